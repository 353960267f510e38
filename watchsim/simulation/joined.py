"""How do two parts of one motion become one trajectory?"""

from __future__ import annotations

import dataclasses

import numpy as np

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
    columns = {name: np.concatenate([getattr(first, name)[: saved.rows], getattr(rest, name)]) for name in ("t", "q", "u", "a")}
    events = np.concatenate([first.events[: saved.events], rest.events])
    wall, compile_time = first.wall + rest.wall, first.compile + rest.compile
    return dataclasses.replace(rest, **columns, events=events, wall=wall, compile=compile_time, end_state=later)
