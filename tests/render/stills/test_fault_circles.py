"""Can the numbers at the circles be read?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from watchsim.drawing.findings import Finding
from watchsim.drawing.read import read
from watchsim.render.drawing_picture import CIRCLED, LINE, best_box, in_ranges, label, places, shared

FRAME = np.array([0.0, 0.0, 500.0, 500.0])


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ([4], "4"),
        ([2, 1], "1, 2"),
        ([7, 8, 9, 3], "3, 7–9"),
        ([1, 3, 5, 7, 9, 11], "1, 3 … (in all 6)"),
        (list(range(1, 60)), "1–59"),
    ],
)
def test_numbers_in_ranges(numbers: list[int], text: str) -> None:
    assert in_ranges(numbers) == text


def test_faults_a_hair_apart_share_a_circle_and_none_is_forgotten() -> None:
    points = [(k, np.array([10.0 * (k % 20) + 0.1 * (k % 3), 10.0 * (k // 20)])) for k in range(300)]
    circles, left = shared([*points, (300, np.array([0.5, 0.5]))])
    assert len(circles) == CIRCLED
    assert sum(len(numbers) for _, numbers in circles) + left == 301
    assert [0, 300] in [numbers for _, numbers in circles]


def test_numbers_avoid_each_other_where_there_is_room() -> None:
    taken: list[tuple[float, float, float, float]] = [(250.0, 250.0, 263.0, 263.0)]
    for _ in range(12):
        box, _ = best_box(np.array([256.5, 256.5]), 12.0, np.array(taken), FRAME)
        for other in taken:
            wide, high = min(box[2], other[2]) - max(box[0], other[0]), min(box[3], other[3]) - max(box[1], other[1])
            assert max(wide, 0.0) * max(high, 0.0) < 0.1 * 12.0 * LINE
        taken.append(box)


def test_numbers_stay_in_the_picture() -> None:
    box, _ = best_box(np.array([499.0, 499.0]), 30.0, np.array([(493.0, 493.0, 505.0, 505.0)]), FRAME)
    assert box[2] <= 500.0 and box[3] <= 500.0 and box[3] - box[1] == LINE


def test_long_numbers_are_shortened_only_where_they_would_cover_others() -> None:
    centre, numbers = np.array([250.0, 250.0]), [5, 9, 14, 20]
    ring = (243.5, 243.5, 256.5, 256.5)
    assert label(centre, numbers, np.array([ring]), FRAME)[1] == "5, 9 … (in all 4)"
    # Stripes leave free columns too narrow for all of the numbers.
    stripes = [(x, 0.0, x + 1.0, 500.0) for x in np.arange(0.0, 500.0, 40.0)]
    box, text = label(centre, numbers, np.array([ring, *stripes]), FRAME)
    assert text == "5 +3" and not any(box[0] < high and low < box[2] for low, _, high, _ in stripes)
    assert label(centre, [5], np.array([ring, *stripes]), FRAME)[1] == "5"


def test_both_ends_of_a_gap_are_circled(tmp_path: Path) -> None:
    page = tmp_path / "open.svg"
    path = '<path fill="none" stroke="black" d="M 1,1 H 9 V 9 H 1 V 3"/>'
    size = 'width="10mm" height="10mm" viewBox="0 0 10 10"'
    page.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{path}</svg>')
    (gap,) = [finding for finding in read(page).findings if finding.code == "open-outline"]
    (first, second) = places(gap)
    assert np.hypot(first[0] - second[0], first[1] - second[1]) == pytest.approx(2.0) and first[0] == pytest.approx(second[0])
    assert places(Finding("units", "error", "nowhere")) == []
    assert shared([(1, np.zeros(2)), (1, np.array([30.0, 0.0])), (2, np.zeros(2)), (2, np.ones(2))])[1] == 0
    assert [numbers for _, numbers in shared([(1, np.zeros(2)), (1, np.ones(2))])[0]] == [[1]]
