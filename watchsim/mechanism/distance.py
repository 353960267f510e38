"""How far apart are two outlines, and what are the gaps and the kinematics of their contacts?

For researchers who need the geometry without a simulation. A pose is (x, y, angle) of the outline's frame in metres and
radians, a velocity (vx, vy, ω). Outlines are closed loops with the material on their left (holes run clockwise) or open
chains, which have a side but no inside. Formulas: docs/theory/contact-geometry.md.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.edge_distance import EDGE, depth_profile, edge_records, nearest_edges, place_edges, point_on
from watchsim.contact.gaps import closed_contacts, every_contact, poses
from watchsim.geometry.loops import Loop, winding
from watchsim.geometry.primitives import GOLDEN, Edge, Point
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.model import KIND_WORD, Model, records
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.tolerances import DEEPEST_PLACE

Outline = Loop | Sequence[Loop]
Vector = tuple[float, float, float]
SAMPLES = 65  # per edge, in the search for the deepest point

CONTACT_ROW = np.dtype(
    [
        ("kind_a", "U6"),  # corner, line or arc of a
        ("kind_b", "U6"),
        ("index_a", "i8"),  # number of the primitive: the edges in order, then the convex corners
        ("index_b", "i8"),
        ("g", "f8"),  # gap, m
        ("n", "f8", 2),  # unit normal, from b's material towards a's
        ("point", "f8", 2),  # contact point, m
        ("margin", "f8"),  # how far inside both primitives the contact lies, m; negative: no contact there
        ("g_N_dot", "f8"),  # m/s
        ("g_T_dot", "f8"),  # m/s, of a against b along t, n turned by +90°
        ("w_bar_N", "f8"),  # m/s²: g_N'' at zero u'
        ("w_bar_T", "f8"),
        ("w_N", "f8", 6),  # force directions over (x, y, angle) of a, then of b
        ("w_T", "f8", 6),
    ]
)


class Distance(NamedTuple):
    """Signed distance (m) and the two points, (x, y) in the world, between which it is measured."""

    value: float
    on_a: Point
    on_b: Point


def distance(a: Outline, pose_a: Vector, b: Outline, pose_b: Vector) -> Distance:
    """The shortest distance between two outlines, exact for lines and arcs; negative where their materials overlap.

    Apart: the distance of the nearest points. Touching: 0. Overlapping: minus the depth of the deepest point of either outline
    inside the other one's material, measured to the nearest point of that outline. An open chain that is crossed gives 0.
    ValueError where an outline has no edges.
    """
    loops_a, loops_b = _loops(a), _loops(b)
    edges = [_edges(loops) for loops in (loops_a, loops_b)]
    turned = [(float(x), float(y), math.cos(angle), math.sin(angle)) for x, y, angle in (pose_a, pose_b)]
    placed = [records(EDGE, len(rows)) for rows in edges]
    near = nearest_edges(edges[0], turned[0], edges[1], turned[1], *placed)
    if near.crossing or _one_inside(loops_a, turned[0], loops_b, turned[1]):
        deepest = _deepest(loops_a, turned[0], loops_b, turned[1], placed)
        if deepest is not None:
            return deepest
    on_a, on_b = _point(placed[0][near.edge_a], near.way_a), _point(placed[1][near.edge_b], near.way_b)
    return Distance(float(near.distance), on_a, on_b)


def gap(a: Outline, pose_a: Vector, b: Outline, pose_b: Vector) -> NDArray[Any]:
    """Every pair of primitives that has a gap function, one row each; nothing moves, so all rates are 0.

    Poses are (x, y, angle), m and rad. docs/theory/contact-geometry.md lists the fields of the rows with shapes and units.
    Gaps are those of the whole line or full circle, positive outside the material: only rows with `margin` >= 0 are contacts.
    """
    return kinematics(a, pose_a, (0.0, 0.0, 0.0), b, pose_b, (0.0, 0.0, 0.0))


def kinematics(a: Outline, pose_a: Vector, velocity_a: Vector, b: Outline, pose_b: Vector, velocity_b: Vector) -> NDArray[Any]:
    """The rows of `gap` for outlines that move, with gap rates, slip, force directions and bar terms from the compiled kernels.

    Velocities are (vx, vy, omega), m/s and rad/s. With u = (velocity_a, velocity_b): g_N_dot = w_N·u, and
    g_N'' = w_N·u' + w_bar_N, likewise for T (Pfeiffer & Glocker 1996, ch. 4).
    """
    model = _model(_loops(a), _loops(b))
    count = len(model.contacts)
    closed = closed_contacts(count)
    q, u = np.array((*pose_a, *pose_b), float), np.array((*velocity_a, *velocity_b), float)
    every_contact(model, q, u, poses(2), closed)
    out = np.zeros(count, CONTACT_ROW)
    first, last = model.primitives[model.contacts.a], model.primitives[model.contacts.b]
    on_a = first.body == 0
    start = int(np.count_nonzero(model.primitives.body == 0))
    words = np.array(KIND_WORD)
    out["kind_a"], out["kind_b"] = words[np.where(on_a, first.kind, last.kind)], words[np.where(on_a, last.kind, first.kind)]
    out["index_a"] = np.where(on_a, model.contacts.a, model.contacts.b)
    out["index_b"] = np.where(on_a, model.contacts.b, model.contacts.a) - start
    kin = closed.kin
    rates = ("g_N_dot", "gN_dot"), ("g_T_dot", "gT_dot"), ("w_bar_N", "bar_N"), ("w_bar_T", "bar_T")
    for name, kernel_name in (("g", "g"), ("margin", "margin"), *rates):
        out[name] = kin[kernel_name]
    out["point"] = np.stack([kin.x, kin.y], axis=1)
    rows = np.arange(count)
    for slot in range(6):
        out["w_N"][rows, closed.coord[:, slot]] = closed.w_N[:, slot]
        out["w_T"][rows, closed.coord[:, slot]] = closed.w_T[:, slot]
    # The entries of the two origins are n and t themselves.
    out["n"] = out["w_N"][:, :2]
    return out


def _loops(outline: Outline) -> tuple[Loop, ...]:
    loops = (outline,) if isinstance(outline, Loop) else tuple(outline)
    if not any(edge.length > 0.0 for loop in loops for edge in loop.edges):
        raise ValueError("the outline has no edges")
    return loops


@functools.lru_cache(maxsize=32)
def _edges(loops: tuple[Loop, ...]) -> Any:
    edges: list[Edge] = [edge for loop in loops for edge in loop.edges]
    return edge_records(edges)


@functools.lru_cache(maxsize=32)
def _model(a: tuple[Loop, ...], b: tuple[Loop, ...]) -> Model:
    bodies = tuple(Body(name, "free", mass=1.0, inertia=1.0, loops=loops) for name, loops in (("a", a), ("b", b)))
    return compile_scene(Scene("two outlines", bodies, contacts=(Contact((Side("a"), Side("b"))),))).model


_point_on = callable_kernel(point_on)
_place_edges = callable_kernel(place_edges)


def _point(edge: Any, way: float) -> Point:
    x, y = _point_on(edge, way)
    return float(x), float(y)


Placed = tuple[float, float, float, float]


def _one_inside(a: tuple[Loop, ...], pose_a: Placed, b: tuple[Loop, ...], pose_b: Placed) -> bool:
    """Does a corner of either lie in the other's material? Outlines that cross nowhere are apart or nested."""
    for mine, at, other, there in ((a, pose_a, b, pose_b), (b, pose_b, a, pose_a)):
        for loop in mine:
            if any(_in_material(other, _into(there, _out_of(at, edge.start))) for edge in loop.edges):
                return True
    return False


def _in_material(loops: tuple[Loop, ...], p: Point) -> bool:
    """Is the point, in the outline's frame, enclosed by more outer loops than holes?"""
    return sum(winding(loop, p) for loop in loops if loop.closed) > 0


def _out_of(pose: Placed, p: Point) -> Point:
    x, y, c, s = pose
    return x + c * p[0] - s * p[1], y + s * p[0] + c * p[1]


def _into(pose: Placed, p: Point) -> Point:
    x, y, c, s = pose
    return c * (p[0] - x) + s * (p[1] - y), -s * (p[0] - x) + c * (p[1] - y)


def _deepest(a: tuple[Loop, ...], pose_a: Placed, b: tuple[Loop, ...], pose_b: Placed, placed: list[Any]) -> Distance | None:
    """The deepest point of either outline inside the other; None where neither has one inside."""
    best: Distance | None = None
    for order, (mine, others, loops, pose) in enumerate(((0, 1, b, pose_b), (1, 0, a, pose_a))):
        for row in range(len(placed[mine])):
            found = _deepest_of_edge(placed[mine], row, placed[others], loops, pose)
            if found is not None and (best is None or -found[0] < best.value):
                depth, inside, outside = found
                best = Distance(-depth, *((inside, outside) if order == 0 else (outside, inside)))
    return best


def _deepest_of_edge(edges: Any, row: int, others: Any, loops: tuple[Loop, ...], pose: Placed) -> Any:
    """(depth, the point, the nearest point of the other outline) of an edge's deepest point; None if none is inside."""

    def depths(ways: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Depth at each way, negative outside."""
        found, feet = np.zeros(len(ways)), np.zeros((len(ways), 2))
        depth_profile(edges, row, ways, others, found, feet)
        inside = [_in_material(loops, _into(pose, _point(edges[row], way))) for way in ways]
        return np.where(inside, found, -found), feet

    half = float(edges[row].half)
    ways = np.linspace(-half, half, SAMPLES)
    found, _ = depths(ways)
    top = int(np.argmax(found))
    if found[top] <= 0.0:
        return None
    low, high = ways[max(top - 1, 0)], ways[min(top + 1, SAMPLES - 1)]
    best_way, best = ways[top], found[top]
    while high - low > DEEPEST_PLACE * half:
        inner = np.array([high - GOLDEN * (high - low), low + GOLDEN * (high - low)])
        (left, right), _ = depths(inner)
        low, high = (low, inner[1]) if left >= right else (inner[0], high)
        for way, depth in zip(inner, (left, right), strict=True):
            if depth > best:
                best_way, best = way, depth
    _, feet = depths(np.array([best_way]))
    return float(best), _point(edges[row], best_way), (float(feet[0, 0]), float(feet[0, 1]))
