"""What are the outlines of a duplex escapement's wheel and balance?

RESTING teeth and ROLLER touch in one plane, upright IMPULSE teeth and the PALLET in another; the RIM of the balance is drawn
only. Millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.balance_wheel import BalanceWheel, balance_wheel
from watchsim.construction.duplex.duplex_points import DuplexPoints
from watchsim.construction.outline import along, arc_between, circle, fillet_chain, polar, turned
from watchsim.construction.pallet_stone import Stone
from watchsim.construction.undercut_teeth import ToothForm, contour, tooth_and_gap
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line

REFERENCE = 6.0  # mm: radius of the wheel whose lesser lengths others scale
ROOT, RIM, ARM, HUB, BORE = 3.6, 3.1, 0.35, 0.9, 0.3
STRAIGHT, TAPER, HOLLOW = 1.8, 9.0, 0.8  # of a resting tooth: length of its straight back, angle at its point, hollow behind
ARMS, BALANCE_ARMS = 4, 3
UPRIGHT, BACK = 0.62, 24.0  # of an impulse tooth: height of its section, lean of its back from the radius (degrees)
WIDTH, RELIEF, EDGE = 0.45, 25.0, 0.05  # of the pallet
DEPTH, CLEAR = 0.5, 2.0  # of the notch: of the roller's radius; of what the points come in


def wheel(points: DuplexPoints) -> list[Loop]:
    """Resting teeth on the rim, arms, impulse teeth; at angle 0 the point of a resting tooth is on the x axis."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    form = resting_form(points)
    arms = Arms(ARMS, ARM * s, HUB * s, RIM * s, 0.25 * s)
    upright = impulse_tooth(points)
    return [
        contour(form, values.undercut, "RESTING", values.teeth),
        *(Loop(tuple(arms.window(i)), "RESTING", hole=True) for i in range(ARMS)),
        circle("RESTING", (0.0, 0.0), BORE * s, hole=True),
        *(
            upright.moved(math.radians(points.waiting - points.rests + i * points.pitch), (0.0, 0.0))
            for i in range(values.teeth)
        ),
    ]


def resting_form(points: DuplexPoints) -> ToothForm:
    """Of the long teeth: their backs are straight for most of the way."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    return ToothForm(values.tip_radius, ROOT * s, 0.03 * s, STRAIGHT * s, values.undercut + TAPER, HOLLOW * s, 0.3 * s)


def floor_between(points: DuplexPoints) -> float:
    """Degrees of the rim between two resting teeth, at the wheel's centre."""
    chain = tooth_and_gap(resting_form(points), points.values.undercut, points.pitch)
    first, last = chain[0], chain[-1]
    return math.degrees(abs(first.sweep) + abs(last.sweep)) if isinstance(first, Arc) and isinstance(last, Arc) else 0.0


def impulse_tooth(points: DuplexPoints) -> Loop:
    """The section of an upright tooth, a wedge with its point on the x axis."""
    s = points.values.tip_radius / REFERENCE
    tip, height = (points.impulse_radius, 0.0), UPRIGHT * s
    front = along(tip, 180.0 - points.values.undercut, height / math.cos(math.radians(points.values.undercut)))
    back = along(polar(points.impulse_radius, 0.5), 180.0 - points.values.undercut - BACK, 1.15 * height)
    corners = [front, tip, polar(points.impulse_radius, 0.5), back]
    edges: list[Edge] = [Line(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
    return Loop(tuple(fillet_chain(edges, [0.0, 0.0, 0.1 * height, 0.1 * height], closed=True)), "IMPULSE")


def balance(points: DuplexPoints) -> list[Loop]:
    """Roller with its notch, pallet, rim; the balance at rest."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    bearing = -90.0 + points.pallet_let_go - values.letting_go
    width = WIDTH * s
    pallet = Stone(polar(points.pallet, bearing), bearing + 180.0, width, points.pallet, width * math.tan(math.radians(RELIEF)))
    return [roller(points), pallet.loop("PALLET", EDGE * s), *wheel_of(points).rim()]


def roller(points: DuplexPoints) -> Loop:
    """A disc with a notch; its leading wall is where the tooth is let go as the balance stands at `letting_go`."""
    values, r = points.values, points.roller
    lead = -90.0 + values.intersection - values.letting_go
    trail = lead - values.notch
    floor = r - max(CLEAR * points.inside, DEPTH * r * math.sin(math.radians(values.notch)))
    # Walls are parallel to the notch's middle line, or the point would jam in a narrowing notch.
    middle, half = (lead + trail) / 2.0, r * math.sin(math.radians(values.notch / 2.0))
    foot, root = turned((floor, half), middle), turned((floor, -half), middle)
    edges: list[Edge] = [
        arc_between(polar(r, lead), polar(r, trail), (0.0, 0.0), True),
        Line(*polar(r, trail), *root),
        Line(*root, *foot),
        Line(*foot, *polar(r, lead)),
    ]
    return Loop(tuple(edges), "ROLLER")


def wheel_of(points: DuplexPoints) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    return balance_wheel(points.values.balance_inertia, points.pallet, 0.45 * points.roller, BALANCE_ARMS)
