"""Does a run begin in contact where bodies touch within rounding, and are overlaps taken back or refused?"""

import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace

import dxf_text as d
import numpy as np
import pytest
from moving_scenes import box, circle, profile

from watchsim.cli import main
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.overlap import overlaps
from watchsim.model import Model
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Contact, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import start as overlap_removal
from watchsim.simulation.simulate import simulate
from watchsim.simulation.start import directions, overlapping_rows, taken_back_from
from watchsim.simulation.state import Stop
from watchsim.tolerances import DRAWING_ROUNDING

# Does a run begin in contact where bodies touch within rounding, and is it refused where they overlap by more?

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
        "carried", bodies, torques=(Torque("arm", -1e-9),), contacts=(Contact((Side("arm"), Side("stop"))),), duration=0.05
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


# Which overlaps are taken back at the start, and by the smallest change that does it?

OPTIONS = SimpleNamespace(extent=1e-3, gap_zero=1e-9, size=2.0)


def outline(count: int, corners: tuple[int, ...]) -> np.recarray:
    """A closed chain of primitives, each with the one before and after it."""
    rows = np.zeros(count, [("before", "i8"), ("after", "i8"), ("corner", "i8")]).view(np.recarray)
    rows.before, rows.after = np.roll(np.arange(count), 1), np.roll(np.arange(count), -1)
    rows.corner[list(corners)] = 1
    return rows


def contacts(gaps: list[float], margins: list[float], met: list[int], circles: list[int]) -> tuple[Model, SimpleNamespace]:
    made = SimpleNamespace(
        contacts=np.rec.fromarrays([circles, met], names="a,b"), primitives=outline(20, ()),
    )  # fmt: skip
    kin = SimpleNamespace(g=np.array(gaps), margin=np.array(margins))
    return made, SimpleNamespace(kin=kin)  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("gap", "margin", "counts"),
    [(-1.1e-6, 0.0, True), (-0.9e-6, 0.0, False), (-0.9e-4, -0.9e-3, True), (-1.1e-4, 0.0, False), (-1e-5, -1.1e-3, False)],
)
def test_an_overlap_counts_between_the_least_and_what_is_near_and_within_its_primitives(
    gap: float, margin: float, counts: bool
) -> None:
    model, closed = contacts([0.5, gap], [0.0, margin], [3, 9], [30, 31])
    assert overlapping_rows(model, closed, OPTIONS, 1e-4, 1e-6).tolist() == ([1] if counts else [])


@pytest.mark.parametrize(
    ("other", "circle", "gap", "margin", "counts"),
    [
        (6, 30, -1e-6, 0.0, False),  # beside it, less deep: this one is the back of the corner
        (7, 30, 1e-6, 0.0, False),
        (3, 30, -1e-6, 0.0, False),
        (8, 30, -1e-6, 0.0, True),  # further along the outline
        (6, 31, -1e-6, 0.0, True),  # another circle
        (6, 30, -2e-5, 0.0, True),  # deeper: the other one is the back
        (6, 30, -1e-6, -2e-3, True),  # outside its primitives
    ],
)
def test_the_back_of_a_corner_does_not_count(other: int, circle: int, gap: float, margin: float, counts: bool) -> None:
    model, closed = contacts([-1e-5, gap], [0.0, margin], [5, other], [30, circle])
    assert (0 in overlapping_rows(model, closed, OPTIONS, 1e-4, 1.5e-6).tolist()) == counts


def test_directions_over_coordinates_add_up_what_acts_on_the_same_one() -> None:
    closed = SimpleNamespace(ids=[0, 1], slots=[2, 3], coord=np.array([[0, 2, 9], [1, 1, 3]]))
    sparse = np.array([[1.0, 2.0, 9.0], [3.0, 4.0, 5.0]])
    assert directions(closed, sparse, 4).tolist() == [[1.0, 0.0, 2.0, 0.0], [0.0, 7.0, 0.0, 5.0]]


def removed(gap: float, slope: float, near: float, tangent: float = 0.0, mass: float = 4.0) -> float | None:
    """The place at which a body that overlaps at 0 by -gap is put, its gap growing with that slope; None where it is not."""

    def at(model, q):
        kin = SimpleNamespace(g=np.array([gap + slope * float(q[0])]), margin=np.zeros(1))
        slots = {"slots": [1], "coord": np.zeros((1, 1), int)}
        return SimpleNamespace(ids=[0], kin=kin, w_N=np.array([[slope]]), w_T=np.array([[tangent]]), **slots)

    coordinates = SimpleNamespace(mass=np.array([mass]), scale=np.array([2.0]))
    model = SimpleNamespace(
        contacts=np.rec.fromarrays([[30], [5]], names="a,b"), primitives=outline(20, ()), coordinates=coordinates
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(overlap_removal, "kinematics_at", at)
        found = taken_back_from(model, np.zeros(1), OPTIONS, near)
    return None if found is None else float(found[0])


def test_an_overlap_is_taken_back_to_zero() -> None:
    assert removed(-1e-4, 2.0, 1e-3) == pytest.approx(0.5e-4)
    assert removed(-1e-4, -0.5, 1e-3) == pytest.approx(-2e-4)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_ten_times_the_gap_that_is_zero_may_be_left(share: float) -> None:
    assert (removed(-share * 10.0 * 1e-9, 1.0, 1e-3) == 0.0) == (share < 1.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_nothing_is_moved_further_than_fifty_times_what_is_near(share: float) -> None:
    near = 1e-3
    assert (removed(-near, near / (share * 50.0 * near), near) is None) == (share > 1.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_what_hardly_moves_across_is_left_as_it_is(share: float) -> None:
    """A millionth of how it moves along the face."""
    found = removed(-1e-12 - 1e-7, share * 1e-6, 1e-2, tangent=1.0)
    assert (found == 0.0) == (share < 1.0)


@pytest.mark.parametrize(("gap", "margin", "heeded"), [
    (0.0, 0.0, True), (0.9e-3, 0.0, True), (1.1e-3, 0.0, False), (0.0, -0.9e-3, True), (0.0, -1.1e-3, False),
    (0.5e-3, 0.9e-3, True),
])  # fmt: skip
def test_what_touches_from_outside_is_not_pushed_into(gap: float, margin: float, heeded: bool) -> None:
    """Near, and within its primitives: 2 x + y takes the overlap back, x closes the other gap."""

    def at(model, q):
        x, y = q
        kin = SimpleNamespace(g=np.array([-1e-3 + 2.0 * x + y, gap - x]), margin=np.array([0.0, margin]))
        ways = np.array([[2.0, 1.0], [-1.0, 0.0]])
        return SimpleNamespace(ids=[0, 1], kin=kin, w_N=ways, w_T=0.0 * ways, slots=[2, 2], coord=np.array([[0, 1], [0, 1]]))

    coordinates = SimpleNamespace(mass=np.ones(2), scale=np.full(2, 2.0))
    model = SimpleNamespace(
        contacts=np.rec.fromarrays([[30, 31], [5, 9]], names="a,b"), primitives=outline(20, ()), coordinates=coordinates
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(overlap_removal, "kinematics_at", at)
        found = taken_back_from(model, np.zeros(2), OPTIONS, 1e-3)
    assert found is not None
    most = min(gap, 0.4e-3) if heeded else 0.4e-3  # alone, x is twice y
    assert found == pytest.approx([most, 1e-3 - 2.0 * most], abs=1e-9)
