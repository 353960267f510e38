"""Which teeth are not locked while the oscillator is away?

Between two beats a tooth should rest on a locking face and hold, or draw, the lever on its banking. A tooth that landed on an
impulse face, or a wheel that turns the wrong way, drives the lever off instead, until its dart rubs on the roller.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.averages import last_window
from watchsim.analysis.verdicts.arms import Arms, arms
from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.in_force import in_force
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.event_kinds import EventKind

GRAZING = 0.05  # of the distance from the staff: a dart on its roller has less of an arm, a pin in the fork more


def unlocked(watch: Watch) -> list[tuple[float, str, Face]]:
    """Of the turning points in the last window: time (s), contact in words and face of each tooth that drives the lever off."""
    if watch.lever is None or not len(watch.found) or not watch.has_shapes:
        return []
    start, _ = last_window(watch.run, watch.found.nominal_period)
    times = watch.found.end[watch.found.end >= start]
    times = times[watch.recorded(times)]
    pallets = set(np.unique(watch.events(watch.lever, {watch.wheel}, *EventKind)["contact"]).tolist())
    forks = set(np.unique(watch.events(watch.lever, {watch.oscillator}, *EventKind)["contact"]).tolist())
    bankings = set(np.unique(watch.events(watch.lever, watch.fixed, *EventKind)["contact"]).tolist())
    found = []
    for t, holding in zip(times.tolist(), in_force(watch.run, times.tolist()), strict=True):
        own = [number for number in holding if number in pallets]
        if not own or bankings.intersection(holding):
            continue
        pins = [number for number in holding if number in forks]
        told = arms(watch.run, watch.compiled, t, [*own, *pins])
        if any(_engaged(watch, told, row) for row in range(len(own), len(told.pairs))):
            continue  # a small swing turns back while the fork still holds the pin
        faces = [face(watch, told, row) for row in range(len(own))]
        found += [(t, str(pair), one) for pair, one in zip(told.pairs, faces, strict=False) if one.impulse]
    return found


def _engaged(watch: Watch, told: Arms, row: int) -> bool:
    x, y, _ = told.places[watch.oscillator]
    arm, _ = told.of(row, watch.oscillator)
    return abs(arm) > GRAZING * math.hypot(told.point[row, 0] - x, told.point[row, 1] - y)
