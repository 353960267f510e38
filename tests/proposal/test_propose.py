"""Do drawings of whole mechanisms give the scene that they were drawn from?"""

import json
import math
from pathlib import Path

import ezdxf
import pytest
from every_time import few
from proposal.assemblies import NAMES, assembly, scene_of
from strangers import DRAWINGS, PIN_LEVER, needs

from watchsim.cli import main
from watchsim.mechanism.overlap import overlaps
from watchsim.proposal.propose import NothingToPropose, propose
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

ROOT = Path(__file__).resolve().parents[2]
OURS = sorted([*ROOT.glob("profiles/*/*.dxf"), *ROOT.glob("tests/data/*.dxf")])
EXTRA = {  # guessed and not so
    "coaxial": {
        frozenset((("lever", "FORK"), ("balance", "IMPULSE_STONE"))),
        frozenset((("lever", "LOCKING_STONES"), ("banking", "PINS"))),
    }
}


def written(paths: list[Path], folder: Path) -> Scene:
    """The proposed scene, loaded from files."""
    folder.mkdir()
    for name, data in propose(paths).files.items():
        (folder / name).write_bytes(data)
    return load(folder)


def partner(scene: Scene, real: Scene, name: str) -> str:
    """The body of the real scene that turns where body `name` of the proposed one does, or stands still as it does."""
    body = scene.body(name)
    if body.motion == "fixed":
        return next(one.name for one in real.bodies if one.motion == "fixed")
    turning = [one for one in real.bodies if one.motion == "pivot"]
    nearest = min(turning, key=lambda one: math.dist(one.position, body.position))
    assert math.dist(nearest.position, body.position) < 1e-9
    return nearest.name


@pytest.mark.parametrize("name", few(NAMES, lambda name: name != "involute_pair"))
def test_an_assembly_gives_its_bodies_pivots_and_contacts(name: str, tmp_path: Path) -> None:
    real = scene_of(name)
    scene = written([assembly(real, tmp_path / f"{name}.dxf", "own")], tmp_path / "out")
    names = {body.name: partner(scene, real, body.name) for body in scene.bodies}
    assert sorted(names.values()) == sorted(body.name for body in real.bodies)
    assert not overlaps(scene)

    def pairs(one: Scene, told: dict[str, str]) -> set[frozenset[tuple[str, str]]]:
        """By body and the last words of the layer: a sorted drawing puts the body's name before it."""
        found = set()
        for contact in one.contacts:
            sides = [(told[side.body], side.layer, one.body(side.body)) for side in contact.sides]
            found.add(
                frozenset((body, (layer or own.layers[0]).removeprefix(f"{own.name.upper()}_")) for body, layer, own in sides)
            )
        return found

    plain = {"involute_pair": {"WHEEL": "TEETH", "WHEEL_2": "TEETH"}, "coaxial": {"BANKING": "PINS"}}.get(name, {})
    guessed = {frozenset((body, plain.get(layer, layer)) for body, layer in pair) for pair in pairs(scene, names)}
    wanted = pairs(real, {body.name: body.name for body in real.bodies})
    assert guessed - EXTRA.get(name, set()) == wanted


def test_a_click_without_a_name_is_known_by_its_one_side(tmp_path: Path) -> None:
    """Unlike an anchor, which comes into the teeth whichever way it is turned; driven, the wheel runs free beneath it."""
    real = scene_of("ratchet")
    scene = written([assembly(real, tmp_path / "a.dxf", "own")], tmp_path / "free")
    assert [spring.body for spring in scene.springs] == ["click"]
    assert simulate(scene, 1.0).q[-1, 0] > math.tau / 4  # counter-clockwise, as it is wound
    text = (tmp_path / "free" / "scene.toml").read_text()
    held = text.replace('value = "1 µN·m"', 'value = "-1 µN·m"')
    assert held != text
    (tmp_path / "free" / "scene.toml").write_text(held)
    assert abs(simulate(load(tmp_path / "free"), 1.0).q[-1, 0]) < math.tau / 24  # the other way the click holds it


def test_that_a_click_holds_is_not_said_of_what_the_teeth_alone_show(tmp_path: Path) -> None:
    found = propose([assembly(scene_of("ratchet"), tmp_path / "a.dxf", "own")])
    (why,) = [guess.why for guess in found.guesses if guess.key == "torques.0.value"]
    assert "lean the other way, which a click should hold; that it does is not shown" in why


def test_a_follower_whose_pivot_lies_behind_it_slides(tmp_path: Path) -> None:
    """An eccentric lifts it by twice its eccentricity, 1.5 mm: at half a turn it stands highest."""
    scene = written([assembly(scene_of("cam"), tmp_path / "a.dxf", "whole")], tmp_path / "out")
    assert scene.body("follower").motion == "slide"
    run = simulate(scene, 0.5)
    height = run.q[:, run.slices["follower"].start]
    assert float(height[-1] - height[0]) == pytest.approx(3e-3, abs=1e-6)


def test_a_driven_finger_moves_a_star_on_against_its_jumper(tmp_path: Path) -> None:
    scene = written([assembly(scene_of("jumper"), tmp_path / "a.dxf", "body")], tmp_path / "out")
    run = simulate(scene, 3.0)
    star = run.slices["star"].start
    assert abs(run.q[-1, star] - run.q[0, star]) / (math.tau / 7) == pytest.approx(3.0, abs=0.02)


@pytest.mark.parametrize("name", ["swiss_lever", "bench_lever", "set_a"])
def test_a_lever_escapement_goes_as_it_was_proposed(name: str, tmp_path: Path) -> None:
    """Locked at the start, driven the right way, and gaining amplitude: it ticks without any edit."""
    real = scene_of(name)
    scene = written([assembly(real, tmp_path / f"{name}.dxf", "body")], tmp_path / "out")
    assert math.copysign(1.0, scene.torques[0].value) == math.copysign(1.0, real.torques[0].value)
    run = simulate(scene, 1.0)
    wheel = run.slices[scene.torques[0].body].start
    pitches = abs(run.q[-1, wheel] - run.q[0, wheel]) / math.radians(24.0)
    assert 3.4 < pitches < 4.7  # one tooth in each oscillation of 4 Hz
    balance = run.slices[scene.springs[0].body].start
    assert math.degrees(run.q[len(run.q) // 2 :, balance].max()) > 240.0


def test_loose_outlines_and_marks_give_bodies(tmp_path: Path) -> None:
    """All on one layer: outlines in a drawing that is made for it, each on a layer of its own, those of one body together.

    Without the balance's rim, in which everything would lie as its holes.
    """
    real = scene_of("swiss_lever")
    proposal = propose([assembly(real, tmp_path / "loose.dxf", "loose", without=("RIM",))])
    assert [role.task for role in proposal.roles] == ["wheel", "lever", "oscillator", "fixed"]
    assert set(proposal.files) == {"loose_sorted.dxf", "scene.toml"}
    assert proposal.roles[0].teeth == 15
    at = [role.part.centre.at for role in proposal.roles[:3]]
    assert [math.dist(a, body.position) for a, body in zip(at, real.bodies[:3], strict=True)] == pytest.approx(
        [0.0] * 3, abs=1e-9
    )


def test_blocks_are_bodies(tmp_path: Path) -> None:
    """Two gears, each a block on the same layer, put into the drawing."""
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    for block, teeth, radius in (("BIG", 24, 6.0), ("SMALL", 12, 3.0)):
        made = document.blocks.new(block)
        corners = []
        for k in range(2 * teeth):
            r = radius + (0.4 if k % 2 else -0.4)
            corners += [(r * math.cos(math.pi * (k + d) / teeth), r * math.sin(math.pi * (k + d) / teeth)) for d in (-0.2, 0.2)]
        made.add_lwpolyline(corners, close=True, dxfattribs={"layer": "OUTLINE"})
    document.modelspace().add_blockref("BIG", (0.0, 0.0))
    document.modelspace().add_blockref("SMALL", (9.3, 0.0))
    document.saveas(tmp_path / "gears.dxf")
    scene = written([tmp_path / "gears.dxf"], tmp_path / "out")
    assert sorted(body.position for body in scene.bodies) == [
        pytest.approx((0.0, 0.0), abs=1e-9),
        pytest.approx((9.3e-3, 0.0), abs=1e-12),
    ]
    assert len(scene.contacts) == 1 and not overlaps(scene)


def test_parts_in_files_of_their_own_are_put_side_by_side(tmp_path: Path) -> None:
    folder = scene_of("swiss_lever").path.parent  # type: ignore[union-attr]
    proposal = propose([folder / f"{name}.dxf" for name in ("escape_wheel", "lever", "roller", "banking")])
    assert [role.name for role in proposal.roles] == ["wheel", "lever", "balance", "banking"]
    assert {("wheel.TEETH", "lever.STONES"), ("lever.FORK", "balance.PIN")} <= set(proposal.contacts)
    keys = {guess.key for guess in proposal.guesses}
    assert {"bodies.lever.position", "bodies.balance.position"} <= keys


def test_every_guess_has_a_reason_and_stands_in_the_scene(tmp_path: Path) -> None:
    path = assembly(scene_of("bench_lever"), tmp_path / "bench.dxf")
    proposal = propose([path])
    text = proposal.files["scene.toml"].decode()
    assert len(proposal.guesses) > 10
    assert all(guess.why and guess.why in text for guess in proposal.guesses)


def test_the_command_writes_and_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = assembly(scene_of("bench_lever"), tmp_path / "bench.dxf")
    assert main(["new", "bench.dxf", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["folder"] == "bench" and [body["task"] for body in told["bodies"]][:3] == ["wheel", "lever", "oscillator"]
    assert main(["check", "bench"]) == 0
    assert main(["new", "bench.dxf"]) == 2  # it is there
    assert main(["new", "bench.dxf", "--force"]) == 0
    capsys.readouterr()
    assert main(["new", "nothing.dxf"]) == 2
    assert "there is no such file" in capsys.readouterr().err
    assert main(["new", "bench.dxf", "--lock", "2°", "-o", "b"]) == 2
    assert "does not apply to drawings" in capsys.readouterr().err
    (tmp_path / "open.dxf").write_bytes(path.read_bytes()[:4000])
    assert main(["new", "open.dxf"]) == 2
    assert "closed outline" in capsys.readouterr().err
    assert not (tmp_path / "open").exists() and not (tmp_path / "b").exists()


def test_an_outline_that_crosses_itself_is_refused(tmp_path: Path) -> None:
    for name, path in (("equal", "M0 0 L5 5 L5 0 L0 5 Z"), ("unequal", "M0 0 L5 5 L5 0 L0 3 Z")):
        head = '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9">'
        (tmp_path / f"{name}.svg").write_text(f'{head}<path id="A" d="{path}"/></svg>')
        with pytest.raises(NothingToPropose, match="cross"):
            propose([tmp_path / f"{name}.svg"])


@needs(PIN_LEVER)
def test_a_real_assembly() -> None:
    """A Swiss lever from a public CAD model: three parts that turn, two stops, stones against teeth, pin against fork."""
    proposal = propose([PIN_LEVER / "siconos_pin_lever_assembly.dxf"])
    assert [role.name for role in proposal.roles] == ["escape_wheel", "lever", "balance", "stop"]
    wanted = {
        ("escape_wheel.ESCAPE_WHEEL_z-1.30", "lever.PALLET_A"),
        ("escape_wheel.ESCAPE_WHEEL_z-1.30", "lever.PALLET_B"),
        ("lever.LEVER_z-1.20", "balance.BALANCE_z-1.10_IMPULSE"),
        ("lever.LEVER_z-1.20", "stop.STOP_A"),
        ("lever.LEVER_z-1.20", "stop.STOP_B"),
    }
    assert wanted <= set(proposal.contacts)


def gives_a_scene_or_one_refusal(path: Path) -> None:
    try:
        assert "scene.toml" in propose([path]).files
    except NothingToPropose as error:
        assert str(error)


@pytest.mark.slow
@needs(DRAWINGS / "dxf")
def test_no_drawing_brings_it_down() -> None:
    for path in sorted([*DRAWINGS.glob("dxf/*"), *DRAWINGS.glob("svg/*")]):
        gives_a_scene_or_one_refusal(path)


@pytest.mark.parametrize("path", OURS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_no_drawing_of_our_own_brings_it_down(path: Path) -> None:
    """Single parts of mechanisms, and drawings with faults."""
    gives_a_scene_or_one_refusal(path)


BARE = {  # layers named after features alone, or not at all: parts by profile, each with its layers and its task
    "cam": {("CAM",): "driver", ("END", "SHAFT"): "click"},
    "detent": {
        ("TEETH",): "wheel",
        ("BAR", "HORN", "HUB", "STONE"): "lever",
        ("LEAF",): "passing",
        ("DISCHARGE", "IMPULSE_STONE", "RIM", "ROLLER", "TABLE"): "oscillator",
        ("SCREW",): "fixed",
    },
    "jumper": {("ARM#1", "HUB#1", "PIN"): "driver", ("ARM#1", "BEAK", "FOOT"): "click", ("HUB#1", "STAR"): "wheel"},
    "geneva_stop": {("DISC", "PIN", "PLATE"): "driver", ("CROSS",): "wheel"},
    "duplex": {("IMPULSE", "RESTING"): "wheel", ("PALLET", "RIM", "ROLLER"): "oscillator"},
    "pin_wheel": {("PINS", "RIM"): "wheel", ("ANCHOR", "BOB", "PALLETS", "ROD"): "oscillator"},
    "cylinder": {("RIM", "TEETH"): "wheel", ("BALANCE", "SHELL"): "oscillator"},
}


@pytest.mark.parametrize("name", few(BARE, lambda name: name != "pin_wheel"))
def test_bare_names_give_way_to_geometry(name: str, tmp_path: Path) -> None:
    """Teeth make a wheel, a pin beside the pivot a driver, and a stone belongs to what it lies in."""
    found = propose([assembly(scene_of(name), tmp_path / f"{name}.dxf")])
    assert {tuple(sorted(role.part.layers)): role.task for role in found.roles} == BARE[name]


def test_a_rim_over_the_lever_takes_nothing_of_it(tmp_path: Path) -> None:
    """The balance runs round the pivot of the lever: what lies under it may be the lever's, such as its impulse stone."""
    found = propose([assembly(scene_of("coaxial"), tmp_path / "coaxial.dxf")])
    (lever,) = (role for role in found.roles if role.task == "lever")
    (balance,) = (role for role in found.roles if role.task == "oscillator")
    # Each has a stone on the layer IMPULSE_STONE, which is parted in two.
    assert all(any(layer.startswith("IMPULSE_STONE") for layer in role.part.layers) for role in (lever, balance))
    assert "RIM" in balance.part.layers


def test_drawings_without_units_have_one_and_the_same(tmp_path: Path) -> None:
    """A wheel of 0.998 and its pawl of 0.31 across: alone the one is likely in millimetres, the other in inches."""
    star = [(r * math.cos(math.tau * k / 23), r * math.sin(math.tau * k / 23)) for k in range(23) for r in (0.44, 0.5)]
    shapes = {"spool": (star, (0.0, 0.0, 0.06)), "pawl": ([(0.1, 0.7), (0.2, 0.6), (-0.09, 0.45)], (0.14, 0.6, 0.02))}
    paths = []
    for name, (corners, bore) in shapes.items():
        document = ezdxf.new("R12")
        document.modelspace().add_polyline2d(corners, close=True, dxfattribs={"layer": name.upper()})
        document.modelspace().add_circle(bore[:2], bore[2], dxfattribs={"layer": "PIVOT"})
        paths.append(tmp_path / f"{name}.dxf")
        document.saveas(paths[-1])
    found = propose(paths)
    assert [guess.value for guess in found.guesses if guess.key.endswith(".units")] == ['"mm"', '"mm"']
    assert not any("side by side" in doubt for doubt in found.doubts)
