"""watchsim movie RUN: an MP4 or a GIF of a finished run."""

from __future__ import annotations

import argparse
from fractions import Fraction
from pathlib import Path

from watchsim.commands.console import FINE, InputError, Progress, parse_names, parse_positive, parse_window, say

HELP = "MP4 or GIF of a results folder, by the file's ending"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder")
    parser.add_argument("--window", metavar="FROM:TO", help='such as "9.5 s:9.75 s" (default: all that was recorded)')
    parser.add_argument(
        "--speed",
        metavar="X",
        default="1",
        help='1/20 is slow motion (default %(default)s); "adaptive": slow where things happen, with the factor shown',
    )
    parser.add_argument("--length", metavar="TIME", help='how long a movie at adaptive speed lasts (default "10 s")')
    parser.add_argument("--fps", metavar="N", type=float, help="frames per second (default 60, GIF 25)")
    parser.add_argument(
        "--size", metavar="WxH", help='pixels, such as 1280x720; "auto": wide, square or tall, as the mechanism is drawn'
    )
    parser.add_argument("--dark", action="store_true", help="with a dark background")
    parser.add_argument(
        "--sound", action="store_true", help="the ticking, each blow when it is shown, with its own pitch at any speed (MP4)"
    )
    parser.add_argument("--contacts", action="store_true", help="mark the contacts that are closed")
    parser.add_argument("--forces", action="store_true", help="arrows for the forces at contacts, and their scale")
    parser.add_argument("--names", action="store_true", help="names on the parts: entry stone, guard pin, roller jewel, ...")
    parser.add_argument("--phases", action="store_true", help="show the phases of a beat by name, and shaded in the strip")
    parser.add_argument(
        "--strip",
        metavar="BODY",
        nargs="?",
        const=True,
        default=False,
        help="a strip with its angle and velocity (default: the oscillator's)",
    )
    parser.add_argument(
        "--inset",
        metavar="PLACE",
        action="append",
        default=[],
        help='show a place enlarged: lever, lever.STONES, lever.STONES.2 (its second outline), "entry stone", "exit stone" or '
        '"-1.4,1.9:-0.8,2.5" (mm); may be given several times',
    )
    parser.add_argument(
        "--zoom",
        metavar="NAMES",
        help='frame only these bodies, separated by commas, or "all" (default: what touches, with the whole as an inset)',
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="file.mp4 or file.gif (default RUN/movie.mp4)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.render.encoder import check_path
    from watchsim.render.movie import ADAPTIVE, movie
    from watchsim.units import TIME

    speed, size = (args.speed if args.speed == ADAPTIVE else parse_speed(args.speed)), _size(args.size)
    length = None if args.length is None else parse_positive("--length", args.length, TIME)
    if length is not None and speed != ADAPTIVE:
        raise InputError(f"--length {args.length}: only with --speed {ADAPTIVE}; else speed and window determine its length.")
    if isinstance(size, tuple) and any(side % 2 for side in size):
        say(f"Note: sides of a movie are even numbers of pixels; {args.size} is rounded up.")
    window = parse_window(args.window)
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    target = secured_file(check_path(args.output or Path(args.run_folder) / "movie.mp4"), "the movie")
    progress = Progress("frames:")
    try:
        movie(
            trajectory,
            target,
            window,
            speed,
            fps=args.fps,
            size=size,
            contacts=args.contacts,
            zoom=parse_names(args.zoom),
            length=length,
            insets=args.inset,
            strip=args.strip,
            phases=args.phases,
            names=args.names,
            forces=args.forces,
            sound=args.sound,
            dark=args.dark,
            progress=progress,
        )
    finally:
        progress.close()
    print(target)
    return FINE


def parse_speed(text: str) -> float:
    """A positive number or fraction."""
    try:
        value = float(Fraction(text))
    except (ValueError, ZeroDivisionError) as error:
        raise InputError(f"--speed {text}: write a number or a fraction such as 1/20, or adaptive.") from error
    if not value > 0.0:
        raise InputError(f"--speed {text}: must be positive.")
    return value


def _size(text: str | None) -> tuple[int, int] | str | None:
    if text is None or text == "auto":
        return text
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdigit() and int(part) > 0 for part in parts):
        raise InputError(f"--size {text}: write width and height in pixels, such as 1280x720, or auto.")
    return int(parts[0]), int(parts[1])
