"""watchsim listen FILE.wav: rate, beat error and amplitude of a recorded watch or clock, as a timing machine shows them.

Held against the case or the backboard, a phone's microphone is good enough. Half a minute gives the rate of a watch to
a few tenths of a second a day, if the recorder's own clock is right.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import FINE, InputError, print_json, say

if TYPE_CHECKING:
    from watchsim.analysis.listen import Heard

HELP = "rate, beat error and amplitude of a recorded watch or clock"
PICTURES = (".png", ".svg", ".pdf")
LABEL = 13


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE.wav", help="a recording of any width, rate and number of channels")
    parser.add_argument("--lift-angle", metavar="ANGLE", default="52°", help="lift angle of the watch (default %(default)s)")
    parser.add_argument(
        "--vph", metavar="N", type=float, help="vibrations per hour of its train (default: the nearest usual one)"
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="the tape, as a picture (.png, .svg, .pdf) or as numbers (.csv)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import secured_file

    target = None if args.output is None else Path(args.output)
    _check(args, target)
    from watchsim.analysis.listen import NothingHeard, listen

    if target is not None:
        secured_file(target, "the tape")
    try:
        heard = listen(args.file, lift_angle=args.lift_angle, vph=args.vph)
    except NothingHeard as error:
        raise InputError(f"listen: {error}.") from error
    if args.json:
        print_json(heard.numbers())
    else:
        print(text(heard))
    if target is not None:
        _save(heard, target)
        say(f"Tape: {target}")
    return FINE


def _check(args: argparse.Namespace, target: Path | None) -> None:
    """InputError with all that is wrong with what was typed."""
    from watchsim.units import ANGLE, UnitError, parse, to

    wrong = []
    if not Path(args.file).is_file():
        wrong.append(f"{args.file}: {'is a folder' if Path(args.file).is_dir() else 'there is no such file'}.")
    try:
        if not 0.0 < to(parse(args.lift_angle, ANGLE), "°") < 180.0:
            wrong.append(f"--lift-angle {args.lift_angle}: must lie between 0° and 180°.")
    except UnitError as error:
        wrong.append(f"--lift-angle {args.lift_angle}: {error}.")
    if args.vph is not None and not 0.0 < args.vph < 1e6:
        wrong.append(f"--vph {args.vph:g}: must be a positive number, such as 28800.")
    if target is not None and target.suffix.lower() not in (*PICTURES, ".csv"):
        wrong.append(f"-o {target}: its name must end in {', '.join(PICTURES)} or .csv.")
    if wrong:
        raise InputError("\n".join(wrong))


def text(heard: Heard) -> str:
    """For people, a line each."""
    from watchsim.commands.steady import with_error

    lines = [("frequency", f"{heard.vph:.2f} vph, {len(heard.t)} beats in {heard.seconds:.4g} s")]
    if heard.missed:
        lines.append(("", f"{heard.missed} beats were not heard"))
    if heard.rate_s_per_d is not None:
        rate = with_error(heard.rate_s_per_d, heard.rate_s_per_d_error, " s/d")
        lines.append(("rate", f"{rate}, against {heard.nominal_vph:g} vph"))
        lines += _changes(heard.rate_s_per_d, heard.rate_change_s_per_d, 1, " s/d")
    lines.append(("beat error", with_error(heard.beat_error_ms, heard.beat_error_ms_error, " ms")))
    if heard.amplitude_deg is None:
        lines.append(("amplitude", "no second noise is heard in the beats by which it could be measured"))
    else:
        lines.append(("amplitude", f"{heard.amplitude_deg:.0f}° with a lift angle of {heard.lift_angle_deg:g}°"))
        lines += _changes(heard.amplitude_deg, heard.amplitude_change_deg, 0, "°")
        lines.append(("", f"the last loud noise comes {heard.interval_ms:.2f} ms after the first"))
    lines += [("note", note) for note in heard.notes]
    return "\n".join([heard.title, *(f"  {label:{LABEL}}{words}" for label, words in lines)])


def _changes(value: float, change: float | None, decimals: int, unit: str) -> list[tuple[str, str]]:
    """From what to what it goes within the recording; nothing where it stays."""
    if not change:
        return []
    from watchsim.units import signed

    first, last = (signed(value + part * change, decimals) for part in (-0.5, 0.5))
    way = "rises" if change > 0.0 else "falls"
    return [("", f"it {way} from {first}{unit} to {last}{unit} within the recording: not settled")]


def _save(heard: Heard, target: Path) -> None:
    from watchsim.storage.write import write_file

    tape = heard.tape
    if target.suffix.lower() == ".csv":
        from watchsim.studies.study_report import csv_text

        names = ("gain_ms", "rate_s_per_d", "beat_error_ms")
        columns = {name: [x if math.isfinite(x) else None for x in getattr(tape, name).tolist()] for name in names}
        direction = ["tick" if forward else "tock" for forward in tape.forward.tolist()]
        table = {"t_s": tape.t.tolist(), "gain_ms": columns.pop("gain_ms"), "direction": direction, **columns}
        write_file(target, lambda place: place.write_text(csv_text(table), encoding="utf-8"), "the tape")
        return
    from watchsim.render.style import save
    from watchsim.render.timing_plot import tape_figure

    about = f"Recording, {heard.vph:.1f} vph"
    write_file(target, lambda place: save(tape_figure(tape, heard.title, about), place), "the tape")
