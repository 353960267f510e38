"""Are those pairs found that come within the clearance, and no others? Places are those of complex numbers."""

from __future__ import annotations

import cmath
import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from pair_scenes import body_pose, outline
from test_cell_travel import curve, seen

from watchsim.candidates import cell_grid
from watchsim.candidates.asymmetric_contacts import LooseContacts
from watchsim.candidates.broad_phase import PairSearch, _circles, _largest, _shapes
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

NONE = np.zeros(0, np.int64)


@pytest.fixture(autouse=True)
def _cells_however_few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cell_grid, "FEW_CONTACTS", 0)


def polygon(corners: int, size: float, at: complex) -> Loop:
    """Unequal sides, lines alone."""
    turns = [2.0 * math.pi * (k + 0.2 * (k % 2)) / corners for k in range(corners)]
    points = [at + cmath.rect(size * (1.0 + 0.3 * (k % 3)), turn) for k, turn in enumerate(turns)]
    return Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in zip(points, points[1:] + points[:1], strict=True)))


POLYGONS, ROUND = (polygon(9, 0.35, 0.2 + 0.1j), polygon(7, 0.5, -0.1j)), (outline(0.6, (0.2, 0.1)), outline(1.0, (0.1, 0.2)))


def scene_of(
    loops: tuple[Loop, Loop], clearance: float, motions: tuple[str, str] = ("pivot", "pivot")
) -> tuple[Scene, Compiled]:
    given = zip("ab", motions, ((0.1, -0.2), (0.6, 0.1)), loops, strict=True)
    bodies = tuple(Body(name, motion, at, mass=1.0, inertia=1.0, loops=(loop,)) for name, motion, at, loop in given)
    scene = Scene("near", bodies, contacts=(Contact((Side("a"), Side("b"))),))
    compiled = compile_scene(scene)
    pairs = compiled.model.pairs.copy()
    pairs.clearance = clearance
    return scene, replace(compiled, model=compiled.model._replace(pairs=pairs))


def shape(points: np.ndarray) -> Any:
    xy = np.stack([points.real, points.imag], axis=1)
    return shapely.Point(xy[0]) if len(xy) == 1 else shapely.LineString(xy)


@pytest.mark.parametrize(
    "loops", [POLYGONS, POLYGONS[::-1], ROUND, ROUND[::-1]], ids=["lines", "swapped", "arcs", "swapped arcs"]
)
@pytest.mark.parametrize("clearance", [0.02, 0.12])
def test_what_comes_within_the_clearance_is_found(loops: tuple[Loop, Loop], clearance: float) -> None:
    """Whatever the normals; where there are lines alone nothing else, of arcs what their chords may be off, twice."""
    scene, compiled = scene_of(loops, clearance)
    model, pair, places = compiled.model, compiled.model.pairs[0], np.random.default_rng(6).uniform(-3.0, 3.0, (40, 2))
    search: Any = PairSearch(model, 0, NONE)
    search._regions.possible = lambda place, *_: np.ones(len(place), bool)
    assert max(search._drawn.sag.max(), search._still_sag.max()) <= 0.5 * clearance * (1.0 + 1e-12)
    beyond = 2.0 * float(search._drawn.sag.max() + search._still_sag.max())
    assert (beyond == 0.0) is (loops[0] in POLYGONS)
    found = set(zip(*(part.tolist() for part in search._alike(places, np.zeros(2))), strict=True))
    for c in range(5):  # alone as among others
        alone = search._alike(places[c : c + 1], np.zeros(2))[1].tolist()
        assert sorted(alone) == sorted(k for place, k in found if place == c)
    hits = 0
    for c, at in enumerate(places):
        q = np.zeros(2)
        q[[pair.c0, pair.c1]] = at
        one, other = (body_pose(scene, scene.bodies[b].name, q) for b in (pair.a, pair.b))
        rows = model.primitives
        shapes = [shape(seen(curve(row), one, other) if row.body == pair.a else curve(row)) for row in rows]
        for k in model.near[pair.near_start : pair.near_stop]:
            distance = shapes[model.contacts.a[k]].distance(shapes[model.contacts.b[k]])
            if distance < clearance * (1.0 - 1e-3):
                assert (c, k - pair.start) in found
                hits += 1
            elif distance > (clearance + beyond) * (1.0 + 1e-3):
                assert (c, k - pair.start) not in found
    assert hits > 10


def test_loose_primitives_are_found_once_wherever_they_are() -> None:
    """Contacts of two of them always, of one of them at least where they are found otherwise, the others as ever."""
    model = scene_of(POLYGONS, 0.02)[1].model
    loose = np.array([1, 4, 12, 20, 25])
    start, cells = int(model.pairs[0].start), np.random.default_rng(3).integers(-90, 90, (12, 2))
    is_loose = np.isin(np.stack([model.contacts.a, model.contacts.b]), loose).sum(axis=0)
    assert {0, 1, 2} <= set(is_loose.tolist()) and {model.primitives.body[k] for k in loose} == {0, 1}
    usual, more = (PairSearch(model, 0, some).candidates(cells) for some in (NONE, loose))
    for before, after in zip(*(np.split(found, np.cumsum(count)[:-1]) for count, found in (usual, more)), strict=True):
        assert np.all(np.diff(after) > 0)
        number = is_loose[after + start]
        assert set(before.tolist()) <= set(after.tolist())
        assert after[number == 0].tolist() == [k for k in before if is_loose[k + start] == 0]
        near = model.near[model.pairs[0].near_start : model.pairs[0].near_stop] - start
        assert after[number == 2].tolist() == [k for k in near if is_loose[k + start] == 2]


@pytest.mark.parametrize("turning", [0, 1])
@pytest.mark.parametrize("motions", [("pivot", "pivot"), ("free", "fixed"), ("fixed", "free")])
def test_what_turns_freely_is_met_on_its_ring(motions: tuple[str, str], turning: int) -> None:
    """Points as far as they are, lines at least half of what their ends' distances have more than their length."""
    scene, compiled = scene_of(POLYGONS, 0.015, motions)
    model, pair, rng = compiled.model, compiled.model.pairs[0], np.random.default_rng(9)
    rows, contacts = model.primitives, model.contacts
    ids = np.arange(len(contacts))
    mine = np.where(rows.body[contacts.a] == turning, contacts.a, contacts.b)
    partner = np.where(rows.body[contacts.a] == turning, contacts.b, contacts.a)
    ends = [curve(row)[[0, -1]] if row.length > 0.0 and row.kind == 1 else curve(row) for row in rows]
    search = LooseContacts(model, 0, ids, mine, partner)
    reach = np.array([np.abs(one).max() for one in ends])
    at = rng.uniform(-1.0, 1.0, (7, int(pair.axes)))
    for room in (np.zeros(int(pair.axes)), rng.uniform(0.01, 0.1, int(pair.axes))):
        place, found = search.candidates(at, room)
        hit = set(zip(place.tolist(), found.tolist(), strict=True))
        for c, q in enumerate(at):
            poses = [body_pose(scene, body.name, q) for body in scene.bodies]
            (ox, oy, _), (x, y, turn) = poses[turning], poses[1 - turning]
            moved = [np.abs(complex(x - ox, y - oy) + one * cmath.rect(1.0, turn)) for one in ends]
            for k in ids:
                shift = math.hypot(*room[:2]) if "free" in motions else 0.0
                swing = {"pivot": room[(1 - turning) % len(room)], "free": room[-1], "fixed": 0.0}[motions[1 - turning]]
                travel = shift + swing * reach[partner[k]] + 0.015
                (low, high), (near, far) = (
                    span(d, e) for d, e in ((moved[partner[k]], ends[partner[k]]), (abs(ends[mine[k]]), ends[mine[k]]))
                )
                room_left = min(far - low, high - near) + travel
                assert abs(room_left) < 1e-9 or ((c, k) in hit) is bool(room_left > 0.0)
    assert 0 < len(hit) < len(at) * len(ids)


def span(distance: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    low = 0.5 * (distance.sum() - abs(points[1] - points[0])) if len(points) == 2 else distance[0]
    return max(float(low), 0.0), float(distance.max())


def test_circles_hold_their_points() -> None:
    """About the middle of the least and largest coordinates, as far as the corner of their frame."""
    points = np.array([[[0.3, 0.1], [0.9, -0.7], [0.5, 0.4], [-2.0, 3.0]], [[1.3, 0.2], [1.1, 0.5], [0.6, 0.9], [4.0, -5.0]]])
    centre, radius = _circles(points, np.array([0, 3, 4]))
    assert centre == pytest.approx(np.array([[0.6 - 0.15j, -2.0 + 3.0j], [0.95 + 0.55j, 4.0 - 5.0j]]), rel=1e-14)
    assert radius == pytest.approx(np.array([[math.hypot(0.3, 0.55), 0.0], [0.35 * math.sqrt(2.0), 0.0]]), rel=1e-14)


@pytest.mark.parametrize("first", [[0, 3, 4, 6], [0, 6]])
def test_the_largest_of_each_primitive(first: list[int]) -> None:
    values = np.array([[0.3, 0.9, 0.1, 0.4, 0.2, 0.7], [0.8, 0.1, 0.2, 0.6, 0.5, 0.3]])
    wanted = [[max(row[a:b]) for a, b in itertools.pairwise(first)] for row in values.tolist()]
    assert _largest(values, np.array(first)).tolist() == wanted


def test_points_and_lines_through_several() -> None:
    points = np.array([[0.3, 0.1], [0.9, -0.7], [0.5, 0.4], [-2.0, 3.0], [1.5, 2.5], [1.0, 7.0]])
    made = _shapes(points, np.array([0, 1, 4, 6]))
    assert [shapely.get_coordinates(one).tolist() for one in made] == [p.tolist() for p in np.split(points, [1, 4])]
    assert [one.geom_type for one in made] == ["Point", "LineString", "LineString"]
    assert [one.geom_type for one in _shapes(points[:2], np.array([0, 1, 2]))] == ["Point", "Point"]
