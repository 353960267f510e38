"""Where in its drawing is a body's pivot?

A layer with one point or circle on it, a circle or point of the drawing named by where it is about, or coordinates.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from watchsim.drawing.circles import circle_of
from watchsim.drawing.drawing import Drawing
from watchsim.geometry.primitives import Point
from watchsim.scene.file.keys.key_values import NAN, UNREADABLE, Table
from watchsim.scene.file.keys.schema import nearest

SAME_POINT = 1e-9  # m; two circles on the pivot layer this close mark one pivot
CLEARER = 2.0  # times: so much further off than the nearest must the next one be
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
    """The points and centres of circles on a layer, each once."""
    return _distinct(_marks(drawing, layer))


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


def _marks(drawing: Drawing, layer: str) -> Iterator[Point]:
    yield from ((x, y) for name, x, y in drawing.points if name == layer)
    for loop in drawing.loops:
        circle = circle_of(loop) if loop.layer == layer else None
        if circle is not None:
            yield circle.centre


def _distinct(points: Iterator[Point]) -> list[Point]:
    found: list[Point] = []
    for point in points:
        if all(math.dist(point, other) > SAME_POINT for other in found):
            found.append(point)
    return found


def _shown(points: list[Point]) -> str:
    return ", ".join(f"({x * 1e3:.3f}, {y * 1e3:.3f})" for x, y in points)
