"""Where does a curve pause, turn back or change its curvature at once?

Arcs that follow a curve take its own tangent at such places, on either side.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from watchsim.geometry.fitting.biarc import crosses, dots
from watchsim.geometry.fitting.bundle import PAUSE, Bundle
from watchsim.geometry.fitting.curve import Array, Curve

LOOKS = 32  # places in each span where the speed is looked at
SLOW = 0.2  # of the usual speed: a minimum below that is looked at more closely
NARROWINGS = 45  # by the golden section, to 1e-9 of a step
GOLDEN = 0.6180339887498949
STILL = 1e-12  # of the whole: a step of no length
LITTLE = 1e-30  # 1/m: no change of curvature
SLIVER = 1e-4  # of a span: nothing shorter is cut off
NEAR = 1e-3  # of a span: so far beside a break its curvature is measured
JUMP = 4.0  # tolerances: a jump of curvature over one arc's length that is worth an end there
BEST = 216.0 / 3.0**0.5  # an arc's length is the cube root of BEST times the tolerance over the rate of curvature


def smooth_parts(curves: Sequence[Curve], tolerance: Array) -> list[list[Curve]]:
    """Each curve, all of one degree, cut where it is not smooth; `tolerance` (curves,) in metres."""
    bundle = Bundle(curves)
    result = [[curve] for curve in curves]
    places = np.unique(np.concatenate((jumps(bundle, tolerance), pauses(bundle))))
    number = bundle.owner[bundle.locate(places)[0]]
    for k in np.unique(number):
        cuts = [0.0]
        for place in (places[number == k] - bundle.begin[k]).tolist():
            nearest = float(round(place))
            cut = nearest if abs(place - nearest) <= SLIVER else place  # what is beside a break is taken for it
            if cut - cuts[-1] > SLIVER and len(curves[k].control) - cut > SLIVER:
                cuts.append(cut)
        result[k] = cut_at(curves[k], cuts[1:])
    return result


def cut_at(curve: Curve, places: Sequence[float]) -> list[Curve]:
    """The parts between ascending places inside."""
    parts, last = [], float(len(curve.control))
    for place in reversed(places):
        span = int(place)
        curve, rest = curve.split(span + (place - span) / min(1.0, last - span))  # the last cut may have shortened the span
        parts.append(rest)
        last = place
    return [curve, *reversed(parts)]


def jumps(bundle: Bundle, tolerance: Array) -> Array:
    """The inner breaks (places) where the curvature jumps by more than an arc across it could bear."""
    inner = np.flatnonzero(np.diff(bundle.owner) == 0)
    if not len(inner):
        return np.empty(0)
    chosen = np.union1d(inner, inner + 1)
    start = bundle.start_of[chosen].astype(float)
    after = bend(bundle, start + NEAR, start + 2.0 * NEAR)
    before = bend(bundle, start + 1.0 - 2.0 * NEAR, start + 1.0 - NEAR)
    limit = tolerance[bundle.owner[chosen]]
    total = np.bincount(bundle.owner, bundle.lengths)[bundle.owner[chosen]]
    length = np.maximum(bundle.lengths[chosen], STILL * (total + limit))
    reach = np.minimum(length, np.cbrt(BEST * limit * length / np.maximum(np.abs(before - after), LITTLE)))
    one = np.searchsorted(chosen, inner)
    worth = np.abs(after[one + 1] - before[one]) * np.minimum(reach[one + 1], reach[one]) ** 2
    return start[one + 1][worth > JUMP * limit[one]]


def bend(bundle: Bundle, t: Array, later: Array) -> Array:
    """The mean curvature (1/m) from each place t to the one a little later; 0 where the curve stands."""
    chord = bundle.points(later) - bundle.points(t)
    a, b = bundle.slopes(t), bundle.slopes(later)
    length = np.hypot(chord[:, 0], chord[:, 1])
    turn = np.arctan2(crosses(a, b), dots(a, b))
    moving = length > STILL * bundle.lengths[bundle.locate(t)[0]]
    return np.where(moving, turn / np.where(moving, length, 1.0), 0.0)


def pauses(bundle: Bundle) -> Array:
    """The places inside where the speed falls to nothing: cusps, and corners at coincident control points."""
    t = np.sort(np.append((bundle.start_of[:, None] + np.arange(LOOKS) / LOOKS).ravel(), bundle.end))
    apart = np.diff(t) > 1.5 / LOOKS  # one curve ends, the next one begins
    first, last = np.append(True, apart), np.append(apart, True)
    speeds, usual = bundle.speeds(t), bundle.usual_speed[bundle.owner[bundle.locate(t)[0]]]
    here = np.arange(len(t))
    before, after = here - ~first, here + ~last  # an end has a neighbour on one side alone
    slow = (speeds <= SLOW * usual) & (speeds <= np.minimum(speeds[before], speeds[after]))
    still = speeds <= PAUSE * usual
    moving = slow & ~still
    chosen = slow & ~(still & (first | last))  # not where the curve pauses at its very end
    at = t.copy()
    at[moving] = slowest(bundle, t[before[moving]], t[after[moving]])
    return at[chosen][bundle.speeds(at[chosen]) <= PAUSE * usual[chosen]]


def slowest(bundle: Bundle, low: Array, high: Array) -> Array:
    """The places (n,) of least speed between two others, by the golden section."""
    for _ in range(NARROWINGS if len(low) else 0):
        width = GOLDEN * (high - low)
        nearer = bundle.speeds(high - width) <= bundle.speeds(low + width)
        low, high = np.where(nearer, low, high - width), np.where(nearer, low + width, high)
    return 0.5 * (low + high)
