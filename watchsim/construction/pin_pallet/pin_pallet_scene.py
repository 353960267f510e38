"""What does the scene of a pin-pallet escapement say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.pin_pallet.pin_pallet_dimensions import PinPallet
from watchsim.construction.pin_pallet.pin_pallet_numbers import pin_lever
from watchsim.construction.swiss_lever.swiss_lever_roller import wheel_of

CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on

TEXT = """\
# A pin-pallet (Roskopf) lever escapement, drawn to these dimensions:
{dimensions}

[scene]
title  = "Pin-pallet lever, {values.frequency:.0f} vph, {values.teeth} teeth"
schema = 1

[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{wheel_angle!r}°"        # a tooth just off the entry pin
inertia  = "{values.wheel_inertia:.15g} mg·cm²"      # with the train as felt here

[bodies.lever]
drawing  = "lever.dxf"
layers   = ["PALLETS", "FORK", "DART", "ARMS"]
pivot    = "PIVOT"
position = ["0 mm", "{lever_y!r} mm"]
angle    = "{lever_angle!r}°"        # just off the bank
inertia  = "{values.lever_inertia:.15g} mg·cm²"

[bodies.balance]                     # hangs at the end of a swing, the impulse pin far outside the fork
drawing  = "roller.dxf"
layers   = ["TABLE", "SAFETY", "PIN"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["0 mm", "{balance_y!r} mm"]
angle    = "{start!r}°"
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
value = "{torque!r} µN·m"

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
    ("wheel.TEETH", "lever.PALLETS"),
    ("lever.FORK", "balance.PIN"),
    ("lever.DART", "balance.SAFETY", "safety action: never meets in normal running"),
    ("lever.ARMS", "banking.PINS"),
)


def scene_text(values: PinPallet) -> str:
    """The text of scene.toml: lever on its entry bank, a tooth on the entry pin, the balance about to be let go."""
    design = pin_lever(values)
    lever = design.bank - CLEAR
    pitch = 360.0 / values.teeth
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        wheel_angle=round((design.locked_corner(1, lever) + CLEAR) % pitch, 9),
        lever_y=design.lever_pivot[1],
        lever_angle=round(lever, 10),
        balance_y=design.balance_pivot[1],
        start=-values.start,
        hairspring=wheel_of(design, values.balance_inertia).hairspring(90.0),
        torque=-values.torque,
    )
