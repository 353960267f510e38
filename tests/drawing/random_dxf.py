"""How is a random DXF drawing of nested blocks written, and where are the points it draws?

Points are summed up from the definitions: entities sampled in their own plane, then multiplied by the matrix of each block they
stand in. Shares no code with the package.
"""

import math
import random
from collections.abc import Callable, Sequence
from itertools import pairwise

import dxf_text as d
import numpy as np
from scipy.interpolate import BSpline

Array = np.ndarray
Drawn = tuple[str, list[Array]]  # the text, and rows of points (n, 3)
SAMPLES = 1500
SCALES = (
    *((1, 1, 1), (2, 2, 2), (-1, 1, 1), (1, -1, 1), (-0.5, -0.5, 0.5), (1.7, 0.6, 1)),
    *((1, 1, 0), (0.3, 0.3, 0), (-2, 1.1, 0), (1, 1, -1)),
)


def plane(normal: Sequence[float]) -> Array:
    """The axes of an entity's own plane as columns, by the arbitrary-axis rule."""
    n = np.array(normal, dtype=float) / np.linalg.norm(normal)
    steep = abs(n[0]) < 1 / 64 and abs(n[1]) < 1 / 64
    ax = np.cross((0, 1, 0) if steep else (0, 0, 1), n)
    ax /= np.linalg.norm(ax)
    return np.column_stack((ax, np.cross(n, ax), n))


def normal_of(rng: random.Random) -> tuple[float, float, float]:
    tilted = (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))
    return rng.choices(((0.0, 0.0, 1.0), (0.0, 0.0, -1.0), tilted), (5, 3, 1))[0]


def place(rng: random.Random, size: float = 5.0) -> tuple[float, float]:
    return round(rng.uniform(-size, size), 7), round(rng.uniform(-size, size), 7)


def line(rng: random.Random) -> Drawn:
    a, b = place(rng), place(rng)
    return d.line(a, b, layer="A"), [np.array([(*a, 0), (*b, 0)])]


def arc(rng: random.Random) -> Drawn:
    (x, y), normal, height = place(rng), normal_of(rng), rng.choice((0.0, 1.5))
    radius, start, end = rng.uniform(0.1, 4), rng.choice((0, 90, -90, 350, rng.uniform(-400, 400))), rng.uniform(-400, 400)
    t = np.radians(start + np.linspace(0, (end - start) % 360 or 360, SAMPLES))
    points = np.column_stack((x + radius * np.cos(t), y + radius * np.sin(t), np.full(len(t), height)))
    tags = [*d.point(10, (x, y, height)), *d.point(210, normal), (40, repr(radius)), (50, repr(start)), (51, repr(end))]
    return d.record("ARC", *tags), [points @ plane(normal).T]


def polyline(rng: random.Random) -> Drawn:
    """Light or heavy, open or closed, with bulges."""
    count, normal, height = rng.randint(3, 6), normal_of(rng), rng.choice((0.0, -2.0))
    corners = [(*place(rng), rng.choice((0, 0, 1, -1, rng.uniform(-2, 2)))) for _ in range(count)]
    closed = rng.random() < 0.5
    pairs = list(zip(corners, corners[1:] + corners[:1], strict=True))[: None if closed else -1]
    rows = [segment(complex(*a[:2]), complex(*b[:2]), a[2]) for a, b in pairs]
    points = [np.column_stack((z.real, z.imag, np.full(len(z), height))) @ plane(normal).T for z in rows]
    if rng.random() < 0.5:
        tags: list[d.Tag] = [(90, count), (70, int(closed)), (38, height), *d.point(210, normal)]
        for x, y, bulge in corners:
            tags += [(10, repr(x)), (20, repr(y)), (42, repr(bulge))]
        return d.record("LWPOLYLINE", *tags), points
    head = d.record("POLYLINE", (66, 1), *d.point(10, (0, 0, height)), (70, int(closed)), *d.point(210, normal))
    vertices = (d.record("VERTEX", *d.point(10, (x, y, height)), (42, repr(bulge))) for x, y, bulge in corners)
    return head + "".join(vertices) + d.record("SEQEND"), points


def segment(a: complex, b: complex, bulge: float) -> Array:
    """Points of a polyline's segment: the bulge is the tangent of a quarter of its angle."""
    if bulge == 0:
        return np.array([a, b])
    angle = 4 * math.atan(bulge)
    centre = (a + b) / 2 + 1j * (b - a) / 2 / math.tan(angle / 2)
    return centre + (a - centre) * np.exp(1j * np.linspace(0, angle, SAMPLES))


def ellipse(rng: random.Random) -> Drawn:
    normal = rng.choice(((0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    centre, major, ratio = np.array((*place(rng), 0)), np.array((*place(rng), 0)), rng.choice((1.0, rng.uniform(0.05, 2)))
    start, end = rng.choice(((0, math.tau), (5.5, 1.0), (math.pi, 0), (rng.uniform(-7, 7), rng.uniform(-7, 7))))
    t = start + np.linspace(0, (end - start) % math.tau or math.tau, 3 * SAMPLES)[:, None]
    tags = [*d.point(10, centre), *d.point(11, major), *d.point(210, normal)]
    tags += [(40, repr(ratio)), (41, repr(start)), (42, repr(end))]
    return d.record("ELLIPSE", *tags), [centre + np.cos(t) * major + ratio * np.sin(t) * np.cross(normal, major)]


def spline(rng: random.Random) -> Drawn:
    """Clamped, uniform or with any knots; weighted or not."""
    degree = rng.choice((2, 3, 3, 4, 5))
    count = rng.randint(degree + 1, degree + 6)
    points = [place(rng) for _ in range(count)]
    inner = sorted(round(rng.random(), 3) for _ in range(count - degree - 1))
    clamped = [0.0] * (degree + 1) + inner + [1.0] * (degree + 1)
    free = sorted(rng.random() for _ in range(count + degree + 1))
    knots = rng.choice((clamped, [float(k) for k in range(count + degree + 1)], free))
    weights = [rng.choice((1.0, rng.uniform(0.3, 3)))] + [rng.uniform(0.3, 3) for _ in points[1:]]
    w = np.array(weights if rng.random() < 0.4 else [1.0] * count)[:, None]
    breaks = np.unique(knots[degree : count + 1])
    t = np.concatenate([np.linspace(a, b, SAMPLES) for a, b in pairwise(breaks)])
    h = BSpline(np.array(knots), np.hstack((np.array(points) * w, w)), degree)(t)
    tags: list[d.Tag] = [(70, 8), (71, degree), (72, len(knots)), (73, count), *((40, repr(knot)) for knot in knots)]
    tags += [(41, repr(float(one))) for one in w[:, 0]] + [tag for p in points for tag in d.point(10, p)]
    return d.record("SPLINE", *tags), [np.column_stack((h[:, :2] / h[:, 2:], np.zeros(len(t))))]


KINDS: tuple[Callable[[random.Random], Drawn], ...] = (line, arc, polyline, ellipse, spline)


def insert(rng: random.Random, name: str, base: Sequence[float], inside: Sequence[Array]) -> Drawn:
    """A block put in place: base point off, scaled, turned, shifted, in rows and columns, in a plane of its own."""
    scale, angle, normal = rng.choice(SCALES), rng.choice((0, 90, 180, -45, rng.uniform(0, 360))), normal_of(rng)
    at, (columns, rows), (across, up) = (*place(rng, 20), 1.5), rng.choice(((1, 1), (1, 1), (2, 3))), place(rng)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    offsets = [turn @ (i * across, j * up, 0) + at for j in range(rows) for i in range(columns)]
    points = [(((p - base) * scale) @ turn.T + offset) @ plane(normal).T for offset in offsets for p in inside]
    tags: list[d.Tag] = [(41, scale[0]), (42, scale[1]), (43, scale[2]), (50, repr(angle)), *d.point(210, normal)]
    tags += [(70, columns), (71, rows), (44, repr(across)), (45, repr(up))] if columns > 1 else []
    return d.insert(name, at, *tags, layer="A"), points


def drawing(rng: random.Random) -> tuple[bytes, list[Array]]:
    """A whole file, and rows of points (n, 3) along all it draws."""
    blocks: list[tuple[str, tuple[float, ...], list[Array]]] = []
    text = ""
    for number in range(rng.randint(1, 3)):
        name, base = f"B{number}", (*place(rng, 2), rng.choice((0.0, 1.5)))
        parts = [rng.choice(KINDS)(rng) for _ in range(rng.randint(1, 2))]
        parts += [insert(rng, *rng.choice(blocks))] if blocks else []
        text += d.block(name, "".join(part for part, _ in parts), base)
        blocks.append((name, base, [row for _, rows in parts for row in rows]))
    parts = [rng.choice(KINDS)(rng), insert(rng, *blocks[-1]), insert(rng, *rng.choice(blocks))]
    return d.dxf("".join(part for part, _ in parts), blocks=text), [row for _, rows in parts for row in rows]
