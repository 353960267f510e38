"""What does the scene of an anchor escapement with a pendulum say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.graham.graham_points import Anchor

CLEAR = 1e-5  # degrees by which the tooth stands off the pallet at the start
BOB_DENSITY = 8400.0  # kg/m³, brass
ROD_DENSITY, ROD_THICKNESS = 7850.0, 2.0  # steel; mm

TEXT = """\
# {title}, drawn to these dimensions:
{dimensions}

[scene]
title   = "{title}"
schema  = 1
gravity = ["0 m/s²", "{gravity!r} m/s²"]

[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a tooth just off the locking face of the entry pallet
inertia  = "{values.wheel_inertia:.15g} g·mm²"

[bodies.pendulum]                    # with the anchor; let go with the entry pallet deep in the wheel
drawing  = "pendulum.dxf"
layers   = ["PALLETS"]
pivot    = "PIVOT"
position = ["0 mm", "{distance!r} mm"]
angle    = "{values.start!r}°"

[[bodies.pendulum.solids]]
layer     = "BOB"
thickness = "{thickness!r} mm"       # makes its mass {values.bob_mass:.6g} kg
density   = "{bob_density:g} kg/m³"

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

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (("wheel.TEETH", "pendulum.PALLETS"),)


def scene_text(anchor: Anchor, title: str) -> str:
    """The text of scene.toml: a tooth locked on the entry pallet, the pendulum about to be let go."""
    values = anchor.values
    area = math.pi * values.bob_radius**2
    return TEXT.format(
        title=f"{title}, {values.teeth} teeth",
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        gravity=-values.gravity,
        wheel_angle=(anchor.wheel_angle(values.start) + CLEAR) % (360.0 / values.teeth),
        distance=anchor.distance,
        thickness=values.bob_mass / (BOB_DENSITY * area) * 1e9,
        bob_density=BOB_DENSITY,
        rod_thickness=ROD_THICKNESS,
        rod_density=ROD_DENSITY,
        torque=-values.torque,
    )
