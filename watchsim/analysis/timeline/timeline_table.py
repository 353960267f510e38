"""How is the timeline of some beats printed: one table of motion, one of energy?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.analysis.timeline.rows import Stage
from watchsim.analysis.timeline.shown_beats import Beat, shown_beats
from watchsim.scene.roles import roles
from watchsim.simulation.record.trajectory import Trajectory

NANO, KILO = 1e9, 1e-3
WIDTH = 20


def title(stage: Stage) -> str:
    """What a phase is called, with what is pushed: as in phases.csv and on the page."""
    return f"{stage.name} on {stage.phase.on}" if stage.phase.on else stage.name


def timeline_text(run: Trajectory, told: list[Beat] | None = None) -> str:
    """Both tables of some beats (see `shown_beats`), by default of the last oscillation; ValueError as there."""
    told = told or shown_beats(run)
    return "\n".join([*_motion(run, told), "", *_energy(told)])


def _motion(run: Trajectory, told: list[Beat]) -> Iterator[str]:
    parts = roles(run.scene)
    names = [str(name)[:13] for name in (parts.wheel, parts.lever, parts.oscillator)]
    yield f"Timeline, t = {told[0].start:.6f} s to {told[-1].end:.6f} s"
    yield "angles in degrees and angular velocities in 1000 °/s, at the start of each phase; times in ms from the first touch"
    yield f"{'':{WIDTH}}{'start':>9}{'length':>9} " + "".join(f" {name:>19}" for name in names)
    yield f"{'':{WIDTH}}{'ms':>9}{'ms':>9} " + f" {'°':>10} {'1000°/s':>8}" * 3
    for beat in told:
        yield _heading(beat)
        for stage in beat.stages:
            phase = stage.phase
            times = f"{1e3 * (phase.start - beat.start):9.3f}{1e3 * (phase.end - phase.start):9.3f} "
            places = (
                f" {math.degrees(angle):10.3f} {KILO * math.degrees(rate):8.3f}"
                for angle, rate in zip(phase.angles, stage.start_rates, strict=True)
            )
            yield f"  {title(stage):{WIDTH - 2}}{times}" + "".join(places)
        last = beat.stages[-1]
        places = (
            f" {math.degrees(angle):10.3f} {KILO * math.degrees(rate):8.3f}"
            for angle, rate in zip(last.end_angles, last.end_rates, strict=True)
        )
        yield f"  {'end':{WIDTH - 2}}{1e3 * (beat.end - beat.start):9.3f}{'':9} " + "".join(places)


def _heading(beat: Beat) -> str:
    stone = beat.stages[0].pallet
    of = f", {stone} stone" if stone else ""
    return f"beat {beat.stages[0].beat}{of}, t = {beat.start:.6f} s"


def _energy(told: list[Beat]) -> Iterator[str]:
    rubbed = sorted({pair for beat in told for one in beat.friction for pair in one})
    struck = sorted({pair for beat in told for stage in beat.stages for pair in stage.energy.impacts})
    columns = [
        "supplied",
        "to balance",
        "stored",
        "damping",
        *(f"f {pair}" for pair in rubbed),
        *(f"i {pair}" for pair in struck),
    ]
    wide = [max(11, len(name) + 2) for name in columns]
    yield "energy in nJ; f: friction, i: impacts; to balance: work of all contacts on the oscillator; impulse on it in nN·m·s"
    yield f"{'':{WIDTH}}{'impulse':>9}" + "".join(f"{name:>{w}}" for name, w in zip(columns, wide, strict=True))
    for beat in told:
        yield _heading(beat)
        lines = [_values(stage, one, rubbed, struck) for stage, one in zip(beat.stages, beat.friction, strict=True)]
        sums = [sum(column) for column in zip(*lines, strict=True)]
        for stage, values in zip(beat.stages, lines, strict=True):
            cells = "".join(f"{_nano(value):>{w}}" for value, w in zip(values, wide, strict=True))
            yield f"  {title(stage):{WIDTH - 2}}{NANO * stage.impulse:9.3f}{cells}"
        impulse = NANO * sum(stage.impulse for stage in beat.stages)
        yield f"  {'together':{WIDTH - 2}}{impulse:9.3f}" + "".join(
            f"{_nano(value):>{w}}" for value, w in zip(sums, wide, strict=True)
        )
        if sums[0] > 0.0:
            yield f"  {'of what is supplied':{WIDTH - 2}}{'':8}" + "".join(
                f"{100.0 * value / sums[0]:>{w - 2}.2f} %" for value, w in zip(sums, wide, strict=True)
            )
            yield f"  the account closes to {abs(beat.residual):.1e} J, {abs(beat.residual) / sums[0]:.1e} of what is supplied"


def _values(stage: Stage, friction: dict[str, float], rubbed: list[str], struck: list[str]) -> list[float]:
    e = stage.energy
    pairs = [*(friction.get(pair, 0.0) for pair in rubbed), *(e.impacts.get(pair, 0.0) for pair in struck)]
    return [e.supplied, e.to_balance, e.stored, e.damping, *pairs]


def _nano(value: float) -> str:
    """In nJ; a dash where it is nothing."""
    return "-" if value == 0.0 else f"{NANO * value + 0.0:.4f}"
