"""How does a scene become a model?

Bodies, forces and declared contacts are flattened once into the record arrays the kernels read. Only outlines named in
a contact enter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.mechanism.body import Body
from watchsim.mechanism.choose_cells import choose_cells
from watchsim.mechanism.features import features
from watchsim.mechanism.force import Side, Torque
from watchsim.mechanism.model import (
    ARC,
    BODY,
    BODY_PAIR,
    CONSTANT,
    CONTACT,
    COORDINATE,
    CORNER,
    FREE,
    LAW,
    MOTION_CODE,
    OVER_ANGLE,
    OVER_TIME,
    PIVOT,
    PRIMITIVE,
    SLIDE,
    TABLE,
    TANGENTIAL_CODE,
    Model,
    Records,
    frozen,
    records,
)
from watchsim.mechanism.reachable import reachable
from watchsim.mechanism.scene import Scene

OVER = {"constant": CONSTANT, "angle": OVER_ANGLE, "time": OVER_TIME}
CLEARANCE = 2e-3  # of the size: a pair that comes this close counts as touching. More than any tolerance of a run


@dataclass(frozen=True)
class Compiled:
    """The model with what people need to read it."""

    model: Model
    layers: tuple[str, ...]  # of each primitive
    slices: dict[str, slice]  # coordinates of each body
    size: float  # m, the reach of the largest moving body
    q: np.ndarray
    u: np.ndarray
    fastest: float  # 1/s, largest natural frequency of a spring, 0 without springs


def compile_scene(scene: Scene, prefilter: bool = True) -> Compiled:
    """Flatten a checked scene (SI units). Coordinates follow the order of the bodies.

    Without `prefilter` every declared pair of primitives is a candidate everywhere.
    """
    size = scene_size(scene)
    bodies, slices, q, u = _bodies(scene)
    primitives, layers, sides = _primitives(scene, size)
    contacts, laws, pairs = _contacts(scene, sides, primitives)
    coordinates, tables, knots, fastest = _coordinates(scene, slices, size)
    pairs.clearance = CLEARANCE * size
    near = _near(bodies, primitives, contacts, pairs)
    choose_cells(bodies, primitives, contacts, pairs, near)
    if not prefilter:
        # The cells stay, so that time is parted in the same way; only their answers are not used.
        near = np.arange(len(contacts))
        pairs.near_start, pairs.near_stop, pairs.listed = pairs.start, pairs.stop, 0
    parts = (bodies, coordinates, tables, knots, primitives, contacts, laws, pairs, near)
    return Compiled(Model(*(frozen(part) for part in parts)), layers, slices, size, q, u, fastest)


def scene_size(scene: Scene) -> float:
    """The largest distance of an outline from its moving body's origin, m; 1 mm where nothing moving has outlines."""
    reaches = [_reach(body) for body in scene.bodies if body.motion != "fixed" and body.loops]
    return max(reaches, default=0.0) or 1e-3


def _reach(body: Body) -> float:
    far = 0.0
    for loop in body.loops:
        for edge in loop.edges:
            far = max(far, *(math.hypot(*edge.point(f)) for f in (0.0, 0.25, 0.5, 0.75, 1.0)))
    return far


def _bodies(scene: Scene) -> tuple[Records, dict[str, slice], np.ndarray, np.ndarray]:
    rows = records(BODY, len(scene.bodies))
    slices: dict[str, slice] = {}
    q: list[float] = []
    u: list[float] = []
    for row, body in zip(rows, scene.bodies, strict=True):
        row.motion = MOTION_CODE[body.motion]
        row.x, row.y, row.angle = *body.position, body.angle
        row.c, row.s = math.cos(body.angle), math.sin(body.angle)
        row.axis_x, row.axis_y = body.axis
        start = {"fixed": (), "pivot": (body.angle,), "slide": (0.0,), "free": (*body.position, body.angle)}[body.motion]
        row.first = len(q) if start else -1
        if start:
            slices[body.name] = slice(len(q), len(q) + len(start))
        q.extend(start)
        u.extend(body.velocity if body.velocity else (0.0,) * len(start))
    return rows, slices, np.array(q, float), np.array(u[: len(q)], float)


def _primitives(scene: Scene, size: float) -> tuple[Records, tuple[str, ...], dict[Side, np.ndarray]]:
    """All primitives that a contact names, their layers, and for each side of a contact the numbers of its primitives."""
    asked = list(dict.fromkeys(side for contact in scene.contacts for side in contact.sides))
    names = [body.name for body in scene.bodies]
    blocks: list[Records] = []
    layers: list[str] = []
    of_layer: dict[tuple[str, str], np.ndarray] = {}
    for side in asked:
        body = scene.body(side.body)
        for layer in body.layers if side.layer is None else (side.layer,):
            if (side.body, layer) in of_layer:
                continue
            found = [features(loop, names.index(side.body), size) for loop in body.loops if loop.layer == layer]
            start = len(layers)
            for block in found:
                for side_of in ("before", "after"):
                    block[side_of][block[side_of] >= 0] += len(layers)
                blocks.append(block)
                layers.extend([layer] * len(block))
            of_layer[side.body, layer] = np.arange(start, len(layers))
    sides = {}
    for side in asked:
        chosen = scene.body(side.body).layers if side.layer is None else (side.layer,)
        sides[side] = np.concatenate([of_layer[side.body, layer] for layer in chosen] or [np.zeros(0, int)]).astype(int)
    rows = np.concatenate(blocks).view(np.recarray) if blocks else records(PRIMITIVE, 0)
    return rows, tuple(layers), sides


def _contacts(scene: Scene, sides: dict[Side, np.ndarray], primitives: Records) -> tuple[Records, Records, Records]:
    """Every declared pair (circle on A, line or arc on B), grouped by pair of bodies; the laws; the pairs of bodies."""
    laws = records(LAW, len(scene.contacts))
    found: dict[tuple[int, int], list[np.ndarray]] = {}
    names = [body.name for body in scene.bodies]
    for group, contact in enumerate(scene.contacts):
        laws[group].friction, laws[group].restitution = contact.friction, contact.restitution
        laws[group].tangential = contact.tangential_restitution
        laws[group].kind, laws[group].nu = TANGENTIAL_CODE[scene.tangential_law], scene.nu
        first, last = (sides[side] for side in contact.sides)
        a, b = _touching(primitives, first, last)
        block = np.stack([a, b, np.full(len(a), group)], axis=1)
        i, j = (names.index(side.body) for side in contact.sides)
        found.setdefault((min(i, j), max(i, j)), []).append(block)
    pairs = records(BODY_PAIR, len(found))
    blocks = []
    start = 0
    for row, (key, parts) in zip(pairs, found.items(), strict=True):
        block = np.unique(np.concatenate(parts), axis=0)
        row.a, row.b, row.start, row.stop = *key, start, start + len(block)
        start += len(block)
        blocks.append(block)
    contacts = records(CONTACT, start)
    if blocks:
        table = np.concatenate(blocks)
        contacts.a, contacts.b, contacts.group = table[:, 0], table[:, 1], table[:, 2]
        _add_shapes(primitives, contacts)
    return contacts, laws, pairs


def _add_shapes(primitives: Records, contacts: Records) -> None:
    """Curvature of B's curve with A's radius added to it, and the reduced radius of the two."""
    a, b = primitives[contacts.a], primitives[contacts.b]
    arcs = b.kind == ARC
    total = np.where(arcs, b.radius + b.side * a.radius, 1.0)
    contacts.curvature = np.where(arcs, b.side / total, 0.0)
    contacts.reduced = np.where(arcs, a.radius * b.radius / total, a.radius)


def _touching(primitives: Records, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All pairs (circle, other) between two sets of primitives that have a gap function."""
    kind, radius, convex = primitives.kind, primitives.radius, primitives.side > 0.0

    def circles_and_edges(circles: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        circles = circles[(kind[circles] == CORNER) | ((kind[circles] == ARC) & convex[circles])]
        edges = edges[kind[edges] != CORNER]
        a, b = np.repeat(circles, len(edges)), np.tile(edges, len(circles))
        fits = (kind[b] != ARC) | convex[b] | (radius[a] < radius[b])
        return a[fits], b[fits]

    def both_round(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (kind[a] == ARC) & (kind[b] == ARC) & convex[b]

    a, b = circles_and_edges(first, last)
    c, d = circles_and_edges(last, first)
    # Two convex arcs are one contact, not two: the rounder one plays the circle, of equal ones the first set's.
    one, two = ~both_round(a, b) | (radius[a] <= radius[b]), ~both_round(c, d) | (radius[c] < radius[d])
    return np.concatenate([a[one], c[two]]), np.concatenate([b[one], d[two]])


def _coordinates(scene: Scene, slices: dict[str, slice], size: float) -> tuple[Records, Records, np.ndarray, float]:
    """Coordinates with their forces; force tables and their knots; the largest natural frequency."""
    count = sum(part.stop - part.start for part in slices.values())
    rows = records(COORDINATE, count)
    numbers = {body.name: i for i, body in enumerate(scene.bodies)}
    for body in scene.bodies:
        if body.name in slices:
            _inertias(scene, body, numbers[body.name], rows[slices[body.name]], size)
    for spring in scene.springs:
        row = rows[_driven(scene, slices, spring.body)]
        # Several springs on one coordinate add up to one: stiffnesses add, rests average.
        total = row.stiffness + spring.stiffness
        row.rest = (row.stiffness * row.rest + spring.stiffness * spring.rest) / total
        row.stiffness = total
    for damping in scene.damping:
        row = rows[_driven(scene, slices, damping.body)]
        row.viscous += damping.viscous
        row.quadratic += damping.quadratic
        row.coulomb += damping.coulomb
    tables, knots = _tables(scene, slices, rows)
    tabled = {int(table.coordinate) for table in tables}
    for i, row in enumerate(rows):
        row.linear = row.quadratic == 0.0 and row.weight_x == 0.0 and row.weight_y == 0.0 and i not in tabled
    fastest = float(np.sqrt(np.max(rows.stiffness / rows.mass, initial=0.0)))
    pushed = float(np.sqrt(np.max(np.abs(rows.force) / (rows.mass * rows.scale), initial=0.0)))
    rows.rate = fastest or pushed or 1.0
    return rows, tables, knots, fastest


def _driven(scene: Scene, slices: dict[str, slice], name: str) -> int:
    """The coordinate on which a body's spring, torque or damping acts: its angle, or a sliding body's travel."""
    part = slices[name]
    return part.stop - 1 if scene.body(name).motion == "free" else part.start


def _inertias(scene: Scene, body: Body, number: int, rows: Records, size: float) -> None:
    """Masses, scales and gravity of one body's coordinates."""
    gx, gy = scene.gravity
    rows.body = number
    motion = MOTION_CODE[body.motion]
    if motion == PIVOT:
        cx, cy = body.centre_of_mass
        rows.mass, rows.scale = body.inertia, 1.0
        rows.weight_x, rows.weight_y = body.mass * (cx * gx + cy * gy), body.mass * (cx * gy - cy * gx)
    elif motion == SLIDE:
        rows.mass, rows.scale = body.mass, size
        rows.force = body.mass * (gx * body.axis[0] + gy * body.axis[1])
    elif motion == FREE:
        rows.mass, rows.scale = (body.mass, body.mass, body.inertia), (size, size, 1.0)
        rows.force = (body.mass * gx, body.mass * gy, 0.0)


def _tables(scene: Scene, slices: dict[str, slice], rows: Records) -> tuple[Records, np.ndarray]:
    """Constant torques go into the coordinates, the others into tables."""
    tabled: list[Torque] = []
    for torque in scene.torques:
        if torque.over == "constant":
            rows[_driven(scene, slices, torque.body)].force += torque.value
        else:
            tabled.append(torque)
    tables = records(TABLE, len(tabled))
    knots: list[tuple[float, float]] = []
    for row, torque in zip(tables, tabled, strict=True):
        row.coordinate, row.over = _driven(scene, slices, torque.body), OVER[torque.over]
        row.start, row.count = len(knots), len(torque.table)
        knots.extend(torque.table)
    return tables, np.array(knots, float).reshape(len(knots), 2)


def _near(bodies: Records, primitives: Records, contacts: Records, pairs: Records) -> np.ndarray:
    """The contacts that can ever touch, by pair of bodies."""
    found = [np.zeros(0, np.int64)]
    count = 0
    for pair in pairs:
        ids = np.flatnonzero(reachable(bodies, primitives, contacts, pair)) + pair.start
        pair.near_start, pair.near_stop = count, count + len(ids)
        count += len(ids)
        found.append(ids)
    return np.concatenate(found)
