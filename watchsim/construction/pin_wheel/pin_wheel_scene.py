"""What does the scene of a pin-wheel escapement say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.pin_wheel.pin_wheel_dimensions import PinWheel
from watchsim.construction.pin_wheel.pin_wheel_points import PinAnchor

CLEAR = 1e-5  # degrees by which the pin stands off the pallet at the start
IRON = 7200.0  # kg/m³
ROD_DENSITY, ROD_THICKNESS = 7850.0, 4.0  # steel; mm

TEXT = """\
# A pin-wheel escapement with its pendulum, drawn to these dimensions:
{dimensions}

[scene]
title   = "Pin-wheel escapement, {values.pins} pins"
schema  = 1
gravity = ["0 m/s²", "{gravity!r} m/s²"]

[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["PINS"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a pin just off the resting face of the lower pallet
inertia  = "{values.wheel_inertia:.15g} g·mm²"

[bodies.pendulum]                    # with the anchor; let go on the right
drawing  = "pendulum.dxf"
layers   = ["PALLETS"]
pivot    = "PIVOT"
position = ["{pivot[0]!r} mm", "{pivot[1]!r} mm"]
angle    = "{values.start!r}°"

[[bodies.pendulum.solids]]
layer     = "BOB"
thickness = "{thickness!r} mm"       # makes its mass {values.bob_mass:.6g} kg
density   = "{iron:g} kg/m³"

[[bodies.pendulum.solids]]
layer     = "ROD"
thickness = "{rod_thickness:g} mm"
density   = "{rod_density:g} kg/m³"

[[torques]]
body  = "wheel"
value = "{torque:.15g} mN·m"

[[damping]]
body     = "pendulum"
q_factor = {values.q_factor!r}

{contacts}
[run]
duration  = "60 s"
tolerance = 1e-12

[timegrapher]
lift_angle = "{values.lift!r}°"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (("wheel.PINS", "pendulum.PALLETS"),)


def scene_text(values: PinWheel) -> str:
    """The text of scene.toml: a pin at rest on the lower pallet, the pendulum about to be let go."""
    anchor = PinAnchor(values)
    area = math.pi * values.bob_radius**2
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        gravity=-values.gravity,
        wheel_angle=(anchor.locked(1) + CLEAR) % (2.0 * anchor.half_pitch),
        pivot=anchor.pivot,
        thickness=values.bob_mass / (IRON * area) * 1e9,
        iron=IRON,
        rod_thickness=ROD_THICKNESS,
        rod_density=ROD_DENSITY,
        torque=-values.torque,
    )
