"""watchsim check SCENE: is everything right, short of simulating?"""

from __future__ import annotations

import argparse
from pathlib import Path

from watchsim.commands.console import BAD_INPUT, FINE, MISSED, InputError, check_picture, print_json, say

HELP = "everything short of simulating: units, overlap at the start, mass, frequency, what can touch"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", help="a scene file (TOML), the folder that holds scene.toml, or a results folder"
    )
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of text")
    parser.add_argument(
        "--png", metavar="FILE", help="where to write a picture of the start position, what can ever touch in colour"
    )
    parser.add_argument(
        "--turn", action="store_true", help="turn the mechanism by hand, without forces: what meets what at which angle"
    )
    parser.add_argument(
        "--swing",
        metavar="WAY",
        help='with --turn: how far the oscillator is led to either side, such as "200°" (default: the start)',
    )
    parser.add_argument("--movie", metavar="FILE", help="with --turn: where to write it as a movie, file.mp4 or file.gif")


def run(args: argparse.Namespace) -> int:
    if not args.turn and (args.swing or args.movie):
        raise InputError(f"{'--swing' if args.swing else '--movie'}: belongs to --turn, which is not asked for.")
    from watchsim.commands.destination import secured_file
    from watchsim.commands.scenes import load_scene
    from watchsim.contact.counts import modelled_pairs
    from watchsim.drawing.findings import Finding
    from watchsim.mechanism.check import check_report, check_text
    from watchsim.mechanism.compile import compile_scene
    from watchsim.simulation.start import refusals

    if args.png:
        check_picture(args.png, args.scene)
        secured_file(Path(args.png), "the picture")
    scene = load_scene(args.scene, args.set, overlap=False)
    compiled = compile_scene(scene)
    pairs = modelled_pairs(compiled, [body.name for body in scene.bodies])
    report = check_report(scene, pairs.counts)
    for met, words in refusals(scene, compiled):
        x, y = (1e3 * value for value in met.place)
        report["findings"].append(Finding("overlap", "error", words, "", x_mm=x, y_mm=y).as_dict())
    wrong = any(finding["severity"] == "error" for finding in report["findings"])
    turned = None
    if args.turn and not wrong:
        from watchsim.commands.turn import turned_by_hand

        turned = turned_by_hand(scene, args.swing, args.movie, args.png)
        report["turn"] = turned.report
    elif args.png:
        from watchsim.render.still import still

        places = [(1e-3 * f["x_mm"], 1e-3 * f["y_mm"]) for f in report["findings"] if f["code"] == "overlap"]
        still(scene, args.png, compiled, pairs, places)
    if args.png:
        say(f"Picture: {args.png}")
    if args.json:
        print_json(report)
    else:
        print(check_text(report, scene))
        if turned is not None:
            print(turned.text)
    if wrong:
        return BAD_INPUT
    return MISSED if turned is not None and not turned.passes else FINE
