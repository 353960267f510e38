"""Do bounds of a gap hold over a stretch of time, and are they no larger than their terms make them?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.model.records import ARC, FIXED, FREE, LINE, PIVOT, SLIDE
from watchsim.simulation.first_closing import gap_bounds
from watchsim.simulation.first_closing.gap_bounds import Bounds

LENGTH = 0.3


class Moving:
    """A body under constant accelerations, and a point of it."""

    def __init__(self, rng: np.random.Generator, reach: float) -> None:
        self.start, self.speed, self.push = (complex(*rng.normal(size=2)) for _ in range(3))
        self.angle, self.turn, self.twist = rng.normal(size=3)
        self.x, self.y = reach * rng.normal(size=2)
        self.bounds = Bounds(
            abs(self.speed) + abs(self.push) * LENGTH,
            abs(self.turn) + abs(self.twist) * LENGTH,
            abs(self.push),
            abs(self.twist),
        )

    def origin(self, t: np.ndarray | float) -> np.ndarray:
        return np.asarray(self.start + self.speed * t + 0.5 * self.push * t * t)

    def direction(self, t: np.ndarray | float) -> np.ndarray:
        return np.exp(1j * (self.angle + self.turn * t + 0.5 * self.twist * t * t))

    def point(self, t: np.ndarray | float) -> np.ndarray:
        return self.origin(t) + complex(self.x, self.y) * self.direction(t)

    def pose(self) -> SimpleNamespace:
        c = complex(self.direction(0.0))
        return SimpleNamespace(
            x=self.start.real, y=self.start.imag, c=c.real, s=c.imag, vx=self.speed.real, vy=self.speed.imag, w=self.turn
        )


def pair(seed: int, kind: int) -> tuple[Moving, Moving, SimpleNamespace, SimpleNamespace]:
    """The circle's body and the other one, the model with their contact, the path at the start."""
    rng = np.random.default_rng(seed)
    a, b = Moving(rng, 0.7), Moving(rng, 0.4 if seed % 2 else 4.0)
    primitives = [SimpleNamespace(body=0, x=a.x, y=a.y, kind=ARC), SimpleNamespace(body=1, x=b.x, y=b.y, kind=kind)]
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=primitives)
    return a, b, model, SimpleNamespace(pose=[a.pose(), b.pose()])


def rates(values: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives by central quotients."""
    return (values[2:] - values[:-2]) / (2.0 * step), (values[2:] - 2.0 * values[1:-1] + values[:-2]) / step**2


@pytest.mark.parametrize("kind", [LINE, ARC])
@pytest.mark.parametrize("seed", range(25))
def test_no_gap_changes_faster_than_its_bounds(seed: int, kind: int) -> None:
    """Of a circle against a line that goes with the other body, or against its centre: that one's curve bends the gap more."""
    a, b, model, path = pair(seed, kind)
    closing, bend, swing = in_python(gap_bounds.gap_bounds)(model, 0, LENGTH, a.bounds, b.bounds, path)
    t = np.linspace(0.0, LENGTH, 301)
    way = a.point(t) - b.point(t)
    gap = (way * np.conj(b.direction(t) * np.exp(0.7j))).imag if kind == LINE else np.abs(way)
    first, second = rates(gap, t[1])
    more = closing**2 / np.abs(way).min() if kind == ARC else 0.0
    assert np.abs(first).max() <= closing and np.abs(second).max() <= bend + more + 1e-6
    assert swing == a.bounds.turn + b.bounds.turn


@pytest.mark.parametrize("kind", [LINE, ARC])
@pytest.mark.parametrize("seed", range(25))
def test_bounds_are_the_sums_of_their_terms(seed: int, kind: int) -> None:
    """Centripetal, angular and Coriolis terms at the arms; of an arc about the shorter of its two arms."""
    a, b, model, path = pair(seed, kind)
    closing, bend, _ = in_python(gap_bounds.gap_bounds)(model, 0, LENGTH, a.bounds, b.bounds, path)
    arm = abs(complex(a.x, a.y))
    most = a.bounds.speed + a.bounds.turn * arm + b.bounds.speed
    own = a.bounds.push + b.bounds.push + (a.bounds.twist + a.bounds.turn**2) * arm
    centre, pivot = complex(a.point(0.0)), b.start
    far, near = abs(centre - pivot) + most * LENGTH, abs(complex(b.x, b.y))
    speed = a.speed + 1j * a.turn * (centre - a.start) - b.speed
    if kind == LINE or near >= far:
        fastest = most + b.bounds.turn * far
        expected = own + (b.bounds.twist + b.bounds.turn**2) * far + 2.0 * b.bounds.turn * fastest
        now = abs(speed - 1j * b.turn * (centre - pivot))
    else:
        fastest = most + b.bounds.turn * near
        expected = own + (b.bounds.twist + b.bounds.turn**2) * near
        now = abs(speed - 1j * b.turn * (complex(b.point(0.0)) - pivot))
    assert bend == pytest.approx(expected)
    assert closing == pytest.approx(min(fastest, now + expected * LENGTH))


def test_both_arms_are_met_with() -> None:
    met = set()
    for seed in range(25):
        a, b, _, _ = pair(seed, ARC)
        most = a.bounds.speed + a.bounds.turn * abs(complex(a.x, a.y)) + b.bounds.speed
        met.add(bool(abs(complex(b.x, b.y)) < abs(complex(a.point(0.0)) - b.start) + most * LENGTH))
    assert met == {True, False}


def test_no_bound_is_zero() -> None:
    ask = in_python(gap_bounds._closing)
    assert ask((0.0, 0.0), 0.0, 1.0, 5.0) == 1e-300
    assert ask((3.0, -4.0), 2.0, 0.25, 9.0) == 5.5
    assert ask((3.0, -4.0), 2.0, 0.25, 5.4) == 5.4


@pytest.mark.parametrize("seed", range(4))
def test_distance_is_that_of_the_two_centres(seed: int) -> None:
    a, b, model, path = pair(seed, ARC)
    ask = in_python(gap_bounds.centre_distance)
    assert ask(model, 0, path.pose) == pytest.approx(abs(complex(a.point(0.0) - b.point(0.0))))
    model.primitives[1].kind = LINE
    assert ask(model, 0, path.pose) == math.inf


@pytest.mark.parametrize(("left", "length"), [(0.9, 0.9), (1.1, 1.0), (7.0, 1.0)])
def test_a_stretch_is_no_longer_than_bodies_travel_by_the_size_of_the_scene(left: float, length: float) -> None:
    """1.5 and 2.5 m/s in a scene of four metres; bounds are those of that stretch."""
    primitives = [SimpleNamespace(body=3), SimpleNamespace(body=5)]
    model = SimpleNamespace(contacts=[None, SimpleNamespace(a=0, b=1)], primitives=primitives)
    speeds = {3: 1.5, 5: 2.5}
    instead = {
        "body_bounds": lambda model, b, length, step, path: Bounds(speeds[b], b, length, 0.0),
        "gap_bounds": lambda model, k, length, one, other, path: (one, other, length),
    }
    options = SimpleNamespace(size=4.0)
    found = in_python(gap_bounds.next_stretch, **instead)(model, options, 1, left, None, None)
    assert found == (length, Bounds(1.5, 3, length, 0.0), Bounds(2.5, 5, length, 0.0), length)


@pytest.mark.parametrize(
    ("motion", "expected"),
    [
        (FIXED, (0.0, 0.0, 0.0, 0.0)),
        (PIVOT, (0.0, 0.4 * (3.0 + 1.2 * 0.3), 0.0, 0.4 * 1.2)),
        (SLIDE, (0.4 * (3.0 + 1.2 * 0.3), 0.0, 0.4 * 1.2, 0.0)),
        (FREE, (5.0 + 1.3 * 0.3, 0.7 + 0.9 * 0.3, 1.3, 0.9)),
    ],
)
def test_a_frame_is_no_faster_than_it_is_now_and_its_accelerations_make_it(motion: int, expected: tuple[float, ...]) -> None:
    """Speeds of 3 and 4 m/s, accelerations of up to 1.2 and 0.5 m/s²; a ratio of -0.4 of what has one coordinate."""
    body = SimpleNamespace(first=1, motion=motion, ratio=-0.4, carrier=-1)
    path = SimpleNamespace(u=np.array([99.0, -3.0, 4.0, -0.7]))
    step = SimpleNamespace(bound=np.array([99.0, 1.2, 0.5, 0.9]))
    found = in_python(gap_bounds.body_bounds)(SimpleNamespace(bodies=[None, body]), 1, LENGTH, step, path)
    assert found == pytest.approx(expected)
