"""With how many arcs is a curve tried next, and when is the search over?"""

from __future__ import annotations

import numpy as np
import pytest
from curves import spline

from watchsim.geometry.biarcs import ArcChain, Bundle, Curve
from watchsim.geometry.fitting import BRISK, MOST, THOROUGH, Found, Search, fewest

BOW = [(0, 0), (1, 3), (4, 3), (5, -1)]
FOUND = Found(ArcChain(*[None] * 5), 1e-9)  # type: ignore[arg-type]


def test_the_first_attempt_is_what_the_curvature_asks_for_and_a_brisk_one_has_more() -> None:
    assert [Search(count, THOROUGH).count for count in (1, 7, 100)] == [1, 7, 100]
    assert [Search(count, BRISK).count for count in (1, 7, 100)] == [2, 10, 130]


def test_what_seems_necessary_is_tried_next_and_more_where_that_fails_again() -> None:
    search = Search(100, THOROUGH)
    assert search.learn(120, None) and search.count == 120
    assert search.learn(119, None) and search.count == 120  # once more, laid better
    assert search.learn(118, None) and search.count == 121
    brisk = Search(100, BRISK)
    assert brisk.count == 130 and brisk.learn(110, None) and brisk.count == 131


def test_few_arcs_are_tried_more_often_since_each_counts_for_more() -> None:
    for count, times in ((1, MOST), (9, MOST), (10, 4), (12, 4), (16, 3), (24, 2), (96, 2)):
        search = Search(count, THOROUGH)
        for _ in range(times - 1):
            assert search.learn(count, None) and search.count == count
        assert search.learn(count, None) and search.count == count + 1
    assert Search(96, BRISK).enough_attempts(96) == 1 and Search(20, BRISK).enough_attempts(20) == 2


def test_a_search_without_success_ends_at_four_times_the_first_count() -> None:
    for needed, goes_on in ((56, True), (57, False)):
        assert Search(10, THOROUGH).learn(needed, None) is goes_on


@pytest.mark.parametrize(
    ("count", "needed", "goes_on", "following"),
    [
        (100, 90, True, 90),  # far fewer may do
        (100, 97, False, 97),  # within four per cent of what seems necessary
        (100, 96, True, 96),
        (104, 100, False, 100),
        (20, 20, False, 19),  # one fewer than necessary is no use
        (50, 50, False, 49),
        (2, 1, False, 1),  # a single arc is tried elsewhere
        (3, 2, True, 2),
        (3, 1, False, 1),
    ],
)
def test_after_a_success_fewer_are_tried_as_long_as_fewer_could_do(
    count: int, needed: int, goes_on: bool, following: int
) -> None:
    search = Search(count, THOROUGH)
    assert search.learn(needed, FOUND) is goes_on
    assert search.count == following and search.best is FOUND and search.fewest == count


def test_between_a_failure_and_a_success_nothing_is_left_to_try() -> None:
    search = Search(100, THOROUGH)
    assert search.learn(80, FOUND) and search.count == 80
    assert search.learn(95, None) and search.count == 95
    assert not search.learn(97, None) and search.fewest == 100
    again = Search(100, THOROUGH)
    assert again.learn(90, FOUND) and again.learn(90, None) and again.count == 90
    assert again.learn(90, None) and again.count == 91  # tried twice: one more
    better = Found(FOUND.arcs, 2e-9)
    assert not again.learn(90, better) and again.best is better and again.fewest == 91


def test_each_curve_is_searched_as_long_as_it_needs_whatever_the_others_do() -> None:
    easy, hard = (
        spline(3, [0] * 4 + [1] * 4, [(1e-3 * x, 1e-3 * y) for x, y in p]) for p in (BOW, [(0, 0), (3, 0), (2, 4), (5, 4)])
    )

    def counts(*curves: Curve) -> list[int]:
        found = fewest(Bundle(curves), np.array([1e-5, 1e-7][-len(curves) :]), 20)
        return [len(one.arcs.curvatures) for one in found if one is not None]

    one, other = counts(easy, hard)
    assert 2 <= one < 10 < other and [other] == counts(hard)
