"""How is the lift shared between stone and tooth?"""

from __future__ import annotations

import math

from watchsim.construction.swiss_lever.swiss_lever_points import Swiss


def lift_on_tooth(design: Swiss, side: int) -> float:
    """Lever angle (degrees) from where the stone's discharge corner crosses the circle of the toes to let-off.

    The corner is rho from the lever's pivot, which is C from the wheel's centre: its distance from that one gives the angle
    between the two directions at the pivot. ValueError where the corner never crosses.
    """
    corner = design.discharge_corner(side)
    away, rho = design.lever_pivot[1], math.hypot(*corner)

    def at(distance: float) -> float:
        return math.degrees(math.acos((away**2 + rho**2 - distance**2) / (2.0 * away * rho)))

    return at(design.heel_radius) - at(design.tip_radius)
