"""watchsim shock SCENE: what a blow does to the watch, against the same watch without it.

The blow is that of ISO 1413: a hammer of 4.43 m/s gives the case half a sine of 3100 g over 0.35 ms; other speeds scale
its height. With --map it strikes from 24 directions at 24 phases of the oscillation, and a picture shows the outcome.
"""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path
from typing import Any

from watchsim.commands.console import FINE, MISSED, InputError, Progress, parse_quantity, print_json

HELP = "what a blow does: jewel, guard pin, time lost; a map over direction and phase"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument(
        "--direction", metavar="ANGLE", default="0°", help="direction of the case's acceleration in the movement (0°)"
    )
    parser.add_argument("--speed", metavar="SPEED", default="4.43 m/s", help="speed of the hammer (default %(default)s)")
    parser.add_argument(
        "--phase", metavar="SHARE", type=float, default=0.0, help="phase of the oscillation, 0 to 1 (default 0)"
    )
    parser.add_argument("--after", metavar="TIME", default="5 s", help="how long the watch is observed (default %(default)s)")
    parser.add_argument("--map", action="store_true", help="24 directions and 24 phases instead")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a key of the scene")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of text")
    parser.add_argument("-o", "--output", metavar="DIR", help="results folder of a map (default results/NAME-shock)")
    parser.add_argument("--force", action="store_true", help="replace the results folder")


def run(args: argparse.Namespace) -> int:
    from watchsim import stopping, units
    from watchsim.commands.inputs import load_scene
    from watchsim.studies.shock import shock_lines, shock_map, struck, unstruck

    direction = parse_quantity("--direction", args.direction, units.ANGLE)
    speed, after = parse_quantity("--speed", args.speed, units.SPEED), parse_quantity("--after", args.after, units.TIME)
    faults = [f"{name}: must be above zero" for name, value in (("--speed", speed), ("--after", after)) if not value > 0.0]
    if not 0.0 <= args.phase < 1.0:
        faults.append(f"--phase {args.phase:g}: a share of an oscillation from 0 up to, not including, 1")
    if faults:
        raise InputError("\n".join(f"{one}." for one in faults))
    scene = load_scene(args.scene, args.set)
    if not args.map:
        blow, _ = struck(unstruck(scene, after), direction, speed, args.phase)
        if args.json:
            from dataclasses import asdict

            print_json(asdict(blow))
        else:
            print("\n".join(shock_lines([blow])))
        return FINE if blow.harmless else MISSED
    from watchsim.commands.sweep import study_folder

    with contextlib.ExitStack() as held:
        folder = study_folder(args, scene, "shock", held)
        with stopping.keeping():
            progress = Progress("blows:")
            try:
                found = shock_map(scene, speed, after=after, progress=progress)
            finally:
                progress.close()
            if found.blows:
                _write(folder, found)
    if args.json:
        print_json(found.numbers())
    else:
        print(f"{found.harmless} of {len(found.blows)} blows are harmless.\nResults: {folder}")
    return FINE if found.whole else stopping.status()


def _write(folder: Path, found: Any) -> None:
    from watchsim.commands.write import write_study
    from watchsim.render.shock_plot import plot_shock_map

    columns = {name: [getattr(one, name) for one in found.blows] for name in found.blows[0].__dataclass_fields__}
    write_study(folder, found.numbers(), columns, plot_shock_map(found), "shock")
