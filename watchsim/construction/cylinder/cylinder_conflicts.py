"""Which dimensions of a cylinder escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.cylinder.cylinder_dimensions import Cylinder
from watchsim.construction.cylinder.cylinder_outlines import tooth
from watchsim.construction.cylinder.cylinder_points import Shell, shell
from watchsim.construction.design import Conflict

LEAST_WALL = 0.04  # of the outer radius
PARTS = 20  # of an edge
SLIDES = 5.0  # degrees by which an impulse face must be steeper than the angle of friction
SPARE = 5.0  # degrees of swing


def conflicts(values: Cylinder) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    half = 180.0 / values.teeth
    if values.tooth_width + values.drop >= half:
        most = half - values.drop
        yield Conflict("tooth_width", f"must be less than {most:.4g}°: half a pitch is tooth, wall and drop")
        return
    made = shell(values)
    wall = 1.0 - made.inner / made.outer
    if wall < LEAST_WALL:
        words = f"with this drop leaves a wall of {1e3 * (made.outer - made.inner):.3g} µm, {100.0 * wall:.2g} % of the radius"
        yield Conflict("tooth_width", f"{words}; {100.0 * LEAST_WALL:g} % are needed")
    slope = math.degrees(math.atan2(2.0 * made.rise, made.distance * math.radians(values.tooth_width)))
    least = math.degrees(math.atan(values.friction)) + SLIDES
    if slope < least:
        words = f"gives impulse faces of {slope:.3g}°; with a friction of {values.friction:g} they must have {least:.3g}°"
        yield Conflict("lift", words)
    if values.start <= made.let_off:
        yield Conflict("start", f"must be more than {made.let_off:.4g}°, else no tooth is let off")
    if values.start > made.most - SPARE:
        words = f"must be less than {made.most - SPARE:.4g}°"
        yield Conflict("start", f"{words}: farther out the other end of the shell comes round to the tooth")
    yield from _drive(values, made)
    yield from _belly(made)


def _drive(values: Cylinder, made: Shell) -> Iterator[Conflict]:
    """The swing A that the drive would keep up if only damping and friction at rest took work: w = π k A² / 2 Q + 2 f A."""
    stiffness = values.balance_inertia * 1e-10 * (math.pi * values.frequency / 3600.0) ** 2
    damping = 0.5 * math.pi * stiffness / values.q_factor
    work = values.torque * 1e-6 * math.radians(values.tooth_width)
    rubbing = values.friction * values.torque * 1e-6 * made.outer / made.distance
    swing = math.degrees((math.sqrt(rubbing**2 + damping * work) - rubbing) / damping)
    if swing > made.most:
        words = f"the balance would swing by up to {swing:.4g}°, and at {made.most:.4g}° the other end of the shell comes round"
        yield Conflict("torque", f"{words}: less torque, or a heavier balance")
    if swing < made.let_off:
        yield Conflict("torque", f"the balance would swing by {swing:.4g}° at most, and let off no tooth: more torque")


def _belly(made: Shell) -> Iterator[Conflict]:
    """Nothing of a tooth that rests inside may stand out of the inner circle."""
    turn = math.radians(made.rests_inside + made.values.tooth_width / 2.0)
    edges = tooth(made).moved(turn, (0.0, 0.0)).edges
    farthest = max(math.dist(edge.point(i / PARTS), made.balance) for edge in edges for i in range(PARTS + 1))
    if farthest > made.inner * (1.0 + 1e-9):
        yield Conflict("tooth_width", "a tooth that rests inside would be cut by the shell: less lift, or more drop")
