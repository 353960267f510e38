"""How does a balance with dry friction in its bearing swing under a torque that is linear in time between knots?

In closed form from knot to knot, stop to stop: shares nothing with watchsim. Between two stops J q'' = M(t) - k q - s T with
the sign s of the velocity; at a stop it stays while |M(t) - k q| <= T.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def angles(
    inertia: float, stiffness: float, dry: float, table: Sequence[tuple[float, float]], start: tuple[float, float], times: Array
) -> Array:
    """(n,) rad at the ascending `times` (s); `table` of (s, N·m) over all of them, `start`: angle and velocity."""
    w, (q, u) = math.sqrt(stiffness / inertia), start
    out, done = np.zeros(len(times)), 0
    for (begin, first), (end, last) in itertools.pairwise(table):
        slope, t = (last - first) / (end - begin), begin
        while t < end:
            torque = first + slope * (t - begin)
            pull = torque - stiffness * q
            if u == 0.0 and (abs(pull) < dry * (1.0 - 1e-12) or (abs(pull) <= dry * (1.0 + 1e-12) and pull * slope <= 0.0)):
                until = t + (math.copysign(dry, slope) - pull) / slope if slope else end
                until, path, after = min(until, end), (q, 0.0, 0.0, 0.0), (q, 0.0)
                if until < end:
                    u = math.copysign(5e-324, slope)  # the direction in which it breaks loose
            else:
                sign = math.copysign(1.0, u or pull)
                mean, drift = (torque - sign * dry) / stiffness, slope / stiffness
                path = (mean, drift, q - mean, (u - drift) / w)
                stop = _reversal(path, w, sign, end - t)
                until = t + stop
                q, u = _at(path, w, stop)
                after = (q, 0.0 if stop < end - t else u)
            last_one = int(np.searchsorted(times, until, side="right"))
            for i in range(done, last_one):
                out[i] = _at(path, w, times[i] - t)[0]
            done, t = max(done, last_one), until
            if path[1:] != (0.0, 0.0, 0.0):
                q, u = after
    return out


def _at(path: tuple[float, float, float, float], w: float, d: float) -> tuple[float, float]:
    """Angle and velocity after d seconds."""
    mean, drift, cosine, sine = path
    c, s = math.cos(w * d), math.sin(w * d)
    return mean + drift * d + cosine * c + sine * s, drift + w * (sine * c - cosine * s)


def _reversal(path: tuple[float, float, float, float], w: float, sign: float, most: float) -> float:
    """When the velocity first turns against its sign, at `most` if it does not before."""
    _, drift, cosine, sine = path
    amplitude, phase = w * math.hypot(cosine, sine), math.atan2(w * sine, -w * cosine)
    if amplitude <= abs(drift):
        return most
    base = math.asin(-drift / amplitude)
    found = [most]
    for angle in (base, math.pi - base):
        turn = math.ceil((phase - angle) / (2.0 * math.pi) - 1e-9)
        for n in range(turn, turn + 3):
            d = (angle + 2.0 * math.pi * n - phase) / w
            if d > 1e-13 and math.cos(w * d + phase) * sign < 0.0:
                found.append(d)
    return min(found)
