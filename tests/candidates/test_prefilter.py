"""Does the prefilter ever lose a pair? Random toothed wheels, with and without spokes, against random blocks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from true_contacts import touches

from watchsim.candidates.cell_lookup import candidate, candidates
from watchsim.candidates.cell_table import CellFinder
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

_candidates, _candidate = callable_kernel(candidates), callable_kernel(candidate)


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


def listed(compiled: Compiled, q: np.ndarray) -> set[int]:
    """The candidates at q; the cell is asked about."""
    cells = CellFinder(compiled.model).learn(0, q) if compiled.model.pairs[0].listed else CellFinder(compiled.model).cells
    how, start, count = _candidates(compiled.model, cells, 0, q)
    assert how >= 0
    return {int(_candidate(compiled.model, cells, how, place)) for place in range(start, start + count)}


BARS = st.tuples(st.floats(0.1, 0.8), st.floats(0.01, 0.2), st.floats(-0.3, 0.3))


@pytest.mark.slow
@settings(max_examples=20)
@given(
    st.sampled_from([3, 12, 15, 30]),
    st.sampled_from([0, 4, 5]),
    BARS,
    st.sampled_from(["pivot", "slide", "fixed", "free"]),
    st.floats(0.6, 2.2),
    st.lists(st.tuples(st.floats(-10.0, 10.0), st.floats(-7.0, 7.0)), min_size=4, max_size=4),
)
def test_no_touching_pair_is_lost(
    teeth: int, spokes: int, bar: tuple[float, float, float], motion: str, distance: float, poses: list[tuple[float, float]]
) -> None:
    scene, compiled = scene_of(teeth, spokes, bar, motion, distance)
    starts = (np.array([pose[0], 0.3 * pose[1], 0.2 * pose[0], pose[1]])[: len(compiled.model.coordinates)] for pose in poses)
    for k, q in touches(scene, compiled, np.random.default_rng(1), starts):
        assert k in compiled.model.near
        assert k in listed(compiled, q)


def test_the_teeth_are_shared_and_the_spokes_are_not() -> None:
    """Asked about one block of cells, the table holds all fifteen parts of a turn; a spoke is found where it is."""
    scene, compiled = scene_of(15, 4, (0.8, 0.05, 0.0), "pivot", 1.2)
    pair = compiled.model.pairs[0]
    assert pair.fold0 == 15 and pair.wrap0 % 15 == 0
    finder = CellFinder(compiled.model)
    finder.learn(0, np.array([0.1, 0.2]))
    assert finder.number >= 14 * max(finder.learned, 1)
    rng, met = np.random.default_rng(1), 0
    holes = set(np.flatnonzero(compiled.model.primitives.extent > 0).tolist())
    for k, q in touches(scene, compiled, rng, (rng.uniform(-4.0, 4.0, 2) for _ in range(100))):
        met += int(compiled.model.contacts[k].b) in holes
        assert k in listed(compiled, q)
    assert met > 5


@pytest.mark.parametrize(("distance", "some"), [(1.9, True), (2.7, False)])
def test_what_cannot_be_reached_is_no_candidate(distance: float, some: bool) -> None:
    _, compiled = scene_of(12, 0, (0.8, 0.05, 0.0), "pivot", distance)
    assert (len(compiled.model.near) > 0) == some
    assert len(compiled.model.near) < len(compiled.model.contacts)
