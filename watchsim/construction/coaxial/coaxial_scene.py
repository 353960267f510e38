"""What does the scene of a co-axial escapement say?"""

from __future__ import annotations

from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.coaxial.coaxial_points import FIRST, Points
from watchsim.construction.coaxial.coaxial_roller import wheel_of
from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told

CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on

TEXT = """\
# A co-axial escapement after George Daniels: the large wheel locks on two stones of the lever and pushes the roller's stone
# (direct impulse, balance counter-clockwise); the small one pushes the lever's third stone (indirect impulse, through fork and
# pin). Drawn to these dimensions:
{dimensions}

[scene]
title  = "Co-axial escapement, {values.frequency:.0f} vph, 8 + 8 teeth"
schema = 1

[bodies.wheel]                       # turns clockwise; the inertia includes the train as felt here
drawing  = "escape_wheel.dxf"
layers   = ["TEETH", "SMALL_TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle:.7f}°"      # a tooth a few nanometres off the first locking face
inertia  = "{values.wheel_inertia:.15g} mg·cm²"

[bodies.lever]
drawing  = "lever.dxf"
layers   = ["LOCKING_STONES", "IMPULSE_STONE", "FORK", "GUARD", "ARMS"]
pivot    = "PIVOT"
position = ["0 mm", "{lever_y!r} mm"]
angle    = "{lever_angle:.15g}°"     # a few nanometres off the bank
inertia  = "{values.lever_inertia:.15g} mg·cm²"

[bodies.balance]                     # hangs at the end of a swing, its pin far outside the fork
drawing  = "roller.dxf"
layers   = ["TABLE", "SAFETY", "PIN", "IMPULSE_STONE"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["{balance[0]!r} mm", "{balance[1]!r} mm"]
angle    = "{start:.15g}°"
inertia  = "{values.balance_inertia:.15g} mg·cm²"

[bodies.banking]
drawing  = "banking.dxf"
layers   = ["PINS"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
motion   = "fixed"

[[springs]]
body      = "balance"
frequency = "{values.frequency:.15g} vph"
draw      = {hairspring}

[[torques]]
body  = "wheel"
value = "{torque:.15g} µN·m"

[[damping]]
body     = "balance"
q_factor = {values.q_factor!r}

{contacts}
[run]
duration  = "10 s"
tolerance = 1e-9

[timegrapher]
lift_angle = "{values.lift_angle:.15g}°"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("wheel.TEETH", "lever.LOCKING_STONES", "locking"),
    ("wheel.TEETH", "balance.IMPULSE_STONE", "direct impulse"),
    ("wheel.SMALL_TEETH", "lever.IMPULSE_STONE", "indirect impulse"),
    ("lever.FORK", "balance.PIN", "unlocking, and the indirect impulse handed on"),
    ("lever.GUARD", "balance.SAFETY", "safety action: never meets in normal running"),
    ("lever.ARMS", "banking.PINS"),
)


def scene_text(values: Coaxial) -> str:
    """The text of scene.toml: wheel locked on the first stone, lever on its bank, the balance about to be let go."""
    points = Points(values)
    lever = points.bank - CLEAR
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        wheel_angle=points.locked_tip(FIRST, lever) + CLEAR,
        lever_y=points.lever_pivot[1],
        lever_angle=round(lever, 10),
        balance=points.balance_pivot,
        start=-values.start,
        hairspring=wheel_of(points).hairspring(round(points.fork_bearing, 1)),
        torque=-values.torque,
    )
