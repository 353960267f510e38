"""What does a watchmaker want to read first?"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.flows import energy_shares
from watchsim.analysis.phases import stretches, with_angles
from watchsim.analysis.timeline import Stages, Staging, knows_energies
from watchsim.analysis.timing import Beats
from watchsim.analysis.verdict_kinds import BESIDE
from watchsim.mechanism.compile import scene_size
from watchsim.scene.keys import in_words
from watchsim.scene.roles import keeps_time, only_presses
from watchsim.simulation import MOREAU
from watchsim.simulation.trajectory import Trajectory
from watchsim.units import decimals_for, metric, signed, true_minus

UNSOLVED = 1e-6  # share of a contact problem's largest term: what rounding leaves lies far below
COARSE = 5e-3  # overlap as a share of the mechanism's size, beyond which a step has lost the shapes that touch
FINER = 5.0  # so much shorter a step to try


def doubts(run: Trajectory) -> Iterator[str]:
    """A sentence for each reason: contact problems left unsolved, a step too coarse for the motion."""
    if run.worst_residual > UNSOLVED:
        yield (
            f"a contact problem was left with a residual of {run.worst_residual:.2g} of its largest term, "
            "so forces and impulses there are not those of the laws of contact"
        )
    deep = COARSE * scene_size(run.scene)
    if run.method == MOREAU and run.step is not None and run.worst_penetration > deep:
        yield (
            f"the step of {1e6 * run.step:.4g} µs is too coarse: bodies overlapped by {1e6 * run.worst_penetration:.2g} µm. "
            f'Take a shorter one, such as --step "{1e6 * run.step / FINER:.2g} µs", until the numbers no longer change'
        )


BEAT_COLUMNS = ("beat", "t_s", "tick_s", "turn_s", "turn_at", "amplitude", "period_s", "rate_s_per_d", "beat_error_ms")
PARTS = ("wheel", "lever", "balance")
ROWS_AT_ONCE = 1 << 12
PHASE_COLUMNS = (
    *("beat", "phase", "t_s", "duration_ms"),
    *(f"{part}_{what}_deg" for part in PARTS for what in ("angle", "turn")),
    *("on", "stone"),
    *(f"{part}_{what}_deg_per_s" for part in PARTS for what in ("start_rate", "end_rate")),
    *("impulse_on_balance_N_m_s", "supplied_J", "stored_J", "to_balance_J", "damping_J", "friction_J", "impacts_J"),
)


def beats_csv(found: Beats) -> Iterator[str]:
    """One row per half swing: passage, tick, the turning point after it (time and place), amplitude, period, rate, beat error.

    In pieces of some thousand rows. Angles in degrees (turn_at_deg, amplitude_deg), of a sliding body metres (turn_at_m,
    amplitude_m); empty where unknown.
    """
    unit = "deg" if found.angular else "m"
    header = [f"{name}_{unit}" if name in ("turn_at", "amplitude") else name for name in BEAT_COLUMNS]
    scale = math.degrees(1.0) if found.angular else 1.0
    turn, amplitude = scale * found.end_at, scale * found.amplitude
    columns = (found.t, found.tick, found.end, turn, amplitude, found.period_s, found.rate_s_per_d, found.beat_error_ms)
    yield _row(header)
    for first in range(0, len(found), ROWS_AT_ONCE):
        some = [_cells(column[first : first + ROWS_AT_ONCE]) for column in columns]
        numbers = range(found.before + 1 + first, found.before + 1 + first + len(some[0]))
        yield _lines([list(map(str, numbers)), *some])


def phases_csv(run: Trajectory, found: Beats) -> Iterator[str]:
    """One row per phase: beat (as in beats.csv), name, start, duration, for wheel, lever and balance the angle at its start and
    the turn during it, on what an impulse acts, which stone is unlocked in the beat, angular velocities, the angular impulse of
    all contacts on the oscillator, and where the energy went (see analysis/timeline/rows.py).

    Energies and impulse are empty for a run by fixed steps, whose contacts have no smooth forces.
    """
    yield _row(PHASE_COLUMNS)
    staging, known = Staging(run), knows_energies(run)
    for part in stretches(run, found):
        some = with_angles(run, part)
        yield _lines(_phase_columns(staging.of(some), known)) if len(some) else ""


def _phase_columns(part: Stages, known: bool) -> list[list[str]]:
    phases, count = part.phases, len(part.phases)
    rows = phases.rows
    turned, rates = (
        np.degrees(np.stack(pair, axis=2)).reshape(count, -1)  # of each body one beside the other
        for pair in ((phases.angles, phases.turns), (part.start_rates, part.end_rates))
    )
    energies = [part.impulse, part.supplied, part.stored, part.to_balance, part.damping, part.friction, part.impacts.whole]
    if not known:
        energies = [np.full(count, math.nan)] * len(energies)
    numbers = (_cells(one) for one in (rows.start, 1e3 * (rows.end - rows.start), *turned.T))
    beats = list(map(str, rows.beat.tolist()))
    return [beats, rows.names, *numbers, rows.faces, part.pallets, *map(_cells, rates.T), *map(_cells, energies)]


def _cells(column: NDArray[np.float64]) -> list[str]:
    """The numbers, such that they read back as the same; nothing for what is not finite."""
    return [repr(value) if math.isfinite(value) else "" for value in column.tolist()]


def _row(fields: Sequence[str]) -> str:
    """One line; no name in these tables needs quotes."""
    return ",".join(fields) + "\n"


def _lines(columns: Sequence[Sequence[str]]) -> str:
    return "".join(map(_row, zip(*columns, strict=True)))


LABEL = 13
EXACT = 6  # decimals at most
FINEST = {" ms": 4}  # of a beat error, of which timing machines show one
AVERAGED = (("amplitude_deg", "amplitude", "°"), ("rate_s_per_d", "rate", " s/d"), ("beat_error_ms", "beat error", " ms"))
HELPED = (
    ("lcp_copositive", "by the second way (copositive form)"),
    ("lcp_detours", "from another start"),
    ("lcp_enumerated", "by trying all cases"),
    ("lcp_inexact", "to a billionth of the largest load"),
)
RULES = (
    ("accumulations", "bounces that died out in ever smaller rebounds: {}"),
    ("energy_rescues", "impacts that would have gained energy, solved again with less restitution: {}"),
    ("jams", "jams, sliding contacts that no finite force could hold apart, stopped by impulses (Painlevé): {}"),
)
NO_PENETRATION = 1e-12  # m; less is not worth a digit, neither of depths nor of errors
SCATTER = (
    "scatter: how much the beats of that time scatter and drift; the error of the computation is another matter (--error-bars)"
)
PLAIN = 1e-6  # errors below are written with an exponent


def readings(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str, str | None]]:
    """What a watchmaker reads first, from the numbers of a run: what it is, its value, and what stands below it."""
    for name, label, unit in AVERAGED:
        if numbers.get(name) is not None:
            yield label.capitalize(), *with_error(float(numbers[name]), numbers.get(f"{name}_error"), unit)
    if numbers.get("vph") is not None:
        yield "Frequency", f"{numbers['vph']:.2f} vph", f"{numbers['frequency_hz']:.6f} Hz"
    heard = numbers.get("timegrapher")
    if heard and heard.get("amplitude_deg") is not None:
        yield "Timegrapher shows", f"{heard['amplitude_deg']:.0f}°", f"with a lift angle of {heard['lift_angle_deg']:.4g}°"
    if numbers.get("missed_beats") is not None:
        yield "Missed beats", str(numbers["missed_beats"]), f"in {numbers['beats']} beats"
    if numbers.get("efficiency") is not None:
        yield "Efficiency", f"{100.0 * numbers['efficiency']:.1f} %", "of the drive's work reaches the oscillator"


def with_error(value: float, error: float | None, unit: str) -> tuple[str, str | None]:
    """The value with as many digits as its scatter leaves it, at least two."""
    if error is None:
        return f"{signed(value, 3)}{unit}", None
    finest = FINEST.get(unit, EXACT)
    decimals = min(max(decimals_for(error), 0 if abs(value) >= 100.0 else 1), finest) if error > 0.0 else 3
    shown = (
        f"scatter {error:.{decimals}f}" if error >= 0.5 * 10.0**-decimals else f"scatter below {10.0**-decimals:.{decimals}f}"
    )
    return f"{signed(value, decimals)}{unit}", f"{shown}{unit}"


def headlines(run: Trajectory, numbers: Mapping[str, Any]) -> str:
    """The headline numbers in watchmakers' units, a line each; `numbers` as from `watchsim.analysis.summary.summary(run)`."""
    timing = (*_verdict(numbers), *_timing(numbers), *_places(run, numbers))
    parts = (*timing, *_contacts(numbers), *_energy(run), *_solver(run, numbers), *_verdicts(numbers))
    width = max(LABEL, *(len(label) + 1 for label, _ in parts))
    lines = [f"  {label:{width}}{text}" for label, text in parts]
    return "\n".join([run.scene.title, *lines])


def with_scatter(value: float, error: float | None, unit: str) -> str:
    """ "275.3°, scatter 0.1°": as many decimals as the scatter justifies, three where it is not known; a true minus sign."""
    finest = FINEST.get(unit, EXACT)
    if error is not None and max(abs(value), error) < 10.0**-finest:
        return f"below {10.0**-finest:.{finest}f}{unit}" if error > 0.0 or value else f"0{unit}"
    decimals = 3 if error is None else min(_decimals(error), finest)
    text = signed(value, decimals) + unit
    if error is None:
        return text
    return f"{text}, scatter {max(error, 10.0**-finest):.{decimals}f}{unit}"


def _decimals(error: float) -> int:
    """So that the error shows one digit, and never rounds to nothing."""
    if error <= 0.0:
        return EXACT
    return min(max(0, math.ceil(-math.log10(error))), EXACT)


def _verdict(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What the watch does, first of all; nothing where nothing keeps time."""
    if numbers.get("verdict") is not None:
        yield "verdict", numbers["verdict_message"]


def _timing(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Lines of the oscillator; none where there is none."""
    beside = BESIDE.get(numbers.get("verdict") or "")
    for name, label, unit in AVERAGED:
        if numbers[name] is not None:
            yield label, with_scatter(numbers[name], numbers[f"{name}_error"], unit) + (f", {beside}" if beside else "")
    yield from _heard(numbers)
    if numbers["timing_message"] is not None:
        yield "timing", numbers["timing_message"]
    if numbers["vph"] is not None:
        start, end = numbers["window_s"]
        yield "frequency", f"{numbers['vph']:.2f} vph, averaged from {start:.4g} s to {end:.4g} s"
        if any(numbers[f"{name}_error"] is not None for name, _, _ in AVERAGED):
            yield "", SCATTER
    if (share := numbers["efficiency"]) is not None:
        part = f"{100.0 * share:.1f} %" if share >= 0.0 else "none"
        given = "" if share >= 0.0 else f", which gave away {-100.0 * share:.1f} % as much"
        yield "efficiency", f"{part} of the drive's work in that time reached the oscillator{given}"
    if (missed := numbers["missed_beats"]) is not None:
        where = f"in {numbers['beats']} half swings"
        yield "missed beats", f"{missed} {where}: half pitches the wheel fell short or ran ahead" if missed else f"none {where}"


def _heard(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What a timegrapher shows, and why it is something else."""
    heard = numbers["timegrapher"]
    if heard is None:
        return
    forms = {"amplitude_deg": "{:.0f}°", "rate_s_per_d": "{:+.1f} s/d", "beat_error_ms": "{:.2f} ms"}
    shown = (form.format(heard[name]) for name, form in forms.items() if heard[name] is not None)
    listed = ", ".join(re.sub(r"^[+-](?=0\.0 )", "", text) for text in shown).replace("-", "−")
    if listed:
        lift = heard["lift_angle_deg"]
        yield "timegrapher", f"would show {listed}" + ("" if lift is None else f" with a lift angle of {lift:.4g}°")
    if heard.get("message"):
        yield "" if listed else "timegrapher", heard["message"]


def _places(run: Trajectory, numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Where free and sliding bodies have got to, and pivoted ones where nothing keeps time."""
    for body in run.scene.bodies:
        state = numbers["bodies"].get(body.name)
        if state is None or body.motion == "fixed":
            continue
        if body.motion == "pivot":
            if not keeps_time(run.scene) or only_presses(run.scene):
                yield body.name, f"at {signed(math.degrees(state['angle_rad']), 3)}° at the end"
            continue
        angle = f", {signed(math.degrees(state['angle_rad']), 3)}°" if body.motion == "free" else ""
        yield body.name, f"at ({signed(1e3 * state['x_m'], 4)}, {signed(1e3 * state['y_m'], 4)}) mm{angle} at the end"


def _contacts(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    per_second = f", {numbers['impacts'] / numbers['simulated_s']:.0f} per second" if numbers["simulated_s"] > 0.0 else ""
    series = numbers["events_by_kind"]["accumulation"]
    rough = f"; those in {series} series of rebounds depend on where these are ended" if series else ""
    yield "impacts", f"{numbers['impacts']}{per_second}{rough}; {numbers['events']} events"
    depth = numbers["worst_penetration_m"]
    deep = f"by up to {metric(depth, 'm', 2)}" if depth >= NO_PENETRATION else f"by less than {1e9 * NO_PENETRATION:g} nm"
    yield "penetration", f"bodies overlapped {deep}"
    if numbers["overlap"].get("looks"):
        yield "", _looked(numbers["overlap"])


def _looked(overlap: Mapping[str, Any]) -> str:
    """What looking at the outlines themselves has found."""
    looks = f"{overlap['looks']} {'check' if overlap['looks'] == 1 else 'checks'} of the outlines themselves"
    if overlap["between"] is None:
        return f"{looks} found no overlap of {metric(overlap['resolution_m'], 'm', 2)} or more"
    first, second = overlap["between"]
    place = f"at ({signed(overlap['x_mm'], 4)}, {signed(overlap['y_mm'], 4)}) mm"
    return f"{looks}: {first} and {second} by {metric(overlap['worst_m'], 'm', 2)} at {overlap['t_s']:.6g} s, {place}"


def _energy(run: Trajectory) -> Iterator[tuple[str, str]]:
    shares = energy_shares(run)
    if not shares.went_to:
        return
    power = f", {metric(shares.supplied / run.simulated, 'W', 4)}" if run.simulated > 0.0 else ""
    listed = ", ".join(f"{cause} {100.0 * share:.1f} %" for cause, share in shares.went_to.items() if abs(share) >= 5e-4)
    # From a drive, or from what springs, weights and moving bodies held.
    source = "put in or taken from what was stored" if shares.ran_down > 0.0 else "put in"
    if shares.ran_down >= shares.supplied:
        source = "taken from what was stored at the start"
    yield "energy", f"{metric(shares.supplied, 'J', 4)} {source}{power}: {listed}"
    yield "", f"the account closes to {run.energy.get('residual_relative', 0.0):.1g} of it"


def _error(value: float, unit: str) -> str:
    """An error with one digit; a length with a prefix."""
    if unit == "m":
        return metric(max(value, NO_PENETRATION), unit, 1)
    return f"{value:.{_decimals(value)}f}{unit}" if value >= PLAIN or value == 0.0 else f"{value:.0e}{unit}"


def _solver(run: Trajectory, numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    factor = numbers["realtime_factor"]
    compiling = f" (and {run.compile:.1f} s to compile or load the solver)" if run.compile > 1.0 else ""
    times = (f"{factor:.3g}" if factor < 999.5 else f"{float(f'{factor:.3g}'):,.0f}") if factor else ""
    yield "speed", f"{times} × real time, {run.wall:.2g} s{compiling}" if factor else "not measured"
    if run.method == MOREAU and run.step is not None:
        yield "method", f"Moreau's time stepping, steps of {metric(run.step, 's', 4)}"
    yield "solver", _solved(run, numbers)
    for name, words in RULES:
        if count := numbers["counts"].get(name):
            yield "", words.format(count)
    yield from _compared(numbers)
    yield "end", run.stop_message or run.stop.sentence


def _solved(run: Trajectory, numbers: Mapping[str, Any]) -> str:
    """How the complementarity problems came out."""
    counts = run.counts
    count = counts.get("lcp", 0)
    if not count and not numbers["lcp_failures"]:
        return "there was no contact problem to solve"
    solved = f"each solved to {run.worst_residual:.1g} or better" if run.worst_residual > 0.0 else "each solved exactly"
    if run.worst_residual > UNSOLVED:
        solved = f"the worst left with a residual of {run.worst_residual:.2g}"
    parts = [f"{count} contact {'problem' if count == 1 else 'problems'}, {solved}"]
    parts += [f"{counts[name]} {words}" for name, words in HELPED if counts.get(name)]
    if numbers["lcp_failures"]:
        parts.append(f"{numbers['lcp_failures']} had no solution")
    return "; ".join(parts)


def _compared(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How far the numbers of a more exact run lie away: the error of the computation, whether or not the watch has settled."""
    bars = numbers.get("error_bars")
    if bars is None:
        return
    if not bars["complete"]:
        yield "error bars", "none: the more exact run did not finish"
        return
    finer = f"steps of {metric(bars['step_s'], 's', 4)}" if bars["step_s"] else f"tolerance {bars['tolerance']:.0e}"
    yield "error bars", f"of the computation, from a second run with {finer}:"
    units = {name: (label, unit) for name, label, unit in AVERAGED}
    moved = [
        f"{units[name][0]} ± {_error(value, units[name][1])}" for name, value in bars["differences"].items() if name in units
    ]
    if moved:
        yield "", ", ".join(moved)
    for body, state in numbers["bodies"].items():
        far = max(state["x_m_error"], state["y_m_error"])
        errors = ((far, "m"), (math.degrees(state["angle_rad_error"]), "°"))
        moved = [f"± {_error(error, unit)}" for error, unit in errors if error > 0.0]
        if moved:
            yield "", f"{body} at the end {' and '.join(moved)}"


def _verdicts(numbers: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What is to be doubted, and expectations."""
    for warning in numbers.get("warnings", ()):
        yield "WARNING", warning
    for entry in numbers["expect"]:
        if entry["ok"] is not None:
            yield "expected", f"{expected_text(entry)}: {'kept' if entry['ok'] else 'MISSED'}"
    unjudged = Counter(entry["message"] for entry in numbers["expect"] if entry["ok"] is None)
    for message, count in unjudged.items():
        yield "expected", f"{count} {'number' if count == 1 else 'numbers'} {message}"


def expected_text(entry: Mapping[str, Any]) -> str:
    """ "amplitude = 290.73° ± 0.05°, got 290.732°" from an entry of the summary's `expect`, its key in words."""
    key = re.sub(r" (rad|m|deg)( per s)?$", lambda found: " velocity" if found[2] else "", in_words(entry["key"]))
    unit = entry["unit"] if entry["unit"] in ("", "°") else f" {entry['unit']}"
    promised = f"= {entry['expected']:.12g}{unit} ± {entry['tolerance']:.4g}{unit}"
    ends = [(word, entry.get(name)) for word, name in (("from", "min"), ("to", "max")) if entry.get(name) is not None]
    if ends:
        promised = " ".join(f"{word} {end:.12g}{unit}" for word, end in ends)
    if entry["ok"] is None:
        return true_minus(f"{key} {promised}")
    if entry["got"] is None:
        return true_minus(f"{key} {promised}") + f", but {entry['message']}"
    # One digit more than the tolerance has.
    size = entry["tolerance"] if math.isfinite(entry["tolerance"] or math.inf) else abs(entry["expected"]) or 1.0
    digits = max(4, 2 + math.ceil(math.log10(max(abs(entry["got"]), size) / size)))
    return true_minus(f"{key} {promised}, got {entry['got']:.{min(digits, 17)}g}{unit}")
