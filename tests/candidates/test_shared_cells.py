"""Which answers do alike parts and alike pairs of bodies share, and which bodies need no cells?"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pair_scenes import outline

from watchsim.candidates.asymmetric_contacts import LooseContacts
from watchsim.candidates.broad_phase import PairSearch
from watchsim.candidates.chords import chords
from watchsim.candidates.equivalent_contacts import AlikeContacts, _numbers_later
from watchsim.candidates.pair_cache import forget, known_cells
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import Model
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

NONE = np.zeros(0, np.int64)


def model_of(*bodies: Body, meet: tuple[tuple[str, str], ...]) -> Model:
    contacts = tuple(Contact((Side(one), Side(other))) for one, other in meet)
    return compile_scene(Scene("shared", bodies, contacts=contacts)).model


def wheel(name: str, x: float, **more: object) -> Body:
    return Body(name, "pivot", (x, 0.0), 0.0, inertia=1.0, loops=(outline(1.0, (0.2, 0.1)),), **more)


def test_the_same_two_bodies_behind_others_share_what_is_known() -> None:
    """Numbers are counted from the pair's own; another place of one of them is another pair."""
    forget()
    a, b = wheel("a", 0.0), wheel("b", 0.6)
    alone = model_of(a, b, meet=(("a", "b"),))
    behind = model_of(wheel("c", 0.0), a, b, meet=(("a", "b"),))
    other = model_of(a, replace(b, position=(0.61, 0.0)), meet=(("a", "b"),))
    known = known_cells(alone, 0, NONE)
    assert int(behind.pairs[0].a) == 1 and known_cells(behind, 0, NONE) is known
    assert known_cells(other, 0, NONE) is not known
    forget()
    assert known_cells(alone, 0, NONE) is not known


@pytest.mark.parametrize("seed", range(5))
def test_contacts_are_renumbered_as_a_list_would(seed: int) -> None:
    """Also the last ones, which may not be declared; several groups of the same primitives."""
    rng = np.random.default_rng(seed)
    every = [(a, b, group) for a in range(7) for b in range(7, 12) for group in range(2)]
    some = sorted(every[i] for i in rng.choice(len(every), 45, replace=False))
    part = np.rec.fromrecords(some, dtype=[("a", "i8"), ("b", "i8"), ("group", "i8")])
    before = np.concatenate([np.roll(np.arange(7), int(rng.integers(1, 7))), np.arange(7, 12)])
    number, declared = _numbers_later(part, before)
    for (a, b, group), place, is_there in zip(some, number.tolist(), declared.tolist(), strict=True):
        wanted = (int(before[a]), int(before[b]), group)
        assert is_there == (wanted in some)
        assert not is_there or some[place] == wanted
    assert 0 < np.count_nonzero(declared) < len(some)


@pytest.mark.parametrize("carried", [False, True])
def test_only_bodies_that_nothing_carries_are_told_apart_by_their_origins(carried: bool) -> None:
    """A carrier that is the first body of all counts, too: the place of what it carries is no coordinate."""
    free = Body("free", "free", (2.0, 0.0), mass=1.0, inertia=1.0, loops=(outline(0.5, (0.1, -0.1)),))
    arm = Body("arm", "slide", (0.0, 0.0), axis=(1.0, 0.0), mass=1.0)
    block = Body("block", "fixed", (0.1, 0.0), loops=(outline(1.0, (0.2, 0.1)),), on="arm" if carried else None)
    pair = model_of(arm, block, free, meet=(("block", "free"),)).pairs[0]
    assert (pair.reach > 0.0) == (not carried and pair.axes > 0)
    assert carried or pair.axes > 0


@pytest.mark.parametrize("coarse", [0.02, 0.1])
def test_arcs_that_turn_reach_as_far_as_their_true_curves(coarse: float) -> None:
    """Of contacts with a primitive that is anywhere on its ring: the farthest point from the origin, plus at most two sags."""
    model = model_of(wheel("a", 0.0), wheel("b", 0.6), meet=(("a", "b"),))
    model = model._replace(pairs=model.pairs.copy())
    model.pairs.clearance = coarse
    pair, rows = model.pairs[0], model.primitives
    a, b = model.contacts.a, model.contacts.b
    ids = np.flatnonzero(rows.body[a] == pair.a)
    loose = LooseContacts(model, 0, ids, a[ids], b[ids])
    partners = rows[np.unique(b[ids])]
    fine = chords(partners, 1e-7, 4000)
    true = [float(np.hypot(*points.T).max()) for points in np.split(fine.points, fine.first[1:-1])]
    assert np.all(loose._reach >= np.array(true) - 1e-12) and loose._drawn.sag.max() > 0.1 * coarse
    assert np.all(loose._reach <= np.array(true) + 2.0 * loose._drawn.sag + 1e-12)


def test_what_is_searched_reaches_as_far_as_its_true_curves() -> None:
    """Of every primitive that is moved: the farthest point from its origin, plus at most two sags."""
    model = model_of(wheel("a", 0.0), wheel("b", 0.6), meet=(("a", "b"),))
    model = model._replace(pairs=model.pairs.copy())
    model.pairs.clearance = 0.2
    search, pair = PairSearch(model, 0, NONE), model.pairs[0]
    near = model.near[pair.near_start : pair.near_stop]
    used = np.unique([model.contacts.a[near], model.contacts.b[near]])
    rows = model.primitives[used[model.primitives.body[used] == search._bodies[0]]]
    fine = chords(rows, 1e-7, 4000)
    true = np.array([float(np.hypot(*points.T).max()) for points in np.split(fine.points, fine.first[1:-1])])
    sag = search._drawn.sag
    assert np.all(search._reach >= true - 1e-12) and np.all(search._reach <= true + 2.0 * sag + 1e-12)


@pytest.mark.parametrize("motions", [("pivot", "pivot"), ("free", "fixed")])
def test_candidates_are_the_same_in_any_unit_of_length(motions: tuple[str, str]) -> None:
    """A power of two smaller: to the bit the same picture, a thousandth in size."""
    lists = []
    for unit in (1.0, 2.0**-10):
        bodies = [
            Body(name, motion, (x * unit, 0.0), mass=1.0, inertia=1.0, loops=(outline(unit, (0.2 * unit, 0.1 * unit)),))
            for name, motion, x in zip("ab", motions, (0.0, 0.6), strict=True)
        ]
        model = model_of(*bodies, meet=(("a", "b"),))
        cells = np.random.default_rng(3).integers(-9, 9, (30, int(model.pairs[0].axes)))
        lists.append([part.tolist() for part in PairSearch(model, 0, NONE).candidates(cells)])
    assert lists[0] == lists[1] and lists[0][1]


@pytest.mark.parametrize("groups", [2, 3])
def test_where_several_groups_name_the_same_primitives_each_has_its_candidates(groups: int) -> None:
    model = model_of(wheel("a", 0.0), wheel("b", 0.6), meet=(("a", "b"),) * groups)
    alone = model_of(wheel("a", 0.0), wheel("b", 0.6), meet=(("a", "b"),))
    cells = np.random.default_rng(3).integers(-9, 9, (30, 2))
    count, found = PairSearch(model, 0, NONE).candidates(cells)
    once, each = PairSearch(alone, 0, NONE).candidates(cells)
    assert len(model.pairs) == 1 and count.tolist() == (groups * once).tolist()
    here, there = np.cumsum(count) - count, np.cumsum(once) - once
    for k in range(30):
        rows = model.contacts[model.pairs[0].start + found[here[k] : here[k] + count[k]]]
        expected = alone.contacts[each[there[k] : there[k] + once[k]]]
        pairs = {(int(a), int(b)) for a, b in zip(expected.a, expected.b, strict=True)}
        named = {(int(a), int(b), int(group)) for a, b, group in zip(rows.a, rows.b, rows.group, strict=True)}
        assert named == {(a, b, group) for a, b in pairs for group in range(groups)}


def toothed(teeth: int) -> Model:
    """A body with so many corners evenly round it, beside a wedge."""
    corners = 0.8 * np.exp(2j * np.pi * np.arange(teeth) / teeth)
    pairs = zip(corners, np.roll(corners, -1), strict=True)
    round_ = Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in pairs))
    wedge = Loop((Line(-0.3, 0.0, 0.3, 0.0), Line(0.3, 0.0, 0.0, 0.4), Line(0.0, 0.4, -0.3, 0.0)))
    a = Body("a", "pivot", (0.0, 0.0), inertia=1.0, loops=(round_,))
    b = Body("b", "pivot", (1.0, 0.0), inertia=1.0, loops=(wedge,))
    return model_of(a, b, meet=(("a", "b"),))


@pytest.mark.parametrize("teeth", [3, 5, 8])
def test_what_comes_next_where_contacts_are_now(teeth: int) -> None:
    """The same part of the other body meets what a turn by one tooth brings to the same place."""
    model = toothed(teeth)
    pair, rows, contacts = model.pairs[0], model.primitives, model.contacts
    every = np.arange(len(contacts))
    alike = AlikeContacts(rows, contacts, pair, every, 0)
    assert alike.fold == teeth and len(alike.loose) == 0
    for k, after in enumerate(alike.later(every).tolist()):
        for now, later in ((contacts.a[k], contacts.a[after]), (contacts.b[k], contacts.b[after])):
            middle, there = (complex(p.px, p.py) + 0.5 * p.length * complex(p.tx, p.ty) for p in (rows[now], rows[later]))
            turn = np.exp(2j * np.pi / teeth) if rows.body[now] == 0 else 1.0
            assert there * turn == pytest.approx(middle, abs=1e-12) and rows.kind[now] == rows.kind[later]


def test_what_is_drawn_alike_but_not_declared_alike_is_not_shared() -> None:
    """One of many contacts is missing: nothing comes where it would be."""
    model = toothed(5)
    pair = model.pairs[0].copy()
    some = np.delete(model.contacts, 7).view(np.recarray)
    pair.stop -= 1
    assert AlikeContacts(model.primitives, some, pair, np.arange(len(some)), 0).fold == 1


def test_without_symmetry_nothing_comes_next() -> None:
    model = model_of(wheel("a", 0.0), wheel("b", 0.6), meet=(("a", "b"),))
    alike = AlikeContacts(model.primitives, model.contacts, model.pairs[0], np.arange(len(model.contacts)), 1)
    assert alike.fold == 1
    with pytest.raises(AttributeError):
        alike.later(np.arange(3))
