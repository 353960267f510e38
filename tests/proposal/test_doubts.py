"""What cannot be true as proposed is said aloud, and a run of it does not pass for a watch."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.math
import pytest
import shapely
from escapement.made import one_faced_anchor
from proposal.assemblies import assembly, mirror, scene_of
from shapely import affinity

from watchsim.cli import main
from watchsim.escapement.measure import measured_lift
from watchsim.escapement.turn import PASSES, turn, verdict
from watchsim.proposal.propose import propose
from watchsim.proposal.trial import tried
from watchsim.scene.load import from_mapping, load

Corners = list[tuple[float, float]]


def ratchet(teeth: int, lean: float = 0.84) -> Corners:
    return [
        (r * math.cos(angle), r * math.sin(angle))
        for k in range(teeth)
        for r, angle in ((4.0, math.tau * k / teeth), (5.0, math.tau * (k + lean) / teeth))
    ]


def drawing(path: Path, **layers: list[Corners | tuple[float, float, float]]) -> Path:
    """Closed outlines, open ones (whose last corner is None), and circles (x, y, r), by layer."""
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    for layer, shapes in layers.items():
        for shape in shapes:
            if isinstance(shape, tuple):
                document.modelspace().add_circle(shape[:2], shape[2], dxfattribs={"layer": layer})
            else:
                closed = math.dist(shape[0], shape[-1]) > 0.2
                document.modelspace().add_lwpolyline(shape, close=closed, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


ANCHOR: Corners = [(17.0, 0.0), (20.0, 3.0), (23.0, 0.0), (22.5, 0.0), (20.0, 2.0), (17.5, 0.0)]


def test_a_layout_for_cutting_is_said_to_be_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its contacts are declared, so that a run says that they never engage, and gives no rate."""
    path = drawing(tmp_path / "cut.dxf", WHEEL=[ratchet(15), (0.0, 0.0, 0.5)], ANCHOR=[ANCHOR, (20.0, 2.5, 0.2)])
    assert main(["new", str(path), "-o", str(tmp_path / "out")]) == 0
    assert "never come within reach of each other, as in a layout for cutting" in capsys.readouterr().err
    assert load(tmp_path / "out").contacts
    assert main(["run", str(tmp_path / "out"), "--duration", "1 s", "-o", str(tmp_path / "run")]) == 1
    said = capsys.readouterr().out
    assert "s/d" not in said and "wheel never touched anything" in said


def test_an_escape_wheel_a_metre_across_is_doubted(tmp_path: Path) -> None:
    """Drawn in millimetres, and declared to be in inches."""
    path = assembly(scene_of("graham"), tmp_path / "graham.dxf", "body")
    document = ezdxf.readfile(path)
    document.units = ezdxf.units.IN
    document.saveas(path)
    assert any("m across: look at the units of the drawing" in words for words in propose([path]).doubts)


def test_an_assembly_raises_no_doubt(tmp_path: Path) -> None:
    for name in ("swiss_lever", "graham", "ratchet", "jumper", "detent"):
        assert propose([assembly(scene_of(name), tmp_path / f"{name}.dxf", "body")]).doubts == ()


WINDOW: Corners = [(1.2, 0.2), (3.0, 0.4), (2.0, 2.0), (1.22, 0.25)]  # 54 µm open


def test_a_gap_in_a_window_does_not_cost_the_wheel(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nothing touches it there: closed, and said so. A lever whose own outline is open is left out, and said so, too."""
    lever: Corners = [(8.0, -1.0), (10.0, -1.0), (10.0, 1.0), (8.0, 1.0), (8.0, -0.9)]
    path = drawing(tmp_path / "gap.dxf", WHEEL=[ratchet(15), WINDOW, (0.0, 0.0, 0.5)], LEVER=[lever, (9.0, 0.0, 0.2)])
    assert main(["new", str(path), "-o", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert [body["teeth"] for body in said["bodies"]] == [15]
    assert any("open by 53.9 µm" in words for words in said["doubts"])
    assert any("layer LEVER" in words and "100 µm" in words for words in said["left_out"])
    wheel = load(tmp_path / "out").body("wheel")
    assert sum(loop.hole for loop in wheel.loops) == 2  # bore and window
    assert main(["new", str(path), "-o", str(tmp_path / "out"), "--force"]) == 0
    err = capsys.readouterr().err
    assert "Left out: layer LEVER" in err and "Doubtful: an outline inside a part" in err


def test_a_wheel_and_its_mirror_image_are_driven_opposite_ways(tmp_path: Path) -> None:
    """By their teeth, also where there are many of them; where these lean neither way the guess is doubted."""
    ways = []
    for name, lean, side in (("one", 0.84, 1.0), ("mirrored", 0.84, -1.0), ("upright", 0.5, 1.0)):
        teeth = [(x, side * y) for x, y in ratchet(120, lean)]
        path = drawing(tmp_path / f"{name}.dxf", WHEEL=[teeth], ANCHOR=[[(x - 20.0, y + 5.0) for x, y in ANCHOR]])
        found = propose([path])
        assert ("lean neither way" in "".join(found.doubts)) == (name == "upright")
        (tmp_path / name).mkdir()
        for file, data in found.files.items():
            (tmp_path / name / file).write_bytes(data)
        ways.append(math.copysign(1.0, load(tmp_path / name).torques[0].value))
    assert ways == [1.0, -1.0, -1.0]


@pytest.mark.parametrize("name", ["graham", "recoil_anchor"])
def test_an_anchor_gets_a_lift_angle(name: str, tmp_path: Path) -> None:
    """From where one pallet lets go to where the other does, as measured by hand: the 2° of the lift and a lock."""
    found = propose([assembly(scene_of(name), tmp_path / f"{name}.dxf", "body")])
    (tmp_path / "out").mkdir()
    for file, data in found.files.items():
        (tmp_path / "out" / file).write_bytes(data)
    scene = load(tmp_path / "out")
    assert scene.lift_angle == pytest.approx(measured_lift(replace(scene, lift_angle=None)), abs=1e-5)
    assert scene.lift_angle == pytest.approx(math.radians(2.4), abs=1e-5)
    assert verdict(turn(scene))[0] == PASSES  # its anchor is on a spring, and not turned as far as a balance is
    assert next(guess for guess in found.guesses if guess.key == "timegrapher.lift_angle").why.startswith(
        "from where one pallet"
    )


@pytest.mark.parametrize(
    ("name", "layers", "words"),
    [
        ("swiss_lever", "whole", "lever and balance lie over each other"),
        ("cylinder", "whole", "wheel and balance lie over each other"),
    ],
)
def test_what_a_flat_drawing_does_not_show_is_doubted(name: str, layers: str, words: str, tmp_path: Path) -> None:
    """Surfaces of several heights on one layer."""
    found = propose([assembly(scene_of(name), tmp_path / f"{name}.dxf", layers)])
    assert words in "".join(found.doubts)


def test_star_jumper_and_finger_are_known_by_their_names(tmp_path: Path) -> None:
    found = propose([assembly(scene_of("jumper"), tmp_path / "jumper.dxf", "whole")])
    assert {role.name: role.task for role in found.roles} == {"finger": "driver", "star": "wheel", "jumper": "click"}
    assert found.doubts == ()
    keys = {guess.key for guess in found.guesses}
    assert {"springs.0.stiffness", "bodies.finger.velocity"} <= keys and "timegrapher.lift_angle" not in keys


def test_drawings_that_have_zeros_of_their_own_are_doubted_and_a_jumper_beside_its_star_has_no_rate(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    star = [(r * math.cos(a), r * math.sin(a)) for k in range(7) for r, a in star_points(7, k)]
    paths = [
        drawing(tmp_path / "star.dxf", STAR=[star], STAR_PIVOT=[(0.0, 0.0, 0.5)]),
        drawing(tmp_path / "finger.dxf", FINGER=[[(10.0, -0.5), (3.0, 0.0), (10.0, 0.5)]], FINGER_PIVOT=[(9.5, 0.0, 0.1)]),
        drawing(tmp_path / "jumper.dxf", JUMPER=[[(0.0, 7.0), (-1.0, 11.0), (1.0, 11.0)]], JUMPER_PIVOT=[(0.0, 10.5, 0.1)]),
    ]
    assert main(["new", *map(str, paths), "-o", str(tmp_path / "out")]) == 0
    assert "share one coordinate system" in capsys.readouterr().err
    main(["check", str(tmp_path / "out")])
    assert "the spring of jumper presses it on nothing" in capsys.readouterr().out
    assert main(["run", str(tmp_path / "out"), "--duration", "3 s", "--no-plots", "-o", str(tmp_path / "run")]) == 0
    said = capsys.readouterr().out
    assert "s/d" not in said and "swings to and fro: look at where it stands" in said


@pytest.mark.parametrize("teeth", [7, 12])
def test_a_finger_out_of_reach_is_no_anchor_and_a_jumper_in_the_star_is_doubted(teeth: int, tmp_path: Path) -> None:
    jumper, finger = [(1.0, 0.5), (15.0, 1.5), (15.0, 4.0)], [(-9.5, 8.5), (-8.5, 8.5), (-9.0, 4.0)]
    star = [(r * math.cos(a), r * math.sin(a)) for k in range(teeth) for r, a in star_points(teeth, k)]
    pivots = [(0.0, 0.0, 0.5), (14.5, 2.5, 0.2), (-9.0, 8.0, 0.2)]
    found = propose([drawing(tmp_path / "a.dxf", STAR=[star], JUMPER=[jumper], FINGER=[finger], PIVOT=pivots)])
    assert {role.name: role.task for role in found.roles} == {"finger": "driver", "star": "wheel", "jumper": "click"}
    assert any("star and jumper lie over each other, and nothing else comes within reach" in words for words in found.doubts)


def star_points(teeth: int, k: int) -> list[tuple[float, float]]:
    return [(6.0, math.tau * k / teeth), (3.6, math.tau * (k + 0.5) / teeth)]


@pytest.mark.parametrize("layers", ["body", "own"])
def test_pallets_hinged_on_a_pendulum_are_not_found_and_said_so(layers: str, tmp_path: Path) -> None:
    found = propose([assembly(scene_of("grasshopper"), tmp_path / "a.dxf", layers)])
    assert any("2 pivots are drawn at (0.04542, 39.95) mm" in words for words in found.doubts)


def test_two_levers_are_doubted(tmp_path: Path) -> None:
    """One more arm beside a Swiss lever."""
    path = assembly(scene_of("swiss_lever"), tmp_path / "lever.dxf", "body")
    document = ezdxf.readfile(path)
    document.modelspace().add_lwpolyline([(20, -1), (26, -1), (26, 1), (20, 1)], close=True, dxfattribs={"layer": "LEVER2_ARM"})
    document.modelspace().add_point((21, 0), dxfattribs={"layer": "PIVOT"})
    document.saveas(path)
    assert any("no second lever of an escapement" in words for words in propose([path]).doubts)


@pytest.mark.parametrize(("longer", "swings_through"), [(0.0, True), (2.0, False)])
def test_a_click_that_can_swing_through_the_teeth_is_doubted(longer: float, swings_through: bool, tmp_path: Path) -> None:
    """Its pivot is 12.315 mm from the wheel's, its nose 7.951 mm from its pivot: 4.36 mm, and the roots are at 4 mm."""
    x, y = (length * longer / math.hypot(7.3, 3.15) for length in (-7.3, -3.15))
    click = [(10.0, 7.5), (3.2 + x, 4.6 + y), (3.0 + x, 3.6 + y), (10.6, 6.0)]
    path = drawing(tmp_path / "a.dxf", RATCHET=[ratchet(16)], CLICK=[click], PIVOT=[(0.0, 0.0, 0.5), (10.3, 6.75, 0.3)])
    doubts = propose([path]).doubts
    assert any("no nearer to the centre than 4.36 mm, and the teeth go down to 4 mm" in one for one in doubts) is swings_through


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("coaxial", ()),
        ("duplex", ()),
        ("snail", ()),
        (
            "verge",
            ("foliot is all that moves, and nothing meets it", "far_side_FAR and near_side_NEAR: teeth in a straight row"),
        ),
        ("detent", ()),
        ("pin_wheel", ()),
        ("pin_pallet", ()),
        ("cam", ()),
    ],
)
def test_a_proposal_is_tried_and_what_does_not_work_is_said(
    name: str, words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = assembly(scene_of(name), tmp_path / f"{name}.dxf", "body")
    assert main(["new", str(path), "-o", str(tmp_path / "out"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)["doubts"]
    assert len(said) == len(words) and all(part in one for part, one in zip(words, said, strict=True))


def by_hand(folder: Path, gap: float = 0.0) -> list[Path]:
    """A Graham in two files, drawn by its rules: 30 teeth, pallets of 4.1° over seven and a half of them, lift 2°."""

    def put(r: float, degrees: float, y: float = 0.0) -> tuple[float, float]:
        return r * math.cos(math.radians(degrees)), y + r * math.sin(math.radians(degrees))

    pivot, thick = 20.0 * math.sqrt(2.0), 1.43
    teeth = [put(r, 12 * k + 45 + a) for k in range(30) for r, a in ((17, 1.2), (20, 0), (20, 0.4), (17, 6))]
    corners = [
        (20, 210, 14),
        (20, 224, 0),
        (20 - thick, 226, -16),
        (20 - thick, 210, 0),
        (6, 235, 0),
        (6, 305, 0),
        (20, 330, -14),
    ]
    corners += [(20, 316, 0), (20 + thick, 314, 16), (20 + thick, 330, 0), (6, 20, 0), (6, 160, 0)]
    anchor = [(*put(r, a, pivot), math.tan(math.radians(turn) / 4.0)) for r, a, turn in corners]
    if gap:
        anchor.append((anchor[0][0] + gap, anchor[0][1], 0.0))
    paths = []
    for name, points, y, bore in (("wheel", [(*place, 0.0) for place in teeth], 0.0, 1.5), ("anchor", anchor, pivot, 1.0)):
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        closed = not gap or name == "wheel"
        document.modelspace().add_lwpolyline(points, format="xyb", close=closed, dxfattribs={"layer": name})
        document.modelspace().add_circle((0.0, y), bore, dxfattribs={"layer": "BORE"})
        paths.append(folder / f"{name}.dxf")
        document.saveas(paths[-1])
    return paths


def test_a_graham_drawn_by_hand_ticks_as_proposed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The pendulum that is not drawn is heavy enough for the torque by which the wheel keeps up."""
    assert main(["new", *map(str, by_hand(tmp_path)), "-o", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["doubts"] == []
    assert main(["steady", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["amplitude_deg"] == pytest.approx(4.0, abs=0.5)


def renamed(path: Path, names: dict[str, str]) -> Path:
    """The same drawing with other names of layers; a layer of no name here is left as it is."""
    document = ezdxf.readfile(path)
    for entity in document.modelspace():
        entity.dxf.layer = names.get(entity.dxf.layer, entity.dxf.layer)
    document.saveas(path)
    return path


@pytest.mark.parametrize("stone", ["BASCULE_REPOS", "BASCULE_PIERRE_DE_REPOS", "BASCULE_LEVEE", "BASCULE_PIERRE"])
def test_a_french_detent_is_known_by_its_stone_its_leaf_and_its_finger(stone: str, tmp_path: Path) -> None:
    """Neither by the beak of the detent, nor by the roller and the impulse stone, which the leaf does not meet."""
    names = {"wheel_TEETH": "ROUE_DENTURE", "detent_STONE": stone, "detent_BAR": "BASCULE_TIGE", "detent_HORN": "BASCULE_BEC"}
    names |= {"detent_HUB": "BASCULE_MOYEU", "passing_LEAF": "RESSORT_DE_DEGAGEMENT", "balance_TABLE": "BALANCIER_PLATEAU"}
    names |= {"balance_IMPULSE_STONE": "BALANCIER_PIERRE_IMPULSION", "balance_ROLLER": "BALANCIER_PETIT_PLATEAU"}
    names |= {"balance_DISCHARGE": "BALANCIER_DOIGT", "balance_RIM": "BALANCIER_SERGE", "banking_SCREW": "VIS_BUTEE"}
    found = tried([renamed(assembly(scene_of("detent"), tmp_path / "a.dxf", "body"), names)])
    assert [tuple(side.split(".")[1] for side in pair) for pair in found.contacts] == [
        ("ROUE_DENTURE", stone),
        ("ROUE_DENTURE", "BALANCIER_PIERRE_IMPULSION"),
        ("BASCULE_BEC", "RESSORT_DE_DEGAGEMENT"),
        ("BASCULE_TIGE", "VIS_BUTEE"),
        ("RESSORT_DE_DEGAGEMENT", "BALANCIER_DOIGT"),
    ]
    assert found.doubts == ()


@pytest.mark.parametrize(("spokes", "touches"), [("ROUE_RAYONS", False), ("ESCAPE_WHEEL_SPOKES", False), ("ROUE_BORD", True)])
def test_spokes_of_a_wheel_are_no_teeth(spokes: str, touches: bool, tmp_path: Path) -> None:
    names = {"wheel_TEETH": "ROUE_DENTS", "pendulum_PALLETS": "ANCRE_LEVEES", "pendulum_ANCHOR": "ANCRE_BRAS"}
    path = renamed(assembly(scene_of("graham"), tmp_path / "a.dxf", "body"), names)
    document = ezdxf.readfile(path)
    document.modelspace().add_circle((0.0, 0.0), 13.0, dxfattribs={"layer": spokes})
    document.saveas(path)
    found = [{side.split(".")[1] for side in pair} for pair in propose([path]).contacts]
    assert {"ROUE_DENTS", "ANCRE_LEVEES"} in found
    assert ({spokes, "ANCRE_LEVEES"} in found) == touches


@pytest.mark.parametrize("turned", [0.0, -8.0, 5.0])
def test_a_pin_drawn_over_the_fork_meets_it_all_the_same_and_it_is_said(turned: float, tmp_path: Path) -> None:
    """The lever drawn off the middle, by some degrees, and the balance at rest: its pin then lies over a horn of the fork."""
    path = assembly(scene_of("pin_pallet"), tmp_path / "a.dxf", "body")
    document, scene = ezdxf.readfile(path), scene_of("pin_pallet")
    x, y = (1e3 * value for value in scene.body("lever").position)
    turn = ezdxf.math.Matrix44.chain(
        ezdxf.math.Matrix44.translate(-x, -y, 0.0),
        ezdxf.math.Matrix44.z_rotate(math.radians(turned)),
        ezdxf.math.Matrix44.translate(x, y, 0.0),
    )
    for entity in document.modelspace():
        if entity.dxf.layer.startswith("lever_"):
            entity.transform(turn)
    document.saveas(path)
    found = propose([path])
    assert any({"FORK", "PIN"} == {side.split("_")[-1] for side in pair} for pair in found.contacts)
    said = any("overlap as they are drawn" in words and "lever_FORK" in words for words in found.doubts)
    assert said == (abs(turned) > 4.0)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_finger_turns_the_way_in_which_it_carries_the_star_on(mirrored: bool, tmp_path: Path) -> None:
    path = assembly(scene_of("jumper"), tmp_path / "a.dxf", "whole")
    found = tried([mirror(path) if mirrored else path])
    assert found.doubts == ()
    assert f'velocity = "{"" if mirrored else "-"}60 rpm"' in found.files["scene.toml"].decode()


def test_of_a_part_left_out_it_is_said_that_it_may_be_what_should_touch(tmp_path: Path) -> None:
    found = propose(by_hand(tmp_path, gap=0.02))
    assert "Mend the drawing" in "".join(found.left_out)
    assert "among what was left out" in found.doubts[0] and "cutting" not in "".join(found.doubts)


@pytest.mark.parametrize("mirrored", [False, True])
def test_where_pins_show_no_direction_both_are_tried(mirrored: bool, tmp_path: Path) -> None:
    """A pin wheel drives its pendulum one way only; in a mirror the other way."""
    path = assembly(scene_of("pin_wheel"), tmp_path / "pins.dxf", "body")
    found = tried([mirror(path) if mirrored else path])
    assert found.doubts == ()
    (value,) = (guess.value for guess in found.guesses if guess.key == "torques.0.value")
    assert value.startswith('"-') != mirrored


def test_teeth_that_lock_either_way_are_driven_as_they_lean(tmp_path: Path) -> None:
    """One flat face on each pallet locks and drives both ways: the guesses of a trial do not outweigh the lean of the tips."""
    _, teeth, anchor = one_faced_anchor(tmp_path)
    pallets = [(x, y + 20.62213808) for x, y in anchor]
    path = drawing(tmp_path / "clock.dxf", WHEEL=[teeth, (0.0, 0.0, 1.0)], ANCHOR=[pallets, (0.0, 20.62213808, 0.8)])
    found = tried([path])
    (value,) = (guess.value for guess in found.guesses if guess.key == "torques.0.value")
    assert value.startswith('"-')
    assert "lock and drive either way" in found.doubts[-1]


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_pin_lever_is_driven_the_way_in_which_its_wheel_drops_less(mirrored: bool, tmp_path: Path) -> None:
    """Its 18 teeth lock and drive either way, and their tips lean against the right one."""
    scene = from_mapping({"design": {"of": "pin_pallet", "teeth": 18}}, None)
    path = assembly(scene, tmp_path / "roskopf.dxf", "body")
    found = tried([mirror(path) if mirrored else path])
    (value,) = (guess.value for guess in found.guesses if guess.key == "torques.0.value")
    assert value.startswith('"-') != mirrored and found.doubts == ()


@pytest.mark.parametrize("aside", [0.0, 3.0, -2.0])
def test_an_anchor_that_jams_between_two_teeth_is_said_to_and_where(aside: float, tmp_path: Path) -> None:
    """However far aside it is drawn, it swings about the middle of its lift. The places are those at which outlines touch."""
    _, teeth, anchor = one_faced_anchor(tmp_path)
    pivot, turn = 20.62213808, math.radians(aside)
    turned = [(x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn) + pivot) for x, y in anchor]
    layers = {"WHEEL": [teeth, (0.0, 0.0, 1.0)], "ANCHOR": [turned, (0.0, pivot, 0.8)]}
    found = tried([drawing(tmp_path / "clock.dxf", **layers)])
    guesses = {guess.key: guess.value.strip('"') for guess in found.guesses}
    assert float(guesses.get("springs.0.rest", "0°").rstrip("°")) == pytest.approx(-aside, abs=0.1)
    assert float(guesses["timegrapher.lift_angle"].rstrip("°")) == pytest.approx(3.05, abs=0.1)
    (jam,) = (words for words in found.doubts if "jams between two teeth" in words)
    assert "torque may mend" not in "".join(found.doubts)
    led, x, y, x2, y2, wheel = (float(one.replace("−", "-")) for one in re.findall(r"-?\d+\.?\d*(?=°|, |\) )", jam))
    assert led + aside == pytest.approx(-4.17, abs=0.03)
    one = affinity.rotate(shapely.Polygon(turned), led, origin=(0.0, pivot))
    other = affinity.rotate(shapely.Polygon(teeth), wheel, origin=(0.0, 0.0))
    for place in (shapely.Point(x, y), shapely.Point(x2, y2)):
        assert max(place.distance(one.boundary), place.distance(other.boundary)) < 0.02
    assert math.dist((x, y), (x2, y2)) > 2.0  # a pitch is 3.5 mm


def test_a_balance_out_of_reach_of_its_lever_is_the_cause_and_no_inertia(tmp_path: Path) -> None:
    scene = scene_of("swiss_lever")
    lever, balance = scene.body("lever"), scene.body("balance")
    away = tuple(b + 0.12 * (b - a) for a, b in zip(lever.position, balance.position, strict=True))
    moved = replace(scene, bodies=tuple(replace(one, position=away) if one is balance else one for one in scene.bodies))
    doubts = tried([assembly(moved, tmp_path / "far.dxf")]).doubts
    assert any("lever and balance never come within reach of each other" in words for words in doubts)
    assert not any("other inertias" in words for words in doubts)


def test_a_pendulum_drawn_aside_hangs_down_and_beats_by_its_length(tmp_path: Path) -> None:
    """A disc of radius r = 20 mm, d = 250 mm below its pivot, drawn 3° aside: T = 2π √(L/g) with L = (d² + r²/2)/d."""
    lean = math.radians(3.0)
    bob = (250.0 * math.sin(lean), 50.0 - 250.0 * math.cos(lean), 20.0)
    teeth = [(2.0 * x, 2.0 * y) for x, y in ratchet(30)]
    path = drawing(tmp_path / "clock.dxf", WHEEL_TEETH=[teeth], PENDULUM_BOB=[bob])
    document = ezdxf.readfile(path)
    for place in ((0.0, 0.0), (0.0, 50.0)):
        document.modelspace().add_point(place, dxfattribs={"layer": "PIVOT"})
    document.saveas(path)
    guesses = {guess.key: guess.value.strip('"') for guess in propose([path]).guesses}
    assert float(guesses["springs.0.rest"].rstrip("°")) == pytest.approx(-3.0, abs=0.01)
    vph = 3600.0 / math.pi * math.sqrt(9.81 / (0.25 + 0.5 * 0.02**2 / 0.25))
    assert float(guesses["springs.0.frequency"].split()[0]) == pytest.approx(vph, abs=0.06)


def brocot(path: Path, turned: float) -> Path:
    """A clock as blocks: a wheel with a "rim", half-round pins on an anchor, and a pendulum hung on it, in a plate."""
    document = ezdxf.new("R2013", units=ezdxf.units.MM)
    space, radius, pitch, span, pin = document.modelspace(), 20.0, math.tau / 30, math.radians(51.0), 0.9
    up = radius / math.cos(span)

    def polar(r: float, angle: float) -> tuple[float, float]:
        return (r * math.cos(angle), r * math.sin(angle))

    def outline(where: Any, layer: str, points: Any, **more: Any) -> None:
        where.add_lwpolyline(points, close=True, dxfattribs={"layer": layer}, **more)

    wheel, anchor = document.blocks.new("SCAPEWHEEL"), document.blocks.new("BROCOT_ANCHOR")
    tooth = ((16.8, 0.0), (radius, 0.0), (radius, 0.015), (17.2, 0.62 * pitch))
    outline(wheel, "SCAPE_RIM", [polar(r, k * pitch + more) for k in range(30) for r, more in tooth])
    wheel.add_circle((0, 0), 1.1, dxfattribs={"layer": "SCAPE_BORE"})
    for angle in (0.5 * math.pi + span, 0.5 * math.pi - span):
        ends = (polar(radius + 0.35 + pin, angle), polar(radius + 0.35 - pin, angle))
        outline(anchor, "ANCHOR_PINS", [(*ends[0], 1), (*ends[1], 0)], format="xyb")
    arms = [(-20, 14), (-14, up - 1), (0, up + 4), (14, up - 1), (20, 14), (12, up - 6), (-12, up - 6)]
    outline(anchor, "ANCHOR_ARMS", arms)
    anchor.add_circle((0, up), 1.0, dxfattribs={"layer": "ANCHOR_BORE"})
    space.add_blockref("SCAPEWHEEL", (60, 40), dxfattribs={"rotation": turned})
    space.add_blockref("BROCOT_ANCHOR", (60, 40))
    outline(space, "PLATE", [(0, 0), (120, 0), (120, 100), (0, 100)])
    outline(space, "PENDULUM_ROD", [(59, 38 + up), (61, 38 + up), (61, up - 200), (59, up - 200)])
    space.add_circle((60, up - 210), 30, dxfattribs={"layer": "PENDULUM_BOB"})
    document.saveas(path)
    return path


def test_a_wheel_with_a_rim_is_no_pendulum_and_the_anchor_hangs_on_its_rod(tmp_path: Path) -> None:
    """Its rim and the pendulum's bob once made one oscillator of wheel and pendulum, beside an anchor with nothing to do."""
    found = propose([brocot(tmp_path / "clock.dxf", -0.4)])
    assert [(role.name, role.task, role.teeth) for role in found.roles] == [
        ("scape_wheel", "wheel", 30),
        ("pendulum", "oscillator", 0),
        ("plate", "fixed", 0),
    ]
    met = {tuple(side.split("_")[-1] for side in pair) for pair in found.contacts}
    assert ("WHEEL", "PINS") in met
    assert not any("cuts into" in doubt for doubt in found.doubts)


def test_pins_drawn_into_the_teeth_are_doubted(tmp_path: Path) -> None:
    found = propose([brocot(tmp_path / "clock.dxf", -1.2)])
    (doubt,) = (doubt for doubt in found.doubts if "cuts into" in doubt)
    assert "ANCHOR_PINS cuts into the teeth of scape_wheel" in doubt
