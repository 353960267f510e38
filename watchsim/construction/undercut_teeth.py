"""What is the outline of pointed teeth with undercut fronts, of which only the tips work, and hollow backs?

In the wheel's own frame, millimetres; tooth 0 has its tip on the x axis and the wheel turns clockwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import along, angle_of, arc_between, fillet_chain, polar, turned
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import TURN, Edge, Line, Point


@dataclass(frozen=True)
class ToothForm:
    """One wheel's teeth: radii of tips and of the gaps' floor, the tip's flat, the back's lean there, fillets."""

    tip: float
    root: float
    land: float
    back: float  # length of the straight back behind the flat
    lean: float  # of that back from the radius, degrees
    hollow: float  # radius behind that
    front_fillet: float


def contour(form: ToothForm, undercut: float, layer: str, teeth: int) -> Loop:
    """All teeth, counter-clockwise; one tooth and the gap behind it, turned as often as there are teeth."""
    tooth = Loop(tuple(tooth_and_gap(form, undercut, 360.0 / teeth)), layer)
    edges = [edge for i in range(teeth) for edge in tooth.moved(i * TURN / teeth, (0.0, 0.0)).edges]
    return Loop(tuple(edges), layer)


def tooth_and_gap(form: ToothForm, undercut: float, pitch: float) -> list[Edge]:
    """From the middle of the gap before the tooth over its tip to the middle of the next gap."""
    tip = (form.tip, 0.0)
    flat = math.degrees(form.land / form.tip)
    heel = polar(form.tip, flat)
    back = along(heel, flat + 180.0 - form.lean, form.back)
    foot = along(tip, 180.0 - undercut, _reach(tip, 180.0 - undercut, form.root))
    hollow, end = hollow_back(back, form.hollow, form.root)
    before = polar(form.root, (angle_of(foot) + angle_of(end) - pitch) / 2.0)
    after = turned(before, pitch)
    chain: list[Edge] = [
        arc_between(before, foot, (0.0, 0.0), True),
        Line(*foot, *tip),
        arc_between(tip, heel, (0.0, 0.0), True),
        Line(*heel, *back),
        hollow,
        arc_between(end, after, (0.0, 0.0), True),
    ]
    return fillet_chain(chain, [form.front_fillet, 0.0, 0.0, 0.0, 0.0])


def hollow_back(back: Point, radius: float, root: float) -> tuple[Edge, Point]:
    """The hollow behind a tooth: an arc through `back` that runs tangentially into the gap's floor, and where it ends."""
    reach, distance = root + radius, math.hypot(*back)
    cosine = (distance**2 + reach**2 - radius**2) / (2.0 * distance * reach)
    if not -1.0 <= cosine <= 1.0:
        raise ValueError("the backs of the teeth do not reach the floor of their gaps")
    bearing = angle_of(back) + math.degrees(math.acos(cosine))
    return arc_between(back, polar(root, bearing), polar(reach, bearing), False), polar(root, bearing)


def _reach(start: Point, direction: float, radius: float) -> float:
    """How far along `direction` the circle about the wheel's centre is first met."""
    ux, uy = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    ahead = start[0] * ux + start[1] * uy
    return -ahead - math.sqrt(ahead**2 + radius**2 - start[0] ** 2 - start[1] ** 2)
