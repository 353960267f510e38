"""Do dart and horns keep the lever on its bank wherever the balance stands with the pin outside the fork?

The freedom of the lever is how far it can be turned off its bank before something stops it. As long as that is less than the
total lock, the tooth stays on the locking face and draw brings the lever back.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from watchsim.escapement.by_hand.hands import Integers
from watchsim.escapement.fork_and_pin import Balance, Entry
from watchsim.escapement.quantity import Quantity, single

SCAN = math.radians(1.0)  # of the balance
FINE = 1e-9  # rad of the balance: the worst place is known to that
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
FACES_CRESCENT = 1.5  # times the guard's freedom: the dart faces the crescent and the horns have to guard


@dataclass(frozen=True, slots=True)
class Safety:
    """Freedoms of the lever, from one bank, rad; nan where nothing stops it or the scene has no such part.

    guard   dart against safety roller, the pin opposite the fork
    horn    horns against pin where the dart faces the crescent: the largest
    worst   the largest over all places of the balance, at balance angle `worst_at` from rest; inf where the lever can cross
    guard_clearance: from dart to roller on the bank, m
    """

    guard: Quantity
    horn: Quantity
    worst: Quantity
    worst_at: float
    guard_clearance: float


def safety(balance: Balance, bank: float, side: float, entry: Entry) -> Safety | None:
    """Of the lever on the bank of that side; None where the scene declares nothing besides the fork that could stop it."""
    hands = balance.hands
    far = balance.rest + math.pi
    groups = np.array(hands.model.contacts.group)[balance.parts.to_balance]
    stop = balance.lever(bank, far, -side)
    if stop is None and not balance.parts.guarded:
        return None
    if stop is None:
        never = single(math.inf, 0.0)
        return Safety(never, single(math.nan, math.nan), never, math.pi, math.nan)
    own = int(hands.model.contacts.group[stop.contact])
    guarding, horns = balance.parts.to_balance[groups == own], balance.parts.to_balance[groups != own]

    def freedom(theta: float, ids: Integers) -> float:
        touch = balance.lever(bank, theta, -side, ids)
        return math.inf if touch is None else abs(touch.angle - bank)

    everything = balance.parts.to_balance
    guard = abs(stop.angle - bank)
    places = _outside(entry, far)
    free = [freedom(theta, everything) for theta in places]
    at, worst = _peak(lambda theta: freedom(theta, everything), places, free)
    dart = [freedom(theta, guarding) for theta in places]
    facing = [i for i, value in enumerate(dart) if value > FACES_CRESCENT * guard]
    horn = math.nan
    if facing and len(horns):
        chosen = [places[i] for i in facing]
        _, horn = _peak(lambda theta: freedom(theta, horns), chosen, [freedom(theta, horns) for theta in chosen])
    met = hands.meeting(stop.contact, balance.at(stop.angle, far))
    rate = met.rates[hands.body(balance.parts.lever)]
    error = hands.error(rate)
    return Safety(
        single(guard, error),
        single(horn, error),
        single(worst, error),
        (at - balance.rest + math.pi) % math.tau - math.pi,
        hands.gap(stop.contact, balance.at(bank, far)),
    )


def _outside(entry: Entry, far: float) -> list[float]:
    """Balance angles from opposite the fork up to where the pin comes in, and from there back to where it would knock."""
    width = abs((entry.angle - far + math.pi) % math.tau - math.pi)
    back = math.pi if entry.knock is None else abs(entry.knock - far)
    count = int((width + back) / SCAN)
    return [entry.angle - entry.way * (i * SCAN + FINE) for i in range(count)]


def _peak(function: Callable[[float], float], places: list[float], values: list[float]) -> tuple[float, float]:
    """Place and height of the largest value, by golden section between the neighbours of the highest place."""
    i = max(range(len(values)), key=values.__getitem__)
    if not math.isfinite(values[i]):
        return places[i], values[i]
    low, high = places[max(i - 1, 0)], places[min(i + 1, len(places) - 1)]
    best = (places[i], values[i])
    while abs(high - low) > FINE:
        one, two = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        first, second = function(one), function(two)
        best = max(best, (one, first), (two, second), key=lambda pair: pair[1])
        low, high = (low, two) if first > second else (one, high)
    return best
