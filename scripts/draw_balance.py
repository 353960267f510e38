"""What is the drawing of the balance whose mass and inertia docs/mass-and-inertia.md adds up?

    python scripts/draw_balance.py [folder]

Writes balance.dxf (default folder: profiles/balance): rim, arms, one screw as half a section in its place, rollers and
pin in plan, and beside them half a section of the staff. The scene itself is written by hand.
"""

from __future__ import annotations

import math
from pathlib import Path

from balance_sizes import (
    ARM_WIDTH,
    BORE,
    CRESCENT_PLACE,
    CRESCENT_RADIUS,
    PIN_PLACE,
    PIN_RADIUS,
    RIM_INNER,
    RIM_OUTER,
    ROLLER_RADIUS,
    SAFETY_RADIUS,
    SCREW_ANGLE,
    SCREW_LENGTH,
    SCREW_RADIUS,
    STAFF,
    STAFF_PLACE,
)

from watchsim.construction.outline import angle_of, arc_between, circle, polar, turned
from watchsim.drawing.sheet import add_circle, add_edge, add_loop, add_polygon, new_sheet, write
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line, Point

LAYERS = ("RIM", "ARMS", "SCREWS", "SCREW_AXIS", "STAFF", "STAFF_AXIS", "ROLLER", "PIN", "SAFETY")
ORIGIN = (0.0, 0.0)


def arms() -> Loop:
    """A bar that ends on the inner circle of the rim."""
    half = 0.5 * ARM_WIDTH
    x = math.sqrt(RIM_INNER**2 - half**2)
    right = arc_between((x, -half), (x, half), ORIGIN, left=True)
    left = arc_between((-x, half), (-x, -half), ORIGIN, left=True)
    return Loop((right, Line(x, half, -x, half), left, Line(-x, -half, x, -half)), "ARMS")


def safety() -> Loop:
    """A disc with a crescent opposite to the impulse pin's side of the staff, towards -y, where the pin is."""
    d, a, r = CRESCENT_PLACE, CRESCENT_RADIUS, SAFETY_RADIUS
    opening = math.degrees(math.acos((d * d + r * r - a * a) / (2 * d * r)))
    centre, first, second = (0.0, -d), polar(r, -90.0 - opening), polar(r, -90.0 + opening)
    rim = Arc(0.0, 0.0, r, math.radians(angle_of(second)), math.radians(360.0 - 2.0 * opening))
    return Loop((rim, arc_between(first, second, centre, left=False)), "SAFETY")


def screw() -> list[Point]:
    """Half of its head, seen from above."""
    outer = RIM_OUTER + SCREW_LENGTH
    corners = ((RIM_OUTER, 0.0), (outer, 0.0), (outer, SCREW_RADIUS), (RIM_OUTER, SCREW_RADIUS))
    return [turned(corner, SCREW_ANGLE) for corner in corners]


def staff() -> list[Point]:
    """Half of its section, the axis upright."""
    x, y = STAFF_PLACE
    corners = [(x, y)]
    for length, lower, upper in STAFF:
        for corner in ((x + lower, y), (x + upper, y + length)):
            if corner != corners[-1]:
                corners.append(corner)
        y += length
    return [*corners, (x, y)]


def draw(folder: Path) -> None:
    """Write the drawing into `folder`."""
    sheet = new_sheet(LAYERS)
    for layer, radius in (("RIM", RIM_OUTER), ("RIM", RIM_INNER), ("ARMS", BORE), ("ROLLER", ROLLER_RADIUS), ("ROLLER", BORE)):
        add_circle(sheet, layer, ORIGIN, radius)
    add_circle(sheet, "SAFETY", ORIGIN, BORE)
    add_loop(sheet, circle("ROLLER", (0.0, -PIN_PLACE), PIN_RADIUS))
    add_loop(sheet, circle("PIN", (0.0, -PIN_PLACE), PIN_RADIUS))
    add_loop(sheet, arms())
    add_loop(sheet, safety())
    add_polygon(sheet, "SCREWS", screw())
    ends = (RIM_OUTER - 0.3, RIM_OUTER + SCREW_LENGTH + 0.3)
    add_edge(sheet, "SCREW_AXIS", Line(*polar(ends[0], SCREW_ANGLE), *polar(ends[1], SCREW_ANGLE)))
    add_polygon(sheet, "STAFF", staff())
    x, y = STAFF_PLACE
    add_edge(sheet, "STAFF_AXIS", Line(x, y - 0.4, x, y + sum(length for length, _, _ in STAFF) + 0.4))
    write(sheet, folder / "balance.dxf")


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "balance"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
