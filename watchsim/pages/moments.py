"""When does something happen: events to step to, phases with names, noises, and where to play slowly?"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.analysis.timing.timegrapher import noises
from watchsim.pages.packed import doubles, floats
from watchsim.render.frame.pose_history import Window
from watchsim.simulation.record.trajectory import Array, EventKind, Trajectory
from watchsim.units import metric

WORDS = {
    EventKind.IMPACT: "impact",
    EventKind.CLOSE: "closes",
    EventKind.OPEN: "opens",
    EventKind.STICK: "sticks",
    EventKind.SLIDE: "slides",
    EventKind.ACCUMULATION: "comes to rest after rebounds",
    EventKind.TURN: "turning point",
    EventKind.CROSS: "rest position",
    EventKind.JAM: "jams",
}
TOLD = (EventKind.IMPACT, EventKind.CLOSE, EventKind.OPEN, EventKind.JAM, EventKind.ACCUMULATION)  # slow where these happen
MOST = 3000  # instants
NAMED = 3  # events of one instant that are put into words
FAINT = 1e-4  # of the loudest noise: cannot be heard
AROUND = 0.004  # of the window: what is slow around an event where no phases are known
MERGED = 2.0  # times that: quiet stretches so short are not worth a hurry
LASTING = ("locked",)  # phases in which nothing happens


def instants(run: Trajectory, window: Window) -> list[list[Any]]:
    """[t (s), what happens] for every instant with events, in order; the faintest left out where there are too many."""
    events = run.events[(run.events["t"] >= window[0]) & (run.events["t"] <= window[1])]
    events = events[events["kind"] != EventKind.HANDOVER]
    times, place = np.unique(events["t"], return_inverse=True)
    if len(times) > MOST:
        loud = np.zeros(len(times))
        np.maximum.at(loud, place, np.where(events["kind"] == EventKind.IMPACT, events["energy_lost"], np.inf))
        chosen = np.zeros(len(times), bool)
        chosen[np.argsort(-loud, kind="stable")[:MOST]] = True
        events, times = events[chosen[place]], times[chosen]
    names = [body.name for body in run.scene.bodies]
    starts = np.searchsorted(events["t"], times)
    return [
        [float(t), _words(run, events[i:j], names)]
        for t, (i, j) in zip(times, pairwise([*starts.tolist(), len(events)]), strict=True)
    ]


def _words(run: Trajectory, events: Any, names: list[str]) -> str:
    told = list(dict.fromkeys(_one(run, event, names) for event in events))
    more = len(told) - NAMED
    return "; ".join(told[:NAMED]) + (f"; {more} more" if more > 0 else "")


def _one(run: Trajectory, event: Any, names: list[str]) -> str:
    kind = EventKind(int(event["kind"]))
    if event["contact"] < 0:
        return f"{names[event['body']]}: {WORDS[kind]}" if event["body"] >= 0 else WORDS[kind]
    pair = run.pairs[int(event["contact"])]
    lost = f", {metric(float(event['energy_lost']), 'J', 2)} lost" if kind == EventKind.IMPACT else ""
    return f"{pair.body_a} {pair.layer_a} / {pair.body_b} {pair.layer_b}: {WORDS[kind]}{lost}"


def heard(run: Trajectory, window: Window) -> dict[str, str]:
    """Noises of the window: t (s) and loudness, 1 for the loudest; energies (J) go with the square of it."""
    times, energies = noises(run)
    inside = (times >= window[0]) & (times <= window[1])
    times, energies = times[inside], np.maximum(energies[inside], 0.0)
    loudest = float(energies.max(initial=0.0))
    if loudest <= 0.0:
        return {"t": doubles([]), "loud": floats([])}
    audible = energies >= FAINT * loudest
    return {"t": doubles(times[audible]), "loud": floats(np.sqrt(energies[audible] / loudest))}


def named(found: list[Phase], window: Window) -> list[list[Any]]:
    """[name, start, end] of the phases that reach into the window."""
    return [[phase.name, phase.start, phase.end] for phase in found if phase.end > window[0] and phase.start < window[1]]


def busy(run: Trajectory, found: list[Phase], window: Window) -> list[Window]:
    """Stretches in which things happen: from unlocking to the banking where phases are known, else around every event."""
    lively = [(phase.start, phase.end) for phase in _lively(found, window)]
    if lively:
        longest = max(end - start for start, end in lively)
        spans = np.array([(start - 0.1 * longest, end + 0.1 * longest) for start, end in lively])
        return list(_merged(spans, longest, window))
    events = run.events[np.isin(run.events["kind"], TOLD)]
    times = np.unique(events["t"][(events["t"] >= window[0]) & (events["t"] <= window[1])])
    around = AROUND * (window[1] - window[0])
    return list(_merged(np.column_stack((times - around, times + around)), MERGED * around, window))


def _lively(found: list[Phase], window: Window) -> list[Phase]:
    """The phases within the window in which something happens."""
    return [one for one in found if one.name not in LASTING and one.end > window[0] and one.start < window[1]]


def _merged(spans: Array, gap: float, window: Window) -> Iterator[Window]:
    """The spans in order, united where no more than `gap` (s) lies between them, cut to the window."""
    last: list[float] | None = None
    for start, end in sorted(map(tuple, spans.tolist())):
        if last is not None and start <= last[1] + gap:
            last[1] = max(last[1], end)
            continue
        if last is not None:
            yield max(last[0], window[0]), min(last[1], window[1])
        last = [start, end]
    if last is not None:
        yield max(last[0], window[0]), min(last[1], window[1])
