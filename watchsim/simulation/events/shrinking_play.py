"""Does a contact rebound without end, because the play in which it does closes?

A body that lies nearly flat and rocks from corner to corner is hit at one end and thrown back from the other. Where friction
holds each end for the moment of its impact, an impact without loss sends it back the way it came: it rocks as fast as before,
in a play that the drives close. The impacts come ever sooner and never end (docs/theory/method.md 2.9). What resists
comes back faster: in half the time sqrt(2) times as fast, be it between walls or against a force.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.tolerances import ENDLESS_REBOUNDS, SAME_RATE, SHRUNK_PLAY


@kernel
def end_endless(state, m, options, event, room):
    """Take the restitution from those of the m closed contacts that would rebound without end; True if from any."""
    found = False
    for i in range(m):
        rate = event.closed.kin[i].gN_dot
        hit = rate < -event.zero[i] and room.restitution[i] > 0.0
        if hit and _comes_back_endlessly(state, options, event.closed.ids[i], rate):
            room.restitution[i], found = 0.0, True
    return found


@kernel
def _comes_back_endlessly(state, options, k, rate):
    """Note that contact k is hit at this gap rate; True if it is back ever sooner, though no faster.

    Within `accumulation_time` each time, `ENDLESS_REBOUNDS` times at least, and in the end in `SHRUNK_PLAY` of the first time.
    """
    seen, time = state.returning, state.clock.time
    away = time - seen.last
    if seen.contact != k or away == 0.0:
        if away > options.accumulation_time:  # nor does the other one come back as soon
            seen.contact, seen.last, seen.hits = k, time, 0
        return False
    seen.last = time
    if away > options.accumulation_time:
        seen.hits = 0
        return False
    if seen.hits == 0 or abs(rate - seen.rate) > SAME_RATE * abs(seen.rate):
        seen.hits, seen.away, seen.rate = 0, away, rate
    seen.hits += 1
    return seen.hits > ENDLESS_REBOUNDS and away <= SHRUNK_PLAY * seen.away
