"""How are parts of a drawing turned and shifted before it is used?

[bodies.lever.adjust]
STONES = { turn = "0.1°", about = "PIVOT", shift = ["0 µm", "2 µm"] }      # all of a layer
STONES = [{ near = ["-0.7 mm", "-0.2 mm"], along = "5 µm", face = ["-0.8 mm", "-0.4 mm"] }]   # one outline of it

First everything is turned, then shifted; places and directions are those of the drawing as it is drawn. Lines and arcs are
moved exactly, and all that follows from outlines (contacts, mass, pictures, exports) follows from the moved ones.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from watchsim.drawing.chaining.crossings import crossings
from watchsim.drawing.chaining.outline_source import Outline
from watchsim.drawing.drawing import Drawing
from watchsim.geometry.extent import extents
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.geometry.solids.mass import section
from watchsim.scene.file.keys.key_values import NAN, Table, shown
from watchsim.scene.file.keys.schema import ADJUST, nearest
from watchsim.scene.file.outlines.parts_near import lines_near, part_near, parts_of
from watchsim.scene.file.outlines.pivot import marks_on

NOWHERE: Point = (0.0, 0.0)


def adjusted(table: Table, drawing: Drawing) -> Drawing:
    """The drawing with what `adjust` asks for; faults go to the table."""
    if "adjust" not in table:
        return drawing
    asked = table.mapping["adjust"]
    if not isinstance(asked, dict):
        table.fault("adjust", 'a table of layers is needed here, such as STONES = { turn = "0.1°" }', with_value=True)
        return drawing
    for layer, entries in asked.items():
        path = f"{table.path}.adjust.{layer}"
        if all(loop.layer != layer for loop in (*drawing.loops, *drawing.open_chains)):
            there = dict.fromkeys(loop.layer for loop in (*drawing.loops, *drawing.open_chains))
            table.faults.add(path, f"the drawing has no outlines on such a layer. {nearest(layer, there)}")
            continue
        many = isinstance(entries, list)
        before = drawing
        for i, entry in enumerate(entries if many else [entries]):
            one = Table(entry, f"{path}.{i}" if many else path, ADJUST, table.faults)
            drawing = _with_part_moved(one, table, before, drawing, layer)
        _note_crossings(table, path, drawing, layer)
    return drawing


def _with_part_moved(one: Table, body: Table, before: Drawing, drawing: Drawing, layer: str) -> Drawing:
    """`drawing` with one entry done; which part, about what and whither follows from the drawing as it was `before`."""
    loops = [*before.loops, *before.open_chains]
    numbers = _meant(one, loops, layer)
    if not numbers:
        return drawing
    meant = [loops[k] for k in numbers]
    turn, shift = one.quantity("turn"), one.pair("shift")
    about = _point(one, "about", before) if "about" in one else _centre(meant)
    along = _along(one, meant)
    if not all(map(math.isfinite, (turn, *shift, *about, *along))):
        return drawing
    common = _about(about, turn, (shift[0] + along[0], shift[1] + along[1]))
    now = [*drawing.loops, *drawing.open_chains]
    for part in parts_of(meant):
        away = _radial(one, body, before, _centre([meant[k] for k in part]))
        for k in part:
            now[numbers[k]] = now[numbers[k]].moved(turn, (common[0] + away[0], common[1] + away[1]))
    points = drawing.points
    if "near" not in one:
        points = tuple((name, *_moved((px, py), turn, common)) if name == layer else (name, px, py) for name, px, py in points)
    whole = len(drawing.loops)
    return replace(drawing, loops=tuple(now[:whole]), open_chains=tuple(now[whole:]), points=points)


def _about(about: Point, turn: float, shift: Point) -> Point:
    """The shift that goes with a turn about the origin instead."""
    x, y = _moved(about, turn, NOWHERE)
    return (about[0] - x + shift[0], about[1] - y + shift[1])


def _moved(point: Point, turn: float, shift: Point) -> Point:
    c, s = math.cos(turn), math.sin(turn)
    return (c * point[0] - s * point[1] + shift[0], s * point[0] + c * point[1] + shift[1])


def _meant(one: Table, loops: list[Loop], layer: str) -> tuple[int, ...]:
    """The numbers of the outlines that an entry is about; none after a fault."""
    known = len(one.faults.found)
    mine = [k for k, loop in enumerate(loops) if loop.layer == layer]
    if "near" not in one:
        return tuple(mine) if one.is_table and len(one.faults.found) == known else ()
    place = one.pair("near", (NAN, NAN))
    if not all(map(math.isfinite, place)):
        return ()
    found, clear = part_near([loops[k] for k in mine], place)
    if not clear:
        one.fault(
            "near", "two outlines of this layer are about equally near: give a place in the intended one", with_value=True
        )
        return ()
    return tuple(mine[k] for k in found)


def _centre(part: list[Loop]) -> Point:
    """The centroid of the area; of open lines the middle of their extent."""
    whole = section(part)
    if whole.area > 0.0:
        return whole.centroid
    box = extents(part) or (0.0, 0.0, 0.0, 0.0)
    return (0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3]))


def _point(one: Table, key: str, drawing: Drawing) -> Point:
    """A point of the drawing: its coordinates, or a layer with one point or circle."""
    value = one.mapping[key]
    if not isinstance(value, str):
        return one.pair(key)
    marks = marks_on(drawing, value)
    if len(marks) == 1:
        return marks[0]
    if marks:
        one.fault(key, f"{len(marks)} points or circles are on this layer: give coordinates", with_value=True)
    else:
        example = 'a layer with one point or circle, or ["0 mm", "0 mm"]'
        one.fault(key, f"neither a point nor a circle is on such a layer. Write {example}", with_value=True)
    return (NAN, NAN)


def _radial(one: Table, body: Table, drawing: Drawing, centre: Point) -> Point:
    """The shift of a part straight away from `about`, else from the body's pivot."""
    if "radial" not in one:
        return NOWHERE
    distance = one.quantity("radial")
    if "about" in one:
        x, y = _point(one, "about", drawing)
    elif "pivot" in body:
        value = body.mapping["pivot"]
        marks = marks_on(drawing, value) if isinstance(value, str) else []
        x, y = marks[0] if len(marks) == 1 else (body.pair("pivot") if not isinstance(value, str) else (NAN, NAN))
    else:
        x = y = NAN
    away = math.dist((x, y), centre)
    if math.isnan(away) or away == 0.0:
        one.fault("radial", 'away from where? Write about = ["0 mm", "0 mm"], a point that is not the middle of the part', True)
        return (NAN, NAN)
    return (distance * (centre[0] - x) / away, distance * (centre[1] - y) / away)


def _along(one: Table, part: list[Loop]) -> Point:
    """The shift along the straight edge nearest to `face`, towards that end of it to which `face` is nearer."""
    if "along" not in one and "face" not in one:
        return NOWHERE
    if "along" not in one or "face" not in one:
        here, missing = ("along", "face") if "along" in one else ("face", "along")
        one.fault(
            here, f'belongs together with {missing}: along = "2 µm", face = [x, y], a place at that end of a straight edge'
        )
        return (NAN, NAN)
    distance, place = one.quantity("along"), one.pair("face")
    if not all(map(math.isfinite, (distance, *place))):
        return (NAN, NAN)
    found = lines_near(part, place)
    if len(found) != 1:
        several = "two edges meet there, or are equally near: give a place on the intended one"
        one.fault("face", several if found else "the part has no straight edge", with_value=True)
        return (NAN, NAN)
    line, fraction = found[0]
    if fraction == 0.5:
        one.fault("face", "lies in the middle of the edge: which way? Give a place nearer to one end of it", with_value=True)
        return (NAN, NAN)
    x, y = line.tangent(0.0)
    way = distance if fraction > 0.5 else -distance
    return (way * x, way * y)


def _note_crossings(table: Table, path: str, drawing: Drawing, layer: str) -> None:
    """Outlines of one layer that lay apart may cross once they are moved."""
    outlines = [Outline(loop, ("an edge",) * len(loop.edges)) for loop in drawing.loops if loop.layer == layer]
    for finding in _errors(outlines):
        table.faults.add(
            path, f"moved so far, its outlines cross{finding}. Move it less", shown(table.mapping["adjust"][layer])
        )
        return


def _errors(outlines: list[Outline]) -> Iterator[str]:
    for finding in crossings(outlines) if outlines else ():
        if finding.severity == "error":
            yield "" if finding.x_mm is None else f" at ({finding.x_mm:.4g}, {finding.y_mm:.4g}) mm"
