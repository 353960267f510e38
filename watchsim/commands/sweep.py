"""watchsim sweep SCENE KEY=FROM:TO:N ...: how do amplitude, rate and beat error depend on the scene's numbers?

KEY is any path of the scene as in --set, with units: "torques.0.value=-0.6:-1.4:9 µN·m" or "contacts.0.friction=0.1,0.12,0.15".
Each point is the limit cycle itself (--steady, the default), or the end of a run (--duration). With --sensitivity: the
derivatives with respect to every number of the scene, or by the KEYs that are named.
"""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.console import (
    FINE,
    GAVE_UP,
    MISSED,
    InputError,
    Progress,
    add_study_options,
    announce_compile,
    check_tolerance,
    parse_names,
    parse_positive,
    print_json,
    say,
)

if TYPE_CHECKING:
    from watchsim.scene.scene import Scene
    from watchsim.studies.point import Output
    from watchsim.studies.workers import Executor


HELP = "parameter study: table and plot; or what matters in a watch (--sensitivity)"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument(
        "keys", metavar="KEY=FROM:TO:N", nargs="*", help="a key of the scene and its values; several make a grid"
    )
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder (default results/NAME-sweep)")
    parser.add_argument(
        "--outputs",
        metavar="NAMES",
        default="amplitude,rate,beat_error",
        help="of amplitude, rate, beat_error, period, multiplier, separated by commas (default %(default)s)",
    )
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--steady", action="store_true", help="each point by its limit cycle (the default)")
    how.add_argument("--duration", metavar="TIME", help='each point by a run of that length instead, such as "60 s"')
    parser.add_argument(
        "--sensitivity", action="store_true", help="derivatives with respect to every number of the scene, or by the KEYs named"
    )
    add_study_options(parser)


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene
    from watchsim.studies.point import outputs_named

    outputs = outputs_named(parse_names(args.outputs) or ())
    check_tolerance(args.tol)
    if args.workers is not None and args.workers < 1:
        raise InputError(f"--workers {args.workers}: at least one process is needed.")
    if args.sensitivity and args.duration:
        raise InputError("--sensitivity is taken on limit cycles; leave --duration out.")
    scene = load_scene(args.scene, args.set)
    study = _sensitivity if args.sensitivity else _sweep
    with contextlib.ExitStack() as held:
        return study(args, scene, outputs, held)


def _sweep(args: argparse.Namespace, scene: Scene, outputs: tuple[Output, ...], held: contextlib.ExitStack) -> int:
    from watchsim.commands.write import write_study
    from watchsim.studies.axes import axes_from_texts
    from watchsim.studies.point import Question
    from watchsim.studies.study_report import sweep_table, sweep_text
    from watchsim.studies.sweep import measured, swept
    from watchsim.units import TIME

    if not args.keys:
        raise InputError('sweep: name a key and its values, such as "torques.0.value=-0.6:-1.4:9 µN·m", or add --sensitivity.')
    axes = axes_from_texts(scene, args.keys)
    duration = None if args.duration is None else parse_positive("--duration", args.duration, TIME)
    points = 1
    for axis in axes:
        points *= len(axis.values)
    question = Question(scene, args.duration is None, duration, args.tol, function=measured(outputs))
    folder = study_folder(args, scene, "sweep", held)
    with stopping.keeping():
        done = watched(
            lambda progress: swept(
                question, axes, outputs, executor_of(args, points), folder=folder, resume=args.resume, progress=progress
            )
        )
        write_study(folder, done.numbers(), sweep_table(done), None if args.no_plots else _figure_of_sweep(done))
    if args.json:
        from watchsim.results.tables import plain

        print_json(plain(done.numbers()))
    else:
        print(sweep_text(done))
        print(f"Results: {folder}")
    without = sum(row[outputs[0].column] is None for row in done.rows)
    if without:
        have = "has" if without == 1 else "have"
        why = "; the column message says why" if any(row.get("message") for row in done.rows) else ": nothing swings in them"
        say(f"{without} of {len(done.rows)} points {have} no {outputs[0].label}{why}.")
    return status_of(done.whole, folder, MISSED if without == len(done.rows) else FINE)


def _sensitivity(args: argparse.Namespace, scene: Scene, outputs: tuple[Output, ...], held: contextlib.ExitStack) -> int:
    from watchsim.commands.write import write_study
    from watchsim.studies.sensitivity import found
    from watchsim.studies.study_report import sensitivity_table, sensitivity_text

    folder = study_folder(args, scene, "sensitivity", held)
    with stopping.keeping():
        done = watched(
            lambda progress: found(
                scene, args.keys or None, outputs, executor_of(args, None), args.tol, folder, args.resume, progress
            )
        )
        figure = None
        if done.effects and not args.no_plots:
            from watchsim.render.study_plot import plot_sensitivity

            figure = plot_sensitivity(done)
        write_study(folder, done.numbers(), sensitivity_table(done), figure)
    if args.json:
        from watchsim.results.tables import plain

        print_json(plain(done.numbers()))
    else:
        print(sensitivity_text(done))
        print(f"Results: {folder}")
    return status_of(done.whole, folder, FINE)


def status_of(whole: bool, folder: Path, fine: int) -> int:
    """The exit status of a study, `fine` unless it was interrupted, which is reported."""
    if whole:
        return fine
    say(f"Interrupted. Finished points are kept in {folder}; --resume goes on with the others.")
    return stopping.status()


def executor_of(args: argparse.Namespace, points: int | None) -> Executor:
    """Of --workers and --scheduler, for so many points; the solver is compiled once before."""
    from watchsim.jit import is_cached
    from watchsim.studies.sweep import processors
    from watchsim.studies.workers import chosen

    workers = args.workers or processors()
    if points is not None:
        workers = min(workers, points)
    announce_compile()
    if workers > 1 and args.scheduler is None and not is_cached("event_loop.advance"):
        _compile_once()
    return chosen(workers, args.scheduler)


def _compile_once() -> None:
    """Before several processes do it all at once."""
    from watchsim.paths import profiles_dir
    from watchsim.scene.load import load
    from watchsim.studies.section import Loop

    Loop(load(profiles_dir() / "balance"), 1e-9).warm_up()


def watched(compute: Callable[[Progress], Any]) -> Any:
    """With a progress line; a worker that was killed is no fault of the program."""
    from watchsim.studies.workers import WorkersLost

    progress = Progress("points:")
    try:
        return compute(progress)
    except WorkersLost as error:
        progress.close()
        say(f"{error}. Finished points are kept; --resume goes on with the others, --workers 1 needs the least memory.")
        raise SystemExit(GAVE_UP) from error
    finally:
        progress.close()


def study_folder(args: argparse.Namespace, scene: Scene, what: str, held: contextlib.ExitStack) -> Path:
    """The results folder, made if it is not there; refused where it holds something else."""
    from watchsim.commands.inputs import claimed, secured_folder
    from watchsim.studies.journal import NAME

    name = scene.path.parent.name if scene.path else "scene"
    folder = Path(args.output or Path("results") / f"{name}-{what}")
    secured_folder(folder, "results", default=not args.output)
    resume = getattr(args, "resume", None)  # None: that study cannot go on
    if folder.is_dir() and not args.force and any(not path.name.startswith(".") for path in folder.iterdir()):
        if not resume:
            ways = "Replace" if resume is None else "Continue it (--resume), replace"
            raise InputError(f"{folder} already exists. {ways} it (--force), or choose another folder (-o).")
        if not (folder / NAME).is_file():
            raise InputError(
                f"--resume {folder}: this folder holds no study. Replace it (--force), or choose another folder (-o)."
            )
    folder.mkdir(exist_ok=True)
    held.enter_context(claimed(folder))
    return folder


def _figure_of_sweep(done: Any) -> Any:
    from watchsim.render.study_plot import plot_sweep

    try:
        return plot_sweep(done) if done.rows else None
    except ValueError as error:
        say(f"No plot: {error}.")
        return None
