"""Does the wheel run through, with nothing to stop it?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.timing.averages import last_window
from watchsim.analysis.verdicts.verdict_kinds import when
from watchsim.analysis.verdicts.watch import Watch

FAST = 2.0  # times as many teeth as the oscillator could let go in that time


def running_free(watch: Watch) -> tuple[float, str] | None:
    """Since when (s) and a few words, where in the last window the wheel passed far more teeth than there are beats."""
    start, end = last_window(watch.run, watch.found.nominal_period)
    ends = np.array([start, end])
    if watch.pitch is None or not watch.recorded(ends).all():
        return None
    first, last = watch.progress(ends)
    let_go = (end - start) / watch.found.nominal_period + 1.0
    if last - first <= FAST * let_go * watch.pitch:
        return None
    turns = (last - first) / (2.0 * np.pi)
    return start, f"{watch.wheel} runs through, {turns:.3g} turns from {when(start)} to {when(end)}"
