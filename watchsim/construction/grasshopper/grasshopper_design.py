"""What makes the grasshopper escapement a design?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict, Design
from watchsim.construction.grasshopper.grasshopper_dimensions import Grasshopper
from watchsim.construction.grasshopper.grasshopper_outlines import pallet, pendulum, wheel
from watchsim.construction.grasshopper.grasshopper_points import ENTRY, EXIT, Points, points
from watchsim.construction.grasshopper.grasshopper_scene import scene_text
from watchsim.drawing.sheet import Sheet

NARROWEST, WIDEST = 50.0, 130.0  # degrees between the pallets, seen from the wheel
HIGHEST = 0.8  # of a pitch: height of a tooth
LEAST = 1.3  # of the lift of a pallet that has been let go, by its nib
WEAKEST, STRONGEST = 1.02, 1.12  # amplitude that the drive sustains, by release and by release with overswing


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
    for side in (ENTRY, EXIT):
        lifted = at.length * math.radians(abs(at.lean(-side * at.values.release, side) - at.stopped(side)))
        if lifted < LEAST * at.values.nib:
            yield Conflict("nib", f"must be below {lifted / LEAST:.4g} mm, else a pallet let go stays among the teeth")
            return


DESIGN = Design("grasshopper", "Grasshopper escapement with its pendulum", Grasshopper, draw, scene, conflicts)
