"""watchsim export SCENE: bodies for other programs: outlines as DXF and SVG, solids as GLB and STL; the GLB of a run moves."""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.console import FINE, InputError, parse_names, parse_positive, parse_window, print_json, say

if TYPE_CHECKING:
    from watchsim.geometry.meshes import Track
    from watchsim.render.palette import Finish
    from watchsim.scene.layer_heights import Slab
    from watchsim.scene.scene import Body, Scene


HELP = "outlines as DXF and SVG, bodies as GLB and STL"
FORMATS = ("dxf", "svg", "glb", "stl")
MANIFEST = "export.json"
PIVOT = "PIVOT"
THINNEST = 1e-9  # m, of a plate: a mesh of it would have no sides


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", help="a scene file (TOML), the folder that holds scene.toml, or a results folder"
    )
    parser.add_argument("-o", "--output", metavar="DIR", help="folder for the files (default export/NAME)")
    parser.add_argument("--format", metavar="NAMES", default=",".join(FORMATS), help="default %(default)s")
    parser.add_argument("--bodies", metavar="NAMES", help="only these bodies, separated by commas, or all (the default)")
    parser.add_argument(
        "--thickness",
        metavar="LENGTH",
        default="0.2 mm",
        help='thickness of layers without one in the scene (default "%(default)s")',
    )
    parser.add_argument(
        "--deviation",
        metavar="LENGTH",
        default="0.2 µm",
        help='how far chords may lie from arcs in GLB and STL (default "%(default)s")',
    )
    parser.add_argument(
        "--window",
        metavar="FROM:TO",
        help="for a results folder: what scene.glb plays (default: the last beats, or the whole run)",
    )
    parser.add_argument(
        "--speed", metavar="X", help="speed at which it plays: 1 is real time (default 1/20; a whole run in 10 s)"
    )
    parser.add_argument("--json", action="store_true", help="print what was written as one JSON object")
    parser.add_argument("--force", action="store_true", help="replace an export that exists")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene, secured_folder
    from watchsim.storage.write import write_folder
    from watchsim.units import LENGTH

    formats = parse_names(args.format) or []
    if not formats or any(name not in FORMATS for name in formats):
        raise InputError(f"--format {args.format}: choose from {', '.join(FORMATS)}.")
    thickness = parse_positive("--thickness", args.thickness, LENGTH)
    deviation = parse_positive("--deviation", args.deviation, LENGTH)
    scene = load_scene(args.scene, overlap=False)
    bodies = _chosen(scene, parse_names(args.bodies))
    folder = Path(args.output) if args.output else Path("export") / _name(scene)
    if folder.suffix[1:].lower() in FORMATS:
        raise InputError(
            f"-o {folder}: a folder is needed, since each body has a file of its own. "
            f"--format {folder.suffix[1:]} writes these only."
        )
    secured_folder(folder, "exported files", default=not args.output)
    replaced = _check_folder(folder.absolute(), args.force)
    motion = _motion(args, formats)
    contents, manifest = _contents(scene, bodies, formats, thickness, deviation, motion)
    manifest["files"] = [*contents, MANIFEST]
    contents[MANIFEST] = (json.dumps(manifest, indent=1, ensure_ascii=False) + "\n").encode()

    def fill(place: Path) -> None:
        for name, content in contents.items():
            (place / name).write_bytes(content)

    write_folder(folder, fill, replaced.__contains__, "the export")
    _tell(manifest, folder, args.json)
    return FINE


def _motion(args: argparse.Namespace, formats: Sequence[str]) -> list[Track]:
    """How the bodies move, where a results folder was given; InputError where anything else has a window or speed."""
    from watchsim.commands.inputs import read_run
    from watchsim.commands.movie import parse_speed
    from watchsim.commands.pictures import filmed
    from watchsim.results.folder import TRAJECTORY

    is_run = (Path(args.scene) / TRAJECTORY).is_file()
    asked = [option for option in ("window", "speed") if getattr(args, option) is not None]
    if asked and not (is_run and "glb" in formats):
        raise InputError(f"--{asked[0]}: only a results folder has a motion, and only GLB files hold it.")
    if not is_run or "glb" not in formats:
        return []
    from watchsim.render.keyframes import keyframes

    run = read_run(args.scene)
    if len(run.t) < 2:
        say("No rows of this run were kept, so scene.glb stands still.")
        return []
    window, speed = filmed(run, 1.0 / 20.0)
    if args.window is not None:
        window = parse_window(args.window) or window
    return keyframes(run, window, speed if args.speed is None else parse_speed(args.speed))


def _chosen(scene: Scene, names: list[str] | None) -> tuple[Body, ...]:
    from watchsim.scene.keys import nearest

    known = [body.name for body in scene.bodies]
    if names == ["all"] and "all" not in known:
        names = None
    for name in names or ():
        if name not in known:
            raise InputError(f'--bodies: the scene has no body "{name}". {nearest(name, known)}')
    return tuple(body for body in scene.bodies if names is None or body.name in names)


def _name(scene: Scene) -> str:
    from watchsim.scene.load import SCENE_FILES

    if scene.path is None:
        return "scene"
    return scene.path.parent.resolve().name if scene.path.name in SCENE_FILES else scene.path.stem


def _check_folder(target: Path, force: bool) -> frozenset[str]:
    """The names that an earlier export wrote there; FileExistsError where the folder must not be changed."""
    if not target.exists():
        return frozenset()
    if not target.is_dir():
        raise FileExistsError(f"{target} is a file; an export needs a folder of its own")
    if next(target.iterdir(), None) is None:
        return frozenset()
    try:
        files = json.loads((target / MANIFEST).read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        raise FileExistsError(f"{target} exists and holds no export; it was not changed. Choose another folder") from None
    if not force:
        raise FileExistsError(f"{target} already exists and was not changed. Choose another folder, or replace it with --force")
    return frozenset(str(name) for name in files)


def _contents(
    scene: Scene,
    bodies: Sequence[Body],
    formats: Sequence[str],
    thickness: float,
    deviation: float,
    motion: Sequence[Track] = (),
) -> tuple[dict[str, bytes], dict[str, Any]]:
    """The files by name, and what the manifest says about them."""
    from watchsim.geometry.meshes import glb, stl
    from watchsim.render.palette import looks
    from watchsim.scene.layer_heights import slabs

    worn = looks(scene)
    found: dict[str, bytes] = {}
    stems = _stems([body.name for body in bodies])
    for body in scene.bodies:
        if body.name in stems and (body.loops or body.decoration):
            for name, text in _drawings(body, worn[body.name], formats):
                found[f"{stems[body.name]}.{name}"] = text.encode()
    stacked = tuple(slab for slab in slabs(scene, thickness) if slab.body in stems)
    thin = next((slab for slab in stacked if set(formats) & {"glb", "stl"} and 0.0 < slab.thickness < THINNEST), None)
    if thin:
        raise InputError(
            f"{thin.layer} of {thin.body} is {1e3 * thin.thickness:g} mm thick: a solid of less than "
            f"{1e9 * THINNEST:g} nm has no "
            "sides. Correct the thickness in its solids or --thickness, or leave solids out with --format dxf,svg."
        )
    if "glb" in formats:
        from watchsim.render.keyframes import bends, placed_solids, ribbons

        placed = placed_solids(scene, stacked, deviation)
        found.update((f"{stems[part.name]}.glb", glb([type(part)(part.name, part.pieces)])) for part in placed)
        if placed:
            drawn = ribbons(scene, placed)
            carried, bent = bends(scene, motion, drawn) if motion else ([], [])
            found["scene.glb"] = glb([*placed, *drawn], [*motion, *carried], bent)
    if "stl" in formats:
        from watchsim.render.keyframes import closed_solids

        found.update((f"{stems[part.name]}.stl", stl(part)) for part in closed_solids(scene, stacked, deviation))
    if not found:
        raise InputError("these bodies have no outlines: there is nothing to export.")
    return found, _manifest(scene, bodies, stacked, thickness)


def _drawings(body: Body, look: Finish, formats: Sequence[str]) -> Iterator[tuple[str, str]]:
    """The outlines of one body in its own frame, the pivot at the origin and marked."""
    from watchsim.drawing.write import dxf_text, svg_text
    from watchsim.render.palette import finish

    loops = (*body.loops, *body.decoration)
    layers = dict.fromkeys(loop.layer for loop in loops)
    colours = {layer: finish(body, layer, look).fill for layer in layers}
    mark = next(name for name in (PIVOT, *(f"{PIVOT}_{k}" for k in range(1, len(layers) + 2))) if name not in layers)
    points = ((mark, (0.0, 0.0)),)
    if "dxf" in formats:
        yield "dxf", dxf_text(loops, points, colours)
    if "svg" in formats:
        yield "svg", svg_text(loops, points, colours, body.name)


def _stems(names: Sequence[str]) -> dict[str, str]:
    """File names of bodies: letters, digits, - and _; "scene" is taken."""
    stems: dict[str, str] = {}
    taken = {"scene"}
    for name in names:
        plain = re.sub(r"[^\w-]", "_", name)
        stem, k = plain, 1
        while stem.casefold() in taken:
            k += 1
            stem = f"{plain}_{k}"
        taken.add(stem.casefold())
        stems[name] = stem
    return stems


def _manifest(scene: Scene, bodies: Sequence[Body], stacked: Sequence[Slab], thickness: float) -> dict[str, Any]:
    """What was written and what was assumed, for people and for `--force`."""
    entries: dict[str, list[dict[str, Any]]] = {body.name: [] for body in bodies}
    for slab in stacked:
        entry = {"layer": slab.layer, "kind": slab.solid.kind if slab.solid else "plate", "middle_mm": 1e3 * slab.middle}
        if slab.solid and slab.solid.bores:
            entry["bores"] = list(slab.solid.bores)
        if slab.thickness:
            entry |= {"thickness_mm": 1e3 * slab.thickness, "thickness_from": "scene" if slab.solid else "default"}
        entries[slab.body].append(entry)
    return {
        "scene": scene.title,
        "units": {"dxf": "mm", "svg": "mm", "stl": "mm", "glb": "m"},
        "default_thickness_mm": 1e3 * thickness,
        "solids": entries,
    }


def _tell(manifest: dict[str, Any], folder: Path, as_json: bool) -> None:
    assumed = [
        f"{name}.{entry['layer']}"
        for name, entries in manifest["solids"].items()
        for entry in entries
        if entry.get("thickness_from") == "default"
    ]
    bare = [name for name, entries in manifest["solids"].items() if not entries]
    if assumed:
        say(f"No thickness in the scene; {manifest['default_thickness_mm']:g} mm is assumed: {', '.join(assumed)}")
    if bare:
        say(f"No closed outline, so no solid: {', '.join(bare)}")
    if as_json:
        print_json(manifest)
        return
    for name in manifest["files"]:
        print(folder / name)
