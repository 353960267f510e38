"""Does the picture of wear colour what slides, by as much as it wears, where it lies?"""

import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import LineCollection

import watchsim as ws
from watchsim.analysis.wear import CELLS

SLIDER = """[bodies.block]
motion = "slide"
axis = [1, 0]
circle = "2 mm"
mass = "1 g"
velocity = "{speed} m/s"
[bodies.plate]
motion = "slide"
axis = [0, 1]
mass = "2 g"
position = ["0 mm", "-2 mm"]
line = [["60 mm", "0 mm"], ["-4 mm", "0 mm"]]
[[torques]]
body = "plate"
value = "{press} N"
[[contacts]]
between = ["block", "plate"]
friction = 0.1
[run]
duration = "0.1 s"
"""


def test_a_line_that_is_slid_over_has_the_colour_of_its_load(tmp_path: Path) -> None:
    """N for each metre of way: N·m for each mm is a thousandth of the load, here in one run, times a year over its time."""
    press = 0.02
    (tmp_path / "scene.toml").write_text(SLIDER.format(speed=0.3, press=press))
    run = ws.simulate(ws.load(tmp_path))
    figure = ws.plot_wear(run)
    found = {axes.get_title(): axes for axes in figure.axes if axes.get_title()}
    worn = [one for one in found["plate, line"].collections if isinstance(one, LineCollection)]
    values = np.concatenate([np.asarray(one.get_array()) for one in worn])
    year = 365.25 * 86400.0 / 0.1
    assert np.median(values) == pytest.approx(press * 1e-3 * year, rel=1e-2)
    # Where the block has been: from 0 to v t - ½ μ N t²/m on the line, which is 64 mm long in so many pieces.
    way = 0.3 * 0.1 - 0.5 * 0.1 * press / 1e-3 * 0.1**2
    ends = np.concatenate([np.concatenate(one.get_segments()) for one in worn])[:, 0]
    assert ends.min() == pytest.approx(0.0, abs=64.0 / CELLS) and ends.max() == pytest.approx(1e3 * way, abs=64.0 / CELLS)
    assert "N·m a year" in found["plate, line"].get_xlabel()


def test_panels_are_stones_and_one_tooth_of_all() -> None:
    run = ws.simulate("profiles/swiss_lever", 1.0)
    titles = [axes.get_title() for axes in ws.plot_wear(run).axes if axes.get_title()]
    assert {"lever, entry stone", "lever, exit stone", "balance, roller jewel", "lever, fork", "banking"} <= set(titles)
    assert sum("tooth" in title for title in titles) == 1
    with pytest.raises(ValueError, match="no step of the run"):
        ws.plot_wear(run, (5.0, 6.0))


def test_what_does_not_slide_does_not_wear(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SLIDER.format(speed=0.0, press=0.02))
    run = ws.simulate(ws.load(tmp_path))
    assert math.isclose(run.end_u[0], 0.0)
    with pytest.raises(ValueError, match="nothing slides"):
        ws.plot_wear(run)
