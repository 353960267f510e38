"""Is the speed of a movie told as a fraction where it is one, and is a point drawn where its body stands?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.render.marks import speed_text
from watchsim.render.view import placed


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        (1.0, "true speed"),
        (2.0, "2 × true speed"),
        (1.0 / 20.0, "1/20 of true speed"),
        (9.0 / 10.0, "9/10 of true speed"),
        (0.11 * 10 / 11.0 + 0.003, "0.103 of true speed"),
        (11.0 / 12.0, "0.9167 of true speed"),
        (1e-7, "1e-07 of true speed"),
    ],
)
def test_speeds(speed: float, words: str) -> None:
    assert speed_text(speed) == words


def test_points_turn_with_their_body_and_shift_with_it() -> None:
    rng = np.random.default_rng(4)
    points, frames = rng.normal(size=(7, 2)), rng.normal(size=(5, 3))
    z = (frames[:, :1] + 1j * frames[:, 1:2]) + np.exp(1j * frames[:, 2:]) * (points[:, 0] + 1j * points[:, 1])
    assert placed(points, frames) == pytest.approx(np.stack((z.real, z.imag), axis=2), abs=1e-14)
