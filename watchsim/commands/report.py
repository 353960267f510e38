"""watchsim report RUN: one self-contained HTML page: a player, linked plots, the timing sheet, the files.

For results of watchsim tolerance: yield, spread, contributions, failures; for watchsim positions: its tables and the dial.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from watchsim.commands.console import FINE, InputError, parse_window

HELP = "one self-contained HTML page: player, timing sheet, plots"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "run_folder", metavar="RUN", help="a results folder, of a run, or of a study of tolerances or positions"
    )
    parser.add_argument(
        "--window", metavar="FROM:TO", help='what the player shows, such as "179 s:180 s" (default: the last ten beats, or all)'
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="the page (default RUN/report.html)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.pages.report_page import check_page, report
    from watchsim.results.folder import read_summary

    window = parse_window(args.window)
    if (Path(args.run_folder) / "rows.jsonl").is_file():
        return _of_study(args, window)
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    target = secured_file(check_page(args.output or Path(args.run_folder) / "report.html"), "the page")
    print(report(trajectory, target, window, numbers=read_summary(args.run_folder)))
    return FINE


def _of_study(args: argparse.Namespace, window: tuple[float, float] | None) -> int:
    from watchsim.commands.inputs import secured_file
    from watchsim.pages.positions_page import FILE, positions_page
    from watchsim.pages.tolerance_page import tolerance_page
    from watchsim.studies.tolerance import finished

    if window is not None:
        raise InputError("--window: a study has no player; leave it out.")
    if (Path(args.run_folder) / FILE).is_file():
        print(
            positions_page(
                args.run_folder, secured_file(Path(args.output or Path(args.run_folder) / "positions.html"), "the page")
            )
        )
        return FINE
    target = secured_file(Path(args.output or Path(args.run_folder) / "tolerance.html"), "the page")
    print(tolerance_page(finished(args.run_folder), target))
    return FINE
