"""Governor fly of a striking train: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import circle, polygon
from watchsim.drawing.write import Sheet


@dataclass(frozen=True)
class Governor:
    torque: float = dim(60.0, "mN·m", 1e-3, 1e5, "of the weight on its drum", CHOSEN)
    ratio: float = dim(600.0, "", 1.0, 1e5, "turns of the fly by those of the drum", "three arbors of 8 to 9 each")
    drum_radius: float = dim(20.0, "mm", 1.0, 500.0, "of the drum", CHOSEN)
    drum_inertia: float = dim(2.0, "kg·cm²", 1e-6, 1e6, "drum with the weight that hangs on it", CHOSEN)
    reach: float = dim(30.0, "mm", 1.0, 500.0, "of the fly's two vanes, from its axis", CHOSEN)
    root: float = dim(6.0, "mm", 0.0, 400.0, "from the axis to where the vanes begin", CHOSEN)
    height: float = dim(35.0, "mm", 1.0, 1000.0, "of the vanes along the axis", CHOSEN)
    thickness: float = dim(1.0, "mm", 0.05, 20.0, "of the vanes", CHOSEN)
    fly_inertia: float = dim(15.0, "g·cm²", 1e-4, 1e7, "fly with its arbor", CHOSEN)
    drag_coefficient: float = dim(
        1.2, "", 0.5, 2.5, "of a vane across the air", "plates across a stream: 1.1 to 2 (Hoerner 1965)"
    )
    air: float = dim(1.2, "kg/m³", 0.1, 5.0, "density", "at 20 °C and sea level")


WORDS = """\
The governor of a striking train: a weight on a drum drives a fly through gears, and the air on its vanes takes what that
gives. From rest it comes up to the speed at which both are equal, {terminal} rad/s of the fly. Drawn to these dimensions:"""

SETTLED = 6.0  # times the time constant of tanh: within 10⁻⁵ of the terminal speed


def drag(values: Governor) -> float:
    """Torque of the air by the fly's speed squared, N·m·s²/rad²: ½ ρ C h r² on each strip of both vanes, at the arm r."""
    reach, root, height = (1e-3 * length for length in (values.reach, values.root, values.height))
    return 0.25 * values.air * values.drag_coefficient * height * (reach**4 - root**4)


def terminal_speed(values: Governor) -> float:
    """Of the fly, rad/s."""
    return math.sqrt(1e-3 * values.torque / (values.ratio * drag(values)))


def time_constant(values: Governor) -> float:
    """T of ω tanh(t/T), s: inertia felt at the drum by torque, times the drum's terminal speed."""
    felt = 1e-4 * values.drum_inertia + values.ratio**2 * 1e-7 * values.fly_inertia
    return felt * terminal_speed(values) / values.ratio / (1e-3 * values.torque)


def scene_text(values: Governor) -> str:
    """The text of scene.toml: all at rest."""
    apart, air = 1.1 * (values.drum_radius + values.reach), f"{1e9 * drag(values):.15g} nN·m·s²/rad²"
    return toml.scene(
        toml.head(values, WORDS.format(terminal=f"{terminal_speed(values):.4g}"), "Governor fly of a striking train"),
        toml.body(
            "drum", "drum", "DRUM", pivot=toml.ORIGIN, position=toml.ORIGIN, inertia=f"{values.drum_inertia:.15g} kg·cm²"
        ),
        toml.body(
            *("fly", "fly", "VANES"),
            draw="COLLAR",
            pivot=toml.ORIGIN,
            position=(f"{apart:.15g} mm", "0 mm"),
            inertia=f"{values.fly_inertia:.15g} g·cm²",
        ),
        toml.table("[[gears]]", "through the arbors between them", between=("drum", "fly"), ratio=values.ratio),
        toml.torque("drum", f"{values.torque:.15g} mN·m"),
        toml.table("[[damping]]", "vanes in air: torque c w²", body="fly", quadratic=air),
        toml.table("[run]", duration=f"{SETTLED * time_constant(values):.2g} s"),
    )


def draw(values: Governor) -> dict[str, Sheet]:
    """Drum and fly: two vanes on a collar, seen along the axis."""
    far, half = values.reach, 0.5 * values.thickness
    vanes = polygon("VANES", [(-far, -half), (far, -half), (far, half), (-far, half)])
    collar = max(0.1 * values.reach, values.thickness)
    drum = circle("DRUM", (0.0, 0.0), values.drum_radius)
    return sheets_of(drum=[drum], fly=[vanes, circle("COLLAR", (0.0, 0.0), collar)])


def conflicts(values: Governor) -> Iterator[Conflict]:
    if values.root >= 0.9 * values.reach:
        yield Conflict("root", f"must be below {0.9 * values.reach:.4g} mm, else no vane is left")
    if values.thickness > 0.2 * values.reach:
        yield Conflict("thickness", f"must be at most {0.2 * values.reach:.4g} mm")


DESIGN = Design("governor", "Governor fly of a striking train", Governor, draw, scene_text, conflicts)
