"""Which outlines does a body have, and where is its pivot in the drawing?"""

from __future__ import annotations

import math
import re
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.construction.design import drawing_of
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.drawing.nodes import Track
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import AT_ONCE, Floats, Ints, Loop, near_pairs, table_of
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.keys import SHAPES, closest, nearest
from watchsim.scene.placing import adjusted, given_pivot, marked_pivot, with_teeth
from watchsim.scene.values import UNREADABLE, Table, shown

# Where do drawings come from that need no file: those that a design makes, and those of a scene that was read before?

Made = Mapping[str, Sheet | bytes]  # name of a drawing in the scene -> the sheet, or what the file held


# Which outline does a shape written into the scene have: a circle, a polygon, a line?

ROUNDING = 1e-12  # of the coordinates


def shape_loops(table: Table, key: str) -> tuple[Loop, ...]:
    """The outline under "circle", "polygon" or "line" of a body; its layer is named after the shape. Empty after a fault."""
    known = len(table.faults.found)
    readers = {"circle": _circle, "polygon": _polygon, "line": _line}
    loop = readers[key](table)
    return (loop,) if loop and len(table.faults.found) == known else ()


def _circle(table: Table) -> Loop:
    radius = table.quantity("circle", math.nan)
    return Loop((Arc(0.0, 0.0, radius, 0.0, TURN),), "circle")


def _line(table: Table) -> Loop | None:
    points = _points(table, "line", at_least=2)
    if len(points) > 2:
        table.fault("line", "a line has two points; more make a polygon")
    if len(points) != 2:
        return None
    if points[0] == points[1]:
        table.fault("line", "its two points are the same")
        return None
    return Loop((Line(*points[0], *points[1]),), "line", closed=False)


def _polygon(table: Table) -> Loop | None:
    """Counter-clockwise whichever way it was written: the material is inside."""
    points = _points(table, "polygon", at_least=3)
    if points and not any(math.isnan(c) for point in points for c in point):
        if len(set(points)) < len(points):
            table.fault(
                "polygon", "a point occurs twice in it; the outline closes by itself, without repeating the first point"
            )
        elif signed_area(points) == 0.0:
            table.fault("polygon", "it encloses no area")
        elif crossing := first_crossing(points):
            table.fault("polygon", f"its sides {crossing[0]} and {crossing[1]} (counted from 0) cross each other")
        points = points if signed_area(points) > 0.0 else points[::-1]
    edges = tuple(Line(*start, *end) for start, end in zip(points, (*points[1:], *points[:1]), strict=True))
    return Loop(edges, "polygon") if edges else None


def _points(table: Table, key: str, at_least: int) -> tuple[Point, ...]:
    value, dimension = table.mapping[key], table.dimension(key)
    if not isinstance(value, (list, tuple)) or len(value) < at_least:
        example = '["0 mm", "0 mm"], ["5 mm", "0 mm"]' + (', ["0 mm", "5 mm"]' if at_least > 2 else "")
        table.faults.add(
            f"{table.path}.{key}", f"a list of at least {at_least} points is needed here: {key} = [{example}]", shown(value)
        )
        return ()
    return tuple(table.point(f"{key}.{i}", item, dimension) for i, item in enumerate(value))


def signed_area(points: Sequence[Point]) -> float:
    """Area of the polygon in m², positive when it runs counter-clockwise."""
    x0, y0 = points[0]
    local = [(x - x0, y - y0) for x, y in points]
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(local))


def first_crossing(points: Sequence[Point]) -> tuple[int, int] | None:
    """The first two sides, in their order, that are no neighbours and meet."""
    corners, count = np.array(points), len(points)
    sides = [Line(*a, *b) for a, b in zip(points, (*points[1:], points[0]), strict=True)]
    near = near_pairs(table_of(sides), ROUNDING * float(np.abs(corners).max()))
    found = None
    for k in range(0, len(near.first), AT_ONCE):
        found = found or _meeting(corners, near.first[k : k + AT_ONCE], near.second[k : k + AT_ONCE])
    # Where sides crowd not every pair is given: then all pairs before the one that was found, most often very few.
    for i in range(min(found[0] + 1 if found else count, count - 2) if near.crowds else 0):
        others = np.arange(i + 2, count)
        if earlier := _meeting(corners, np.full(len(others), i), others):
            return earlier
    return found


def _meeting(corners: Floats, first: Ints, second: Ints) -> tuple[int, int] | None:
    """The first of these pairs of sides (first < second) that meet and are no neighbours."""
    a, b, c, d = (corners[k % len(corners)].T for k in (first, first + 1, second, second + 1))
    crossing = (_turn(a, b, c) * _turn(a, b, d) <= 0) & (_turn(c, d, a) * _turn(c, d, b) <= 0)
    beside = np.all((np.maximum(a, b) >= np.minimum(c, d)) & (np.maximum(c, d) >= np.minimum(a, b)), axis=0)
    apart = (second - first > 1) & (second - first < len(corners) - 1)
    places = np.flatnonzero(crossing & beside & apart)
    return (int(first[places[0]]), int(second[places[0]])) if len(places) else None


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Sign of the turn from a-b to a-c, of points (2, n)."""
    turned: Floats = np.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    return turned


# On which side of an open chain is the material?
#
# An open chain has no inside, so it can only be touched where the scene says what is behind it: `material` of a body, for all
# its open chains or layer by layer. A point in the material says it however the chain was drawn.

SIDES = ("left", "right")
ADVICE = 'material = "left" (or "right", seen along the drawn direction; or a point behind it, ["0 mm", "-1 mm"])'
UNREADABLE_SIDE = ""

Side = str | Point


def face_layers(table: Table, drawing: Drawing, asked: tuple[str, ...]) -> dict[str, Side]:
    """Layers whose open chains can be touched, with the side of their material; faults go to the table.

    One value speaks for all `asked` layers that have open chains, or where none are asked for all layers.
    """
    if "material" not in table:
        return {}
    value = table.mapping["material"]
    there = tuple(dict.fromkeys(chain.layer for chain in drawing.open_chains))
    if not isinstance(value, Mapping):
        side = _side(table, "material", value)
        chosen = [layer for layer in there if layer in asked or "layers" not in table]
        if not chosen:
            table.fault("material", "there is no open chain it could apply to: closed outlines have their material inside")
        return dict.fromkeys(chosen, side)
    result = {}
    sure = table.mapping.get("layers") == [*asked] and set(asked) <= set(drawing.layers)  # else that is the fault
    for layer, entry in value.items():
        meant = layer if layer in there else closest(layer, [one for one in there if one not in value])
        result[meant or layer] = _side(table, f"material.{layer}", entry)
        if layer not in there:
            hint = nearest(layer, there) if there else "There are none in this drawing."
            table.fault(f"material.{layer}", f"there is no open chain on this layer. {hint}")
        elif sure and layer not in asked:
            table.fault(f"material.{layer}", f'this layer cannot touch: add "{layer}" to layers')
    return result


def _side(table: Table, key: str, value: object) -> Side:
    if isinstance(value, str):
        if value not in SIDES:
            what = f"a side is left or right, or a point of the drawing in the material. Write e.g. {ADVICE}"
            table.faults.add(f"{table.path}.{key}", what, shown(value))
            return UNREADABLE_SIDE
        return value
    return table.point(key, value, table.dimension("material"))


def faces(table: Table, drawing: Drawing, sides: Mapping[str, Side]) -> Iterator[Loop]:
    """The open chains of those layers with the material on their left."""
    for chain in drawing.open_chains:
        side = sides.get(chain.layer, UNREADABLE_SIDE)
        if side == UNREADABLE_SIDE:
            continue
        yield chain if _on_left(table, chain, side) else chain.reversed()


def _on_left(table: Table, chain: Loop, side: Side) -> bool:
    if isinstance(side, str):
        return side == "left"
    if any(math.isnan(c) for c in side):
        return True
    track = Track(chain)
    distance, hand = track.side(side, 0.0, track.length)
    if distance <= 1e-9 * track.length:
        message = f"the point lies on the chain of layer {chain.layer} itself: give one well inside the material"
        table.fault("material", message, with_value=True)
    return hand > 0.0


# Which layers do the solids of a body name, and what for?
#
# Asked before the solids are read, because what is drawn there is no outline that could touch: the table may hold anything.


def set_apart(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that solids name for sections, axes and hairsprings."""
    for solid in _entries(mapping):
        if "turned" in solid or solid.get("hairspring") is True:
            yield from (name for name in (solid.get("layer"), solid.get("turned")) if isinstance(name, str))


def weighed(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that decide the mass: those of solids and of their bores."""
    for solid in _entries(mapping):
        yield from (name for name in (solid.get("layer"), *_texts(solid.get("bores"))) if isinstance(name, str))


def bored(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that plates name as their bores."""
    for solid in _entries(mapping):
        yield from _texts(solid.get("bores"))


def hollow(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers of bores that nothing fills: no solid is made of them, and `layers` does not ask for them."""
    made_of = {solid.get("layer") for solid in _entries(mapping) if isinstance(solid.get("layer"), str)}
    filled = made_of.union(_texts(mapping.get("layers")))
    yield from (name for name in bored(mapping) if name not in filled)


def _entries(mapping: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    solids = mapping.get("solids")
    yield from (solid for solid in (solids if isinstance(solids, (list, tuple)) else ()) if isinstance(solid, Mapping))


def _texts(value: object) -> list[str]:
    return [item for item in value if isinstance(item, str)] if isinstance(value, (list, tuple)) else []


# Which outlines does a body have, and where is its pivot in the drawing?

_SETTING = re.compile(r'(\b[Ss]et \w+ = "[^"]*"(?: \(or "[^"]*"\))?)')  # the reader does not know whose drawing it reads
OPEN = ("open-outline", "stray-line")  # findings about open chains


@dataclass(frozen=True)
class Outlines:
    """What a drawing or a shape gives a body, in the coordinates of the drawing (metres).

    `loops` can touch, `rest` are closed outlines on layers left out, `aside` those that solids use as sections and
    hairsprings, `bores` those that solids take out and nothing fills, `chains` the open lines. `pivot` is None when nobody said
    where it is. `errors` are what is wrong on layers left out. `drawn` is what the scene asks to draw besides, None where it
    does not say. `data` is the drawing file, or a design's sheet that it is made of; None without one.
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
    data: bytes | Sheet | None = None
    drawn: tuple[Loop, ...] | None = None

    @property
    def all(self) -> tuple[Loop, ...]:
        return self.loops + self.rest + self.aside + self.bores


def read_outlines(table: Table, folder: Path, made: Made) -> Outlines:
    """Outlines of one body from its `drawing` (in `made`, else relative to `folder`) or its shape; faults go to the table."""
    sources = [key for key in ("drawing", *SHAPES) if key in table]
    for extra in sources[1:]:
        table.fault(extra, f"a body has one outline: leave out {extra} or {sources[0]}")
    for key in ("layers", "draw", "units", "section", "snap", "material", "adjust", "teeth"):
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
    drawing = adjusted(table, with_teeth(table, drawing))
    before = len(table.faults.found)
    pivot = marked_pivot(table, drawing) if marked else given_pivot(table)
    known += len(table.faults.found) - before  # a wrong pivot leaves outlines sound: what names their layers is judged, too
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
        data=made.get(table.text("drawing"), drawing.data),
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
    path, known = folder / name, made.get(name)
    if path.is_dir() and known is None:
        there = ", ".join((Path(name) / file).as_posix() for file in _drawings(path)) or "a DXF or SVG file"
        what = "this is a folder; the" if name else "the"
        table.fault("drawing", f"{what} name of a drawing is needed here: {there}", with_value=True)
        return None
    snap = table.quantity("snap")
    stated = table.text("units")
    units = stated if isinstance(table.mapping.get("units"), str) else None
    section = table.quantity("section") if "section" in table else None
    if isinstance(known, Sheet) and not math.isnan(snap):
        return drawing_of(known, name, snap)
    missing = known is None and not path.is_file()
    if missing or math.isnan(snap):
        if missing:
            table.fault("drawing", f"there is no such file{_similar(path)} (looked for {path})", with_value=True)
        return None
    try:
        if isinstance(known, bytes):
            return cached_drawing(path, units, snap, section, None, known)
        stamp = path.stat()
        return cached_drawing(path, units, snap, section, (stamp.st_mtime_ns, stamp.st_size))
    except ValueError as error:
        table.fault("units" if "units" in table else "drawing", str(error), with_value=True)
    except OSError as error:
        table.faults.add(f"{table.path}.drawing", f"cannot be read: {error.strerror or error}", _arrow(path))
    return None


KEPT = 64  # drawings
_kept: OrderedDict[tuple[object, ...], tuple[tuple[int, int] | None, Drawing]] = OrderedDict()


def cached_drawing(
    path: Path, units: str | None, snap: float, section: float | None, stamp: tuple[int, int] | None, data: bytes | None = None
) -> Drawing:
    """Read once per version of the file: a parameter study loads the same scene thousands of times.

    `stamp` tells the version on the disk. `data`, where given, is what it held when the scene was read: it may have changed
    since, or be on another machine.
    """
    from watchsim.drawing.read import read, read_data

    key = (path, units, snap, section)
    last, found = _kept.pop(key, (None, None))
    if found is None or (last != stamp if data is None else found.data != data):
        last = stamp
        if data is None:
            found = read(path, units=units, snap=snap, section=section)
        else:
            found = read_data(data, path, units, snap, section=section)
    _kept[key] = last, found
    while len(_kept) > KEPT:
        _kept.popitem(last=False)
    return found


def forget_drawings() -> None:
    """Drop all that is known, for measurements and tests."""
    _kept.clear()


def _similar(path: Path) -> str:
    """' Did you mean ...?' with the drawings that lie in the folder."""
    if not path.parent.is_dir():
        return f", nor the folder {path.parent}"
    there = _drawings(path.parent)
    return f". {nearest(path.name, there)}".removesuffix(".") if there else ""


def _drawings(folder: Path) -> list[str]:
    from watchsim.drawing.read import ENDINGS

    return sorted(file.name for file in folder.iterdir() if file.suffix.lower().lstrip(".") in ENDINGS)


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
