"""Which teeth are not locked while the oscillator is away?

Between two beats a tooth should rest on a locking face and hold, or draw, the lever on its banking. A tooth that landed on an
impulse face, or a wheel that turns the wrong way, drives the lever off instead, until its dart rubs on the roller. Where a
lever has no banking, as in clocks with recoil, nothing can be said.
"""

from __future__ import annotations

import math

from watchsim.analysis.timing.averages import last_window
from watchsim.analysis.verdicts.equilibrium.in_force import in_force
from watchsim.analysis.verdicts.equilibrium.lever_arms import Arms, arms
from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.watch import Watch

GRAZING = 0.05  # of the distance from the staff: a dart on its roller has less of an arm, a pin in the fork more
MANY = 8  # turning points


def unlocked(watch: Watch) -> list[tuple[float, str, Face]]:
    """Of the turning points in the last window: time (s), contact in words and face of each tooth that drives the lever off.

    A small swing turns back while the fork still holds the pin, on an impulse face too: that counts only where it is so always.
    """
    if watch.lever is None or not len(watch.found) or not watch.has_banking:
        return []
    start, _ = last_window(watch.run, watch.found.nominal_period)
    times = watch.found.end[watch.recorded(watch.found.end)]
    times = times[times >= start] if len(times) and times[-1] >= start else times[-MANY:]
    pallets, forks, bankings = (
        watch.contacts(watch.lever, others) for others in ({watch.wheel}, {watch.oscillator}, watch.fixed)
    )
    free, engaged = [], []
    for t, holding in zip(times.tolist(), in_force(watch.run, times.tolist()), strict=True):
        own, pins = ([number for number in holding if number in some] for some in (pallets, forks))
        if not own or bankings.intersection(holding):
            continue
        if not watch.has_shapes:
            return []
        told = arms(watch.run, watch.compiled, t, [*own, *pins])
        driven = [(t, str(told.pairs[row]), one) for row in range(len(own)) if (one := face(watch, told, row)).impulse]
        if any(_engaged(watch, told, row) for row in range(len(own), len(told.pairs))):
            engaged += driven
        else:
            free += driven
    always = len(times) >= MANY and len(engaged) + len(free) >= len(times)
    return sorted(free + engaged, key=lambda one: one[0]) if always else free


def _engaged(watch: Watch, told: Arms, row: int) -> bool:
    x, y, _ = told.places[watch.oscillator]
    arm, _ = told.of(row, watch.oscillator)
    return abs(arm) > GRAZING * math.hypot(told.point[row, 0] - x, told.point[row, 1] - y)
