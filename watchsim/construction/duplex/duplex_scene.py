"""What does the scene of a duplex escapement say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.duplex.duplex_dimensions import Duplex
from watchsim.construction.duplex.duplex_outlines import wheel_of
from watchsim.construction.duplex.duplex_points import DuplexPoints

CLEAR = 1e-4  # degrees by which the tooth stands off the roller at the start

TEXT = """\
# A duplex escapement: a long tooth rests on the roller while the balance swings; as the roller's notch comes by, counter-
# clockwise, the tooth goes through with it, and an upright tooth falls on the impulse pallet. On the way back the tooth only
# dips into the notch. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Duplex escapement, {values.frequency:.0f} vph, {values.teeth} teeth"
schema = 1

[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["RESTING", "IMPULSE"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a tooth just off the roller
inertia  = "{values.wheel_inertia:.15g} mg·cm²"      # with the train as felt here

[bodies.balance]                     # hangs at the end of a swing
drawing  = "balance.dxf"
layers   = ["ROLLER", "PALLET"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["0 mm", "{distance!r} mm"]
angle    = "{start!r}°"
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
duration  = "60 s"
tolerance = 1e-12

[timegrapher]
lift_angle = "{lift:.4g}°"           # from the notch's taking of a tooth to the end of the impulse
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("wheel.RESTING", "balance.ROLLER"),
    ("wheel.IMPULSE", "balance.PALLET"),
)


def scene_text(values: Duplex) -> str:
    """The text of scene.toml: a tooth at rest on the roller, the balance about to be let go."""
    points = DuplexPoints(values)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        wheel_angle=round((90.0 + points.rests + CLEAR) % points.pitch, 9),
        distance=points.distance,
        start=-values.start,
        hairspring=wheel_of(points).hairspring(90.0),
        torque=-values.torque,
        lift=points.driven + 2.0 * values.intersection,
    )
