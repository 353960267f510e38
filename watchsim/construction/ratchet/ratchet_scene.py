"""What does the scene of a ratchet wheel and its click say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.ratchet.ratchet_dimensions import Ratchet
from watchsim.construction.ratchet.ratchet_proportions import pivot

WOUND = 0.35  # rad of the click's spring at rest: it hardly weakens as the click is lifted

TEXT = """\
# A ratchet wheel with its click, drawn to these dimensions:
{dimensions}

[scene]
title  = "Ratchet wheel of {values.teeth} teeth with its click"
schema = 1

[bodies.wheel]                       # wound counter-clockwise
drawing  = "wheel.dxf"
layers   = ["TEETH"]
pivot    = ["0 mm", "0 mm"]
inertia  = "{values.wheel_inertia:.15g} mg·cm²"

[bodies.click]
drawing  = "click.dxf"
layers   = ["NOSE"]
pivot    = ["0 mm", "0 mm"]
position = ["{pivot[0]!r} mm", "{pivot[1]!r} mm"]
angle    = "{angle!r} rad"
inertia  = "{values.click_inertia:.15g} mg·cm²"

[[springs]]                          # presses the nose into the teeth with {values.click_force:.6g} mN
body      = "click"
stiffness = "{stiffness!r} µN·m/rad"
rest      = "{rest!r} rad"

[[torques]]                          # the mainspring
body  = "wheel"
value = "{mainspring!r} mN·m"

[[torques]]                          # the hand that winds, and lets go
body  = "wheel"
over  = "time"
table = [["0.05 s", "0 mN·m"], ["0.07 s", "{winding} mN·m"], ["0.35 s", "{winding} mN·m"], ["0.37 s", "0 mN·m"]]

[[damping]]
body    = "wheel"
viscous = "{values.viscous:.15g} mN·m·s/rad"

{contacts}
[run]
duration  = "0.5 s"
tolerance = 1e-9
"""

CONTACTS = (("click.NOSE", "wheel.TEETH"),)


def scene_text(values: Ratchet) -> str:
    """The text of scene.toml: the click holds, the wheel is wound, the click holds again."""
    angle = -math.radians(values.click_angle)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        pivot=pivot(values),
        angle=angle,
        stiffness=values.click_force * values.click_length / WOUND,  # mN·mm = µN·m
        rest=angle + WOUND,
        mainspring=-values.mainspring,
        winding=f"{values.winding:.15g}",
    )
