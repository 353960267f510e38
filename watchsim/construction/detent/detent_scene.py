"""What does the scene of a detent escapement say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.detent.detent_dimensions import Detent
from watchsim.construction.detent.detent_outlines import BLADE_LENGTH, root
from watchsim.construction.detent.detent_points import Points

CLEAR = 1e-4  # degrees by which tooth and passing spring stand off what they rest on at the start

TEXT = """\
# A detent escapement, as in a marine chronometer: the wheel is locked by a detent that a spring holds on its bank. As the
# balance swings counter-clockwise its discharging stone lifts the passing spring, and with it the detent; a tooth falls on the
# impulse stone. On the way back it bends the passing spring alone, and nothing else happens. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Detent escapement, {hertz:g} Hz, {values.teeth} teeth"
schema = 1

[bodies.wheel]                       # turns clockwise; the inertia includes the train as felt here
drawing  = "escape_wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a tooth just off the locking face
inertia  = "{values.wheel_inertia:.15g} mg·cm²"

[bodies.detent]
drawing  = "detent.dxf"
layers   = ["STONE", "BAR", "HORN", "HUB"]
pivot    = "PIVOT"
position = ["{pivot[0]!r} mm", "{pivot[1]!r} mm"]
angle    = "{off_bank!r}°"           # just off its bank
inertia  = "{values.detent_inertia:.15g} mg·cm²"

[bodies.passing]                     # the passing spring: a light leaf, pressed on the detent's horn by its own spring
on       = "detent"
drawing  = "passing_spring.dxf"
layers   = ["LEAF"]
pivot    = "PIVOT"
position = ["{root[0]!r} mm", "{root[1]!r} mm"]
angle    = "{clear!r}°"
mass     = "{mass:.6g} mg"
inertia  = "{values.passing_inertia:.15g} mg·cm²"

[bodies.balance]                     # hangs at the end of a swing
drawing  = "roller.dxf"
layers   = ["TABLE", "IMPULSE_STONE", "ROLLER", "DISCHARGE"]
pivot    = "PIVOT"
position = ["{balance[0]!r} mm", "{balance[1]!r} mm"]
angle    = "{start!r}°"
inertia  = "{values.balance_inertia:.15g} mg·cm²"

[bodies.banking]
drawing  = "banking.dxf"
layers   = ["SCREW"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
motion   = "fixed"

[[springs]]
body      = "balance"
frequency = "{values.frequency:.15g} vph"

[[springs]]                          # bent: holds the detent on its bank
body      = "detent"
stiffness = "{values.detent_stiffness:.15g} µN·m/rad"
rest      = "{detent_rest:.9g}°"

[[springs]]                          # bent: holds the leaf on the horn
body      = "passing"
stiffness = "{values.passing_stiffness:.15g} µN·m/rad"
rest      = "{passing_rest:.9g}°"

[[torques]]
body  = "wheel"
value = "{torque!r} µN·m"

[[damping]]
body     = "balance"
q_factor = {values.q_factor!r}

{contacts}
[run]
duration  = "10 s"
tolerance = 1e-9

[timegrapher]
lift_angle = "{lift:.4g}°"           # from the letting go of the tooth to the end of the impulse
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("wheel.TEETH", "detent.STONE", "locking"),
    ("wheel.TEETH", "balance.IMPULSE_STONE", "impulse"),
    ("passing.LEAF", "balance.DISCHARGE", "unlocking, and passing on the way back"),
    ("passing.LEAF", "detent.HORN"),
    ("detent.BAR", "banking.SCREW"),
)


def scene_text(values: Detent) -> str:
    """The text of scene.toml: a tooth locked, the detent on its bank, the balance about to be let go."""
    points = Points(values)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        hertz=values.frequency / 7200.0,
        wheel_angle=round(points.wheel_angle() % points.pitch + CLEAR, 9),
        pivot=points.pivot,
        off_bank=-CLEAR,
        root=root(points),
        clear=CLEAR,
        mass=3.0 * values.passing_inertia * 1e2 / (BLADE_LENGTH * points.scale) ** 2,
        balance=points.balance_pivot,
        start=-values.start,
        detent_rest=math.degrees(values.detent_torque / values.detent_stiffness),
        passing_rest=-math.degrees(values.passing_torque / values.passing_stiffness),
        torque=-values.torque,
        lift=2.0 * points.half_impulse - values.inside,
    )
