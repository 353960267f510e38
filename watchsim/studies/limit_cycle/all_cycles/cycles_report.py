"""How are all cycles of a mechanism reported, and what becomes of swings that are not regular?"""

from __future__ import annotations

import dataclasses
import math

from watchsim.analysis.timing.beats import DAY, beats
from watchsim.analysis.verdicts.verdict_kinds import STOPS, TICKS, UNSETTLED
from watchsim.studies.limit_cycle.all_cycles.survey import Found, Span, Survey
from watchsim.studies.limit_cycle.all_cycles.swings_by_section import Swings
from watchsim.studies.limit_cycle.cycle import Cycle, Orbit, Range
from watchsim.studies.limit_cycle.judge import judged, run_from
from watchsim.studies.limit_cycle.measures import measures

FOLLOWED = 24  # periods: how long a swing that is not regular is watched


def with_all_cycles(cycle: Cycle, survey: Survey, swings: Swings) -> Cycle:
    """The cycle with all that the survey found."""
    ranges: list[Range] = []
    for span in survey.spans:
        found = _range(swings, survey, span)
        if found is None:
            continue
        if ranges and (ranges[-1].verdict, ranges[-1].cycle) == (found.verdict, found.cycle):
            ranges[-1] = dataclasses.replace(ranges[-1], to_deg=found.to_deg)
        else:
            ranges.append(found)
    return dataclasses.replace(cycle, cycles=tuple(_orbit(swings, found) for found in survey.cycles), starts=tuple(ranges))


def _orbit(swings: Swings, found: Found) -> Orbit:
    """Its amplitudes are half the ways between turning points, as those of a run."""
    parts = swings.known.parts
    got = swings(found.amplitudes[0], len(found.amplitudes))
    start = parts.level + swings.known.section.side * found.amplitudes[0]
    each = found.amplitudes if got.trouble else measures(got.events, parts, start, got.time).each
    rate = DAY * (parts.nominal / found.period - 1.0)
    return Orbit(tuple(math.degrees(one) for one in each), found.period, rate, found.multiplier, found.stable)


def _range(swings: Swings, survey: Survey, span: Span) -> Range | None:
    """What becomes of a swing from the middle of the span; None where the parts cannot stand so."""
    ends = int(swings.known.section.side), math.degrees(span.low), math.degrees(span.high)
    if span.cycle is not None:
        return Range(*ends, TICKS if swings.known.parts.wheel >= 0 else UNSETTLED, span.cycle)
    loop, parts = swings.known.loop, swings.known.parts
    state = swings.state_at(0.5 * (span.low + span.high))
    if state is None:
        return None
    run = run_from(loop, state, FOLLOWED * parts.period)
    name = judged(run).name
    if name not in (TICKS, UNSETTLED, None):
        return Range(*ends, name or UNSETTLED, None)
    reached = beats(run).amplitude_deg
    cycle = survey.end_of(math.radians(float(reached[-1])))[1] if len(reached) else None
    verdict = TICKS if cycle is not None else (span.verdict if span.verdict == STOPS else UNSETTLED)
    return Range(*ends, verdict, cycle)
