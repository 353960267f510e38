"""For how long can a gap certainly not close? Against worst cases whose roots numpy finds."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import ARC, FIXED, LINE, PIVOT, SLIDE
from watchsim.simulation.first_closing import safe_times

IMMOVABLE = 1e-12  # sine² of the angle
OPTIONS = SimpleNamespace(gap_zero=1e-13, behind=1e-8, speed_zero=1e-8, extent=1e-9)


def ask(name: str, *arguments, **instead):
    return in_python(getattr(safe_times, name), **instead)(*arguments)


def parabola(room: float, approach: float, bend: float) -> float:
    """When room - approach t - bend t²/2 is first zero."""
    roots = np.roots([-0.5 * bend, -approach, room])
    return float(min((root.real for root in roots if abs(root.imag) < 1e-12 and root.real > 0.0), default=math.inf))


@pytest.mark.parametrize("seed", range(20))
def test_a_gap_closes_no_earlier_than_both_bounds_allow(seed: int) -> None:
    """Of its rate, and of its second derivative; while the centres keep half their distance normals turn that much at most."""
    rng = np.random.default_rng(seed)
    room, bend, closing = 10.0 ** rng.uniform(-6.0, -2.0), 10.0 ** rng.uniform(-2.0, 3.0), 10.0 ** rng.uniform(-2.0, 0.0)
    approach, distance = closing * rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-3.0, -1.0)
    found = ask("safe_time", room, approach, closing, bend, math.inf)
    assert found == pytest.approx(max(room / closing, parabola(room, approach, bend)), rel=1e-9, abs=0.0)
    more = bend + 2.0 * closing**2 / distance
    limit = 0.5 * distance / closing
    found = ask("safe_time", room, approach, closing, bend, distance)
    assert found == pytest.approx(max(room / closing, min(parabola(room, approach, more), limit)), rel=1e-9, abs=0.0)


def test_without_bend_a_receding_gap_is_safe_as_long_as_its_bounds_hold() -> None:
    assert ask("safe_time", 1.0, -0.5, 2.0, 0.0, math.inf) == math.inf
    assert ask("safe_time", 1.0, 0.5, 2.0, 0.0, math.inf) == 2.0
    assert ask("safe_time", 1.0, 0.0, 2.0, 0.0, 0.0) == 0.5  # where centres coincide, the rate alone


def outside(a, b, motion=(1e-4, 1e-5), distance=0.2, kinds=(ARC, LINE)) -> float:
    """(how far inside, largest radius) of each."""
    parts = [SimpleNamespace(radius=size, length=0.5 * size, kind=kind) for (_, size), kind in zip((a, b), kinds, strict=True)]
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=parts)
    return ask("time_outside", model, 0, a[0], b[0], motion, distance)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_contact_stays_outside_as_long_as_neither_point_nor_normal_can_have_come_so_far(scale: float) -> None:
    """In any unit of time; the normal turns with the bodies and with the line between their centres."""
    closing, swing = 1e-4 * scale, 1e-5 * scale
    turn = swing + closing / 0.1
    motion = (closing, swing)
    assert outside((-1e-6, 0.02), (1.0, 0.03), motion) == pytest.approx(1e-6 / (turn * 0.02))
    assert outside((1.0, 0.02), (-1e-6, 0.03), motion) == pytest.approx(1e-6 / closing)
    assert outside((1.0, 0.02), (-1e-6, 0.03), motion, kinds=(ARC, ARC)) == pytest.approx(1e-6 / (turn * 0.03))
    assert outside((-1e-6, 0.02), (-5e-7, 0.03), motion) == pytest.approx(1e-6 / (turn * 0.02))
    assert outside((-5e-8, 0.02), (-5e-7, 0.03), motion) == pytest.approx(5e-7 / closing)
    assert outside((-1.0, 0.02), (-1.0, 0.03), motion) == pytest.approx(0.1 / closing)  # no longer than the centres stay apart
    assert outside((0.0, 0.02), (0.0, 0.03), motion) == 0.0


def test_what_does_not_turn_stays_outside() -> None:
    assert outside((-1e-9, 0.02), (1.0, 0.03), (1e-3, 0.0), math.inf) == math.inf


@pytest.mark.parametrize(
    ("gap", "rate", "is_outside", "clear", "due"),
    [
        (1e-13, -1e-9, True, True, True),
        (1e-13, -1e-9, True, False, False),
        (1.1e-13, -1.0, True, True, False),
        (0.0, 0.0, True, True, False),
        (-1.1e-13, 1.0, True, False, True),
        (-1e-13, 1.0, True, True, False),
        (-1e-8, -1.1e-8, False, True, True),
        (-1.1e-8, -1.0, False, True, False),
        (1.0, -1.1e-8, False, True, True),
        (0.0, -0.9e-8, False, True, False),
        (-1e-8, -0.9e-8, False, True, True),
        (-1e-8, 0.0, False, True, False),
    ],
)
def test_when_a_gap_is_due(gap: float, rate: float, is_outside: bool, clear: bool, due: bool) -> None:
    assert bool(ask("is_due", gap, rate, is_outside, clear, OPTIONS)) == due


def test_a_gap_may_fall_to_zero_or_a_little_below_where_it_does_not_leave() -> None:
    assert ask("room_outside", 1e-6, -1.0, OPTIONS) == 1e-6
    assert ask("room_outside", 1e-13, 1e-7, OPTIONS) == 1e-13
    assert ask("room_outside", -1e-9, 1e-7, OPTIONS) == 0.0
    assert ask("room_outside", 5e-14, 1e-9, OPTIONS) == pytest.approx(2.5e-13, rel=1e-12, abs=0.0)


def test_a_gap_that_is_behind_is_due_when_it_has_come_back_or_gone_deeper() -> None:
    bounds = (2.0, 5.0, math.inf)
    back = ask("safe_time", 3e-9, 0.5, 2.0, 5.0, math.inf)
    deeper = ask("safe_time", 7e-9, -0.5, 2.0, 5.0, math.inf)
    assert ask("time_to_zero", -3e-9, 0.5, False, bounds, OPTIONS) == min(back, deeper)
    back, deeper = (ask("safe_time", way, sign * 0.5, 2.0, 5.0, math.inf) for way, sign in ((3e-9, -1.0), (7e-9, 1.0)))
    assert back > deeper == ask("time_to_zero", -3e-9, -0.5, False, bounds, OPTIONS)
    assert ask("time_to_zero", -3e-8, 0.5, False, bounds, OPTIONS) == ask("safe_time", 3e-8, 0.5, 2.0, 5.0, math.inf)
    assert ask("time_to_zero", 1e-6, -0.5, True, bounds, OPTIONS) == ask("safe_time", 1e-6, 0.5, 2.0, 5.0, math.inf)


def test_a_gap_that_is_zero_and_falls_closes_where_its_tangent_vanishes() -> None:
    bounds = (2.0, 5.0, math.inf)
    assert ask("time_to_touch", 0.0, -1.0, bounds, OPTIONS) == 0.0
    assert ask("time_to_touch", 1e-13, -1e-6, bounds, OPTIONS) == pytest.approx(1e-7, rel=1e-6, abs=0.0)
    slow = ask("time_to_touch", 1e-13, -1e-9, bounds, OPTIONS)  # by then 2.5e-8 m deeper it could be
    assert slow == ask("safe_time", 1e-13, 1e-9, 2.0, 5.0, math.inf)


@pytest.mark.parametrize("kind", [LINE, ARC])
@pytest.mark.parametrize("motion", [FIXED, SLIDE, PIVOT])
def test_an_immovable_contact_is_looked_at_before_it_could_be_behind(kind: int, motion: int) -> None:
    """A quarter of `behind` by its rate, or by its bend; a line that does not turn bends by its slant alone."""
    model = SimpleNamespace(
        contacts=[SimpleNamespace(b=0)],
        primitives=[SimpleNamespace(kind=kind, body=0)],
        bodies=[SimpleNamespace(motion=motion)],
    )
    path = SimpleNamespace(pose=None, probe=None)

    def time(rate: float, bend: float, immovable: bool = True) -> float:
        instead = {"contact_kinematics": lambda *_: None, "is_immovable": lambda *_: immovable}
        return ask("time_immovable", model, OPTIONS, 0, rate, bend, path, **instead)

    share = math.sqrt(IMMOVABLE) if kind == LINE and motion in (FIXED, SLIDE) else 1.0
    assert time(-1e-3, 1e-30) == pytest.approx(0.25 * OPTIONS.behind / 1e-3)
    assert 0.5 * share * 40.0 * time(0.0, 40.0) ** 2 == pytest.approx(0.25 * OPTIONS.behind, rel=1e-6, abs=0.0)
    assert time(-1e-3, 40.0, immovable=False) == 0.0
