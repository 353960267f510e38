"""Does Moreau's time stepping see the same motion?

It shares the gap functions with the event-driven solver, and neither events nor contact solver. Its error goes with the step,
so two steps say how far it can be trusted: it contradicts where the event-driven motion lies ten times further from the finer
one than the two lie from each other and twins of 1e-4 from the scene, and where finer steps do not come nearer. A step takes
impacts that follow each other within it for one, and parts an impact that is passed on through bodies in touch; where that
comes out otherwise, what comes after is not compared. Nor is what the laws leave open (`hunt.open_motion`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hunt.open_motion import open_motion
from watchsim.simulation import MOREAU
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

if TYPE_CHECKING:
    from hunt.judge import Judge

Array = NDArray[np.float64]

STEPS = (2_000, 8_000, 32_000, 128_000)  # of the duration; the last two only where it contradicts
FACTOR, FLOOR = 10.0, 0.03
PASSED_ON = 1e-9  # of the approach at another contact of the instant: one that approaches less passes that impact on
MERGED_STEPS = 2.0  # within which a step may take two impacts for one
ALIKE = 1e-6  # tolerance whose twins (a hundred times that) are as far off as a step


def witness_fault(judge: Judge, base: Trajectory, middle: Array) -> Iterator[str]:
    """A phrase where the witness contradicts the run `base` with the motion `middle`."""
    coarse, fine = (_stepped(judge, n) for n in STEPS[:2])
    far, own = _drift(middle, fine), _drift(coarse, fine)
    if not (far > FLOOR + FACTOR * own).any():
        return
    known = len(judge.verdict.reasons)
    spread = judge.spread(middle, ALIKE)
    del judge.verdict.reasons[known:]  # coarse changes are not what is judged here
    allowed = FLOOR + FACTOR * np.maximum(own, spread)
    if not (far > allowed).any():
        return
    for steps in STEPS[2:]:
        finer = _stepped(judge, steps)
        closer, own = _drift(middle, finer), _drift(fine, finer)
        beyond = np.flatnonzero((closer > FLOOR + FACTOR * np.maximum(own, spread)) & (closer > 0.7 * far))
        if not len(beyond):
            return
        fine = finer
    k = beyond[0]
    if merged(base, judge.times[k], MERGED_STEPS * judge.scene.duration / STEPS[-1]):
        return
    if closer[k] <= open_motion(base, judge.times[k], judge.weights):
        return
    yield f"witness: Moreau is {closer[k]:.1e} of the size away at t = {judge.times[k]:.6g} s, its steps {own[k]:.1e}"


def merged(run: Trajectory, until: float, wait: float) -> bool:
    """Do two impacts of different contacts follow each other within that time, or does one pass on another's at once?

    Two bodies that travel together in touch are apart, in steps, by what they move in one: they are hit in turn.
    """
    found = run.events[(run.events["kind"] == EventKind.IMPACT) & (run.events["t"] <= until)]
    between = np.diff(found["t"])
    in_turn = (found["contact"][1:] != found["contact"][:-1]) & (between > 0.0) & (between <= wait)
    hardest = {t: np.abs(found["value"][found["t"] == t]).max() for t in np.unique(found["t"])}
    passes_on = [abs(event["value"]) < PASSED_ON * hardest[event["t"]] for event in found]
    return bool(in_turn.any() or any(passes_on))


def _stepped(judge: Judge, steps: int) -> Array:
    judge.verdict.runs += 1
    run = simulate(judge.scene, prefilter=False, method=MOREAU, step=judge.scene.duration / steps)
    return judge.motion(run)


def _drift(a: Array, b: Array) -> Array:
    return np.maximum.accumulate(np.abs(a - b).max(axis=1))
