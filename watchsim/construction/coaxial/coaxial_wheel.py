"""What is the outline of a co-axial escape wheel?

Two wheels on one arbor: the large one (TEETH) locks and gives the direct impulse, the small one (SMALL_TEETH) the indirect one.
Eight pointed teeth each, their fronts undercut so that only tips work, their backs hollow. In the wheel's own frame,
millimetres; large tooth 0 has its tip on the x axis and the wheel turns clockwise.
"""

from __future__ import annotations

import math

from watchsim.construction.coaxial.coaxial_points import TEETH, Points
from watchsim.construction.outline import circle
from watchsim.construction.undercut_teeth import ToothForm, contour
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop

ARMS, ARM_WIDTH, WINDOW_FILLET = 4, 0.16, 0.09
RIM_INNER, HUB_RADIUS, BORE_RADIUS = 1.24, 0.42, 0.11


def wheel(points: Points) -> list[Loop]:
    """Both wheels' contours, the windows between the arms and the bore."""
    s = points.scale
    large = ToothForm(points.values.tip_radius, 1.5 * s, 0.02 * s, 0.42 * s, 41.0, 0.62 * s, 0.12 * s)
    small = ToothForm(points.small_radius, 0.68 * points.small_radius, 0.015 * s, 0.15 * s, 42.0, 0.25 * s, 0.05 * s)
    arms = Arms(ARMS, ARM_WIDTH * s, HUB_RADIUS * s, RIM_INNER * s, WINDOW_FILLET * s)
    windows = [Loop(tuple(arms.window(i)), "TEETH", hole=True) for i in range(arms.number)]
    bores = [circle(layer, (0.0, 0.0), BORE_RADIUS * s, hole=True) for layer in ("TEETH", "SMALL_TEETH")]
    undercut = points.values.undercut
    second = contour(small, undercut, "SMALL_TEETH", TEETH).moved(math.radians(points.small_turn), (0.0, 0.0))
    return [contour(large, undercut, "TEETH", TEETH), *windows, bores[0], second, bores[1]]
