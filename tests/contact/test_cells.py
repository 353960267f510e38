"""Does a cell's list hold every pair of primitives that touches anywhere in the cell and its margin?"""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from pair_scenes import DEGREES, body_pose, outline

from watchsim.contact.cells import CellFinder
from watchsim.contact.known import forget
from watchsim.contact.lookup import (
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
from watchsim.geometry.primitives import Arc, moved
from watchsim.jit import callable_kernel
from watchsim.mechanism import choose_cells
from watchsim.mechanism.body import Body
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.mechanism.force import Contact, Side
from watchsim.mechanism.model import ARC, LINE, Cells
from watchsim.mechanism.scene import Scene

PIECES = 200  # chords of an arc: they lie within 2e-5 of it
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
    monkeypatch.setattr(choose_cells, "FEW_CONTACTS", 0)
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


def curves(scene: Scene, compiled: Compiled, q: np.ndarray) -> list[shapely.Geometry]:
    """Every primitive where it is at q: a corner as a point, an arc as many chords."""
    found = []
    for p in compiled.model.primitives:
        x, y, angle = body_pose(scene, "ab"[p.body], q)
        if p.kind == ARC:
            edge = next(
                e
                for e in scene.bodies[p.body].loops[0].edges
                if isinstance(e, Arc) and math.dist((e.x, e.y), (p.x, p.y)) < 1e-12
            )
            points = [moved(edge, angle, (x, y)).point(f) for f in np.linspace(0.0, 1.0, PIECES + 1)]
        else:
            end = p.length if p.kind == LINE else 0.0
            local = [(p.x, p.y), (p.x + end * p.tx, p.y + end * p.ty)]
            c, s = math.cos(angle), math.sin(angle)
            points = [(x + c * X - s * Y, y + s * X + c * Y) for X, Y in local]
        found.append(shapely.Point(points[0]) if points[0] == points[-1] else shapely.LineString(points))
    return found


def somewhere_in_cell(compiled: Compiled, q: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A random pose within the cell of q and its margin; half of them at the very edge."""
    row = compiled.model.pairs[0]
    there = q.copy()
    for axis in range(row.axes):
        i, size = row[f"c{axis}"], row[f"size{axis}"]
        share = rng.uniform(-MARGIN, 1.0 + MARGIN) if rng.random() < 0.5 else rng.choice([-MARGIN, 1.0 + MARGIN])
        there[i] = (math.floor(q[i] / size) + share) * size
    return there


def random_q(scene: Scene, rng: np.random.Generator) -> np.ndarray:
    """Poses in which the bodies are often near one another; angles of several turns."""
    q = []
    for body in scene.bodies:
        spread = {"pivot": [20.0], "slide": [0.6], "free": [0.5, 0.5, 20.0], "fixed": []}[body.motion]
        q += [rng.uniform(-s, s) for s in spread]
    return np.array(q)


@pytest.mark.parametrize("name", CASES)
def test_no_touching_pair_is_lost(name: str) -> None:
    scene, compiled = pair(*CASES[name])
    finder, rng = CellFinder(compiled.model), np.random.default_rng(7)
    assert compiled.model.pairs[0].axes == sum(DEGREES[motion] for motion in CASES[name])
    met, lengths = 0, []
    for _ in range(25):
        q = random_q(scene, rng)
        cells = finder.learn(0, q)
        how, ids = listed(compiled, cells, q)
        assert how == LISTED
        lengths.append(len(ids))
        contacts = compiled.model.contacts
        for _ in range(4):
            drawn = curves(scene, compiled, somewhere_in_cell(compiled, q, rng))
            a, b = np.array([drawn[i] for i in contacts.a]), np.array([drawn[i] for i in contacts.b])
            # Curves that cross touch; points touch where they come closer than any tolerance of the solver.
            touching = set(np.flatnonzero(shapely.distance(a, b) < 1e-7).tolist())
            met += len(touching)
            assert touching <= ids
    assert met > 20
    # The lists are worth having: far shorter than all pairs.
    assert np.mean(lengths) < 0.25 * len(compiled.model.contacts)


def test_corners_that_meet_anything_are_listed() -> None:
    """A corner hardly ever touches at a random pose: put one exactly on the other body's primitives."""
    scene, compiled = pair("free", "fixed")
    finder, rng = CellFinder(compiled.model), np.random.default_rng(3)
    contacts, primitives = compiled.model.contacts, compiled.model.primitives
    for k in rng.permutation(len(contacts))[:60]:
        one, other = primitives[contacts[k].a], primitives[contacts[k].b]
        if one.body != 0 or one.kind == ARC:
            continue
        angle = rng.uniform(-10.0, 10.0)
        x, y, turned = body_pose(scene, "b", np.zeros(3))
        local = (other.x, other.y)
        if other.kind == LINE:
            way = rng.uniform(0.0, other.length)
            local = (other.x + way * other.tx, other.y + way * other.ty)
        else:
            edge = next(e for e in scene.bodies[1].loops[0].edges if isinstance(e, Arc) and e.radius == other.radius)
            local = edge.point(rng.random())
        cb, sb, ca, sa = math.cos(turned), math.sin(turned), math.cos(angle), math.sin(angle)
        target = (x + cb * local[0] - sb * local[1], y + sb * local[0] + cb * local[1])
        q = np.array([target[0] - ca * one.x + sa * one.y, target[1] - sa * one.x - ca * one.y, angle])
        assert k in listed(compiled, finder.learn(0, q), q)[1]


@pytest.mark.parametrize("name", ["pivot-pivot", "slide-pivot", "free-fixed"])
def test_candidates_stay_complete_for_the_promised_time(name: str) -> None:
    """No motion with the given speeds and accelerations leaves the cell's margin before `time_in_cell`."""
    scene, compiled = pair(*CASES[name])
    row, rng = compiled.model.pairs[0], np.random.default_rng(11)
    for _ in range(100):
        q = random_q(scene, rng)
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


def test_far_away_every_pair_is_a_candidate() -> None:
    compiled = pair("free", "fixed")[1]
    row = compiled.model.pairs[0]
    q = np.array([1.5 * REACH * row.size0, 0.0, 0.0])
    assert cell_key(compiled.model, 0, q) == -1
    how, ids = listed(compiled, CellFinder(compiled.model).learn(0, q), q)
    assert how == ALL
    assert len(ids) == len(compiled.model.near)
