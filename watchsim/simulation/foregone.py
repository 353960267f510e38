"""Can what a watch does still change, or is it a foregone conclusion?

Looked at between slices, at times that depend on nothing but the scene, so that the motion is the same whoever looks.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from watchsim.mechanism.compile import Compiled
from watchsim.model import OVER_TIME
from watchsim.scene.roles import drive_direction, keeps_time, nominal_frequency, pitch, roles
from watchsim.scene.scene import Scene
from watchsim.units import rounded

PERIODS = 4  # nominal ones, from look to look at what stands; a wheel that races is looked at in each of them
RACES = 50.0  # times as many teeth as the oscillator could let go in that time,
IN_A_ROW = 2  # in so many periods: nothing will lock the wheel again
ON_TIME = 1e-9  # of the spacing: so near to a look is at it
LOOKS = 3  # in a row without a passage through rest and without a tooth: nothing will unlock the wheel again


def _after(time: float, spacing: float) -> float:
    """The next multiple of a spacing, s: never `time` itself, which may be one that rounding has put before it."""
    return (math.floor(time / spacing + ON_TIME) + 1.0) * spacing


class Foregone:
    """Looks at a run of a watch; `words` says what nothing will change any more, "" until then."""

    def __init__(self, scene: Scene, compiled: Compiled, begun: float = 0.0, at: np.ndarray | None = None) -> None:
        """Of a run that begins at the time `begun` (s) with the coordinates `at`; the scene's own by default."""
        found, hertz = roles(scene), nominal_frequency(scene)
        timed = any(table.over >= OVER_TIME for table in compiled.model.tables)
        moved = any(body.prescribed is not None for body in scene.bodies)
        self.is_watch = bool(found.wheel and keeps_time(scene) and hertz and not timed and not moved)
        self.period, self.words, self.next = 1.0 / (hertz or 1.0), "", np.inf
        if not self.is_watch or found.wheel is None:
            return
        self._compiled, self._wheel = compiled, found.wheel
        self._pitch, self._sense = pitch(scene, found.wheel), drive_direction(scene, found.wheel)
        self._before = begun, np.array(compiled.relative((compiled.q if at is None else at)[None])[0])
        self._looked, self._idle = [(begun, self._turned(self._before[1]))], 0
        self._standing = begun + PERIODS * self.period
        self.next = begun + self.period

    def look(self, time: float, coordinates: np.ndarray, passed: Callable[[], float]) -> bool:
        """Is it over at `time` (s), at these coordinates? `passed`: when the oscillator last passed its rest position, s; only
        asked where the wheel stands.
        """
        if time < self.next:
            return False
        self.next = _after(time, self.period)
        q = self._compiled.relative(coordinates[None])[0]
        if not self._races(time, q) and time >= self._standing:
            self._standing = _after(time, PERIODS * self.period)
            self._stands(time, q, passed)
        return bool(self.words)

    def _turned(self, q: np.ndarray) -> float:
        """How far the wheel has gone with its drive, rad."""
        return self._sense * float(q[self._compiled.slices[self._wheel].start])

    def _races(self, time: float, q: np.ndarray) -> bool:
        if self._pitch is None:
            return False
        (since, was), now = self._looked[-1], self._turned(q)
        fast = (now - was) / self._pitch > RACES * ((time - since) / self.period + 1.0)
        self._looked = [*self._looked, (time, now)] if fast else [(time, now)]
        if len(self._looked) <= IN_A_ROW:
            return False
        since, was = self._looked[0]
        teeth = rounded((now - was) / self._pitch)
        self.words = f"{self._wheel} races, {teeth} teeth from t = {since:.4g} s to {time:.4g} s"
        return True

    def _stands(self, time: float, q: np.ndarray, passed: Callable[[], float]) -> None:
        (since, was), self._before = self._before, (time, q.copy())
        if np.array_equal(q, was):
            self.words = f"all has been at rest since t = {since:.4g} s"
        if self._pitch is None or self.words:
            return
        teeth = (self._turned(q) - self._turned(was)) / self._pitch
        self._idle = self._idle + 1 if abs(teeth) < 0.25 and passed() < since else 0
        if self._idle >= LOOKS:
            held = time - LOOKS * PERIODS * self.period
            self.words = f"since t = {held:.4g} s no tooth was let go, and no swing has passed its rest position"
