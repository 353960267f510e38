"""Where does a curve pause, turn back or change its curvature at once?

Arcs that follow a curve take its own tangent at such places, on either side.
"""

from __future__ import annotations

import numpy as np

from watchsim.geometry.biarc import crosses, dots
from watchsim.geometry.curve import PAUSE, Array, Curve

LOOKS = 64  # places at least where the speed is looked at
SLOW = 0.2  # of the usual speed: a minimum below that is looked at more closely
NARROWINGS = 45  # by the golden section, to 1e-9 of a step
GOLDEN = 0.6180339887498949
STILL = 1e-12  # of the whole: a step of no length
LITTLE = 1e-30  # 1/m: no change of curvature
SLIVER = 1e-4  # of the range: nothing shorter is cut off
NEAR = 1e-3  # of a span: so far beside a break its curvature is measured
JUMP = 4.0  # tolerances: a jump of curvature over one arc's length that is worth an end there
BEST = 216.0 / 3.0**0.5  # an arc's length is the cube root of BEST times the tolerance over the rate of curvature


def smooth_parts(curve: Curve, tolerance: float) -> list[float]:
    """The ends of the curve and the parameters in between where it is not smooth, ascending."""
    low, high = float(curve.breaks[0]), float(curve.breaks[-1])
    inside = sorted({*jumps(curve, tolerance), *pauses(curve)})
    least = SLIVER * (high - low)
    cuts = [low]
    for t in inside:
        if t - cuts[-1] > least and high - t > least:
            cuts.append(t)
    return [*cuts, high]


def jumps(curve: Curve, tolerance: float) -> list[float]:
    """The inner breaks where the curvature jumps by more than an arc across it could bear."""
    breaks = curve.breaks
    if len(breaks) < 3:
        return []
    span = np.diff(breaks)
    near = NEAR * span
    after = bend(curve, breaks[:-1] + near, breaks[:-1] + 2.0 * near)
    before = bend(curve, breaks[1:] - 2.0 * near, breaks[1:] - near)
    sides = np.diff(curve.points(breaks), axis=0)
    length = np.hypot(sides[:, 0], sides[:, 1])
    length = np.maximum(length, STILL * np.sum(length) + STILL * tolerance)
    reach = np.minimum(length, np.cbrt(BEST * tolerance * length / np.maximum(np.abs(before - after), LITTLE)))
    worth = np.abs(after[1:] - before[:-1]) * np.minimum(reach[1:], reach[:-1]) ** 2
    return [float(t) for t in breaks[1:-1][worth > JUMP * tolerance]]


def bend(curve: Curve, t: Array, later: Array) -> Array:
    """The mean curvature (1/m) from each parameter t to the one a little later; 0 where the curve stands."""
    chord = curve.points(later) - curve.points(t)
    a, b = curve.slopes(t), curve.slopes(later)
    length = np.hypot(chord[:, 0], chord[:, 1])
    turn = np.arctan2(crosses(a, b), dots(a, b))
    moving = length > STILL * np.sum(length)
    return np.where(moving, turn / np.where(moving, length, 1.0), 0.0)


def pauses(curve: Curve) -> list[float]:
    """The parameters inside where the speed falls to nothing: cusps, and corners at coincident control points."""
    spans = np.diff(curve.breaks)
    each = max(2, -(-LOOKS // len(spans)))
    t = np.append((curve.breaks[:-1, None] + spans[:, None] * np.arange(each) / each).ravel(), curve.breaks[-1])
    speeds = speed(curve, t)
    slow = SLOW * curve.usual_speed
    found = []
    for k in range(1, len(t) - 1):
        if speeds[k] <= slow and speeds[k] <= speeds[k - 1] and speeds[k] <= speeds[k + 1]:
            at = t[k] if speeds[k] <= PAUSE * curve.usual_speed else slowest(curve, float(t[k - 1]), float(t[k + 1]))
            if speed(curve, np.array([at]))[0] <= PAUSE * curve.usual_speed:
                found.append(float(at))
    return found


def speed(curve: Curve, t: Array) -> Array:
    slopes = curve.slopes(t)
    result: Array = np.hypot(slopes[:, 0], slopes[:, 1])
    return result


def slowest(curve: Curve, low: float, high: float) -> float:
    """The parameter of least speed between two others, by the golden section."""
    for _ in range(NARROWINGS):
        width = GOLDEN * (high - low)
        a, b = speed(curve, np.array([high - width, low + width]))
        low, high = (low, low + width) if a <= b else (high - width, high)
    return 0.5 * (low + high)
