"""Which teeth are not locked while the oscillator is away?

Between two beats a tooth should rest on a locking face and hold, or draw, the lever on its banking. A tooth that landed on an
impulse face, or a wheel that turns the wrong way, drives the lever off instead, until its dart rubs on the roller.
"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.averages import last_window
from watchsim.analysis.verdicts.arms import arms
from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.in_force import in_force
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.event_kinds import EventKind


def unlocked(watch: Watch) -> list[tuple[float, str, Face]]:
    """Of the turning points in the last window: time (s), contact in words and face of each tooth that drives the lever off."""
    if watch.lever is None or not len(watch.found):
        return []
    start, _ = last_window(watch.run, watch.found.nominal_period)
    times = watch.found.end[watch.found.end >= start]
    times = times[watch.recorded(times)]
    pallets = set(np.unique(watch.events(watch.lever, {watch.wheel}, *EventKind)["contact"]).tolist())
    bankings = set(np.unique(watch.events(watch.lever, watch.fixed, *EventKind)["contact"]).tolist())
    found = []
    for t, holding in zip(times.tolist(), in_force(watch.run, times.tolist()), strict=True):
        own = [number for number in holding if number in pallets]
        if not own or bankings.intersection(holding):
            continue
        told = arms(watch.run, t, own)
        faces = [face(watch, told, row) for row in range(len(own))]
        found += [(t, str(pair), one) for pair, one in zip(told.pairs, faces, strict=True) if one.impulse]
    return found
