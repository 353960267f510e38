"""Are the pairs that can ever touch those whose dense points can come that near, and hardly any others?

Places of points at any coordinates are worked out point by point: a point of a pivoted body runs round a circle, of one that is
carried by a pivoted one it covers a ring, of a sliding one it runs along a line.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from carried_scenes import carried_scene
from pair_scenes import outline
from test_cell_travel import curve

from watchsim.geometry.loop import Loop
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model.records import LINE
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

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
