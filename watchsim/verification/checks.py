"""What do the bodies of the benchmarks look like?"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line, Point
from watchsim.scene.scene import Body

Row = dict[str, Any]


def compared(name: str, quantity: str, expected: float, got: float, tolerance: float, source: str) -> Row:
    """One row, with its error (relative to `expected`, absolute where that is zero) and verdict."""
    expected, got = expected + 0.0, got + 0.0  # no negative zero
    error = abs(got - expected) / (abs(expected) if expected else 1.0)
    return {
        "name": name,
        "quantity": quantity,
        "expected": expected,
        "got": got,
        "error": error,
        "tolerance": tolerance,
        "ok": bool(error <= tolerance),
        "source": source,
    }


# Where is a disc that bounces down an incline? The exact answer, by geometric series.
#
# A disc falls from rest onto a plane inclined by `slope`, x along the plane downhill, y along its normal, angle
# counter-clockwise (so rolling downhill turns it negative). One point of contact whose normal and tangential directions are
# not coupled: with approach speed v the impact returns e v, and friction takes at most mu (1+e)(1+1/kappa) v off the slip,
# else all of it. Impact k comes at T_k = T - 2 t1 e^k/(1-e) with speed v1 e^(k-1); T = t1 (1+e)/(1-e) is where they
# accumulate. Between impacts the slip grows by 2 tan(slope) times the next speed, so all impacts but the first take the
# same multiple of their speed.


@dataclass(frozen=True, slots=True)
class Incline:
    """SI units and radians; `drop` is the gap at the start, `kappa` inertia over mass times radius squared."""

    friction: float
    restitution: float = 0.5
    radius: float = 0.05
    drop: float = 0.1
    slope: float = math.radians(20.0)
    gravity: float = 9.81
    kappa: float = 0.5

    @property
    def pull(self) -> float:
        return self.gravity * math.sin(self.slope)

    @property
    def press(self) -> float:
        return self.gravity * math.cos(self.slope)

    @property
    def first_impact(self) -> float:
        """Time of the first touch, s."""
        return math.sqrt(2.0 * self.drop / self.press)

    @property
    def accumulation(self) -> float:
        """Time at which the bouncing has died out, s."""
        return _impact_time(self, math.inf)

    @property
    def rolling_begins(self) -> float:
        """Time from which the disc rolls, s; inf where it never does."""
        decay = self.friction * self.press * (1.0 + 1.0 / self.kappa) - self.pull
        if decay <= 0.0:
            return math.inf
        return self.accumulation + _slip_left(self) / decay


@dataclass(frozen=True, slots=True)
class DiscState:
    """Place (m), angle (rad, counter-clockwise) and their rates."""

    x: float
    y: float
    angle: float
    v_x: float
    v_y: float
    spin: float


def incline_state(case: Incline, t: float) -> DiscState:
    """The disc at time `t` (s) after its release."""
    if t >= case.accumulation:
        return _on_the_plane(case, t)
    # Number of impacts up to and including time t < accumulation.
    count = 0
    while _impact_time(case, count + 1) <= t:
        count += 1
    taken, moment = _friction_sums(case, count, t)
    y, v_y = _height(case, count, t)
    share = case.kappa / (1.0 + case.kappa)
    turn = (1.0 - share) / case.radius
    return DiscState(
        x=0.5 * case.pull * t * t - share * moment,
        y=case.radius + y,
        angle=-turn * moment,
        v_x=case.pull * t - share * taken,
        v_y=v_y,
        spin=-turn * taken,
    )


def _impact_time(case: Incline, k: float) -> float:
    """Of the k-th impact, counted from 1; inf: where they accumulate."""
    e = case.restitution
    return case.first_impact * (1.0 + 2.0 * e * (1.0 - e ** (k - 1)) / (1.0 - e))


def _multiples(case: Incline) -> tuple[float, float]:
    """Slip taken over approach speed, at the first impact and at all later ones."""
    most = case.friction * (1.0 + case.restitution) * (1.0 + 1.0 / case.kappa)
    return min(math.tan(case.slope), most), min(2.0 * math.tan(case.slope), most)


def _friction_sums(case: Incline, count: float, t: float) -> tuple[float, float]:
    """Sums over the first `count` (may be inf) impacts of the slip taken, and of the slip taken times the time since."""
    if count == 0:
        return 0.0, 0.0
    e, t1 = case.restitution, case.first_impact
    v1 = case.press * t1
    first, later = _multiples(case)
    speeds = v1 * e * (1.0 - e ** (count - 1)) / (1.0 - e)
    weighted = v1 * e**3 * (1.0 - e ** (2 * (count - 1))) / (1.0 - e * e)
    since = (t - case.accumulation) * speeds + 2.0 * t1 / (1.0 - e) * weighted
    return first * v1 + later * speeds, first * v1 * (t - t1) + later * since


def _height(case: Incline, count: int, t: float) -> tuple[float, float]:
    """Gap and its rate after `count` impacts."""
    if count == 0:
        return case.drop - 0.5 * case.press * t * t, -case.press * t
    since = t - _impact_time(case, count)
    speed = case.press * case.first_impact * case.restitution**count
    return since * (speed - 0.5 * case.press * since), speed - case.press * since


def _slip_left(case: Incline) -> float:
    """Slip when the bouncing has died out; exactly zero where the last impacts stick."""
    _, later = _multiples(case)
    if later == 2.0 * math.tan(case.slope):
        return 0.0
    taken, _ = _friction_sums(case, math.inf, case.accumulation)
    return case.pull * case.accumulation - taken


def _on_the_plane(case: Incline, t: float) -> DiscState:
    """Sliding until the slip is gone, then rolling."""
    start = case.accumulation
    taken, moment = _friction_sums(case, math.inf, start)
    share = case.kappa / (1.0 + case.kappa)
    turn = (1.0 - share) / case.radius
    x, angle = 0.5 * case.pull * start * start - share * moment, turn * moment
    v, spin = case.pull * start - share * taken, turn * taken
    grip = case.friction * case.press
    rolling = case.pull / (1.0 + case.kappa)
    change = max(start, min(t, case.rolling_begins))
    phases = (
        (change - start, case.pull - grip, grip / (case.kappa * case.radius)),
        (t - change, rolling, rolling / case.radius),
    )
    for duration, acceleration, spin_up in phases:
        x += duration * (v + 0.5 * acceleration * duration)
        angle += duration * (spin + 0.5 * spin_up * duration)
        v, spin = v + acceleration * duration, spin + spin_up * duration
    return DiscState(x, case.radius, -angle, v, 0.0, -spin)


# How does a sprung body swing, and a pendulum against a stop? The exact answers.


@dataclass(frozen=True, slots=True)
class Damped:
    """inertia q'' + viscous q' + stiffness q = torque, less than critically damped, from (q, u) = (`angle`, `rate`). SI."""

    inertia: float
    stiffness: float
    viscous: float
    torque: float
    angle: float
    rate: float = 0.0


def damped_state(case: Damped, t: float) -> tuple[float, float]:
    """Coordinate and rate at time `t` (s)."""
    middle, decay = case.torque / case.stiffness, 0.5 * case.viscous / case.inertia
    w = math.sqrt(case.stiffness / case.inertia - decay * decay)
    a, b = case.angle - middle, (case.rate + decay * (case.angle - middle)) / w
    c, s, fade = math.cos(w * t), math.sin(w * t), math.exp(-decay * t)
    return middle + fade * (a * c + b * s), fade * ((b * w - decay * a) * c - (a * w + decay * b) * s)


def turning_time(case: Damped, number: int) -> float:
    """Time (s) of the `number`-th turning point after the start, counted from 1."""
    middle, decay = case.torque / case.stiffness, 0.5 * case.viscous / case.inertia
    w = math.sqrt(case.stiffness / case.inertia - decay * decay)
    a, b = case.angle - middle, (case.rate + decay * (case.angle - middle)) / w
    first = math.atan((b * w - decay * a) / (a * w + decay * b)) % math.pi or math.pi
    return (first + (number - 1) * math.pi) / w


@dataclass(frozen=True, slots=True)
class Stopped:
    """A pendulum with J q'' = -J w² sin q, released at rest at `angle` > 0, and a stop at q = 0 that returns `restitution`."""

    w: float
    angle: float
    restitution: float


def touch_times(case: Stopped, count: int) -> list[float]:
    """The first `count` times (s) at which it meets the stop."""
    return [start for start, _ in _swings(case, count)]


def stopped_state(case: Stopped, t: float) -> tuple[float, float]:
    """Angle and rate at time `t` (s).

    With k = sin(amplitude/2) the motion from the bottom upwards is sin(q/2) = k sn(w t), q' = 2 w k cn(w t). The rate at
    the bottom is 2 w k, so an impact turns k into restitution × k.
    """
    from scipy.special import ellipj, ellipk

    k = math.sin(0.5 * case.angle)
    start = -float(ellipk(k * k)) / case.w
    for touch, next_k in _swings(case, 2 + int(t * case.w / math.pi)):  # a swing takes at least pi / w
        if touch <= t:
            start, k = touch, next_k
    sn, cn, _, _ = ellipj(case.w * (t - start), k * k)
    return 2.0 * math.asin(k * float(sn)), 2.0 * case.w * k * float(cn)


def _swings(case: Stopped, count: int) -> list[tuple[float, float]]:
    """(time of the touch, modulus after it), one after the other."""
    from scipy.special import ellipk

    k = math.sin(0.5 * case.angle)
    t, swings = float(ellipk(k * k)) / case.w, []
    for _ in range(count):
        k *= case.restitution
        swings.append((t, k))
        t += 2.0 * float(ellipk(k * k)) / case.w
    return swings


def circle(radius: float) -> Loop:
    """A full circle about the origin."""
    return Loop((Arc(0.0, 0.0, radius, 0.0, TURN),))


def polygon(*points: Point) -> Loop:
    """Closed, counter-clockwise."""
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))


def box(half_width: float, half_height: float) -> Loop:
    """A rectangle about the origin."""
    x, y = half_width, half_height
    return polygon((-x, -y), (x, -y), (x, y), (-x, y))


def ground(length: float = 1e4) -> Body:
    """A fixed plane along x with material below, `length` to both sides."""
    return Body("ground", "fixed", loops=(Loop((Line(length, 0.0, -length, 0.0),), closed=False),))


def shaped(body: Body, *loops: Loop) -> Body:
    """The body with these outlines."""
    return replace(body, loops=loops)
