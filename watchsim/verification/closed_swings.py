"""How does a sprung body swing, and a pendulum against a stop? The exact answers."""

from __future__ import annotations

import math
from dataclasses import dataclass


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
