"""What does the scene of a grasshopper escapement say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.grasshopper.grasshopper_points import ENTRY, EXIT, Points

CLEAR, OFF = 1e-3, 1e-4  # degrees by which, at the start, the tooth stands off its pallet, and the pallets off their stops

TEXT = """\
# A grasshopper escapement with one pivot for both pallets, drawn to these dimensions:
{dimensions}
# From them: frame {arm:.6g} mm from the pendulum's axis to the pallets' pivot, pallets {length:.6g} mm long.

[scene]
title   = "Grasshopper escapement, {values.teeth} teeth"
schema  = 1
gravity = ["0 m/s²", "{gravity!r} m/s²"]

[bodies.wheel]                       # turns clockwise
drawing  = "wheel.dxf"
layers   = ["TEETH"]
pivot    = ["0 mm", "0 mm"]
position = ["0 mm", "0 mm"]
angle    = "{wheel!r}°"              # a tooth just off the entry pallet
inertia  = "{values.wheel_inertia:.15g} g·mm²"

[bodies.pendulum]                    # with the frame; let go with the entry pallet about to drive it
drawing  = "pendulum.dxf"
layers   = ["STOPS"]
pivot    = ["0 mm", "0 mm"]
position = ["{axis[0]!r} mm", "{axis[1]!r} mm"]
angle    = "{start!r}°"
mass     = "{values.bob_mass:.15g} kg"
centre_of_mass = ["0 mm", "{bob!r} mm"]
inertia  = "{inertia:.15g} kg·mm²"   # of the bob, about the pivot

[bodies.entry]                       # hangs in the frame; pushed by its tooth
on       = "pendulum"
drawing  = "entry.dxf"
layers   = ["PALLET"]
pivot    = ["0 mm", "0 mm"]
position = ["{pivot!r} mm", "0 mm"]
angle    = "{entry!r}°"
mass     = "{values.pallet_mass:.15g} g"
inertia  = "{values.pallet_inertia:.15g} g·mm²"

[bodies.exit]                        # on the same pivot; pulled by its tooth
on       = "pendulum"
drawing  = "exit.dxf"
layers   = ["PALLET"]
pivot    = ["0 mm", "0 mm"]
position = ["{pivot!r} mm", "0 mm"]
angle    = "{exit!r}°"
mass     = "{values.pallet_mass:.15g} g"
inertia  = "{values.pallet_inertia:.15g} g·mm²"

[[torques]]                          # counterweights, which lift the pallets to their stops
body  = "entry"
value = "{lift_entry:.15g} µN·m"

[[torques]]
body  = "exit"
value = "{values.pallet_torque:.15g} µN·m"

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
"""

CONTACTS = (
    ("wheel.TEETH", "entry.PALLET"),
    ("wheel.TEETH", "exit.PALLET"),
    ("entry.PALLET", "pendulum.STOPS"),
    ("exit.PALLET", "pendulum.STOPS"),
)


def scene_text(at: Points) -> str:
    """The text of scene.toml: a tooth on the entry pallet, the exit pallet on its stop."""
    values = at.values
    about = values.bob_mass * (values.pendulum**2 + 0.5 * values.bob_radius**2)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        arm=at.arm,
        length=at.length,
        gravity=-values.gravity,
        wheel=math.fmod(at.tooth(at.furthest, ENTRY), at.pitch) + CLEAR,
        axis=at.axis,
        start=at.furthest,
        bob=-values.pendulum,
        inertia=about,
        pivot=-at.arm,
        entry=at.stopped(ENTRY) + OFF,
        exit=at.stopped(EXIT) - OFF,
        lift_entry=-values.pallet_torque,
        torque=-values.torque,
    )
