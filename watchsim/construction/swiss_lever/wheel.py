"""What is the outline of the Swiss lever's escape wheel?

Fifteen club teeth on a rim, four arms with rounded corners, a bore; one piece, so all on the layer TEETH. In the
wheel's own frame, millimetres; tooth 0 has its toe on the x axis and the wheel turns clockwise.
"""

from __future__ import annotations

import math

from watchsim.construction.outline import along, angle_of, arc_between, circle, fillet, fillet_chain, polar, turned
from watchsim.construction.swiss_lever.points import Swiss

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

LAYER = "TEETH"
ROOT_RADIUS = 1.9  # bottom of the gaps
TOE_ROOT, HEEL_ROOT = 0.16, 0.46  # fillets into the gap, before and behind a tooth
CLUB = 0.085  # straight back of the club, from the heel
CLUB_LEAN = 14.0  # of that back, from the radius, towards the toe, degrees
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.66, 0.42, 0.11
ARMS, ARM_WIDTH, WINDOW_FILLET = 4, 0.17, 0.09


def wheel(design: Swiss) -> list[Loop]:
    """The toothed contour, the windows between the arms and the bore."""
    windows = [Loop(tuple(window(i)), LAYER, hole=True) for i in range(ARMS)]
    return [contour(design), *windows, circle(LAYER, (0.0, 0.0), BORE_RADIUS, hole=True)]


def contour(design: Swiss) -> Loop:
    """All teeth, counter-clockwise; one tooth and the gap behind it, turned fifteen times."""
    pitch = math.radians(360.0 / design.teeth)
    tooth = Loop(tuple(tooth_and_gap(design)), LAYER)
    edges = [edge for i in range(design.teeth) for edge in tooth.moved(i * pitch, (0.0, 0.0)).edges]
    return Loop(tuple(edges), LAYER)


def tooth_and_gap(design: Swiss) -> list[Edge]:
    """From the foot of the locking face over toe and heel to the foot of the next tooth's locking face."""
    toe = polar(design.tip_radius, 0.0)
    heel = polar(design.heel_radius, design.tooth_width)
    back = along(heel, design.tooth_width + 180.0 - CLUB_LEAN, CLUB)
    neck, sweep_end = concave_back(back)
    foot, toe_root = locking_foot(design)
    next_start = turned(toe_root.start, 360.0 / design.teeth)
    floor = arc_between(sweep_end, next_start, (0.0, 0.0), True)
    return [
        toe_root,
        Line(*foot, *toe),
        Line(*toe, *heel),
        Line(*heel, *back),
        neck,
        floor,
    ]


def locking_foot(design: Swiss) -> tuple[Point, Arc]:
    """Where the locking face ends, and the fillet from the gap's floor into it."""
    toe = polar(design.tip_radius, 0.0)
    face = Line(*along(toe, 180.0 - design.undercut, 2.0 * (design.tip_radius - ROOT_RADIUS)), *toe)
    crossing = _on_root(face)
    floor = arc_between(polar(ROOT_RADIUS, angle_of(crossing) - 8.0), crossing, (0.0, 0.0), True)
    _, root, rest = fillet(floor, Line(*crossing, *toe), TOE_ROOT)
    return rest.start, root


def concave_back(back: Point) -> tuple[Arc, Point]:
    """The hollow from the club's back into the gap's floor: an arc through `back`, tangent to the floor from outside."""
    reach, distance = ROOT_RADIUS + HEEL_ROOT, math.hypot(*back)
    cosine = (distance**2 + reach**2 - HEEL_ROOT**2) / (2.0 * distance * reach)
    bearing = angle_of(back) + math.degrees(math.acos(cosine))
    end = polar(ROOT_RADIUS, bearing)
    return arc_between(back, end, polar(reach, bearing), False), end


def window(i: int) -> list[Edge]:
    """One opening between two arms, clockwise."""
    first, last = _arm_sides(i)
    chain: list[Edge] = [
        arc_between(last[1], first[1], (0.0, 0.0), False),
        Line(*first[1], *first[0]),
        arc_between(first[0], last[0], (0.0, 0.0), True),
        Line(*last[0], *last[1]),
    ]
    return fillet_chain(chain, [WINDOW_FILLET] * 4, closed=True)


def _arm_sides(i: int) -> tuple[tuple[Point, Point], tuple[Point, Point]]:
    """Hub and rim ends of the arm edges that bound window i."""
    pitch, half = 360.0 / ARMS, ARM_WIDTH / 2.0
    sides = []
    for number, side in ((i, 1.0), (i + 1, -1.0)):
        ends = [turned((math.sqrt(r * r - half * half), side * half), number * pitch) for r in (HUB_RADIUS, RIM_INNER)]
        sides.append((ends[0], ends[1]))
    return sides[0], sides[1]


def _on_root(face: Line) -> Point:
    """Where the line meets the floor circle, on the way in from the toe."""
    low, high = 0.0, 1.0  # fraction from the far end to the toe; the toe is outside
    for _ in range(200):
        middle = (low + high) / 2.0
        low, high = (middle, high) if math.hypot(*face.point(middle)) < ROOT_RADIUS else (low, middle)
    return face.point(high)
