"""watchsim improve SCENE KEY=FROM:TO ...: which dimensions make a better watch?

KEY is a dimension of the scene's design (lock=1.2°:3°) or any path of --set; --vary KEY changes one without limits. One KEY and
--goal "amplitude = 290°" is solved in seconds. Several goals of max and min give a front. Designs that do not tick count as
worse than any that do.
"""

from __future__ import annotations

import argparse
import contextlib
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import (
    FINE,
    MISSED,
    Progress,
    all_at_once,
    announce_compile,
    check_tolerance,
    parse_positive,
    print_json,
    say,
)

if TYPE_CHECKING:
    from watchsim.studies.goals import Better

HELP = "a better watch: goals, limits, and what holds it back"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument("keys", metavar="KEY=FROM:TO", nargs="*", help="what may be changed, and between which limits")
    parser.add_argument(
        "--vary", metavar="KEY", action="append", default=[], help="a number that may be changed without limits"
    )
    parser.add_argument(
        "--goal", metavar="GOAL", action="append", default=[], help='such as "amplitude max", "torque min", "amplitude = 290°"'
    )
    parser.add_argument("--keep", metavar="LIMIT", action="append", default=[], help='such as "total_lock >= 1.2°"')
    parser.add_argument(
        "--method",
        metavar="NAME",
        default="auto",
        help="auto, slsqp, nelder-mead or differential-evolution (default %(default)s)",
    )
    parser.add_argument(
        "--starts", metavar="N", type=int, default=1, help="number of searches, each from another starting point"
    )
    parser.add_argument("--points", metavar="N", type=int, default=9, help="designs on a front (default %(default)s)")
    parser.add_argument("-o", "--output", metavar="DIR", help="write the better scene there, with its drawings")
    parser.add_argument("--duration", metavar="TIME", help='judge by the end of a run of that length instead, such as "60 s"')
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene first")
    parser.add_argument(
        "--tol", "--tolerance", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)"
    )
    parser.add_argument(
        "--workers", metavar="N", type=int, help="processes (default: 1; for a yield as many as there are processors)"
    )
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of dask.distributed, such as tcp://127.0.0.1:8786")
    parser.add_argument("--force", action="store_true", help="replace a folder that exists")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene, secured_folder
    from watchsim.studies.goals import YIELD, arguments
    from watchsim.studies.improve import improve
    from watchsim.studies.sweep import processors
    from watchsim.units import TIME

    knobs, wrong = limits_of(args.keys, args.vary)
    folder = None if args.output is None else Path(args.output)
    if folder is not None and folder.is_dir() and any(folder.iterdir()) and not args.force:
        wrong.append(f"-o {folder}: exists already. Choose another folder, or replace what is there with --force.")
    if args.workers is not None and args.workers < 1:
        wrong.append(f"--workers {args.workers}: at least one process is needed.")
    with all_at_once(wrong) as also:
        also(check_tolerance, args.tol)
        duration = None if args.duration is None else also(parse_positive, "--duration", args.duration, TIME)
        scene = also(load_scene, args.scene, args.set)
        if scene is not None and (knobs or not wrong):
            also(arguments, scene, knobs, args.goal, args.keep, args.method, args.starts, args.points)
    if folder is not None:
        secured_folder(folder, "the better scene")
    announce_compile()
    workers = args.workers or (processors() if any(YIELD.name in one for one in (*args.goal, *args.keep)) else 1)
    progress = Progress("designs evaluated:")
    try:
        better = improve(
            scene, knobs, args.goal, args.keep, method=args.method, starts=args.starts, points=args.points, duration=duration,
            tolerance=args.tol, workers=workers, scheduler=args.scheduler, progress=lambda n: progress(n, math.inf),
        )  # fmt: skip
    finally:
        progress.close()
    if args.json:
        from watchsim.results.tables import plain

        print_json(plain(better.numbers()))
    else:
        print(text(better))
    if folder is not None and better.found:
        _save(better, folder)
        say(f"Better scene: {folder}")
    return FINE if better.found else MISSED


def limits_of(texts: list[str], free: list[str]) -> tuple[dict[str, tuple[str, str] | None], list[str]]:
    """Keys with their limits; the unit behind the second limit is also that of the first."""
    from watchsim.units import UnitError, split

    found: dict[str, tuple[str, str] | None] = {}
    wrong = []
    for text in texts:
        key, equals, limits = (part.strip() for part in text.partition("="))
        parts = [part.strip() for part in limits.split(":")]
        if not key or not equals or len(parts) != 2 or not all(parts):
            wrong.append(f'"{text}": write KEY=FROM:TO, such as "lock=1.2°:3°", or --vary KEY without limits.')
            continue
        with contextlib.suppress(UnitError):
            if not split(parts[0])[1]:
                parts[0] = f"{parts[0]} {split(parts[1])[1]}".strip()
        if key in found:
            wrong.append(f"{key}: is given twice; name each key once.")
        found[key] = (parts[0], parts[1])
    for key in free:
        if key in found:
            wrong.append(f"{key}: is given twice; name each key once.")
        found.setdefault(key, None)
    return found, wrong


def text(better: Better) -> str:
    """For people: a table of old and new, and what holds it back."""
    from watchsim.studies.goals import KNOWN, shown

    rows = []
    by_column = {one.column: one for one in KNOWN.values()}
    for knob in better.knobs:
        new = better.keys.get(knob.key)
        rows.append([knob.key, knob.shown(knob.value), "" if new is None else knob.shown(new[1])])
    for column, pair in better.values.items():
        rows.append([by_column[column].label, *("" if one is None else shown(by_column[column], one) for one in pair)])
    lines = [better.title, *columns([["", "old", "new"], *rows])]
    if better.front:
        lines += ["", "  front", *columns(_front(better))]
    lines += [f"  held back by {words}" for words in better.active]
    if better.found and not better.active and any(one.is_goal for one in better.goals) and not better.front:
        lines.append("  no limit holds it back: it is the best within them")
    lines += [f"  {better.message}"] if better.message else []
    if better.starts[0] > 1:
        lines.append(f"  {better.starts[1]} of {better.starts[0]} searches end in this design or an equivalent one")
    without = f", {better.without} of them do not work and count as worse than any that do" if better.without else ""
    return "\n".join([*lines, f"  {better.evaluations} designs evaluated in {better.wall_s:.2g} s{without}"])


def _front(better: Better) -> list[list[str]]:
    from watchsim.studies.goals import KNOWN, shown

    outputs = [one for one in KNOWN.values() if one.column in better.front[0]]
    head = [*(knob.key for knob in better.knobs), *(one.label for one in outputs)]
    return [head] + [
        [*(knob.shown(one[knob.key]) for knob in better.knobs), *(shown(out, one[out.column]) for out in outputs)]
        for one in better.front
    ]


def columns(rows: list[list[str]]) -> list[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["    " + "  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]


def _save(better: Better, folder: Path) -> None:
    from watchsim.results.tables import json_text, plain
    from watchsim.scene.rewrite import write_scene
    from watchsim.storage.write import write_folder

    figure = _figure(better)

    def fill(place: Path) -> None:
        write_scene(better.scene, better.changes, place)
        (place / "improve.json").write_text(json_text(plain(better.numbers())), encoding="utf-8")
        (place / "improve.txt").write_text(text(better) + "\n", encoding="utf-8")
        if figure is not None:
            from watchsim.render.style import save

            save(figure, place / "front.png")

    write_folder(folder, fill, lambda name: True, "the better scene")


def _figure(better: Better) -> Any:
    if len(better.goals) != 2 or not better.front:
        return None
    from watchsim.render.study_plot import plot_front

    return plot_front(better)
