"""Which sizes has the balance of profiles/balance, and what does it weigh by the formulas of a handbook?

Millimetres; nothing here knows the package. The drawing (draw_balance.py) and the table in docs/guide/mass-and-inertia.md
(tabulate_inertia.py) are made from it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

GLUCYDUR, STEEL, GOLD, RUBY, NIVAROX = 8.25, 7.85, 15.5, 3.98, 8.1  # g/cm³ = mg/mm³

RIM_OUTER, RIM_INNER, RIM_HEIGHT = 4.80, 4.25, 0.55
ARM_WIDTH, ARM_HEIGHT = 0.70, 0.20
BORE = 0.30  # radius of the staff where arms and rollers sit
SCREWS, SCREW_ANGLE, SCREW_RADIUS, SCREW_LENGTH = 8, 22.5, 0.25, 0.40  # heads, on the rim, pointing outward
ROLLER_RADIUS, ROLLER_HEIGHT = 1.15, 0.20
PIN_RADIUS, PIN_PLACE, PIN_HEIGHT = 0.14, 0.90, 0.55
SAFETY_RADIUS, SAFETY_HEIGHT = 0.62, 0.25
CRESCENT_RADIUS, CRESCENT_PLACE = 0.20, 0.66
SPRING_INNER, SPRING_OUTER, SPRING_TURNS, SPRING_WIDTH, SPRING_HEIGHT = 0.60, 2.60, 13, 0.030, 0.110
STAFF = (  # length, radius at its lower and upper end: cylinders and cones from the lower pivot up
    *((0.30, 0.045, 0.045), (0.35, 0.045, 0.30), (1.20, 0.30, 0.30), (0.25, 0.70, 0.70)),
    *((1.00, 0.30, 0.30), (0.35, 0.30, 0.045), (0.30, 0.045, 0.045)),
)
STAFF_PLACE = (8.0, -2.0)  # where its section is drawn, beside the plan


class Hand(NamedTuple):
    """Mass in mg, inertia about the staff in mg·mm², the formula, and whether it is exact for the part as drawn."""

    mass: float
    inertia: float
    formula: str
    exact: bool = True


def by_hand() -> dict[str, Hand]:
    """Layer -> what a handbook says."""
    return {
        "RIM": _ring(RIM_OUTER, RIM_INNER, RIM_HEIGHT * GLUCYDUR, "ring: m (R² + r²) / 2"),
        "ARMS": _arms(),
        "SCREWS": _screws(),
        "STAFF": _staff(),
        "ROLLER": _roller(),
        "PIN": _pin(),
        "SAFETY": _safety(),
        "HAIRSPRING": _hairspring(),
    }


def _ring(outer: float, inner: float, surface: float, formula: str) -> Hand:
    mass = surface * math.pi * (outer**2 - inner**2)
    return Hand(mass, 0.5 * mass * (outer**2 + inner**2), formula)


def _arms() -> Hand:
    surface, length = ARM_HEIGHT * GLUCYDUR, 2.0 * RIM_INNER
    bar, bore = surface * length * ARM_WIDTH, surface * math.pi * BORE**2
    inertia = bar * (length**2 + ARM_WIDTH**2) / 12.0 - bore * BORE**2 / 2.0
    return Hand(bar - bore, inertia, "bar less bore: m (L² + b²) / 12 − m r² / 2; its ends taken as straight", exact=False)


def _screws() -> Hand:
    mass = GOLD * math.pi * SCREW_RADIUS**2 * SCREW_LENGTH
    place = RIM_OUTER + SCREW_LENGTH / 2.0
    own = mass * (3.0 * SCREW_RADIUS**2 + SCREW_LENGTH**2) / 12.0
    return Hand(SCREWS * mass, SCREWS * (own + mass * place**2), "8 cylinders on their side: 8 [m (3 r² + l²) / 12 + m d²]")


def _staff() -> Hand:
    mass = inertia = 0.0
    for length, a, b in STAFF:
        mass += STEEL * math.pi * length * (a * a + a * b + b * b) / 3.0
        inertia += STEEL * math.pi * length * (a**4 + a**3 * b + a * a * b * b + a * b**3 + b**4) / 10.0
    return Hand(mass, inertia, "cylinders and cones: Σ π ρ l (a⁴ + a³b + a²b² + ab³ + b⁴) / 10")


def _roller() -> Hand:
    surface = ROLLER_HEIGHT * STEEL
    ring, hole = _ring(ROLLER_RADIUS, BORE, surface, ""), surface * math.pi * PIN_RADIUS**2
    inertia = ring.inertia - hole * (PIN_RADIUS**2 / 2.0 + PIN_PLACE**2)
    return Hand(ring.mass - hole, inertia, "ring less the pin's hole: m (R² + r²) / 2 − m (p² / 2 + d²)")


def _pin() -> Hand:
    mass = PIN_HEIGHT * RUBY * math.pi * PIN_RADIUS**2
    return Hand(mass, mass * (PIN_RADIUS**2 / 2.0 + PIN_PLACE**2), "disc beside the axis: m (p² / 2 + d²)")


def _safety() -> Hand:
    """The crescent is the lens common to two circles; its mass is taken to sit half-way across."""
    surface, a, d, r = SAFETY_HEIGHT * STEEL, CRESCENT_RADIUS, CRESCENT_PLACE, SAFETY_RADIUS
    ring = _ring(r, BORE, surface, "")
    first, second = math.acos((d * d + a * a - r * r) / (2 * d * a)), math.acos((d * d + r * r - a * a) / (2 * d * r))
    lens = surface * (a * a * first + r * r * second - d * r * math.sin(second))
    inertia = ring.inertia - lens * (0.5 * (d - a + r)) ** 2
    return Hand(
        ring.mass - lens, inertia, "ring less crescent: m (R² + r²) / 2 − m d²; the crescent taken as a point", exact=False
    )


def _hairspring() -> Hand:
    length = math.pi * SPRING_TURNS * (SPRING_INNER + SPRING_OUTER)
    mass = NIVAROX * SPRING_WIDTH * SPRING_HEIGHT * length / 3.0
    inertia = 0.5 * mass * (SPRING_INNER**2 + SPRING_OUTER**2)
    return Hand(mass, inertia, "one third of m (R² + r²) / 2, m = ρ b h L, L = π n (R + r)", exact=False)
