"""Does a run begin in contact where bodies touch within rounding, and is it refused where they overlap by more?"""

from __future__ import annotations

import dataclasses
import math
import sys
from pathlib import Path

import pytest
from moving_scenes import box, circle, profile

from watchsim.cli import main
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.body import Body
from watchsim.scene.errors import SceneError
from watchsim.scene.file.load import load
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop
from watchsim.tolerances import DRAWING_ROUNDING

sys.path.append(str(Path(__file__).resolve().parents[1] / "drawing"))
import dxf_text as d

MM = 1e-3
GRAVITY = (0.0, -9.81)
DEPTHS = (0.0, 1e-13, 3e-12, 2e-11, 1e-10, 4e-10, 1.2e-9, 1.9e-9)  # m, all within the rounding of drawings
TOLERANCES = (1e-12, 1e-9, 1e-5)


def on_the_ground(loops: tuple[Loop, ...], height: float, ground: tuple[Loop, ...], tolerance: float) -> Scene:
    bodies = (
        Body("ground", "fixed", loops=ground),
        Body("thing", "free", (0.0, height), mass=1e-3, inertia=1e-10, loops=loops),
    )
    contact = Contact((Side("ground"), Side("thing")), friction=0.1)
    return Scene("start", bodies, contacts=(contact,), gravity=GRAVITY, duration=0.02, tolerance=tolerance)


GROUND = (box(20 * MM, 2 * MM, (0.0, -1 * MM)),)
FACE = (Loop((Line(10 * MM, 0.0, -10 * MM, 0.0),), closed=False),)
BOWL = (Loop((Arc(0.0, 5 * MM, 5 * MM, 1.2 * math.pi, 0.6 * math.pi).reversed(),), closed=False),)
TIP = (Loop((Line(0.0, -1 * MM, 1 * MM, 1 * MM), Line(1 * MM, 1 * MM, -1 * MM, 1 * MM), Line(-1 * MM, 1 * MM, 0.0, -1 * MM))),)
STANDING = {
    "flat on flat": ((box(2 * MM, 2 * MM),), GROUND),
    "disc on flat": ((circle(1 * MM),), GROUND),
    "tip on flat": (TIP, GROUND),
    "disc on an open face": ((circle(1 * MM),), FACE),
    "disc in an open bowl": ((circle(1 * MM),), BOWL),
}


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("name", STANDING)
def test_what_touches_within_rounding_rests_there(name: str, tolerance: float) -> None:
    """A window between what is taken for a contact and what is refused would let the thing fall."""
    loops, ground = STANDING[name]
    fallen = {}
    for depth in DEPTHS:
        done = simulate(on_the_ground(loops, 1 * MM - depth, ground, tolerance))
        assert done.stop == Stop.DURATION
        fallen[depth] = done.q[-1, 1] - 1 * MM
        assert done.worst_penetration >= 0.99 * depth - 1e-15
    # Free fall would come to 2 mm.
    assert max(map(abs, fallen.values())) < 1e-8, fallen


@pytest.mark.parametrize("name", STANDING)
def test_deeper_is_refused_in_python_as_on_the_command_line(name: str) -> None:
    loops, ground = STANDING[name]
    for depth in (2.5e-9, 1e-8, 1e-6, 1e-4):
        scene = on_the_ground(loops, 1 * MM - depth, ground, 1e-9)
        with pytest.raises(SceneError, match=r"overlap by .* mm at the start"):
            simulate(scene)
        (found,) = overlaps(scene)
        assert found.depth == pytest.approx(depth, rel=0.02, abs=3e-10)


@pytest.mark.parametrize("steps", [400, 40])
def test_no_depth_falls_between_touching_and_refused(steps: int) -> None:
    """A tip on a flat, depth by depth across the rounding."""
    scenes = [
        on_the_ground(TIP, 1 * MM - 2.0 * DRAWING_ROUNDING * k / steps, GROUND, 1e-9) for k in range(0, steps, steps // 40)
    ]
    seen = []
    for scene in scenes:
        try:
            done = simulate(scene, 1e-3)
        except SceneError:
            seen.append(False)
            continue
        assert abs(done.q[-1, 1] - 1 * MM) < 1e-10
        seen.append(True)
    assert seen == sorted(seen, reverse=True) and True in seen and False in seen


@pytest.mark.parametrize("angle", ["5.000001°", "5.00001°", "5.00004°"])
def test_the_swiss_lever_stays_in_its_banking(angle: str) -> None:
    done = simulate(profile("swiss_lever").set("bodies.lever.angle", angle), 0.1)
    assert abs(done.q[:, done.slices["lever"]]).max() < math.radians(5.0001)
    assert done.counts["impacts"] > 30


def test_the_swiss_lever_in_its_banking_is_refused() -> None:
    with pytest.raises(SceneError, match="lever and banking overlap by 4"):
        simulate(profile("swiss_lever").set("bodies.lever.angle", "5.0001°"), 0.1)


def test_a_tooth_within_rounding_of_its_locking_face_does_not_pass_the_pallet() -> None:
    for angle in ("-0.28652°", "-0.28654°"):
        done = simulate(profile("swiss_lever").set("bodies.wheel.angle", angle), 0.02)
        assert abs(done.q[-1, 0]) < math.radians(1.0)


def test_moreau_begins_in_the_same_place() -> None:
    scene = profile("swiss_lever").set("bodies.lever.angle", "5.00001°")
    done = simulate(scene, 0.02, method="moreau", step=1e-5)
    assert abs(done.q[:, done.slices["lever"]]).max() < math.radians(5.01)


def test_a_resumed_run_is_never_refused() -> None:
    """Where the run was cut bodies may touch as they like."""
    scene = profile("swiss_lever").set("bodies.lever.angle", "5.00001°")
    first = simulate(scene, 0.05)
    whole, parts = simulate(scene, 0.1), simulate(scene, 0.1, start=first)
    assert (whole.q[-1] == parts.q[-1]).all()


def test_a_carried_body_is_freed_too() -> None:
    """The arm hangs on a carriage that turns; the stop belongs to the carriage's frame."""
    bodies = (
        Body("carriage", "pivot", angle=0.7, inertia=1e-6),
        Body("stop", "fixed", on="carriage", loops=(box(1 * MM, 1 * MM, (3 * MM, -0.5 * MM)),)),
        Body(
            "arm",
            "pivot",
            (-4e-13, -4e-10),
            on="carriage",
            inertia=1e-9,
            mass=1e-4,
            loops=(box(8 * MM, 1 * MM, (0, 0.5 * MM)),),
        ),
    )
    scene = Scene(
        "carried",
        bodies,
        torques=(Torque("arm", -1e-9),),
        contacts=(Contact((Side("arm"), Side("stop"))),),
        duration=0.05,
    )
    done = simulate(scene)
    assert done.stop == Stop.DURATION
    assert abs(done.q[:, done.slices["arm"]]).max() < 1e-6


SCENE = """
[scene]
[bodies.plate]
drawing = "plate.dxf"
motion = "fixed"
[bodies.pin]
circle = "{radius} mm"
motion = "free"
mass = "1 g"
[[contacts]]
between = ["plate", "pin"]
"""


@pytest.mark.parametrize("radius, words", [("1", "same radius"), ("1.00001", "plate and pin overlap by 1e-05 mm")])
def test_check_and_run_refuse_what_python_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], radius: str, words: str
) -> None:
    (tmp_path / "plate.dxf").write_bytes(d.dxf(d.circle(0, 0, 1) + d.circle(0, 0, 5)))
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(radius=radius), encoding="utf-8")
    with pytest.raises(SceneError, match=words):
        simulate(load(scene), 0.01)
    assert main(["check", str(scene)]) == 2
    assert words in capsys.readouterr().out
    assert main(["run", str(scene), "-o", str(tmp_path / "out"), "--duration", "0.01 s"]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_what_is_wedged_in_is_refused_by_name() -> None:
    """Between two walls that are nearer to each other than it is wide, no place is free."""
    walls = (box(2 * MM, 6 * MM, (-2 * MM + 3e-10, 0.0)), box(2 * MM, 6 * MM, (2 * MM - 3e-10, 0.0)))
    bodies = (
        Body("walls", "fixed", loops=walls),
        Body("block", "free", mass=1e-3, inertia=1e-10, loops=(box(2 * MM, 2 * MM),)),
    )
    scene = Scene("wedged", bodies, contacts=(Contact((Side("walls"), Side("block"))),), duration=0.01)
    with pytest.raises(SceneError, match=r"block .* wedged in"):
        simulate(scene)


def test_an_arc_in_a_hollow_of_its_own_radius_is_refused_where_they_touch() -> None:
    """No gap function tells where such a pair touches, so the pin would fall through the plate."""
    hole = Loop((Arc(0.0, 0.0, 1 * MM, 0.0, -2.0 * math.pi),), hole=True)
    bodies = (
        Body("plate", "fixed", loops=(box(6 * MM, 6 * MM), hole)),
        Body("pin", "free", mass=1e-3, inertia=1e-10, loops=(circle(1 * MM),)),
    )
    scene = Scene("tight", bodies, contacts=(Contact((Side("plate"), Side("pin"))),), gravity=GRAVITY, duration=0.01)
    with pytest.raises(SceneError, match="same radius"):
        simulate(scene)
    loose = dataclasses.replace(bodies[1], loops=(circle(0.999 * MM),))
    assert simulate(dataclasses.replace(scene, bodies=(bodies[0], loose))).stop == Stop.DURATION


def test_two_bars_that_cross_overlap_though_no_corner_lies_in_the_other() -> None:
    bodies = (
        Body("a", "fixed", loops=(box(10 * MM, 1 * MM),)),
        Body("b", "free", mass=1e-3, inertia=1e-10, loops=(box(1 * MM, 10 * MM),)),
    )
    scene = Scene("cross", bodies, contacts=(Contact((Side("a"), Side("b"))),), duration=0.01)
    with pytest.raises(SceneError, match="a and b overlap"):
        simulate(scene)
