"""How far is an edge from a point, or from another edge?

Lines and arcs alike are given by their middle, the normal there, a curvature (0 for a line) and half their length, so that
no centre enters and nothing is lost where arcs are flat (docs/theory/method.md 2.2). Distances are between points that both
edges have; sides of material do not matter here.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from watchsim.geometry.primitives import Edge, Line, middle
from watchsim.jit import entry, kernel
from watchsim.model import records

FLAT = 8.0  # an arc whose radius is larger than so many lengths gets its middle from exact arithmetic
HALVINGS = 200

EDGE = np.dtype(
    [
        ("x", "f8"),  # its middle
        ("y", "f8"),
        ("nx", "f8"),  # unit normal there; of an arc, away from the centre
        ("ny", "f8"),
        ("curvature", "f8"),  # 1/m, never negative
        ("half", "f8"),  # half its length
    ]
)


class Nearest(NamedTuple):
    """Where two sets of edges are nearest: the edge of each by its row, and the place on it by the way from its middle."""

    distance: float  # m
    edge_a: int
    way_a: float  # m
    edge_b: int
    way_b: float  # m
    crossing: bool  # edges cross there: the distance is 0


def edge_records(edges: Iterable[Edge]) -> Any:
    """EDGE records of edges that have a length, in their own frame (metres)."""
    rows: list[tuple[float, ...]] = []
    for edge in edges:
        if not edge.length > 0.0:
            continue
        if isinstance(edge, Line):
            (x, y), (tx, ty) = edge.point(0.5), edge.tangent(0.5)
            rows.append((x, y, ty, -tx, 0.0, 0.5 * edge.length))
        else:
            x, y, c, s = middle(edge, exact=edge.radius > FLAT * edge.length)
            rows.append((x, y, c, s, 1.0 / edge.radius, 0.5 * min(edge.length, 2.0 * math.pi * edge.radius)))
    out = records(EDGE, len(rows))
    out[:] = rows
    return out


@kernel
def place_edges(edges, pose, out_edges):
    """The edges at pose (x, y, cosine, sine)."""
    x, y, c, s = pose
    for i in range(len(edges)):
        edge, out = edges[i], out_edges[i]
        out.x, out.y = x + c * edge.x - s * edge.y, y + s * edge.x + c * edge.y
        out.nx, out.ny = c * edge.nx - s * edge.ny, s * edge.nx + c * edge.ny
        out.curvature, out.half = edge.curvature, edge.half


@kernel
def point_on(edge, way):
    """The point of the edge at that signed way from its middle."""
    half_turn = 0.5 * edge.curvature * way
    chord = way if half_turn == 0.0 else math.sin(half_turn) / half_turn * way
    along, down = chord * math.cos(half_turn), chord * math.sin(half_turn)
    return edge.x - edge.ny * along - edge.nx * down, edge.y + edge.nx * along - edge.ny * down


@kernel
def height_over(edge, x, y):
    """(height, way): of a point over the whole line or circle, positive on the normal's side, and where its foot lies."""
    wx, wy = x - edge.x, y - edge.y
    up, along = edge.nx * wx + edge.ny * wy, edge.nx * wy - edge.ny * wx
    k = edge.curvature
    across, ahead = 1.0 + k * up, k * along
    height = (2.0 * up + k * (wx * wx + wy * wy)) / (1.0 + math.sqrt(across * across + ahead * ahead))
    return height, along if k == 0.0 else math.atan2(ahead, across) / k


@kernel
def point_to_edge(edge, x, y):
    """(distance, way of the nearest point of the edge)."""
    height, way = height_over(edge, x, y)
    if abs(way) <= edge.half:
        return abs(height), way
    way = math.copysign(edge.half, way)
    px, py = point_on(edge, way)
    return math.hypot(x - px, y - py), way


@kernel
def _common_normal(a, b, sign):
    """(found, distance, way on a, way on b, angle on a) at the normal that round edge a shares with b, no rounder than a.

    sign +1: the normals point against each other, -1: along each other.
    """
    r = sign / a.curvature
    share = 1.0 + b.curvature * r
    if share == 0.0:
        return False, 0.0, 0.0, 0.0, 0.0
    K = b.curvature / share
    wx, wy = a.x - b.x, a.y - b.y
    ax, ay = sign * a.nx, sign * a.ny
    sx, sy = ax + b.nx, ay + b.ny
    x, y = wx - r * sx, wy - r * sy
    nx, ny = b.nx + K * x, b.ny + K * y
    Q = math.sqrt(nx * nx + ny * ny)
    if Q == 0.0:
        return False, 0.0, 0.0, 0.0, 0.0
    nx, ny = nx / Q, ny / Q
    gap = (2.0 * (wx * b.nx + wy * b.ny) - r * (sx * sx + sy * sy) + K * (x * x + y * y)) / (1.0 + Q)
    angle = math.atan2(-(ax * ny - ay * nx), -(ax * nx + ay * ny))
    # Foot of a's point: the two stay opposite each other, however far a flat arc's point runs with rounding.
    px, py = point_on(a, angle / a.curvature)
    _, way_b = height_over(b, px, py)
    return True, abs(gap), angle / a.curvature, way_b, angle


@kernel
def _crossing(a, b, angle):
    """(found, way on a): where a, with extremes over b at `angle` and opposite, crosses b."""
    turn = math.pi / a.curvature if a.curvature > 0.0 else math.inf
    first = angle / a.curvature if a.curvature > 0.0 else math.inf
    second = first - turn if first > 0.0 else first + turn
    low = -a.half
    x, y = point_on(a, low)
    before, _ = height_over(b, x, y)
    for j in range(3):
        high = a.half
        if j < 2:
            stop = min(first, second) if j == 0 else max(first, second)
            if not low < stop < a.half:
                continue
            high = stop
        x, y = point_on(a, high)
        after, _ = height_over(b, x, y)
        if before * after < 0.0:
            start, end = low, high
            for _ in range(HALVINGS):
                middle_ = 0.5 * (start + end)
                if not min(start, end) < middle_ < max(start, end):
                    break
                x, y = point_on(a, middle_)
                height, _way = height_over(b, x, y)
                if height * before > 0.0:
                    start = middle_
                else:
                    end = middle_
            x, y = point_on(a, end)
            _, way = height_over(b, x, y)
            if abs(way) <= b.half:
                return True, end
        low, before = high, after
    return False, 0.0


@kernel
def edge_to_edge(a, b):
    """(distance, way on a, way on b, crossing?) of the nearest points of two edges."""
    best, at_a, at_b = math.inf, 0.0, 0.0
    for side in (-1.0, 1.0):
        x, y = point_on(a, side * a.half)
        distance, way = point_to_edge(b, x, y)
        if distance < best:
            best, at_a, at_b = distance, side * a.half, way
        x, y = point_on(b, side * b.half)
        distance, way = point_to_edge(a, x, y)
        if distance < best:
            best, at_a, at_b = distance, way, side * b.half
    swap = a.curvature < b.curvature
    one, two = (b, a) if swap else (a, b)
    angle = 0.0
    if one.curvature > 0.0:
        for sign in (1.0, -1.0):
            found, distance, first, second, turned = _common_normal(one, two, sign)
            if not found:
                continue
            angle = turned
            if distance < best and abs(first) <= one.half and abs(second) <= two.half:
                best, at_a, at_b = distance, (second if swap else first), (first if swap else second)
    found, way = _crossing(one, two, angle)
    if found and best > 0.0:
        x, y = point_on(one, way)
        _, other = height_over(two, x, y)
        return 0.0, (other if swap else way), (way if swap else other), True
    return best, at_a, at_b, False


@entry
def nearest_edges(edges_a, pose_a, edges_b, pose_b, room_a, room_b):
    """The nearest points of two sets of edges at poses (x, y, cosine, sine)."""
    place_edges(edges_a, pose_a, room_a)
    place_edges(edges_b, pose_b, room_b)
    best, row_a, at_a, row_b, at_b = math.inf, 0, 0.0, 0, 0.0
    for i in range(len(edges_a)):
        a = room_a[i]
        for j in range(len(edges_b)):
            b = room_b[j]
            if math.hypot(a.x - b.x, a.y - b.y) - a.half - b.half > best:
                continue
            distance, first, second, crossing = edge_to_edge(a, b)
            if distance < best or crossing:
                best, row_a, at_a, row_b, at_b = distance, i, first, j, second
            if crossing:
                return Nearest(0.0, i, first, j, second, True)
    return Nearest(best, row_a, at_a, row_b, at_b, False)


@entry
def depth_profile(edges, row, ways, others, out_depths, out_points):
    """For points at `ways` of edge `row`: distance to the nearest of the other edges, and that point."""
    for i in range(len(ways)):
        x, y = point_on(edges[row], ways[i])
        best = math.inf
        for j in range(len(others)):
            distance, way = point_to_edge(others[j], x, y)
            if distance < best:
                best = distance
                out_points[i, 0], out_points[i, 1] = point_on(others[j], way)
        out_depths[i] = best
