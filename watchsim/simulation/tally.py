"""What can be said of a run without keeping it?

Sums over all half swings of its first sprung body and counts of its events, made as the run goes. Events are handed over
part by part; what a half swing still needs is carried on. However a run is cut, the same half swings are counted.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.roles import Roles, drive_direction, nominal_frequency, oscillators, pitch, roles
from watchsim.scene.scene import Scene
from watchsim.simulation.knock_tally import KnockTally
from watchsim.simulation.recording import (
    LONGEST_STEP,
    STILL,
    Array,
    Events,
    Indices,
    Pair,
    Pairs,
    Rows,
    as_pairs,
    columns_of,
    first_noises,
    half_swings,
    made_rows,
    row_times,
    since_two_before,
    unevenness,
)
from watchsim.simulation.saved_state import TALLIED, TALLIED_LATER
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.simulation.trajectory import Trajectory, place_between
from watchsim.simulation.wheel_tally import Lost, WheelTally

# Of each half swing: amplitude (rad or m), time since the passage two before (s), unevenness of the ticks and of the passages
# (s, with the sign of the direction of swing, so that chance does not add up to a beat error).
QUANTITIES = ("amplitude", "period", "uneven_ticks", "uneven_passages")
MOMENTS = ("number", "mean", "squares", "least", "largest")  # squares: of the distances from the mean, summed
CARRIED = 8  # passages whose events are carried on; a half swing needs four: its beat is compared with those of the two before
LATE = 120  # half swings whose amplitudes are kept: they show whether a watch has settled
MOST_CARRIED = 20000  # events, of an oscillator that makes noises but never passes its rest position
NEAR = 2.5  # rad: blows nearer to rest are no knocks, whatever a sine makes of their time


class Tally:
    """Sums so far. `arrays()` is all it holds."""

    waits = False  # whether events wait for the row after them; all rows are handed over then

    def __init__(
        self,
        scene: Scene,
        pairs: Sequence[Pair],
        slices: Mapping[str, slice] | None = None,
        form: Callable[[Array], Sequence[Array]] = columns_of,
        event_form: Callable[[Events], Events] | None = None,
    ) -> None:
        """`slices`: the columns of the bodies; `form` and `event_form` make rows and events of the scene (see `Recorder`)."""
        self._form, self._event_form = form, event_form or (lambda events: events)
        self.body, self.half_period, self._width = -1, 0.0, 0
        self.wheel, self.knocks = WheelTally(np.nan, np.inf), KnockTally(0.0, np.zeros(1, bool), 0)
        if (parts := roles(scene)).oscillator is not None:
            self.body = [body.name for body in scene.bodies].index(parts.oscillator)
            self.half_period = 0.5 / (nominal_frequency(scene) or np.inf)
            self._look_for(scene, as_pairs(pairs), parts, slices or {})
        self.kinds = np.zeros(max(EventKind) + 1, np.int64)
        self.beats = np.zeros(2, np.int64)  # half swings, and those with a tick
        self.moments = np.zeros((len(QUANTITIES), len(MOMENTS)))
        self.moments[:, 3:] = np.inf, -np.inf
        self.late = np.zeros(0)  # amplitudes of the last half swings
        self.last = np.full(1, -np.inf)  # passage of the last half swing that was counted, s
        self.carried: Events = np.zeros(0, EVENT_DTYPE)
        self.places = np.zeros((0, self._width))  # coordinates of the scene at the carried events
        self.pending: Events = np.zeros(0, EVENT_DTYPE)  # they wait for the row after them
        self.row = np.zeros((0, 0))  # the last row that was handed over
        self.holding = np.zeros(0, np.int64)  # contacts that hold
        # Passages, turning points, the fastest passage (rad/s or m/s) and the last turning point (s).
        self.swung = np.zeros(4)

    def _look_for(self, scene: Scene, pairs: Pairs, parts: Roles, slices: Mapping[str, slice]) -> None:
        """Which contacts and coordinates say something; by contact, and False for none."""
        none = np.zeros(len(pairs) + 1, bool)
        of = {body.name: np.append(pairs.of_body(body.name), False) for body in scene.bodies}
        fixed = np.any([none, *(of[body.name] for body in scene.bodies if body.motion == "fixed")], axis=0)
        lever = of.get(parts.lever or "", none)
        self._noisy = of[str(parts.oscillator)]
        self._striking, self._locking = self._noisy & (fixed | lever), none
        self._stops, self._own = fixed, slices[str(parts.oscillator)].start if slices else 0
        self._width = max((part.stop for part in slices.values()), default=0)
        frequencies = [one.hertz for one in oscillators(scene) if one.hertz]
        self._longest = LONGEST_STEP / max(frequencies) if frequencies else np.inf
        rest = next(one.rest for one in oscillators(scene) if one.body == parts.oscillator)
        self.knocks = KnockTally(rest, fixed, self._width)
        whole = pitch(scene, parts.wheel) if parts.wheel is not None and parts.wheel in slices else None
        if parts.wheel is not None and whole is not None:
            self.wheel = WheelTally(0.5 * whole, 2.0 * self.half_period)
            self._locking = of[parts.wheel] & (lever if parts.lever else self._noisy)
            self._column, self._at_start = slices[parts.wheel].start, scene.body(parts.wheel).angle
            self._sense = drive_direction(scene, parts.wheel)

    def _holder(self, name: str) -> tuple[Any, str]:
        """Whose attribute is saved under that name."""
        owner, _, own = name.rpartition(".")
        return (getattr(self, owner), own) if owner else (self, own)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything, to be saved."""
        return {name: np.array(getattr(*self._holder(name))) for name in (*TALLIED, *TALLIED_LATER)}

    def restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Go on from saved sums."""
        for name, array in arrays.items():
            setattr(*self._holder(name), np.array(array))
        if len(self.places) != len(self.carried):  # saved by a version that did not know them
            self.places = np.full((len(self.carried), self._width), np.nan)

    def fold(self, events: Events, rows: Rows | None = None, last: bool = False) -> None:
        """Count the next events; `rows` go up to them. `last` says that no more will come."""
        self.kinds += np.bincount(events["kind"], minlength=len(self.kinds))
        self._hold(events)
        if self.body < 0:
            return
        contact, kind = events["contact"], events["kind"]
        wanted = (events["body"] == self.body) | ((kind == EventKind.IMPACT) & self._noisy[contact])
        wanted |= ((kind == EventKind.IMPACT) | (kind == EventKind.OPEN)) & self._locking[contact]
        new, places = self._placed(np.concatenate([self.pending, self._event_form(np.compress(wanted, events))]), rows, last)
        self._swing(new)
        own, places = np.concatenate([self.carried, new]), np.concatenate([self.places, places])
        crossings = own[own["kind"] == EventKind.CROSS]
        self._count(own, places, crossings, last)
        if len(crossings) > CARRIED:
            late = own["t"] >= crossings["t"][-CARRIED]
            own, places = own[late], places[late]
        self.carried, self.places = own[-MOST_CARRIED:].copy(), places[-MOST_CARRIED:].copy()

    def _swing(self, events: Events) -> None:
        passed, turned = (events[events["kind"] == kind] for kind in (EventKind.CROSS, EventKind.TURN))
        self.swung[:2] += len(passed), len(turned)
        self.swung[2] = max(self.swung[2], np.abs(passed["value"]).max(initial=0.0))
        self.swung[3] = max(self.swung[3], turned["t"].max(initial=0.0))

    def _hold(self, events: Events) -> None:
        """Which contacts hold after these."""
        kind = events["kind"]
        gained = np.flatnonzero((kind == EventKind.CLOSE) | (kind == EventKind.HANDOVER))
        lost, handed = np.flatnonzero(kind == EventKind.OPEN), np.flatnonzero(kind == EventKind.HANDOVER)
        contacts = np.concatenate(
            [events["contact"][gained], events["contact"][lost], events["value"][handed].astype(np.int64)]
        )
        order = np.argsort(np.concatenate([gained, lost, handed]), kind="stable")[::-1]
        seen, latest = np.unique(contacts[order], return_index=True)  # the last change of each contact
        closed = order[latest] < len(gained)
        self.holding = np.union1d(np.setdiff1d(self.holding, seen), seen[closed])

    def _placed(self, events: Events, rows: Rows | None, last: bool) -> tuple[Events, Array]:
        """Those events whose place is known or will never be, and the coordinates there, nan where not known."""
        earlier = self.row[:, 0] if len(self.row) else np.zeros(0)
        times = np.concatenate([earlier, row_times(rows)]) if rows is not None else earlier
        ready = len(events)
        if self.waits and not last:
            ready = int(np.searchsorted(events["t"], times[-1], side="right")) if len(times) else 0
        self.pending, events = events[ready:].copy(), events[:ready]
        places = np.full((ready, self._width), np.nan)
        if len(times) and self._width:
            t = events["t"]
            after = np.minimum(np.searchsorted(times, t, side="left"), len(times) - 1)
            before = np.maximum(np.searchsorted(times, t, side="right") - 1, 0)
            known = (t >= times[0]) & (t <= times[-1]) & (times[after] - times[before] <= self._longest)
            places[known] = self._between(rows, times, before[known], t[known], len(earlier))
        if rows is not None and len(rows):
            self.row = made_rows(rows[-1:]).copy()
        return events, places

    def _between(self, rows: Rows | None, times: Array, before: Indices, t: Array, earlier: int) -> Array:
        """Coordinates at times t (s), `before` each of which is the row of that number."""
        after = np.minimum(before + 1, len(times) - 1)
        left, right = (self._columns(rows, number, earlier) for number in (before, after))
        h = (times[after] - times[before])[:, None]
        apart = np.where(h > 0.0, h, 1.0)
        s = np.clip((t - times[before])[:, None] / apart, 0.0, 1.0)
        return np.where(h > 0.0, place_between(s, apart, left, right), right[0])

    def _columns(self, rows: Rows | None, numbers: Indices, earlier: int) -> tuple[Array, ...]:
        """q, u, a of rows; the first of them may be the last one that was handed over before."""
        parts = [self.row[numbers[numbers < earlier]]] if earlier else []
        if rows is not None:
            parts.append(made_rows(rows[numbers[numbers >= earlier] - earlier]))
        return tuple(self._form(np.concatenate(parts))[1:])

    def _count(self, own: Events, places: Array, crossings: Events, last: bool) -> None:
        """Sums over the half swings that are over, and were not counted before."""
        is_turn = own["kind"] == EventKind.TURN
        turns = own[is_turn]
        complete, before, after = half_swings(crossings, turns)
        if not len(complete):
            return
        t, start, end = crossings["t"][complete], turns["t"][before], turns["t"][after]
        noisy = (own["kind"] == EventKind.IMPACT) & self._noisy[own["contact"]]
        ticks = first_noises(own["t"][noisy], start, end, self.half_period)
        way = turns["value"][after] - turns["value"][before]
        # Until the next passage a turning point further out may still come.
        new = (t > self.last[0]) & (last | (complete < len(crossings) - 1)) & (np.abs(way) > 2.0 * STILL)
        values = (
            0.5 * np.abs(way),
            since_two_before(crossings["t"])[complete],
            np.sign(way) * unevenness(ticks),
            np.sign(way) * unevenness(t),
        )
        for moments, value in zip(self.moments, values, strict=True):
            _add(moments, value[new & np.isfinite(value)])
        self.late = np.append(self.late, values[0][new])[-LATE:]
        self._go_through(own, places, np.flatnonzero(is_turn)[np.stack([before, after])], t, np.flatnonzero(new).tolist())
        if last and new.any() and self._may_knock(own, places):
            final = int(np.flatnonzero(is_turn)[after[-1]])
            self._knock(own, places, final, (float(t[-1]), float(own["t"][final])))
        self.beats[1] += int(np.isfinite(ticks[new]).sum())
        self.last[0] = np.max(t[new], initial=self.last[0])

    def _go_through(self, own: Events, places: Array, turns: Indices, passages: Array, new: list[int]) -> None:
        """The new ones of half swings that pass the rest position at `passages` (s); `turns`: the events that bound them."""
        outside = self._may_knock(own, places)
        times, angles = own["t"].copy(), np.full(len(own), np.nan)
        if self._locking.any():
            angles = self._sense * (places[:, self._column] - self._at_start)
        for k in new:
            first, second = turns[:, k].tolist()
            if outside:
                self._knock(own, places, first, (passages[k - 1] if k else np.nan, passages[k]))

            def lost(first: int = first, second: int = second) -> Lost:
                inside = np.flatnonzero((times >= times[first]) & (times <= times[second]) & self._locking[own["contact"]])
                inside = inside[np.isfinite(angles[inside])]
                return Lost(times[inside], own["contact"][inside], angles[inside] - angles[first])

            start, end = float(times[first]), float(times[second])
            if not self.beats[0]:
                self.wheel.turn(0, start, start, float(angles[first]), lost)
            self.beats[0] += 1
            self.wheel.turn(int(self.beats[0]), start, end, float(angles[second]), lost)

    def _may_knock(self, own: Events, places: Array) -> bool:
        """Was any of the blows far from rest, by the coordinates there where they are known, or by a stop?"""
        blows = np.flatnonzero((own["kind"] == EventKind.IMPACT) & self._striking[own["contact"]])
        if not len(blows) or not self._width:
            return bool(len(blows))
        near = np.abs(places[blows, self._own] - self.knocks.rest) < NEAR
        return bool((~near | self._stops[own["contact"][blows]]).any())

    def _knock(self, own: Events, places: Array, turn: int, passed: tuple[float, float]) -> None:
        """Blows about a turning point, the event of that number, between two passages (s); before the first there is none."""
        t, reach = float(own["t"][turn]), float(own["value"][turn])
        begins = t if np.isnan(passed[0]) else np.nextafter(passed[0], np.inf)
        inside = slice(*np.searchsorted(own["t"], (begins, np.nextafter(passed[1], np.inf))))
        contact = own["contact"][inside]
        blows = (own["kind"][inside] == EventKind.IMPACT) & self._striking[contact]
        if blows.any():
            self.knocks.turn(own["t"][inside][blows], contact[blows], places[inside][blows], passed, t, reach)

    def finished(self) -> dict[str, Any]:
        """The sums as plain numbers, of a run that ends here; more may follow in this tally all the same."""
        whole = copy.copy(self)
        whole.wheel, whole.knocks = copy.copy(self.wheel), copy.copy(self.knocks)
        whole.restore(self.arrays())
        whole.fold(np.zeros(0, EVENT_DTYPE), last=True)
        kinds = {kind.name.lower(): int(whole.kinds[kind]) for kind in EventKind}
        sums: dict[str, Any] = {"events_by_kind": kinds, "holding": whole.holding.tolist()}
        if self.body >= 0:
            sums |= {"half_swings": int(whole.beats[0]), "ticks": int(whole.beats[1]), "late": whole.late.tolist()}
            passages, turns, fastest, turned = whole.swung.tolist()
            sums |= {"passages": int(passages), "turns": int(turns), "fastest": fastest, "turned": turned}
            sums |= {"wheel": whole.wheel.finished(), "knocks": whole.knocks.finished()}
            for name, moments in zip(QUANTITIES, whole.moments.tolist(), strict=True):
                sums[name] = dict(zip(MOMENTS, moments, strict=True)) if moments[0] else None
        return sums


def sums_of(run: Trajectory) -> Mapping[str, Any]:
    """Those made as the run went; of a run made by hand, or saved by an earlier version, those over what it holds."""
    if "holding" in run.sums:
        return run.sums
    tally = Tally(run.scene, run.pairs, run.slices)
    tally.fold(run.events, np.concatenate([run.t[:, None], run.q, run.u, run.a], axis=1))
    return {**tally.finished(), **run.sums}


def _add(moments: Array, values: Array) -> None:
    """Take values into number, mean, sum of squares, least and largest, one after the other (Welford 1962): to the last bit
    the same however the values are handed over."""
    number, mean, squares, least, largest = moments.tolist()
    for value in values.tolist():
        number += 1.0
        apart = value - mean
        mean += apart / number
        squares += apart * (value - mean)
        least, largest = min(least, value), max(largest, value)
    moments[:] = number, mean, squares, least, largest
