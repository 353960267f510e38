"""watchsim new DESIGN or DRAWING: a scene of a mechanism, drawn to your dimensions or guessed from drawings."""

from __future__ import annotations

import argparse
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import FINE, InputError, print_json, say

if TYPE_CHECKING:
    from watchsim.construction.design import Design, Dimension


HELP = "starts a scene: a mechanism drawn to your dimensions, or what drawings suggest, with guesses marked"
WIDTH = 110
DRAWINGS_USAGE = "watchsim new DRAWING [DRAWING ...] [-o DIR] [--json] [--force]"


def options(parser: argparse.ArgumentParser) -> None:
    design_usage = "watchsim new DESIGN [--DIMENSION VALUE ...] [-o DIR] [--drawings] [--list] [--json] [--force]"
    parser.usage = f"{design_usage}\n       {DRAWINGS_USAGE}"
    parser.epilog = (
        'For example: watchsim new swiss_lever --lock "2°" --draw "13.5°" --teeth 20 -o my_lever. '
        "watchsim new --list lists the designs, watchsim new DESIGN --list their dimensions. "
        "watchsim new movement.dxf -o my_watch writes a scene that drawings suggest; each guess says so, and why."
    )
    _common(parser)
    naming = "the name of a design, such as swiss_lever, or drawings (DXF, SVG, STL, ...)"
    parser.add_argument("design", metavar="DESIGN", nargs="?", help=naming)
    parser.add_argument("rest", nargs=argparse.REMAINDER, help=argparse.SUPPRESS)


def _common(parser: argparse.ArgumentParser) -> None:
    unset: Any = argparse.SUPPRESS
    parser.add_argument(
        "-o", "--output", metavar="DIR", default=unset, help="folder for the files (default: the name of the design or drawing)"
    )
    parser.add_argument("--list", action="store_true", default=unset, help="list designs, or the dimensions of a design")
    parser.add_argument("--json", action="store_true", default=unset, help="print one JSON object instead of text")
    parser.add_argument(
        "--force",
        action="store_true",
        default=unset,
        help="change the scene in an existing folder; what is not given stays as it is",
    )
    written_out = (
        "write drawings (DXF) and the whole scene, to be edited by hand, in place of a scene that holds the dimensions"
    )
    parser.add_argument("--drawings", action="store_true", default=unset, help=written_out)


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import is_drawing
    from watchsim.scene.designed import designed

    asked = {"output": None, "list": False, "json": False, "force": False, "drawings": False, **vars(args)}
    if asked["design"] is None:
        if not asked["list"]:
            raise InputError("watchsim new: name a design; watchsim new --list lists them.")
        _list_designs(asked["json"])
        return FINE
    if is_drawing(asked["design"]):
        _from_drawings(asked)
        return FINE
    design = designed(asked["design"])
    given = _dimensions(design, asked["rest"], asked)
    if asked["list"]:
        _list_dimensions(design, asked["json"])
    else:
        _write(design, given, asked)
    return FINE


def _from_drawings(asked: dict[str, Any]) -> None:
    """The first drawing, and those among the words behind it; the others are options."""
    from watchsim.commands.inputs import start_from_drawings

    parser = argparse.ArgumentParser(prog="watchsim new", usage=DRAWINGS_USAGE, allow_abbrev=False)
    _common(parser)
    parser.add_argument("drawings", nargs="*", metavar="DRAWING", help="further drawings")
    found, unknown = parser.parse_known_args(asked["rest"])
    if unknown:
        raise InputError(f"watchsim new {asked['design']}: {unknown[0]} does not apply to drawings; -o, --json and --force do.")
    given = {**asked, **vars(found)}
    if given["list"]:
        raise InputError(f"watchsim new {asked['design']}: --list lists designs and their dimensions; a drawing has none.")
    start_from_drawings([asked["design"], *given["drawings"]], given["output"], given["json"], given["force"])


def _dimensions(design: Design, rest: list[str], asked: dict[str, Any]) -> dict[str, object]:
    """The dimensions among the options behind the name of the design; the others go to `asked`."""
    parser = argparse.ArgumentParser(prog=f"watchsim new {design.name}", description=f"{design.title}.", allow_abbrev=False)
    _common(parser)
    for one in design.dimensions:
        words = f"{one.meaning} (default {one.shortly(one.default)})".replace("%", "%%")
        parser.add_argument(one.option, metavar="VALUE", dest=f"dimension {one.name}", default=argparse.SUPPRESS, help=words)
    found, unknown = parser.parse_known_args(rest)
    if unknown:
        raise InputError(f"watchsim new {design.name}: {_unknown(design, unknown[0])}")
    values = vars(found)
    asked.update({key: value for key, value in values.items() if not key.startswith("dimension ")})
    return {key.partition(" ")[2]: value for key, value in values.items() if key.startswith("dimension ")}


def _unknown(design: Design, word: str) -> str:
    from watchsim.scene.keys import nearest

    if not word.startswith("-"):
        first = design.dimensions[0]
        folder = "" if word[0].isdigit() else f" For a folder of that name write -o {word}."
        return f'"{word}" belongs to no option. Write --DIMENSION VALUE, such as {first.option} {first.default}.{folder}'
    hint = nearest(word.partition("=")[0], [one.option for one in design.dimensions])
    known = f"watchsim new {design.name} --list lists its dimensions."
    return f"{word} is not a dimension of this design. {hint if hint.startswith('Did') else known}"


def _list_designs(as_json: bool) -> None:
    from watchsim.construction import registry as known
    from watchsim.scene.designed import designed

    designs = [designed(name) for name in known.names()]
    if as_json:
        print_json({"designs": [{"name": d.name, "title": d.title, "dimensions": len(d.dimensions)} for d in designs]})
        return
    for one in designs:
        print(f"{one.name:16s} {one.title}, {len(one.dimensions)} dimensions")
    say("watchsim new DESIGN --list lists the dimensions of one.")


def _list_dimensions(design: Design, as_json: bool) -> None:
    if as_json:
        rows = [
            {name: getattr(one, name) for name in ("name", "meaning", "unit", "default", "low", "high", "source")}
            for one in design.dimensions
        ]
        print_json({"name": design.name, "title": design.title, "dimensions": rows})
        return
    print(f"{design.title}\n")
    columns = [(one.option, one.shortly(one.default), _range(one), one.meaning, one.source) for one in design.dimensions]
    wide = [max(len(row[i]) for row in columns) for i in range(3)]
    left = sum(wide) + 6
    for option, default, limits, meaning, source in columns:
        head = f"{option:<{wide[0]}}  {default:<{wide[1]}}  {limits:<{wide[2]}}  "
        lines = textwrap.wrap(f"{meaning}. [{source}]", max(WIDTH - left, 40))
        print(head + lines[0])
        for line in lines[1:]:
            print(" " * left + line)


def _range(one: Dimension) -> str:
    return f"{one.shortly(one.low)} to {one.shortly(one.high)}"


def _write(design: Design, given: dict[str, object], asked: dict[str, Any]) -> None:
    from watchsim.commands.inputs import unused_folder, write_start
    from watchsim.designs import SCENE, Drawn
    from watchsim.mechanism.overlap import overlap_faults
    from watchsim.scene.designed import chosen
    from watchsim.scene.errors import SceneError
    from watchsim.scene.load import changed, load
    from watchsim.scene.rewrite import rewritten

    folder = unused_folder(Path(asked["output"] or design.name), asked["force"])
    path, drawings = folder / SCENE, asked["drawings"]
    kept = _kept(design, path, given)
    drawn = Drawn(design, chosen(design, {**(kept or {}), **given}))
    if kept is None or drawings:
        scene, files = drawn.scene(), drawn.files(drawings)
    else:  # all else that the scene says stays as well
        before, values = load(path), {one.name: drawn.written(one) for one in design.dimensions if one.name in given}
        changes = {f"design.{name}": value for name, value in values.items()}
        scene, files = changed(before, changes), {SCENE: rewritten(before, changes).encode()}
    faults = overlap_faults(scene)
    if faults:
        raise SceneError(faults)
    names = write_start(folder, files, design.name)
    if asked["json"]:
        print_json({"folder": str(folder), "files": names, "dimensions": drawn.dimensions})
        return
    print(f"{folder}: {', '.join(names)}")
    same = [one for one in design.dimensions if kept and one.name in kept and getattr(drawn.values, one.name) != one.default]
    if same:
        say(f"Kept as it was in {path}: {', '.join(f'{one.name} = {drawn.dimensions[one.name]}' for one in same)}.")
    if kept is not None and drawings:
        say("Everything else in it was replaced by the design's own scene.")
    if not drawings:
        say(f"Its dimensions stand in {path}; --set design.NAME=VALUE tries another one.")
    say(f"watchsim run {folder} simulates it; watchsim check {folder} --png start.png shows it.")


def _kept(design: Design, path: Path, given: dict[str, object]) -> dict[str, object] | None:
    """The dimensions that a scene of the same design in that place holds and that are not given; None where there is none.

    InputError where the scene there does not hold its dimensions: they would silently become the defaults again.
    """
    from watchsim.scene.keys import DESIGN
    from watchsim.scene.load import read_mapping

    if not path.is_file():
        return None
    table = read_mapping(path).get(DESIGN)
    if not isinstance(table, dict):
        raise InputError(
            f"{path} has no [design]: its dimensions are not known, and those that you did not give would become the defaults. "
            "Choose another folder with -o, or remove this scene first."
        )
    if table.get("of") != design.name:
        other = f"{path} is a scene of another design, {table.get('of')}"
        raise InputError(f"{other}. Choose another folder with -o, or remove it first.")
    return {name: value for name, value in table.items() if name != "of" and name not in given}
