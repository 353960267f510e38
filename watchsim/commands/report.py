"""watchsim report RUN: one self-contained HTML page: a player, linked plots, the timing sheet, the files.

Of the results of watchsim tolerance: yield, spread, contributions, failures.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from watchsim.commands.console import FINE, InputError, parse_window

HELP = "one self-contained HTML page: player, timing sheet, plots"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder, of a run or of a study of tolerances")
    parser.add_argument(
        "--window", metavar="FROM:TO", help='what the player shows, such as "179 s:180 s" (default: the last ten beats, or all)'
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="the page (default RUN/report.html)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.pages.report_page import check_page, report

    window = parse_window(args.window)
    if (Path(args.run_folder) / "rows.jsonl").is_file():
        return _of_study(args, window)
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    target = secured_file(check_page(args.output or Path(args.run_folder) / "report.html"), "the page")
    print(report(trajectory, target, window, numbers=_numbers(args.run_folder)))
    return FINE


def _of_study(args: argparse.Namespace, window: tuple[float, float] | None) -> int:
    from watchsim.commands.inputs import secured_file
    from watchsim.pages.tolerance_page import tolerance_page
    from watchsim.studies.tolerance import finished

    if window is not None:
        raise InputError("--window: a study has no player; leave it out.")
    target = secured_file(Path(args.output or Path(args.run_folder) / "tolerance.html"), "the page")
    print(tolerance_page(finished(args.run_folder), target))
    return FINE


def _numbers(folder: str) -> dict[str, Any] | None:
    """The summary as the run wrote it, which knows its error bars and promises; None where it cannot be read."""
    from watchsim.results.folder import SUMMARY

    try:
        found = json.loads((Path(folder) / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "energy" in found else None
