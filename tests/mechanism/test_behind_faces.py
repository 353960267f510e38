"""How far is a point behind a face, and is it beside it at all?"""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from watchsim.geometry.primitives import Line
from watchsim.mechanism.overlap_depth import _behind_line, corner_depth


@pytest.mark.parametrize("turned", [0.0, 0.8, 2.0, -2.5])
def test_behind_a_line(turned: float) -> None:
    """Along it and to its left, in a frame turned and shifted with it."""
    c, s = math.cos(turned), math.sin(turned)
    x0, y0, length = 3e-3, -2e-3, 5e-3
    face = Line(x0, y0, x0 + length * c, y0 + length * s)
    along, left = np.array([(1e-5, 2e-3), (4.99e-3, -1e-3), (-1e-5, 1e-3), (5.01e-3, 1e-3), (5e-4, 0.0)]).T
    points = np.column_stack((x0 + along * c - left * s, y0 + along * s + left * c))
    beside, behind = _behind_line(face, points)
    assert beside.tolist() == [True, True, False, False, True]
    assert behind == pytest.approx(left, abs=1e-15)


@pytest.mark.parametrize(
    ("box", "depth", "place"),
    [
        ((-1.0, 0.3, 2.0, 5.0), 0.2, (0.0, 0.5)),  # xmin, ymin, xmax, ymax
        ((-0.1, 0.3, 2.0, 5.0), 0.1, (0.0, 0.5)),
        ((-1.5, 0.1, 0.5, 5.0), 0.4, (0.0, 0.5)),
        ((-1.0, 0.5, 1.0, 2.0), -1.0, (0.0, 0.0)),  # on the ridge
        ((-1.0, 2.0, 1.0, 3.0), -1.0, (0.0, 0.0)),
        ((-1.0, -1.0, 2.5, 5.0), -1.0, (0.0, 0.0)),  # round one end
        ((-2.5, -1.0, 1.0, 5.0), -1.0, (0.0, 0.0)),
    ],
)
def test_depth_of_a_corner_in_a_box(box: tuple[float, ...], depth: float, place: tuple[float, float]) -> None:
    roof = np.array([(2.0, 0.0), (1.0, 0.25), (0.0, 0.5), (-1.0, 0.25), (-2.0, 0.0)])
    found, where = corner_depth(roof, shapely.box(*box))
    assert found == pytest.approx(depth)
    assert where == place
