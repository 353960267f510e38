"""Does the prefilter ever lose a pair? Random toothed wheels, with and without spokes, against random blocks."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from watchsim.contact.cells import CellFinder
from watchsim.contact.lookup import candidate, candidates
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.jit import callable_kernel
from watchsim.mechanism.body import Body
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.mechanism.force import Contact, Side
from watchsim.mechanism.model import ARC, LINE
from watchsim.mechanism.scene import Scene

_candidates, _candidate = callable_kernel(candidates), callable_kernel(candidate)
CHORDS = 64


def wheel(teeth: int, spokes: int) -> tuple[Loop, ...]:
    """Saw teeth of radius 1 and round spoke holes."""
    step = 2.0 * math.pi / teeth
    root = 0.75
    edges: list[Edge] = []
    for k in range(teeth):
        flank = Line(root, 0.0, 1.0, 0.02)
        back = Line(1.0, 0.02, root * math.cos(step), root * math.sin(step))
        edges += [moved(flank, k * step, (0.0, 0.0)), moved(back, k * step, (0.0, 0.0))]
    turns = [2.0 * math.pi * k / spokes + 0.3 for k in range(spokes)]
    holes = (Arc(0.5 * math.cos(a), 0.5 * math.sin(a), 0.15, 0.0, -2.0 * math.pi) for a in turns)
    return Loop(tuple(edges)), *(Loop((hole,), hole=True) for hole in holes)


def block(width: float, nose: float, offset: float) -> Loop:
    """A bar with a round nose, `offset` beside its pivot."""
    x, y = offset, -0.3
    arc = Arc(x, y - width, nose, -math.pi, math.pi)
    return Loop(
        (arc, Line(x + nose, y - width, x + nose, y), Line(x + nose, y, x - nose, y), Line(x - nose, y, x - nose, y - width))
    )


def scene_of(teeth: int, spokes: int, bar: tuple[float, float, float], motion: str, distance: float) -> tuple[Scene, Compiled]:
    axis = (0.6, 0.8)
    bodies = (
        Body("wheel", "pivot", (0.1, -0.2), 0.0, inertia=1.0, loops=wheel(teeth, spokes)),
        Body("bar", motion, (0.1, distance), 0.4, axis=axis, mass=1.0, inertia=1.0, loops=(block(*bar),)),
    )
    scene = Scene("prefilter", bodies, contacts=(Contact((Side("wheel"), Side("bar"))),))
    return scene, compile_scene(scene)


def drawn(compiled: Compiled, q: np.ndarray) -> list[shapely.Geometry]:
    """Every primitive where it is at q, straight from its record: a point, a line, or many chords."""
    found = []
    for p in compiled.model.primitives:
        body = compiled.model.bodies[p.body]
        x, y, angle = body.x, body.y, body.angle
        if body.motion == 1:
            angle = q[body.first]
        elif body.motion == 2:
            x, y = x + q[body.first] * body.axis_x, y + q[body.first] * body.axis_y
        local = [(p.x, p.y)]
        if p.kind == LINE:
            local.append((p.x + p.length * p.tx, p.y + p.length * p.ty))
        elif p.kind == ARC:
            half = math.pi if p.extent else math.atan2(p.half_sin, p.half_cos)
            middle = math.atan2(p.side * p.ny, p.side * p.nx)
            angles = middle + half * np.linspace(-1.0, 1.0, CHORDS + 1)
            local = [(p.x + p.radius * math.cos(a), p.y + p.radius * math.sin(a)) for a in angles]
        c, s = math.cos(angle), math.sin(angle)
        points = [(x + c * X - s * Y, y + s * X + c * Y) for X, Y in local]
        found.append(shapely.Point(points[0]) if len(points) == 1 else shapely.LineString(points))
    return found


def touching(compiled: Compiled, q: np.ndarray) -> set[int]:
    """Contacts whose curves come closer than any tolerance of a run."""
    shapes, contacts = drawn(compiled, q), compiled.model.contacts
    a, b = np.array([shapes[i] for i in contacts.a]), np.array([shapes[i] for i in contacts.b])
    return set(np.flatnonzero(shapely.distance(a, b) < 1e-4).tolist())


def listed(compiled: Compiled, q: np.ndarray) -> set[int]:
    """The candidates at q; the cell is asked about."""
    cells = CellFinder(compiled.model).learn(0, q) if compiled.model.pairs[0].listed else CellFinder(compiled.model).cells
    how, start, count = _candidates(compiled.model, cells, 0, q)
    assert how >= 0
    return {int(_candidate(compiled.model, cells, how, place)) for place in range(start, start + count)}


BARS = st.tuples(st.floats(0.1, 0.8), st.floats(0.01, 0.2), st.floats(-0.3, 0.3))


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from([3, 12, 15, 30]),
    st.sampled_from([0, 4, 5]),
    BARS,
    st.sampled_from(["pivot", "slide", "fixed"]),
    st.floats(0.6, 2.2),
    st.lists(st.tuples(st.floats(-10.0, 10.0), st.floats(-7.0, 7.0)), min_size=4, max_size=4),
)
def test_no_touching_pair_is_lost(
    teeth: int, spokes: int, bar: tuple[float, float, float], motion: str, distance: float, poses: list[tuple[float, float]]
) -> None:
    _, compiled = scene_of(teeth, spokes, bar, motion, distance)
    for pose in poses:
        q = np.array(pose[: len(compiled.model.coordinates)])
        if motion == "slide":
            q[1] *= 0.2
        met = touching(compiled, q)
        assert met <= listed(compiled, q)
        assert met <= set(compiled.model.near.tolist())


def test_the_teeth_are_shared_and_the_spokes_are_not() -> None:
    """Asked about one block of cells, the table holds all fifteen parts of a turn; a spoke is found where it is."""
    _, compiled = scene_of(15, 4, (0.8, 0.05, 0.0), "pivot", 1.2)
    pair = compiled.model.pairs[0]
    assert pair.fold0 == 15 and pair.wrap0 % 15 == 0
    finder = CellFinder(compiled.model)
    finder.learn(0, np.array([0.1, 0.2]))
    assert finder.number >= 14 * max(finder.learned, 1)
    rng, met = np.random.default_rng(1), 0
    holes = set(np.flatnonzero(compiled.model.primitives.extent > 0).tolist())
    for _ in range(300):
        q = rng.uniform(-4.0, 4.0, 2)
        found = touching(compiled, q)
        met += sum(int(compiled.model.contacts[k].b) in holes for k in found)
        assert found <= listed(compiled, q)
    assert met > 5


@pytest.mark.parametrize(("distance", "some"), [(1.9, True), (2.7, False)])
def test_what_cannot_be_reached_is_no_candidate(distance: float, some: bool) -> None:
    _, compiled = scene_of(12, 0, (0.8, 0.05, 0.0), "pivot", distance)
    assert (len(compiled.model.near) > 0) == some
    assert len(compiled.model.near) < len(compiled.model.contacts)
