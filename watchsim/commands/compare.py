"""watchsim compare RUN|SCENE ...: what was changed between scenes or runs, and what came of it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import FINE, InputError, announce_compile, print_json

if TYPE_CHECKING:
    from watchsim.studies.compare import Comparison, Side


HELP = "what was changed between scenes or runs, and what came of it"
NOTES = {
    "±": "± is the error of the difference, that of the computation.",
    "scatter": "scatter: how much the beats of the runs scatter and drift; the error of the computation is another matter.",
}


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "sources", metavar="RUN|SCENE", nargs="+", help="results folders or scenes, two or more, the old one first"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="plots over each other (.png, .svg, .pdf), or a page in motion (.html)"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import secured_file
    from watchsim.commands.plot import FORMATS
    from watchsim.pages.report_page import ENDINGS
    from watchsim.studies.compare import compare

    target = None if args.output is None else Path(args.output)
    if target is not None and target.suffix[1:] not in FORMATS and target.suffix not in ENDINGS:
        raise InputError(f"-o {target}: the name ends in .html for a page, or for a plot in one of .{', .'.join(FORMATS)}.")
    if len(args.sources) < 2:
        raise InputError("compare: name at least two results folders or scenes.")
    if target is not None:
        secured_file(target, "the plots")
    announce_compile()
    sides = sides_of(args.sources, drawn=target is not None)
    found = compare(*sides)
    if args.json:
        print_json(plain_numbers(found))
    else:
        print(text(found))
    if target is not None:
        _draw(found, target, silent=args.json)
    return FINE


def sides_of(names: Sequence[str], drawn: bool = False) -> list[Side]:
    """What was named; scenes with a motion where that is to be drawn."""
    from watchsim.commands.inputs import load_scene, read_run
    from watchsim.results.folder import TRAJECTORY
    from watchsim.studies.compare import side_of, with_run

    for name in names:  # all that can be refused, before anything is computed
        if not (Path(name) / TRAJECTORY).is_file():
            load_scene(name)
        elif drawn:
            read_run(name)
    sides = [side_of(name) for name in names]
    return [with_run(side) for side in sides] if drawn else sides


def plain_numbers(found: Comparison) -> dict[str, Any]:
    """For `--json`."""
    from watchsim.results.tables import plain

    numbers: dict[str, Any] = plain(found.numbers())
    return numbers


def text(found: Comparison) -> str:
    """Two tables for people: what was changed, and what came of it."""
    from watchsim.studies.compare import changed_rows, result_rows
    from watchsim.studies.study_report import aligned

    names = [side.name for side in found.sides]
    changed = [[*row, ""] for row in changed_rows(found)]
    lines = aligned(["changed", *names, ""], changed) if changed else ["  Nothing was changed in the scene."]
    body = [[*row, ""] for row in result_rows(found)]
    lines += ["", *aligned(["result", *names, "difference", found.off, ""], body)]
    lines += [f"  {side.name}: {side.message}" for side in found.sides if side.message]
    if any(one.error is not None for one in found.outputs.values()):
        lines.append(f"  {NOTES[found.off]}")
    return "\n".join(lines)


def _draw(found: Comparison, target: Path, silent: bool) -> None:
    from watchsim.pages.compare_page import comparison_page
    from watchsim.pages.report_page import ENDINGS
    from watchsim.render.compare_plot import plot_comparison
    from watchsim.render.style import save
    from watchsim.storage.write import write_file

    if target.suffix in ENDINGS:
        comparison_page(found, target)
    else:
        figure = plot_comparison(found)
        write_file(target, lambda path: save(figure, path), "the plots")
    if not silent:
        print(target)
