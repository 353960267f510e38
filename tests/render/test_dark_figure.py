"""Can everything in a plot be read on dark ground, and do parts keep their colours?"""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.lines import Line2D
from matplotlib.text import Text
from render.fake_runs import watch_run

from watchsim.render.kinematics_plot import plot_kinematics
from watchsim.render.palette import BRASS, DARK, INK, RUBY, STEEL, contrast, dark, on_dark
from watchsim.render.style import SERIES, figure, key

GROUND = to_rgb(DARK.background)


@pytest.mark.parametrize(
    ("one", "other", "expected"), [("white", "black", 21.0), ("#777777", "white", 4.48), ("red", "red", 1.0)]
)
def test_contrast_is_that_of_the_guidelines(one, other, expected):
    assert contrast(to_rgb(one), to_rgb(other)) == pytest.approx(expected, abs=0.005)


def test_every_word_and_curve_of_a_plot_can_be_read():
    made = plot_kinematics(watch_run())
    shown = made.axes[0].lines[0]
    axes = made.add_axes((0.8, 0.8, 0.1, 0.1))
    lines = [axes.plot([0, 1], [k, k + 1], color=colour)[0] for k, colour in enumerate((*SERIES, "#222222", "navy", "#777777"))]
    key(axes, [(line, "a curve") for line in lines])
    axes.annotate("here", (0.5, 0.5), (0.1, 0.1), color="darkred", arrowprops={"arrowstyle": "-", "color": "darkred"})
    before = len(made.findobj())
    assert dark(made) is made and len(made.findobj()) == before
    words = [one for one in made.findobj(Text) if one.get_text() and one.get_visible()]
    ruled = {id(line) for one in made.axes for axis in (one.xaxis, one.yaxis) for line in axis.get_gridlines()}
    curves = [one for one in made.findobj(Line2D) if len(one.get_xdata()) > 1 and id(one) not in ruled]
    assert len(words) > 10 and shown in curves
    for one in (*words, *curves):
        assert contrast(to_rgb(one.get_color()), GROUND) >= 4.45, one
    arrow = axes.texts[-1].arrow_patch
    assert contrast(arrow.get_edgecolor()[:3], GROUND) >= 4.45
    pixels = np.asarray(made.canvas.buffer_rgba()) if made.canvas.draw() is None else None
    assert pixels is not None and tuple(pixels[0, 0, :3]) == tuple(round(255 * part) for part in GROUND)


def test_parts_keep_what_they_wear_and_what_is_clear_stays_clear():
    for look in (BRASS, STEEL, RUBY):
        assert on_dark(look.fill, face=True) == to_rgba(look.fill)
    made = figure()
    axes = made.subplots()
    (clear,) = axes.bar([0.0], [1.0], color="none", edgecolor=INK)
    (plain,) = axes.bar([1.0], [1.0], color=BRASS.fill, edgecolor="none", alpha=0.8)
    dark(made)
    assert clear.get_facecolor()[3] == 0.0 and clear.get_edgecolor() == to_rgba(DARK.ink)
    assert plain.get_facecolor() == to_rgba(BRASS.fill, 0.8)
