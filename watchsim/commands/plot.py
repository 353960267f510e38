"""watchsim plot RUN: kinematic plots of a finished run."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.common.console import FINE, InputError, parse_names, parse_width, parse_window, say

if TYPE_CHECKING:
    from watchsim.simulation.record.trajectory import Trajectory

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
    parser.add_argument(
        "--tape", action="store_true", help="the paper of a timegrapher, and rate, amplitude and beat error over time"
    )
    parser.add_argument("--window", metavar="FROM:TO", help='such as "179.4 s:179.75 s" (default: all that was recorded)')
    parser.add_argument(
        "--phases", action="store_true", help="the timeline: tables of motion and energy, and a plot with the phases of a beat"
    )
    parser.add_argument(
        "--width", metavar="LENGTH", default="170 mm", help='of that plot (default "%(default)s", or "85 mm" for a column)'
    )
    parser.add_argument("--format", metavar="NAMES", default="png", help="png, svg, pdf, with commas (default %(default)s)")
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="the file, ending optional (default RUN/plots/kinematics, phases or tape)"
    )


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.common.inputs import read_run
    from watchsim.commands.common.output_place import secured_file, swept_run
    from watchsim.storage.write import write_file

    formats = parse_names(args.format) or []
    wrong = [name for name in formats if name not in FORMATS]
    if wrong or not formats:
        raise InputError(f"--format {args.format}: choose from {', '.join(FORMATS)}.")
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    quantities = tuple(parse_names(args.quantities) or ())
    window = parse_window(args.window)
    usual = "phases" if args.phases else "tape" if args.tape else "kinematics"
    target = Path(args.output) if args.output else Path(args.run_folder) / "plots" / usual
    if target.suffix[1:] in FORMATS:
        formats = [target.suffix[1:]] if args.format == "png" else formats
        target = target.with_suffix("")
    if not args.output:
        target.parent.mkdir(exist_ok=True)
    paths = [secured_file(target.parent / f"{target.name}.{name}", "the plot") for name in formats]
    if args.tape:
        from watchsim.render.figures.tape import plot_tape

        figure = plot_tape(trajectory, window)
    elif args.phases:
        from watchsim.analysis.timeline.oscillation import shown_beats
        from watchsim.analysis.timeline.table import timeline_text
        from watchsim.render.figures.phase_plot import phase_plot

        width = parse_width(args.width)
        try:
            told = shown_beats(trajectory, window)
        except ValueError as error:
            raise InputError(f"--phases: {error}.") from error
        print(timeline_text(trajectory, told))
        figure = phase_plot(trajectory, window, 1e3 * width, told)
    else:
        from watchsim.render.figures.plots import plot_kinematics

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
