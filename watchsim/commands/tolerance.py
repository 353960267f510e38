"""watchsim tolerance SCENE: how many of the watches made to its [tolerances] work, and which dimension decides it?

Each sample is a watch with all dimensions drawn within their limits, and its limit cycle (or a run, --duration). It is good if
it ticks and meets [expect]. A sample can be looked at: watchsim run STUDY --sample 213 --movie.
"""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.console import FINE, InputError, add_study_options, check_tolerance, parse_positive, print_json, say
from watchsim.commands.sweep import executor_of, status_of, study_folder, watched
from watchsim.commands.write import write_study

if TYPE_CHECKING:
    from watchsim.studies.tolerance_result import ToleranceStudy

HELP = "the yield of a tolerance study, what limits it, and which dimension contributes how much"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", help="a scene file (TOML) with [tolerances], or the folder that holds scene.toml"
    )
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder (default results/NAME-tolerance)")
    parser.add_argument("--samples", metavar="N", type=int, default=1024, help="watches, at most (default %(default)s)")
    parser.add_argument("--until", metavar="WIDTH", help='stop when the yield is known to within this: "±0.5 %%"')
    parser.add_argument("--duration", metavar="TIME", help='each sample by a run of that length, such as "60 s"')
    parser.add_argument("--importance", action="store_true", help="sample mostly near the failures: for yields above 99.9 %%")
    parser.add_argument(
        "--seed", metavar="N", type=int, default=0, help="seed of the samples: another one draws other watches (default 0)"
    )
    parser.add_argument("--shard", metavar="I/N", help="only the i-th of n shares, for watchsim merge")
    add_study_options(parser)


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene
    from watchsim.scene.errors import SceneError
    from watchsim.scene.read_tolerances import checked_samples, half_width, require_tolerances
    from watchsim.studies.journal import same_study, study_of_tolerances
    from watchsim.units import TIME

    faults = []
    for check in (lambda: checked_samples(args.samples), lambda: half_width(args.until), lambda: _shard(args.shard)):
        try:
            check()
        except ValueError as error:
            faults.append(f"--{error}")
    if args.workers is not None and args.workers < 1:
        faults.append(f"--workers {args.workers}: at least one process is needed")
    if args.seed < 0:
        faults.append(f"--seed {args.seed}: a whole number from 0 on is needed")
    try:
        scene = load_scene(args.scene, args.set)
        require_tolerances(scene)
    except SceneError as error:
        raise InputError("\n".join([*faults, str(error)])) from error
    if faults:
        raise InputError("\n".join(faults))
    check_tolerance(args.tol)
    duration = None if args.duration is None else parse_positive("--duration", args.duration, TIME)
    shard = _shard(args.shard)
    what = "tolerance" if shard is None else f"tolerance-{shard[0]}-of-{shard[1]}"
    with contextlib.ExitStack() as held:
        folder = study_folder(args, scene, what, held)
        if args.resume:
            same_study(folder, study_of_tolerances(scene, duration, args.tol, args.seed, args.importance))
        from watchsim.studies.tolerance import made  # late: what computes takes as long to import as a fault to find
        from watchsim.studies.tolerance_plan import plan_of

        with stopping.keeping():
            resumed = folder if args.resume else None
            plan = plan_of(
                scene, duration=duration, tolerance=args.tol, seed=args.seed, importance=args.importance, resumed=resumed
            )
            executor = executor_of(args, args.samples)
            for key in plan.not_judged:
                say(f'Note: samples are not judged by "{key}", which they do not give.')
            done = watched(
                lambda progress: made(
                    plan,
                    args.samples,
                    executor,
                    until=half_width(args.until),
                    shard=shard,
                    folder=folder,
                    resume=args.resume,
                    progress=progress,
                )
            )
            show(done, folder, args.no_plots or shard is not None, args.json)
        return status_of(done.whole, folder, FINE)


def _shard(text: str | None) -> tuple[int, int] | None:
    """(3, 64) of "3/64"; ValueError for another text."""
    if text is None:
        return None
    first, _, last = text.partition("/")
    if not (first.isdecimal() and last.isdecimal() and 1 <= int(first) <= int(last)):
        raise ValueError(f'shard {text}: write e.g. "3/64", the third of 64 shares')
    return int(first), int(last)


def show(done: ToleranceStudy, folder: Path | None, no_plots: bool, as_json: bool) -> None:
    """Write what a study gives into its folder, and print it."""
    from watchsim.results.tables import plain
    from watchsim.studies.study_report import tolerance_table, tolerance_text

    if folder is not None:
        write_study(folder, done.numbers(), tolerance_table(done), None if no_plots else _figure(done), "tolerance")
    if as_json:
        print_json(plain(done.numbers()))
        return
    print(tolerance_text(done))
    if folder is not None:
        print(f"Results: {folder}")


def _figure(done: ToleranceStudy) -> Any:
    from watchsim.render.tolerance_plot import plot_tolerance

    return plot_tolerance(done) if done.outputs else None
