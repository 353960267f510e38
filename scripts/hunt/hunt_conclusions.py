"""Is anything false concluded from the motion of random mechanisms with an oscillator?

Judges mechanisms `--start` to `--start + --count` of `--seed` (oscillators.py) and prints what is not fine, one a line, then a
table. Each is judged by

steady    against a run at 1e-11 from the scene's own start, as long as the multiplier says that settling takes: amplitudes must
          agree within the stated error and what the run still moves. No cycle: a run four times as long must not settle either
verdict   against the teeth that the recorded angle of the wheel passes and the zero crossings of the oscillator's
records   the summary must be the same to the last digit whether all, events or statistics are kept
scale     the same summary in other units of length and time, but where the motion forgets how it began

    python scripts/hunt/hunt_conclusions.py --count 300
    python scripts/hunt/hunt_conclusions.py --only 17 --judge steady

Ctrl-C and SIGTERM end it with the table of what was judged so far. Exit status: 0 all fine, 1 something was wrong.
"""

import argparse
import math
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

sys.path.extend([str(Path(__file__).resolve().parents[2] / part) for part in ("scripts", "tests", "tests/simulation")])

from scaled_scenes import scaled

import watchsim as ws
from hunt.oscillators import TEETH, mechanism
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory

FINEST = 1e-11
FEWEST, MOST = 60, 4000  # oscillations of a run that judges a cycle
LEFT = 1e-2  # of the stated error: what the run may still have to go, by the multiplier
SETTLED = 1e-6  # of the amplitude: a run whose means of a turn differ by less has settled
LONGER = 4.0  # times the longest run of the search: where no cycle was found
TURNS = 2  # of the wheel, in each mean
CARRIED = 480  # half swings in each, where gravity turns with a carriage: a minute
SHOWN = 20.0  # nominal periods of the run whose verdict is judged
RATE = 400  # samples in a period
OTHERWISE = {"wall_s", "compile_s", "realtime_factor", "kept", "scene_file", "versions", "counts", "expect"}
UNITS = 1e-6  # relative: summaries in other units, and the residual of energy is rounding
NUDGED = 1e-12  # of the torques: what changes as much by that says nothing about units
KEYS = ("amplitude_deg", "beats", "missed_beats", "verdict")


def teeth_of(scene: Scene) -> int:
    """Of the wheel that is judged: of two mechanisms the bodies of the second have a 2 in their names."""
    profiles = scene.title.rsplit(" ", 1)[0].split(" beside ")
    return TEETH[profiles[-1 if (roles(scene).wheel or "").endswith(" 2") else 0]]


def means(run: Trajectory, size: int) -> np.ndarray:
    """Mean amplitudes (degrees) of successive stretches of so many half swings, the last ones at the end of the run."""
    amplitudes = ws.beats(run).amplitude_deg
    count = len(amplitudes) // size
    return amplitudes[len(amplitudes) - count * size :].reshape(count, size).mean(axis=1)


def judge_steady(scene: Scene, note: Callable[[str], None]) -> Iterator[str]:
    cycle = ws.steady(scene)
    size = 2 * teeth_of(scene) * TURNS * (cycle.oscillations if cycle.oscillations not in (1, teeth_of(scene)) else 1)
    size = CARRIED if scene.body(roles(scene).oscillator or "").on else size  # a passing spring rides too, and turns nothing
    if not cycle.found:
        note(f"none: {cycle.verdict}")
        if cycle.verdict in ("ticks", "unsettled", None):
            yield from _settles(scene, cycle, size)
        return
    assert cycle.amplitude_deg is not None and cycle.amplitude_deg_error is not None and cycle.period_s is not None
    if math.isnan(cycle.amplitude_deg_error):
        yield f"steady: {cycle.amplitude_deg:.9g}° without an error: at another tolerance the solver gives up"
        return
    shares = [abs(one) ** (1.0 / cycle.oscillations) for one in cycle.multipliers]
    needed = (
        math.log(LEFT * cycle.amplitude_deg_error / cycle.amplitude_deg) / math.log(max([*shares, 0.1])) if shares else 1000.0
    )
    count = int(min(max(needed, FEWEST) + 2 * size, MOST))
    run = ws.simulate(scene, count * cycle.period_s, record="events", tolerance=FINEST)
    found = means(run, size)
    note("by a run" if not shares else "found" if needed + 2 * size < MOST else "found, run cut short")
    if len(found) < 2:
        yield f"steady: {cycle.amplitude_deg:.9g}° found, a run has {len(ws.beats(run))} half swings in {run.simulated:.4g} s"
        return
    move = abs(found[-1] - found[-2])
    left = (shares[0] ** (size / 2) if shares else 1.0) * move
    left = left / (1.0 - shares[0] ** (size / 2)) if shares else left
    away = abs(found[-1] - cycle.amplitude_deg)
    if away > cycle.amplitude_deg_error + 2.0 * left:
        known = f"{cycle.amplitude_deg:.9g}° ± {cycle.amplitude_deg_error:.1e}"
        yield (
            f"steady: {known} ({cycle.message or 'regular'}, multiplier {cycle.multipliers}), run of {run.simulated:.4g} s "
            f"{found[-1]:.9g}°, {away / cycle.amplitude_deg_error:.2g} errors off, moves by {move:.1e}"
        )


def _settles(scene: Scene, cycle: ws.Cycle, size: int) -> Iterator[str]:
    period = cycle.period_s or 1.0 / (ws.summary(ws.simulate(scene, 0.5, record="events"))["frequency_hz"] or 1.0)
    run = ws.simulate(scene, LONGER * max(120.0, 40 * period), record="events", tolerance=FINEST)
    found = means(run, size)
    if len(found) >= 3 and np.ptp(found[-3:]) <= SETTLED * found[-1]:
        yield f"steady: no cycle ({cycle.message}), but a run of {run.simulated:.4g} s settles at {found[-1]:.9g}°"


def judge_verdict(scene: Scene, note: Callable[[str], None]) -> Iterator[str]:
    """Against the wheel's recorded angle and the oscillator's, sampled evenly."""
    found = roles(scene)
    run = ws.simulate(scene, _shown(scene), record="all")
    numbers = ws.summary(run)
    note(str(numbers["verdict"]))
    if found.wheel is None or found.oscillator is None:
        yield f"verdict: no escape wheel or no oscillator ({found})"
        return
    times = np.linspace(0.0, run.simulated, int(RATE * SHOWN))
    q, _ = run.sample(times)
    teeth = teeth_of(scene)
    wheel, swing = q[:, run.slices[found.wheel].start], q[:, run.slices[found.oscillator].start]
    spring = next((one for one in scene.springs if one.body == found.oscillator), None)
    rest = spring.rest if spring else 0.5 * (swing.max() + swing.min())
    sense = math.copysign(1.0, wheel[-1] - wheel[0])
    half = math.pi / teeth
    late = times >= run.simulated - 4.0 / _hertz(numbers, run)
    passed = int((np.diff(np.sign(swing - rest)) != 0).sum())
    passed_late = int((np.diff(np.sign(swing[late] - rest)) != 0).sum())
    steps, steps_late = sense * (wheel[-1] - wheel[0]) / half, sense * (wheel[late][-1] - wheel[late][0]) / half
    seen = f"{steps:.2f} half pitches in {passed} passages, {steps_late:.2f} in the last {passed_late}"
    works = numbers["verdict"] in ("ticks", "unsettled")
    if works and abs(steps_late - passed_late) > 2.2:
        yield f"verdict: {numbers['verdict']}, but {seen}"
    missed = numbers["missed_beats"]
    if works and missed is not None and abs((passed - steps) - missed) > 3.2:
        yield f"verdict: {missed} missed, but {seen}"
    if numbers["verdict"] == "stops" and steps_late > 2.2:
        yield f"verdict: stops, but {seen}"
    if numbers["verdict"] == "trips" and abs(steps - passed) < 1.0 and abs(steps_late - passed_late) < 1.0:
        yield f"verdict: trips, but {seen} ({numbers['verdict_message']})"


def _hertz(numbers: dict[str, Any], run: Trajectory) -> float:
    return float(numbers.get("frequency_hz") or SHOWN / run.simulated)


def _shown(scene: Scene) -> float:
    from watchsim.scene.roles import frequency

    return SHOWN / (frequency(scene) or 1.0)


def concluded(scene: Scene, duration: float, record: str) -> dict[str, Any]:
    numbers = ws.summary(ws.simulate(scene, duration, record=record))
    return {key: value for key, value in numbers.items() if key not in OTHERWISE}


def judge_records(scene: Scene, note: Callable[[str], None]) -> Iterator[str]:
    everything = concluded(scene, _shown(scene), "all")
    for record in ("events", "statistics"):
        other = concluded(scene, _shown(scene), record)
        differ = [f"{key} {everything[key]!r} {other[key]!r}" for key in everything if everything[key] != other[key]]
        if differ:
            yield f"records: with {record} {'; '.join(differ)[:300]}"
    note("same")


def judge_scale(scene: Scene, note: Callable[[str], None]) -> Iterator[str]:
    if any(one.rows for one in scene.shocks) or scene.line_springs:
        return
    rng = np.random.default_rng(len(scene.title))
    length, unit = 10.0 ** rng.uniform(-3.0, 3.0), 10.0 ** rng.uniform(-5.0, 5.0)
    duration = 0.4 * _shown(scene)
    usual = concluded(scene, duration, "events")
    other = concluded(scaled(scene, length=length, time=unit), duration * unit, "events")
    differ = [key for key in KEYS if _differ(usual[key], other[key])]
    if differ:  # a wheel that runs free knocks about for ever, and forgets how it began
        torques = tuple(replace(one, value=(1.0 + NUDGED) * one.value) for one in scene.torques)
        beside = concluded(replace(scene, torques=torques), duration, "events")
        if any(_differ(usual[key], beside[key]) for key in differ):
            note("sensitive")
            return
    for key in differ:
        yield f"scale: {key} {usual[key]!r}, with lengths × {length:.3g} and times × {unit:.3g} {other[key]!r}"
    note("same")


def _differ(a: Any, b: Any) -> bool:
    return bool(a != b) and not (isinstance(a, float) and isinstance(b, float) and abs(a - b) <= UNITS * abs(a))


JUDGES = {"steady": judge_steady, "verdict": judge_verdict, "records": judge_records, "scale": judge_scale}


def answer_of(name: str, scene: Scene) -> tuple[list[str], list[str]]:
    """Words for the table, and what is wrong; an exception is wrong, too."""
    words: list[str] = []
    try:
        return words, list(JUDGES[name](scene, words.append))
    except Exception as error:
        return words, [f"{name}: crashed, {type(error).__name__}: {error}"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--only", type=int)
    parser.add_argument("--judge", choices=sorted(JUDGES), action="append")
    args = parser.parse_args()
    numbers = [args.only] if args.only is not None else range(args.start, args.start + args.count)
    begun, seen, wrong, judged = time.perf_counter(), Counter[tuple[str, str]](), 0, 0
    for ended in (signal.SIGINT, signal.SIGTERM):  # in the background the first one is ignored
        signal.signal(ended, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        for number in numbers:
            scene = mechanism(args.seed, number)
            for name in args.judge or JUDGES:
                words, reasons = answer_of(name, scene)
                seen.update((name, word) for word in words)
                wrong += bool(reasons)
                for reason in reasons:
                    print(f"{number} {scene.title}: {reason}", flush=True)
            judged += 1
    for (name, word), count in sorted(seen.items()):
        print(f"| {name} | {word} | {count} |")
    print(f"{judged} mechanisms of seed {args.seed}, {wrong} judgements wrong, {time.perf_counter() - begun:.0f} s")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
