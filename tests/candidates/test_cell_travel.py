"""How far can primitives get within a cell, and which pairs can ever touch? Against dense points."""

import functools
import itertools
import math
from dataclasses import replace
from itertools import islice
from unittest.mock import patch

import numpy as np
import pytest
from every_time import few
from pair_scenes import ARRANGEMENTS, DEGREES, body_pose, carried_scene, outline, places, two_bodies
from true_contacts import touches

from watchsim.contact import cells as cell_grid
from watchsim.contact.broad_phase import PairSearch, Regions
from watchsim.contact.cell_frames import CellMotion
from watchsim.geometry.loops import Loop
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import ARC, CORNER, FULL, LINE
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Geared, Scene

# How far can a primitive get from where it is drawn, while the cell coordinates of two bodies change a little?

Pose = tuple[float, float, float]
NONE = np.zeros(0, np.int64)
PAIRS = [("pivot", "pivot"), ("pivot", "fixed"), ("slide", "slide"), ("free", "fixed"), ("fixed", "free")]


def block(name: str) -> tuple[Loop, ...]:
    return (outline(1.0, (0.2, 0.1)),) if name != "a" else (outline(0.35, (0.1, -0.15)),)


@functools.cache
def made(*given: str | bool | float) -> tuple[Scene, Compiled]:
    """Two bodies of these motions, or what is carried in that arrangement (body a geared, so many times as
    fast, to its carriage or to another body), with cells however few contacts there are."""
    with patch.object(cell_grid, "FEW_CONTACTS", 0):
        if len(given) == 2:
            return two_bodies.__wrapped__(*given)
        scene, compiled = carried_scene(*given[:3], block, (0.25, 0.1))
        if len(given) == 3:
            return scene, compiled
        drive = Body("drive", "pivot", (9.0, 9.0), inertia=1.0)
        bodies = [replace(one, geared=Geared(given[4], given[3])) if one.name == "a" else one for one in (*scene.bodies, drive)]
        scene = replace(scene, bodies=tuple(bodies))
        return scene, compile_scene(scene)


GEARED = [
    ("pivot", partner, False, ratio, to)
    for partner in ("beside", "carrier", "part", "fixed")
    for ratio, to in ((2.5, "carriage"), (-0.4, "carriage"), (-0.4, "drive"))
]
CASES = [one for one in (*PAIRS, *ARRANGEMENTS, *GEARED) if made(*one)[1].model.pairs[0].axes > 0]
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: "-".join(map(str, case)))


def poses(scene: Scene, compiled: Compiled, q: np.ndarray) -> list[Pose]:
    """Of the bodies, in the order of the model's pair, with none of the package's candidates."""
    pair, names = compiled.model.pairs[0], [body.name for body in scene.bodies]
    if any(body.on for body in scene.bodies):
        where = places(scene, compiled, q)
        for body in scene.bodies:
            if body.geared and body.geared.to != body.on:  # what does not carry it turns it in the movement
                (x, y, turn), carrier = where[body.name], where[str(body.on)]
                where[body.name] = x, y, turn - carrier[2]
        return [where[names[b]] for b in (pair.a, pair.b)]
    return [body_pose(scene, names[b], q) for b in (pair.a, pair.b)]


def coordinates(compiled: Compiled, at: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Coordinates whose cell coordinates are `at`; the others as in `rest`."""
    q, pair = rest.copy(), compiled.model.pairs[0]
    for i in sorted(range(pair.axes), key=lambda i: int(pair[f"on{i}"])):  # first those that are told by themselves
        on = int(pair[f"on{i}"])
        q[pair[f"c{i}"]] = at[i] + (q[on] if on >= 0 else 0.0)
    return q


def curve(row: np.record) -> np.ndarray:
    """Dense points of a primitive, as complex numbers."""
    start = complex(row.x, row.y)
    if row.kind == CORNER:
        return np.array([start])
    if row.kind == LINE:
        return start + np.linspace(0.0, row.length, 9) * complex(row.tx, row.ty)
    half = math.pi if row.extent == FULL else math.atan2(row.half_sin, row.half_cos)
    middle = math.atan2(row.side * row.ny, row.side * row.nx)
    return start + row.radius * np.exp(1j * (middle + np.linspace(-half, half, 1281)))


def seen(points: np.ndarray, mover: Pose, other: Pose) -> np.ndarray:
    """Points of one body in the frame of the other."""
    world = complex(*mover[:2]) + np.exp(1j * mover[2]) * points
    return (world - complex(*other[:2])) * np.exp(-1j * other[2])


def from_chords(points: np.ndarray, chain: np.ndarray) -> float:
    """The largest distance of points from a chain of straight pieces, or from its only point."""
    if len(chain) == 1:
        return float(np.abs(points - chain[0]).max())
    start, way = chain[:-1], np.diff(chain)
    share = np.clip(((points[:, None] - start) * way.conj()).real / np.abs(way) ** 2, 0.0, 1.0)
    return float(np.abs(points[:, None] - start - share * way).min(axis=1).max())


def changes(axes: int, rng: np.random.Generator) -> list[np.ndarray]:
    """How far coordinates may change: not at all, one alone, all at once."""
    return [np.zeros(axes), *(1e-3 * np.eye(axes)), rng.uniform(1e-4, 1e-2, axes)]


@each_case
def test_no_point_gets_farther_than_promised_and_some_get_as_far(case: tuple[str | bool | float, ...]) -> None:
    scene, compiled = made(*case)
    model, rng, pair = compiled.model, np.random.default_rng(3), compiled.model.pairs[0]
    search, n = PairSearch(model, 0, NONE), len(compiled.q)
    mover = search._bodies[0]
    near = model.near[pair.near_start : pair.near_stop]
    used = np.unique([model.contacts.a[near], model.contacts.b[near]])
    rows = model.primitives[used[model.primitives.body[used] == mover]]
    order = [0, 1] if mover == pair.a else [1, 0]
    for room in changes(int(pair.axes), rng):
        at, rest = rng.uniform(-3.0, 3.0, pair.axes), rng.uniform(-3.0, 3.0, n)
        points, distance = search._seen(at[None], room, np.arange(len(rows)))
        chains = [part @ (1.0, 1.0j) for part in np.split(points[0], search._drawn.first[1:-1])]
        promised, met = distance[0] - pair.clearance, np.zeros(len(rows))
        for _ in range(6):
            q = coordinates(compiled, at + room * rng.choice([-1.0, 1.0], len(room)), rest)
            both = poses(scene, compiled, q)
            one, other = (both[i] for i in order)
            met = np.maximum(met, [from_chords(seen(curve(row), one, other), c) for row, c in zip(rows, chains, strict=True)])
        assert np.all(met <= promised + 1e-12)
        if np.count_nonzero(room) == 0:
            assert met[rows.kind == ARC] == pytest.approx(promised[rows.kind == ARC], rel=1e-2)
            assert np.all(promised[rows.kind == ARC] > 0.0)
        elif np.count_nonzero(room) == 1:
            corners = rows.kind == CORNER
            assert met[corners] == pytest.approx(promised[corners], rel=2e-3, abs=1e-12)


@each_case
def test_bodies_are_where_they_are_and_move_as_far_as_they_may(case: tuple[str | bool | float, ...]) -> None:
    """One body as seen from the other, and for each coordinate alone how far origins move and by how much bodies turn."""
    scene, compiled = made(*case)
    pair, rng = compiled.model.pairs[0], np.random.default_rng(5)
    motion, bodies = CellMotion(compiled.model.bodies, pair), (int(pair.a), int(pair.b))
    for room in changes(int(pair.axes), rng)[1:-1]:
        at, rest = rng.uniform(-3.0, 3.0, pair.axes), rng.uniform(-3.0, 3.0, len(compiled.q))
        here, there = ([tuple(float(v[0]) for v in motion.pose(b, x[None])) for b in bodies] for x in (at, at + room))
        a, b = poses(scene, compiled, coordinates(compiled, at, rest))
        grid = np.array([0.3 + 0.1j, -0.7j])
        assert seen(grid, *here) == pytest.approx(seen(grid, a, b), abs=1e-13)
        for body, old, new in zip(bodies, here, there, strict=True):
            shift, turn = motion.freedom(body, room)
            assert (shift, turn) == pytest.approx((math.dist(old[:2], new[:2]), abs(new[2] - old[2])), rel=1e-3, abs=1e-15)


UNDRIVEN = [one for one in CASES if one[-1] != "drive"]


@pytest.mark.parametrize("case", few(UNDRIVEN, 6), ids=lambda case: "-".join(map(str, case)))
def test_no_contact_that_touches_within_reach_is_taken_for_impossible(case: tuple[str | bool | float, ...]) -> None:
    """From a pose where it touches the cell coordinates are changed a little or a lot, and may change by so much."""
    scene, compiled = made(*case)
    model, pair, rng = compiled.model, compiled.model.pairs[0], np.random.default_rng(8)
    regions, met = Regions(model, 0), 0
    starts = (rng.uniform(-1.0, 1.0, len(compiled.q)) for _ in range(8))
    for k, q in islice(touches(scene, compiled, rng, starts), 6):
        there = [q[pair[f"c{i}"]] - (q[pair[f"on{i}"]] if pair[f"on{i}"] >= 0 else 0.0) for i in range(pair.axes)]
        for size in (1e-3, 0.03, 0.3, 1.0):
            room = size * rng.uniform(0.1, 1.0, len(there))
            at = np.array(there) + room * rng.choice([-1.0, 1.0], len(there))
            assert regions.possible(np.zeros(1, int), np.array([k - pair.start]), at[None], room).all()
        met += 1
    assert met > 0 or case != ("free", "fixed")


def test_every_motion_is_among_the_cases() -> None:
    assert {motion for pair in PAIRS for motion in pair} == set(DEGREES)
    assert set(PAIRS) < set(CASES) and len(CASES) >= len(PAIRS) + 5
    assert {one[1] for one in CASES if len(one) == 5} >= {"carrier", "part"}


# Are the pairs that can ever touch those whose dense points can come that near, and hardly any others?

Span = tuple[float, float]
AXIS = (math.cos(0.7), math.sin(0.7))


def two(
    motion_a: str, motion_b: str, away: float, size: float, axis: tuple[float, float] = AXIS, unit: float = 1.0
) -> tuple[Scene, Compiled]:
    """Bodies whose outlines lie beside their origins; lengths in `unit` m."""
    one, other = outline(unit, (0.6 * unit, 0.3 * unit)), outline(size * unit, (0.1 * unit, -0.2 * unit))
    at = (0.3 * unit, -0.2 * unit), ((0.3 + away) * unit, 0.1 * unit)
    a = Body("a", motion_a, at[0], 0.4, axis=AXIS, mass=1.0, inertia=1.0, loops=(one,))
    b = Body("b", motion_b, at[1], 0.5, axis=axis, mass=1.0, inertia=1.0, loops=(other,))
    scene = Scene("reach", (a, b), contacts=(Contact((Side("a"), Side("b"))),))
    return scene, compile_scene(scene)


def found(compiled: Compiled) -> set[int]:
    pair = compiled.model.pairs[0]
    return set(compiled.model.near[pair.near_start : pair.near_stop].tolist())


def compare(compiled: Compiled, apart: dict[tuple[int, int], float], some: bool = True) -> None:
    """`apart`: the least distance of two primitives at any coordinates. Twice the clearance is more than chords may stray."""
    contacts, room = compiled.model.contacts, float(compiled.model.pairs[0].clearance)
    least = np.array([apart[min(a, b), max(a, b)] for a, b in zip(contacts.a.tolist(), contacts.b.tolist(), strict=True)])
    near = found(compiled)
    assert set(np.flatnonzero(least < room).tolist()) <= near
    assert near <= set(np.flatnonzero(least < 3.0 * room).tolist())
    assert not some or 0 < len(near) < len(contacts)


def dense(compiled: Compiled) -> list[np.ndarray]:
    """Many points of each primitive in its body's frame."""
    rows = compiled.model.primitives
    return [
        complex(row.x, row.y) + np.linspace(0.0, row.length, 800) * complex(row.tx, row.ty) if row.kind == LINE else curve(row)
        for row in rows
    ]


def between(one: Span, other: Span) -> float:
    """How far two ranges are apart."""
    return max(0.0, one[0] - other[1], other[0] - one[1])


def span(values: np.ndarray) -> Span:
    return float(values.min()), float(values.max())


def world(body: Body, points: np.ndarray) -> np.ndarray:
    return complex(*body.position) + np.exp(1j * body.angle) * points


def sides(compiled: Compiled, names: tuple[str, str] = ("a", "b")) -> list[tuple[int, int]]:
    """Every pair of primitives of the two bodies."""
    own = [[i for i, owner in enumerate(compiled.owners) if owner == name] for name in names]
    return list(itertools.product(*own))


@pytest.mark.parametrize(("away", "size"), [(1.05, 0.35), (0.1, 0.35), (0.8, 1.6), (0.15, 2.4)])
@pytest.mark.parametrize("first", ["pivot", "fixed"])
@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_bodies_that_turn_in_the_movement(unit: float, first: str, away: float, size: float) -> None:
    """Circles about pivots: beside each other, one within the other either way; or one about its pivot, and points at rest."""
    scene, compiled = two(first, "pivot", away, size, AXIS, unit)
    points = dense(compiled)
    a, b = (complex(*body.position) for body in scene.bodies)
    apart = {}
    for i, k in sides(compiled):
        other = span(np.abs(points[k]))
        if first == "fixed":
            apart[i, k] = between(span(np.abs(world(scene.bodies[0], points[i]) - b)), other)
            continue
        own, distance = span(np.abs(points[i])), abs(b - a)
        apart[i, k] = max(0.0, distance - own[1] - other[1], own[0] - distance - other[1], other[0] - distance - own[1])
    compare(compiled, apart)


@pytest.mark.parametrize("away", [0.7, 0.9])
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_a_body_that_turns_and_one_that_slides_past(unit: float, away: float, swapped: bool) -> None:
    given = ("slide", "pivot", away, 0.5, AXIS) if swapped else ("pivot", "slide", away, 0.5, (0.0, 1.0))
    scene, compiled = two(*given, unit)
    points = dense(compiled)
    slider, turner = scene.bodies if swapped else scene.bodies[::-1]
    across = 1j * complex(*slider.axis)
    apart = {}
    for i, k in sides(compiled):
        own, other = (i, k) if swapped else (k, i)
        offset = ((world(slider, points[own]) - complex(*turner.position)) * across.conjugate()).real
        far = float(np.abs(points[other]).max())
        apart[i, k] = between(span(offset), (-far, far))
    compare(compiled, apart)


@pytest.mark.parametrize(("first", "second"), [("slide", "slide"), ("slide", "fixed"), ("fixed", "slide")])
@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_bodies_that_slide_side_by_side(unit: float, first: str, second: str) -> None:
    scene, compiled = two(first, second, 0.5, 0.8, AXIS, unit)
    points, across = dense(compiled), 1j * complex(*AXIS)
    offsets = [
        span((world(scene.body(owner), own) * across.conjugate()).real)
        for owner, own in zip(compiled.owners, points, strict=True)
    ]
    compare(compiled, {(i, k): between(offsets[i], offsets[k]) for i, k in sides(compiled)})


@pytest.mark.parametrize(("first", "second"), [("free", "fixed"), ("free", "pivot"), ("slide", "free")])
def test_of_a_free_body_nothing_is_known(first: str, second: str) -> None:
    compiled = two(first, second, 5.0, 0.5)[1]
    assert len(found(compiled)) == len(compiled.model.contacts)


def test_bodies_that_slide_across_each_other_meet_somewhere() -> None:
    compiled = two("slide", "slide", 5.0, 0.5, (0.0, 1.0))[1]
    assert len(found(compiled)) == len(compiled.model.contacts)


@pytest.mark.parametrize("arm", [(0.25, 0.1), (0.9, 0.4), (1.6, -0.4)])
@pytest.mark.parametrize("partner", ["fixed", "pivot", "beside", "carrier"])
def test_what_is_carried_round_a_pivot_covers_a_ring(partner: str, arm: tuple[float, float]) -> None:
    """About the carriage's pivot at (0.3, -0.2); from the carriage, and what stands on it, it is seen to turn about `arm`."""

    def shape(name: str) -> tuple[Loop, ...]:
        return (outline(0.35, (0.15, -0.1)),) if name == "a" else (outline(1.5, (0.4, 0.2)),)

    scene, compiled = carried_scene("pivot", partner, False, shape, arm)
    points, met = dense(compiled), {"carrier": "carriage"}.get(partner, "b")
    other, hub, centre = scene.body(met), complex(*arm), complex(0.3, -0.2)
    apart = {}
    for i, k in sides(compiled, ("a", met)):
        away = np.abs(points[i])
        ring = float(np.abs(abs(hub) - away).min()), float((abs(hub) + away).max())
        if np.ptp(abs(hub) - away) > 0.0 and (abs(hub) - away).min() < 0.0 < (abs(hub) - away).max():
            ring = 0.0, ring[1]
        if partner == "fixed":
            apart[i, k] = between(ring, span(np.abs(world(other, points[k]) - centre)))
        elif partner == "pivot":
            own, distance = span(np.abs(points[k])), abs(complex(*other.position) - centre)
            apart[i, k] = max(0.0, distance - own[1] - ring[1], own[0] - distance - ring[1], ring[0] - distance - own[1])
        elif partner == "carrier":
            apart[i, k] = between(span(away), span(np.abs(points[k] - hub)))
        else:
            own, distance = span(np.abs(points[k])), abs(complex(*other.position) - hub)
            apart[i, k] = max(0.0, distance - own[1] - span(away)[1], own[0] - distance - span(away)[1])
            apart[i, k] = max(apart[i, k], span(away)[0] - distance - own[1])
    compare(compiled, apart, some=False)
    assert len(found(compiled)) > 0 or arm == (1.6, -0.4)


@pytest.mark.parametrize("carrier", ["slide", "free"])
@pytest.mark.parametrize("partner", ["fixed", "pivot", "slide"])
def test_what_a_slide_or_a_free_body_carries_can_get_anywhere(carrier: str, partner: str) -> None:
    compiled = carried_scene(carrier, partner, False, lambda _: (outline(0.1),), (9.0, 0.4))[1]
    assert len(found(compiled)) == len(compiled.model.contacts)


@pytest.mark.parametrize("partner", ["fixed", "pivot", "slide", "other"])
@pytest.mark.parametrize("carrier", ["pivot", "slide", "free"])
def test_the_order_of_bodies_does_not_matter(carrier: str, partner: str) -> None:
    """The carriage may be the first of all or the last."""
    scene, _ = carried_scene(carrier, partner, False, lambda name: (outline(0.3 if name == "a" else 0.1),), (0.2, 0.1))
    found = set()
    for first in (0, 1, 2):
        model = compile_scene(replace(scene, bodies=(*scene.bodies[first:], *scene.bodies[:first]))).model
        at = model.primitives.px + 1j * model.primitives.py
        found.add(frozenset(frozenset(at[[model.contacts.a[k], model.contacts.b[k]]].tolist()) for k in model.near))
    assert len(found) == 1
