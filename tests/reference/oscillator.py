"""How does a damped oscillator move under a constant torque? Textbook solutions, under-, critically and over-damped."""

import math
from typing import NamedTuple


class Oscillator(NamedTuple):
    """inertia q'' + viscous q' + stiffness (q - rest) = torque."""

    inertia: float
    stiffness: float
    viscous: float = 0.0
    torque: float = 0.0
    rest: float = 0.0


def motion(o: Oscillator, q0: float, u0: float, t: float) -> tuple[float, float]:
    """q and u at time t after (q0, u0)."""
    middle = o.rest + o.torque / o.stiffness
    decay = 0.5 * o.viscous / o.inertia
    square = o.stiffness / o.inertia - decay * decay
    x = q0 - middle
    if abs(square) < 1e-14 * decay * decay:
        b = u0 + decay * x
        q, u = x + b * t, b - decay * (x + b * t)
    elif square > 0.0:
        w = math.sqrt(square)
        b = (u0 + decay * x) / w
        c, s = math.cos(w * t), math.sin(w * t)
        q, u = x * c + b * s, (b * w - decay * x) * c - (x * w + decay * b) * s
    else:
        return _overdamped(x, u0, decay, math.sqrt(-square), t, middle)
    fade = math.exp(-decay * t)
    return middle + fade * q, fade * u


def _overdamped(x: float, u0: float, decay: float, w: float, t: float, middle: float) -> tuple[float, float]:
    """Two real roots; the slow one as stiffness/inertia over the fast one, free of cancellation."""
    fast = -(decay + w)
    slow = (decay * decay - w * w) / fast
    a = (u0 - fast * x) / (slow - fast)
    b = x - a
    e_slow, e_fast = math.exp(slow * t), math.exp(fast * t)
    return middle + a * e_slow + b * e_fast, a * slow * e_slow + b * fast * e_fast
