"""watchsim check SCENE: is everything right, short of simulating?"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import BAD_INPUT, FINE, MISSED, InputError, check_picture, parse_width, print_json, say

if TYPE_CHECKING:
    from watchsim.escapement.measure import Function
    from watchsim.mechanism.compile import Compiled
    from watchsim.scene.scene import Scene


SHEETS = (".png", ".svg", ".pdf")
HELP = "everything short of simulating: units, overlap at the start, mass, frequency, what can touch"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", help="a scene file (TOML), the folder that holds scene.toml, or a results folder"
    )
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of text")
    parser.add_argument(
        "--png",
        metavar="FILE",
        help="where to write a picture of the start position, what can ever touch in colour; for an escapement also "
        "FILE_function.png, its geometry of function; for a scene with tolerances FILE_tolerances.png",
    )
    parser.add_argument("--dark", action="store_true", help="pictures, sheet and movie with a dark background")
    parser.add_argument("--sheet", metavar="FILE", help="where to write the geometry of function alone (.png, .svg or .pdf)")
    parser.add_argument(
        "--width",
        metavar="LENGTH",
        default="170 mm",
        help='width of that sheet (default "%(default)s", or "85 mm" for a column)',
    )
    parser.add_argument(
        "--turn", action="store_true", help="turn the mechanism by hand, without forces: what meets what at which angle"
    )
    parser.add_argument(
        "--swing",
        metavar="WAY",
        help='with --turn: how far the oscillator is turned to each side, such as "200°" (default: the start)',
    )
    parser.add_argument("--movie", metavar="FILE", help="with --turn: where to write it as a movie, file.mp4 or file.gif")


def run(args: argparse.Namespace) -> int:
    _check_options(args)
    from watchsim.commands.inputs import load_scene, secured_file
    from watchsim.drawing.findings import Finding
    from watchsim.escapement.function_report import draw_left, findings, statics, text
    from watchsim.escapement.measure import measure
    from watchsim.mechanism.check import check_report, check_text, modelled_pairs
    from watchsim.mechanism.compile import compile_scene
    from watchsim.simulation.start import refusals

    width = parse_width(args.width)
    sheets = [Path(args.sheet)] if args.sheet else []
    if args.png:
        check_picture(args.png, args.scene)
        secured_file(Path(args.png), "the picture")
    for path in sheets:
        if path.suffix.lower() not in SHEETS:
            raise InputError(f"--sheet {path}: its name must end in {', '.join(SHEETS)}.")
        secured_file(path, "the sheet")
    scene = load_scene(args.scene, args.set, overlap=False)
    compiled = compile_scene(scene)
    pairs = modelled_pairs(compiled, [body.name for body in scene.bodies])
    report = check_report(scene, pairs.counts)
    for met, words in refusals(scene, compiled):
        x, y = (1e3 * value for value in met.place)
        report["findings"].append(Finding("overlap", "error", words, "", x_mm=x, y_mm=y).as_dict())
    function = measure(scene, compiled)
    report["statics"] = statics(function)
    report["findings"] += findings(scene, function)
    wrong = any(finding["severity"] == "error" for finding in report["findings"])
    turned, passes = None, True
    if args.turn and not wrong:
        from watchsim.commands.pictures import turned_by_hand
        from watchsim.escapement.turn import PASSES

        report["turn"], turned = turned_by_hand(scene, args.swing, args.movie, args.png, args.dark)
        passes = report["turn"]["verdict"] == PASSES
    elif args.png:
        from watchsim.render.stage import still

        places = [(1e-3 * f["x_mm"], 1e-3 * f["y_mm"]) for f in report["findings"] if f["code"] == "overlap"]
        still(scene, args.png, compiled, pairs, places, args.dark)
    if args.png:
        if function.pallets is not None:
            sheets.append(Path(args.png).with_name(f"{Path(args.png).stem}_function.png"))
        say(f"Picture: {args.png}")
        if scene.tolerances:
            _limits(scene, Path(args.png).with_name(f"{Path(args.png).stem}_tolerances.png"), args.dark)
    for path in sheets:
        _sheet(scene, compiled, function, path, width, args.dark)
    if args.json:
        print_json(report)
    else:
        print(check_text(report, scene, [*text(function), *draw_left(scene, function)]))
        if turned is not None:
            print(turned)
    if wrong:
        return BAD_INPUT
    return FINE if passes else MISSED


def _check_options(args: argparse.Namespace) -> None:
    if args.dark and not (args.png or args.sheet or args.movie):
        raise InputError("--dark: nothing is drawn; give --png, --sheet or --movie.")
    if not args.turn and (args.swing or args.movie):
        raise InputError(f"{'--swing' if args.swing else '--movie'}: needs --turn.")


def _limits(scene: Scene, path: Path, on_dark: bool) -> None:
    from watchsim.render.palette import dark
    from watchsim.render.style import save
    from watchsim.render.tolerance_plot import plot_limits
    from watchsim.storage.write import write_file

    figure = plot_limits(scene)
    write_file(path, lambda place: save(dark(figure) if on_dark else figure, place), "the picture")
    say(f"Tolerances: {path}")


def _sheet(scene: Scene, compiled: Compiled, function: Function, path: Path, width: float, on_dark: bool) -> None:
    from watchsim.render.function_sheet import function_sheet, write_sheet
    from watchsim.render.palette import dark

    try:
        figure = function_sheet(scene, compiled, function, 1e3 * width)
    except ValueError as error:
        raise InputError(f"--sheet {path}: {error}.") from error
    write_sheet(path, dark(figure) if on_dark else figure)
    say(f"Sheet: {path}")
