"""What makes the grasshopper escapement a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.grasshopper.grasshopper_dimensions import Grasshopper
from watchsim.construction.grasshopper.grasshopper_outlines import arm_clearance, pallet, pendulum, wheel
from watchsim.construction.grasshopper.grasshopper_points import ENTRY, EXIT, Points, points
from watchsim.construction.grasshopper.grasshopper_scene import scene_text
from watchsim.drawing.sheet import Sheet

NARROWEST, WIDEST = 50.0, 130.0  # degrees between the pallets, seen from the wheel
HIGHEST = 0.8  # of a pitch: height of a tooth
LEAST = 1.3  # of the lift of a pallet that has been let go, by its nib
CATCHES = 1.05  # of the nib, by what it is short of the circle of the points where it takes over
HOLDS = 0.3  # of the friction of a nib, which the counterweight may take
QUICK = 0.06  # of a period, in which a pallet let go is lifted by its nib
DEEPEST, CLEAR = 0.6, 0.8  # of a tooth's height, by the nib; of an arm's distance from its nib's line, by the teeth
WEAKEST, STRONGEST = 1.06, 1.12  # amplitude that the drive sustains, by release and by release with overswing


def draw(values: Grasshopper) -> dict[str, Sheet]:
    """Wheel, pendulum with frame, the two pallets."""
    at = points(values)
    sheets = {"wheel": wheel(at), "pendulum": pendulum(at), "entry": pallet(at, ENTRY), "exit": pallet(at, EXIT)}
    return {name: Sheet(tuple(loops)) for name, loops in sheets.items()}


def scene(values: Grasshopper) -> str:
    """Its scene."""
    return scene_text(points(values))


def amplitude(values: Grasshopper) -> float:
    """Degrees, at which damping takes what the wheel gives in an oscillation: T pitch = π k A² / Q."""
    stiffness = values.bob_mass * values.gravity * values.pendulum  # mN·m per rad
    return math.degrees(math.sqrt(values.torque * math.tau / values.teeth * values.q_factor / (math.pi * stiffness)))


def cuts_in(at: Points, side: int) -> float:
    """mm by which the line of a pallet's nib comes inside the circle of the points, at most, while it holds a tooth."""
    ends = (swing for swing in (-at.furthest, at.furthest))
    tilts = (at.lean(swing, side) + swing - at.tooth(swing, side) - side * 90.0 for swing in ends)
    return at.values.tip_radius * (1.0 - min(math.cos(math.radians(tilt)) for tilt in tilts))


def conflicts(values: Grasshopper) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    pitch = 360.0 / values.teeth
    between, unit = (values.span + 0.5) * pitch, math.radians(pitch) * values.tip_radius
    if not NARROWEST <= between <= WIDEST:
        yield Conflict("span", f"puts the pallets {between:.4g}° apart; {NARROWEST:g}° to {WIDEST:g}° work")
        return
    if values.height > HIGHEST * unit:
        yield Conflict("height", f"must be at most {HIGHEST * unit:.4g} mm at this pitch")
    try:
        at = points(values)
    except ValueError as error:
        yield Conflict("release", str(error))
        return
    yield from _pallets(at)
    sustained, least, most = amplitude(values), WEAKEST * values.release, STRONGEST * at.furthest
    if not least < sustained < most:
        torques = [values.torque * (end / sustained) ** 2 for end in (least, most)]
        yield Conflict("torque", f"would sustain {sustained:.3g}°; between {torques[0]:.4g} and {torques[1]:.4g} mN·m it works")


def _pallets(at: Points) -> Iterator[Conflict]:
    """What keeps a nib from holding its tooth, or from clearing it."""
    if at.values.nib > DEEPEST * at.values.height:
        yield Conflict("nib", f"must be at most {DEEPEST * at.values.height:.4g} mm, else it meets the floor between the teeth")
        return
    for side in (ENTRY, EXIT):
        if cuts_in(at, side) > CLEAR * arm_clearance(at):
            yield Conflict("span", "lets the arm of a pallet cut into the teeth as it swings: nearer to 90°, or less release")
            return
        lifted = at.length * math.radians(side * (at.lean(-side * at.values.release, side) - at.stopped(side)))
        if lifted <= 0.0:
            yield Conflict("span", "its pallets, let go, would swing into the teeth: nearer to 90°, or less release")
            return
        if lifted < LEAST * at.values.nib:
            yield Conflict("nib", f"must be below {lifted / LEAST:.4g} mm, else a pallet let go stays among the teeth")
            return
        short = at.length * math.radians(side * (at.lean(side * at.values.release, side) - at.stopped(side)))
        if at.values.nib < CATCHES * short:
            yield Conflict("nib", f"must be above {CATCHES * short:.4g} mm, else it passes over its tooth: or less overswing")
            return
    yield from _counterweights(at)


def _counterweights(at: Points) -> Iterator[Conflict]:
    """Too weak to lift a pallet before the pendulum comes back, or so strong that friction does not hold it on its tooth."""
    values = at.values
    period = math.tau * math.sqrt(1e-3 * values.pendulum / values.gravity)
    needed = 2e-3 * values.nib / at.length * values.pallet_inertia / (QUICK * period) ** 2
    if values.pallet_torque < needed:
        yield Conflict("pallet_torque", f"must be above {needed:.3g} µN·m, else the pallets are slow to clear the teeth")
    most = 1e3 * HOLDS * values.friction * values.torque * at.length / values.tip_radius
    if values.pallet_torque > most:
        yield Conflict("pallet_torque", f"must be below {most:.3g} µN·m, else it pulls the pallets off their teeth")


DESIGN = Design("grasshopper", "Grasshopper escapement with its pendulum", Grasshopper, draw, scene, conflicts)
