"""Is the first contact to close found at its time, with no more looked at than that takes? Against polynomials of time."""

import heapq
import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from moving_scenes import circle, ground
from numpy.polynomial import Chebyshev, Polynomial
from plain_kernels import in_python

from watchsim.jit import callable_kernel
from watchsim.model import ARC, FIXED, FREE, LINE, PIVOT, SLIDE, dtype_of, records
from watchsim.scene.forces import Contact, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import first_closing as gap_bounds
from watchsim.simulation import first_closing as safe_times
from watchsim.simulation import first_closing as time_of_impact
from watchsim.simulation.first_closing import Bounds, drop_first, put
from watchsim.simulation.scratch import Waiting
from watchsim.simulation.simulate import simulate

# Which gaps are functions of time that a test has made up?

START, END = 0.5, 2.5
OPTIONS = SimpleNamespace(gap_zero=1e-13, behind=1e-8, extent=1e-9, speed_zero=1e-9, size=3.0)
RADIUS = 0.4


class Search:
    """A search for the closing of contact 1, whose gap, and how far it is inside either primitive, are functions of time.

    Bounds are those of the gap over a stretch, or over `longest` of it; `instead` stands in for other parts of the search.
    """

    def __init__(self, gap: Any, inside: tuple[Any, Any] = (None, None), **given: Any) -> None:
        self.gap, self.inside = gap, [one or (lambda t: 1.0) for one in inside]
        self.longest, self.kind = given.pop("longest", math.inf), given.pop("kind", LINE)
        self.now, self.looks, self.calls, self.instead = math.nan, [], [], given  # type: ignore[var-annotated]

    def place(self, model, bodies, tau, step, path) -> None:
        assert bodies == (7, 8)
        self.now = float(tau)

    def placed_gap(self, model, k, pose) -> tuple[float, float, float, float]:
        assert k == 1
        self.looks.append(self.now)
        return self.gap(self.now), self.gap.deriv()(self.now), self.inside[0](self.now), self.inside[1](self.now)

    def next_stretch(self, model, options, k, left, step, path) -> tuple[float, float, float, float]:
        assert left == self.end - self.now
        length = min(left, self.longest)
        times = np.linspace(self.now, self.now + length, 200)
        closing, bend = (1.001 * float(np.abs(self.gap.deriv(order)(times)).max()) + 1e-9 for order in (1, 2))
        return length, closing, bend, 0.3

    def found(self, start: float = START, end: float = END) -> tuple[float, bool]:
        """Searched on from where a turn of looks ended."""
        primitives = [None, SimpleNamespace(body=7, radius=0.0, length=RADIUS), SimpleNamespace(body=8, radius=RADIUS)]
        primitives[2].kind = self.kind  # type: ignore[union-attr]
        model = SimpleNamespace(contacts=[None, SimpleNamespace(a=1, b=2)], primitives=primitives)
        counts = SimpleNamespace(gap_evaluations=5)
        instead = {
            "_place": self.place,
            "placed_gap": self.placed_gap,
            "next_stretch": self.next_stretch,
            "centre_distance": lambda *_: math.inf,
            "sunk_level": lambda *_: 0.0,
            **{name: lambda *_: 0.0 for name in ("time_still", "time_apart", "time_immovable", "time_held")},
            **self.instead,
        }
        search = in_python(time_of_impact.crossing, **instead)
        self.turns, self.end = 0, end
        while True:
            before = len(self.looks)
            time, closes = search(model, [], 0, OPTIONS, 1, (start, end), None, SimpleNamespace(pose=None), counts)
            self.turns += 1
            assert self.turns < 100
            assert len(self.looks) - before <= 16 and counts.gap_evaluations == 5 + len(self.looks)
            if closes or time >= end:
                return float(time), bool(closes)
            start = time


# Do bounds of a gap hold over a stretch of time, and are they no larger than their terms make them?

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


@pytest.mark.parametrize("seed", range(4))
def test_distance_is_that_of_the_two_centres(seed: int) -> None:
    a, b, model, path = pair(seed, ARC)
    ask = in_python(gap_bounds.centre_distance)
    assert ask(model, 0, path.pose) == pytest.approx(abs(complex(a.point(0.0) - b.point(0.0))))
    model.primitives[1].kind = LINE
    assert ask(model, 0, path.pose) == math.inf


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


# Is a contact found to close where its gap first falls through zero? Gaps here are polynomials of time, roots are numpy's.


def falls(gap: Any, start: float, end: float) -> list[float]:
    """The times within the search at which the gap falls through zero."""
    roots = [float(root.real) for root in gap.roots() if abs(root.imag) < 1e-12]
    return sorted(root for root in roots if start < root < end and gap.deriv()(root) < 0.0)


GAPS = [Chebyshev(np.random.default_rng(seed).normal(size=7), domain=[0.4, 2.6]) + 1.5 * (seed % 3 == 0) for seed in range(30)]


@pytest.mark.parametrize("longest", [math.inf, 0.3])
@pytest.mark.parametrize("seed", range(30))
def test_the_first_fall_through_zero_closes_the_contact(seed: int, longest: float) -> None:
    """Also of what begins on the far side: it must come out first."""
    gap = GAPS[seed]
    roots, search = falls(gap, START, END), Search(gap, longest=longest)
    time, closes = search.found()
    assert closes == bool(roots)
    assert time == pytest.approx(roots[0] if roots else END, rel=1e-11)
    assert search.turns > 1 or not closes or gap(time) > -0.5 * OPTIONS.gap_zero  # it has been further than rounding from zero
    assert len(search.looks) < 60


def test_these_gaps_close_stay_open_and_come_from_behind() -> None:
    kinds = [(gap(START) > 0.0, bool(falls(gap, START, END))) for gap in GAPS]
    assert all(kinds.count((outside, closes)) >= 2 for outside in (True, False) for closes in (True, False))


@pytest.mark.parametrize("off", [0.0, 0.9e-13])
def test_a_contact_that_has_just_rebounded_closes_when_it_comes_back(off: float) -> None:
    """Its gap is zero to rounding and rises; it has left it when it falls."""
    time, closes = Search(Polynomial([off, 1.0, -0.8])).found(start=0.0)
    assert closes and time == pytest.approx(1.25)


def test_a_gap_of_zero_that_falls_all_the_time_closes_when_it_is_no_longer_rounding() -> None:
    time, closes = Search(Polynomial([1.0, -2.0])).found(start=START)
    assert closes and 0.5 + 0.49e-13 < time < 0.5 + 2e-13


@pytest.mark.parametrize(("end", "at_root"), [(END, True), (START + 5e-6, False)])
def test_one_that_falls_as_it_comes_within_its_primitives_closes_there(end: float, at_root: bool) -> None:
    """It has not been in contact, so that it need not leave zero before; where that is beyond the end, it closes at once."""
    beside = iter([-1e-6])
    search = Search(Polynomial([0.9e-13 + 1e-8 * START, -1e-8]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    time, closes = search.found(end=end)
    assert closes and search.looks[1] - START == pytest.approx(0.5e-6, rel=1e-2)
    assert abs(search.gap(time)) < 1e-18 if at_root else time == search.looks[1]


@pytest.mark.parametrize(("gap", "due"), [(-0.9e-8, True), (-1.1e-8, False)])
def test_what_is_a_little_behind_and_goes_on_falling_closes_at_once(gap: float, due: bool) -> None:
    assert Search(Polynomial([gap + 0.2, -0.4])).found() == ((START, True) if due else (END, False))


@pytest.mark.parametrize("closes_at", [2.0, 3.0])
def test_what_falls_beside_its_primitives_does_not_close_until_it_has_come_out(closes_at: float) -> None:
    """The gap falls through zero at 1 beside the line, which it enters at 1.3; it comes out at 1.5 and falls at 2."""
    gap = Polynomial.fromroots([1.0, 1.5, closes_at]) * -1.0
    assert falls(gap, START, END) == pytest.approx([1.0] + ([2.0] if closes_at == 2.0 else []))
    for kind in (LINE, ARC):
        time, closes = Search(gap, (None, lambda t: 0.1 * (t - 1.3)), kind=kind).found()
        assert (time, closes) == ((pytest.approx(2.0), True) if closes_at == 2.0 else (END, False))
        time, closes = Search(gap, (lambda t: 0.05 * (t - 1.3), None), kind=kind).found()
        assert (time, closes) == ((pytest.approx(2.0), True) if closes_at == 2.0 else (END, False))


@pytest.mark.parametrize(("beyond", "closes"), [(0.9, True), (1.1, False)])
def test_a_little_beyond_the_end_of_a_primitive_counts(beyond: float, closes: bool) -> None:
    for which in range(2):
        inside = [None, None]
        inside[which] = lambda t: -beyond * OPTIONS.extent  # type: ignore[call-overload]
        assert Search(Polynomial([1.0, -0.8]), tuple(inside)).found()[1] == closes


def test_gaps_count_from_the_level_to_which_faces_have_let_bodies_sink() -> None:
    """Looked up at the first look and while the contact lies beside its primitives."""
    asked: list[tuple[float, float]] = []

    def level(model, options, k, gap, inside_b, path) -> float:
        asked.append((gap, inside_b))
        return -0.25

    search = Search(Polynomial([1.0, -0.8]), sunk_level=level)
    time, closes = search.found()
    assert closes and time == pytest.approx(1.25 / 0.8)
    assert asked == [(pytest.approx(0.6), 1.0)]
    asked.clear()
    search = Search(Polynomial([1.0, -0.8]), (None, lambda t: 0.5 * (t - 1.3)), sunk_level=level)
    assert search.found() == (pytest.approx(1.25 / 0.8), True)
    beside = [t for t in search.looks if t < 1.3]
    assert len(asked) == len(beside) + 1 and asked[0] == (pytest.approx(0.6), pytest.approx(-0.4))


def test_what_does_not_move_is_not_looked_at() -> None:
    still = {"next_stretch": lambda model, options, k, left, step, path: (left, 0.0, 0.0, 0.0)}
    search = Search(Polynomial([1.0]), **still)
    assert search.found() == (END, False) and search.looks == []


def test_a_contact_that_is_held_is_looked_at_again_when_it_could_have_come_apart() -> None:
    held = iter([0.125, 0.25, 0.0])
    given: list[Any] = []

    def time_held(model, active, in_force, options, k, tau, rate, bounds, path) -> float:
        given.append((tau, rate, bounds[2:]))
        return next(held)

    search = Search(Polynomial([0.0, -2e-9]), time_held=time_held)
    time, closes = search.found()
    assert closes and search.looks == [0.5, 0.625, 0.875]
    assert given == [(t, -2e-9, (0.3, math.inf)) for t in search.looks] and time == 0.875


# How long is it until the next look at a gap beside its primitives, or one that hardly moves?

BESIDE = {LINE: 1e-2, ARC: 0.1}  # m


def beside_still(kind: int, still: Callable[[float], float]) -> tuple[list[float], list[tuple[float, float]]]:
    """(times of the looks, (room, time left) asked for) at a gap that stands still, beside its primitives."""
    asked: list[tuple[float, float]] = []

    def time_still(model, k, room, left, tau, step, path) -> float:
        asked.append((room, left))
        return still(left)

    search = Search(Polynomial([0.0]), (None, lambda t: -BESIDE[kind]), kind=kind, time_still=time_still)
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found() == (END, False)
    return search.looks, asked


@pytest.mark.parametrize("kind", [LINE, ARC])
def test_where_bounds_make_short_looks_beside_a_primitive_its_place_is_asked_how_long_it_stands(kind: int) -> None:
    """With the room that there is to a line's end, or that of a gap's rounding."""
    looks, asked = beside_still(kind, lambda left: 0.7 if left < 1.5 else 0.9)
    assert looks == pytest.approx([0.5, 1.4, 2.1])
    room = BESIDE[kind] - OPTIONS.extent if kind == LINE else OPTIONS.gap_zero
    assert asked == [(pytest.approx(room), pytest.approx(END - t)) for t in looks]
    short, _ = beside_still(kind, lambda left: 0.0)
    wait = (BESIDE[kind] - OPTIONS.extent) / (2.0 if kind == LINE else 50.0 * RADIUS)
    assert np.diff(short) == pytest.approx(wait)


@pytest.mark.parametrize(("share", "asked"), [(0.99, True), (1.01, False)])
def test_a_finer_bound_is_asked_for_where_a_look_is_shorter_than_a_64th_of_what_is_left(share: float, asked: bool) -> None:
    """Unless the gap falls so fast that it would not help."""
    for helps in (True, False):
        rooms: list[Any] = []

        def time_apart(model, k, room, left, tau, step, path, rooms=rooms) -> float:
            rooms.append((room, left))
            return 0.75

        room = 0.1
        speed = room / (share * (END - START) / 64.0)
        given = {"may_last": lambda room, rate, safe, helps=helps: helps, "time_apart": time_apart}
        search = Search(Polynomial([room]), **given)
        search.next_stretch = lambda m, o, k, left, s, p, speed=speed: (left, speed, 1e9, 0.0)  # type: ignore[method-assign]
        search.found()
        assert search.looks[1] == pytest.approx(1.25 if asked and helps else START + room / speed)
        assert rooms[:1] == ([(room, END - START)] if asked and helps else [])


def test_a_look_beside_a_primitive_is_no_shorter_than_a_gap_takes_to_pass_through_its_rounding() -> None:
    """However little it lies beside: here by a millionth of what counts as touching."""
    beside = iter([-OPTIONS.extent * (1.0 + 1e-6)])
    search = Search(Polynomial([0.0]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 2.0, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found() == (END, False)
    assert search.looks[1] - START == pytest.approx(OPTIONS.gap_zero / 2.0, rel=0.01, abs=0.0)


@pytest.mark.parametrize("start", [8.0, 0.015625])
def test_no_look_is_shorter_than_the_rounding_of_time(start: float) -> None:
    beside = iter([-OPTIONS.extent * (1.0 + 1e-9)])
    search = Search(Polynomial([0.0]), (None, lambda t: next(beside, 1.0)))
    search.next_stretch = lambda model, options, k, left, step, path: (left, 1e5, 0.0, 50.0)  # type: ignore[method-assign]
    assert search.found(start, start + 1.0) == (start + 1.0, False)
    assert search.looks[1] == start + 4e-16 * start


# Are times in which a gap cannot close those of the worst motion that the bounds allow?


@pytest.mark.parametrize("seed", range(40))
def test_the_longer_of_the_straight_and_the_curved_way(seed: int) -> None:
    """With centres that stay half as far apart as they are, over the time in which they do; roots by numpy."""
    rng = np.random.default_rng(seed)
    room, approach, closing, bend = 10.0 ** rng.uniform(-2.0, 1.0, 4) * [1.0, rng.choice([-1.0, 1.0]), 1.0, 1.0]
    distance = math.inf if seed % 3 == 0 else float(10.0 ** rng.uniform(-5.0, 1.0))
    limit, curve = 0.5 * distance / closing, bend + (0.0 if distance == math.inf else closing**2 / (0.5 * distance))
    roots = np.roots([-0.5 * curve, -approach, room])
    expected = max(room / closing, min(float(roots[roots > 0.0][0]), limit))
    assert in_python(safe_times.safe_time)(room, approach, closing, bend, distance) == pytest.approx(expected)


def test_without_bend_a_gap_that_does_not_fall_stays_open() -> None:
    ask = in_python(safe_times.safe_time)
    assert ask(0.3, -0.2, 2.0, 0.0, math.inf) == math.inf and ask(0.3, 0.0, 2.0, 0.0, math.inf) == math.inf
    assert ask(0.3, 0.2, 2.0, 0.0, math.inf) == pytest.approx(1.5)
    assert ask(0.3, 1e-4, 2.0, 0.0, math.inf) == pytest.approx(3e3)
    assert ask(0.3, -0.2, 2.0, 1e-4, math.inf) == pytest.approx((0.2 + (0.04 + 0.6e-4) ** 0.5) / 1e-4)
    assert ask(0.3, -0.2, 2.0, 0.1, 0.0) == 0.15  # concentric: nothing is known of the curve


@pytest.mark.parametrize("kind", [LINE, ARC])
@pytest.mark.parametrize("seed", range(12))
def test_outside_until_the_normal_or_the_point_could_have_come_in(seed: int, kind: int) -> None:
    rng = np.random.default_rng(seed)
    a = SimpleNamespace(radius=rng.uniform(0.1, 0.5), length=rng.uniform(0.1, 0.5))
    b = SimpleNamespace(radius=rng.uniform(0.1, 0.5), kind=kind)
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=[a, b])
    inside_a, inside_b = rng.uniform(-1e-3, 5e-4, 2)
    closing, swing, distance = rng.uniform(0.2, 2.0, 3)
    turn = swing + closing / (0.5 * distance)
    times = [0.0]
    if inside_a < 0.0:
        times.append(-inside_a / (turn * max(a.radius, a.length)))
    if inside_b < 0.0:
        times.append(-inside_b / closing if kind == LINE else -inside_b / (turn * b.radius))
    ask = in_python(safe_times.time_outside)
    assert ask(model, 0, inside_a, inside_b, (closing, swing), distance) == pytest.approx(max(times))
    assert ask(model, 0, -9.0, inside_b, (closing, swing), distance) == pytest.approx(0.5 * distance / closing)
    slowly = ask(model, 0, -1e-3, 1.0, (closing, 1e-4), math.inf)
    assert slowly == pytest.approx(10.0 / max(a.radius, a.length))


# Is no more looked at than it takes to find which contact closes first?

KEPT = Path(__file__).resolve().parents[1] / "data" / "hunt"


@pytest.mark.parametrize("seed", range(20))
def test_the_contact_that_could_close_first_is_in_front(seed: int) -> None:
    """Against the heap of Python's standard library, with ties."""
    add, drop = callable_kernel(put), callable_kernel(drop_first)
    rng = np.random.default_rng(seed)
    waiting, count, oracle = records(dtype_of(Waiting), 100), 0, []
    for k in range(300):
        if count and (count == len(waiting) or rng.random() < 0.45):
            first = waiting[0]
            assert first.stays_open == oracle[0][0]
            entry = (float(first.stays_open), int(first.contact), int(first.pair), float(first.start), float(first.until))
            oracle.remove(entry)
            heapq.heapify(oracle)
            count = drop(waiting, count)
        else:
            stays = float(rng.integers(0, 12))
            count = add(waiting, count, k, k % 7, (stays - 1.0, stays + 2.0, stays))
            heapq.heappush(oracle, (stays, k, k % 7, stays - 1.0, stays + 2.0))
        assert count == len(oracle)


def test_a_flight_is_not_searched_beyond_its_first_closing() -> None:
    """A roller bounces 2717 times on a bar that goes on sliding for a second: a flight takes about one look at each contact."""
    run = simulate(load(KEPT / "wave-801-16576.toml"), prefilter=False)
    assert run.counts["flights"] > 2000
    assert run.counts["gap_evaluations"] < 3 * len(run.pairs) * run.counts["flights"]


APPROACH, DRAWN, GAP, DURATION = 5e-8, 1e-7, 1e-10, 5.0  # m/s, m/s², m, s


def parted(restitution: float) -> Scene:
    """A disc nears the ground by 0.1 nm in 2 ms, so slowly that it counts as no speed, and is drawn away from it."""
    height = 0.05 + GAP
    disc = Body("disc", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(-APPROACH,), mass=1.0, loops=(circle(0.05),))
    contacts = (Contact((Side("ground"), Side("disc")), 0.0, restitution),)
    return Scene("parted", (ground(0.1), disc), torques=(Torque("disc", DRAWN),), contacts=contacts, duration=DURATION)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_what_nears_more_slowly_than_counts_as_zero_rebounds_once(restitution: float) -> None:
    run = simulate(parted(restitution), tolerance=1e-7)
    assert run.counts["instants"] < 10
    speed = math.sqrt(APPROACH**2 - 2.0 * DRAWN * GAP)
    after = DURATION - (APPROACH - speed) / DRAWN
    assert run.u[-1, 0] == pytest.approx(restitution * speed + DRAWN * after, rel=1e-6, abs=0.0)
    assert run.q[-1, 0] - run.q[0, 0] == pytest.approx((restitution * speed + 0.5 * DRAWN * after) * after - GAP, rel=1e-6)
