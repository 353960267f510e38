"""What does the scene of two gears in mesh say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import Values, told

TEXT = """\
# {heading}, drawn to these dimensions:
{dimensions}

[scene]
title  = "{title}, {values.wheel_teeth} and {values.pinion_teeth} teeth"
schema = 1

[bodies.wheel]                       # drives, counter-clockwise
drawing  = "wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "0°"                      # a tooth on the line of centres
inertia  = "{values.wheel_inertia:.15g} mg·cm²"

[bodies.pinion]                      # a gap on the line of centres
drawing  = "pinion.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["{distance!r} mm", "0 mm"]
angle    = "{pinion!r}°"
inertia  = "{values.pinion_inertia:.15g} mg·cm²"

[[torques]]
body  = "wheel"
value = "{values.torque:.15g} µN·m"

[[damping]]
body    = "pinion"
viscous = "{values.drag:.15g} µN·m·s/rad"

{contacts}
[run]
duration  = "2 s"
tolerance = 1e-10
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (("wheel.TEETH", "pinion.TEETH"),)


def gear_pair_scene(values: Values, heading: str, title: str, distance: float) -> str:
    """The text of scene.toml: both at rest, in the middle of the play; `distance` of the axes, mm."""
    pinion = (180.0 + 180.0 / values.pinion_teeth) % (360.0 / values.pinion_teeth)
    return TEXT.format(
        heading=heading,
        title=title,
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        distance=distance,
        pinion=pinion,
    )
