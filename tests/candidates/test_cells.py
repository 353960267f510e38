"""Does a cell's list hold every pair of primitives that touches anywhere in the cell and its margin?"""

import math
from dataclasses import replace

import numpy as np
import pytest
from every_time import few
from hypothesis import given, settings
from hypothesis import strategies as st
from pair_scenes import DEGREES, outline
from true_contacts import touches

from watchsim.contact import cells as cell_grid
from watchsim.contact.cell_lookup import (
    ALL,
    LISTED,
    MARGIN,
    REACH,
    UNKNOWN,
    candidate,
    candidates,
    cell_key,
    find_slot,
    time_in_cell,
)
from watchsim.contact.cells import CellFinder, PairCells, forget
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import Cells
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene

# Does a cell's list hold every pair of primitives that touches anywhere in the cell and its margin?

_candidates, _candidate, _time_in_cell = (callable_kernel(kernel) for kernel in (candidates, candidate, time_in_cell))

CASES = {
    "pivot-pivot": ("pivot", "pivot"),
    "pivot-fixed": ("pivot", "fixed"),
    "fixed-pivot": ("fixed", "pivot"),
    "slide-pivot": ("slide", "pivot"),
    "slide-slide": ("slide", "slide"),
    "free-fixed": ("free", "fixed"),
    "fixed-free": ("fixed", "free"),
}


@pytest.fixture(autouse=True)
def _cells_however_few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cells are chosen even where few contacts can be reached; nothing is known from other tests."""
    monkeypatch.setattr(cell_grid, "FEW_CONTACTS", 0)
    forget()


def pair(motion_a: str, motion_b: str) -> tuple[Scene, Compiled]:
    """Two bodies a few tenths of a metre apart, with 400 pairs of primitives."""
    axis = (math.cos(2.0), math.sin(2.0))
    a = Body("a", motion_a, (0.0, 0.0), 0.2, axis=(0.6, 0.8), mass=1.0, inertia=1.0, loops=(outline(1.0, (0.2, 0.1)),))
    b = Body("b", motion_b, (0.5, 0.3), -0.4, axis=axis, mass=1.0, inertia=1.0, loops=(outline(0.5, (0.1, -0.1)),))
    scene = Scene("cells", (a, b), contacts=(Contact((Side("a"), Side("b"))),))
    return scene, compile_scene(scene)


def listed(compiled: Compiled, cells: Cells, q: np.ndarray) -> tuple[int, set[int]]:
    """How the cell of q is known, and its candidates."""
    how, start, count = _candidates(compiled.model, cells, 0, q)
    return how, {int(_candidate(compiled.model, cells, how, place)) for place in range(start, start + count)}


def cell_near(compiled: Compiled, q: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The middle of a random cell that holds q, itself or in its margin."""
    row = compiled.model.pairs[0]
    there = q.copy()
    for axis in range(row.axes):
        i, size = row[f"c{axis}"], row[f"size{axis}"]
        place = q[i] / size
        held = [n for n in range(math.floor(place) - 1, math.floor(place) + 2) if -MARGIN <= place - n <= 1.0 + MARGIN]
        there[i] = (rng.choice(held) + 0.5) * size
    return there


def random_q(scene: Scene, rng: np.random.Generator) -> np.ndarray:
    """Poses in which the bodies are often near one another; angles of several turns."""
    q = []
    for body in scene.bodies:
        spread = {"pivot": [20.0], "slide": [0.6], "free": [0.5, 0.5, 20.0], "fixed": []}[body.motion]
        q += [rng.uniform(-s, s) for s in spread]
    return np.array(q)


@pytest.mark.parametrize("poses", [15, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", few(CASES, 4))
def test_no_touching_pair_is_lost(name: str, poses: int) -> None:
    scene, compiled = pair(*CASES[name])
    finder, rng = CellFinder(compiled.model), np.random.default_rng(7)
    assert compiled.model.pairs[0].axes == sum(DEGREES[motion] for motion in CASES[name])
    met: list[int] = []
    for k, q in touches(scene, compiled, rng, (random_q(scene, rng) for _ in range(poses))):
        middle = cell_near(compiled, q, rng)
        how, ids = listed(compiled, finder.learn(0, middle), middle)
        assert how == LISTED and k in ids
        met.append(k)
    kinds = {(int(p.kind), int(o.kind)) for p, o in (sides(compiled, k) for k in met)}
    assert len(met) > poses // 5 and (len(kinds) >= 2 or "free" not in name)
    # The lists are worth having: far shorter than all pairs.
    lengths = [len(listed(compiled, finder.learn(0, q), q)[1]) for q in (random_q(scene, rng) for _ in range(25))]
    assert np.mean(lengths) < 0.1 * len(compiled.model.contacts)


def sides(compiled: Compiled, k: int) -> tuple[np.record, np.record]:
    """The two primitives of a contact."""
    contact = compiled.model.contacts[k]
    return compiled.model.primitives[contact.a], compiled.model.primitives[contact.b]


@pytest.mark.parametrize("name", ["pivot-pivot", "slide-pivot", "free-fixed"])
def test_candidates_stay_complete_for_the_promised_time(name: str) -> None:
    """No motion with the given speeds and accelerations leaves the cell's margin before `time_in_cell`."""
    scene, compiled = pair(*CASES[name])
    row, rng = compiled.model.pairs[0], np.random.default_rng(11)
    poses = [q for q in (random_q(scene, rng) for _ in range(150)) if not_apart(compiled, q)]
    assert len(poses) > 50
    for q in poses:
        u, a = rng.normal(size=len(q)), np.abs(rng.normal(size=len(q))) * rng.choice([0.0, 1.0, 100.0])
        time = _time_in_cell(compiled.model, 0, q, u, a)
        assert time > 0.0
        for axis in range(row.axes):
            i, size = row[f"c{axis}"], row[f"size{axis}"]
            travel = abs(u[i]) * time + 0.5 * a[i] * time**2
            low = math.floor(q[i] / size) * size
            assert travel <= (min(q[i] - low, low + size - q[i]) + MARGIN * size) * (1.0 + 1e-9)


def test_everything_learned_is_found_again() -> None:
    """Many cells, negative indices and several turns included; a turn later it is the same cell."""
    scene, compiled = pair("pivot", "pivot")
    finder, rng = CellFinder(compiled.model), np.random.default_rng(5)
    asked = [random_q(scene, rng) for _ in range(30)]
    assert listed(compiled, finder.cells, asked[0])[0] == UNKNOWN
    for q in asked:
        cells = finder.learn(0, q)
    for q in asked:
        how, ids = listed(compiled, cells, q)
        alone = CellFinder(compiled.model)
        assert how == LISTED
        assert ids == listed(compiled, alone.learn(0, q), q)[1]
        assert listed(compiled, cells, q + np.array([2.0, -4.0]) * math.pi)[1] == ids
    keys = cells.keys[cells.keys >= 0]
    assert len(keys) == len(set(keys.tolist())) > 1000
    assert all(cells.keys[find_slot(cells.keys, key)] == key for key in keys)


def test_keys_of_different_cells_differ() -> None:
    compiled = pair("free", "fixed")[1]
    row, rng = compiled.model.pairs[0], np.random.default_rng(2)
    size = np.array([row.size0, row.size1, row.size2])
    index = rng.integers(-300, 300, size=(2000, 3))
    keys = [int(cell_key(compiled.model, 0, (place + 0.5) * size)) for place in index]
    same = {(int(x), int(y), int(turn) % int(row.wrap2)) for x, y, turn in index}
    assert len(set(keys)) == len(same)
    assert min(keys) >= 0


def test_the_candidates_here_are_those_of_the_cell() -> None:
    scene, compiled = pair("pivot", "pivot")
    finder, rng = CellFinder(compiled.model), np.random.default_rng(13)
    found = 0
    for q in (random_q(scene, rng) for _ in range(10)):
        here = set(PairCells(compiled.model, 0).here(q).tolist())
        assert here == listed(compiled, finder.learn(0, q), q)[1]
        found += len(here)
    assert found > 0


def not_apart(compiled: Compiled, q: np.ndarray) -> bool:
    """Does the pair need a cell at q?"""
    return listed(compiled, CellFinder(compiled.model).cells, q)[0] != ALL


def test_bodies_apart_do_not_meet_in_the_promised_time() -> None:
    """However they move with the given speeds and accelerations, the outlines' circles about the origins stay apart."""
    scene, compiled = pair("free", "fixed")
    rng = np.random.default_rng(3)
    reach = [max(math.hypot(*edge.point(f / 16.0)) for edge in body.loops[0].edges for f in range(17)) for body in scene.bodies]
    met = 0
    for _ in range(300):
        q = random_q(scene, rng) * (6.0, 6.0, 1.0)
        if not_apart(compiled, q):
            continue
        met += 1
        u, a = rng.normal(size=3), np.abs(rng.normal(size=3)) * rng.choice([0.0, 1.0, 100.0])
        time = _time_in_cell(compiled.model, 0, q, u, a)
        assert time > 0.0
        far = math.dist(q[:2], scene.bodies[1].position) - sum(reach)
        assert math.hypot(*u[:2]) * time + 0.5 * math.hypot(*a[:2]) * time**2 <= far
    assert met > 100


def test_far_away_every_pair_is_a_candidate() -> None:
    """Beyond the range of keys, of bodies that have slid there together."""
    slides = pair("slide", "slide")[0]
    both = tuple(replace(body, axis=(0.6, 0.8)) for body in slides.bodies)
    compiled = compile_scene(replace(slides, bodies=both))
    way = 1.5 * REACH * compiled.model.pairs[0].size0
    q = np.array([way, way])
    assert cell_key(compiled.model, 0, q) == -1
    how, ids = listed(compiled, CellFinder(compiled.model).cells, q)
    assert how == ALL
    assert len(ids) == len(compiled.model.near) > 0


def test_apart_nothing_is_a_candidate() -> None:
    compiled = pair("free", "fixed")[1]
    assert listed(compiled, CellFinder(compiled.model).cells, np.array([10.0, 0.0, 0.0])) == (ALL, set())


def table_of(cells: Cells) -> dict[int, list[int]]:
    """The candidates of each cell in a table, by key."""
    taken = np.flatnonzero(cells.keys >= 0)
    return {int(cells.keys[i]): cells.entries[cells.start[i] : cells.start[i] + cells.count[i]].tolist() for i in taken}


def test_cells_learnt_bit_by_bit_are_the_same() -> None:
    """Blocks of cells that share some with earlier ones, in any order: each cell once, with the same candidates."""
    model = pair("pivot", "pivot")[1].model
    places = [np.array([0.2 + 0.05 * k, 0.1 * k]) for k in range(5)]
    tables = []
    for order in (places, places[::-1]):
        forget()
        finder = CellFinder(model)
        for q in order:
            finder.learn(0, q)
        tables.append(table_of(finder.cells))
        assert finder.number == len(tables[-1])
        # All that another run has learnt is there from the start.
        assert table_of(CellFinder(model).cells) == tables[-1]
    assert tables[0] == tables[1]
    assert all(sorted(set(found)) == found for found in tables[0].values()) and any(tables[0].values())
    alone = {}
    for q in places:
        keys, count, found = PairCells(model, 0).around(q)
        parts = np.split(found, np.cumsum(count)[:-1])
        alone |= {int(key): part.tolist() for key, part in zip(keys, parts, strict=True)}
    assert alone == tables[0]


@pytest.mark.parametrize("u", [(1.0, 0.0), (-3.0, 3.0), (0.2, -5.0), (0.0, 0.0), (math.inf, 1.0)])
def test_the_cells_ahead_are_learned_with_the_one_asked_about(u: tuple[float, float]) -> None:
    """The same candidates as asked for one by one, and fewer questions on the way that the bodies move."""
    _, compiled = pair("pivot", "pivot")
    finder, row = CellFinder(compiled.model), compiled.model.pairs[0]
    q, pace = np.array([0.1, 0.2]), np.array(u) / np.array([row.size0, row.size1])
    cells = finder.learn(0, q, np.array(u))
    assert listed(compiled, cells, q)[0] == LISTED
    fastest = np.abs(pace).max()
    for step in range(11) if 0.0 < fastest < math.inf else ():
        there = q + step / fastest * np.array(u)
        how, ids = listed(compiled, cells, there)
        assert how == LISTED
        assert ids == listed(compiled, CellFinder(compiled.model).learn(0, there), there)[1]


# Does the prefilter ever lose a pair? Random toothed wheels, with and without spokes, against random blocks.

_candidates_prefilter, _candidate_prefilter = callable_kernel(candidates), callable_kernel(candidate)


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


def listed_prefilter(compiled: Compiled, q: np.ndarray) -> set[int]:
    """The candidates at q; the cell is asked about."""
    cells = CellFinder(compiled.model).learn(0, q) if compiled.model.pairs[0].listed else CellFinder(compiled.model).cells
    how, start, count = _candidates_prefilter(compiled.model, cells, 0, q)
    assert how >= 0
    return {int(_candidate_prefilter(compiled.model, cells, how, place)) for place in range(start, start + count)}


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
def test_no_touching_pair_is_lost_prefilter(
    teeth: int, spokes: int, bar: tuple[float, float, float], motion: str, distance: float, poses: list[tuple[float, float]]
) -> None:
    scene, compiled = scene_of(teeth, spokes, bar, motion, distance)
    starts = (np.array([pose[0], 0.3 * pose[1], 0.2 * pose[0], pose[1]])[: len(compiled.model.coordinates)] for pose in poses)
    for k, q in touches(scene, compiled, np.random.default_rng(1), starts):
        assert k in compiled.model.near
        assert k in listed_prefilter(compiled, q)


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
        assert k in listed_prefilter(compiled, q)
    assert met > 5


@pytest.mark.parametrize(("distance", "some"), [(1.9, True), (2.7, False)])
def test_what_cannot_be_reached_is_no_candidate(distance: float, some: bool) -> None:
    _, compiled = scene_of(12, 0, (0.8, 0.05, 0.0), "pivot", distance)
    assert (len(compiled.model.near) > 0) == some
    assert len(compiled.model.near) < len(compiled.model.contacts)
