"""What can be said of a run without keeping it?

Sums over all half swings of its first sprung body and counts of its events, made as the run goes. Events are handed over part
by part; what a half swing still needs is carried on. However a run is cut, the same half swings are counted.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.oscillation import nominal_frequency
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.record.contact_names import Pair, as_pairs
from watchsim.simulation.record.half_swings import first_noises, half_swings, since_two_before, unevenness
from watchsim.simulation.record.saved_state import TALLIED

Array = NDArray[np.float64]
Events = NDArray[Any]

# Of each half swing: amplitude (rad or m), time since the passage two before (s), unevenness of the ticks and of the passages
# (s, with the sign of the direction of swing, so that chance does not add up to a beat error).
QUANTITIES = ("amplitude", "period", "uneven_ticks", "uneven_passages")
MOMENTS = ("number", "mean", "squares", "least", "largest")  # squares: of the distances from the mean, summed
CARRIED = 8  # passages whose events are carried on; a half swing needs four: its beat is compared with those of the two before
MOST_CARRIED = 20000  # events, of an oscillator that makes noises but never passes its rest position


class Tally:
    """Sums so far. `arrays()` is all it holds."""

    def __init__(self, scene: Scene, pairs: Sequence[Pair]) -> None:
        self.body, self.half_period = -1, 0.0
        name = roles(scene).oscillator
        if name is not None:
            self.body = [body.name for body in scene.bodies].index(name)
            self.half_period = 0.5 / (nominal_frequency(scene) or np.inf)
            self._noisy = np.append(as_pairs(pairs).of_body(name), False)
        self.kinds = np.zeros(max(EventKind) + 1, np.int64)
        self.beats = np.zeros(2, np.int64)  # half swings, and those with a tick
        self.moments = np.zeros((len(QUANTITIES), len(MOMENTS)))
        self.moments[:, 3:] = np.inf, -np.inf
        self.last = np.full(1, -np.inf)  # passage of the last half swing that was counted, s
        self.carried: Events = np.zeros(0, EVENT_DTYPE)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything, to be saved."""
        return {name: np.array(getattr(self, name)) for name in TALLIED}

    def restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Go on from saved sums."""
        for name, array in arrays.items():
            setattr(self, name, np.array(array))

    def fold(self, events: Events, last: bool = False) -> None:
        """Count the next events; `last` says that no more will come."""
        self.kinds += np.bincount(events["kind"], minlength=len(self.kinds))
        if self.body < 0:
            return
        noise = (events["kind"] == EventKind.IMPACT) & self._noisy[np.where(events["contact"] >= 0, events["contact"], -1)]
        own = np.concatenate([self.carried, events[noise | (events["body"] == self.body)]])
        crossings, turns = own[own["kind"] == EventKind.CROSS], own[own["kind"] == EventKind.TURN]
        self._count(crossings, turns, own["t"][own["kind"] == EventKind.IMPACT], last)
        if len(crossings) > CARRIED:
            own = own[own["t"] >= crossings["t"][-CARRIED]]
        self.carried = own[-MOST_CARRIED:].copy()

    def _count(self, crossings: Events, turns: Events, noises: Array, last: bool) -> None:
        """Sums over the half swings that are over, and were not counted before."""
        complete, before, after = half_swings(crossings, turns)
        if not len(complete):
            return
        t, start, end = crossings["t"][complete], turns["t"][before], turns["t"][after]
        ticks = first_noises(noises, start, end, self.half_period)
        way = turns["value"][after] - turns["value"][before]
        # Until the next passage a turning point further out may still come.
        new = (t > self.last[0]) & (last | (complete < len(crossings) - 1))
        values = (
            0.5 * np.abs(way),
            since_two_before(crossings["t"])[complete],
            np.sign(way) * unevenness(ticks),
            np.sign(way) * unevenness(t),
        )
        for moments, value in zip(self.moments, values, strict=True):
            _add(moments, value[new & np.isfinite(value)])
        self.beats += (int(new.sum()), int(np.isfinite(ticks[new]).sum()))
        self.last[0] = np.max(t[new], initial=self.last[0])

    def finished(self) -> dict[str, Any]:
        """The sums as plain numbers, of a run that ends here; more may follow in this tally all the same."""
        whole = copy.copy(self)
        whole.restore(self.arrays())
        whole.fold(np.zeros(0, EVENT_DTYPE), last=True)
        kinds = {kind.name.lower(): int(whole.kinds[kind]) for kind in EventKind}
        sums: dict[str, Any] = {"events_by_kind": kinds}
        if self.body >= 0:
            sums |= {"half_swings": int(whole.beats[0]), "ticks": int(whole.beats[1])}
            for name, moments in zip(QUANTITIES, whole.moments.tolist(), strict=True):
                sums[name] = dict(zip(MOMENTS, moments, strict=True)) if moments[0] else None
        return sums


def _add(moments: Array, values: Array) -> None:
    """Take values into number, mean, sum of squares, least and largest (Chan, Golub and LeVeque 1983)."""
    if not len(values):
        return
    number, mean, squares, least, largest = moments
    count, centre = len(values), float(values.mean())
    whole, apart = number + count, centre - mean
    moments[0] = whole
    moments[1] = mean + apart * count / whole
    moments[2] = squares + float(((values - centre) ** 2).sum()) + apart * apart * number * count / whole
    moments[3], moments[4] = min(least, values.min()), max(largest, values.max())
