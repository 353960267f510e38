"""Does a hairspring keep its ends and its length while it breathes?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.hairspring import Coil, Spiral

COIL = Coil(0.55e-3, 2.8e-3, 13.0, math.radians(70.0), 3e-5)
FINE = 20_000
AMPLITUDE = math.radians(330.0)

turned = st.floats(-AMPLITUDE, AMPLITUDE)


def length(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def test_at_rest_it_is_the_spiral_that_has_mass() -> None:
    line = COIL.line(0.0, FINE)
    assert length(line) == pytest.approx(Spiral(COIL.inner, COIL.outer, COIL.turns).length, rel=1e-6, abs=0.0)
    radius, angle = np.hypot(*line.T), np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    pitch = (COIL.outer - COIL.inner) / COIL.turns
    assert np.allclose(radius, COIL.inner + pitch * (angle - angle[0]) / math.tau, atol=1e-12)
    assert angle[-1] - angle[0] == pytest.approx(math.tau * COIL.turns)


@given(turned)
def test_the_collet_turns_and_the_stud_stays(angle: float) -> None:
    line, rest = COIL.line(angle, 400), COIL.line(0.0, 400)
    c, s = math.cos(angle), math.sin(angle)
    assert line[0] == pytest.approx(np.array([[c, -s], [s, c]]) @ rest[0], abs=1e-12)
    assert line[-1] == pytest.approx(COIL.outer * np.array([math.cos(COIL.stud), math.sin(COIL.stud)]), abs=1e-12)


@given(turned)
def test_its_length_stays_and_its_coils_never_cross(angle: float) -> None:
    line = COIL.line(angle, FINE)
    assert length(line) == pytest.approx(length(COIL.line(0.0, FINE)), rel=1e-4, abs=0.0)
    assert np.all(np.diff(np.hypot(*line.T)) > 0.0)


def test_it_widens_as_it_unwinds_and_narrows_as_it_is_wound_up() -> None:
    mean = [np.hypot(*COIL.line(angle, FINE).T).mean() for angle in np.linspace(-AMPLITUDE, AMPLITUDE, 9)]
    assert np.all(np.diff(mean) > 0.0)


@given(st.floats(1e-8, 1e-3), turned)
def test_chords_stray_no_further_than_asked(deviation: float, angle: float) -> None:
    count = COIL.chords(deviation)
    if count >= 180 * COIL.turns:  # as fine as it gets
        return
    line, fine = COIL.line(angle, count), COIL.line(angle, 8 * count)
    middle = 0.5 * (line[1:] + line[:-1])
    off = np.hypot(*(middle - fine[4::8]).T)
    assert off.max() <= 1.3 * max(deviation, 1e-12)  # coils that bulge reach a little beyond the stud's radius


def test_even_a_spring_turned_too_far_is_drawn() -> None:
    short = Coil(1e-3, 2e-3, 1.0, 0.0, 1e-5)
    for angle in (-100.0, 100.0):
        line = short.line(angle, 50)
        assert np.isfinite(line).all() and np.all(np.diff(np.hypot(*line.T)) > 0.0)


def test_chords_of_a_turn_are_neither_too_few_nor_too_many() -> None:
    assert [COIL.chords(deviation) for deviation in (1e-2, 1e-12)] == [24 * 13, 180 * 13]
    half = COIL.outer * (1.0 - math.cos(math.pi / 60.0))  # how far a sixtieth of a turn lies from its chord
    assert COIL.chords(half) == pytest.approx(60 * 13, rel=2e-3, abs=0.0)
