"""Which few arcs follow this curve?

The deviation e of a tangent-continuous chain of arcs from a curve obeys e″ = k - κ: k is constant on each arc, κ the curvature
of the curve. So the best chain is the best uniform approximation by quadratic splines with free knots. Where κ′ hardly
changes that leaves e = κ′ h³ B₃(s/h) / 6, the third Bernoulli polynomial, on arcs of length h, and |e| ≤ √3/216 |κ′| h³.
Hence no chain within ε has fewer arcs than (√3/216 / ε)^(1/3) ∫ |κ′|^(1/3) ds, for small ε. Biarcs that take the tangents of
the curve where they meet it (D. S. Meek, D. J. Walton, Approximating smooth planar curves by arc splines, J. Comput. Appl.
Math. 59, 1995) leave 2/81 |κ′| h³ and need 1.45 times as many. Here their tangents are turned by -κ′h²/12, the slope of the
Bernoulli polynomial, and the lengths are corrected step by step until all deviations are alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.biarc import ArcChain, arcs_from, crosses, dots
from watchsim.geometry.fitting.bundle import Bundle
from watchsim.geometry.fitting.curve import Array, Curve
from watchsim.geometry.fitting.deviation import deviations
from watchsim.geometry.fitting.fewest import BRISK, THOROUGH, Effort, Found, fewest
from watchsim.geometry.fitting.smooth import smooth_parts
from watchsim.geometry.primitives import Edge, Line

KINK = 1e-6  # radians between a single arc's and the curve's tangent at its end
ROUNDS = 20  # of distributing the arcs anew
ROUNDS_OF_HALVES = 6  # where the whole did not succeed
AT_ONCE = 1024  # curves: so many that single steps cost little, so few that the numbers stay near the processor
MANY = 4000  # spans: where more wait, the search for the fewest arcs stops a little sooner
DEEPEST = 40  # halvings where nothing helps: at a cusp
NOTHING = 1e-5  # of the tolerance: edges shorter than that are left out
LOOKS = 33  # places in each span that show its extent


class Fit(NamedTuple):
    """Edges in travel order, and a bound of the distance (metres) between the curve and them."""

    edges: tuple[Edge, ...]
    deviation: float


def fit_arcs(curve: Curve, tolerance: float) -> Fit:
    """Tangent-continuous arcs along the whole curve, within `tolerance` metres.

    Where the curve itself has a corner or a cusp so have they. A larger deviation than the tolerance is possible where the
    curve jumps, and is reported.
    """
    return fit_all([curve], [tolerance])[0]


def fit_all(curves: Sequence[Curve], tolerances: Sequence[float]) -> list[Fit]:
    """The same for many curves, much faster than one by one; where there are very many, with some more arcs."""
    effort = THOROUGH if sum(len(curve.control) for curve in curves) <= MANY else BRISK
    parts: list[list[Curve]] = [[] for _ in curves]
    for chosen in batches(curves):
        smooth = smooth_parts([curves[k] for k in chosen], np.array([tolerances[k] for k in chosen]))
        for k, row in zip(chosen, smooth, strict=True):
            parts[k] = row
    each = np.array([limit for row, limit in zip(parts, tolerances, strict=True) for _ in row])
    fits = iter(_follow([part for row in parts for part in row], each, effort, 0))
    return [_end_to_end([next(fits) for _ in row]) for row in parts]


def batches(curves: Sequence[Curve]) -> Iterator[list[int]]:
    """Numbers of curves that can be looked at together."""
    alike: dict[int, list[int]] = {}
    for k, curve in enumerate(curves):
        alike.setdefault(curve.degree, []).append(k)
    for numbers in alike.values():
        for first in range(0, len(numbers), AT_ONCE):
            yield numbers[first : first + AT_ONCE]


def _follow(curves: Sequence[Curve], tolerance: Array, effort: Effort, depth: int) -> list[Fit]:
    """Arcs along smooth curves, which are halved where no chain is found."""
    result: list[Fit] = [Fit((), 0.0)] * len(curves)
    missing = []
    for chosen in batches(curves):
        rounds = ROUNDS if depth == 0 else ROUNDS_OF_HALVES
        found = _chains([curves[k] for k in chosen], tolerance[chosen], rounds, effort)
        for k, chain, fit in zip(chosen, found, _fits(found, tolerance[chosen]), strict=True):
            result[k] = fit
            if chain is None:
                away = _extent(curves[k])
                if away <= tolerance[k] or depth >= DEEPEST:
                    result[k] = _chord(curves[k], away, float(tolerance[k]))
                else:
                    missing.append(k)
    if missing:
        halves = [half for k in missing for half in curves[k].split(0.5 * len(curves[k].control))]
        fits = iter(_follow(halves, np.repeat(tolerance[missing], 2), effort, depth + 1))
        for k in missing:
            result[k] = _end_to_end((next(fits), next(fits)))
    return result


def _chains(curves: Sequence[Curve], tolerance: Array, rounds: int, effort: Effort) -> list[Found | None]:
    """One arc or the fewest along each of some curves of one degree; None where none are found."""
    found = _one_arc_each(Bundle(curves), tolerance)
    rest = [k for k, chain in enumerate(found) if chain is None]
    if rest:
        for k, chain in zip(rest, fewest(Bundle([curves[k] for k in rest]), tolerance[rest], rounds, effort), strict=True):
            found[k] = chain
    return found


def _chord(curve: Curve, away: float, tolerance: float) -> Fit:
    """The line from end to end of a short curve that is at most `away` from it."""
    (x0, y0), (x1, y1) = curve.ends.tolist()
    chord = Line(x0, y0, x1, y1)
    return Fit((chord,) if chord.length > NOTHING * tolerance else (), away)


def _end_to_end(fits: Sequence[Fit]) -> Fit:
    if len(fits) == 1:
        return fits[0]
    return Fit(tuple(edge for fit in fits for edge in fit.edges), max(fit.deviation for fit in fits))


def _fits(found: Sequence[Found | None], tolerance: Array) -> list[Fit]:
    """The lines and arcs of chains; nothing where there is none."""
    chains = [chain.arcs for chain in found if chain is not None]
    edges = iter(ArcChain(*(np.concatenate(column) for column in zip(*chains, strict=True))).edges() if chains else ())
    result = []
    for chain, limit in zip(found, (NOTHING * tolerance).tolist(), strict=True):
        own = [next(edges) for _ in chain.arcs.curvatures] if chain is not None else []
        result.append(Fit(tuple(edge for edge in own if edge.length > limit), chain.deviation if chain is not None else 0.0))
    return result


def _extent(curve: Curve) -> float:
    """A bound of the distance between a short curve and its chord, wherever it turns: its extent, sampled."""
    number = np.arange(len(curve.control))
    points = Bundle([curve]).at(number, np.broadcast_to(np.linspace(0.0, 1.0, LOOKS), (len(number), LOOKS)))
    return float(np.hypot(np.ptp(points[0]), np.ptp(points[1])))


def _one_arc_each(bundle: Bundle, tolerance: Array) -> list[Found | None]:
    """The single arc or line, where it has the right tangents at both ends and stays within the tolerance."""
    low, high = bundle.begin.astype(float), bundle.end.astype(float)
    starts, ways, ends, last = bundle.points(low), bundle.tangents(low), bundle.points(high), bundle.tangents(high)
    arcs = arcs_from(starts, ways, ends)
    mirrored = np.where((arcs.curvatures != 0.0)[:, None], arcs.end_tangents, ways)
    with np.errstate(invalid="ignore"):
        smooth: NDArray[np.bool_] = (np.abs(crosses(mirrored, last)) <= KINK) & (dots(mirrored, last) > 0.0)
    result: list[Found | None] = [None] * len(bundle)
    chosen = np.flatnonzero(smooth)
    if len(chosen):
        own = ArcChain(*(column[chosen] for column in arcs))
        errors = deviations(bundle, low[chosen], high[chosen], own, np.arange(len(chosen)))
        for i in np.flatnonzero(errors <= tolerance[chosen]).tolist():
            result[chosen[i]] = Found(ArcChain(*(column[i : i + 1] for column in own)), float(errors[i]))
    return result
