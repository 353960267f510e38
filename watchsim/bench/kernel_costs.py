"""What does one call of each kernel cost, in the middle of a run?

Each is called many times in compiled code at a state of the scene in which contacts couple bodies. Nothing depends on these
entries, so they are not among the sources that `jit` takes for kernels.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from watchsim import jit
from watchsim.contact.gaps import normal_gap
from watchsim.contact.poses import place_body
from watchsim.dynamics.lcp import lcp_work, lemke_checked
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.model import ModelRef
from watchsim.mechanism.recording import Recording
from watchsim.mechanism.scene import Scene
from watchsim.simulation.advance import scratch_by_reference
from watchsim.simulation.coupled import engage, motion
from watchsim.simulation.free import flow
from watchsim.simulation.options import OptionsRef
from watchsim.simulation.run import Run
from watchsim.simulation.state import StateRef
from watchsim.simulation.stops import Stop

REPEATS = 2000
LCP_SIZES = {"lcp_to_1": 1, "lcp_to_2": 2, "lcp_to_4": 3, "lcp_to_8": 6, "lcp_to_16": 12, "lcp_larger": 24}  # unknowns
MOST_SLICES = 100000


@jit.entry
def gaps_again(model, k, q, u, pose, repeats):
    """One gap with the places of its two bodies."""
    total = 0.0
    a, b = model.primitives[model.contacts[k].a].body, model.primitives[model.contacts[k].b].body
    for i in range(repeats):
        q[0] += 1e-18 * i
        place_body(model, a, q, u, pose)
        place_body(model, b, q, u, pose)
        total += normal_gap(model, k, pose)[0]
    return total


@jit.entry
def flights_again(model, state, repeats):
    """All coordinates at one time of a flight."""
    total = 0.0
    for i in range(repeats):
        for j in range(len(model.coordinates)):
            total += flow(model.coordinates[j], state.grip[j], state.q[j], state.u[j], 1e-6 * i)[0]
    return total


@jit.entry
def evaluations_again(model, state, options, scratch, repeats):
    """The accelerations of coupled bodies with all monitors."""
    m, s, o, w = ModelRef(*model), StateRef(*state), OptionsRef(*options), scratch_by_reference(scratch)
    n = len(s.q)
    w.y[:n], w.y[n : 2 * n] = s.q, s.u
    engage(m, s, w)
    for _ in range(repeats):
        motion(m, s, o, s.clock[0], w.y, w)
    return w.dy[0]


@jit.entry
def lcps_again(A, b, n, work, x, repeats):
    """One complementarity problem by Lemke's method."""
    total = 0
    for _ in range(repeats):
        total += lemke_checked(A, b, n, work, x)
    return total


def coupled_run(scene: Scene) -> Run | None:
    """A run stopped where contacts couple bodies; None if it never comes to that."""
    run = Run(scene, compile_scene(scene), scene.tolerance, Recording(keep="statistics"))
    until = np.array([0.0, scene.duration, 1.0])
    for _ in range(MOST_SLICES):
        until[0] = run.state.clock[0] + 1e-9
        stop = run._advance(until, run.record)
        if stop == Stop.CELL_UNKNOWN:
            run._learn()
        elif stop == Stop.BUFFER_FULL:
            run.flush()
        elif stop != Stop.SLICE:
            return None
        elif run.state.numbers[0] > 0 and run.state.numbers[2] == 0 and run.state.clock[0] > 0.0:
            return run
    return None


def kernel_costs(scene: Scene) -> dict[str, float]:
    """Seconds for one `evaluation`, `flight`, `gap_evaluation`, and one complementarity problem by size (`LCP_SIZES`).

    Without `evaluation` where nothing ever couples.
    """
    run = coupled_run(scene)
    compiled = compile_scene(scene)
    model = compiled.model if run is None else run.compiled.model
    state = run.state if run is not None else Run(scene, compiled, scene.tolerance, Recording()).state
    spare = Run(scene, compiled, scene.tolerance, Recording()) if run is None else run
    q, u, pose = state.q.copy(), state.u.copy(), spare.scratch.pose
    costs = {"flight": _seconds(lambda: flights_again(model, state, REPEATS))}
    costs |= {name: _lcp_seconds(size) for name, size in LCP_SIZES.items()}
    if len(model.contacts):
        costs["gap_evaluation"] = _seconds(lambda: gaps_again(model, 0, q, u, pose, REPEATS))
    if run is not None:
        costs["evaluation"] = _seconds(lambda: evaluations_again(model, state, run.options, run.scratch, REPEATS))
    return costs


def _lcp_seconds(size: int) -> float:
    """Of a problem with that many unknowns, each of which has to be pivoted in."""
    A, b, x, work = np.eye(size) * 2.0 + 0.1, -np.linspace(0.5, 1.0, size), np.zeros(size), lcp_work(size)
    return _seconds(lambda: lcps_again(A, b, size, work, x, REPEATS))


def _seconds(call: Callable[[], object]) -> float:
    """Of one repeat, the best of five; compiled before."""
    call()
    best = float("inf")
    for _ in range(5):
        begun = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - begun)
    return best / REPEATS
