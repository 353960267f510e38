"""Does a patch that keeps its look show the colours that it was given?"""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.path import Path

from watchsim.render.parts import LastingPatch


@pytest.mark.parametrize(("alpha", "grey"), [(None, 230), (0.5, 128)])
def test_a_shadow_is_seen_through(alpha: float | None, grey: int) -> None:
    """Black of a tenth on white; an `alpha` of the patch takes the place of that of its colour, as in matplotlib."""
    figure = Figure(figsize=(1.0, 1.0), dpi=20)
    canvas = FigureCanvasAgg(figure)
    square = Path([(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0), (-1.0, -1.0)])
    patch = LastingPatch(square, facecolor=(0.0, 0.0, 0.0, 0.1), edgecolor="none", alpha=alpha, transform=figure.transFigure)
    figure.add_artist(patch)
    canvas.draw()
    assert np.asarray(canvas.buffer_rgba())[10, 10, 0] == pytest.approx(grey, abs=2)
