"""When does something happen: events to step to, phases with names, and noises?"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from watchsim.analysis.timing.phases import Phase
from watchsim.analysis.timing.timegrapher import noises
from watchsim.pages.player.packed import doubles, floats
from watchsim.render.frame.pose_history import Window
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.storage.columns import rows_where
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
MOST = 3000  # instants
NAMED = 3  # events of one instant that are put into words
FAINT = 1e-4  # of the loudest noise: cannot be heard


def instants(run: Trajectory, window: Window) -> list[list[Any]]:
    """[t (s), what happens] for every instant with events, in order; the faintest left out where there are too many."""
    start, end = window
    events = rows_where(
        run.events, lambda part: (part["t"] >= start) & (part["t"] <= end) & (part["kind"] != EventKind.HANDOVER)
    )
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
    times, energies = noises(run, *window)
    energies = np.maximum(energies, 0.0)
    loudest = float(energies.max(initial=0.0))
    if loudest <= 0.0:
        return {"t": doubles([]), "loud": floats([])}
    audible = energies >= FAINT * loudest
    return {"t": doubles(times[audible]), "loud": floats(np.sqrt(energies[audible] / loudest))}


def named(found: list[Phase], window: Window) -> list[list[Any]]:
    """[name, start, end] of the phases that reach into the window."""
    return [[phase.name, phase.start, phase.end] for phase in found if phase.end > window[0] and phase.start < window[1]]
