"""watchsim plot RUN: kinematic plots of a finished run."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import FINE, InputError, parse_names, parse_window, say

if TYPE_CHECKING:
    from watchsim.simulation.trajectory import Trajectory

HELP = "kinematic plots of a results folder"
FORMATS = ("png", "svg", "pdf")
ALL, MOST = "all", 50  # bodies: each costs some hundredths of a second and two inches of paper


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder")
    parser.add_argument(
        "--bodies", metavar="NAMES", help=f"only these bodies, with commas between them, or {ALL} (default: the first {MOST})"
    )
    parser.add_argument(
        "--quantities",
        metavar="NAMES",
        default="angle,velocity",
        help="angle, velocity, acceleration, with commas (default %(default)s)",
    )
    parser.add_argument("--window", metavar="FROM:TO", help='such as "179.4 s:179.75 s" (default: all that was recorded)')
    parser.add_argument("--format", metavar="NAMES", default="png", help="png, svg, pdf, with commas (default %(default)s)")
    parser.add_argument("-o", "--output", metavar="FILE", help="the file, ending optional (default RUN/plots/kinematics)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.destination import secured_file, swept_run
    from watchsim.commands.scenes import read_run
    from watchsim.render.plots import plot_kinematics
    from watchsim.storage.write import write_file

    formats = parse_names(args.format) or []
    wrong = [name for name in formats if name not in FORMATS]
    if wrong or not formats:
        raise InputError(f"--format {args.format}: choose from {', '.join(FORMATS)}.")
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    quantities = tuple(parse_names(args.quantities) or ())
    window = parse_window(args.window)
    target = Path(args.output) if args.output else Path(args.run_folder) / "plots" / "kinematics"
    if target.suffix[1:] in FORMATS:
        formats = [target.suffix[1:]] if args.format == "png" else formats
        target = target.with_suffix("")
    if not args.output:
        target.parent.mkdir(exist_ok=True)
    paths = [secured_file(target.parent / f"{target.name}.{name}", "the plot") for name in formats]
    figure = plot_kinematics(trajectory, _bodies(trajectory, args.bodies), quantities, window)
    for path in paths:
        write_file(path, figure.savefig, "the plot")
        print(path)
    return FINE


def _bodies(run: Trajectory, asked: str | None) -> list[str] | None:
    """The names asked for; the first of those that move where nothing is asked, which is said where there are more."""
    moving = list(run.slices)
    if asked == ALL and ALL not in moving:
        return None
    if asked is not None or len(moving) <= MOST:
        return parse_names(asked)
    say(f"{MOST} of {len(moving)} moving bodies are plotted; --bodies NAMES plots others, --bodies {ALL} all of them.")
    return moving[:MOST]
