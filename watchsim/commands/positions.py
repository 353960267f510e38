"""watchsim positions SCENE: what a timing machine shows of the watch in all positions, wound and a day later, cold and warm.

Each reading is the limit cycle in that state. Mean and differences (X, D, DVH), the poise error of the balance as a poising
tool finds it, and the criteria of ISO 3159 follow. The scene's [watch] says where 12 o'clock lies and what temperature does.
"""

from __future__ import annotations

import argparse
import contextlib
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.console import FINE, MISSED, InputError, add_study_options, check_tolerance, parse_names, print_json
from watchsim.commands.sweep import executor_of, status_of, study_folder, watched

if TYPE_CHECKING:
    from watchsim.studies.positions import Positions

HELP = "rate, amplitude and beat error in positions, windings, temperatures; ISO 3159"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument(
        "--positions",
        metavar="NAMES",
        default="CH,CB,3H,6H,9H,12H",
        help="dial up CH, dial down CB, or the hour that is up, also 10H30 (default %(default)s)",
    )
    parser.add_argument(
        "--temperatures", metavar="LIST", help="°C, such as 8,23,38 (the default where the scene has watch.thermal, else 23)"
    )
    parser.add_argument("--wound", metavar="LIST", help="hours since winding (default 0,24 with a mainspring, else 0)")
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder (default results/NAME-positions)")
    add_study_options(parser)


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene
    from watchsim.scene.read_watch import up_of
    from watchsim.studies.positions import planned

    check_tolerance(args.tol)
    faults: list[str] = []
    temperatures, wound = _numbers("--temperatures", args.temperatures, faults), _numbers("--wound", args.wound, faults)
    names = parse_names(args.positions)
    if not names:
        faults.append("--positions: name at least one, such as CH,6H")
    for name in names or ():
        try:
            up_of(name)
        except ValueError as error:
            faults.append(f"--positions: {error}")
    if args.workers is not None and args.workers < 1:
        faults.append(f"--workers {args.workers}: at least one process is needed")
    if faults:
        raise InputError("\n".join(f"{one}." for one in faults))
    scene = load_scene(args.scene, args.set)
    study = planned(scene, names or (), temperatures, wound, args.tol)
    with contextlib.ExitStack() as held:
        folder = study_folder(args, scene, "positions", held)
        with stopping.keeping():
            executor = executor_of(args, None)
            done = watched(lambda progress: study(executor, folder, args.resume, progress))
            _show(done, folder, args)
    ticking = all(row["rate_s_per_d"] is not None for row in done.rows)
    return status_of(done.whole, folder, FINE if ticking else MISSED)


def _numbers(option: str, text: str | None, faults: list[str]) -> list[float] | None:
    """The numbers of a text such as "8,23,38"."""
    if text is None:
        return None
    try:
        return [float(part) for part in text.replace("−", "-").split(",")]
    except ValueError:
        faults.append(f'{option} "{text}": write numbers separated by commas, such as 8,23,38')
        return None


def _show(done: Positions, folder: Any, args: argparse.Namespace) -> None:
    from watchsim.commands.write import write_study
    from watchsim.results.tables import plain
    from watchsim.studies.study_report import positions_table, positions_text

    write_study(folder, done.numbers(), positions_table(done), None if args.no_plots else _figure(done), "positions")
    if args.json:
        print_json(plain(done.numbers()))
        return
    print(positions_text(done))
    print(f"Results: {folder}")


def _figure(done: Positions) -> Any:
    from watchsim.render.positions_plot import plot_positions

    return plot_positions(done) if any(row["rate_s_per_d"] is not None for row in done.rows) else None
