"""watchsim inspect FILE: what is in this drawing, and what is wrong with it?

Exit status 0: the drawing was read, whatever faults are listed (`watchsim check` of a scene that uses it judges them); 2: there
was nothing that could be read.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import (
    BAD_INPUT,
    FINE,
    InputError,
    check_picture,
    parse_positive,
    parse_quantity,
    print_json,
    say,
)

if TYPE_CHECKING:
    from watchsim.drawing.drawing import Drawing


HELP = "read a drawing: units, size, layers, loops, lines, arcs, faults"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="a DXF or SVG drawing, or a solid: STL, OBJ, GLB, 3MF or STEP")
    parser.add_argument("--units", metavar="UNIT", help="read lengths in this unit (mm, inch, ...) whatever the file says")
    parser.add_argument("--layer", metavar="NAMES", help="only these layers, separated by commas")
    parser.add_argument(
        "--snap", metavar="LENGTH", help='join ends that are this close together, such as "2 µm" (default 1 µm)'
    )
    parser.add_argument("--fit", metavar="LENGTH", help='follow splines and ellipses this closely by arcs (default "0.1 µm")')
    parser.add_argument("--section", metavar="HEIGHT", help='cut a solid at this height along its z axis, such as "0.15 mm"')
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of text")
    parser.add_argument("--png", metavar="FILE", help="where to write the picture (default: none)")
    parser.add_argument("--centres", action="store_true", help="mark the centres of arcs in the picture")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import secured_file
    from watchsim.drawing.inspection import inspect_report, inspect_text
    from watchsim.drawing.read import read
    from watchsim.units import LENGTH

    if args.png:
        check_picture(args.png, args.file)
        secured_file(Path(args.png), "the picture")
    asked = {name: getattr(args, name) for name in ("snap", "fit")}
    lengths = {name: parse_positive(f"--{name}", text, LENGTH) for name, text in asked.items() if text is not None}
    section = None if args.section is None else parse_quantity("--section", args.section, LENGTH)
    try:
        drawing = read(args.file, units=args.units, section=section, **lengths)
    except ValueError as error:
        raise InputError(f"{args.file}: {error}") from error
    if args.layer:
        drawing = _only(drawing, [name.strip() for name in args.layer.split(",")])
    unreadable = not drawing.layers and any(finding.severity == "error" for finding in drawing.findings)
    if args.png and not unreadable:
        from watchsim.render.drawing_picture import draw_drawing

        draw_drawing(drawing, args.png, centres=args.centres)
        say(f"Picture: {args.png}")
    if args.json:
        print_json(inspect_report(drawing))
    else:
        print(inspect_text(drawing))
    return BAD_INPUT if unreadable else FINE


def _only(drawing: Drawing, names: list[str]) -> Drawing:
    """The drawing with only these layers."""
    unknown = [name for name in names if name not in drawing.layers]
    if unknown:
        raise InputError(f"--layer: {drawing.path} has no layer {', '.join(unknown)}; it has {', '.join(drawing.layers)}.")
    return replace(
        drawing,
        loops=tuple(loop for loop in drawing.loops if loop.layer in names),
        open_chains=tuple(chain for chain in drawing.open_chains if chain.layer in names),
        points=tuple(point for point in drawing.points if point[0] in names),
        layers=tuple(name for name in drawing.layers if name in names),
        findings=tuple(finding for finding in drawing.findings if finding.layer in (None, *names)),
    )
