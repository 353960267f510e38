"""What does the watch settle to, without waiting until it has?

The limit cycle is a fixed point of the return map, the one that the scene's own run comes to (attractor.py), closed over a
whole turn of the wheel (return_map.py). Where there is none, an ordinary run from the scene's start shows what happens instead.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from watchsim.analysis.timing import DAY
from watchsim.analysis.verdict import blows_that_turn
from watchsim.analysis.verdict_kinds import BACKWARDS, TICKS, UNSETTLED
from watchsim.escapement.measure import wrong_way
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.roles import is_driven, only_presses, roles
from watchsim.scene.scene import Scene
from watchsim.scene.toml import key_lines
from watchsim.simulation.recording import pairs_of
from watchsim.simulation.state import State, Stop
from watchsim.simulation.systems import systems_of
from watchsim.studies.all_cycles import Survey, Swings, judged, late_means, less_sure, run_from, with_all_cycles
from watchsim.studies.attractor import Led, attractor, moved_on
from watchsim.studies.cycle import Cycle
from watchsim.studies.return_map import (
    CAUTION,
    COARSER,
    FINER,
    Fixed,
    Lost,
    Polished,
    Return,
    ReturnMap,
    fixed_point,
    glanced,
    polished,
    polished_over,
    repeats,
)
from watchsim.studies.section import (
    Events,
    Loop,
    NoSection,
    Parts,
    first_section,
    parts_of,
    turns,
    why_no_section,
    with_springs_held,
)
from watchsim.tolerances import COARSEST_TOLERANCE, FINEST_TOLERANCE

# Does anything keep an oscillator going? If not, there is no limit cycle to ask for.

WHAT = "nothing keeps an oscillator going here"
WHY = "so there is no limit cycle to look for"
INSTEAD = "Give the wheel of an escapement a torque, or simulate the scene with `watchsim run`"


def nothing_swings(scene: Scene) -> SceneError | None:
    """Where no body swings, or the only ones that do are lifted and let go by bodies that move as the scene says."""
    oscillator = roles(scene).oscillator
    if oscillator is None:
        return _refused(scene, "no body swings on a spring or by gravity")
    if only_presses(scene) and not is_driven(scene):
        moved = [body.name for body in scene.bodies if body.prescribed is not None]
        moves = "moves" if len(moved) == 1 else "move"
        return _refused(scene, f"{oscillator} is sprung, {' and '.join(moved)} {moves} as the scene says, and no torque acts")
    return None


def nothing_lets_go(scene: Scene) -> SceneError | None:
    """Where a driven wheel touches a sprung body that did not swing: a click holds it, and no escapement lets it go."""
    found = roles(scene)
    if found.wheel is None or not only_presses(scene):
        return None
    return _refused(scene, f"{found.wheel} is driven, {found.oscillator} is sprung and rests on it, and did not swing")


def _refused(scene: Scene, seen: str) -> SceneError:
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if scene.path and scene.path.is_file() else {}
    faults = Faults(str(scene.path or "scene"), lines)
    faults.add("torques" if scene.torques else "springs", f"{WHAT}: {seen}, {WHY}. {INSTEAD}")
    return SceneError(faults.found)


TURNS = 6  # of the wheel, until what stands still comes back to its place
AFTERWARDS = 24  # periods of the run that shows what happens where there is no cycle
LONGEST = 120.0  # s, of a run that stands in for a cycle, at first
FEWEST = 40  # periods of it
LONGER, MOST = 4.0, 2000  # times as long, and periods at most, where it has not settled by then
SETTLED = 1e-4  # of the amplitude: what such a run may still scatter and drift
LOSSLESS = 1e-9  # of the amplitude, in one oscillation
DIES = "its swing dies away within an oscillation"
NO_REPEAT = "its swing does not repeat itself"
ASIDE = 0.01  # of the amplitude: beside an unstable cycle, to see where it is left for


def steady(
    scene: Scene | str | Path,
    *,
    tolerance: float | None = None,
    amplitude: float | None = None,
    brief: bool = False,
    slope: float | None = None,
    all_cycles: bool = False,
) -> Cycle:
    """The limit cycle that the scene's start leads to: amplitude, rate, beat error and stability, each with its error.

    scene      a scene, or the file or folder that holds one
    tolerance  relative error per step (default the scene's own)
    amplitude  rad (m), where the search is to begin instead of at the first turning point of the scene's own start
    brief      one oscillation on the cycle is enough: without errors, multipliers and a look at all teeth of the wheel
    slope      with an amplitude: of the return map at the cycle of a scene that differs little from this one
    all_cycles  look at swings of all sizes for every cycle, stable or not, and say which of them each swing leads to

    Where there is no cycle `found` is False, and `verdict` and `message` say what there is instead. ValueError for a bad
    argument; SceneError where bodies overlap at the start, and where nothing keeps an oscillator going. A mainspring stays as
    far wound as the scene says.
    """
    begun = time.perf_counter()
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    tolerance = scene.tolerance if tolerance is None else float(tolerance)
    if not FINEST_TOLERANCE <= tolerance <= COARSEST_TOLERANCE:
        raise ValueError(f"the tolerance must lie between {FINEST_TOLERANCE:g} and {COARSEST_TOLERANCE:g}, not {tolerance}")
    if amplitude is not None and not (amplitude > 0.0 and math.isfinite(amplitude)):
        raise ValueError(f"the amplitude must be a positive number of rad (m), not {amplitude}")
    if refused := nothing_swings(scene):
        raise refused
    loop = Loop(with_springs_held(_own_system(scene)), tolerance)
    ready = time.perf_counter()
    loop.warm_up()
    warm = time.perf_counter()
    cycle = _searched(loop, Search(amplitude, brief, slope, all_cycles))
    if not cycle.found and cycle.period_s is None and (refused := nothing_lets_go(scene)):
        raise refused
    wall = time.perf_counter() - begun - (warm - ready)
    return dataclasses.replace(cycle, simulated_s=loop.simulated, cells_s=loop.finder.seconds, wall_s=wall)


def _own_system(scene: Scene) -> Scene:
    """The scene without what cannot influence its escapement, such as a second watch beside it."""
    found = roles(scene)
    return next((part for part in systems_of(scene) if roles(part) == found), scene)


class Search(NamedTuple):
    """What was asked for, as in `steady`."""

    amplitude: float | None
    brief: bool
    slope: float | None
    all_cycles: bool


def _searched(loop: Loop, search: Search) -> Cycle:
    parts = parts_of(loop.scene, loop.compiled)
    if parts is None:
        return Cycle(False, None, "nothing in this scene swings on a spring or by gravity, so nothing repeats itself")
    if why := why_no_section(loop.compiled, parts):
        return _by_run(loop, parts, why)
    state = loop.begin()
    section = first_section(loop, parts, state)
    if isinstance(section, NoSection):
        if section.still or not is_driven(loop.scene):
            if parts.wheel < 0:
                return Cycle(False, None, DIES)
            return _by_run(loop, parts, DIES, section.time)
        return _by_run(loop, parts, "at no turning point of the oscillator does everything else stand still")
    if not is_driven(loop.scene):
        return _alone(ReturnMap(loop, parts, section))
    if search.amplitude is not None:
        begin = section.at(loop, parts, search.amplitude)
        if begin is None:
            return Cycle(False, None, "the parts cannot stand still at that amplitude")
        section = dataclasses.replace(section, state=begin, amplitude=search.amplitude)
    led = attractor(loop, parts, section, None if search.amplitude is None else search.slope)
    cycle = _shot(led, search.brief, None if search.amplitude is None else section.state)
    if not search.all_cycles:
        return cycle
    swings = Swings(led.oscillate)
    return with_all_cycles(cycle, Survey(swings, led.found.amplitude), swings)


def _shot(led: Led, brief: bool, state: State | None) -> Cycle:
    """What the run goes to, and how exactly it is known; `state` where it began, None at the scene's start."""
    oscillate, found = led.oscillate, led.found
    loop, parts = oscillate.loop, oscillate.parts
    if brief and isinstance(found, Fixed) and abs(found.slope) < 1.0:
        return _cycle(loop, parts, glanced(oscillate, found))
    others = _otherwise(loop)
    if isinstance(found, Lost):
        again = _after_several(oscillate, found.amplitude, others) if found.trouble == UNSETTLED else None
        return again or _by_run(loop, parts, NO_REPEAT, led.time + AFTERWARDS * parts.period, state, brief)
    exact = _closed(oscillate, found, others)
    loop.simulated += sum(other.simulated for other in others)
    if isinstance(exact, Return):
        return _by_run(loop, parts, NO_REPEAT, led.time + FEWEST * parts.period, state)
    if exact.multiplier is None or not abs(exact.multiplier) < 1.0:
        return _after_several(oscillate, (1.0 + ASIDE) * found.amplitude, others) or _unstable(loop, parts, exact)
    return _cycle(loop, parts, exact)


def _otherwise(loop: Loop) -> tuple[Loop, ...]:
    """The same with a solver that is more exact, and with one that is less so."""
    exact_to = (max(FINER * loop.tolerance, FINEST_TOLERANCE), min(COARSER * loop.tolerance, COARSEST_TOLERANCE))
    return tuple(Loop(loop.scene, tolerance, like=loop) for tolerance in exact_to)


def _closed(oscillate: ReturnMap, found: Fixed, others: Sequence[Loop]) -> Polished | Return:
    """The cycle over a whole turn of the wheel, after which all that stands still has come back to its place.

    A remontoir is wound once in several oscillations: the section moves on by a turn until nothing depends on where it began.
    """
    exact, moved = polished(oscillate, found, others), 0.0
    for _ in range(TURNS):
        section = None if isinstance(exact, Return) else moved_on(oscillate, exact.turn)
        if isinstance(exact, Return) or section is None:
            return exact
        oscillate = ReturnMap(oscillate.loop, oscillate.parts, section)
        again = fixed_point(oscillate, exact.amplitude)
        if isinstance(again, Lost):
            break
        before, exact = exact, polished(oscillate, again, others)
        if not isinstance(exact, Return):
            moved = abs(exact.means.amplitude - before.means.amplitude)
    return exact if isinstance(exact, Return) else exact.moved_by(CAUTION * moved)


def _after_several(oscillate: ReturnMap, amplitude: float, others: Sequence[Loop]) -> Cycle | None:
    """A stable cycle of several oscillations that the orbit from there runs to; None without one."""
    found = repeats(oscillate, amplitude)
    if found is None:
        return None
    loop, number = oscillate.loop, found[0]
    exact = polished_over(oscillate, found[1], number, others)
    if isinstance(exact, Return) or exact.multiplier is None or not abs(exact.multiplier) < 1.0:
        return None
    if abs(exact.amplitude - found[1]) > ASIDE * ASIDE * found[1]:
        return None  # another one than the orbit's
    cycle = _cycle(loop, oscillate.parts, exact)
    if number == 1:
        return cycle
    each = tuple(math.degrees(one) for one in exact.means.each) if cycle.amplitude_deg is not None else ()
    sizes = ", ".join(f"{one:.6g}°" for one in each)
    message = f"it repeats itself only after {number} oscillations, which differ: {sizes or 'their sizes'} in turn"
    return dataclasses.replace(cycle, message=message, amplitudes_deg=each)


def _cycle(loop: Loop, parts: Parts, exact: Polished) -> Cycle:
    """A cycle in watchmakers' units."""
    means = exact.means
    return Cycle(
        found=True,
        verdict=_ticks(loop, parts),
        message=_blows(loop, parts, exact.turn.events) or wrong_way(loop.scene) or "",
        amplitude_deg=_degrees(loop, parts, means.amplitude),
        amplitude_deg_error=_degrees(loop, parts, exact.amplitude_error),
        period_s=means.period,
        period_s_error=exact.period_error,
        rate_s_per_d=DAY * (parts.nominal / means.period - 1.0),
        rate_s_per_d_error=_times(DAY * parts.nominal / means.period**2, exact.period_error),
        beat_error_ms=1e3 * abs(means.uneven),
        beat_error_ms_error=_times(1e3, exact.beat_error_error),
        uneven_ms=1e3 * means.uneven,
        multipliers=() if exact.multiplier is None else (exact.multiplier,),
        multipliers_error=() if exact.multiplier_error is None else (exact.multiplier_error,),
        oscillations=exact.per,
        tooth_spread_deg=_degrees(loop, parts, means.spread),
    )


def _ticks(loop: Loop, parts: Parts) -> str | None:
    """The verdict on a cycle: it is none of a watch whose teeth lock only when they are driven the other way."""
    return None if parts.wheel < 0 else BACKWARDS if wrong_way(loop.scene) else TICKS


def _blows(loop: Loop, parts: Parts, events: Events) -> str:
    """What ends the swings of a cycle, where that is a blow in half of them; "" where they end by themselves."""
    ends = turns(events, parts)["t"]
    blows, met = blows_that_turn(events, parts.touching, ends)
    count = int(met.sum())
    if not count or 2 * count < len(ends):
        return ""
    pair = pairs_of(loop.compiled)[int(blows["contact"][np.argmax(blows["impulse_normal"])])]
    return f"{count} of its {len(ends)} half swings end with a blow ({pair}): without it they would be larger"


def _degrees(loop: Loop, parts: Parts, value: float | None) -> float | None:
    """None for a body that slides."""
    angular = loop.scene.bodies[parts.body].motion == "pivot"
    return math.degrees(value) if angular and value is not None else None


def _times(factor: float, value: float | None) -> float | None:
    return None if value is None else factor * value


def _unstable(loop: Loop, parts: Parts, exact: Polished) -> Cycle:
    """A cycle that the mechanism leaves at the slightest disturbance: what it does then."""
    cycle = _cycle(loop, parts, exact)
    multiplier = exact.multiplier or 0.0
    how = "it swings too far and too little in turn" if multiplier < 0.0 else "it runs away from it"
    message = f"there is a cycle, but an unstable one (multiplier {multiplier:.3g}): disturbed, {how}"
    return dataclasses.replace(cycle, found=False, verdict=UNSETTLED, message=message)


def _alone(oscillate: ReturnMap) -> Cycle:
    """What swings without a drive."""
    start = oscillate.section.amplitude
    got = oscillate(start)
    if got.trouble:
        return Cycle(False, None, f"nothing drives it, and {DIES}")
    ratio = got.amplitude / start
    if abs(1.0 - ratio) <= LOSSLESS:
        message = "nothing drives it and nothing brakes it: it keeps any amplitude that it is given"
    elif ratio > 1.0:
        message = f"nothing drives it, and yet its swing grows by {100.0 * (ratio - 1.0):.3g} % in an oscillation"
    else:
        quality = math.pi / -math.log(ratio)
        lost = f"{100.0 * (1.0 - ratio):.3g} % of its swing in an oscillation of {got.time:.9g} s"
        message = f"nothing drives it: it loses {lost} (Q = {quality:.4g}), and comes to rest"
    return Cycle(False, None, message, multipliers=(ratio,))


def _by_run(
    loop: Loop, parts: Parts, why: str, duration: float | None = None, state: State | None = None, brief: bool = False
) -> Cycle:
    """What an ordinary run settles to, from the scene's start or from that state; `brief`: what tolerance adds to its error is
    not looked at."""
    if duration is None:
        duration = min(max(loop.scene.duration, FEWEST * parts.period), max(LONGEST, FEWEST * parts.period))
    while True:
        run = run_from(loop, state, duration)
        if run.stop == Stop.OVERLAP and state is not None:  # where parts cannot be at the amplitude that was given
            state = None
            continue
        seen = judged(run, since_start=state is None)
        means = late_means(run)
        message = f"{why}; this is the end of a run of {run.simulated:.4g} s"
        if means.amplitude_deg is None or seen.name not in (TICKS, UNSETTLED, None):
            return Cycle(False, seen.name, seen.message or message)
        settled = (means.amplitude_deg_error or math.inf) <= SETTLED * means.amplitude_deg
        if settled or run.stop != Stop.DURATION or duration >= MOST * parts.period:
            break
        duration = min(LONGER * duration, MOST * parts.period)
    if settled and not brief:
        others = _otherwise(loop)
        means = less_sure(means, [late_means(run_from(other, state, duration)) for other in others])
        loop.simulated += sum(other.simulated for other in others)
    return Cycle(
        found=settled,
        verdict=_ticks(loop, parts) if settled else UNSETTLED,
        message=message if settled else f"{message}, which has not settled",
        amplitude_deg=means.amplitude_deg,
        amplitude_deg_error=means.amplitude_deg_error,
        period_s=means.period_s,
        period_s_error=means.period_s_error,
        rate_s_per_d=means.rate_s_per_d,
        rate_s_per_d_error=means.rate_s_per_d_error,
        beat_error_ms=means.beat_error_ms,
        beat_error_ms_error=means.beat_error_ms_error,
    )
