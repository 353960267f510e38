"""How are so many arcs laid along a curve?

Single arcs at the ends and biarcs in between. The tangents at the ends of the biarcs are the curve's, turned a little so that
the deviation swings evenly (see fit).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.biarc import ArcChain, arcs_from, biarc_joints, crosses, dots
from watchsim.geometry.curve import Array, Curve
from watchsim.geometry.deviation import glances

# Arcs of the best chain whose work the pieces do. At its ends the chain has the tangent of the curve, which costs some.
ALONE, BOTH_ENDS, ONE_END, INSIDE = 0.69, 1.38, 1.75, 2.0
MOST_TILT = 0.1  # radians, of the tangent at a joint
HARDEST = 64.0  # tolerances: what a larger deviation counts
NEWTON = 2  # steps; the first guess is good
BALANCE = 0.1  # of the logarithm of two deviations: correction of that of the legs of a biarc


class Trial(NamedTuple):
    """Arcs between the stations (parameters) and their deviations; pieces between the nodes, their first arcs."""

    stations: Array
    arcs: ArcChain
    nodes: Array
    ratios: Array
    first: NDArray[np.intp]
    errors: Array

    @property
    def worst(self) -> float:
        return float(np.max(self.errors))

    def strains(self, tolerance: float) -> Array:
        """For each piece by how much it is too long: the cube root of deviation over tolerance, the mean of its arcs."""
        strain = np.cbrt(np.minimum(self.errors / tolerance, HARDEST))
        return np.add.reduceat(strain, self.first) / np.diff(np.append(self.first, len(strain)))


@lru_cache(maxsize=1024)
def capacities(count: int) -> Array:
    """How the pieces of a chain of `count` arcs share the work of the best chain: single arcs at the ends, else biarcs."""
    if count == 2:
        return np.array([BOTH_ENDS])
    if count % 2:
        return np.array([ALONE, *[INSIDE] * (count // 2 - 1), ONE_END])
    return np.array([ALONE, *[INSIDE] * (count // 2 - 1), ALONE])


def lay_chain(curve: Curve, t: Array, load: Array, capacity: Array, skew: Array) -> Trial:
    """Single arcs at the ends and biarcs in between, distributed so that each gets its share of the load."""
    bounds = np.append(0.0, np.cumsum(capacity)) * (load[-1] / np.sum(capacity))
    nodes = np.interp(bounds, load, t)
    nodes[0], nodes[-1] = t[0], t[-1]
    ratios = np.exp(np.interp(0.5 * (nodes[:-1] + nodes[1:]), *skew)) if skew.size else np.ones(len(capacity))
    middles = np.interp(bounds[:-1] + np.diff(bounds) / (1.0 + ratios), load, t)
    both = np.concatenate((nodes, middles))
    points, directions = curve.points(both), curve.tangents(both, float(t[0]), float(t[-1]))
    count = len(nodes)
    at, halfway = points[:count], points[count:]
    tangents = _tilted(at, halfway, directions[:count], directions[count:])
    single = capacity == ALONE
    if single[0]:
        tangents[1] = _mirrored(at[1] - at[0], tangents[0])
    if single[-1]:
        tangents[-2] = _mirrored(at[-1] - at[-2], tangents[-1])
    pairs = np.flatnonzero(~single)
    joints, along = biarc_joints(at[pairs], tangents[pairs], at[pairs + 1], tangents[pairs + 1], ratios[pairs])
    between = _abreast(curve, joints, along, nodes[pairs], middles[pairs], nodes[pairs + 1])
    stations = np.concatenate((nodes, between))
    order = np.argsort(stations, kind="stable")
    corners, ways = np.concatenate((at, joints))[order], np.concatenate((tangents, along))[order]
    arcs = arcs_from(corners[:-1], ways[:-1], corners[1:])
    errors = glances(curve, stations[order], arcs)
    first = np.searchsorted(stations[order], nodes[:-1])
    return Trial(stations[order], arcs, nodes, ratios, first, errors)


def _tilted(at: Array, halfway: Array, tangents: Array, between: Array) -> Array:
    """The tangents (n, 2) at the nodes, the inner ones turned by -κ′h²/12, from the curve's turns to the places half-way."""
    back, ahead = np.hypot(*(at[1:-1] - halfway[:-1]).T), np.hypot(*(halfway[1:] - at[1:-1]).T)
    inner = tangents[1:-1]
    turn_back = np.arctan2(crosses(between[:-1], inner), dots(between[:-1], inner))
    turn_ahead = np.arctan2(crosses(inner, between[1:]), dots(inner, between[1:]))
    with np.errstate(invalid="ignore", divide="ignore"):
        tilt = -(turn_ahead * back - turn_back * ahead) / (6.0 * (back + ahead))
    tilt = np.clip(np.where(np.isfinite(tilt), tilt, 0.0), -MOST_TILT, MOST_TILT)
    c, s = np.cos(tilt), np.sin(tilt)
    result = tangents.copy()
    result[1:-1] = np.column_stack((c * inner[:, 0] - s * inner[:, 1], s * inner[:, 0] + c * inner[:, 1]))
    return result


def _mirrored(chord: Array, tangent: Array) -> Array:
    """The tangent at the other end of an arc."""
    with np.errstate(invalid="ignore", divide="ignore"):
        result: Array = 2.0 * (chord @ tangent) / (chord @ chord) * chord - tangent
    return result


def _abreast(curve: Curve, joints: Array, along: Array, low: Array, guess: Array, high: Array) -> Array:
    """The parameters (n,) where the curve crosses the normals of the joints, by Newton's method; inside `low` to `high`."""
    margin = 0.01 * (high - low)
    t = guess
    for _ in range(NEWTON):
        rise = dots(curve.points(t) - joints, along)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = rise / dots(curve.slopes(t), along)
        t = np.clip(t - np.where(np.isfinite(step), step, 0.0), low + margin, high - margin)
    return t


def balanced(trial: Trial) -> Array:
    """Middles of the pieces, and there the logarithm of the ratio of legs that makes both arcs of a biarc deviate alike."""
    double = np.diff(np.append(trial.first, len(trial.errors))) == 2
    change = np.zeros(len(trial.first))
    one, other = trial.errors[trial.first[double]], trial.errors[trial.first[double] + 1]
    with np.errstate(invalid="ignore", divide="ignore"):
        change[double] = np.clip(np.nan_to_num(np.log(one / other)) * BALANCE, -0.5, 0.5)
    middles = 0.5 * (trial.nodes[:-1] + trial.nodes[1:])
    return np.stack((middles[double], (np.log(trial.ratios) + change)[double]))
