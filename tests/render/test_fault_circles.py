"""Can the numbers at the circles be read?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.render.fault_circles import CIRCLED, LINE, best_box, in_ranges, shared

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
        box = best_box(np.array([256.5, 256.5]), 12.0, np.array(taken), FRAME)
        for other in taken:
            wide, high = min(box[2], other[2]) - max(box[0], other[0]), min(box[3], other[3]) - max(box[1], other[1])
            assert max(wide, 0.0) * max(high, 0.0) < 0.1 * 12.0 * LINE
        taken.append(box)


def test_numbers_stay_in_the_picture() -> None:
    box = best_box(np.array([499.0, 499.0]), 30.0, np.array([(493.0, 493.0, 505.0, 505.0)]), FRAME)
    assert box[2] <= 500.0 and box[3] <= 500.0 and box[3] - box[1] == LINE
