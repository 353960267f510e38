"""What is the outline of the Swiss lever's escape wheel?

Club teeth on a rim, four arms with rounded corners, a bore; one piece, so all on the layer TEETH. In the wheel's own
frame, millimetres; tooth 0 has its toe on the x axis and the wheel turns clockwise. The constants are those of a wheel of
2.4 mm and 15 teeth; they grow with the wheel, and what lies between two teeth shrinks where there are more.
"""

from __future__ import annotations

import math

from watchsim.construction.outline import along, angle_of, arc_between, circle, fillet, polar, turned
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point

LAYER = "TEETH"
ROOT_RADIUS = 1.9  # bottom of the gaps
TOE_ROOT, HEEL_ROOT = 0.16, 0.46  # fillets into the gap, before and behind a tooth
CLUB = 0.085  # straight back of the club, from the heel
CLUB_LEAN = 14.0  # of that back, from the radius, towards the toe, degrees
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.66, 0.42, 0.11
ARMS, ARM_WIDTH, WINDOW_FILLET = 4, 0.17, 0.09
DEEP = 1.11  # how far a hollow may lean over the thickness of the tooth
FEW = 15  # teeth, up to which the gaps are as drawn here


def wheel(design: Swiss) -> list[Loop]:
    """The toothed contour, the windows between the arms and the bore."""
    scale = design.wheel_scale
    arms = Arms(ARMS, ARM_WIDTH * scale, HUB_RADIUS * scale, RIM_INNER * scale, WINDOW_FILLET * scale)
    windows = [Loop(tuple(arms.window(i)), LAYER, hole=True) for i in range(arms.number)]
    return [contour(design), *windows, circle(LAYER, (0.0, 0.0), BORE_RADIUS * scale, hole=True)]


def root_radius(design: Swiss) -> float:
    """Bottom of the gaps."""
    return ROOT_RADIUS * design.wheel_scale


def gap_scale(design: Swiss) -> float:
    """Of what lies between two teeth."""
    return design.wheel_scale * min(1.0, FEW / design.teeth)


def contour(design: Swiss) -> Loop:
    """All teeth, counter-clockwise; one tooth and the gap behind it, turned once per tooth."""
    pitch = math.radians(360.0 / design.teeth)
    tooth = Loop(tuple(tooth_and_gap(design)), LAYER)
    edges = [edge for i in range(design.teeth) for edge in tooth.moved(i * pitch, (0.0, 0.0)).edges]
    return Loop(tuple(edges), LAYER)


def tooth_and_gap(design: Swiss) -> list[Edge]:
    """From the foot of the locking face over toe and heel to the foot of the next tooth's locking face."""
    toe, heel, back = toe_heel_back(design)
    lean, neck, sweep_end = behind(design, back)
    foot, toe_root = locking_foot(design)
    next_start = turned(toe_root.start, 360.0 / design.teeth)
    floor = arc_between(sweep_end, next_start, (0.0, 0.0), True)
    return [toe_root, Line(*foot, *toe), Line(*toe, *heel), Line(*heel, *back), *lean, neck, floor]


def toe_heel_back(design: Swiss) -> tuple[Point, Point, Point]:
    """The corners of a tooth's head."""
    heel = polar(design.heel_radius, design.tooth_width)
    back = along(heel, design.tooth_width + 180.0 - CLUB_LEAN, CLUB * gap_scale(design))
    return polar(design.tip_radius, 0.0), heel, back


def behind(design: Swiss, back: Point) -> tuple[list[Edge], Arc, Point]:
    """From the head's back to the floor of the gap: a hollow, and before it a straight piece parallel to the locking face where
    the tooth is so narrow that the hollow would cut through it. Also where it reaches the floor."""
    depth = math.hypot(*back) - root_radius(design)
    inward = math.radians(180.0 - design.undercut)
    thickness = back[1] * -math.cos(inward) - (design.tip_radius - back[0]) * math.sin(inward)
    allowed = DEEP * thickness / math.sin(inward)
    if depth <= allowed:
        return [], *concave_back(design, back, HEEL_ROOT * gap_scale(design))
    start = along(back, 180.0 - design.undercut, (depth - max(allowed, 0.0)) / -math.cos(inward))
    left = math.hypot(*start) - root_radius(design)
    return [Line(*back, *start)], *concave_back(design, start, left)


def locking_foot(design: Swiss) -> tuple[Point, Arc]:
    """Where the locking face ends, and the fillet from the gap's floor into it."""
    toe = polar(design.tip_radius, 0.0)
    face = Line(*along(toe, 180.0 - design.undercut, 2.0 * (design.tip_radius - root_radius(design))), *toe)
    crossing = _on_root(face, root_radius(design))
    floor = arc_between(polar(root_radius(design), angle_of(crossing) - 8.0), crossing, (0.0, 0.0), True)
    _, root, rest = fillet(floor, Line(*crossing, *toe), TOE_ROOT * gap_scale(design))
    return rest.start, root


def concave_back(design: Swiss, back: Point, hollow: float) -> tuple[Arc, Point]:
    """The hollow into the gap's floor: an arc of that radius through `back`, tangent to the floor from outside; and its end."""
    root = root_radius(design)
    reach, distance = root + hollow, math.hypot(*back)
    cosine = (distance**2 + reach**2 - hollow**2) / (2.0 * distance * reach)
    bearing = angle_of(back) + math.degrees(math.acos(cosine))
    end = polar(root, bearing)
    return arc_between(back, end, polar(reach, bearing), False), end


def _on_root(face: Line, root: float) -> Point:
    """Where the line meets the floor circle, on the way in from the toe."""
    low, high = 0.0, 1.0  # fraction from the far end to the toe; the toe is outside
    for _ in range(200):
        middle = (low + high) / 2.0
        low, high = (middle, high) if math.hypot(*face.point(middle)) < root else (low, middle)
    return face.point(high)


def tooth_gap(design: Swiss) -> float:
    """Degrees of floor between two teeth, negative where the hollow behind one runs into the foot of the next."""
    _, _, sweep_end = behind(design, toe_heel_back(design)[2])
    _, toe_root = locking_foot(design)
    ahead = angle_of(turned(toe_root.start, 360.0 / design.teeth)) - angle_of(sweep_end)
    return (ahead + 180.0) % 360.0 - 180.0
