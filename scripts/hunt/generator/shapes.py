"""Which outlines do random mechanisms have?

Lengths in metres. Smooth curves come as CAD programs export them: as so many arcs through three points each, or chords, with a
small kink at every joint.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from hunt.generator.parts import Dice
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point

Curve = Callable[[float], Point]
STRAIGHT = 1e-9  # sagitta by chord below which three points count as straight


def polygon(points: Sequence[Point]) -> Loop:
    """Counter-clockwise corners."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, [*points[1:], points[0]], strict=True)), "polygon")


def circle(radius: float, centre: Point = (0.0, 0.0)) -> Loop:
    return Loop((Arc(*centre, radius, 0.0, TURN),), "circle")


def box(width: float, height: float, centre: Point = (0.0, 0.0)) -> Loop:
    (x, y), w, h = centre, 0.5 * width, 0.5 * height
    return polygon([(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)])


def turned_points(points: Sequence[Point], angle: float) -> list[Point]:
    c, s = math.cos(angle), math.sin(angle)
    return [(c * x - s * y, s * x + c * y) for x, y in points]


def ragged(dice: Dice, radius: float, corners: int) -> Loop:
    """A star-shaped polygon, convex or not."""
    steps = [dice.uniform(0.5, 1.5) for _ in range(corners)]
    angles = np.cumsum(steps) * TURN / sum(steps)
    low = dice.pick((0.5, 0.8, 1.0))
    reach = [radius * (dice.uniform(low, 1.0) if low < 1.0 else 1.0) for _ in range(corners)]
    return polygon([(round(r * math.cos(a), 8), round(r * math.sin(a), 8)) for r, a in zip(reach, angles, strict=True)])


def arc_through(a: Point, b: Point, c: Point) -> Edge:
    """From a through b to c; a line where they are straight."""
    (ax, ay), (bx, by), (cx, cy) = a, b, c
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    cross = ux * vy - uy * vx
    if abs(cross) < STRAIGHT * (vx * vx + vy * vy):
        return Line(*a, *c)
    u2, v2 = ux * ux + uy * uy, vx * vx + vy * vy
    x, y = ax + (vy * u2 - uy * v2) / (2.0 * cross), ay + (ux * v2 - vx * u2) / (2.0 * cross)
    start, end = math.atan2(ay - y, ax - x), math.atan2(cy - y, cx - x)
    sweep = (end - start) % TURN if cross > 0.0 else -((start - end) % TURN)
    return Arc(x, y, math.hypot(ax - x, ay - y), start, sweep)


def curve_edges(curve: Curve, count: int, arcs: bool) -> list[Edge]:
    """The curve for parameters from 0 to 1 in so many arcs or chords."""
    if not arcs:
        points = [curve(k / count) for k in range(count + 1)]
        return [Line(*a, *b) for a, b in pairwise(points)]
    points = [curve(0.5 * k / count) for k in range(2 * count + 1)]
    return [arc_through(*points[k : k + 3]) for k in range(0, 2 * count, 2)]


def closed_curve(curve: Curve, count: int, arcs: bool) -> Loop:
    """The same for a curve that closes, counter-clockwise."""
    return Loop(tuple(curve_edges(lambda s: curve(s % 1.0), count, arcs)), "curve")


def joined(*parts: Sequence[Edge], layer: str = "curve") -> Loop:
    """Edges one after another, gaps bridged by lines; closed."""
    edges: list[Edge] = []
    for part in parts:
        for edge in part:
            if edges and math.dist(edges[-1].end, edge.start) > 1e-12:
                edges.append(Line(*edges[-1].end, *edge.start))
            edges.append(edge)
    if math.dist(edges[-1].end, edges[0].start) > 1e-12:
        edges.append(Line(*edges[-1].end, *edges[0].start))
    return Loop(tuple(edges), layer)


def cam_curve(dice: Dice, radius: float) -> Curve:
    """An ellipse, a lobed disc or an eccentric, counter-clockwise."""
    kind, depth, lobes = dice.pick(("ellipse", "lobes", "eccentric")), dice.uniform(0.03, 0.35), dice.number(1, 3)

    def at(s: float) -> Point:
        a = TURN * s
        if kind == "ellipse":
            return radius * math.cos(a), radius * (1.0 - depth) * math.sin(a)
        if kind == "eccentric":
            return radius * (math.cos(a) + depth), radius * math.sin(a)
        r = radius * (1.0 + 0.3 * depth * math.cos(lobes * a))
        return r * math.cos(a), r * math.sin(a)

    return at


def gear(teeth: int, module: float, pieces: int, arcs: bool, play: float) -> Loop:
    """A sector of involute teeth of 25 degrees, each flank in so many pieces; its middle tooth points along +x."""
    pressure = math.radians(25.0)
    pitch = 0.5 * module * teeth
    base, tip, root = pitch * math.cos(pressure), pitch + module, pitch - 1.3 * module
    half = 0.25 * TURN / teeth * (1.0 - play) + math.tan(pressure) - pressure  # of the tooth, at the base circle
    low = max(base, root) * (1.0 + 1e-6)

    def flank(s: float) -> Point:
        r = low + (tip - low) * s
        t = math.sqrt((r / base) ** 2 - 1.0)
        a = -(half - (t - math.atan(t)))
        return r * math.cos(a), r * math.sin(a)

    up = curve_edges(flank, pieces, arcs)
    down = curve_edges(lambda s: (flank(1.0 - s)[0], -flank(1.0 - s)[1]), pieces, arcs)
    foot_angle = math.atan2(flank(0.0)[1], flank(0.0)[0])
    foot = (root * math.cos(foot_angle), root * math.sin(foot_angle))
    tooth = joined([Line(*foot, *up[0].start)], up, down, [Line(*down[-1].end, foot[0], -foot[1])])
    edges = [tooth.moved(k * TURN / teeth, (0.0, 0.0)).edges[:-1] for k in range(-2, 3 if teeth > 9 else 2)]
    return joined(*edges)


def ratchet_wheel(teeth: int, radius: float, depth: float, lean: float) -> Loop:
    """Saw teeth whose steep faces lean from the radius by `lean` rad; they look clockwise."""
    points: list[Point] = []
    for k in range(teeth):
        a = k * TURN / teeth
        low = (radius - depth) * math.cos(a - lean), (radius - depth) * math.sin(a - lean)
        points += [low, (radius * math.cos(a), radius * math.sin(a))]
    return polygon(points)


def slotted_wheel(slots: int, radius: float, width: float, depth: float) -> Loop:
    """A disc with radial slots, between them chords or arcs: a Geneva wheel without its lock."""
    edges: list[Edge] = []
    reach = math.sqrt(radius**2 - 0.25 * width**2)
    half = math.atan2(0.5 * width, reach)
    for k in range(slots):
        a = k * TURN / slots
        slot = turned_points(
            [(reach, -0.5 * width), (radius - depth, -0.5 * width), (radius - depth, 0.5 * width), (reach, 0.5 * width)], a
        )
        edges += [Line(*p, *q) for p, q in pairwise(slot)]
        edges.append(Arc(0.0, 0.0, radius, a + half, TURN / slots - 2.0 * half))
    return joined(edges)


def kinked_bar(dice: Dice, length: float, thick: float) -> Loop:
    """A bar whose top turns by a few kinks, each from 1e-10 rad to a right angle; the kinks lie right of its middle."""
    places = sorted(dice.uniform(-0.15, 0.4) * length for _ in range(dice.number(1, 3)))
    slope, top, last = 0.0, [(-0.5 * length, 0.0)], (-0.5 * length, 0.0)
    for x in [*places, 0.5 * length]:
        last = (x, last[1] + math.tan(slope) * (x - last[0]))
        top.append(last)
        turn = dice.kink(1.2)
        slope = slope + turn if abs(slope + turn) < 1.2 else slope - turn
    floor = min(y for _, y in top) - thick
    return polygon([(-0.5 * length, floor), (0.5 * length, floor), *reversed(top)])


def wavy_bar(dice: Dice, length: float, thick: float) -> Loop:
    """A bar whose top is a wave of many arcs or chords behind a flat start."""
    height, waves, count = dice.uniform(0.002, 0.04) * length, dice.number(1, 3), dice.number(2, 40)
    begin = -0.25 * length

    def top(s: float) -> Point:
        x = 0.5 * length - s * (0.5 * length - begin)
        return x, 0.5 * height * (1.0 - math.cos(TURN * waves * (1.0 - s)))

    edges = curve_edges(top, count, dice.chance(0.6))
    corners = [(begin, 0.0), (-0.5 * length, 0.0), (-0.5 * length, -thick), (0.5 * length, -thick), edges[0].start]
    return joined(edges, [Line(*a, *b) for a, b in pairwise(corners)])
