"""Is this row of Bézier curves a circle or an arc, and what else becomes of it?

Drawing programs write circles as four cubics whose handles are 0.5523 radii long. These leave the circle by 2.7e-4 of the
radius. Where that is within the tolerance the circle is meant and drawn; where it is more, the curves are followed as drawn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.findings import Finding
from watchsim.drawing.projection import ROUNDING, Gathering, emit, keep, reach
from watchsim.drawing.shapes import Shape, Spline
from watchsim.geometry.primitives import TURN, Arc

Array = NDArray[np.float64]
SAMPLES = 16  # per curve; those of a circle have two humps
CIRCLE_LIKE = 1e-3  # of the radius: a row of curves this near a circle was meant to be one


class Circle(NamedTuple):
    """A circle or arc near some curves (metres), and how far they are from it at most."""

    arc: Arc
    deviation: float


def emit_row(found: Gathering, shapes: Sequence[Shape], layer: str, source: str) -> None:
    """Keeps the edges of one row of shapes (drawing units); rows of curves on one circle become that circle."""
    for curved, group in groupby(shapes, key=lambda shape: isinstance(shape, Spline)):
        row = list(group)
        if curved and _round(found, [shape for shape in row if isinstance(shape, Spline)], layer, source):
            continue
        for shape in row:
            emit(found, shape, layer, source)


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
        found.curves += len(row)
        found.arcs += 1
        found.deviation = max(found.deviation, circle.deviation)
        return True
    message = (
        f"{source} stands for a circle of radius {1e3 * circle.arc.radius:.6g} mm but leaves it by "
        f"{1e6 * circle.deviation:.3g} µm; it is followed as drawn"
    )
    fix = "Draw it as a circle, or allow a larger fit."
    found.findings.append(Finding("near-circle", "notice", message, fix, layer, 1e3 * circle.arc.x, 1e3 * circle.arc.y))
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
