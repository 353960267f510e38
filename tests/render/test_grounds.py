"""Can everything be read and told apart on light and on dark ground?"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from render.fake_runs import watch_run

from watchsim.render.movie import frame
from watchsim.render.palette import BLUED, BRASS, DARK, FIXED, LIGHT, NIGHT, OTHERS, RUBY, STEEL, Style, mixed

STYLES = (LIGHT, DARK)
READ, SEEN, PALE_SEEN = 4.5, 3.0, 1.25  # contrasts: of words and of marks as WCAG 2.2 asks for; of what is meant to recede


def luminance(colour: str) -> float:
    """Relative luminance (WCAG 2.2)."""
    parts = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in to_rgb(colour)]
    return float(np.dot(parts, (0.2126, 0.7152, 0.0722)))


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_words_and_marks_stand_out(style: Style) -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    for words in (style.ink, style.faint):
        assert contrast(words, style.background) >= READ
    for mark in (style.contact, style.force, style.line(FIXED), *(style.curve(look) for look in OTHERS)):
        assert contrast(mark, style.background) >= SEEN, mark
    for shade in style.phases.values():
        assert contrast(style.curve(BLUED), shade) >= SEEN  # a curve over it
        assert contrast(style.ink, shade) >= READ


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_parts_are_seen_by_face_or_by_edge(style: Style) -> None:
    for look in (BRASS, STEEL, RUBY, BLUED, NIGHT, FIXED, *OTHERS):
        assert max(contrast(look.fill, style.background), contrast(look.edge, style.background)) >= SEEN, look


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.name)
def test_what_cannot_touch_recedes_and_is_still_seen(style: Style) -> None:
    pale = style.worn(type(BRASS)(BRASS.fill, BRASS.edge, BRASS.line, pale=True))
    assert (
        PALE_SEEN
        <= contrast(pale.fill, style.background)
        < contrast(BRASS.edge if style is LIGHT else BRASS.fill, style.background)
    )
    assert style.worn(BRASS) is BRASS


def test_fixed_parts_are_unlike_all_that_move() -> None:
    for look in {BRASS, STEEL, RUBY, BLUED, NIGHT, *OTHERS}:
        apart = np.abs(np.array(to_rgb(look.fill)) - np.array(to_rgb(FIXED.fill))).max()
        assert apart > 0.15, look
    for one, other in combinations(OTHERS, 2):
        assert one.fill != other.fill


def test_a_frame_on_dark_ground_has_the_same_parts_in_the_same_places() -> None:
    run = watch_run()
    light, dark = (frame(run, 0.7, (640, 360), dark=on) for on in (False, True))
    for colour in (BRASS.fill, RUBY.fill, FIXED.fill):
        wanted = np.round(255 * np.array(to_rgb(colour)))
        one, other = (np.all(picture == wanted, axis=2) for picture in (light, dark))
        assert one.sum() > 20 and np.sum(one != other) <= 0.01 * one.sum()  # edges may mix to the very colour
    for picture, style in ((light, LIGHT), (dark, DARK)):
        assert np.all(picture[0, 0] == np.round(255 * np.array(to_rgb(style.background))))


def test_mixing_goes_from_one_colour_to_the_other() -> None:
    assert mixed("#102030", "#ffffff", 0.0) == "#102030" and mixed("#102030", "#fefefe", 1.0) == "#fefefe"
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"
