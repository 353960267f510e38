"""Is this curve drawn with straight pieces, and how far off are they?

Facets are not arcs: a locking face of facets pushes in steps. They are imported as drawn. Where they leave the smooth curve
through their corners by more than a fitted curve may, they are reported, once for each outline.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.findings import Finding
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line, Point

Array = NDArray[np.float64]

FEWEST = 6  # pieces in a row
SHARPEST = math.radians(31.0)  # turn from piece to piece: a twelve-sided nut is still taken for a circle
SMOOTH = 2.0  # times: the curvature of a curve changes by no more from corner to corner
EQUAL = 0.02  # relative difference of radii in an arc
VISIBLE = 1e-7  # m: what splines and ellipses may be off by, too


class Row(NamedTuple):
    """Straight pieces that stand for one curve: their number, the largest rise (m) and where, the radii at their corners."""

    pieces: int
    rise: float
    place: Point
    radii: Array


def facets(loops: Iterable[Loop]) -> list[Finding]:
    """A warning for each outline with straight pieces that stand for a curve and are visibly off it."""
    found = ((loop, [row for row in rows(loop) if row.rise > VISIBLE]) for loop in loops)
    return [facet_finding(loop, off) for loop, off in found if off]


def rows(loop: Loop) -> list[Row]:
    """The rows of at least FEWEST lines through whose corners a smooth curve goes."""
    edges = loop.edges
    count = len(edges)
    if count < FEWEST or sum(isinstance(edge, Line) for edge in edges) < FEWEST:
        return []
    # A piece that is no line has no length here, so that no curve goes on through its ends.
    ways = np.array([(e.x1 - e.x0, e.y1 - e.y0) if isinstance(e, Line) else (0.0, 0.0) for e in edges])
    bends = curvatures(ways)
    if not loop.closed:
        bends[-1] = np.nan
    length = np.hypot(*ways.T)
    found = []
    for first, joints in smooth_rows(bends):
        whole = joints == count
        at = (first + np.arange(joints)) % count  # joint k lies between the pieces k and k + 1
        pieces = at if whole else (first + np.arange(joints + 1)) % count
        if len(pieces) < FEWEST:
            continue
        bend = np.abs(bends[at])
        both = 0.5 * (bend + np.roll(bend, 1)) if whole else 0.5 * (np.append(bend, bend[-1]) + np.append(bend[0], bend))
        half = 0.5 * length[pieces] * both  # sine of half the angle that the piece spans
        rise = (1.0 - np.sqrt(np.maximum(1.0 - half * half, 0.0))) / both
        worst = int(np.argmax(rise))
        found.append(Row(len(pieces), float(rise[worst]), edges[int(pieces[worst])].point(0.5), 1.0 / bend))
    return found


def curvatures(ways: Array) -> Array:
    """Of the curve through the corner after each piece, 1/m, positive to the left; nan where it is none.

    It is that of the circle through three corners, whatever the lengths of the two pieces.
    """
    after = np.roll(ways, -1, axis=0)
    span = np.hypot(*(ways + after).T)
    turn = np.arctan2(ways[:, 0] * after[:, 1] - ways[:, 1] * after[:, 0], np.sum(ways * after, axis=1))
    smooth = (turn != 0.0) & (np.abs(turn) < SHARPEST)  # a piece of no length has no turn
    return np.where(smooth, 2.0 * np.sin(turn) / np.where(smooth, span, 1.0), np.nan)


def smooth_rows(bends: Array) -> list[tuple[int, int]]:
    """(first joint, number of joints) of the longest rows of joints, around the outline, whose curvatures go on smoothly."""
    count = len(bends)
    following = np.roll(bends, -1)
    with np.errstate(invalid="ignore"):
        ratio = following / bends
    goes_on = (ratio <= SMOOTH) & (ratio >= 1.0 / SMOOTH)  # False for nan
    if goes_on.all():
        return [(0, count)]
    breaks = np.flatnonzero(~goes_on)  # the row ends with this joint
    sizes = np.diff(np.append(breaks, breaks[0] + count))
    return [((int(k) + 1) % count, int(size)) for k, size in zip(breaks, sizes, strict=True) if size >= FEWEST - 1]


def facet_finding(loop: Loop, off: list[Row]) -> Finding:
    """The warning with the number of pieces, the curve they stand for, and by how much they miss it."""
    worst = max(off, key=lambda row: row.rise)
    pieces = sum(row.pieces for row in off)
    radii = worst.radii
    equal = float(np.ptp(radii)) <= EQUAL * float(radii.max())
    curve = f"an arc of radius {1e3 * float(np.median(radii)):.4g} mm" if equal else "a curve"
    if len(off) > 1:
        curve = f"curves at {len(off)} places"
    message = (
        f"{pieces} straight pieces stand for {curve} (up to {1e6 * worst.rise:.3g} µm off); contacts run over their corners"
    )
    fix = f"Draw {'ARCs or CIRCLEs' if len(off) > 1 else 'an ARC or CIRCLE' if equal else 'a SPLINE or ARCs'} instead."
    x, y = worst.place
    return Finding("facets", "warning", message, fix, loop.layer, 1e3 * x, 1e3 * y)
