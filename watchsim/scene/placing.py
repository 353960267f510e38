"""How are parts of a drawing turned and shifted before it is used?

[bodies.lever.adjust]
STONES = { turn = "0.1°", about = "PIVOT", shift = ["0 µm", "2 µm"] }      # all of a layer
STONES = [{ near = ["-0.7 mm", "-0.2 mm"], along = "5 µm", face = ["-0.8 mm", "-0.4 mm"] }]   # one outline of it

First everything is turned, then shifted, then grown; places and directions are those of the drawing as it is drawn. Lines and
arcs stay what they are, and all that follows from outlines (contacts, mass, pictures, exports) follows from the moved ones.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from watchsim.drawing.chain_faults import crossings
from watchsim.drawing.circles import circle_of
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.nodes import Outline, nearest_fraction
from watchsim.geometry.loops import Loop, extents, winding
from watchsim.geometry.primitives import Line, Point
from watchsim.geometry.solids import section
from watchsim.geometry.variation import Floats, TeethErrors, fold, grown, with_errors
from watchsim.scene.keys import ADJUST, TEETH, nearest
from watchsim.scene.values import NAN, UNREADABLE, Table, shown

# Which outlines of a layer does a place near them choose, and which edge?

SAME = 1e-8  # m; edges as near as this to each other cannot be distinguished by a place
CLEARER = 2.0  # times: so much farther off than the nearest must the next one be


def part_near(loops: Sequence[Loop], place: Point) -> tuple[tuple[int, ...], bool]:
    """The numbers of the outline nearest to the place (of one that holds it, if any does) and of the holes in it, and whether
    it is clearly the intended one."""
    order = sorted(parts_of(loops), key=lambda part: _away(loops[part[0]], place))
    if not order:
        return (), False
    clear = len(order) == 1 or _away(loops[order[1][0]], place) > CLEARER * _away(loops[order[0][0]], place)
    return order[0], clear


def parts_of(loops: Sequence[Loop]) -> list[tuple[int, ...]]:
    """The numbers of each outer outline or open chain with those of the holes in it."""
    outer = [k for k, loop in enumerate(loops) if not loop.hole]
    owners = {k: _owner(loops, outer, loop) for k, loop in enumerate(loops) if loop.hole}
    alone = [(k,) for k, owner in owners.items() if owner is None]
    return [(k, *(hole for hole, owner in owners.items() if owner == k)) for k in outer] + alone


def _away(loop: Loop, place: Point) -> float:
    """Distance of the place from the outline, 0 inside of it."""
    if loop.closed and winding(loop, place):
        return 0.0
    return min(math.dist(edge.point(nearest_fraction(edge, place)), place) for edge in loop.edges)


def _owner(loops: Sequence[Loop], outer: Sequence[int], hole: Loop) -> int | None:
    """The smallest outline around a hole."""
    around = [k for k in outer if loops[k].closed and winding(loops[k], hole.edges[0].point(0.5))]
    return min(around, key=lambda k: loops[k].length, default=None)


def lines_near(loops: Sequence[Loop], place: Point) -> list[tuple[Line, float]]:
    """The straight edges nearest to the place, several where they meet there, and which fraction of each lies nearest."""
    lines = [(edge, nearest_fraction(edge, place)) for loop in loops for edge in loop.edges if isinstance(edge, Line)]
    away = [math.dist(line.point(fraction), place) for line, fraction in lines]
    return [one for one, distance in zip(lines, away, strict=True) if distance <= min(away) + SAME]


# Where in its drawing is a body's pivot?
#
# A layer with one point or circle on it, a circle or point of the drawing named by where it is about, or coordinates.

SAME_POINT = 1e-9  # m; two circles on the pivot layer this close mark one pivot
KINDS = ("hole", "circle", "point")
EXAMPLE = 'pivot = "hole near [1.2 mm, -0.5 mm]"'
_NEAR = re.compile(r"\s*(\w+)\s+near\s*(.*)", re.DOTALL)
_BARE = re.compile(r"[-+]?[\d.]+(e[-+]?\d+)?", re.IGNORECASE)
_PAIR = re.compile(r"\[([^,\]]*),([^,\]]*)\]\s*")


def given_pivot(table: Table) -> Point | None:
    """The pivot by its coordinates; None where nobody said."""
    if isinstance(table.mapping.get("pivot"), str):
        table.fault("pivot", 'without a drawing there is no layer to look for; write pivot = ["0 mm", "0 mm"]', with_value=True)
        return UNREADABLE
    return table.pair("pivot") if "pivot" in table else None


def marked_pivot(table: Table, drawing: Drawing) -> Point:
    """The pivot that a text names: a layer, or what is near a place."""
    text = table.text("pivot")
    match = _NEAR.fullmatch(text)
    if match and text not in _layers(drawing):
        return _near(table, drawing, match[1], match[2])
    return _on_layer(table, drawing, text)


def _near(table: Table, drawing: Drawing, kind: str, place: str) -> Point:
    pair = _PAIR.fullmatch(place)
    if kind not in KINDS or pair is None:
        table.fault("pivot", f"write hole, circle or point near a place of the drawing, such as {EXAMPLE}", with_value=True)
        return UNREADABLE
    bare = [part.strip() for part in pair.groups()]
    if any(_BARE.fullmatch(part) for part in bare):
        meant = ", ".join(f"{part} mm" if _BARE.fullmatch(part) else part for part in bare)
        message = f'a bare number needs a unit here; write pivot = "{kind} near [{meant}]", or with another unit'
        table.fault("pivot", message, with_value=True)
        return UNREADABLE
    x, y = (table.parsed("pivot", part.strip().strip("\"'"), table.dimension("pivot")) for part in pair.groups())
    if math.isnan(x) or math.isnan(y):
        return UNREADABLE
    found = sorted(_distinct(_of_kind(drawing, kind)), key=lambda point: math.dist(point, (x, y)))
    if not found:
        table.fault("pivot", f"the drawing holds no {kind}", with_value=True)
        return UNREADABLE
    if len(found) > 1 and math.dist(found[1], (x, y)) < CLEARER * math.dist(found[0], (x, y)):
        message = f"{_shown(found[:2])} mm are about equally near: give the place more exactly"
        table.fault("pivot", message, with_value=True)
        return UNREADABLE
    return found[0]


def _of_kind(drawing: Drawing, kind: str) -> Iterator[Point]:
    if kind == "point":
        yield from ((x, y) for _, x, y in drawing.points)
    for loop in drawing.loops if kind != "point" else ():
        circle = circle_of(loop)
        if circle is not None and (loop.hole or kind == "circle" or not _has_holes(drawing)):
            yield circle.centre


def _has_holes(drawing: Drawing) -> bool:
    """Are any circles of the drawing holes on their own layer? Else a bore on a layer of its own is meant by the word."""
    return any(loop.hole and circle_of(loop) is not None for loop in drawing.loops)


def marks_on(drawing: Drawing, layer: str) -> list[Point]:
    """The points and centres of circles on a layer, each once; else of polygons that stand for circles."""
    return _distinct(_marks(drawing, layer, False)) or _distinct(_marks(drawing, layer, True))


def _on_layer(table: Table, drawing: Drawing, layer: str) -> Point:
    """The one point or circle centre on that layer."""
    marks = marks_on(drawing, layer)
    if len(marks) == 1:
        return marks[0]
    if marks:
        cure = f"leave one, or say which, such as {EXAMPLE}"
        message = f"{len(marks)} points or circles are on this layer, at {_shown(marks[:4])} mm: {cure}"
        table.fault("pivot", message, with_value=True)
    elif layer not in _layers(drawing):
        hint = nearest(layer, _layers(drawing))
        there = f"{drawing.path.name} has {', '.join(drawing.layers) or 'no layers with lines'}."
        table.fault("pivot", f"the drawing has no such layer. {f'{hint} ' if hint.startswith('Did') else ''}{there}", True)
    else:
        table.fault("pivot", "neither a point nor a circle is on this layer", with_value=True)
    return (NAN, NAN)


def _layers(drawing: Drawing) -> tuple[str, ...]:
    return tuple(dict.fromkeys([*drawing.layers, *(point[0] for point in drawing.points)]))


def _marks(drawing: Drawing, layer: str, polygons: bool) -> Iterator[Point]:
    yield from ((x, y) for name, x, y in drawing.points if name == layer)
    for loop in drawing.loops:
        circle = circle_of(loop) if loop.layer == layer else None
        if circle is not None and (polygons or not circle.sides):
            yield circle.centre


def _distinct(points: Iterator[Point]) -> list[Point]:
    found: list[Point] = []
    for point in points:
        if all(math.dist(point, other) > SAME_POINT for other in found):
            found.append(point)
    return found


def _shown(points: list[Point]) -> str:
    return ", ".join(f"({x * 1e3:.3f}, {y * 1e3:.3f})" for x, y in points)


# How are parts of a drawing turned and shifted before it is used?

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
    if (offset := one.quantity("offset")) and math.isfinite(offset):
        try:
            for k in numbers:
                now[k] = grown(now[k], offset)
        except ValueError as error:
            one.fault("offset", str(error), with_value=True)
    points = drawing.points
    if "near" not in one:
        points = tuple((name, *_moved((px, py), turn, common)) if name == layer else (name, px, py) for name, px, py in points)
    whole = len(drawing.loops)
    return replace(drawing, loops=tuple(now[:whole]), open_chains=tuple(now[whole:]), points=points)


def with_teeth(table: Table, drawing: Drawing) -> Drawing:
    """The drawing with what `teeth` says is wrong with the teeth; faults go to the table."""
    if not isinstance(table.mapping.get("teeth"), dict):
        if "teeth" in table:
            table.fault("teeth", 'a table is needed here, such as teeth = { height = "2 µm" }', with_value=True)
        return drawing
    one = Table(table.mapping["teeth"], f"{table.path}.teeth", TEETH, table.faults)
    marked = isinstance(table.mapping.get("pivot"), str)
    centre = marked_pivot(table, drawing) if marked else table.pair("pivot")
    layers = table.mapping.get("layers", [loop.layer for loop in drawing.loops])
    folds = [fold(loop, centre) if loop.layer in layers and math.isfinite(sum(centre)) else 1 for loop in drawing.loops]
    teeth = max(folds, default=1)
    if teeth < 2:
        one.fault("", "there are no equal teeth about the pivot")
        return drawing
    pitch, height, width = (_each(one, key, teeth) for key in ("pitch", "height", "width"))
    errors = TeethErrors(pitch, height, width, one.quantity("wobble"), one.quantity("towards"))
    if not all(np.isfinite(value).all() for value in (errors.pitch, errors.height, errors.width, errors.wobble)):
        return drawing
    which = folds.index(teeth)
    loops = list(drawing.loops)
    loops[which] = with_errors(loops[which], centre, teeth, errors)
    return replace(drawing, loops=tuple(loops))


def _each(one: Table, key: str, teeth: int) -> Floats:
    """The values of all teeth, m; one value stands for all."""
    value = one.mapping.get(key, "0 m")
    listed = value if isinstance(value, (list, tuple)) else [value] * teeth
    if len(listed) != teeth:
        one.fault(key, f"there are {teeth} teeth: give one value, or a list of {teeth}", with_value=True)
        return np.zeros(teeth)
    return np.array([one.parsed(f"{key}.{i}", item, one.dimension(key)) for i, item in enumerate(listed)])


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
    wrong = [finding for finding in crossings(outlines) if finding.severity == "error"] if outlines else []
    if wrong:
        x, y = wrong[0].x_mm, wrong[0].y_mm
        at = "" if x is None else f" at ({x:.4g}, {y:.4g}) mm"
        table.faults.add(path, f"moved so far, its outlines cross{at}. Move it less", shown(table.mapping["adjust"][layer]))
