"""Which arcs follow the curves of a drawing?

All curves at once: thousands of them take little longer than a few. Drawing programs write circles as four cubics whose
handles are 0.5523 radii long; these leave the circle by 2.7e-4 of the radius. Where that is within the tolerance the circle is
meant and drawn; where it is more, the curves are followed as drawn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np

from watchsim.drawing.findings import Stroke, finding_at
from watchsim.drawing.projection import (
    ROUNDING,
    Conic,
    Gathering,
    Shape,
    Spline,
    Straight,
    TooLarge,
    Vector,
    Waiting,
    cannot_follow,
    emit,
    forward,
    keep,
    reach,
)
from watchsim.drawing.splines import SAME, Follower
from watchsim.geometry.biarcs import Array, Curve
from watchsim.geometry.fitting import Fit, fit_all
from watchsim.geometry.loops import QUARTER
from watchsim.geometry.primitives import TURN, Arc, Edge, moved, reflected
from watchsim.geometry.recognition import put_together

SAMPLES = 16  # per curve; those of a circle have two humps
SLACK = 0.01  # of the tolerance: curves that meet nearly smoothly may be moved so much
WIDEST = 1e6  # of the first curve's range of the parameter
LONGEST = 500  # curves in one chain
STRAIGHT = 1e-9  # of the squared length: by so little the control points of a straight curve may leave its line
CIRCLE_LIKE = 1e-3  # of the radius: a row of curves this near a circle was meant to be one


class Chain(NamedTuple):
    """Some Béziers as one spline; how many they are, and how far (drawing units) a common point of theirs was moved."""

    spline: Spline
    curves: int
    moved: float


class Circle(NamedTuple):
    """A circle or arc near some curves (metres), and how far they are from it at most."""

    arc: Arc
    deviation: float


def emit_row(found: Gathering, shapes: Sequence[Shape], layer: str, source: str) -> None:
    """Keeps the edges of one row of shapes (drawing units); rows of curves on one circle become that circle."""
    plain = [piece for shape in shapes for piece in (straightened(shape) if isinstance(shape, Spline) else (shape,))]
    for curved, group in groupby(plain, key=lambda shape: isinstance(shape, Spline)):
        row = list(group)
        if not curved:
            for shape in row:
                emit(found, shape, layer, source)
            continue
        curves = [shape for shape in row if isinstance(shape, Spline)]
        if not _round(found, curves, layer, source):
            for chain in chained(curves, SLACK * found.tolerance / found.scale):
                emit(found, chain.spline, layer, source, chain.curves, found.scale * chain.moved)


def straightened(curve: Spline) -> Sequence[Shape]:
    """The lines that a Bézier is if all its control points lie on one, to where it turns back and on; else itself."""
    if not _is_straight(curve):
        return (curve,)
    control = np.array([point[:2] for point in curve.points])
    along = control @ max(control[1:] - control[0], key=lambda way: float(np.hypot(*way)))
    # The derivative in powers of t: k = 0 .. n-1 of sums of binomials times differences of the control points.
    steps, n = np.diff(along), curve.degree - 1
    powers = [
        math.comb(n, k) * sum((-1) ** (k - i) * math.comb(k, i) * float(steps[i]) for i in range(k + 1)) for k in range(n + 1)
    ]
    size = max(map(abs, powers))
    roots = np.roots([power if abs(power) > 1e-14 * size else 0.0 for power in reversed(powers)])
    turns = sorted({float(t.real) for t in roots if t.imag == 0.0 and 0.0 < t.real < 1.0})
    corners = [curve.points[0], *(_bezier_point(curve, t) for t in turns), curve.points[-1]]
    return [Straight(a, b) for a, b in pairwise(corners)]


def _bezier_point(curve: Spline, t: float) -> Vector:
    n = curve.degree
    weights = [math.comb(n, k) * t**k * (1.0 - t) ** (n - k) for k in range(n + 1)]
    x, y = (sum(weight * point[axis] for weight, point in zip(weights, curve.points, strict=True)) for axis in (0, 1))
    return (x, y, 0.0)


def chained(row: Sequence[Spline], slack: float) -> list[Chain]:
    """Béziers that follow each other smoothly as one spline each, so that arcs can run across where they meet.

    Two cubics whose handles at their common point lie on one line are a cubic spline with a double knot there, if their
    ranges of the parameter are as long as to give both the same speed (G. Farin, Curves and Surfaces for CAGD, ch. 7).
    The common point is then given by the handles; by that it may move `slack` (drawing units).
    """
    chains: list[Chain] = []
    run: list[Spline] = []
    spans: list[float] = []
    moved = 0.0
    for curve in row:
        cubic = elevated(curve)
        ratio, offset = _joint(run[-1], cubic) if run else (0.0, math.inf)
        span = spans[-1] * ratio if run else 0.0
        if offset <= slack and 1.0 / WIDEST <= span <= WIDEST and len(run) < LONGEST:
            run.append(cubic)
            spans.append(span)
            moved = max(moved, offset)
            continue
        if run:
            chains.append(Chain(_spline_of(run, spans), len(run), moved))
        run, spans, moved = [cubic], [1.0], 0.0
    return [*chains, Chain(_spline_of(run, spans), len(run), moved)] if run else chains


def elevated(curve: Spline) -> Spline:
    """A quadratic Bézier as a cubic one."""
    if curve.degree != 2:
        return curve
    a, b, c = curve.points
    inner = [(p[0] + 2.0 * (b[0] - p[0]) / 3.0, p[1] + 2.0 * (b[1] - p[1]) / 3.0, 0.0) for p in (a, c)]
    return Spline(3, [0.0] * 4 + [1.0] * 4, [a, inner[0], inner[1], c])


def _joint(first: Spline, second: Spline) -> tuple[float, float]:
    """How much longer the second handle at the common point is, and how far that point lies from where the handles put it."""
    (ax, ay, _), (x, y, _), (bx, by, _) = first.points[2], first.points[3], second.points[1]
    before, after = math.hypot(x - ax, y - ay), math.hypot(bx - x, by - y)
    if before == 0.0 or after == 0.0:
        return 0.0, math.inf
    share = before / (before + after)
    return after / before, math.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y)


def _is_straight(curve: Spline) -> bool:
    (x0, y0, _), *others = curve.points
    inner = [(x - x0, y - y0) for x, y, _ in others]
    length = max(math.hypot(x, y) for x, y in inner)
    ex, ey = max(inner, key=lambda p: math.hypot(*p))
    return all(abs(ex * y - ey * x) <= STRAIGHT * length * length for x, y in inner)


def _spline_of(run: Sequence[Spline], spans: Sequence[float]) -> Spline:
    if len(run) == 1:
        return run[0]
    points = [run[0].points[0]]
    knots = [0.0] * 4
    for cubic, span in zip(run, spans, strict=True):
        points += cubic.points[1:3]
        knots += [knots[-1] + span] * 2
    return Spline(3, [*knots, knots[-1], knots[-1]], [*points, run[-1].points[3]])


def _round(found: Gathering, row: Sequence[Spline], layer: str, source: str) -> bool:
    """Keeps a row that closes into a circle within the tolerance; otherwise says that it nearly does."""
    if row[0].points[0] != row[-1].points[-1] or len(row) < 2:
        return False
    circle = circle_of(row, found.scale)
    if circle is None:
        return False
    limit = max(found.tolerance, ROUNDING * found.scale * max(map(reach, row)))
    if circle.deviation <= limit:
        keep(found, (circle.arc,), layer, source)
        found.kinds["spline"] += len(row)
        found.curves += len(row)
        found.arcs += 1
        found.deviation = max(found.deviation, circle.deviation)
        return True
    message = (
        f"{source} stands for a circle of radius {1e3 * circle.arc.radius:.6g} mm but leaves it by "
        f"{1e6 * circle.deviation:.3g} µm; it is followed as drawn"
    )
    fix = "Draw it as a circle, or allow a larger fit."
    found.findings.append(finding_at((circle.arc.x, circle.arc.y), "near-circle", "notice", message, fix, layer))
    return False


def circle_of(row: Sequence[Spline], scale: float) -> Circle | None:
    """The full circle (metres) that the ends of these Béziers lie on, if they run round it once and stay near."""
    ends = scale * np.array([spline.points[0][:2] for spline in row])
    samples = np.concatenate([scale * bezier_points(spline) for spline in row])
    middle = samples[SAMPLES // 2 :: SAMPLES]
    centre, radius = _circle_through(np.concatenate((ends, middle)) if len(ends) < 3 else ends)
    if not radius > 0.0:
        return None
    offsets = samples - centre
    deviation = float(np.max(np.abs(np.hypot(offsets[:, 0], offsets[:, 1]) - radius)))
    if not deviation <= CIRCLE_LIKE * radius:
        return None
    angles = np.arctan2(offsets[:, 1], offsets[:, 0])
    steps = np.remainder(np.diff(np.append(angles, angles[0])) + math.pi, TURN) - math.pi
    turn = float(np.sum(steps))
    if abs(abs(turn) - TURN) > 1.0 or not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        return None
    # Between the samples the distance goes on growing by no more than the square of half a step of its wave.
    deviation *= 1.0 + (math.pi / SAMPLES) ** 2
    return Circle(Arc(float(centre[0]), float(centre[1]), radius, float(angles[0]), math.copysign(TURN, turn)), deviation)


def _circle_through(points: Array) -> tuple[Array, float]:
    """The circle nearest to points (n, 2) in the algebraic sense (I. Kåsa, IEEE Trans. Instrum. Meas. 25, 1976)."""
    origin = points.mean(axis=0)
    local = points - origin
    matrix = np.column_stack((2.0 * local, np.ones(len(local))))
    (x, y, rest), *_ = np.linalg.lstsq(matrix, np.sum(local * local, axis=1), rcond=None)
    return origin + np.array([x, y]), math.sqrt(max(rest + x * x + y * y, 0.0))


def bezier_points(spline: Spline) -> Array:
    """SAMPLES points (n, 2) along a Bézier, its end left out."""
    t = np.arange(SAMPLES)[:, None] / SAMPLES
    n = spline.degree
    control = np.array([point[:2] for point in spline.points])
    return sum(math.comb(n, k) * t**k * (1.0 - t) ** (n - k) * control[k] for k in range(n + 1))


# Ellipses are cut at the ends of their axes.

SLIVER = 0.02  # radians of the parameter


class Stretch(NamedTuple):
    """A part of an ellipse: the number of the curve that is followed, and the quadrant that this one is mirrored into."""

    curve: int
    quadrant: int | None


def ellipses_edges(conics: Sequence[Conic], scale: float, tolerances: Sequence[float]) -> list[Fit]:
    """Tangent-continuous arcs (metres) within `tolerances` metres, for each ellipse the same in every quadrant.

    Cut at the ends of the axes: in between the curvature grows or falls throughout. Where the arcs on both sides of such an
    end belong to one circle they become one arc.
    """
    curves: list[Curve] = []
    limits: list[float] = []
    plans: list[tuple[Array, Array, list[Stretch]]] = []
    for conic, tolerance in zip(conics, tolerances, strict=True):
        first, cuts = axis_cuts(conic)
        c, s = math.cos(first), math.sin(first)
        u, v = scale * np.array(conic.u[:2]), scale * np.array(conic.v[:2])
        a, b = c * u + s * v, c * v - s * u  # the half axes
        stretches: list[Stretch] = []
        whole: int | None = None
        for low, high in pairwise(cuts):
            quarter = abs(high - low - QUARTER) <= 1e-9
            if whole is None or not quarter:
                curves.append(rational(a, b, 0.0, QUARTER) if quarter else rational(a, b, low - first, high - first))
                limits.append(tolerance)
            whole = whole if whole is not None or not quarter else len(curves) - 1
            if quarter and whole is not None:
                stretches.append(Stretch(whole, round((low - first) / QUARTER) % 4))
            else:
                stretches.append(Stretch(len(curves) - 1, None))
        plans.append((a, b, stretches))
    fits = fit_all(curves, limits)
    return [
        _placed(scale * np.array(conic.centre[:2]), plan, fits, tolerance)
        for conic, plan, tolerance in zip(conics, plans, tolerances, strict=True)
    ]


def _placed(centre: Array, plan: tuple[Array, Array, list[Stretch]], fits: Sequence[Fit], tolerance: float) -> Fit:
    """The edges of all stretches of one ellipse."""
    a, b, stretches = plan
    x, y = centre.tolist()
    parts = []
    for curve, quadrant in stretches:
        edges = fits[curve].edges if quadrant is None else in_quadrant(fits[curve], a, b, quadrant)
        parts.append(Fit(tuple(moved(edge, 0.0, (x, y)) for edge in edges), fits[curve].deviation))
    return put_together(parts, tolerance)


def rational(a: Array, b: Array, low: float, high: float) -> Curve:
    """a·cos t + b·sin t from `low` to at most a quarter turn later, as a rational parabola in the tangent of half the angle."""
    half = 0.5 * (high - low)
    angles, weights = np.array([low, low + half, high]), np.array([1.0, math.cos(half), 1.0])
    points = np.cos(angles)[:, None] * a + np.sin(angles)[:, None] * b
    points[1] /= weights[1]
    return Curve(np.column_stack((points * weights[:, None], weights))[None], np.array([0.0, 1.0]))


def in_quadrant(fit: Fit, a: Array, b: Array, number: int) -> list[Edge]:
    """The edges of the first quadrant mirrored in the axes into quadrant 0 to 3, in travel order."""
    edges = list(fit.edges)
    if number in (1, 2):
        edges = [mirrored(edge, a) for edge in edges]
    if number in (2, 3):
        edges = [mirrored(edge, b) for edge in edges]
    return edges if number in (0, 2) else [edge.reversed() for edge in reversed(edges)]


def mirrored(edge: Edge, axis: Array) -> Edge:
    """The mirror image with the component along `axis` turned round."""
    nx, ny = (axis / math.hypot(*axis)).tolist()
    return reflected(edge, (0.0, 0.0), (-ny, nx))


def axis_cuts(conic: Conic) -> tuple[float, list[float]]:
    """The parameter of one half axis; and start, the ends of the axes in between, end.

    The axes lie where |c'(t)| is extreme, at tan 2t = 2 u·v/(u² - v²). No sliver is cut off at start and end.
    """
    (ux, uy, _), (vx, vy, _) = conic.u, conic.v
    first = 0.5 * math.atan2(2.0 * (ux * vx + uy * vy), ux * ux + uy * uy - vx * vx - vy * vy)
    stop = conic.start + conic.sweep
    k = math.ceil((conic.start - first) / QUARTER)
    cuts = [conic.start]
    while first + k * QUARTER < stop - SLIVER:
        if first + k * QUARTER > conic.start + SLIVER:
            cuts.append(first + k * QUARTER)
        k += 1
    return first, [*cuts, stop]


AT_ONCE = 4096  # curves: then it is looked whether they become too many pieces


def follow(found: Gathering) -> None:
    """Puts the lines and arcs of all waiting curves among the strokes, in the order of the file. May raise TooLarge."""
    waiting, found.waiting = found.waiting, []
    strokes: list[Stroke] = []
    follower = Follower(found.scale)
    taken = 0
    for first in range(0, len(waiting), AT_ONCE):
        chosen = waiting[first : first + AT_ONCE]
        for curve, (fit, fitted) in zip(chosen, _fits(chosen, follower), strict=True):
            strokes += found.strokes[taken : curve.before]
            taken = curve.before
            strokes += [Stroke(edge, curve.layer, curve.source, curve.run) for edge in fit.edges]
            if fitted:
                found.curves += curve.curves
                found.arcs += sum(isinstance(edge, Arc) for edge in fit.edges)
                found.deviation = max(found.deviation, fit.deviation + curve.moved)
                if fit.deviation > curve.limit * (1.0 + SAME):
                    cannot_follow(found, curve, fit.deviation)
        if len(strokes) > found.most:
            raise TooLarge
    found.strokes = strokes + found.strokes[taken:]


def _fits(waiting: Sequence[Waiting], follower: Follower) -> Iterator[tuple[Fit, bool]]:
    """Lines and arcs for each curve, and whether anything had to be fitted."""
    splines = [(curve.shape, curve.limit) for curve in waiting if isinstance(curve.shape, Spline)]
    conics = [(forward(curve.shape), curve.limit) for curve in waiting if isinstance(curve.shape, Conic)]
    followed = iter(follower.edges([shape for shape, _ in splines], [limit for _, limit in splines]))
    rounded = iter(ellipses_edges([shape for shape, _ in conics], follower.scale, [limit for _, limit in conics]))
    for curve in waiting:
        yield next(followed) if isinstance(curve.shape, Spline) else (next(rounded), True)
