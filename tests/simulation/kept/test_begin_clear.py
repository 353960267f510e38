"""Which contacts are asked whether a start is clear, and what is refused? With made-up touches and gaps."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.mechanism.overlap import Overlap
from watchsim.model.records import NO_KEY
from watchsim.scene.errors import SceneError
from watchsim.scene.force import Side
from watchsim.simulation import start_clearance as start

NEAR = 1.5 * 3e-9  # m, times the largest rounding of what touches
MET = Overlap(0, (Side("one", "face"), Side("two", "rim")), 2e-9, (0.00123456, -0.02), 3e-9)
OTHER = Overlap(1, (Side("two", "rim"), Side("three", None)), 4e-9, (0.5, 0.25), 1e-9)
OPTIONS = SimpleNamespace(behind=1e-10)
Q = np.array([0.25, -0.5])


def gaps(*values: float, margin: float = 0.0) -> Any:
    return SimpleNamespace(kin=np.rec.fromarrays([list(values), [margin] * len(values)], names="g,margin"))


def model(groups: list[int], ends: list[tuple[int, int]]) -> Any:
    a, b = zip(*ends, strict=True) if ends else ((), ())
    contacts = np.rec.fromarrays([groups, list(a), list(b)], formats="i8,i8,i8", names="group,a,b")
    return SimpleNamespace(contacts=contacts)


COMPILED: Any = SimpleNamespace(owners=("one", "two", "three", "one"), layers=("face", "rim", None, "other"))


@pytest.mark.parametrize(("gap", "margin", "group", "ends", "known"), [
    (1e-9, 0.0, 0, (0, 1), True), (1e-9, 0.0, 0, (1, 0), True), (-0.9 * NEAR, 0.0, 0, (0, 1), True),
    (0.9 * NEAR, 0.0, 0, (0, 1), True), (1.1 * NEAR, 0.0, 0, (0, 1), False), (-1.1 * NEAR, 0.0, 0, (0, 1), False),
    (0.0, -0.9 * NEAR, 0, (0, 1), True), (0.0, -1.1 * NEAR, 0, (0, 1), False), (0.0, 0.0, 1, (0, 1), False),
    (0.0, 0.0, 0, (0, 2), False), (0.0, 0.0, 0, (3, 1), False),
])  # fmt: skip
def test_a_touch_is_known_where_a_contact_of_its_layers_is_about_zero(gap, margin, group, ends, known: bool) -> None:
    """To within what is near, in its gap and beyond the ends of its primitives; the second contact is asked."""
    made, closed = model([5, group], [(0, 1), ends]), gaps(0.0, gap, margin=margin)
    assert start._is_known(MET, COMPILED, made, closed, NEAR) == known


class Finder:
    """A table of cells with keys 3 to 6; 5 is learnt when it is asked for."""

    def __init__(self) -> None:
        self.cells = SimpleNamespace(
            keys=np.array([3, 4, NO_KEY, 6]), start=np.array([0, 2, 5, 9]), count=np.array([2, 3, 2, 1]),
            entries=np.array([10, 11, 12, 13, 14, 15, 16, 77, 77, 17]),
        )  # fmt: skip
        self.learnt: list[tuple[int, list[float]]] = []

    def learn(self, p: int, q: np.ndarray) -> None:
        self.learnt.append((p, q.tolist()))
        self.cells.keys[2] = 5


def candidates(keys: list[int], listed: list[int], monkeypatch: pytest.MonkeyPatch) -> tuple[list[int], Finder]:
    """Of pairs of bodies in these cells; what is near of pair p are contacts 3 p and 3 p + 2, listed at 4 p + 1 to 4 p + 3."""
    near = np.full(40, 77)
    pairs = []
    for p, is_listed in enumerate(listed):
        near[4 * p + 1 : 4 * p + 3] = 3 * p, 3 * p + 2
        pairs.append(SimpleNamespace(listed=is_listed, near_start=4 * p + 1, near_stop=4 * p + 3))
    monkeypatch.setattr(start, "cell_key", lambda model, p, q: keys[p])
    monkeypatch.setattr(start, "find_slot", lambda table, key: list(table).index(key) if key in table else 2)
    finder: Any = Finder()
    made: Any = SimpleNamespace(pairs=pairs, near=near)
    return start._candidates(made, finder, Q).tolist(), finder


def test_candidates_are_those_of_the_cells_or_all_that_are_near(monkeypatch: pytest.MonkeyPatch) -> None:
    found, finder = candidates([4, NO_KEY, 3, 99], [1, 1, 1, 0], monkeypatch)
    assert found == [3, 5, 9, 10, 11, 12, 13, 14] and finder.learnt == []
    found, finder = candidates([6, 5], [1, 1], monkeypatch)
    assert found == [15, 16, 17] and finder.learnt == [(1, [0.25, -0.5])]
    assert candidates([], [], monkeypatch)[0] == []


def cleared(monkeypatch: pytest.MonkeyPatch, met=(MET, OTHER), known=(True, True), rows=(1,), moved=True, n: int = 2):
    """Coordinates, overlap taken back and words of refusals; contacts 4 and 7 are asked, which overlap by 1 and 2 nm."""
    near, asked = 1.5 * max((one.allowed for one in met), default=0.0), []
    closed = gaps(-1e-9, -2e-9)
    compiled: Any = SimpleNamespace(
        q=Q[:n],
        model=SimpleNamespace(contacts=np.arange(9), _replace=lambda contacts: asked.append(contacts.tolist()) or "model"),
    )
    monkeypatch.setattr(start, "meetings", lambda scene: met)
    monkeypatch.setattr(start, "_candidates", lambda model, finder, q: [4, 7])
    monkeypatch.setattr(start, "kinematics_at", lambda model, q: closed if model == "model" else None)
    monkeypatch.setattr(start, "_is_known", lambda one, compiled, model, closed, reach: known[met.index(one)] and reach == near)
    monkeypatch.setattr(
        start,
        "overlapping_rows",
        lambda model, closed, options, reach, least: np.array(rows) if (reach, least) == (near, 1e-10) else None,
    )
    monkeypatch.setattr(start, "taken_back_from", lambda model, q, options, reach: q + 1.0 if moved and reach == near else None)
    q, back, refused = start._clear(None, compiled, None, OPTIONS)  # type: ignore[arg-type]
    assert asked in ([], [[4, 7]])
    return q.tolist(), back, [(one, words) for one, words in refused]


def test_a_start_is_where_no_touching_contact_overlaps(monkeypatch: pytest.MonkeyPatch) -> None:
    assert cleared(monkeypatch) == ([1.25, 0.5], 2e-9, [])
    assert cleared(monkeypatch, rows=(0,)) == ([1.25, 0.5], 1e-9, [])
    assert cleared(monkeypatch, rows=()) == cleared(monkeypatch, met=()) == ([0.25, -0.5], 0.0, [])
    assert cleared(monkeypatch, n=0) == ([], 0.0, [])


def test_what_has_no_gap_function_or_is_wedged_in_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what is wedged in, the deepest is told."""
    q, back, refused = cleared(monkeypatch, known=(True, False))
    assert (q, back, refused) == ([0.25, -0.5], 0.0, [(OTHER, start._words(OTHER, start.NO_GAP))])
    q, back, refused = cleared(monkeypatch, moved=False)
    assert (q, back, refused) == ([0.25, -0.5], 0.0, [(OTHER, start._words(OTHER, start.WEDGED))])


def test_a_refusal_says_what_meets_where_and_how_deep() -> None:
    assert (
        start._words(MET, "so.")
        == "one and two overlap by 2e-06 mm at the start, at (1.235, -20) mm (layers face and rim), so."
    )
    touch = Overlap(0, MET.sides, 0.0, (0.0, 0.001), 3e-9)
    assert start._words(touch, "so.") == "one and two touch at the start, at (0, 1) mm (layers face and rim), so."


def test_a_run_begins_at_the_clear_start_or_not_at_all(monkeypatch: pytest.MonkeyPatch) -> None:
    found: dict[str, Any] = {"faults": [], "refused": []}
    monkeypatch.setattr(start, "overlap_faults", lambda scene: found["faults"])
    monkeypatch.setattr(start, "_clear", lambda *_: (Q, 2e-9, found["refused"]))
    monkeypatch.setattr(start, "faults_at", lambda scene, refused: [f"refused {len(refused)}"])
    assert start.clear_start(None, None, None, None) == (pytest.approx(Q), 2e-9)  # type: ignore[arg-type]
    for name, told in (("faults", ["fault"]), ("refused", [(MET, "words")])):
        monkeypatch.setitem(found, name, told)
        with pytest.raises(SceneError):
            start.clear_start(None, None, None, None)  # type: ignore[arg-type]
        monkeypatch.setitem(found, name, [])
