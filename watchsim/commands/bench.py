"""watchsim bench: speed against error, of this solver and of other engines on the same scenes.

Other engines take part where they are installed: pip install 'watchsim[bench]'.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import FINE, announce_compile, print_json, say

if TYPE_CHECKING:
    from collections.abc import Callable


FILES = ("bench.json", "bench.md", "bench.png")
HELP = "speed against error, beside other engines: table and plot"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-o", "--output", metavar="DIR", default="bench", help="folder for the results (default bench)")
    parser.add_argument("--json", action="store_true", help="print one JSON list instead of the table")
    parser.add_argument("--quick", action="store_true", help="two settings of each engine, each timed once: under a minute")
    parser.add_argument("--scene", metavar="NAME", action="append", help="only this scene; may be given several times")


def run(args: argparse.Namespace) -> int:
    from watchsim.bench.compare import missing_engines, table
    from watchsim.commands.inputs import secured_file, secured_folder

    folder = Path(args.output)
    if not folder.is_dir():
        secured_folder(folder, "results")
    for name in FILES if folder.is_dir() else ():
        secured_file(folder / name, "the comparison")
    announce_compile()
    for engine in missing_engines():
        say(f"{engine} is not installed and left out. To compare with it: pip install 'watchsim[bench]'")
    rows, references = measured(args.quick, args.scene, say)
    write(folder, rows, references)
    if args.json:
        print_json(rows)
    else:
        print(table(rows, references))
    say(f"Results: {args.output}")
    return FINE


def measured(
    quick: bool, names: list[str] | None, report: Callable[[str], None]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Rows and references as plain mappings; ValueError for a scene that is not compared."""
    from dataclasses import asdict

    from watchsim.bench.compare import REPEATS, compare, scenarios

    chosen = scenarios()
    if unknown := set(names or ()) - {one.name for one in chosen}:
        known = "; ".join(one.name for one in chosen)
        raise ValueError(f"--scene {', '.join(sorted(unknown))}: no such scene. Choose from {known}")
    rows, references = [], []
    for scenario in chosen:
        if names and scenario.name not in names:
            continue
        reference, found = compare(scenario.quick() if quick else scenario, 1 if quick else REPEATS, report)
        references.append(asdict(reference))
        rows += [asdict(row) for row in found]
    return rows, references


def write(folder: Path, rows: list[dict[str, Any]], references: list[dict[str, Any]]) -> None:
    """bench.json, bench.md and bench.png."""
    from watchsim.bench.compare import table
    from watchsim.render.study_plot import plot_speed
    from watchsim.results.tables import json_text
    from watchsim.storage.write import write_file

    folder.mkdir(exist_ok=True)
    numbers = json_text({"rows": rows, "references": references})
    write_file(folder / FILES[0], lambda path: path.write_text(numbers, encoding="utf-8"), "the numbers")
    write_file(folder / FILES[1], lambda path: path.write_text(table(rows, references), encoding="utf-8"), "the table")
    write_file(folder / FILES[2], lambda path: plot_speed(rows, path), "the plot")
