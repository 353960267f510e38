"""What does the scene of a cylinder escapement say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.cylinder.cylinder_dimensions import Cylinder
from watchsim.construction.cylinder.cylinder_outlines import wheel_of
from watchsim.construction.cylinder.cylinder_points import shell
from watchsim.construction.design import told

CLEAR = 1e-4  # degrees by which the tooth stands off the shell at the start

TEXT = """\
# A cylinder escapement: teeth rest on the cylinder, a half shell on the balance's arbor, outside and inside by turns, while the
# balance swings on; in between their inclined faces lift its lips. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Cylinder escapement, {values.frequency:.0f} vph, {values.teeth} teeth"
schema = 1

[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["TEETH"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a tooth just off the outside of the shell
inertia  = "{values.wheel_inertia:.15g} mg·cm²"      # with the train as felt here

[bodies.balance]                     # hangs at the end of a swing
drawing  = "balance.dxf"
layers   = ["SHELL"]
draw     = ["BALANCE"]
pivot    = "PIVOT"
position = ["0 mm", "{values.centre_distance!r} mm"]
angle    = "{values.start!r}°"
inertia  = "{values.balance_inertia:.15g} mg·cm²"

[[springs]]
body      = "balance"
frequency = "{values.frequency:.15g} vph"
draw      = {hairspring}

[[torques]]
body  = "wheel"
value = "{torque!r} µN·m"

[[damping]]
body     = "balance"
q_factor = {values.q_factor!r}

{contacts}
[run]
duration  = "20 s"
tolerance = 1e-12

[timegrapher]
lift_angle = "{values.lift:.15g}°"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (("wheel.TEETH", "balance.SHELL"),)


def scene_text(values: Cylinder) -> str:
    """The text of scene.toml: a tooth at rest on the outside of the shell, the balance about to be let go."""
    made = shell(values)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        wheel_angle=round((made.rests_outside + values.tooth_width / 2.0 + CLEAR) % made.pitch, 9),
        hairspring=wheel_of(made).hairspring(90.0),
        torque=-values.torque,
    )
