"""Where does the scene's own run go?

Newton's steps leap: from far away they may end at another cycle than the one that the run comes to, or where nothing works. So
the run itself is followed, oscillation by oscillation, and now and then a search is begun where it has come to. A fixed point
counts where the run goes there: on the whole way from the run to it the return map leads towards it, and evenly.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from watchsim.analysis.verdict_kinds import STOPS, TRIPS, UNSETTLED
from watchsim.simulation.state import State
from watchsim.simulation.trajectory import Array
from watchsim.studies.return_map import Fixed, Lost, Return, ReturnMap, fixed_point
from watchsim.studies.section import (
    Loop,
    NoSection,
    Parts,
    Section,
    SolverGaveUp,
    copied,
    first_section,
    section_at,
    section_from,
    turns,
)

FIRST = 8  # oscillations of the run before the second search; twice as many before each of the next
MOST, MOST_ROUGH = 3000, 400  # oscillations in all; of a run in which each other stretch is not regular
LOOKS = 8  # swings that are looked at on the way from the run to a fixed point
LIKE_LOOKS = 4  # the same of a scene that differs little from one that was looked at so closely
EVEN = 0.8  # the map leads to it by shares of the way that differ by no more than that, smallest by largest
THERE = 1e-7  # of the amplitude: so near the way is not looked at
LONG, NO_DRIFT = 250, 0.05  # oscillations; of their spread: a longer stretch that drifts by less wanders about
RACES = 3.0  # teeth in an oscillation: the wheel runs through
REST = 1e-12  # rad or m per scale: bodies that stand still come back so closely, or the section is moved on
SECTIONS = 6  # of them at most


class Led(NamedTuple):
    """Where the run has come to: the return map there, a fixed point or what there is instead, and the swings of its last
    stretch (rad or m; those of one side), after `time` (s)."""

    oscillate: ReturnMap
    found: Fixed | Lost
    swings: Array
    time: float


def attractor(loop: Loop, parts: Parts, section: Section, like: float | None = None) -> Led:
    """What a run that turns at this section goes to; `like`: the slope of the map at the cycle of a scene like this one."""
    looks = LOOKS if like is None else LIKE_LOOKS
    state, time, count, done, rough = copied(section.state), 0.0, FIRST, 0, 0
    oscillate, found = _searched(loop, parts, section, like)
    swings = np.array([section.amplitude])
    while isinstance(found, Lost) or not _leads_to(oscillate, section.amplitude, found, looks):
        if done >= MOST or rough >= MOST_ROUGH or _wanders(swings):
            trouble = found.trouble if isinstance(found, Lost) and rough else UNSETTLED
            return Led(oscillate, Lost(section.amplitude, trouble, False), swings, time)
        try:
            swings, trouble = _followed(loop, parts, section.side, state, count)
            done, rough, count = done + count, rough + count if trouble else 0, 2 * count
            time = float(state.clock.time)
            now = first_section(loop, parts, copied(state))
        except SolverGaveUp as failure:
            return Led(oscillate, Lost(section.amplitude, str(failure), False), swings, time)
        if trouble == TRIPS or isinstance(now, NoSection):
            ended = trouble or (STOPS if isinstance(now, NoSection) and now.still else UNSETTLED)
            return Led(oscillate, Lost(section.amplitude, ended, False), swings, time)
        section = now
        oscillate, found = _searched(loop, parts, section)
    return Led(oscillate, found, swings, time)


def _wanders(swings: Array) -> bool:
    """Does a long stretch of the run go neither up nor down, nor come to rest?"""
    if len(swings) < LONG:
        return False
    earlier, later = swings[-2 * (len(swings) // 2) :].reshape(2, -1)
    spread = float(np.ptp(later))
    settles = spread <= max(THERE * abs(float(later[-1])), 0.5 * float(np.ptp(earlier)))
    return not settles and abs(float(later.mean() - earlier.mean())) < NO_DRIFT * spread


def _followed(loop: Loop, parts: Parts, side: float, state: State, count: int) -> tuple[Array, str]:
    """The turning points on one side in about so many oscillations of the run, and what is not regular in it."""
    before = float(state.q[parts.wheel]) if parts.wheel >= 0 else 0.0
    own = turns(loop.on(state, float(state.clock.time) + count * parts.period), parts)["value"] - parts.level
    teeth = parts.sense * (float(state.q[parts.wheel]) - before) / parts.pitch if parts.pitch and parts.wheel >= 0 else count
    if teeth > RACES * count:
        return side * own, TRIPS
    regular = len(own) > 1 and (np.sign(own[1:]) != np.sign(own[:-1])).all() and abs(teeth - count) < 2.0
    return side * own[own * side > 0.0], "" if regular else UNSETTLED


def _leads_to(oscillate: ReturnMap, amplitude: float, found: Fixed, looks: int) -> bool:
    """Does the map lead every swing between that amplitude and the fixed point towards it, by like shares of the way?"""
    way = amplitude - found.amplitude
    if abs(way) <= THERE * found.amplitude:
        return True
    shares = []
    for part in np.linspace(1.0, 0.0, looks, endpoint=False) ** 2:
        got = oscillate(found.amplitude + part * way)
        if got.trouble:
            return False
        shares.append(1.0 - (got.amplitude - found.amplitude) / (part * way))
    return min(shares) > 0.0 and min(shares) >= EVEN * max(shares)


def _searched(loop: Loop, parts: Parts, section: Section, like: float | None = None) -> tuple[ReturnMap, Fixed | Lost]:
    """The fixed point; the section moves on until what stands still at it comes back to its place."""
    amplitude = section.amplitude
    for _ in range(SECTIONS):
        oscillate = ReturnMap(loop, parts, section)
        found = fixed_point(oscillate, amplitude, like)
        again = None if isinstance(found, Lost) else moved_on(oscillate, oscillate(found.amplitude))
        if isinstance(found, Lost) or again is None:
            break
        section, amplitude = again, found.amplitude
    return oscillate, found


def moved_on(oscillate: ReturnMap, got: Return) -> Section | None:
    """The section at the end of a return where bodies at rest have not come back to their places; None where they have."""
    parts, loop, state = oscillate.parts, oscillate.loop, got.state
    if state is None:
        return None
    away = np.abs(state.q - oscillate.section.state.q)
    away = np.minimum(away, np.abs(np.remainder(away + np.pi, math.tau) - np.pi))  # a whole turn further is the same place
    away /= loop.compiled.model.coordinates.scale
    away[[parts.coordinate, *parts.train]] = 0.0
    if (away <= REST).all():
        return None
    return section_from(loop, parts, state) if oscillate.section.touching else section_at(loop, parts, state, got.time)
