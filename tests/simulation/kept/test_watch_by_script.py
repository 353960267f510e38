"""What does the watch ask of the outlines, in which order, and what does it remember? With made-up layers and depths."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.scene.recording import WHOLE_RUN
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU
from watchsim.simulation.record import overlap_watch
from watchsim.simulation.record.overlap_watch import CHORD, OverlapWatch

SIZE = 0.4
SIDES = [SimpleNamespace(body=name) for name in ("arm", "block", "cam")]
FIRST, SECOND = (SIDES[1], SIDES[0]), (SIDES[2], SIDES[1])


class Words:
    """A side of a contact that says its name."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __str__(self) -> str:
        return self.name


SCENE: Any = SimpleNamespace(
    duration=8.0,
    contacts=[
        None,
        *(SimpleNamespace(sides=sides) for sides in ((Words("one"), Words("two")), (Words("three"), Words("four")))),
    ],
)
COMPILED: Any = SimpleNamespace(
    size=SIZE,
    slices="slices",
    relative=lambda q: q + 100.0,
    model=SimpleNamespace(coordinates=SimpleNamespace(scale=[1.0, SIZE])),
)


class Outlines:
    """Layers of which pair k overlaps by `depths[k]` (m) as a function of the first coordinate."""

    def __init__(self, *depths: Any) -> None:
        self.depths, self.asked = depths, []
        self.bodies = ["arm", "block", "cam"]
        self.pairs = [
            SimpleNamespace(contact=k + 1, sides=(FIRST, SECOND)[k], deepest=self._deepest(k)) for k in range(len(depths))
        ]

    def _deepest(self, k: int) -> Any:
        def deepest(where: list[np.ndarray]) -> tuple[float, tuple[float, float]]:
            assert [int(at[1]) for at in where] == ([1, 0], [2, 1])[k]  # the number of each body
            return self.depths[k](where[0][0]), (where[0][0], where[1][0] + k)

        return deepest

    def overlapping(self, where: np.ndarray, depth: float) -> np.ndarray:
        self.asked.append((where.shape[1], depth))
        return np.array([[depths(x) > depth for x in where[0, :, 0]] for depths in self.depths])


def frames(scene: Any, slices: Any, q: np.ndarray) -> dict[str, np.ndarray]:
    """For each body: its first coordinate, its number, a zero; coordinates are those that the scene has."""
    assert slices == "slices"
    place = q[:, 0] - 100.0
    return {name: np.column_stack([place, np.full(len(q), i), 0.0 * place]) for i, name in enumerate(("arm", "block", "cam"))}


def watching(
    monkeypatch: pytest.MonkeyPatch, layers: Outlines, method: str = EVENT_DRIVEN, windows: Any = WHOLE_RUN
) -> OverlapWatch:
    chords: list[float] = []
    monkeypatch.setattr(overlap_watch, "declared_pairs", lambda scene, chord: chords.append(chord) or layers)
    monkeypatch.setattr(overlap_watch, "frames", frames)
    watch = OverlapWatch(SCENE, COMPILED, method, windows)
    watch.chords = chords  # type: ignore[attr-defined]
    return watch


def rows(*places: float, start: float = 0.0) -> np.ndarray:
    found = np.zeros((len(places), 7))
    found[:, 0], found[:, 1] = start + np.arange(len(places)), places
    return found


RESOLUTION = 5e-5 * SIZE


def test_overlaps_are_measured_one_after_the_other_each_deeper_by_a_quarter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of all pairs the deepest counts; what is asked begins behind the last one measured."""
    layers = Outlines(lambda x: x, lambda x: 0.5 * x)
    watch = watching(monkeypatch, layers, MOREAU)
    watch._look(layers, np.arange(6.0), np.column_stack([[0.0, 0.1, 0.12, 0.13, 0.0, 0.5], np.zeros(6)]), [])
    found = watch.found
    assert (found.depth, found.time, found.x, found.y, found.contact, found.looks) == (0.5, 5.0, 0.5, 0.5, 1, 6.0)
    wanted = [(6, RESOLUTION), (4, 0.125), (2, 1.25 * 0.13), (0, 0.625)]
    assert [count for count, _ in layers.asked] == [count for count, _ in wanted]
    assert [depth for _, depth in layers.asked] == pytest.approx([depth for _, depth in wanted])


def test_of_two_pairs_at_one_instant_the_deeper_one_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for depths, contact, depth, y in (((1.0, 2.0), 2, 0.4, 1.2), ((2.0, 1.0), 1, 0.4, 0.2)):
        layers = Outlines(lambda x, k=depths[0]: k * x, lambda x, k=depths[1]: k * x)
        watch = watching(monkeypatch, layers)
        watch._look(layers, np.array([7.0]), np.array([[0.2, 0.0]]), [])
        found = watch.found
        assert (found.contact, found.depth, found.time) == (contact, pytest.approx(depth), 7.0)
        assert (found.x, found.y) == pytest.approx((0.2, y))


def test_numbers_owed_are_those_before_and_after_each_overlap(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of so many instants; what was found at one of them is told to those that come after it. Rows stay their own."""
    layers = Outlines(lambda x: x)
    watch = watching(monkeypatch, layers)
    watch.found.looks, watch.found.rows = 10.0, 99.0
    owed = [(count, np.full(7, 50.0)) for count in range(7)]
    watch._look(layers, np.arange(6.0), np.column_stack([[0.0, 0.0, 0.1, 0.0, 0.2, 0.0], np.zeros(6)]), owed)
    assert [numbers[1] for _, numbers in owed] == [10.0 + count for count in range(7)]
    assert [numbers[2] for _, numbers in owed] == pytest.approx([0.0, 0.0, 0.0, 0.1, 0.1, 0.2, 0.2])
    assert {numbers[0] for _, numbers in owed} == {50.0} and watch.found.looks == 16.0


def test_what_waits_is_looked_at_together_moves_first_then_states(monkeypatch: pytest.MonkeyPatch) -> None:
    layers = Outlines(lambda x: x - 0.9)
    watch = watching(monkeypatch, layers, MOREAU)
    watch.see()
    assert layers.asked == [] and watch.chords == [pytest.approx(RESOLUTION * CHORD)]  # type: ignore[attr-defined]
    watch.see_rows(rows(0.0, 0.5, 0.3, start=2.0))
    watch.see_state(9.0, np.array([0.7, 0.0]))
    numbers = watch.numbers.copy()
    watch.fill_in_later(numbers)
    watch.see_state(9.5, np.array([1.0, 0.0]))
    watch.see()
    assert [count for count, _ in layers.asked] == [4, 0] and watch.found.looks == 4.0 == 1.0 + numbers[1]
    assert (numbers[0], watch.found.rows, numbers[2], watch.found.depth) == (3.0, 3.0, 0.0, pytest.approx(0.1))
    watch.see()
    assert len(layers.asked) == 2 and len(watch.chords) == 1  # type: ignore[attr-defined]


def test_a_long_way_between_two_parts_of_the_rows_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth of the size of what moves points by it, or of a radian; in time that passes."""
    for column, scale in ((1, 1.0), (2, SIZE)):
        for way, later, waits in ((0.09, 1.0, 0), (-0.11, 1.0, 1), (0.11, 1.0, 1), (0.11, 0.0, 0)):
            watch = watching(monkeypatch, Outlines(lambda x: 0.0))
            before, after = rows(0.0, start=5.0), rows(0.0, start=5.0 + later)
            after[0, column] = way * scale
            watch.see_rows(before)
            watch.see()
            watch.see_rows(np.zeros((0, 7)))
            watch.see_rows(after)
            assert watch._waits == waits and watch.found.rows == 2.0


def test_without_rows_nothing_of_them_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    watch = watching(monkeypatch, Outlines(lambda x: 0.0), windows=((0.0, 1.0),))
    watch.see_rows(rows(0.0, 5.0, 0.0))
    assert watch._waits == 0 and watch.found.rows == 3.0
    assert watching(monkeypatch, Outlines(), EVENT_DRIVEN).next_look(3.0) == math.inf


def test_limits_words_and_results(monkeypatch: pytest.MonkeyPatch) -> None:
    layers = Outlines(lambda x: x, lambda x: 0.5 * x)
    watch = watching(monkeypatch, layers, MOREAU)
    assert watch.result(0.0) == {
        "worst_m": 0.0, "resolution_m": pytest.approx(RESOLUTION), "allowed_m": pytest.approx(5e-3 * SIZE), "looks": 0,
        "between": None, "t_s": None, "x_mm": None, "y_mm": None,
    }  # fmt: skip
    found = watch.found
    found.depth, found.time, found.x, found.y, found.contact, found.looks = 3e-3, 2.25, 0.0125, -0.25, 2, 12
    assert watch.words() == "three and four overlapped by 3e+03 µm at t = 2.25 s, at (12.5, -250) mm"
    told = watch.result(2e-3)
    assert (told["worst_m"], told["between"], told["t_s"], told["x_mm"], told["y_mm"]) == (
        3e-3,
        ["three", "four"],
        2.25,
        12.5,
        -250.0,
    )
    assert (told["allowed_m"], told["looks"]) == (8e-3, 12)
    assert watch.fails(0.0) and watch.fails(7.4e-4) and not watch.fails(7.6e-4)
    other = watching(monkeypatch, layers)
    assert other.limit(1.0) == pytest.approx(RESOLUTION) and not other.fails(0.0)
    other.found.depth = 1.01 * RESOLUTION
    assert other.fails(1.0)
    other.found.depth = 0.99 * RESOLUTION
    assert not other.fails(1.0)
