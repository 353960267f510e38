"""Can everybody tell the colours of curves and phases apart?"""

from __future__ import annotations

import pytest
from render.figures.colour_vision import VISIONS, least_difference

import watchsim as ws
from watchsim.render.palette import PHASE_LINES, PHASES, looks
from watchsim.render.style import SERIES


def test_the_measure_knows_what_is_confused() -> None:
    assert least_difference(("#000000", "#ffffff"), "usual") == pytest.approx(100.0, abs=0.01)
    assert least_difference(("#ff0000", "#ff0000"), "usual") == 0.0
    red_and_green = ("#c04040", "#708030")  # one lightness to a deuteranope
    assert least_difference(red_and_green, "deuteranopia") < 0.5 * least_difference(red_and_green, "usual")


@pytest.mark.parametrize("vision", VISIONS)
def test_colours_of_curves_are_distinct(vision: str) -> None:
    assert least_difference(SERIES, vision) > 15.0
    assert least_difference(dict.fromkeys(PHASE_LINES.values()), vision) > 15.0


@pytest.mark.parametrize("vision", VISIONS)
def test_shades_of_phases_are_distinct_from_each_other_and_from_paper(vision: str) -> None:
    assert least_difference((*dict.fromkeys(PHASES.values()), "#ffffff"), vision) > 9.0


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("profile", ["swiss_lever", "bench_lever", "coaxial", "graham", "geneva"])
def test_parts_in_one_panel_are_distinct(profile: str, vision: str) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    worn = looks(scene)
    moving = [worn[body.name].line for body in scene.bodies if body.motion != "fixed"]
    assert least_difference(moving, vision) > 15.0
