"""Are those pairs found that come within the clearance, and no others? Places are those of complex numbers."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely
from every_time import few
from pair_scenes import body_pose, outline
from test_cell_travel import curve, seen

from watchsim.candidates import broad_phase, cell_grid
from watchsim.candidates.asymmetric_contacts import LooseContacts
from watchsim.candidates.broad_phase import PairSearch
from watchsim.candidates.normal_fans import Regions
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


@pytest.fixture
def any_normals(monkeypatch: pytest.MonkeyPatch) -> None:
    """No pair is left out because of its normals; cells are points, their middles."""
    monkeypatch.setattr(broad_phase, "MARGIN", -0.5)
    monkeypatch.setattr(Regions, "possible", lambda _, place, *__: np.ones(len(place), bool))


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
@pytest.mark.parametrize("clearance", few([0.02, 0.12], 1))
def test_what_comes_within_the_clearance_is_found(loops: tuple[Loop, Loop], clearance: float, any_normals: None) -> None:
    """Whatever the normals; where there are lines alone nothing else, of arcs what their chords may be off, twice."""
    scene, compiled = scene_of(loops, clearance)
    model, pair, places = compiled.model, compiled.model.pairs[0], np.random.default_rng(6).uniform(-3.0, 3.0, (40, 2))
    search: Any = PairSearch(model, 0, NONE)
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


def test_loose_primitives_are_found_once_wherever_they_are(any_normals: None) -> None:
    """Contacts of two of them always, of one of them at least where they are found otherwise, the others as ever."""
    model = scene_of(POLYGONS, 0.02)[1].model
    loose = np.array([1, 4, 12, 20, 25])
    start, cells = int(model.pairs[0].start), np.random.default_rng(3).integers(-160, 160, (150, 2))
    is_loose = np.isin(np.stack([model.contacts.a, model.contacts.b]), loose).sum(axis=0)
    assert {0, 1, 2} <= set(is_loose.tolist()) and {model.primitives.body[k] for k in loose} == {0, 1}
    usual, more = (PairSearch(model, 0, some).candidates(cells) for some in (NONE, loose))
    near, met = model.near[model.pairs[0].near_start : model.pairs[0].near_stop] - start, 0
    for before, after in zip(*(np.split(found, np.cumsum(count)[:-1]) for count, found in (usual, more)), strict=True):
        assert np.all(np.diff(after) > 0)
        number = is_loose[after + start]
        assert set(before.tolist()) <= set(after.tolist())
        assert after[number == 0].tolist() == [k for k in before if is_loose[k + start] == 0]
        met += int(np.count_nonzero(is_loose[before + start] == 1))
        assert after[number == 2].tolist() == [k for k in near if is_loose[k + start] == 2]
    assert met > 5


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
    for k in (3, 17):
        only = LooseContacts(model, 0, ids[k : k + 1], mine[k : k + 1], partner[k : k + 1])
        assert only.candidates(at, room)[0].tolist() == [c for c, one in sorted(hit) if one == k]


def span(distance: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    low = 0.5 * (distance.sum() - abs(points[1] - points[0])) if len(points) == 2 else distance[0]
    return max(float(low), 0.0), float(distance.max())


def test_how_near_circles_come() -> None:
    """Of a mover in the second row to a still one in the third: up to what is asked beside both radii."""
    search: Any = object.__new__(PairSearch)
    search._still_centre, search._still_radius = np.array([9.0, 9.0j, -0.7 + 1.1j]), np.array([0.0, 0.0, 0.2])
    mover = np.array([[[5.0, 5.0], [0.3, -0.5], [0.3, 0.1]]])
    apart = abs(complex(0.3, -0.2) - search._still_centre[2])
    for share, wanted in ((1.001, True), (0.999, False)):
        within = np.array([[share * (apart - 0.3 - 0.2)]])
        assert search._circles_near(mover, np.array([0, 1, 3]), np.array([1]), np.array([2]), within).tolist() == [[wanted]]


def test_one_contact_alone_is_found_where_it_is_among_others(any_normals: None) -> None:
    model = scene_of(POLYGONS, 0.02)[1].model
    cells = np.random.default_rng(3).integers(-160, 160, (150, 2))
    count, found = PairSearch(model, 0, NONE).candidates(cells)
    cell = np.repeat(np.arange(len(cells)), count)
    none, nothing = PairSearch(model, 0, NONE).candidates(cells[count == 0][:1])
    assert none.tolist() == [0] and len(nothing) == 0
    assert len(np.unique(found)) > 10
    for k in np.unique(found)[::6]:
        pairs = model.pairs.copy()
        pairs.near_start, pairs.near_stop = 1, 2
        one = model._replace(pairs=pairs, near=np.array([0, k + pairs.start[0]]))
        alone, same = PairSearch(one, 0, NONE).candidates(cells)
        assert np.flatnonzero(alone).tolist() == cell[found == k].tolist() and set(same.tolist()) == {k}


def test_contacts_are_counted_from_the_first_of_their_pair(any_normals: None) -> None:
    """Behind another pair of bodies, with and without loose primitives."""
    alone = scene_of(POLYGONS, 0.02)[0]
    before = [replace(body, name=body.name + "0", position=(body.position[0], 5.0)) for body in alone.bodies]
    contacts = (Contact((Side("a0"), Side("b0"))), *alone.contacts)
    one, other = compile_scene(alone).model, compile_scene(Scene("behind", (*before, *alone.bodies), contacts=contacts)).model
    assert other.pairs.start[1] > 0
    cells, more = np.random.default_rng(3).integers(-160, 160, (150, 2)), int(np.flatnonzero(other.primitives.body == 2)[0])
    for loose in (NONE, np.array([1, 4, 20])):
        lists = [PairSearch(model, p, loose + p * more).candidates(cells) for p, model in enumerate((one, other))]
        assert lists[0][1].tolist() == lists[1][1].tolist() and len(lists[0][1]) > 5
