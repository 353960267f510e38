"""How do two parts of one motion become one trajectory?"""

from __future__ import annotations

import dataclasses

import numpy as np

from watchsim.mechanism.recording import ALL, STATISTICS
from watchsim.simulation.kept import stretch_rows, within
from watchsim.simulation.trajectory import Trajectory


def joined(first: Trajectory, rest: Trajectory) -> Trajectory:
    """`first` up to its saved state and `rest`, which went on from there.

    What `first` holds beyond that state is the step its end cut short; `rest` holds the same stretch in whole steps.
    Sums and counts run through the saved state, so those of `rest` are those of both. Times on the clock add up.
    """
    saved, later = first.end_state, rest.end_state
    if saved is None:
        raise ValueError("the first part carries no end state")
    if later is not None:
        later = dataclasses.replace(later, rows=saved.rows + later.rows, events=saved.events + later.events)
    cut = saved.rows
    whole = dataclasses.replace(
        rest,
        t=np.concatenate([first.t[:cut], rest.t]),
        q=np.concatenate([first.q[:cut], rest.q]),
        u=np.concatenate([first.u[:cut], rest.u]),
        a=np.concatenate([first.a[:cut], rest.a]),
        events=np.concatenate([first.events[: saved.events], rest.events]),
        wall=first.wall + rest.wall,
        compile=first.compile + rest.compile,
        end_state=later,
    )
    return whole if rest.keep == ALL else _without_old_tail(whole)


def _without_old_tail(run: Trajectory) -> Trajectory:
    """Without the last seconds of the first part, where only those of the whole are kept."""
    rows = stretch_rows(run.t, run.spans)
    events = within(run.events["t"], run.spans) | (run.keep != STATISTICS)
    saved = run.end_state
    if saved is not None:
        saved = dataclasses.replace(saved, rows=int(rows[: saved.rows].sum()), events=int(events[: saved.events].sum()))
    return dataclasses.replace(
        run, t=run.t[rows], q=run.q[rows], u=run.u[rows], a=run.a[rows], events=run.events[events], end_state=saved
    )
