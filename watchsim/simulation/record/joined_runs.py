"""How do two parts of one motion become one trajectory?"""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.oscillation import frequency
from watchsim.scene.recording import ALL, STATISTICS
from watchsim.simulation.record.row_selection import stretch_rows, tail_length, within
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import one_behind_the_other


def joined(first: Trajectory, rest: Trajectory, folder: Path | None = None) -> Trajectory:
    """`first` up to its saved state and `rest`, which went on from there.

    What `first` holds beyond that state is the step its end cut short; `rest` holds the same stretch in whole steps.
    Sums and counts run through the saved state, so those of `rest` are those of both. Times on the clock add up. Rows and
    events go to files in `folder` where they are many.
    """
    saved, later = first.end_state, rest.end_state
    if saved is None:
        raise ValueError("the first part carries no end state")
    cut, stays = saved.rows, saved.recorded.get("stays", np.ones(saved.rows, bool))
    if rest.keep != ALL and len(saved.recorded.get("row", ())):
        cut -= 1  # the row about which the next one decides is among those of `rest`, if it stays
    if later is not None:
        recorded = {**later.recorded, "stays": np.append(stays[:cut], later.recorded.get("stays", np.ones(later.rows, bool)))}
        later = dataclasses.replace(later, rows=cut + later.rows, events=saved.events + later.events, recorded=recorded)
    before = [array[:cut] for array in (first.t, first.q, first.u, first.a)]
    t, q, u, a = one_behind_the_other(before, (rest.t, rest.q, rest.u, rest.a), folder)
    (events,) = one_behind_the_other([first.events[: saved.events]], [rest.events], folder)
    whole = dataclasses.replace(
        rest,
        t=t,
        q=q,
        u=u,
        a=a,
        events=events,
        wall=first.wall + rest.wall,
        compile=first.compile + rest.compile,
        end_state=later,
    )
    return whole if rest.keep == ALL else _without_old_tail(whole, stays[:cut])


def _without_old_tail(run: Trajectory, stays: NDArray[np.bool_]) -> Trajectory:
    """Without the last seconds of the first part, where only those of the whole are kept; `stays`: which rows stay anyway."""
    since = max(0.0, run.simulated - tail_length(frequency(run.scene)))
    rows = stretch_rows(run.t, ((since, run.simulated),))
    rows[: len(stays)] |= stays
    rows[len(stays) :] = True
    events = within(run.events["t"], run.spans) | (run.keep != STATISTICS)
    saved = run.end_state
    if saved is not None:
        recorded = {**saved.recorded, "stays": saved.recorded["stays"][rows[: saved.rows]]}
        kept_rows, kept_events = int(rows[: saved.rows].sum()), int(events[: saved.events].sum())
        saved = dataclasses.replace(saved, rows=kept_rows, events=kept_events, recorded=recorded)
    return dataclasses.replace(
        run, t=run.t[rows], q=run.q[rows], u=run.u[rows], a=run.a[rows], events=run.events[events], end_state=saved
    )
