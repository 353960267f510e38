"""What does the scene of a verge escapement say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.verge.verge_dimensions import Verge

TEXT = """\
# A verge escapement with a foliot, drawn to these dimensions:
{dimensions}

[scene]
title  = "Verge and foliot, crown wheel of {values.teeth} teeth"
schema = 1

[bodies.verge]                       # with the foliot, seen along its axis
drawing  = "verge.dxf"
layers   = ["NEAR_FLAG", "FAR_FLAG"]
draw     = ["FOLIOT", "WEIGHTS"]
pivot    = ["0 mm", "0 mm"]
inertia  = "{values.foliot_inertia:.15g} kg·cm²"

[bodies.crown_wheel]                 # stands across the plane, its axis pointing down
inertia  = "{values.wheel_inertia:.15g} g·cm²"

[bodies.near_side]                   # of its rim runs to the right,
drawing  = "near_side.dxf"
motion   = "slide"
axis     = [1.0, 0.0]
mass     = "1 µg"                    # weighed with the wheel

[bodies.far_side]                    # the far one to the left
drawing  = "far_side.dxf"
motion   = "slide"
axis     = [-1.0, 0.0]
mass     = "1 µg"

[[gears]]
between = ["crown_wheel", "near_side"]
ratio   = "{values.wheel_radius:.15g} mm/rad"

[[gears]]
between = ["crown_wheel", "far_side"]
ratio   = "{values.wheel_radius:.15g} mm/rad"

[[torques]]
body  = "crown_wheel"
value = "{values.torque:.15g} mN·m"

[[damping]]
body    = "verge"
viscous = "{values.viscous:.15g} mN·m·s/rad"

{contacts}
[run]
duration  = "20 s"
tolerance = 1e-12
"""

CONTACTS = (("near_side.NEAR", "verge.NEAR_FLAG"), ("far_side.FAR", "verge.FAR_FLAG"))


def scene_text(values: Verge) -> str:
    """The text of scene.toml: the verge begins at rest in the middle, a tooth of the near side at its flag."""
    return TEXT.format(dimensions=told(values), values=values, contacts=contact_tables(values, *CONTACTS))
