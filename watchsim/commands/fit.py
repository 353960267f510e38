"""watchsim fit SCENE MEASURED --vary KEY ...: which numbers of the scene make it do what was measured?

MEASURED is a CSV file with a decay (t_s, angle_deg or amplitude_deg) or with readings of a timing machine (rate_s_per_d,
amplitude_deg, beat_error_ms, beside position, wound_h or any path of the scene), or a recording (WAV).
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import FINE, MISSED, Progress, all_at_once, announce_compile, check_tolerance, print_json, say

if TYPE_CHECKING:
    from watchsim.studies.fit import Fit

HELP = "numbers of a scene from a measured decay, timing machine readings or a recording"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument("measured", metavar="MEASURED", help="a CSV or WAV file")
    parser.add_argument(
        "--vary",
        metavar="KEY",
        action="append",
        default=[],
        help='what is fitted, such as "damping.0.q_factor", or KEY=FROM:TO',
    )
    parser.add_argument("-o", "--output", metavar="DIR", help="write the fitted scene there, with its drawings and a plot")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene first")
    parser.add_argument(
        "--tol", "--tolerance", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)"
    )
    parser.add_argument("--workers", metavar="N", type=int, default=1, help="processes (default %(default)s)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of dask.distributed, such as tcp://127.0.0.1:8786")
    parser.add_argument("--force", action="store_true", help="replace a folder that exists")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.improve import limits_of
    from watchsim.commands.inputs import load_scene, secured_folder
    from watchsim.studies.fit import fit

    knobs, wrong = limits_of([one for one in args.vary if "=" in one], [one for one in args.vary if "=" not in one])
    folder = None if args.output is None else Path(args.output)
    if folder is not None and folder.is_dir() and any(folder.iterdir()) and not args.force:
        wrong.append(f"-o {folder}: exists already. Choose another folder, or replace what is there with --force.")
    if not Path(args.measured).is_file():
        wrong.append(f"{args.measured}: {'is a folder' if Path(args.measured).is_dir() else 'there is no such file'}.")
    if args.workers < 1:
        wrong.append(f"--workers {args.workers}: at least one process is needed.")
    with all_at_once(wrong) as also:
        also(check_tolerance, args.tol)
        scene = also(load_scene, args.scene, args.set)
    if folder is not None:
        secured_folder(folder, "the fitted scene")
    announce_compile()
    progress = Progress("scenes evaluated:")
    try:
        found = fit(
            scene, args.measured, knobs, tolerance=args.tol, workers=args.workers, scheduler=args.scheduler,
            progress=lambda n: progress(n, math.inf),
        )  # fmt: skip
    finally:
        progress.close()
    if args.json:
        from watchsim.results.tables import plain

        print_json(plain(found.numbers()))
    else:
        print(text(found))
    if folder is not None and found.found:
        _save(found, folder)
        say(f"Fitted scene: {folder}")
    return FINE if found.found else MISSED


def text(found: Fit) -> str:
    """For people: values with their intervals, and what cannot be distinguished."""
    from watchsim.commands.improve import columns

    rows = [["", "scene", "fitted", "95 % interval"]]
    for knob in found.knobs:
        one = found.keys.get(knob.key)
        if one is not None:
            known = one.low is not None and one.high is not None
            interval = (
                f"{knob.shown(one.low or 0.0)} to {knob.shown(one.high or 0.0)}"
                if known
                else "not bounded by what was measured"
            )
            rows.append([knob.key, knob.shown(one.old), knob.shown(one.value), interval])
    lines = [f"{found.title}, fitted to {found.measured.name}", *(columns(rows) if found.keys else [])]
    lines += [f"  {words}" for words in found.words]
    for kind, scatter in found.scatter.items() if found.found else ():
        name, _, unit = kind.replace("_per_", "/").replace("rate_s", "rate_s").rpartition("_")
        lines.append(f"  scatter of {name.replace('_', ' ')}: {scatter:.3g} {unit.replace('deg', '°')}")
    lines += [f"  {found.message}"] if found.message else []
    return "\n".join(
        [*lines, f"  {found.measured.count} readings, {found.evaluations} scenes evaluated in {found.wall_s:.2g} s"]
    )


def _save(found: Fit, folder: Path) -> None:
    from watchsim.render.study_plot import plot_fit
    from watchsim.render.style import save
    from watchsim.results.tables import json_text, plain
    from watchsim.scene.rewrite import write_scene
    from watchsim.storage.write import write_folder

    figure = plot_fit(found)

    def fill(place: Path) -> None:
        write_scene(found.scene, found.changes, place)
        (place / "fit.json").write_text(json_text(plain(found.numbers())), encoding="utf-8")
        (place / "fit.txt").write_text(text(found) + "\n", encoding="utf-8")
        save(figure, place / "fit.png")

    write_folder(folder, fill, lambda name: True, "the fitted scene")
