"""Are answers kept apart wherever a number differs that they depend on, shared where none does, and forgotten in time?

A number is changed in the tables of a compiled model, as no scene could be written for each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from carried_scenes import carried_scene
from pair_scenes import outline

from watchsim.candidates import pair_cache
from watchsim.candidates.pair_cache import Known, _digest, forget, known_cells
from watchsim.geometry.loop import Loop
from watchsim.model.records import FIXED, FREE, PIVOT, SLIDE, Model


def compiled(carrier: str, partner: str) -> Model:
    """Body a hangs on a carriage, the other one may."""

    def shape(name: str) -> tuple[Loop, ...]:
        return (outline(1.0 if name == "a" else 0.4, (0.2, 0.1)),)

    return carried_scene(carrier, partner, False, shape, (0.3, 0.2))[1].model


SLIDING, BESIDE, FREELY = compiled("pivot", "slide"), compiled("pivot", "beside"), compiled("pivot", "fixed")
MOVED_FIRST = compiled("slide", "pivot")


def changed(model: Model, table: str, row: int, name: str, value: Any = None) -> Model:
    """With one number changed: given, or a quarter more, or one more, or something where nothing was."""
    rows = getattr(model, table).copy()
    if value is None:
        value = rows[row][name] + 1 if rows.dtype[name].kind == "i" else 1.25 * rows[row][name] or 0.37
    assert rows[row][name] != value
    rows[row][name] = value
    return model._replace(**{table: rows})


def body_of(model: Model, motion: int, carried: bool) -> int:
    """The first body that moves so."""
    found = np.flatnonzero((model.bodies.motion == motion) & ((model.bodies.carrier >= 0) == carried))
    return int(found[0])


COUNTED = [
    *((SLIDING, PIVOT, True, name) for name in ("x", "y", "ratio", "phase")),
    *((SLIDING, PIVOT, False, name) for name in ("x", "y", "ratio", "phase")),
    *((SLIDING, SLIDE, False, name) for name in ("x", "y", "angle", "axis_x", "axis_y", "ratio", "phase")),
    *((MOVED_FIRST, SLIDE, False, name) for name in ("x", "y", "angle", "axis_x", "axis_y")),
    *((FREELY, FIXED, False, name) for name in ("x", "y", "angle")),
]


@pytest.mark.parametrize("case", COUNTED, ids=lambda case: "-".join(map(str, case[1:])))
def test_where_bodies_sit_and_how_they_move_counts(case: tuple[Model, int, bool, str]) -> None:
    model, motion, carried, name = case
    body = body_of(model, motion, carried)
    carriers = [int(model.bodies[b].carrier) for b in (model.pairs[0].a, model.pairs[0].b)]
    assert body in (model.pairs[0].a, model.pairs[0].b, *carriers)
    assert _digest(changed(model, "bodies", body, name), 0) != _digest(model, 0)


@pytest.mark.parametrize("first", [True, False])
def test_a_carrier_counts_whatever_its_number(first: bool) -> None:
    """Also that of the first body of all; what hangs on nothing has none, not even the last body."""
    model = SLIDING
    a, carrier = body_of(model, PIVOT, True), body_of(model, PIVOT, False)
    if first:
        order = [carrier, *(b for b in range(len(model.bodies)) if b != carrier)]
        now = {old: new for new, old in enumerate(order)}
        bodies, pairs, primitives = model.bodies[order], model.pairs.copy(), model.primitives.copy()
        bodies.carrier = [now.get(int(b), -1) for b in bodies.carrier]
        pairs.a, pairs.b = ([now[int(b)] for b in side] for side in (pairs.a, pairs.b))
        primitives.body = [now[int(b)] for b in primitives.body]
        model = model._replace(bodies=bodies, pairs=pairs, primitives=primitives)
        assert _digest(model, 0) == _digest(SLIDING, 0)
        a, carrier = now[a], 0
    assert model.bodies[a].carrier == carrier
    assert _digest(changed(model, "bodies", carrier, "x"), 0) != _digest(model, 0)


def test_what_no_answer_depends_on_does_not_count() -> None:
    """Sines of what does not turn so, the place of a pivot's angle, neighbours of primitives, laws."""
    model, other = SLIDING, SLIDING
    for motion, name in ((PIVOT, "angle"), (PIVOT, "axis_x"), (PIVOT, "c"), (SLIDE, "s")):
        other = changed(other, "bodies", body_of(model, motion, False), name, 0.123)
    for name in ("before", "after"):
        other = changed(other, "primitives", 0, name)
    assert _digest(other, 0) == _digest(model, 0)


@pytest.mark.parametrize("name", [name for name in SLIDING.primitives.dtype.names or () if name not in ("before", "after")])
@pytest.mark.parametrize("last", [False, True])
def test_every_number_of_a_primitive_counts(name: str, last: bool) -> None:
    model, pair = SLIDING, SLIDING.pairs[0]
    row = int(model.contacts.b[pair.stop - 1] if last else model.contacts.a[pair.start])
    value = (pair.a if model.primitives[row].body == pair.b else pair.b) if name == "body" else None
    assert _digest(changed(model, "primitives", row, name, value), 0) != _digest(model, 0)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("name", ["size", "wrap", "fold"])
def test_every_cell_coordinate_counts(axis: int, name: str) -> None:
    assert SLIDING.pairs[0].axes == 3
    assert _digest(changed(SLIDING, "pairs", 0, f"{name}{axis}"), 0) != _digest(SLIDING, 0)


def test_clearance_groups_and_what_can_be_reached_count() -> None:
    near = SLIDING.near[::-1].copy()
    others = [changed(SLIDING, "pairs", 0, "clearance"), changed(SLIDING, "contacts", 5, "group"), SLIDING._replace(near=near)]
    others += [changed(SLIDING, "pairs", 0, "near_start"), changed(SLIDING, "pairs", 0, "stop", SLIDING.pairs[0].stop - 1)]
    assert len({_digest(model, 0) for model in (SLIDING, *others)}) == 6


def seen(c: tuple[int, int], on: tuple[int, int]) -> bytes:
    """The digest of two bodies beside one another on a carriage, with those cell coordinates, less those."""
    model = BESIDE
    pair = model.pairs.copy()
    pair.axes, pair.c0, pair.c1, pair.on0, pair.on1 = 2, *c, *on
    return _digest(model._replace(pairs=pair), 0)


def test_what_is_taken_away_from_a_cell_coordinate_counts() -> None:
    """Nothing is neither the first coordinate nor the second."""
    kinds = [((0, 2), (1, on)) for on in (-1, 0, 1, 2)] + [((0, 1), (-1, on)) for on in (-1, 0, 1)] + [((1, 0), (-1, -1))]
    assert len({seen(*one) for one in kinds}) == len(kinds)


class Search:
    """Answers each cell by as many numbers as its first index, and notes what it is asked."""

    def __init__(self) -> None:
        self.asked: list[list[list[int]]] = []

    def candidates(self, index: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        self.asked.append(index.tolist())
        count = index[:, 0]
        return count, np.concatenate([np.arange(n) + 10 * n for n in count]).astype(np.int32)


def test_a_cell_is_asked_about_once(monkeypatch: pytest.MonkeyPatch) -> None:
    search: Any = Search()
    known = Known(search)
    known.ask(np.array([[2, 7], [3, -1]]))
    known.ask(np.array([[3, -1], [2, 7]]))
    known.ask(np.array([[3, -1], [1, 7], [0, 5]]))
    assert search.asked == [[[2, 7], [3, -1]], [[1, 7], [0, 5]]]
    count, found = known.answers([(3, -1), (0, 5), (1, 7), (2, 7)])
    assert count.tolist() == [3, 0, 1, 2] and found.tolist() == [30, 31, 32, 10, 20, 21] and found.dtype == np.int64
    monkeypatch.setattr(pair_cache, "MOST_CELLS", 4)
    known.ask(np.array([[4, 0]]))
    assert len(known) == 5 and known.cells()[0] == (2, 7)
    known.ask(np.array([[2, 7]]))  # now there were too many
    assert known.cells() == [(2, 7)]


def test_what_was_asked_for_longest_ago_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    make: Callable[..., Any] = lambda *_: Search()  # noqa: E731
    monkeypatch.setattr(pair_cache, "PairSearch", make)
    monkeypatch.setattr(pair_cache, "KEPT", 3)
    forget()
    models = [changed(SLIDING, "pairs", 0, "clearance", 0.1 * (k + 1)) for k in range(4)]
    known = [known_cells(model, 0, np.zeros(0, np.int64)) for model in models[:3]]
    assert known_cells(models[0], 0, np.zeros(0, np.int64)) is known[0]
    known.append(known_cells(models[3], 0, np.zeros(0, np.int64)))  # the second one goes
    for k, kept in ((0, True), (2, True), (3, True), (1, False)):
        assert (known_cells(models[k], 0, np.zeros(0, np.int64)) is known[k]) is kept
    forget()


def test_free_bodies_sit_nowhere() -> None:
    """Their records hold no place that counts."""
    model = compiled("pivot", "free")
    body = body_of(model, FREE, False)
    assert _digest(changed(model, "bodies", body, "x"), 0) == _digest(model, 0)
    assert _digest(changed(model, "bodies", body, "ratio"), 0) != _digest(model, 0)
