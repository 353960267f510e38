"""Do the numbers in pictures read as they should?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from render.fake_runs import slide_run, watch_run

from watchsim.render.marks import changing_speed_text, clock, decimals_for, reading, scale_bar, signed, speed_text, turn_text
from watchsim.render.view import poses, sampled


@pytest.mark.parametrize(
    ("speed", "text"),
    [
        (1.0, "true speed"),
        (1 / 20, "1/20 of true speed"),
        (0.05, "1/20 of true speed"),
        (2 / 3, "2/3 of true speed"),
        (0.123456, "0.1235 of true speed"),
        (1e-7, "1e-07 of true speed"),
        (2.0, "2 × true speed"),
        (1.2, "1.2 × true speed"),
        (1.0625, "1.062 × true speed"),
        (9 / 11, "9/11 of true speed"),
        (10 / 11, "0.9091 of true speed"),
    ],
)
def test_speed(speed, text):
    assert speed_text(speed) == text


def test_time_in_seconds_or_after_the_start():
    assert clock((0.0, 10.0)).text(1.2345, 1 / 60) == "1.23 s"
    assert clock((19.4, 19.75)).text(19.4125, 1 / 1200) == "19.4 s + 12.5 ms"
    assert clock((3.40000046, 3.6)).label == "time after 3.4 s (ms)"
    assert clock((3.40000046, 3.6)).text(3.4125, 1 / 1200) == "3.4 s + 12.5 ms"
    assert clock((0.0, 0.3)).text(0.0125, 1 / 1200) == "12.5 ms"


def test_numbers():
    assert signed(-0.04, 1) == "0.0"
    assert signed(-1.25, 2) == "−1.25"
    assert [decimals_for(step) for step in (20.0, 1.0, 0.5, 0.01, 0.0)] == [0, 0, 1, 2, 3]


@pytest.mark.parametrize(
    ("room", "bar"), [(0.0016, (1e-3, "1 mm")), (0.0004, (2e-4, "0.2 mm")), (0.05, (0.05, "50 mm")), (3.1, (2.0, "2 m"))]
)
def test_scale_bar_is_round(room, bar):
    length, name = scale_bar(room)
    assert (length, name) == (pytest.approx(bar[0]), bar[1])


def test_poses_in_words():
    run = watch_run()
    balance = run.scene.body("balance")
    tell, ends = reading(balance, sampled(run, balance, (0.0, 2.0)))
    assert tell(np.array([0.0, 0.0, np.radians(-123.42)])) == "−123.4°"
    assert ends == ("−286.5°", "286.5°")
    lever = run.scene.body("lever")
    tell, _ = reading(lever, sampled(run, lever, (0.0, 0.9)))
    assert tell(np.array([0.0, 3e-3, np.radians(5.126)])) == "5.13°"
    slider = slide_run()
    body = slider.scene.body("slider")
    tell, _ = reading(body, sampled(slider, body, (0.0, 1.0)))
    assert tell(poses(slider, np.array([0.3]))["slider"][0]) == f"{2 * np.sin(3.0):.2f} mm"


@pytest.mark.parametrize(
    ("degrees", "text"),
    [
        (0.0, ""),
        (360.0, ""),
        (-90.0, "picture turned by 90° clockwise"),
        (20.0, "picture turned by 20° counter-clockwise"),
        (270.0, "picture turned by 90° clockwise"),
        (180.0, "picture turned by 180°"),
        (-180.0, "picture turned by 180°"),
    ],
)
def test_a_turned_picture_says_so(degrees, text):
    assert turn_text(math.radians(degrees)) == text


def test_room_for_a_slider_is_that_of_its_whole_travel():
    """2 mm · sin(10 t) along its axis: the texts at both ends say how much room the read-out needs."""
    run = slide_run()
    slider = run.scene.body("slider")
    tell, ends = reading(slider, sampled(run, slider, (0.0, 1.0)))
    frames = poses(run, np.array([0.05]))["slider"]
    assert float(tell(frames[0]).split()[0]) == pytest.approx(2.0 * math.sin(0.5), abs=6e-3)
    assert [float(text.replace("−", "-").split()[0]) for text in ends] == pytest.approx([-2.0, 2.0], abs=6e-3)
    assert [text.split()[1] for text in ends] == ["mm", "mm"]


@pytest.mark.parametrize(
    ("speed", "text"),
    [
        (1.004, "true speed"),
        (0.996, "true speed"),
        (0.7, "0.7 × true speed"),
        (0.5, "1/2 of true speed"),
        (1 / 43.2, "1/43 of true speed"),
        (1 / 432.0, "1/430 of true speed"),
        (2.46, "2.5 × true speed"),
    ],
)
def test_a_speed_that_changes_has_two_digits(speed: float, text: str) -> None:
    assert changing_speed_text(speed) == text


@pytest.mark.parametrize("exponent", range(-6, 1))
@pytest.mark.parametrize("step", [1, 2, 5])
def test_a_scale_bar_as_wide_as_its_room_fits(step: int, exponent: int) -> None:
    """To the last digit; with a hair less room it is the next smaller one."""
    length = step * 10.0**exponent
    smaller = {1: 0.5, 2: 0.5, 5: 0.4}[step]
    assert scale_bar(length)[0] == pytest.approx(length, rel=1e-12)
    assert scale_bar(length * (1.0 - 1e-6))[0] == pytest.approx(smaller * length, rel=1e-12, abs=0.0)
