"""Which outlines are circles, which curves are drawn with straight pieces, and how do bores lie to the outlines of a plate?

A bore that was drawn on a layer of its own lies wholly in material, wholly in none, or across an outline: then what is missing
must be drawn in the outline itself. Touching is no crossing, so a slot may reach the border.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.chain_faults import SHALLOW, Layer, all_meetings, crosses
from watchsim.drawing.findings import Finding, finding_at
from watchsim.drawing.material import is_mark
from watchsim.drawing.nodes import Outline
from watchsim.geometry.loops import Inside, Loop
from watchsim.geometry.primitives import Arc, Boxes, Line, Point
from watchsim.geometry.solids import area

SAME = 1e-9  # m: centres and radii this close are one
UNEVEN, ROUNDED = 1e-3, 1e-6  # of the radius, or m: so far corners of a regular polygon may lie from where they belong
SHARPEST = math.radians(31.0)  # turn from piece to piece: a twelve-sided nut is still taken for a circle
SHOWN = 8  # circles of a layer written out


class Circle(NamedTuple):
    """Metres. A regular polygon of `sides` stands for the circle through its corners; `deviation` is how far it leaves it."""

    centre: Point
    radius: float
    sides: int = 0
    deviation: float = 0.0


def circle_of(loop: Loop) -> Circle | None:
    """The circle that a closed outline is, in one piece, in arcs of one centre, or as a regular polygon; None for all else."""
    first = loop.edges[0]
    if loop.closed and isinstance(first, Line):
        return _polygon(loop)
    if not loop.closed or not isinstance(first, Arc) or (len(loop.edges) == 1 and not first.is_circle):
        return None
    for edge in loop.edges:
        if not isinstance(edge, Arc) or abs(edge.radius - first.radius) > SAME:
            return None
        if math.dist((edge.x, edge.y), (first.x, first.y)) > SAME:
            return None
    return Circle((first.x, first.y), first.radius)


def _polygon(loop: Loop) -> Circle | None:
    """Of equal straight sides, so many that it is neither a nut nor the square of an arbor."""
    count = len(loop.edges)
    if math.tau / count > SHARPEST or not all(isinstance(edge, Line) for edge in loop.edges):
        return None
    corners = np.array([edge.start for edge in loop.edges])
    centre = corners.mean(axis=0)
    arms = corners - centre
    radii = np.hypot(*arms.T)
    radius = float(radii.mean())
    uneven = float(np.abs(radii - radius).max())
    steps = np.diff(np.unwrap(np.arctan2(*arms.T[::-1]), axis=0), append=np.nan)[:-1]
    allowed = max(UNEVEN * radius, ROUNDED)
    if uneven > allowed or np.abs(np.abs(steps) - math.tau / count).max() * radius > 2.0 * allowed:
        return None
    return Circle((float(centre[0]), float(centre[1])), radius, count, uneven + radius * (1.0 - math.cos(math.pi / count)))


def circle_reports(loops: Iterable[Loop]) -> list[dict[str, object]]:
    """For `inspect --json`: layer, centre and radius (mm), whether it is a hole; of a polygon its sides and deviation (µm)."""
    return [
        {
            "layer": loop.layer,
            "x_mm": 1e3 * circle.centre[0],
            "y_mm": 1e3 * circle.centre[1],
            "radius_mm": 1e3 * circle.radius,
            "hole": loop.hole,
            "sides": circle.sides,
            "deviation_um": 1e6 * circle.deviation,
        }
        for loop in loops
        if (circle := circle_of(loop)) is not None
    ]


def circle_lines(loops: Iterable[Loop]) -> Iterator[str]:
    """For people: the circles of one layer, equal ones together."""
    alike: dict[tuple[str, str, str], list[Point]] = {}
    for loop in loops:
        circle = circle_of(loop)
        if circle is not None:
            word = "pivot" if is_mark(loop.layer) else "hole" if loop.hole else "circle"
            off = f", drawn as {circle.sides} straight pieces, {1e6 * circle.deviation:.3g} µm off" if circle.sides else ""
            alike.setdefault((word, f"{1e3 * circle.radius:.6g}", off), []).append(circle.centre)
    shown = 0
    for (word, radius, off), centres in alike.items():
        kept = centres[: max(0, SHOWN - shown)]
        shown += len(centres)
        places = ", ".join(f"({_mm(x)}, {_mm(y)})" for x, y in kept)
        rest = len(centres) - len(kept)
        more = "" if not rest else f" and {rest} more" if kept else f"{rest}"
        where = f" at {places}{' mm' if kept else ''}{more}" if kept else f": {more}"
        yield f"{word if len(centres) == 1 else word + 's'} of radius {radius} mm{where}{off}"


def _mm(value: float) -> str:
    return f"{round(1e3 * value, 6) + 0.0:.6g}"


# Facets are not arcs: a locking face of facets pushes in steps. They are imported as drawn. Where they leave the smooth curve
# through their corners by more than a fitted curve may, they are reported, once for each outline.

Array = NDArray[np.float64]

FEWEST = 6  # pieces in a row
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
    off_by = f"up to {1e6 * worst.rise:.3g} µm off"
    message = f"{pieces} straight pieces stand for {curve} ({off_by}); contacts run over their corners"
    fix = f"Draw {'ARCs or CIRCLEs' if len(off) > 1 else 'an ARC or CIRCLE' if equal else 'a SPLINE or ARCs'} instead."
    return finding_at(worst.place, "facets", "warning", message, fix, loop.layer)


DEEPER = 4.0  # than what crosses without being a crossing: a point that far inside is inside


@dataclass(slots=True)
class Lie:
    """Of one bore: in how many `outlines` and `holes` of the plate it lies.

    `crosses` is a point (metres) where it crosses an outline of the plate, `around` one of them that it encloses or covers,
    `within` the number of a bore around it or in the same place; `meets` the number of an earlier bore that it crosses, and
    where.
    """

    outlines: int = 0
    holes: int = 0
    crosses: Point | None = None
    around: Loop | None = None
    within: int | None = None
    meets: tuple[int, Point] | None = None

    @property
    def clear(self) -> bool:
        """Can it be decided whether it lies in material?"""
        return self.crosses is None and self.around is None and self.meets is None

    @property
    def taken(self) -> bool:
        """Is it to be taken out of the plate?"""
        return self.clear and self.depth == 1 and self.within is None

    @property
    def depth(self) -> int:
        """How many times there is material around it."""
        return self.outlines - self.holes


def lies(bores: Sequence[Loop], plate: Sequence[Loop]) -> list[Lie]:
    """Of every bore (closed loops, running either way) to the closed loops of a plate and to the other bores."""
    found = [Lie() for _ in bores]
    if bores:
        rows = [*plate, *(bore if area(bore) > 0.0 else bore.reversed() for bore in bores)]
        _note_crossings(found, rows)
        _note_nesting(found, rows)
    return found


def _note_crossings(found: list[Lie], rows: Sequence[Loop]) -> None:
    """The last of `rows` are the bores; what crosses among the others was found when the drawing was read."""
    first = len(rows) - len(found)
    layer = Layer([Outline(loop, ("",) * len(loop.edges)) for loop in rows], SHALLOW)
    for meeting in all_meetings(layer)[0]:
        one, other = sorted((int(layer.owner[meeting.first]), int(layer.owner[meeting.second])))
        if other < first or one == other:
            continue
        place = next((p for p in meeting.points if crosses(layer, meeting, p)), None)
        if place is not None and one < first:
            found[other - first].crosses = place
        elif place is not None:
            found[other - first].meets = (one - first, place)


def _note_nesting(found: list[Lie], rows: Sequence[Loop]) -> None:
    """Where nothing crosses, a loop lies in a larger one if a point of it does."""
    first = len(rows) - len(found)
    sizes = [abs(area(loop)) for loop in rows]
    boxes = Boxes(np.array([loop.box for loop in rows]))
    probes = [_inner_point(loop.reversed() if loop.hole and k < first else loop) for k, loop in enumerate(rows)]
    insides: dict[int, Inside] = {}
    for small, large in zip(*(column.tolist() for column in boxes.holding(np.array(probes))), strict=True):
        over = sizes[large] - sizes[small]
        if max(small, large) < first or over < 0.0 or (over == 0.0 and small <= large):
            continue
        if large not in insides:
            insides[large] = Inside(rows[large])
        if insides[large].winding(probes[small]) == 0:
            continue
        if min(small, large) >= first:
            found[small - first].within = large - first
            continue
        bore, loop = found[max(small, large) - first], rows[min(small, large)]
        covers = over <= SHALLOW * rows[large].length  # they lie on each other
        if loop.hole and (covers or large < first):
            bore.holes += 1
        elif covers or small < first:
            bore.around = loop
        else:
            bore.outlines += 1


def _inner_point(loop: Loop) -> Point:
    """A point inside a loop that runs counter-clockwise, beside the middle of its longest edge: deeper than a touch."""
    edge = max(loop.edges, key=lambda edge: edge.length)
    (x, y), (tx, ty) = edge.point(0.5), edge.tangent(0.5)
    return (x - DEEPER * SHALLOW * ty, y + DEEPER * SHALLOW * tx)
