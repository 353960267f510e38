"""What does the scene of a Geneva stop-work say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.geneva.geneva_proportions import centre_distance, half_pitch
from watchsim.construction.geneva_stop.geneva_stop_dimensions import GenevaStop

SPARE = 1.4  # times the time that the turns would take at the speed without impacts
OUTSIDE = 90.0  # degrees of the arbor from where its pin is deepest, at the start

TEXT = """\
# A Geneva stop-work: each turn of the barrel arbor takes the Maltese cross on by an arm; the arm without a hollow stops the
# arbor. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Geneva stop-work, {values.turns} turns"
schema = 1

[bodies.arbor]                       # wound counter-clockwise by hand
drawing  = "arbor.dxf"
layers   = ["PIN", "DISC"]
pivot    = "PIVOT"
position = ["{distance!r} mm", "0 mm"]
angle    = "{start!r}°"
inertia  = "{values.arbor_inertia:.15g} g·mm²"

[bodies.cross]                       # turns clockwise, {pitch:.6g}° at a time
drawing  = "cross.dxf"
layers   = ["CROSS"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{half!r}°"
inertia  = "{values.cross_inertia:.15g} g·mm²"

[[torques]]                          # the hand
body  = "arbor"
value = "{values.hand:.15g} mN·m"

[[springs]]                          # the mainspring, slack at the start, pulls back
body      = "arbor"
stiffness = "{stiffness!r} mN·m/rad"
rest      = "{start!r}°"

[[damping]]                          # the hand does not turn faster
body    = "arbor"
viscous = "{viscous!r} mN·m·s/rad"
{load}
{contacts}
[run]
duration  = "{duration:.6g} s"
tolerance = 1e-9
"""

LOAD = """
[[damping]]
body    = "cross"
coulomb = "{load:.15g} mN·m"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("arbor.PIN", "cross.CROSS"),
    ("arbor.DISC", "cross.CROSS", "the lock, and the stop"),
)


def scene_text(values: GenevaStop) -> str:
    """The text of scene.toml: let down, the arbor a quarter of a turn past the lower stop."""
    drive, wound = values.drive, math.tau * values.turns
    fastest = math.radians(values.speed)
    slowest = fastest * (1.0 - values.mainspring / values.hand)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        distance=centre_distance(drive),
        start=180.0 - 360.0 + OUTSIDE,
        half=half_pitch(drive),
        pitch=2.0 * half_pitch(drive),
        stiffness=values.mainspring / wound,
        viscous=values.hand / math.radians(values.speed),
        load=LOAD.format(load=values.load) if values.load > 0.0 else "",
        duration=SPARE * wound * math.log(fastest / slowest) / (fastest - slowest),
    )
