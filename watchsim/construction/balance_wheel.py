"""What does a balance of a given inertia look like: its rim with arms, and its hairspring?

Drawn only; nothing of it touches anything. The rim is as large as one of Glucydur with a square section in the usual
proportion, so that a heavier balance looks heavier. Millimetres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from watchsim.construction.outline import circle
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop

GLUCYDUR = 8.25  # mg/mm³
SECTION = 0.12  # of the radius: width and height of the rim
RADIUS_OF_GYRATION = 1.0 - 0.5 * SECTION
ARM, HUB, FILLET = 0.085, 0.13, 0.035  # of the radius: width of an arm, radius of the hub, corners of the openings
CLEAR_OF_ROLLER = 1.8  # times the reach of roller and stones, at least
INNER, OUTER = 0.12, 0.62  # of the rim's radius: the hairspring's collet and stud
TURNS, THICKNESS = 13.0, 0.03
PLACES = 3  # decimals of a millimetre that a scene needs


@dataclass(frozen=True)
class BalanceWheel:
    """A rim with straight arms, the first along the x axis, and the hairspring within."""

    radius: float
    arms: int
    staff: float  # radius of its hole

    def rim(self) -> list[Loop]:
        """The outlines on the layer RIM: outer edge, staff's hole, openings between the arms."""
        r = self.radius
        spokes = Arms(self.arms, ARM * r, max(HUB * r, 2.0 * self.staff), (1.0 - SECTION) * r, FILLET * r)
        return [
            circle("RIM", (0.0, 0.0), r),
            circle("RIM", (0.0, 0.0), self.staff, hole=True),
            *(Loop(tuple(spokes.window(i)), "RIM", hole=True) for i in range(self.arms)),
        ]

    def hairspring(self, stud: float) -> str:
        """What a scene says of the hairspring, its stud in that direction (degrees)."""
        inner, outer = (round(share * self.radius, PLACES) for share in (INNER, OUTER))
        return f'{{ inner = "{inner:g} mm", outer = "{outer:g} mm", turns = {TURNS:g}, stud = "{stud:g}°" }}'


def balance_wheel(inertia: float, reach: float, staff: float, arms: int) -> BalanceWheel:
    """That of a balance of `inertia` (mg·cm²) whose roller reaches so far and whose staff has that radius (mm)."""
    # I = 2 pi rho (section R)² (gyration R)³, with R the outer radius and 100 mg·mm² to the mg·cm²
    fifth = 100.0 * inertia / (math.tau * GLUCYDUR * SECTION**2 * RADIUS_OF_GYRATION**3)
    return BalanceWheel(max(fifth**0.2, CLEAR_OF_ROLLER * reach), arms, staff)
