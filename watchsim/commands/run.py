"""watchsim run SCENE: simulate, write the results folder, print the headline numbers."""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.beside import Meanwhile
from watchsim.commands.compare import plain_numbers, sides_of, text
from watchsim.commands.console import (
    FINE,
    GAVE_UP,
    MISSED,
    InputError,
    Progress,
    announce_compile,
    check_tolerance,
    parse_positive,
    parse_window,
    print_json,
    say,
)
from watchsim.commands.inputs import claimed, interrupted_place, room_for, secured_folder, swept_run
from watchsim.commands.write import Extras, goal_of, report_text, write
from watchsim.simulation import EVENT_DRIVEN, METHODS

if TYPE_CHECKING:
    from watchsim.render.kinematics_plot import Kinematics
    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.trajectory import Trajectory
    from watchsim.studies.compare import Comparison, Side


FAR = 1e8  # a balance has a thousand times the inertia of a lever
HELP = "simulate a scene and write a results folder"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene",
        metavar="SCENE",
        nargs="?",
        help="a scene file (TOML), the folder that holds scene.toml, or a results folder (default with --resume: its own)",
    )
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder (default results/NAME)")
    parser.add_argument(
        "--record",
        metavar="WHAT",
        action="append",
        default=[],
        help='what to keep: all, events, statistics, "every 10", or a window "179 s:180 s"; may be given several times',
    )
    parser.add_argument("--duration", metavar="TIME", help='simulated time, such as "5 s" (default: the scene\'s)')
    parser.add_argument(
        "--sample", metavar="N", type=int, help="for a tolerance study in place of a scene: the watch of that sample"
    )
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument(
        "--tol", "--tolerance", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)"
    )
    parser.add_argument("--method", choices=METHODS, help=f"solver (default {EVENT_DRIVEN})")
    parser.add_argument("--step", metavar="TIME", help='step of the method moreau, such as "10 µs" (the default)')
    parser.add_argument("--resume", metavar="RUN", help="continue from the end of this results folder, up to --duration")
    parser.add_argument(
        "--to-the-end", action="store_true", help="continue even when nothing can change any more, as after a stop"
    )
    parser.add_argument(
        "--error-bars", action="store_true", help="run again with tighter tolerance, and say how far the numbers move"
    )
    parser.add_argument("--against", metavar="RUN|SCENE", help="print what differs from this one, as watchsim compare does")
    parser.add_argument("--json", action="store_true", help="print the summary as one JSON object")
    parser.add_argument("--movie", action="store_true", help="write movie.mp4 too: the last beats slowly, or the whole run")
    parser.add_argument("--gif", action="store_true", help="write movie.gif too")
    parser.add_argument("--report", action="store_true", help="write report.html too: player, timing sheet, plots in one page")
    parser.add_argument("--no-plots", action="store_true", help="write no plots, which take a third of the time of a short run")
    parser.add_argument("--profile", action="store_true", help="count operations, and say where the time went")
    parser.add_argument("--force", action="store_true", help="replace a results folder that exists")


def run(args: argparse.Namespace) -> int:
    with contextlib.ExitStack() as held:
        return _run(args, held)


def _run(args: argparse.Namespace, held: contextlib.ExitStack) -> int:
    from watchsim.commands.inputs import load_scene, with_lift
    from watchsim.mechanism.check import notes
    from watchsim.results.folder import check_folder
    from watchsim.simulation.state import Stop
    from watchsim.units import TIME

    if args.scene is None and args.resume is None:
        raise InputError("run: name a scene file, or the folder that holds scene.toml.")
    scene = load_scene(args.scene or args.resume, args.set) if args.sample is None else _sample(args)
    if args.record:
        scene = scene.set("run.record", [_record(what) for what in args.record])
    duration = None if args.duration is None else parse_positive("--duration", args.duration, TIME)
    step = None if args.step is None else parse_positive("--step", args.step, TIME)
    scene = _with_windows(scene, scene.duration if duration is None else duration, requested=bool(args.record))
    check_tolerance(args.tol)
    method, start = args.method or EVENT_DRIVEN, None
    name = _name(scene) if args.sample is None else f"{Path(args.scene).resolve().name}-{args.sample}"
    folder = Path(args.output or args.resume or Path("results") / name)
    # What is resumed is written whole, with what follows it: nothing is lost where it takes the old one's place.
    goes_on = args.resume is not None and folder.resolve() == Path(args.resume).resolve()
    replace = args.force or goes_on
    if replace:
        held.enter_context(claimed(folder))
    if args.resume:
        swept_run(args.resume)
        start = _earlier(args.resume, scene)
        method, step = args.method or start.method, step or start.step
        args.tol = args.tol or start.tolerance
    if args.profile and method != EVENT_DRIVEN:
        raise InputError(f"--profile: only the method {EVENT_DRIVEN} has a profile, not {method}.")
    room = room_for(scene, scene.duration if duration is None else duration, folder)
    secured_folder(folder, "results", room, default=not (args.output or args.resume))
    check_folder(folder, replace)
    goal = goal_of(scene, folder, replace, keeps_later=goes_on and not args.force)
    # What a scene promises, it promises as it is written.
    given = {
        "--set": args.set,
        "--sample": args.sample is not None,
        "--duration": duration not in (None, scene.duration),
        "--tol": args.tol not in (None, scene.tolerance),
        "--step": step,
        "--method": method != EVENT_DRIVEN,
    }
    changed = [name for name, value in given.items() if value]
    for note in notes(scene):
        say(f"Note: {note.message}. {note.fix}")
    against = sides_of([args.against]) if args.against else []
    extras = Extras(not args.no_plots, args.movie, args.gif, args.error_bars, args.profile, args.report)
    with stopping.keeping():
        trajectory, lines, panels = simulate_with_progress(
            scene,
            duration,
            args.tol,
            folder,
            method=method,
            step=step,
            start=start,
            plotted=extras.plots,
            to_the_end=args.to_the_end,
        )
        if trajectory.stop == Stop.INTERRUPTED and folder.is_dir() and any(folder.iterdir()) and not goes_on:
            kept, folder = folder, interrupted_place(folder)
            goal = dataclasses.replace(goal, folder=folder, replace=False)
            say(f"The earlier results in {kept} are kept; what was simulated of this run goes to {folder}.")
        trajectory = with_lift(trajectory)
        summary = write(trajectory, goal, extras, changed, lines, panels)
    _report(args, trajectory, summary, _differences(against, trajectory, str(folder)), folder)
    return status(trajectory, summary)


def _report(
    args: argparse.Namespace, run: Trajectory, summary: dict[str, Any], differences: Comparison | None, folder: Path
) -> None:
    """What came of it, on stdout."""
    if args.json:
        print_json(summary if differences is None else {**summary, "against": plain_numbers(differences)})
        for warning in summary["warnings"]:
            say(f"Warning: {warning}.")
        return
    print(report_text(run, summary))
    if differences is not None:
        print(text(differences))
    print(f"Results: {folder}")


def _differences(against: list[Side], run: Trajectory, name: str) -> Comparison | None:
    """Between this run and the one that was named, where one was."""
    from watchsim.studies.compare import compare, side_of

    return compare(*against, dataclasses.replace(side_of(run), name=name)) if against else None


def _sample(args: argparse.Namespace) -> Scene:
    """The watch that a sample of a study is."""
    from watchsim.scene.load import assignments, changed
    from watchsim.studies.tolerance import sample_scene

    scene = sample_scene(args.scene or "", args.sample)
    return changed(scene, assignments(args.set)) if args.set else scene


def simulate_with_progress(
    scene: Scene,
    duration: float | None,
    tolerance: float | None,
    folder: Path,
    method: str = EVENT_DRIVEN,
    step: float | None = None,
    start: Trajectory | None = None,
    plotted: bool = False,
    to_the_end: bool = True,
) -> tuple[Trajectory, EventLines | None, Kinematics | None]:
    """Simulate for results in `folder`, with a progress line on a terminal; a first run says that it compiles.

    Also gives what was made meanwhile: its events as text, as far as they go, and panels for its plots.
    """
    from watchsim.commands.pictures import empty_panels
    from watchsim.simulation.simulate import simulate
    from watchsim.simulation.state import Stop
    from watchsim.storage.write import real

    announce_compile()
    beside = real(folder).parent
    panels_of = functools.partial(empty_panels, scene) if plotted else None
    progress, meanwhile = Progress("simulated s:"), Meanwhile(scene, beside, panels_of)

    def stepped(time: float, end: float) -> None:
        meanwhile.progress()
        progress(time, end)

    stepped.crowded = progress.crowded  # type: ignore[attr-defined]
    follow = meanwhile.follow if start is None else None
    try:
        run = simulate(
            *(scene, duration, tolerance),
            progress=stepped,
            method=method,
            step=step,
            start=start,
            stream=beside,
            follow=follow,
            to_the_end=to_the_end,
        )
        if run.stop == Stop.FOREGONE:  # at once, before anything is drawn
            progress.close()
            say(f"Ended early (--to-the-end continues): {run.stop_message}.")
    finally:
        lines, panels = meanwhile.end()
        progress.close()
    return run, lines, panels


def _earlier(folder: str, scene: Scene) -> Trajectory:
    """The run to go on from, its scene replaced by the one given, which must be the same (see `simulate`)."""
    from watchsim.results.folder import read_results

    run = read_results(folder)
    if run.end_state is None:
        raise InputError(f"--resume {folder}: this results folder holds no state.npz to go on from.")
    return dataclasses.replace(run, scene=scene)


def status(run: Trajectory, summary: dict[str, Any]) -> int:
    """Exit status of a finished run; says why on stderr where it is not 0."""
    from watchsim.analysis.headlines import expected_text
    from watchsim.analysis.verdict_kinds import SPOKEN
    from watchsim.simulation.state import Stop

    if run.stop.is_wrong:
        say(f"The result is wrong: {run.stop_message}. It is kept for inspection.")
        return GAVE_UP
    if run.stop.gave_up:
        say(f"The solver gave up: {run.stop_message}. What was simulated up to there is kept.")
        if hint := _unlike(run.scene):
            say(hint)
        return GAVE_UP
    if run.stop == Stop.INTERRUPTED:
        say(f"Stopped at {run.stop_message}.")
        return stopping.status()
    if stopping.requested():
        say("Interrupted while writing: everything was kept except the pictures that were not drawn yet.")
        return stopping.status()
    missed = [entry for entry in summary["expect"] if entry["ok"] is False]
    for entry in missed:
        say(expected_text(entry))
    about = summary.get("verdict_details")
    if about is not None and not about["works"]:
        say(f"It does not work: it {SPOKEN.get(summary['verdict'], summary['verdict'])}.")
        return MISSED
    return MISSED if missed else FINE


def _unlike(scene: Scene) -> str:
    """Words about a pivoted body that is so much lighter than another that a slip is likely; "" where there is none.

    A driven body has no inertia that matters, whatever it is given.
    """
    turning = sorted((body.inertia, body.name) for body in scene.bodies if body.motion == "pivot" and body.prescribed is None)
    if not turning or turning[-1][0] < FAR * turning[0][0]:
        return ""
    (least, light), (most, heavy) = turning[0], turning[-1]
    smaller = f"is {most / least:.1g} times smaller than that of {heavy}"
    return f"The inertia of {light}, {least:.3g} kg·m², {smaller}: is this intended?"


def _with_windows(scene: Scene, duration: float, requested: bool) -> Scene:
    """A window of --record that the run never enters is refused; those of the scene are moved to the end of a shorter run."""
    from watchsim.scene.scene import ALL, EVERY

    late = [window for window in scene.record.windows if window[0] >= duration]
    if not late:
        return scene
    last = max(end for _, end in scene.record.windows)
    if requested:
        start, end = late[0]
        words = f"the run ends at {duration:g} s, so that nothing can be recorded from {start:g} s to {end:g} s"
        raise InputError(f"--record: {words}. Choose another window or a longer --duration.")
    moved = [(max(0.0, start - last + duration), end - last + duration) for start, end in scene.record.windows]
    kept = [(start, end) for start, end in moved if end > 0.0]
    record: list[object] = [[f"{start!r} s", f"{end!r} s"] for start, end in kept]
    listed = " and ".join(f"{start:g} s to {end:g} s" for start, end in kept)
    say(f"Note: the run ends before the window of the scene's run.record; recorded is {listed} instead.")
    record += [] if scene.record.keep == ALL else [scene.record.keep]
    record += [] if scene.record.stride == 1 else [f"{EVERY} {scene.record.stride}"]
    return scene.set("run.record", record)


def _record(what: str) -> object:
    """A window as the scene file has it, or the word; InputError where it is neither."""
    from watchsim.scene.read_settings import is_stride
    from watchsim.scene.scene import EVERY, KEPT

    if ":" in what:
        parse_window(what, "--record")
        return [time.strip() for time in what.split(":")]
    word, _, number = what.partition(" ")
    if what in KEPT or (word == EVERY and is_stride(number)):
        return what
    raise InputError(f'--record "{what}": write {", ".join(KEPT)}, "{EVERY} 10", or a window such as "179 s:180 s".')


def _name(scene: Scene) -> str:
    """A folder name for the results: the scene's folder, with the file's own name where it is not scene.toml."""
    from watchsim.scene.load import SCENE_FILES

    path = scene.path
    if path is None:
        return "scene"
    folder = path.resolve().parent.name
    return folder if path.name in SCENE_FILES else f"{folder}_{path.stem}"
