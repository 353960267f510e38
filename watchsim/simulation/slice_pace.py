"""How long may the loop go on before Python looks at clock, progress and interrupts again?

A slice ends after a simulated time or a number of steps, whichever comes first: where events crowd, time is no measure of work.
How slices end changes no bit of a run.
"""

from __future__ import annotations

import time

from watchsim.simulation.loop_state.buffers import Until

SLICE_WALL = 0.1  # s between looks at the clock
FEWEST_STEPS, MOST_STEPS = 16.0, 4000.0  # of a slice; steps may become much slower from one to the next


class Pace:
    """The length of the next slice, from how long the last one took."""

    def __init__(self, duration: float) -> None:
        self.duration = duration
        self.length = 1e-5 * duration  # s, simulated; grows tenfold at most: a long slice would be deaf
        self.steps = FEWEST_STEPS
        self.start = self.begun = 0.0

    def begin(self, now: float, until: Until, look: float) -> None:
        """Set in `until` where the slice from `now` ends, at the latest at `look` (s)."""
        self.start, self.begun = time.perf_counter(), now
        until.slice_end = min(self.duration, now + self.length, look)
        until.steps = self.steps

    def end(self, now: float, until: Until) -> None:
        """Learn from the slice that came to its end."""
        pace = SLICE_WALL / max(time.perf_counter() - self.start, 1e-4)
        if until.steps > 0.0:
            self.length = min(max((now - self.begun) * pace, 1e-9 * self.duration), 10.0 * self.length)
        self.steps = min(max(pace * (self.steps - until.steps), 1.0), 2.0 * self.steps, MOST_STEPS)
