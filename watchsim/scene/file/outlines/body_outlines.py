"""Which outlines does a body have, and where is its pivot in the drawing?"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from watchsim.construction.outline_check import drawing_of
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.read import SNAP
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.scene.file.keys.key_values import UNREADABLE, Table
from watchsim.scene.file.keys.schema import SHAPES, nearest
from watchsim.scene.file.outlines.adjust import adjusted
from watchsim.scene.file.outlines.made import Made
from watchsim.scene.file.outlines.material_side import ADVICE, Side, face_layers, faces
from watchsim.scene.file.outlines.pivot import given_pivot, marked_pivot
from watchsim.scene.file.outlines.solid_layers import hollow, set_apart, weighed
from watchsim.scene.file.outlines.written_shapes import shape_loops

_SETTING = re.compile(r'(\b[Ss]et \w+ = "[^"]*"(?: \(or "[^"]*"\))?)')  # the reader does not know whose drawing it reads
OPEN = ("open-outline", "stray-line")  # findings about open chains


@dataclass(frozen=True)
class Outlines:
    """What a drawing or a shape gives a body, in the coordinates of the drawing (metres).

    `loops` can touch, `rest` are closed outlines on layers left out, `aside` those that solids use as sections and
    hairsprings, `bores` those that solids take out and nothing fills, `chains` the open lines. `pivot` is None when nobody said
    where it is. `errors` are what is wrong on layers left out. `drawn` is what the scene asks to draw besides, None where it
    does not say. `data` is the drawing file, None without one.
    `sound` is False after a fault: questions about layers are then not worth asking.
    """

    loops: tuple[Loop, ...] = ()
    rest: tuple[Loop, ...] = ()
    pivot: Point | None = None
    findings: tuple[Finding, ...] = ()
    sound: bool = True
    aside: tuple[Loop, ...] = ()
    bores: tuple[Loop, ...] = ()
    chains: tuple[Loop, ...] = ()
    errors: tuple[Finding, ...] = ()
    data: bytes | None = None
    drawn: tuple[Loop, ...] | None = None

    @property
    def all(self) -> tuple[Loop, ...]:
        return self.loops + self.rest + self.aside + self.bores


def read_outlines(table: Table, folder: Path, made: Made) -> Outlines:
    """Outlines of one body from its `drawing` (in `made`, else relative to `folder`) or its shape; faults go to the table."""
    sources = [key for key in ("drawing", *SHAPES) if key in table]
    for extra in sources[1:]:
        table.fault(extra, f"a body has one outline: leave out {extra} or {sources[0]}")
    for key in ("layers", "draw", "units", "snap", "material", "adjust"):
        if key in table and sources and sources[0] != "drawing":
            table.fault(key, f"belongs to a drawing; this body is a {sources[0]}")
    if "drawing" in table:
        return _from_drawing(table, folder, made)
    known = len(table.faults.found)
    loops = shape_loops(table, sources[0]) if sources else ()
    return Outlines(loops, pivot=given_pivot(table), sound=len(table.faults.found) == known)


def _from_drawing(table: Table, folder: Path, made: Made) -> Outlines:
    drawing = _open(table, folder, made)
    known = len(table.faults.found)
    marked = isinstance(table.mapping.get("pivot"), str)
    if drawing is None:
        return Outlines(pivot=UNREADABLE if marked else given_pivot(table), sound=False)
    drawing = adjusted(table, drawing)
    pivot = marked_pivot(table, drawing) if marked else given_pivot(table)
    apart, drilled = frozenset(set_apart(table.mapping)), frozenset(hollow(table.mapping))
    sides = {layer: side for layer, side in face_layers(table, drawing, table.texts("layers")).items() if layer not in apart}
    layers = _layers(table, drawing, sides, apart | drilled)
    findings = tuple(_sorted_out(table, drawing, layers, sides, apart))
    closed = [loop for loop in drawing.loops if loop.closed]
    touchable = tuple(loop for loop in closed if loop.layer in layers)
    return Outlines(
        loops=touchable + tuple(faces(table, drawing, sides)),
        rest=tuple(loop for loop in closed if loop.layer not in (*layers, *apart, *drilled)),
        drawn=_drawn(table, drawing, layers),
        pivot=pivot,
        findings=findings,
        sound=len(table.faults.found) == known,
        aside=tuple(loop for loop in closed if loop.layer not in layers and loop.layer in apart),
        bores=tuple(loop for loop in closed if loop.layer in drilled - apart),
        chains=drawing.open_chains,
        errors=tuple(f for f in drawing.findings if f.severity == "error" and f.layer in apart and f.layer not in layers),
        data=drawing.data,
    )


def _drawn(table: Table, drawing: Drawing, layers: tuple[str, ...]) -> tuple[Loop, ...] | None:
    """What lies on the layers of `draw`; each that is not there, or can touch, is a fault."""
    if "draw" not in table:
        return None
    names = table.texts("draw", "ARMS")
    for i, layer in enumerate(names):
        key = f"{table.path}.draw.{i}"
        if layer not in drawing.layers:
            table.faults.add(key, f"the drawing has no such layer. {_there(layer, drawing)}", f' = "{layer}"')
        elif layer in layers:
            table.faults.add(key, "this layer can touch, and is drawn anyway: leave it out here", f' = "{layer}"')
        elif all(loop.layer != layer for loop in drawing.loops):
            table.faults.add(key, "there is no closed outline on this layer, and open lines have no inside to draw")
    return tuple(loop for loop in drawing.loops if loop.layer in names and loop.closed)


def _open(table: Table, folder: Path, made: Made) -> Drawing | None:
    name = table.text("drawing")
    if not name and table.mapping["drawing"] != "":  # no text: noted
        return None
    path = folder / name
    if path.is_dir() and name not in made:
        there = ", ".join((Path(name) / file).as_posix() for file in _drawings(path)) or "a DXF or SVG file"
        what = "this is a folder; the" if name else "the"
        table.fault("drawing", f"{what} name of a drawing is needed here: {there}", with_value=True)
        return None
    snap = table.positive("snap", "it is the gap that may be closed") if "snap" in table else SNAP
    told = table.text("units")
    units = told if isinstance(table.mapping.get("units"), str) else None
    if name in made and not math.isnan(snap):
        return drawing_of(made[name], name, snap)
    if not path.is_file() or math.isnan(snap):
        if not path.is_file():
            table.fault("drawing", f"there is no such file{_similar(path)} (looked for {path})", with_value=True)
        return None
    try:
        stamp = path.stat()
        return cached_drawing(path, units, snap, (stamp.st_mtime_ns, stamp.st_size))
    except ValueError as error:
        table.fault("units" if "units" in table else "drawing", str(error), with_value=True)
    except OSError as error:
        table.faults.add(f"{table.path}.drawing", f"cannot be read: {error.strerror or error}", _arrow(path))
    return None


@lru_cache(maxsize=64)
def cached_drawing(path: Path, units: str | None, snap: float, _stamp: tuple[int, int]) -> Drawing:
    """Read once per version of the file: a parameter study loads the same scene thousands of times."""
    from watchsim.drawing.read import read

    return read(path, units=units, snap=snap)


def _similar(path: Path) -> str:
    """' Did you mean ...?' with the drawings that lie in the folder."""
    if not path.parent.is_dir():
        return f", nor the folder {path.parent}"
    there = _drawings(path.parent)
    return f". {nearest(path.name, there)}".removesuffix(".") if there else ""


def _drawings(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir() if file.suffix.lower() in (".dxf", ".svg", ".svgz"))


def _layers(table: Table, drawing: Drawing, sides: Mapping[str, Side], apart: frozenset[str]) -> tuple[str, ...]:
    """The layers that can touch: with closed outlines, or with open chains whose material is known (`sides`).

    Every requested layer that is not there is a fault.
    """
    closed = dict.fromkeys(loop.layer for loop in drawing.loops if loop.closed)
    asked = table.texts("layers")
    if "layers" not in table:
        known = {**closed, **dict.fromkeys(sides)}
        asked = tuple(layer for layer in known if layer != table.mapping.get("pivot") and layer not in apart)
        if not asked and not any(finding.severity == "error" for finding in drawing.findings):
            hint = f" Its lines are open: say where their material is, {ADVICE}." if drawing.open_chains else ""
            table.faults.add(f"{table.path}.drawing", f"it holds no closed outline.{hint}", _arrow(drawing.path))
        return asked
    open_ones = {chain.layer for chain in drawing.open_chains}
    broken = {finding.layer for finding in drawing.findings if finding.severity == "error"}
    for i, layer in enumerate(asked):
        key = f"{table.path}.layers.{i}"
        if layer not in closed and layer not in drawing.layers:
            table.faults.add(key, f"the drawing has no such layer. {_there(layer, drawing)}", f' = "{layer}"')
        elif layer not in closed and layer not in broken and layer not in sides:
            hint = f" Its lines are open: close them, or write {ADVICE}." if layer in open_ones else ""
            table.faults.add(key, f"there is no closed outline on this layer.{hint}", _arrow(drawing.path, layer))
    return asked


def _there(layer: str, drawing: Drawing) -> str:
    return f"{_hint(layer, drawing.layers)}{drawing.path.name} has {', '.join(drawing.layers) or 'no layers with lines'}."


def _hint(word: str, known: Iterable[str]) -> str:
    hint = nearest(word, known)
    return f"{hint} " if hint.startswith("Did") else ""


def _sorted_out(
    table: Table, drawing: Drawing, layers: tuple[str, ...], sides: Mapping[str, Side], apart: frozenset[str]
) -> Iterator[Finding]:
    """Notes the drawing's errors that concern this body as faults and hands on its warnings.

    Where layers were chosen, the others may be as they like, but outlines that cross are reported; where none were, all must be
    sound but the pivot's. Open chains are as they should be where the scene says what is behind them. Sections, axes and
    hairsprings are judged by the solids that use them.
    """
    pivot = table.mapping.get("pivot")
    used = {*layers, *weighed(table.mapping)}
    for finding in drawing.findings:
        if finding.layer in apart and finding.layer not in layers:
            continue
        beside = finding.layer is not None and finding.layer not in used and ("layers" in table or finding.layer == pivot)
        if (beside and finding.code != "crossing") or (finding.layer in sides and finding.code in OPEN):
            continue
        crossing = (
            finding.code == "crossing" and finding.layer in used and (finding.severity == "error" or finding.layer in sides)
        )
        if crossing or (finding.severity == "error" and not beside):
            fix = _SETTING.sub(rf"\1 under [{table.path}]", finding.fix)
            fix += f" If it is to stay open: {ADVICE}." if finding.code in OPEN else ""
            text = f"{finding.message.rstrip('.')}. {fix}".strip()
            table.faults.add(f"{table.path}.drawing", text, _arrow(drawing.path, finding.layer))
        else:
            severity = "warning" if finding.severity == "error" else finding.severity
            yield replace(finding, severity=severity, message=f"{drawing.path.name}: {finding.message}")


def _arrow(path: Path, layer: str | None = None) -> str:
    return f" -> {path.name}" + (f", layer {layer}" if layer else "")
