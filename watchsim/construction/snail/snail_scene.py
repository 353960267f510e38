"""What does the scene of a snail and its rack say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.leaf_text import leaf_text
from watchsim.construction.snail.snail_dimensions import Snail
from watchsim.construction.snail.snail_proportions import EASE, FALLS, LIFTED

SUDDEN = 1e-6  # s: over which the rack is let go
END = 0.58  # of the last hour: the rack lies on the lowest step

TEXT = """\
# The snail of a striking train with its rack, drawn to these dimensions:
{dimensions}

[scene]
title  = "Snail of {values.steps} steps with its rack"
schema = 1

[bodies.snail]                       # turns counter-clockwise, evenly, by a step in each hour
drawing  = "snail.dxf"
layers   = ["STEPS"]
pivot    = ["0 mm", "0 mm"]
angle    = "{angle!r}°"
motion   = "driven"
velocity = "{speed!r} °/s"

[bodies.rack]                        # falls counter-clockwise, by a tooth for each blow
drawing  = "rack.dxf"
layers   = ["PIN", "TAIL"]
pivot    = ["0 mm", "0 mm"]
position = ["{values.distance!r} mm", "0 mm"]
inertia  = "{values.rack_inertia:.15g} mg·cm²"

[bodies.stop]                        # of the rack that has been gathered up
drawing  = "stop.dxf"
layers   = ["STOP"]
pivot    = ["0 mm", "0 mm"]
position = ["{values.distance!r} mm", "0 mm"]
motion   = "fixed"

[[springs]]                          # a leaf
body    = "rack"
leaf    = {{ {leaf} }}
preload = "{preload!r} µN·m"

[[torques]]                          # the striking train gathers the rack up, and lets it go once in each hour
body   = "rack"
over   = "time"
table  = [{table}]
period = "{values.hour!r} s"

{contacts}
[run]
duration  = "{duration!r} s"
tolerance = 1e-9
"""

CONTACTS = (("rack.PIN", "snail.STEPS"), ("rack.TAIL", "stop.STOP"))


def scene_text(values: Snail) -> str:
    """The text of scene.toml: the rack gathered up, the first step coming under its pin."""
    free, taken = values.hour * FALLS, values.hour * LIFTED
    times = (free, free + SUDDEN, taken, taken + EASE * values.hour)
    torques = (-values.lifting, 0.0, 0.0, -values.lifting)
    rows = [f'["{time:.15g} s", "{torque:.15g} mN·m"]' for time, torque in zip(times, torques, strict=True)]
    pitch = 360.0 / values.steps
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        angle=-0.5 * pitch,
        speed=pitch / values.hour,
        leaf=leaf_text(values),
        preload=values.leaf_force * values.leaf_arm,  # mN·mm = µN·m
        table=", ".join(rows),
        duration=round((values.steps - 1 + END) * values.hour, 9),
    )
