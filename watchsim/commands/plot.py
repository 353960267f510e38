"""watchsim plot RUN: plots of a finished run, for screen and print."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import FINE, InputError, parse_names, parse_width, parse_window, say

if TYPE_CHECKING:
    from watchsim.simulation.trajectory import Trajectory


HELP = "plots of a results folder, for screen and print"
FORMATS = ("png", "svg", "pdf")
ALL, FIRST = "all", 50  # bodies: each costs some hundredths of a second and two inches of paper


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder")
    parser.add_argument(
        "--kind",
        metavar="NAMES",
        help="kinematics (default), phases, timeline (the mechanism in each phase), phase-portrait, torque (on the balance, "
        "or of a drive), forces (at contacts and bearings), energy, sound (of a beat), timing, tape, wear (along outlines), "
        "with commas;"
        f" {ALL}: every one that the run has",
    )
    parser.add_argument(
        "--bodies", metavar="NAMES", help=f"only these bodies, separated by commas, or {ALL} (default: the first {FIRST})"
    )
    parser.add_argument(
        "--quantities",
        metavar="NAMES",
        default="angle,velocity",
        help="for kinematics: angle, velocity, acceleration, separated by commas (default %(default)s)",
    )
    parser.add_argument("--tape", action="store_true", help="the same as --kind tape: the paper of a timegrapher")
    parser.add_argument(
        "--window", metavar="FROM:TO", help='such as "179.4 s:179.75 s" (default: the last beats, or the whole run)'
    )
    parser.add_argument(
        "--phases",
        action="store_true",
        help="show the phases of a beat: the same as --kind phases, with tables of motion and energy on the standard output",
    )
    parser.add_argument(
        "--width", metavar="LENGTH", default="170 mm", help='printed width (default "%(default)s", or "85 mm" for a column)'
    )
    parser.add_argument("--dark", action="store_true", help="with a dark background")
    parser.add_argument(
        "--format", metavar="NAMES", default="png", help="png, svg, pdf, separated by commas (default %(default)s)"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="the file, ending optional; a folder for several kinds (default RUN/plots)"
    )


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.commands.pictures import Request
    from watchsim.render.palette import dark
    from watchsim.render.style import save
    from watchsim.storage.write import write_file

    kinds = _kinds(args)
    formats = parse_names(args.format) or []
    wrong = [name for name in formats if name not in FORMATS]
    if wrong or not formats:
        raise InputError(f"--format {args.format}: choose from {', '.join(FORMATS)}.")
    width, window = 1e3 * parse_width(args.width), parse_window(args.window)
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    paths = {kind: [secured_file(path, "the plot") for path in own] for kind, own in _places(args, kinds, formats).items()}
    bodies = _bodies(trajectory, args.bodies) if "kinematics" in kinds else parse_names(args.bodies)
    request = Request(trajectory, bodies, tuple(parse_names(args.quantities) or ()), window, width)
    if args.phases:
        _print_timeline(trajectory, window)
    drawn = 0
    for kind in kinds:
        try:
            figure = dark(request.figure(kind)) if args.dark else request.figure(kind)
        except ValueError as error:
            if len(kinds) == 1:
                raise InputError(f"--phases: {error}." if args.phases else f"--kind {kind}: {error}.") from error
            say(f"No plot of {kind}: {error}.")
            continue
        for path in paths[kind]:
            write_file(path, lambda place, figure=figure: save(figure, place), "the plot")  # type: ignore[misc]
            print(path)
        drawn += 1
    if not drawn:
        raise InputError(f"none of {', '.join(kinds)} can be drawn for this run.")
    return FINE


def _kinds(args: argparse.Namespace) -> list[str]:
    from watchsim.commands.pictures import chosen

    if args.kind is None:
        names = [] if args.tape or args.phases else ["kinematics"]
    elif not (names := parse_names(args.kind) or []):
        return chosen(names)
    short = [name for name, wanted in (("phases", args.phases), ("tape", args.tape)) if wanted]
    return chosen([*names, *short])


def _places(args: argparse.Namespace, kinds: list[str], formats: list[str]) -> dict[str, list[Path]]:
    """The files of each kind."""
    folder = Path(args.run_folder) / "plots"
    if not args.output:
        folder.mkdir(exist_ok=True)
    elif len(kinds) > 1:
        folder = Path(args.output)
        if folder.suffix[1:] in FORMATS:
            raise InputError(f"-o {args.output}: {len(kinds)} plots need a folder, this is the name of one file.")
        folder.mkdir(parents=True, exist_ok=True)
    else:
        target = Path(args.output)
        if target.suffix[1:] in FORMATS:
            formats = [target.suffix[1:]] if args.format == "png" else formats
            target = target.with_suffix("")
        return {kinds[0]: [target.parent / f"{target.name}.{name}" for name in formats]}
    return {kind: [folder / f"{kind}.{name}" for name in formats] for kind in kinds}


def _print_timeline(run: Trajectory, window: tuple[float, float] | None) -> None:
    from watchsim.analysis.timeline import shown_beats, timeline_text

    try:
        print(timeline_text(run, shown_beats(run, window)))
    except ValueError as error:
        raise InputError(f"--phases: {error}.") from error


def _bodies(run: Trajectory, asked: str | None) -> list[str] | None:
    """The names asked for; the first of those that move where nothing is asked, which is said where there are more."""
    moving = list(run.slices)
    if asked == ALL and ALL not in moving:
        return None
    if asked is not None or len(moving) <= FIRST:
        return parse_names(asked)
    say(f"{FIRST} of {len(moving)} moving bodies are plotted; --bodies NAMES plots others, --bodies {ALL} all of them.")
    return moving[:FIRST]
