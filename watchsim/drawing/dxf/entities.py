"""What does one DXF entity draw?

Each reader takes a record and gives shapes in world coordinates and drawing units. Group codes after the DXF reference
(Autodesk); missing or doubled coordinates raise DxfError instead of becoming zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from watchsim.drawing.curves.affine import Affine, Vector, cross, object_plane, shifted, turned_scaled, unit
from watchsim.drawing.curves.plane_shapes import Conic, Dot, Shape, Spline, Straight, bulge, circle
from watchsim.drawing.curves.spline_to_arcs import spline_from
from watchsim.drawing.dxf_records import DxfError, Record, as_number
from watchsim.geometry.primitives import TURN

UP: Vector = (0.0, 0.0, 1.0)
CLOSED, SPLINE_FIT, MESH, FRAME_POINT, SPACE_POLYLINE = 1, 4, 16 | 64, 16, 8


@dataclass(frozen=True, slots=True)
class Insert:
    """A reference to a block: its name and the maps of the copies (before the block's base point is taken off)."""

    block: str
    maps: tuple[Affine, ...]


def plane_of(record: Record) -> Affine:
    return object_plane(record.point(210, UP))


def line(record: Record) -> list[Shape]:
    return [Straight(record.point(10), record.point(11))]


def point(record: Record) -> list[Shape]:
    return [Dot(record.point(10))]


def full_circle(record: Record) -> list[Shape]:
    return [circle(record.point(10), radius_of(record)).mapped(plane_of(record))]


def arc(record: Record) -> list[Shape]:
    start, end = record.number(50), record.number(51)
    sweep = (end - start) % 360.0 or 360.0
    shape = circle(record.point(10), radius_of(record), math.radians(start), math.radians(sweep))
    return [shape.mapped(plane_of(record))]


def radius_of(record: Record) -> float:
    """Zero is let through: such circles are points left behind by editing, and are reported as pieces of no length."""
    return abs(record.number(40))


def ellipse(record: Record) -> list[Shape]:
    major = record.point(11)
    normal = unit(record.point(210, UP))
    ratio = record.number(40)
    a, b, c = cross(normal, major)
    if ratio == 0.0 or not any(major):
        raise DxfError("one of its axes has no length")
    start, end = record.number(41, 0.0), record.number(42, TURN)
    sweep = (end - start) % TURN
    if min(sweep, TURN - sweep) < 1e-9:
        sweep = TURN
    return [Conic(record.point(10), major, (ratio * a, ratio * b, ratio * c), start, sweep)]


def lightweight(record: Record) -> list[Shape]:
    """LWPOLYLINE: vertices in a row, each 10, 20 and perhaps a bulge 42."""
    elevation = record.number(38, 0.0)
    corners: list[list[float]] = []
    for code, value in record.pairs():
        if code == 10:
            corners.append([as_number(value, code)])
        elif code in (20, 42):
            if not corners or len(corners[-1]) != (1 if code == 20 else 2):
                raise DxfError(f"group {code} stands where it does not belong among its corners")
            corners[-1].append(as_number(value, code))
    if any(len(corner) < 2 for corner in corners):
        raise DxfError("a corner without its y coordinate (group 20)")
    if record.integer(90, len(corners)) != len(corners):
        raise DxfError(f"it announces {record.integer(90)} corners and holds {len(corners)}")
    vertices = [((c[0], c[1], elevation), c[2] if len(c) > 2 else 0.0) for c in corners]
    return traced(vertices, bool(record.integer(70) & CLOSED), plane_of(record))


def heavyweight(record: Record, vertices: Sequence[Record]) -> list[Shape]:
    """POLYLINE with the VERTEX records that follow it."""
    flags = record.integer(70)
    corners: list[tuple[Vector, float]] = []
    for vertex in vertices:
        if flags & SPLINE_FIT and vertex.integer(70) & FRAME_POINT:
            continue  # control points of a curve whose approximation follows
        corners.append((vertex.point(10), vertex.number(42, 0.0)))
    if flags & SPACE_POLYLINE:
        return traced([(corner, 0.0) for corner, _ in corners], bool(flags & CLOSED), Affine())
    elevation = record.number(30, 0.0)
    flat = [((x, y, elevation), amount) for (x, y, _), amount in corners]
    return traced(flat, bool(flags & CLOSED), plane_of(record))


def is_mesh(record: Record) -> bool:
    return record.kind == "POLYLINE" and bool(record.integer(70) & MESH)


def traced(corners: list[tuple[Vector, float]], closed: bool, plane: Affine) -> list[Shape]:
    """The segments from corner to corner; a corner's bulge belongs to the segment that leaves it. One corner alone gives a
    segment without length, so that it is not left out in silence."""
    if not corners:
        raise DxfError("it has no corners")
    following = [*corners[1:], corners[0]] if closed or len(corners) == 1 else corners[1:]
    pairs = zip(corners, following, strict=False)
    if closed and len(corners) == 2 and corners[0][1] == corners[1][1] == 0.0:
        pairs = zip(corners[:1], following[:1], strict=True)  # there and back along one line
    return [bulge(a, b, amount).mapped(plane) for (a, amount), (b, _) in pairs]


def spline(record: Record) -> list[Shape]:
    for code, what in ((72, "knots"), (73, "control points"), (74, "fit points")):
        found = record.codes.count({72: 40, 73: 10, 74: 11}[code])
        if record.integer(code, found) != found:
            raise DxfError(f"it announces {record.integer(code)} {what} and holds {found}")
    shape: Spline = spline_from(
        degree=record.integer(71, 3),
        closed=bool(record.integer(70) & CLOSED),
        knots=record.numbers(40),
        weights=record.numbers(41),
        points=points_of(record, 10),
        fit_points=points_of(record, 11),
        tangents=[record.point(12), record.point(13)] if 12 in record.codes and 13 in record.codes else (),
    )
    return [shape]


def points_of(record: Record, code: int) -> list[Vector]:
    """All points of groups code, code + 10 and code + 20 (the last may be missing throughout)."""
    x, y, z = (record.numbers(code + step) for step in (0, 10, 20))
    z = z or [0.0] * len(x)
    if not len(x) == len(y) == len(z):
        raise DxfError(f"the coordinates of its points (groups {code}, {code + 10}, {code + 20}) do not match up")
    return list(zip(x, y, z, strict=True))


READERS: dict[str, Callable[[Record], list[Shape]]] = {
    "LINE": line,
    "POINT": point,
    "CIRCLE": full_circle,
    "ARC": arc,
    "ELLIPSE": ellipse,
    "LWPOLYLINE": lightweight,
    "SPLINE": spline,
}


def insert(record: Record, most: int) -> Insert:
    """INSERT: rows and columns step along the turned axes, unscaled. More than `most` copies raise DxfError."""
    columns, rows = max(1, record.integer(70, 1)), max(1, record.integer(71, 1))
    if columns * rows > most:
        raise DxfError(f"{columns} × {rows} copies of a block are too many (the limit is {most})")
    angle = math.radians(record.number(50, 0.0))
    scale = (record.number(41, 1.0), record.number(42, 1.0), record.number(43, 1.0))
    if scale[0] == 0.0 or scale[1] == 0.0:
        raise DxfError(f"its scale is {scale[0]:g} × {scale[1]:g}: nothing would be left")
    place = plane_of(record).after(shifted(record.point(10)))
    turned, form = turned_scaled(angle, (1.0, 1.0, 1.0)), turned_scaled(angle, scale)
    across, up = record.number(44, 0.0), record.number(45, 0.0)
    offsets = [turned.direction((column * across, row * up, 0.0)) for row in range(rows) for column in range(columns)]
    return Insert(record.text(2), tuple(place.after(shifted(offset)).after(form) for offset in offsets))
