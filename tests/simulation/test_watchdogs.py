"""Is a run that goes wrong ended by its own checks, and do instants come to an end?"""

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from moving_scenes import box, circle, ground, profile, touching

from watchsim import designs, jit
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.model import blank
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.closed_contacts import is_explained
from watchsim.simulation.coupled_motion import NORMAL
from watchsim.simulation.event_loop import BEARING, KINDS, TOUCHED
from watchsim.simulation.modes import begin_instant, decide_once, key_of_modes
from watchsim.simulation.options import options_for
from watchsim.simulation.recording import pairs_of
from watchsim.simulation.run_end import ledger_fails, what_alternates
from watchsim.simulation.scratch import Ended
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop, new_state
from watchsim.simulation.step_path import MOST, is_open, narrowed, next_time, opened
from watchsim.tolerances import LENIENCE_STEP, MOST_LENIENT

ROOT = Path(jit.__file__).resolve().parents[1]
SABOTAGE = """
import sys
import watchsim.simulation.event_loop as step
import watchsim.simulation.event_loop as settle
from moving_scenes import profile
from watchsim.simulation.simulate import simulate

def stop_everything(closed, m, mode, independent, inverse, projection, out_u):
    out_u[:] = 0.0

{place}.project_velocities = stop_everything
run = simulate(profile("incline", "scene.toml"), duration=2.0)
print(run.stop.name)
print(run.stop_message)
"""


@pytest.mark.parametrize("place", ["step", "settle"])
def test_a_correction_that_stops_bodies_ends_the_run(place: str, tmp_path: Path) -> None:
    """Corrections replaced, in plain Python, by one that stops all motion: the run says so and keeps what it has."""
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(map(str, [ROOT, *Path(__file__).parents[:2]])),
        "NUMBA_DISABLE_JIT": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", SABOTAGE.format(place=place)],
        env=environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    stop, message = done.stdout.splitlines()[:2]
    assert stop == "UNEXPLAINED"
    assert "more than the impulses there explain" in message


def test_changes_of_energy_are_explained_up_to_rounding() -> None:
    model, options = compile_scene(profile("incline")).model, options_for(0.1, 1e-9, 1e-3)
    explained = callable_kernel(is_explained)
    assert explained(model, options, 1.0, 5e-7, 1.0)
    assert not explained(model, options, 1.0, -5e-6, 1.0)
    assert explained(model, options, 1e-20, -1e-20, 1.0)  # of what was highest, or slow enough to count as standing


@pytest.mark.parametrize("slots", [7, 8])
def test_what_a_step_drifts_is_much_of_a_body_that_is_nearly_at_rest(slots: int) -> None:
    """A pin that leaves its slot brings a Geneva wheel to rest: at the mouth, rounding is 1e-6 of what energy it has left."""
    run = simulate(designs.geneva(slots=slots).scene(), 2.25)
    assert run.stop == Stop.DURATION
    turned = run.q[-1, run.slices["wheel"].start]
    assert turned == pytest.approx(-2.5 * math.tau / slots + math.pi / slots, abs=math.radians(0.1))


def test_a_ledger_that_does_not_close_is_noticed() -> None:
    energy = {"in_J": 1.0, "stored_J": 0.5, "dissipated": {"friction": 0.5}, "residual_J": 1e-5}
    assert ledger_fails(energy, 0.5, 1e-9)
    assert not ledger_fails(energy | {"residual_J": 1e-6}, 0.5, 1e-9)
    assert not ledger_fails(energy, 0.5, 1e-7)  # what was asked for
    assert not ledger_fails({"in_J": 0.0, "stored_J": 0.0, "dissipated": {}, "residual_J": 0.0}, 0.0, 1e-9)


def test_no_set_of_modes_is_decided_twice_on_the_same_terms() -> None:
    """Two sets of modes that alternate make the terms more lenient each time one comes back, and then the run ends."""
    compiled = compile_scene(profile("incline"))
    state = new_state(compiled.model, compiled.q, compiled.u)
    once, key, begin = (callable_kernel(kernel) for kernel in (decide_once, key_of_modes, begin_instant))
    instant = state.instant
    seen: list[tuple[int, float]] = []
    for turn in range(1000):
        instant.awake_contacts = turn % 2
        state.regime.mode[0] = 1 + turn % 2
        if not once(key(state.regime, instant), state.decided, instant):
            break
        terms = (turn % 2, float(instant.lenience))
        seen.append(terms)
    assert instant.lenience > MOST_LENIENT
    assert len(seen) < 40
    assert {lenience for _, lenience in seen} == {LENIENCE_STEP**power for power in range(8)}
    begin(instant)
    assert instant.lenience == 1.0
    assert once(key(state.regime, instant), state.decided, instant)
    instant.decisions = 0
    assert once(key(state.regime, instant), state.decided, instant)  # after an impact the same modes may come again
    assert instant.lenience == 1.0


def test_what_alternates_is_named_with_bodies_and_edges() -> None:
    compiled = compile_scene(profile("bench_lever"))
    pairs, bodies = pairs_of(compiled), ["wheel", "lever", "balance"]
    ended = blank(Ended)
    ended.by[:4] = KINDS * 5 + NORMAL, KINDS * 5 + TOUCHED, KINDS * 5 + NORMAL, KINDS * 1 + BEARING
    ended.number = 4
    words = what_alternates(ended, pairs, bodies)
    assert f"the force ends at {pairs[5]} (2×)" in words
    assert f"{pairs[5]} touch (1×)" in words
    assert "the bearing of lever" in words


def bracketed(value: Callable[[float], float]) -> tuple[float, int]:
    """A root in [0, 1] found as the solver does, and the evaluations it took."""
    begin, following, goes_on, after = (callable_kernel(kernel) for kernel in (opened, next_time, is_open, narrowed))
    bracket = begin(0.0, value(0.0), 1.0, value(1.0))
    place = following(bracket)
    while goes_on(bracket, place, 1e-15):
        bracket = after(bracket, place, value(place), value(place) <= 0.0)
        place = following(bracket)
    return bracket.high, bracket.looks


@pytest.mark.parametrize("root", [1e-9, 0.1, 0.5, 0.999])
def test_roots_are_found_where_a_function_is_flat_and_then_falls_steeply(root: float) -> None:
    """The least of a margin that hardly changes and one that falls off: Illinois' method alone is lost there."""
    found, evaluations = bracketed(lambda x: min(1e-12, root - x + 1e-12))
    assert found == pytest.approx(root, abs=2e-12)
    assert evaluations <= MOST


def test_roots_of_smooth_functions_take_few_evaluations() -> None:
    for root in (0.1, 0.5, 0.999):
        found, evaluations = bracketed(lambda x, root=root: root * root - x * x)
        assert found == pytest.approx(root, abs=1e-14)
        assert evaluations <= 20


def test_bodies_that_travel_together_are_not_looked_at_for_ever() -> None:
    """Two free discs go on together after a plastic impact, without a force between them."""
    discs = (
        Body("a", "free", (0.0, 0.0), velocity=(0.9, 0.0, 0.0), mass=0.09, inertia=1e-6, loops=(circle(5e-3),)),
        Body("b", "free", (0.015, 0.0), velocity=(-0.9, 0.0, 0.0), mass=0.01, inertia=1e-7, loops=(circle(5e-3),)),
    )
    done = simulate(Scene("discs", discs, contacts=touching("a", "b"), duration=1.0))
    assert done.stop == Stop.DURATION
    assert done.counts["gap_evaluations"] < 2000
    np.testing.assert_allclose(done.end_u[[0, 3]], 0.72, rtol=1e-12)


def test_equal_pendulums_that_meet_at_their_lowest_point_go_on_together() -> None:
    """All forces between them are rounding: nothing alternates. The speed halves, and both rise as one pendulum would."""
    length, radius, gravity = 0.3, 0.02, 9.81
    bob = {
        "mass": 0.1,
        "inertia": 0.1 * length**2,
        "centre_of_mass": (0.0, -length),
        "loops": (circle(radius, (0.0, -length)),),
    }
    bodies = (Body("a", "pivot", (0.0, 0.0), -1.0, **bob), Body("b", "pivot", (2.0 * radius, 0.0), 0.0, **bob))
    scene = Scene("pendulums", bodies, contacts=touching("a", "b"), duration=1.0, gravity=(0.0, -gravity))
    for tolerance in (1e-7, 1e-9, 1e-12):
        done = simulate(scene, tolerance=tolerance)
        assert done.stop == Stop.DURATION
        highest = np.arccos(1.0 - 0.25 * (1.0 - np.cos(1.0)))
        assert done.q[:, 1].max() == pytest.approx(highest, rel=1e-3)
        np.testing.assert_allclose(done.q[done.t > 0.5, 0], done.q[done.t > 0.5, 1], atol=1e-9)


def test_a_rocking_block_comes_to_rest_on_both_corners() -> None:
    tilt, side = 0.02, 0.04
    block = Body(
        "block",
        "free",
        (0.0, 0.5 * side * (np.cos(tilt) + np.sin(tilt))),
        tilt,
        velocity=(0.0, 0.0, 0.0),
        mass=0.1,
        inertia=0.1 * side**2 / 6.0,
        loops=(box(side, side),),
    )
    contacts = touching("ground", "block", friction=0.5)
    done = simulate(Scene("rocking", (ground(), block), contacts=contacts, duration=2.0, gravity=(0.0, -9.81)))
    assert done.stop == Stop.DURATION
    np.testing.assert_allclose(done.end_u, 0.0, atol=1e-9)
    assert done.end_q[1] == pytest.approx(0.5 * side, abs=1e-10)
    assert done.end_q[2] == pytest.approx(0.0, abs=1e-9)


def test_a_run_that_crawls_says_who_and_since_when() -> None:
    """Two levers that rock flat on each other without loss: thousands of rebounds while their play closes."""
    said: list[str] = []

    def progress(*_: float) -> None: ...

    progress.crowded = said.append  # type: ignore[attr-defined]
    scene = load(Path(__file__).resolve().parents[1] / "data" / "hunt" / "levers-2001-15091.toml")
    simulate(scene, progress=progress)
    slow = [words for words in said if words]
    assert said[0] == "" and slow
    assert slow[-1].startswith("slow since t = 0.") and "touch" in slow[-1]
