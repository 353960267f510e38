"""Does the judge tell a wrong motion from a right one, and one that cannot be known better?"""

import math
from dataclasses import replace

import hunt_path
import numpy as np
import pytest
from every_time import few
from hunt import witness
from hunt.books import Touches, faults, masses, potential, pulls, touching
from hunt.generate import mechanism
from hunt.hunt_mechanisms import judged_file
from hunt.judge import Judge, judged, merged
from hunt.open_motion import grazed, open_accelerations, open_motion
from hunt.parts import GRAVITY, Material, box, circle, fixed, free, pivoted, sliding
from hunt.pool import answers
from hunt.views import made, resumed, views

from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop

# Does the judge tell a wrong motion from one that cannot be known better?


def two_discs(restitution: float = 0.5) -> Scene:
    bodies = (sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02), sliding("b", circle(5e-3), (20e-3, 1e-3), 0.0, 0.0, 0.03))
    return Scene("discs", bodies, contacts=(Contact((Side("a"), Side("b")), 0.0, restitution),), duration=0.04)


def cradle() -> Scene:
    """Three blocks in line, the last two a nanometre apart: another gap, another outcome."""
    bodies = [sliding("a", box(0.01, 0.01), (-0.02, 0.0), 0.0, 1.0, 0.02)]
    bodies += [sliding(name, box(0.01, 0.01), (x, 0.0), 0.0, 0.0, 0.02) for name, x in (("b", 0.0), ("c", 0.010000001))]
    pairs = (("a", "b"), ("b", "c"))
    return Scene(
        "cradle", tuple(bodies), contacts=tuple(Contact((Side(a), Side(b)), 0.0, 0.6) for a, b in pairs), duration=0.03
    )


def test_fine():
    verdict = judged(two_discs(), 1, with_witness=True)
    assert (verdict.kind, verdict.reasons) == ("fine", [])


class Spoilt(Judge):
    """A solver whose speeds in one orientation, or at one tolerance, come out otherwise by a share."""

    def __init__(self, scene: Scene, share: float, tolerance: float | None) -> None:
        super().__init__(scene, 1)
        self.times = self.times[4::5]
        self.share, self.only = share, tolerance

    def motion(self, run, view=None, times=None):
        spoils = (run.tolerance == self.only) if self.only else (view is not None and view.mirrored)
        return super().motion(run, view, times) * (1.0 + self.share * spoils)


@pytest.mark.parametrize("tolerance", [None, 1e-11])
@pytest.mark.parametrize(("share", "wrong"), [(0.0, False), (1e-9, False), (1e-5, True)])
def test_one_run_that_differs(share, wrong, tolerance):
    verdict = Spoilt(two_discs(), share, tolerance).judge(with_witness=False)
    assert [reason.split(":")[0] for reason in verdict.reasons] == ["disagrees"] * wrong


def test_witness_contradicts_a_motion_that_is_alike_everywhere():
    """The event-driven runs of a scene with another restitution than that which the witness sees."""

    class Other(Judge):
        def run(self, scene, tolerance, prefilter=False):
            return super().run(replace(scene, contacts=two_discs(0.9).contacts), tolerance, prefilter)

    verdict = Other(two_discs(0.1), 1).judge(with_witness=True)
    assert [reason.split(":")[0] for reason in verdict.reasons] == ["witness"]


def test_impacts_in_turn_that_a_coarse_run_takes_for_one():
    run = simulate(cradle())
    assert merged(run, 1e-8, 0.03)
    assert not merged(run, 1e-10, 0.03)
    assert not merged(run, 1e-8, 0.001)
    assert not judged(cradle(), 1).reasons


@pytest.mark.slow
def test_sensitive_motion_is_not_wrong():
    """A ball between round posts forgets its start: one part in 10⁷ decides after a dozen impacts."""
    ball = mechanism(7, 2, "boxed").bodies[-1]
    bodies = [replace(ball, motion="free", position=(0.0, 0.0013), velocity=(0.9, 0.31, 0.0), loops=(circle(2e-3),))]
    places = [(x * 7e-3 + 3.5e-3 * (y % 2), y * 6e-3) for x in range(-2, 3) for y in range(-2, 3) if (x, y) != (0, 0)]
    bodies += [fixed(f"post{k}", circle(2e-3), position=place) for k, place in enumerate(places)]
    contacts = tuple(Contact((Side(ball.name), Side(b.name)), 0.0, 1.0) for b in bodies[1:])
    verdict = judged(Scene("posts", tuple(bodies), contacts=contacts, duration=0.1), 1)
    assert verdict.reasons == []
    assert verdict.runs > 5
    assert verdict.judged < 0.9


def test_worker_that_dies_does_not_end_the_hunt():
    def work(number: int) -> int:
        if number == 2:
            raise SystemExit(1)
        return 10 * number

    assert dict(answers(range(5), work, 2)) == {0: 0, 1: 10, 2: None, 3: 30, 4: 40}


def test_views_are_not_the_scene():
    scene = two_discs()
    turned = Judge(scene, 1)
    runs = [turned.run(view.of(scene), 1e-9) for view in views(scene, 1, 2)]
    assert all(not np.allclose(run.scene.bodies[0].axis, (1.0, 0.0)) for run in runs)


def test_steps_part_what_bodies_in_touch_pass_on_at_once():
    """The second and third block touch from the start: the impact on one goes through both."""
    apart = cradle()
    third = replace(apart.bodies[2], position=(0.01, 0.0))
    assert witness.merged(simulate(replace(apart, bodies=(*apart.bodies[:2], third))), 0.03, 0.0)
    assert not witness.merged(simulate(two_discs()), 0.04, 1e-3)


# Does the judge's bookkeeping see what is wrong with a run, and nothing where all is right?


def two_discs_books() -> Scene:
    bodies = (sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02), sliding("b", circle(5e-3), (20e-3, 1e-3), 0.0, 0.0, 0.03))
    return Scene("discs", bodies, (Spring("b", 20.0),), contacts=(Contact((Side("a"), Side("b")), 0.0, 0.7),), duration=0.04)


def falling_block() -> Scene:
    floor = fixed("floor", box(0.1, 0.01, (0.0, -0.005)))
    block = free("block", box(0.01, 0.01), (0.0, 0.02), 0.05, 0.3, (0.1, 0.0, 3.0))
    return Scene(
        "block", (floor, block), contacts=(Contact((Side("floor"), Side("block")), 0.4, 0.3),), gravity=GRAVITY, duration=0.15
    )


def pendulum() -> Scene:
    hung = pivoted("p", box(0.02, 0.02, (0.0, -0.1)), (0.0, 0.0), 0.5, mass=0.1)
    stop = fixed("stop", box(0.02, 0.02, (-0.021, -0.1)))
    return Scene(
        "pendulum", (hung, stop), contacts=(Contact((Side("p"), Side("stop")), 0.2, 0.9),), gravity=GRAVITY, duration=0.5
    )


@pytest.mark.parametrize("make", [two_discs_books, falling_block, pendulum])
def test_nothing_wrong(make):
    scene = make()
    run = simulate(scene)
    assert (run.events["energy_lost"] > 0.0).any()
    assert list(faults(run, Material(scene))) == []


def classes(run):
    return {fault.split(":")[0] for fault in faults(run, Material(run.scene))}


def last_impact(run):
    """The rows before and after the last jump of velocity."""
    row = int(np.flatnonzero(np.diff(run.t) == 0.0)[-1])
    return row, row + 1


def slowed(run, factor):
    """All velocities after the last impact times a factor."""
    u = run.u.copy()
    u[last_impact(run)[1] :] *= factor
    return replace(run, u=u)


def displaced(run, first, column, by):
    q = run.q.copy()
    q[first:, column] += by
    return replace(run, q=q)


def without_its_impact(run):
    return replace(run, events=run.events[run.events["t"] != run.t[last_impact(run)[0]]])


SPOILT = {  # class of the fault: the mechanism, and what is done to its run
    "impulse": (two_discs_books, lambda run: slowed(run, 0.0)),  # takes energy, as impacts may, but no pushing impulse does it
    "jump": (two_discs_books, without_its_impact),
    "energy": (pendulum, lambda run: slowed(run, 1.5)),
    "residual": (pendulum, lambda run: replace(run, energy={**run.energy, "residual_J": 1e-3})),
    "overlap": (falling_block, lambda run: displaced(run, 0, 1, -1e-5)),
    "shift": (falling_block, lambda run: displaced(run, last_impact(run)[1], 0, 1e-7)),
    "gave up": (pendulum, lambda run: replace(run, stop=Stop.TOO_MANY_EVENTS)),
}


@pytest.mark.parametrize("fault", SPOILT)
def test_what_is_spoilt_is_named(fault):
    make, spoil = SPOILT[fault]
    assert fault in classes(spoil(simulate(make())))


def test_energy_of_a_pendulum_is_that_of_its_fall():
    """From rest at 0.5 rad to the bottom: J ω²/2 = m g l (1 - cos 0.5)."""
    scene = pendulum()
    scene = replace(scene, bodies=scene.bodies[:1], contacts=())
    run = simulate(scene)
    inertia = 0.1 * (0.1**2 + (0.02**2 + 0.02**2) / 12.0)
    fastest = np.abs(run.sample(np.linspace(0.0, 0.5, 20001))[1]).max()
    assert math.isclose(0.5 * inertia * fastest**2, 0.1 * 9.81 * 0.1 * (1.0 - math.cos(0.5)), rel_tol=1e-6)
    assert list(faults(run, Material(scene))) == []


@pytest.mark.parametrize("make", [two_discs_books, falling_block, pendulum])
def test_pulls_are_the_slope_of_the_potential(make):
    scene = make()
    run = simulate(scene)
    row, step = len(run.t) // 2, 1e-6
    for k in range(run.q.shape[1]):
        q = np.repeat(run.q[:1], 2, axis=0)
        q[:] = run.q[row]
        q[0, k] -= step
        q[1, k] += step
        low, high = potential(scene, replace(run, q=q, t=run.t[:2]))
        assert pulls(scene, run, row)[k] == pytest.approx((low - high) / (2.0 * step), rel=1e-6, abs=1e-9)


def test_dead_stop_at_the_end_of_impacts():
    """What the contact forces do until then explains a small jump, never a fast body's stop."""
    run = simulate(load(hunt_path.ROOT / "tests" / "data" / "hunt" / "blocks-801-570.toml"))
    assert "impulse" not in classes(run)
    ended = run.events[run.events["kind"] == EventKind.ACCUMULATION]
    (row,) = np.flatnonzero((run.t[:-1] == ended["t"][0]) & (np.diff(run.t) == 0.0))
    u = run.u.copy()
    u[: row + 1] *= 10.0
    assert "impulse" in classes(replace(run, u=u))


# Does the judge tell a graze, which a run may make or miss, from a slow impact, which it must make?

SPEED, PULL, MASS = 3e-4, 1.0, 0.02
DEPTH = 0.5 * SPEED**2 * MASS / PULL  # how far the block would come beyond the other's face: 0.9 nm
TIMES = np.linspace(0.0, 0.02, 11)


def approach(pull: float):
    """A block reaches another one after 10 ms slowly, pulled back (or pushed on) by a force."""
    ahead = SPEED * 0.01 + 0.5 * pull / MASS * 0.01**2  # with the speed at the start, backwards in time
    bodies = (
        sliding("a", box(0.01, 0.01), (-0.01 - ahead, 0.0), 0.0, SPEED + pull / MASS * 0.01, MASS),
        sliding("b", box(0.01, 0.01), (0.0, 0.0), 0.0, 0.0, MASS),
    )
    scene = Scene(
        "blocks", bodies, torques=(Torque("a", -pull),), contacts=(Contact((Side("a"), Side("b")), 0.0, 0.0),), duration=0.02
    )
    run = simulate(scene)
    assert run.events["value"][0] == pytest.approx(-SPEED, rel=1e-3)
    return run


def test_a_gap_that_opens_again():
    run = approach(PULL)
    moved = grazed(run, 1.1 * DEPTH, np.ones(2), TIMES)
    # The plastic impact gives each block half of the speed.
    assert moved == pytest.approx(0.5 * SPEED * np.maximum(TIMES - 0.01, 0.0), rel=1e-3, abs=1e-9)
    assert not grazed(run, 0.2 * DEPTH, np.ones(2), TIMES).any()


def test_a_gap_that_does_not():
    assert not grazed(approach(-3e-4), 3.0 * DEPTH, np.ones(2), TIMES).any()


# Does the judge find where outlines touch, and which jumps of velocity their impulses can make?


@pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, 4.0])
def test_disc_against_disc(angle):
    c, s = math.cos(angle), math.sin(angle)
    first, second = [Arc(5.0 * c, 5.0 * s, 2.0, 0.3, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 1.0, 2.0 * math.pi)]
    points = list(touching(first, second, 1e-9))
    assert points
    for point, normal in points:
        assert point == pytest.approx((3.0 * c, 3.0 * s))
        assert normal == pytest.approx((c, s))


def test_disc_in_a_hollow():
    points = list(touching([Arc(0.0, -2.0, 1.0, 0.0, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 0.0, -math.pi)], 1e-9))
    assert [(tuple(np.round(p, 12)), tuple(np.round(n, 12))) for p, n in points] == [((0.0, -3.0), (0.0, 1.0))]


def test_disc_beside_an_arc_does_not_touch_it():
    assert not list(touching([Arc(0.0, 2.0, 1.0, 0.0, 2.0 * math.pi)], [Arc(0.0, 0.0, 3.0, 0.0, -math.pi)], 1e-9))


def test_corner_on_a_line():
    corner = [Line(1.0, 0.0, 2.0, 1.0), Line(0.0, 1.0, 1.0, 0.0)]
    points = list(touching(corner, [Line(3.0, 0.0, -3.0, 0.0)], 1e-9))
    assert {point for point, _ in points} == {(1.0, 0.0)}
    assert {normal for _, normal in points} == {(0.0, 1.0)}


def scene(friction):
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("block", box(0.2, 0.1), (0.0, 0.05), 2.0))
    return Scene("block", bodies, contacts=(Contact((Side("floor"), Side("block")), friction, 0.0),))


@pytest.mark.parametrize(
    ("friction", "jump", "possible"),
    [
        (0.0, (0.0, 1.0, 0.0), True),  # thrown up
        (0.0, (0.0, -1.0, 0.0), False),  # pulled down
        (0.0, (0.1, 1.0, 0.0), False),  # pushed along without friction
        (0.5, (0.4, 1.0, 0.0), True),  # the couple of the friction is balanced by unequal loads of the two corners
        (0.5, (0.0, 1.0, 0.0), True),
        (0.2, (0.3, 1.0, 0.0), False),  # beyond the cone
    ],
)
def test_pushes_of_a_floor(friction, jump, possible):
    masses = np.array([2.0, 2.0, 2.0 * (0.2**2 + 0.1**2) / 12.0])
    share, points = Touches(scene(friction), {"block": slice(0, 3)}, masses, 1e-6).unexplained(
        np.array([0.0, 0.05, 0.0]), np.array(jump)
    )
    assert points >= 2
    assert (share < 1e-9) == possible


def test_rolling_disc_needs_friction_of_its_cone():
    """A disc of spin ω stopped from sliding: Δv = μ Δv_N, Δω = -μ m r Δv_N / J."""
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("disc", circle(0.1), (0.0, 0.1), 2.0))
    made = Scene("disc", bodies, contacts=(Contact((Side("floor"), Side("disc")), 0.3, 0.0),))
    inertia = 0.5 * 2.0 * 0.1**2
    masses, q = np.array([2.0, 2.0, inertia]), np.array([0.0, 0.1, 0.0])
    touches = Touches(made, {"disc": slice(0, 3)}, masses, 1e-6)
    push = 0.3
    assert touches.unexplained(q, np.array([push, 1.0, push * 2.0 * 0.1 / inertia]))[0] < 1e-9
    assert touches.unexplained(q, np.array([push, 1.0, -push * 2.0 * 0.1 / inertia]))[0] > 0.1
    assert touches.unexplained(q, np.array([0.35, 1.0, 0.35 * 2.0 * 0.1 / inertia]))[0] > 1e-2


@pytest.mark.parametrize("turn", [1e-7, 1e-3])
def test_turn_of_a_face_on_to_which_a_disc_slides(turn):
    """A disc that slides at v and is pulled on to a face that falls away by d gets v d across the floor, and no spin."""
    bodies = (fixed("floor", box(1.0, 0.2, (0.0, -0.1))), free("disc", circle(0.1), (0.0, 0.1), 2.0))
    made = Scene("disc", bodies, contacts=(Contact((Side("floor"), Side("disc")), 0.3, 0.0),))
    touches = Touches(made, {"disc": slice(0, 3)}, np.array([2.0, 2.0, 0.01]), 1e-6)
    q, before = np.array([0.0, 0.1, 0.0]), np.array([3.0, 0.0, 0.0])
    assert touches.turn(q, before, np.array([0.0, -3.0 * turn, 0.0])) == pytest.approx(turn, rel=1e-9)
    assert touches.turn(q, before, np.array([-3.0 * turn, 0.0, 0.0])) == math.inf
    assert touches.turn(q, np.zeros(3), np.array([0.0, -1.0, 0.0])) == math.inf


# Does the judge know how far Coulomb's law leaves a motion open?

SLOPE, BELOW, BETWEEN, LOWER, UPPER, G = 0.33, 0.3, 0.55, 0.05, 0.024, 9.81


def blocks(between: float) -> Scene:
    """Gravity leans, so that the slope is level."""
    bodies = (
        fixed("floor", box(0.2, 0.02, (0.0, -0.01))),
        free("lower", box(0.015, 0.009), (0.0, 0.0045), LOWER),
        free("upper", box(0.015, 0.009), (0.015, 0.0045), UPPER),
    )
    contacts = (
        Contact((Side("floor"), Side("lower")), BELOW, 0.0),
        Contact((Side("floor"), Side("upper")), 0.0, 0.0),
        Contact((Side("lower"), Side("upper")), between, 0.0),
    )
    gravity = (-G * math.sin(SLOPE), -G * math.cos(SLOPE))
    return Scene("blocks", bodies, contacts=contacts, gravity=gravity, duration=0.05)


@pytest.mark.parametrize("between", [BETWEEN, 0.0])
def test_blocks_side_by_side(between):
    scene = blocks(between)
    run = simulate(scene)
    row = len(run.t) // 2
    found = open_accelerations(run, row, Touches(scene, run.slices, masses(scene), 1e-6))
    alone = G * math.sin(SLOPE) - BELOW * LOWER * G * math.cos(SLOPE) / (LOWER + UPPER)
    share = BELOW * between * UPPER / (LOWER + UPPER)
    least, most = ((alone - way * share * G * math.sin(SLOPE)) / (1.0 - way * share) for way in (1.0, -1.0))
    assert least - 1e-6 <= -run.a[row, 0] <= most + 1e-6
    assert found[[0, 3]] == pytest.approx([most - least] * 2, abs=1e-6)
    assert np.abs(found[[1, 2, 4, 5]]).max() < 1e-4
    far = 0.5 * (most - least) * 0.05**2
    assert open_motion(run, 0.05, np.array([1.0, 1.0, 0.01] * 2)) == pytest.approx(far, abs=1e-8)


# Does the judge find nothing wrong any more with what the hunt once found?

KNOWN = sorted((hunt_path.ROOT / "tests" / "data" / "hunt").glob("*.toml"))
LONG = (  # half a second of processor time to ten each
    *("gears-3-7", "levers-2001-15091", "blocks-801-12218", "levers-801-17734", "wave-801-16576", "kink-801-11924"),
    *("blocks-2001-16485", "levers-801-2838", "row-801-10639", "pendulums-801-2071", "cam-20261124-500"),
)
SHORT = [path for path in KNOWN if path.stem not in LONG]


@pytest.mark.parametrize("path", few(KNOWN, lambda path: path in SHORT[::2]), ids=lambda path: path.stem)
def test_mended(path):
    verdict = judged_file(path)
    assert verdict.reasons == []


def test_there_are_scenes():
    assert len(SHORT) > len(LONG)


# Is what a description makes otherwise told from what unstable motion makes of rounding?


def pendulum_pieces(angle: float, duration: float) -> Scene:
    """A bar of 40 mm, its end at the pivot: λ² = 1.5 g/l."""
    bar = pivoted("bar", box(0.04, 1e-3).moved(0.0, (0.02, 0.0)), (0.0, 0.0), angle, mass=0.01)
    other = sliding("other", circle(1e-3), (0.1, 0.0), 0.0, 0.0, 0.01)
    return Scene("pendulum", (bar, other), gravity=(0.0, -9.81), duration=duration)


def discs(restitution: float = 0.5) -> Scene:
    """One slides along a spring and strikes a free one."""
    bodies = (sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02), free("b", circle(5e-3), (20e-3, 1e-3), 0.03))
    contacts = (Contact((Side("a"), Side("b")), 0.2, restitution),)
    return Scene("discs", bodies, (Spring("a", 5.0, 0.01),), contacts=contacts, duration=0.06)


@pytest.mark.parametrize("at", [0.005, 0.03])
def test_a_run_resumed_goes_on_as_it_did(at):
    """Before and after the impact; the slide has gone some way along its spring."""
    run = simulate(discs())
    row = int(np.searchsorted(run.t, at))
    scene, begun = resumed(run, row, 0.06)
    rest = simulate(scene)
    assert begun[0] == run.q[row, 0] != 0.0
    assert rest.q[-1] + begun == pytest.approx(run.q[-1], rel=1e-9, abs=1e-12)
    assert rest.u[-1] == pytest.approx(run.u[-1], rel=1e-8, abs=1e-10)


def test_growth_is_not_made():
    """Upright to rounding, which cosh λt multiplies by 10¹⁰."""
    scene = pendulum_pieces(math.pi / 2.0, 1.25)
    assert math.cosh(math.sqrt(1.5 * 9.81 / 0.04) * scene.duration) > 1e10
    judge, view = Judge(scene), views(scene, 3, 2)[1]
    judge.times = judge.times[3::4]
    base, other = judge.run(scene, 1e-9), judge.run(view.of(scene), 1e-9)
    apart = np.abs(judge.motion(base) - judge.motion(other, view)).max()
    assert apart > 3e-7
    assert made(judge, base, 1e-9, view)[-1] + made(judge, other, 1e-9)[-1] < 0.01 * apart


class Faulty(Judge):
    """A solver that takes another restitution in the mirrored scene: always, or only where it is run as a whole."""

    def __init__(self, always: bool) -> None:
        super().__init__(discs(), 1)
        self.times = self.times[4::5]
        self.view, self.always = views(self.scene, 1, 2)[1], always

    def run(self, scene, tolerance, prefilter=False):
        mirrored = scene.bodies[0].axis == self.view.of(self.scene).bodies[0].axis
        wrong = mirrored and (self.always or scene.duration == self.scene.duration)
        solved = replace(scene, contacts=discs(0.5001).contacts) if wrong else scene
        return replace(super().run(solved, tolerance, prefilter), scene=scene)


@pytest.mark.parametrize("always", few([True, False], 1))
def test_what_is_made_counts_in_full(always):
    judge = Faulty(always)
    base, other = judge.run(judge.scene, 1e-9), judge.run(judge.view.of(judge.scene), 1e-9)
    apart = np.abs(judge.motion(base) - judge.motion(other, judge.view)).max(axis=1)
    assert apart[-1] > 3e-7
    assert (made(judge, base, 1e-9, judge.view) + made(judge, other, 1e-9) >= 0.9 * apart).all()
    assert [reason.split(":")[0] for reason in judge.judge(with_witness=False).reasons] == ["disagrees"]
