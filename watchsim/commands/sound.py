"""watchsim sound RUN: the ticking of a finished run as a WAV file."""

from __future__ import annotations

import argparse
from pathlib import Path

from watchsim.commands.console import FINE, InputError, Progress, parse_positive, say

HELP = "the ticking of a results folder as WAV"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder")
    parser.add_argument(
        "--duration",
        metavar="TIME",
        help='such as "60 s" (default: as long as the run); what is longer than the run repeats its last oscillations',
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="file.wav (default RUN/tick.wav)")


def run(args: argparse.Namespace) -> int:
    from watchsim.analysis.sound import check_length, repeated, score, sound, wav_path
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.units import TIME

    duration = None if args.duration is None else parse_positive("--duration", args.duration, TIME)
    try:
        if duration is not None:
            check_length(duration)
        target = wav_path(args.output or Path(args.run_folder) / "tick.wav")
    except ValueError as error:
        raise InputError(f"sound: {error}.") from error
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    secured_file(target, "the sound")
    if words := repeated(score(trajectory, duration)):
        say(f"Note: {words}.")
    progress = Progress("sound, s:")
    try:
        sound(trajectory, target, duration, progress)
    finally:
        progress.close()
    print(target)
    return FINE
