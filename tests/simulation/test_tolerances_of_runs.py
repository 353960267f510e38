"""Are tolerances those of docs/theory/method.md, for a scene of any size and in any unit of length?"""

import dataclasses
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from every_time import few
from moving_scenes import profile

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge
from watchsim.jit import callable_kernel
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Damping
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import METHODS, MOREAU
from watchsim.simulation.options import longest_step, natural_step, options_for
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import NO_CONTACT, USUAL_STEP, EventKind, new_state

# Which tolerances and rooms has a run? Against the numbers of the method, for a scene of any size.


@pytest.mark.parametrize(("tolerance", "phase"), [
    (1e-9, 0.1), (1e-8, 0.1), (1e-10, 0.1 * 10.0**-0.2), (1e-12, 0.1 * 10.0**-0.6), (3e-14, 0.0125), (1e-13, 0.1 * 10.0**-0.8),
])  # fmt: skip
def test_rows_lie_closer_by_the_fifth_root_of_the_tolerance(tolerance: float, phase: float) -> None:
    assert options_for(1.0, tolerance, 0.125).row_phase == pytest.approx(phase, rel=1e-12)


def test_ways_of_stepping_have_names_and_a_usual_step() -> None:
    """Ten microseconds, as the manual says."""
    assert (METHODS, MOREAU, USUAL_STEP) == (("pfeiffer-glocker", "moreau"), "moreau", 1e-5)


def test_no_step_is_longer_than_a_quarter_of_the_fastest_period() -> None:
    """And none is longer than the scene's duration before that has passed."""

    def step(fastest: float, t: float = 0.0) -> float:
        compiled: Any = SimpleNamespace(fastest=fastest)
        return float(callable_kernel(longest_step)(options_for(1.0, 1e-9, 3.0, natural_step(compiled)), t))

    assert step(8.0) == pytest.approx(2.0 * math.pi / 8.0 / 4.0) == step(8.0, 100.0)
    assert step(0.1) == 3.0 == step(0.0) == step(0.0, 2.9)
    assert step(0.1, 4.0) == 4.0 and step(0.1, 100.0) == pytest.approx(5.0 * math.pi) and step(0.0, 100.0) == 100.0


def model(n: int = 3, bodies: int = 2, contacts: int = 5, pairs: int = 4) -> Any:
    fields = [("rest", "f8")]
    joints = np.zeros(2, [("watched", "i8"), ("coordinate", "i8"), ("on", "i8"), ("rest", "f8")]).view(np.recarray)
    joints.watched, joints.coordinate, joints.on, joints.rest = [0, 1], [0, 2], [1, 0], [9.0, 0.25]
    return SimpleNamespace(
        coordinates=np.full(n, 0.5).astype(fields).view(np.recarray), bodies=[None] * bodies, contacts=[None] * contacts,
        pairs=[None] * pairs, joints=joints,
    )  # fmt: skip


def a_state() -> Any:
    return new_state(model(), np.array([0.6, 0.4, 0.9]), np.array([-1.0, 2.0, -0.5]))


def test_a_run_begins_awake_with_an_event_and_knows_on_which_side_springs_are() -> None:
    """Rest at 0.5; the third coordinate is seen against the first one, from which it rests 0.25 away."""
    state = a_state()
    assert (state.q.tolist(), state.u.tolist(), state.a.tolist()) == ([0.6, 0.4, 0.9], [-1.0, 2.0, -0.5], [0.0] * 3)
    assert (state.instant.event_waits, state.instant.touched, state.instant.lenience) == (1, NO_CONTACT, 1.0)
    assert (state.returning.contact, state.clock.time, state.instant.awake_contacts) == (NO_CONTACT, 0.0, 0)
    assert (
        state.regime.awake.tolist() == [1] * 3
        and state.regime.grip.tolist() == [0] * 3
        and state.regime.mode.tolist() == [0] * 5
    )
    assert (len(state.regime.active), len(state.regime.upto), len(state.decided)) == (48, 48, 32)
    assert state.side_u.tolist() == [-1, 1, 1]  # -0.5 against -1
    assert state.side_q.tolist() == [1, -1, 1]  # 0.9 against 0.6 + 0.25


PROFILES = sorted(path.parent.name for path in profiles_dir().glob("*/scene.toml"))

# What is zero in a scene of a given size, at a given tolerance? The numbers of docs/theory/method.md, worked out.

SIZE = 3.0  # m


def test_lengths_and_speeds_go_with_the_size_of_the_scene() -> None:
    found = options_for(SIZE, 1e-9, 0.25)
    expected = {
        **{"tolerance": 1e-9, "gap_zero": 3e-13, "gap_close": 6e-10, "behind": 6e-8, "sunk": 6e-5, "extent": 3.6e-10},
        **{"speed_zero": 6e-8, "speed_rest": 3e-8, "speed_drift": 6e-8, "force_zero": 1e-10, "accumulation_time": 1e-6},
        **{"accumulation_speed": 0.3, "sleep": 1e-9, "row_phase": 0.1, "max_step": 0.25, "natural": math.inf, "size": SIZE},
        "ledger": 0.0,
    }
    assert found._asdict() == pytest.approx(expected, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("tolerance", "behind", "speed", "phase"),
    [
        (1e-13, 2e-8, 1e-8, 0.1 * 1e-4**0.2),
        (4e-10, 2e-8, 1e-8, 0.1 * 0.4**0.2),
        (6e-10, 2e-8, 1.2e-8, 0.1 * 0.6**0.2),
        (2e-9, 4e-8, 4e-8, 0.1),
        (1e-7, 2e-6, 2e-7, 0.1),
        (2e-6, 2e-5, 2e-7, 0.1),
    ],
)
def test_what_lies_behind_and_what_is_slow_goes_with_the_tolerance_within_limits(
    tolerance: float, behind: float, speed: float, phase: float
) -> None:
    found = options_for(SIZE, tolerance, 0.25)
    assert (found.behind / SIZE, found.speed_zero / SIZE, found.row_phase) == pytest.approx(
        (behind, speed, phase), rel=1e-12, abs=0.0
    )
    assert found.gap_close == pytest.approx(6e-10, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 3e-7, 1e-7])
@pytest.mark.parametrize("name", few(PROFILES, lambda name: name in ("geneva", "jumper", "verge")))
def test_a_coarse_tolerance_changes_no_conclusion(name: str, tolerance: float) -> None:
    """What counted as no slip grew with the tolerance: a verge passed over reversals, a jumper ended with `UNEXPLAINED`."""
    scene = profile(name)
    coarse, fine = (simulate(scene, min(3.0, scene.duration), tolerance=one) for one in (tolerance, 1e-10))
    assert coarse.stop == fine.stop
    assert np.abs(coarse.q[-1] - fine.q[-1]).max() < 1e-4


# Does a scene written in micrometres move like the same scene in metres?


def _edge(edge: Edge, k: float) -> Edge:
    if isinstance(edge, Arc):
        return Arc(k * edge.x, k * edge.y, k * edge.radius, edge.start_angle, edge.sweep)
    return type(edge)(k * edge.x0, k * edge.y0, k * edge.x1, k * edge.y1)


def _body(body: Body, k: float) -> Body:
    loops = tuple(dataclasses.replace(loop, edges=tuple(_edge(edge, k) for edge in loop.edges)) for loop in body.loops)
    lengths = {"free": (k, k, 1.0), "slide": (k,)}.get(body.motion, (1.0,))
    return dataclasses.replace(
        body,
        position=(k * body.position[0], k * body.position[1]),
        velocity=tuple(v * f for v, f in zip(body.velocity, lengths, strict=False)),
        inertia=k * k * body.inertia,
        centre_of_mass=(k * body.centre_of_mass[0], k * body.centre_of_mass[1]),
        loops=loops,
    )


def in_units(scene: Scene, k: float) -> Scene:
    """The same scene with k units of length where there was one; masses and times keep theirs. Pivots and free bodies."""
    return dataclasses.replace(
        scene,
        bodies=tuple(_body(body, k) for body in scene.bodies),
        springs=tuple(dataclasses.replace(one, stiffness=k * k * one.stiffness) for one in scene.springs),
        torques=tuple(dataclasses.replace(one, value=k * k * one.value) for one in scene.torques),
        damping=tuple(
            Damping(one.body, k * k * one.viscous, k * k * one.quadratic, k * k * one.coulomb) for one in scene.damping
        ),
        gravity=(k * scene.gravity[0], k * scene.gravity[1]),
    )


def test_scaled_scenes_are_scaled() -> None:
    """The helper itself: a circle grows, an angle does not."""
    loop = Loop((Arc(1.0, 2.0, 3.0, 0.5, 1.0),))
    body = _body(Body("a", "free", (1.0, 1.0), 0.3, (1.0, 1.0, 1.0), mass=2.0, inertia=3.0, loops=(loop,)), 10.0)
    assert body.loops[0].edges[0] == Arc(10.0, 20.0, 30.0, 0.5, 1.0)
    assert (body.velocity, body.inertia, body.angle) == ((10.0, 10.0, 1.0), 300.0, 0.3)


@pytest.mark.parametrize("k", [1e6, 2.0**20])
def test_the_incline_in_micrometres(k: float) -> None:
    plain, scaled = (simulate(scene) for scene in (profile("incline"), in_units(profile("incline"), k)))
    assert len(plain.events) == len(scaled.events)
    assert list(plain.events["kind"]) == list(scaled.events["kind"])
    # A gap is the difference of lengths as large as the disc and known to their rounding; an impact at speed v comes that
    # length over v earlier or later. Powers of two, which change no rounding, change no bit.
    height = plain.q[-1, 1]
    speed = np.abs(plain.events["value"][plain.events["kind"] == EventKind.IMPACT]).min()
    allowed = 0.0 if k == 2.0**20 else 2.0 * np.spacing(height) / speed
    assert np.abs(scaled.events["t"] - plain.events["t"]).max() <= allowed
    fast = (plain.events["kind"] == EventKind.IMPACT) & (plain.events["value"] < -1e-3)
    assert scaled.events["t"][fast] == pytest.approx(plain.events["t"][fast], rel=1e-12, abs=0.0)
    unit = np.array([k, k, 1.0])
    assert scaled.q[-1] / unit == pytest.approx(plain.q[-1], rel=1e-12)
    assert scaled.u[-1] / unit == pytest.approx(plain.u[-1], rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("k", few([1e6, 2.0**20], lambda k: k != 1e6))
def test_the_bench_lever_in_micrometres(k: float) -> None:
    """A tenth of a second: two dozen impacts, stick, slip, redundant contacts. Powers of two change not even a bit."""
    scene = profile("bench_lever")
    plain, scaled = (simulate(one, 0.1) for one in (scene, in_units(scene, k)))
    assert list(plain.events["kind"]) == list(scaled.events["kind"])
    assert list(plain.events["contact"]) == list(scaled.events["contact"])
    if k == 2.0**20:
        assert np.array_equal(plain.q, scaled.q)
    assert scaled.q[-1] == pytest.approx(plain.q[-1], rel=1e-12, abs=0.0)
    # Rounding of lengths over speeds: of times, not of their share.
    assert scaled.events["t"] == pytest.approx(plain.events["t"], rel=1e-12, abs=1e-15)
