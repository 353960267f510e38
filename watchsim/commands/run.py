"""watchsim run SCENE: simulate, write the results folder, print the headline numbers."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import (
    FINE,
    GAVE_UP,
    INTERRUPTED,
    MISSED,
    InputError,
    Progress,
    announce_compile,
    print_json,
    say,
)

if TYPE_CHECKING:
    from watchsim.mechanism.scene import Scene
    from watchsim.simulation.trajectory import Trajectory

HELP = "simulate a scene and write a results folder"
METHODS = ("pfeiffer-glocker",)


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder (default results/NAME)")
    parser.add_argument("--duration", metavar="TIME", help='simulated time, such as "5 s" (default: the scene\'s)')
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument("--tol", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)")
    parser.add_argument("--method", default=METHODS[0], choices=METHODS, help="solver (default %(default)s)")
    parser.add_argument("--json", action="store_true", help="print the summary as one JSON object")
    parser.add_argument("--movie", action="store_true", help="write movie.mp4 too: the last beats in slow motion")
    parser.add_argument("--gif", action="store_true", help="write movie.gif too")
    parser.add_argument("--force", action="store_true", help="replace a results folder that exists")


def run(args: argparse.Namespace) -> int:
    from watchsim.analysis.results import check_folder
    from watchsim.commands.scenes import load_scene

    scene = load_scene(args.scene, args.set)
    duration = _duration(args.duration) if args.duration else None
    if args.tol is not None and not 1e-13 <= args.tol <= 1e-2:
        raise InputError(f"--tol {args.tol:g}: must lie between 1e-13 and 1e-2.")
    folder = Path(args.output) if args.output else Path("results") / _name(scene)
    check_folder(folder, args.force)
    trajectory = simulate_with_progress(scene, duration, args.tol)
    summary = write(trajectory, folder, args.force, movie=args.movie, gif=args.gif)
    # What a scene promises, it promises as it is written.
    as_written = not (args.set or args.duration or args.tol)
    if args.json:
        print_json(summary)
    else:
        from watchsim.analysis.summary import summary_text

        print(summary_text(trajectory, summary if as_written else {**summary, "expect": []}))
        print(f"Results: {folder}")
    return status(trajectory, summary, promised=as_written)


def simulate_with_progress(scene: Scene, duration: float | None, tolerance: float | None) -> Trajectory:
    """Simulate with a progress line on a terminal; the first run on a machine says that it compiles."""
    from watchsim.simulation.simulate import simulate

    announce_compile()
    progress = Progress("simulated s:")
    try:
        return simulate(scene, duration, tolerance, progress=progress)
    finally:
        progress.close()


def write(run: Trajectory, folder: Path, force: bool, movie: bool = False, gif: bool = False) -> dict[str, Any]:
    """Write the results folder with plots (and movies); returns the summary as written."""
    from watchsim.analysis.results import write_results
    from watchsim.analysis.summary import summary, tables
    from watchsim.analysis.tables import plain
    from watchsim.mechanism.lock import lock_text

    numbers = plain(summary(run))
    extra: dict[str, Any] = dict(tables(run))
    extra.update(_plots(run))
    if movie:
        extra["movie.mp4"] = lambda path: _movie(run, path, speed=1 / 20)
    if gif:
        extra["movie.gif"] = lambda path: _movie(run, path, speed=1 / 40)
    write_results(run, folder, numbers, lock_text(run.scene, folder.absolute()), extra=extra, force=force)
    return numbers


def _plots(run: Trajectory) -> dict[str, Any]:
    """Kinematic plots: all that was recorded, and the last beats."""
    from watchsim.render.plots import plot_kinematics

    if len(run.t) < 2:
        return {}
    windows = {"plots/kinematics.png": None, "plots/last_beats.png": last_beats(run)}

    def plot(window: tuple[float, float] | None) -> Any:
        return lambda path: plot_kinematics(run, window=window).savefig(path)

    return {name: plot(window) for name, window in windows.items()}


def last_beats(run: Trajectory, share: float = 1.5) -> tuple[float, float]:
    """The last one and a half oscillations, or the last tenth where nothing oscillates."""
    from watchsim.mechanism.check import frequency

    start, end = float(run.t[0]), float(run.t[-1])
    hertz = frequency(run.scene)
    length = share / hertz if hertz else 0.1 * (end - start)
    return max(start, end - length), end


def _movie(run: Trajectory, path: Path, speed: float) -> None:
    from watchsim.render.movie import movie

    progress = Progress(f"{path.name}, frames:")
    try:
        movie(run, path, window=last_beats(run, 1.1), speed=speed, progress=progress)
    finally:
        progress.close()


def status(run: Trajectory, summary: dict[str, Any], promised: bool = True) -> int:
    """Exit status of a finished run; says why on stderr where it is not 0. Missed expectations count only if `promised`."""
    from watchsim.analysis.headlines import expected_text
    from watchsim.simulation.stops import Stop

    if run.stop.gave_up:
        say(f"The solver gave up: {run.stop_message}. What was simulated up to there is kept.")
        return GAVE_UP
    if run.stop == Stop.INTERRUPTED:
        say(f"Stopped at {run.stop_message}.")
        return INTERRUPTED
    missed = [entry for entry in summary["expect"] if promised and not entry["ok"]]
    for entry in missed:
        say(expected_text(entry))
    if summary.get("stopped"):
        say("The watch has stopped ticking.")
    return MISSED if missed or summary.get("stopped") else FINE


def _duration(text: str) -> float:
    from watchsim.units import TIME, UnitError, parse

    try:
        value = parse(text, TIME)
    except UnitError as error:
        raise InputError(f'--duration "{text}": {error}') from error
    if not value > 0.0:
        raise InputError(f'--duration "{text}": must be positive.')
    return value


def _name(scene: Scene) -> str:
    """A folder name for the results: the scene's folder, with the file's own name where it is not scene.toml."""
    path = scene.path
    if path is None:
        return "scene"
    folder = path.resolve().parent.name
    return folder if path.stem == "scene" else f"{folder}_{path.stem}"
