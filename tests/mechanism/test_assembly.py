"""Does one drawing serve a whole mechanism, and is a layer that is turned and shifted the same as one edited by hand?"""

import json
import math
from pathlib import Path

import pytest
from made_scenes import circle, square

from watchsim.cli import main
from watchsim.commands.console import FINE
from watchsim.drawing.write import dxf_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.geometry.solids import mass_properties
from watchsim.mechanism.overlap import overlap_faults
from watchsim.paths import profiles_dir
from watchsim.results.folder import lock_text
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

# Does one drawing serve a whole mechanism, each pivot given once?

MM = 1e-3
WHEEL, LEVER = (1.0 * MM, 2.0 * MM), (1.5 * MM, 9.0 * MM)
TEXT = """
[scene]
schema = 1
[bodies.wheel]
drawing = "all.dxf"
layers = ["TEETH"]
draw = ["WHEEL_ARMS"]
pivot = "hole near [1.1 mm, 2 mm]"
inertia = "1 mg·cm²"
[bodies.lever]
drawing = "all.dxf"
layers = ["FORK"]
pivot = "LEVER_PIVOT"
inertia = "1 mg·cm²"
angle = "3°"
[bodies.plate]
drawing = "all.dxf"
layers = ["PLATE"]
motion = "fixed"
"""


def halves(x: float, y: float, radius: float, layer: str) -> Loop:
    """A circle in two arcs, as some programs draw it; clockwise, a hole."""
    arcs = tuple(Arc(x, y, radius, start, -math.pi) for start in (0.0, math.pi))
    return Loop(arcs, layer, hole=True)


@pytest.fixture
def desk(tmp_path: Path) -> Path:
    loops = (
        *(square(4 * MM, WHEEL, "TEETH"), halves(*WHEEL, 0.3 * MM, "TEETH"), square(1 * MM, WHEEL, "WHEEL_ARMS")),
        *(square(2 * MM, LEVER, "FORK"), circle(0.1 * MM, LEVER, "LEVER_PIVOT"), square(1 * MM, (9 * MM, 9 * MM), "PLATE")),
    )
    (tmp_path / "all.dxf").write_text(dxf_text(loops, (("MARK", (5 * MM, 5 * MM)),), {}), encoding="utf-8")
    return tmp_path


def scene_of(desk: Path, text: str = TEXT):
    (desk / "scene.toml").write_text(text, encoding="utf-8")
    return load(desk)


def faults(desk: Path, old: str, new: str) -> str:
    assert TEXT.count(old) == 1
    with pytest.raises(SceneError) as caught:
        scene_of(desk, TEXT.replace(old, new))
    return str(caught.value)


def test_positions_follow_from_pivots(desk: Path) -> None:
    scene = scene_of(desk)
    assert scene.body("wheel").position == pytest.approx(WHEEL, abs=1e-12)
    assert scene.body("lever").position == pytest.approx(LEVER, abs=1e-12)
    assert scene.body("plate").position == (0.0, 0.0)
    # Everything is where it is drawn: the wheel's outline about its own pivot, moved there.
    corner = scene.body("wheel").loops[0].edges[0].start
    assert (corner[0] + WHEEL[0], corner[1] + WHEEL[1]) == pytest.approx((-1 * MM, 0.0), abs=1e-12)
    (desk / "scene.lock.toml").write_text(lock_text(scene, desk), encoding="utf-8")
    assert load(desk / "scene.lock.toml") == scene


def test_a_position_that_is_given_counts(desk: Path) -> None:
    assert scene_of(desk).set("bodies.lever.position", [0.0, 0.005]).body("lever").position == (0.0, 0.005)
    alone = TEXT[: TEXT.index("[bodies.lever]")]
    assert scene_of(desk, alone).body("wheel").position == (0.0, 0.0)  # a drawing of its own says nothing of the movement
    asked = alone.replace("inertia", 'position = "as drawn"\ninertia')
    assert scene_of(desk, asked).body("wheel").position == pytest.approx(WHEEL, abs=1e-12)


def test_a_carried_body_is_placed_on_its_carrier(desk: Path) -> None:
    scene = scene_of(desk, TEXT.replace('angle = "3°"', 'on = "wheel"\nmass = "1 mg"'))
    x, y = scene.body("lever").position
    assert (x + WHEEL[0], y + WHEEL[1]) == pytest.approx(LEVER, abs=1e-12)


def test_drawn_layers_belong_to_their_body_only(desk: Path) -> None:
    scene = scene_of(desk)
    assert [loop.layer for loop in scene.body("wheel").decoration] == ["WHEEL_ARMS"]
    assert scene.body("lever").decoration == () and scene.body("wheel").layers == ("TEETH",)
    shut = scene_of(desk, TEXT[: TEXT.index("[bodies.lever]")].replace('["WHEEL_ARMS"]', "[]"))
    assert shut.body("wheel").decoration == ()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('["WHEEL_ARMS"]', '["WHEEL_ARM"]', 'the drawing has no such layer. Did you mean "WHEEL_ARMS"?'),
        ('["WHEEL_ARMS"]', '["TEETH"]', "this layer can touch, and is drawn anyway"),
        ('["WHEEL_ARMS"]', '["MARK"]', "there is no closed outline on this layer"),
        ("hole near [1.1 mm, 2 mm]", "hole near [1.1, 2]", 'write pivot = "hole near [1.1 mm, 2 mm]"'),
        ("hole near [1.1 mm, 2 mm]", "hole near [1.1 mm, 2]", 'write pivot = "hole near [1.1 mm, 2 mm]"'),
        ("hole near [1.1 mm, 2 mm]", "rivet near [1 mm, 2 mm]", "write hole, circle or point near a place"),
        ("hole near [1.1 mm, 2 mm]", "hole near 1 mm", "write hole, circle or point near a place"),
        ("hole near [1.1 mm, 2 mm]", "circle near [1.2 mm, 5.5 mm]", "are about equally near"),
        ('angle = "3°"', 'position = "drawn"', 'write ["1 mm", "0 mm"], or "as drawn"'),
    ],
)
def test_slips_are_named(old: str, new: str, words: str, desk: Path) -> None:
    assert words in faults(desk, old, new)


def test_other_marks(desk: Path) -> None:
    for pivot, place in (
        ("circle near [1.5 mm, 8 mm]", LEVER),
        ("point near [0 mm, 0 mm]", (5 * MM, 5 * MM)),
        ("MARK", (5 * MM, 5 * MM)),
    ):
        scene = scene_of(desk, TEXT.replace("hole near [1.1 mm, 2 mm]", pivot))
        assert scene.body("wheel").position == pytest.approx(place, abs=1e-12)


def test_inspect_lists_circles_and_points(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(desk / "all.dxf")]) == FINE
    said = capsys.readouterr().out
    assert "hole of radius 0.3 mm at (1, 2) mm" in said
    assert "pivot of radius 0.1 mm at (1.5, 9) mm" in said and "a point at (5, 5) mm" in said
    assert main(["inspect", str(desk / "all.dxf"), "--json"]) == FINE
    circles = json.loads(capsys.readouterr().out)["circles"]
    found = [
        (one["layer"], round(one["x_mm"], 9), round(one["y_mm"], 9), round(one["radius_mm"], 9), one["hole"]) for one in circles
    ]
    assert found == [("TEETH", 1.0, 2.0, 0.3, True), ("LEVER_PIVOT", 1.5, 9.0, 0.1, False)]


def test_check_takes_changes(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene_of(desk)
    assert main(["check", str(desk), "--set", "bodies.lever.inertia=7 mg·cm²", "--json"]) == FINE
    assert json.loads(capsys.readouterr().out)["bodies"]["lever"]["inertia_kg_m2"] == pytest.approx(7e-10)


# Is a layer that is turned and shifted the same as a drawing edited by hand?

KEY = "bodies.lever.adjust.STONES"
ENTRY = ["-1.2 mm", "-0.5 mm"]  # in the entry stone


@pytest.fixture(scope="module")
def scene():
    return load(profiles_dir() / "swiss_lever")


def stones(scene):
    return [loop for loop in scene.body("lever").loops if loop.layer == "STONES"]


def rest(scene):
    return [loop for loop in scene.body("lever").loops if loop.layer != "STONES"]


def corners(loops):
    return [edge.start for loop in loops for edge in loop.edges]


def near(one, other, by=1e-15):
    return all(math.dist(p, q) < by for p, q in zip(corners(one), corners(other), strict=True))


def test_turned_about_a_layer_and_shifted(scene):
    got = scene.set(KEY, {"turn": "0.1°", "about": "PIVOT", "shift": ["0 µm", "2 µm"]})
    assert near(stones(got), [loop.moved(math.radians(0.1), (0.0, 2e-6)) for loop in stones(scene)])
    assert rest(got) == rest(scene)


def test_turned_about_a_point(scene):
    x, y = 1e-3, -0.5e-3
    got = scene.set(f"{KEY}.turn", 0.01).set(f"{KEY}.about", [x, y])
    back = [loop.moved(0.0, (-x, -y)).moved(0.01, (x, y)) for loop in stones(scene)]
    assert near(stones(got), back)


def test_one_stone_turns_about_its_own_centre(scene):
    got = scene.set(KEY, [{"near": ENTRY, "turn": "1°"}])
    assert stones(got)[1] == stones(scene)[1]
    old, new = (mass_properties([stones(one)[0]], 1.0, 1.0) for one in (scene, got))
    assert math.dist(old.centre, new.centre) < 1e-15
    assert old.mass == pytest.approx(new.mass, rel=1e-6, abs=0.0)
    turned = [
        math.atan2(*reversed([b - a for a, b in zip(edge.start, edge.end, strict=True)]))
        for edge in (stones(scene)[0].edges[0], stones(got)[0].edges[0])
    ]
    assert turned[1] - turned[0] == pytest.approx(math.radians(1.0))


@pytest.mark.parametrize(("fraction", "way"), [(0.9, 1.0), (0.51, 1.0), (0.49, -1.0), (0.1, -1.0)])
def test_along_a_face(scene, fraction, way):
    """Towards the end that is nearer."""
    face = stones(scene)[0].edges[-1]  # the locking face, which ends at the corner
    end = [f"{1e3 * value!r} mm" for value in face.point(fraction)]
    got = scene.set(KEY, [{"near": ENTRY, "along": "5 µm", "face": end}])
    shift = [b - a for a, b in zip(corners(stones(scene))[0], corners(stones(got))[0], strict=True)]
    assert math.hypot(*shift) == pytest.approx(5e-6)
    assert shift == pytest.approx([way * 5e-6 * part for part in face.tangent(0.0)])


def test_each_outline_moves_on_its_own_radius(scene):
    before, after = (
        [loop.edges[0] for loop in one.body("banking").loops]
        for one in (scene, scene.set("bodies.banking.adjust.PINS", {"radial": "3 µm", "about": ["0 mm", "2.7712812921 mm"]}))
    )
    for old, new in zip(before, after, strict=True):
        far = math.hypot(old.x, old.y - 2.7712812921e-3)
        assert math.hypot(new.x, new.y - 2.7712812921e-3) - far == pytest.approx(3e-6)
        assert (new.x - old.x) / 3e-6 == pytest.approx(old.x / far)


def test_without_another_place_the_radius_is_that_from_the_pivot(scene):
    """The lever's pivot is marked by a layer of its drawing, with one point on it."""
    marked, said = (scene.set(KEY, [{"near": ENTRY, "radial": "3 µm", **about}]) for about in ({}, {"about": "PIVOT"}))
    assert near(stones(marked), stones(said)) and not near(stones(marked), stones(scene), 1e-7)


def test_mass_and_inertia_follow(tmp_path):
    part = '[bodies.wheel]\ndrawing = "a.dxf"\npivot = ["0 mm", "0 mm"]\n{}'
    solids = '[[bodies.wheel.solids]]\nlayer = "STONES"\nthickness = "1 mm"\ndensity = "4 g/cm³"\n'
    (tmp_path / "a.dxf").write_bytes((profiles_dir() / "swiss_lever" / "lever.dxf").read_bytes())
    (tmp_path / "scene.toml").write_text(part.format('layers = ["FORK"]\n') + solids, encoding="utf-8")
    plain = load(tmp_path)
    moved = plain.set("bodies.wheel.adjust.STONES.shift", ["0.1 mm", "0 mm"])
    body, other = plain.body("wheel"), moved.body("wheel")
    (x, y), m = body.centre_of_mass, body.mass
    assert other.centre_of_mass == pytest.approx((x + 1e-4, y))
    assert other.inertia == pytest.approx(body.inertia + m * ((x + 1e-4) ** 2 - x**2), rel=1e-6, abs=0.0)


def test_overlaps_are_found(scene):
    assert not overlap_faults(scene)
    assert overlap_faults(scene.set(KEY, [{"near": ENTRY, "shift": ["0 µm", "-30 µm"]}]))


def test_a_file_says_the_same(tmp_path, scene):
    text = (profiles_dir() / "swiss_lever" / "scene.toml").read_text(encoding="utf-8")
    for file in (profiles_dir() / "swiss_lever").glob("*.dxf"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    entry = '[bodies.lever.adjust]\nSTONES = { turn = "0.1°", about = "PIVOT", shift = ["0 µm", "2 µm"] }\n'
    (tmp_path / "scene.toml").write_text(text + entry, encoding="utf-8")
    again = load(tmp_path)
    assert stones(again) == stones(scene.set(KEY, {"turn": "0.1°", "about": "PIVOT", "shift": ["0 µm", "2 µm"]}))
    assert again.set(f"{KEY}.turn", "0°").set(f"{KEY}.shift.1", 0.0).bodies == scene.bodies


REFUSED = [
    ("bodies.lever.adjust.STONE.turn", "1°", "bodies.lever.adjust.STONE", 'Did you mean "STONES"?'),
    (f"{KEY}.tun", "1°", f"{KEY}.tun", 'Did you mean "turn"?'),
    (f"{KEY}.0.turn", "1°", f"{KEY}.0.turn", "there is no such table"),
    (f"{KEY}.turn", "2", f"{KEY}.turn", "a bare number needs a unit"),
    (KEY, 3, KEY, "a table of keys is needed"),
    (KEY, {"along": "2 µm"}, f"{KEY}.along", "belongs together with face"),
    (KEY, [{"near": ENTRY, "along": "2 µm", "face": ["-1.23461485582 mm", "-0.62906768936 mm"]}], f"{KEY}.0.face", "two edges"),
    (KEY, {"turn": "1°", "about": "STONES"}, f"{KEY}.about", "neither a point nor a circle"),
    (KEY, {"turn": "1°", "about": "PIVO"}, f"{KEY}.about", "neither a point nor a circle"),
    (KEY, [{"near": ["0 mm", "-0.5 mm"], "turn": "1°"}], f"{KEY}.0.near", "about equally near"),
    ("bodies.lever.adjust.ARMS", {"radial": "1 µm", "about": ["0.1 mm", "x"]}, "bodies.lever.adjust.ARMS.about.1", "number"),
    ("bodies.banking.adjust.PINS", [{"near": ["-0.5 mm", "5.2 mm"], "shift": ["1 mm", "0 mm"]}], "adjust.PINS", "cross at"),
]


@pytest.mark.parametrize(("key", "value", "where", "words"), REFUSED)
def test_faults(scene, key, value, where, words):
    with pytest.raises(SceneError) as caught:
        scene.set(key, value)
    assert any(where in fault.key and words in fault.message for fault in caught.value.faults), str(caught.value)


def test_an_unreadable_place_is_one_fault(scene):
    with pytest.raises(SceneError) as caught:
        scene.set(KEY, [{"near": ENTRY, "along": "2 µm", "face": ["1 kg", "0 mm"]}])
    assert str(caught.value).count(f"{KEY}.0.face") == 1
