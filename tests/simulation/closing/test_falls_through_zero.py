"""Is a contact found to close where its gap first falls through zero? Gaps here are polynomials of time, roots are numpy's."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Chebyshev, Polynomial
from plain_kernels import in_python
from scripted_gaps import END, OPTIONS, START, Search

from watchsim.model.records import ARC, LINE
from watchsim.simulation.first_closing import time_of_impact


def falls(gap: Any, start: float, end: float) -> list[float]:
    """The times within the search at which the gap falls through zero."""
    roots = [float(root.real) for root in gap.roots() if abs(root.imag) < 1e-12]
    return sorted(root for root in roots if start < root < end and gap.deriv()(root) < 0.0)


GAPS = [Chebyshev(np.random.default_rng(seed).normal(size=7), domain=[0.4, 2.6]) + 1.5 * (seed % 3 == 0) for seed in range(30)]


@pytest.mark.parametrize("longest", [math.inf, 0.3])
@pytest.mark.parametrize("seed", range(30))
def test_the_first_fall_through_zero_closes_the_contact(seed: int, longest: float) -> None:
    """Also of what begins on the far side: it must come out first."""
    gap = GAPS[seed]
    roots, search = falls(gap, START, END), Search(gap, longest=longest)
    time, closes = search.found()
    assert closes == bool(roots)
    assert time == pytest.approx(roots[0] if roots else END, rel=1e-11)
    assert search.turns > 1 or not closes or gap(time) > -0.5 * OPTIONS.gap_zero  # it has been further than rounding from zero
    assert len(search.looks) < 60


def test_these_gaps_close_stay_open_and_come_from_behind() -> None:
    kinds = [(gap(START) > 0.0, bool(falls(gap, START, END))) for gap in GAPS]
    assert all(kinds.count((outside, closes)) >= 2 for outside in (True, False) for closes in (True, False))


@pytest.mark.parametrize("off", [0.0, 0.9e-13])
def test_a_contact_that_has_just_rebounded_closes_when_it_comes_back(off: float) -> None:
    """Its gap is zero to rounding and rises; it has left it when it falls."""
    time, closes = Search(Polynomial([off, 1.0, -0.8])).found(start=0.0)
    assert closes and time == pytest.approx(1.25)


def test_a_gap_of_zero_that_falls_all_the_time_closes_when_it_is_no_longer_rounding() -> None:
    time, closes = Search(Polynomial([1.0, -2.0])).found(start=START)
    assert closes and 0.5 + 0.49e-13 < time < 0.5 + 2e-13


@pytest.mark.parametrize(("end", "at_root"), [(END, True), (START + 5e-6, False)])
def test_one_that_falls_as_it_comes_within_its_primitives_closes_there(end: float, at_root: bool) -> None:
    """It has not been in contact, so that it need not leave zero before; where that is beyond the end, it closes at once."""
    beside = iter([-1e-6])
    search = Search(Polynomial([0.9e-13 + 1e-8 * START, -1e-8]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    time, closes = search.found(end=end)
    assert closes and search.looks[1] - START == pytest.approx(0.5e-6, rel=1e-2)
    assert abs(search.gap(time)) < 1e-18 if at_root else time == search.looks[1]


def test_both_bodies_are_brought_to_the_time() -> None:
    placed = []

    def body_on_path(model: object, state: object, step: object, body: int, tau: float, path: object) -> None:
        placed.append((body, tau))

    in_python(time_of_impact._place, body_on_path=body_on_path)(None, None, (7, 8), 1.5, None, None)
    assert placed == [(7, 1.5), (8, 1.5)]


@pytest.mark.parametrize(("gap", "due"), [(-0.9e-8, True), (-1.1e-8, False)])
def test_what_is_a_little_behind_and_goes_on_falling_closes_at_once(gap: float, due: bool) -> None:
    assert Search(Polynomial([gap + 0.2, -0.4])).found() == ((START, True) if due else (END, False))


@pytest.mark.parametrize("closes_at", [2.0, 3.0])
def test_what_falls_beside_its_primitives_does_not_close_until_it_has_come_out(closes_at: float) -> None:
    """The gap falls through zero at 1 beside the line, which it enters at 1.3; it comes out at 1.5 and falls at 2."""
    gap = Polynomial.fromroots([1.0, 1.5, closes_at]) * -1.0
    assert falls(gap, START, END) == pytest.approx([1.0] + ([2.0] if closes_at == 2.0 else []))
    for kind in (LINE, ARC):
        time, closes = Search(gap, (None, lambda t: 0.1 * (t - 1.3)), kind=kind).found()
        assert (time, closes) == ((pytest.approx(2.0), True) if closes_at == 2.0 else (END, False))
        time, closes = Search(gap, (lambda t: 0.05 * (t - 1.3), None), kind=kind).found()
        assert (time, closes) == ((pytest.approx(2.0), True) if closes_at == 2.0 else (END, False))


@pytest.mark.parametrize(("beyond", "closes"), [(0.9, True), (1.1, False)])
def test_a_little_beyond_the_end_of_a_primitive_counts(beyond: float, closes: bool) -> None:
    for which in range(2):
        inside = [None, None]
        inside[which] = lambda t: -beyond * OPTIONS.extent  # type: ignore[call-overload]
        assert Search(Polynomial([1.0, -0.8]), tuple(inside)).found()[1] == closes


def test_gaps_count_from_the_level_to_which_faces_have_let_bodies_sink() -> None:
    """Looked up at the first look and while the contact lies beside its primitives."""
    asked: list[tuple[float, float]] = []

    def level(model, options, k, gap, inside_b, path) -> float:
        asked.append((gap, inside_b))
        return -0.25

    search = Search(Polynomial([1.0, -0.8]), sunk_level=level)
    time, closes = search.found()
    assert closes and time == pytest.approx(1.25 / 0.8)
    assert asked == [(pytest.approx(0.6), 1.0)]
    asked.clear()
    search = Search(Polynomial([1.0, -0.8]), (None, lambda t: 0.5 * (t - 1.3)), sunk_level=level)
    assert search.found() == (pytest.approx(1.25 / 0.8), True)
    beside = [t for t in search.looks if t < 1.3]
    assert len(asked) == len(beside) + 1 and asked[0] == (pytest.approx(0.6), pytest.approx(-0.4))


def test_what_does_not_move_is_not_looked_at() -> None:
    still = {"next_stretch": lambda model, options, k, left, step, path: (left, 0.0, 0.0, 0.0)}
    search = Search(Polynomial([1.0]), **still)
    assert search.found() == (END, False) and search.looks == []


def test_a_contact_that_is_held_is_looked_at_again_when_it_could_have_come_apart() -> None:
    held = iter([0.125, 0.25, 0.0])
    given: list[Any] = []

    def time_held(model, state, options, k, tau, rate, bounds, path) -> float:
        given.append((tau, rate, bounds[2:]))
        return next(held)

    search = Search(Polynomial([0.0, -2e-9]), time_held=time_held)
    time, closes = search.found()
    assert closes and search.looks == [0.5, 0.625, 0.875]
    assert given == [(t, -2e-9, (0.3, math.inf)) for t in search.looks] and time == 0.875
