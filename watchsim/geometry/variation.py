"""How does an outline differ that was not made exactly: grown on all sides, or with teeth out of place?

Errors are small against the outline: no edge vanishes, and none is added. Lines stay lines, arcs stay arcs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

Floats = NDArray[np.float64]
ALIKE = 1e-7  # m; points of one tooth and of the next may differ by so much from a turn by the pitch
SHARPEST = -0.99  # cosine between the normals at a corner: sharper ones would grow without end
TANGENT = 1e-7  # sine between two edges that meet smoothly
NEWTON = 6  # steps; lines need one, arcs converge quadratically
TIP = 0.85  # of the height of a tooth: points above are its tip
BODY = 0.5  # of that height: points above move with the tooth, those below the less, the nearer to the root


def grown(loop: Loop, offset: float) -> Loop:
    """The outline with all edges moved out of the material by `offset` (m), and corners where they then meet.

    ValueError where an arc is too small for it, or a corner too sharp.
    """
    edges = loop.edges
    if len(edges) == 1 and isinstance(edges[0], Arc) and edges[0].is_circle:
        return replace(loop, edges=(_wider(edges[0], offset),))
    pairs = [(edges[i - 1], edges[i]) for i in range(len(edges))]
    corners = [_corner(before, after, offset) for before, after in pairs]
    ends = [*corners[1:], corners[0]]
    if not loop.closed:
        corners[0] = _shifted(edges[0], 0.0, offset)
        ends[-1] = _shifted(edges[-1], 1.0, offset)
    made = tuple(_between(edge, start, end, offset) for edge, start, end in zip(edges, corners, ends, strict=True))
    return replace(loop, edges=made)


def _normal(edge: Edge, fraction: float) -> Point:
    """Out of the material, which is on the left."""
    x, y = edge.tangent(fraction)
    return (y, -x)


def _shifted(edge: Edge, fraction: float, offset: float) -> Point:
    (x, y), (nx, ny) = edge.point(fraction), _normal(edge, fraction)
    return (x + offset * nx, y + offset * ny)


def _wider(arc: Arc, offset: float) -> Arc:
    radius = arc.radius + math.copysign(offset, offset * arc.sweep)
    if radius <= 0.0:
        raise ValueError(f"an arc of {1e6 * arc.radius:.4g} µm radius is too small for an offset of {1e6 * offset:.4g} µm")
    return replace(arc, radius=radius)


def _corner(before: Edge, after: Edge, offset: float) -> Point:
    """Where two neighbours meet once both are moved."""
    (ax, ay), (bx, by) = _normal(before, 1.0), _normal(after, 0.0)
    cosine, sine = ax * bx + ay * by, ax * by - ay * bx
    x, y = after.start
    if cosine < SHARPEST:
        raise ValueError(f"the corner at ({1e3 * x:.4g}, {1e3 * y:.4g}) mm is too sharp to be moved to one side")
    reach = offset / (1.0 + cosine)
    point = (x + reach * (ax + bx), y + reach * (ay + by))
    if abs(sine) < TANGENT:
        return point
    for _ in range(NEWTON if isinstance(before, Arc) or isinstance(after, Arc) else 1):
        (g, gx, gy), (h, hx, hy) = _away(before, point, offset), _away(after, point, offset)
        det = gx * hy - gy * hx
        if abs(det) < TANGENT:
            break
        point = (point[0] - (g * hy - h * gy) / det, point[1] - (gx * h - hx * g) / det)
    return point


def _away(edge: Edge, point: Point, offset: float) -> tuple[float, float, float]:
    """How far the point lies off the moved edge (all of its line or circle), and the gradient of that."""
    if isinstance(edge, Line):
        nx, ny = _normal(edge, 0.0)
        return (point[0] - edge.x0) * nx + (point[1] - edge.y0) * ny - offset, nx, ny
    dx, dy = point[0] - edge.x, point[1] - edge.y
    distance = math.hypot(dx, dy) or edge.radius
    return distance - _wider(edge, offset).radius, dx / distance, dy / distance


def _between(edge: Edge, start: Point, end: Point, offset: float) -> Edge:
    """The moved edge from one new corner to the next."""
    if isinstance(edge, Line):
        if (end[0] - start[0]) * (edge.x1 - edge.x0) + (end[1] - start[1]) * (edge.y1 - edge.y0) <= 0.0:
            raise ValueError(f"an edge of {1e6 * edge.length:.4g} µm is too short for an offset of {1e6 * offset:.4g} µm")
        return Line(*start, *end)
    angles = [math.atan2(y - edge.y, x - edge.x) for x, y in (start, end)]
    first = edge.start_angle + math.remainder(angles[0] - edge.start_angle, TURN)
    last = edge.start_angle + edge.sweep + math.remainder(angles[1] - edge.start_angle - edge.sweep, TURN)
    if (last - first) * edge.sweep <= 0.0:
        raise ValueError(f"an arc of {1e6 * edge.length:.4g} µm is too short for an offset of {1e6 * offset:.4g} µm")
    return replace(_wider(edge, offset), start_angle=first, sweep=last - first)


# Teeth are found along the outline, not by angle: an undercut tooth leans over the gap of the next one.


def fold(loop: Loop, centre: Point = (0.0, 0.0)) -> int:
    """How many equal teeth the outline has about `centre`: so often comes the same sequence of edges. 1 for none.

    Every edge must belong to a tooth, as errors are given to each: spokes on the same outline, which `contact.symmetry` leaves
    out, make it 1.
    """
    count = len(loop.edges)
    if not loop.closed or count < 2:
        return 1
    points = _points(loop, centre)
    step = points * np.conj(np.roll(points, 1))  # distances from the centre, and turns from point to point
    sweeps = np.array([edge.sweep if isinstance(edge, Arc) else 0.0 for edge in loop.edges])
    size = float(np.abs(points).max())
    for period in (m for m in range(1, count // 2 + 1) if count % m == 0):
        off = np.abs(step - np.roll(step, period)).max() / size
        if off < ALIKE and np.abs(sweeps - np.roll(sweeps, period)).max() * size < ALIKE:
            return count // period
    return 1


def _points(loop: Loop, centre: Point) -> NDArray[np.complex128]:
    """Where its edges begin, from the centre, as complex numbers."""
    return np.array([complex(*edge.start) for edge in loop.edges]) - complex(*centre)


@dataclass(frozen=True)
class TeethErrors:
    """Of each tooth (m), the one nearest to the x axis first, counter-clockwise; `wobble` and `towards` (rad) of the wheel.

    pitch is measured along the circle of the tips, height outwards, width from flank to flank.
    """

    pitch: Floats
    height: Floats
    width: Floats
    wobble: float = 0.0
    towards: float = 0.0


def with_errors(loop: Loop, centre: Point, teeth: int, errors: TeethErrors) -> Loop:
    """The outline with those errors of its teeth; roots stay where they are."""
    points = _points(loop, centre)
    radius, count = np.abs(points), len(points) // teeth
    root, tip = float(radius.min()), float(radius.max())
    height = (radius - root) / (tip - root) if tip > root else np.zeros_like(radius)
    way = 1.0 if np.sum(np.imag(np.conj(points) * np.roll(points, -1))) > 0.0 else -1.0
    tooth = (np.arange(len(points)) - int(np.argmin(radius[:count]))) // count % teeth
    middle = np.array([points[(tooth == k) & (height >= TIP)].sum() for k in range(teeth)])
    first = int(np.argmin(np.abs(np.angle(middle))))
    number = ((tooth - first) * int(way)) % teeth
    # Which flank: how far round from the middle of the tip, at most half the tip's own width to either side.
    round_by = np.angle(points * np.conj(middle[tooth]))
    half = float(np.abs(round_by[height >= TIP]).max()) or 1.0
    flank = np.clip(round_by / half, -1.0, 1.0)
    share = np.clip(height / BODY, 0.0, 1.0)
    along = share * (errors.pitch[number] * radius / tip + 0.5 * flank * errors.width[number])
    out = points / radius * (share * errors.height[number] + 1j * along)
    moved = points + out
    line = np.exp(1j * errors.towards)
    moved = moved - (1.0 - math.cos(errors.wobble)) * np.real(moved * np.conj(line)) * line + complex(*centre)
    places = [(float(one.real), float(one.imag)) for one in moved]
    ends: Sequence[Point] = [*places[1:], places[0]]
    return replace(loop, edges=tuple(_stretched(*each) for each in zip(loop.edges, places, ends, strict=True)))


def _stretched(edge: Edge, start: Point, end: Point) -> Edge:
    """The edge between two new ends; an arc keeps its sweep."""
    if isinstance(edge, Line):
        return Line(*start, *end)
    chord = complex(*end) - complex(*start)
    to_centre = 0.5 * chord * (1.0 + 1j / math.tan(0.5 * edge.sweep))
    centre = complex(*start) + to_centre
    first = math.atan2(-to_centre.imag, -to_centre.real)
    return Arc(centre.real, centre.imag, abs(to_centre), first, edge.sweep)
