"""How are [[line_springs]] read, which act along the line between two points?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.errors import Faults
from watchsim.scene.file.keys.key_values import NAN, UNREADABLE, Table, listed
from watchsim.scene.file.keys.schema import LINE_SPRING, nearest
from watchsim.scene.file.readers.springs.read_leaf import leaf_stiffness
from watchsim.scene.force import LineSpring
from watchsim.units import LENGTH

EXAMPLE = 'points = [["1 mm", "0 mm"], ["5 mm", "2 mm"]]'


def read_line_springs(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[LineSpring, ...]:
    """Each between a point of a body and a point of another, or of the movement."""
    known = {body.name: body for body in bodies}
    tables = [
        Table(one, f"line_springs.{i}", LINE_SPRING, faults) for i, one in enumerate(listed(mapping, "line_springs", faults))
    ]
    found = [_line_spring(table, known) for table in tables]
    return tuple(one for one in found if one is not None)


def _line_spring(table: Table, known: Mapping[str, Body]) -> LineSpring | None:
    ends = _ends(table, known)
    points = _points(table)
    stiffness, viscous = _stiffness(table), table.quantity("viscous")
    if viscous < 0.0:
        table.fault("viscous", "negative damping would drive the bodies", with_value=True)
    if "length" in table and "tension" in table:
        table.fault("tension", "length and tension say the same thing: leave one out")
    if ends is None:
        return None
    start = math.dist(*(at_start(body, point) for body, point in zip(ends, points, strict=True)))
    length = table.quantity("length") if "length" in table else start - table.quantity("tension") / stiffness
    if length < 0.0:
        why = "without force it would be shorter than nothing" if "tension" in table else "a length is not negative"
        table.fault("tension" if "tension" in table else "length", why, with_value=True)
    if start == 0.0:
        table.fault("points", "lie on each other at the start: the spring would have no direction")
    first, second = ends
    assert first is not None
    return LineSpring((first.name, second.name if second else None), points, stiffness, length, viscous)


def _stiffness(table: Table) -> float:
    if "leaf" in table:
        if "stiffness" in table:
            table.fault("leaf", "stiffness and leaf say the same thing: leave one out")
        return leaf_stiffness(table, "slide")
    if "stiffness" not in table and table.is_table:
        table.fault("", 'missing: stiffness = "20 N/m", or leaf = { … }')
    return table.positive("stiffness", "a spring pulls back")


def at_start(body: Body | None, point: Point) -> Point:
    """Where a point of a body, or of the movement, lies when a run begins."""
    if body is None:
        return point
    c, s = math.cos(body.angle), math.sin(body.angle)
    (x0, y0), (x, y) = body.position, point
    return x0 + c * x - s * y, y0 + s * x + c * y


def _ends(table: Table, known: Mapping[str, Body]) -> tuple[Body | None, Body | None] | None:
    """The two bodies, the second None for the movement; None altogether after a fault."""
    example = 'between = ["lever", "wheel"], or ["lever"] for a spring from the movement'
    names = table.names("between", (1, 2), f"one or two bodies are needed: {example}")
    if not names:
        return None
    for i, name in enumerate(names):
        if name not in known:
            table.fault(f"between.{i}", f'there is no body "{name}". {nearest(name, known)}')
            return None
        if known[name].on is not None:
            table.fault(f"between.{i}", f"{name} is carried by {known[name].on}: line springs hold bodies of the movement only")
            return None
    first, second = known[names[0]], known[names[1]] if len(names) == 2 else None
    if all(body is None or body.motion == "fixed" or body.prescribed is not None for body in (first, second)):
        table.fault("between", "nothing that it holds can give way, so this spring does nothing", with_value=True)
    return first, second


def _points(table: Table) -> tuple[Point, Point]:
    value = table.mapping.get("points")
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        if table.is_table:
            table.fault("points" if "points" in table else "", f"a point of each is needed, from its pivot: {EXAMPLE}")
        return UNREADABLE, (NAN, NAN)
    first, second = (table.point(f"points.{i}", one, LENGTH) for i, one in enumerate(value))
    return first, second
