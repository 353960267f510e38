"""What does the scene of a winding click with recoil say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.leaf_text import leaf_text
from watchsim.construction.winding_click.winding_click_dimensions import WindingClick
from watchsim.construction.winding_click.winding_click_proportions import distance, held, least_recoil

BEGIN, EASE, AFTER = 0.05, 0.02, 0.13  # s: before the hand winds, over which it takes hold and lets go, and after

TEXT = """\
# A winding click with recoil, drawn to these dimensions:
{dimensions}
# Let go, the wheel runs back by {recoil:.6g}° at least, and by up to {pitch:.6g}° more.

[scene]
title  = "Winding click with recoil, {values.teeth} teeth"
schema = 1

[bodies.wheel]                       # on the barrel's arbor, wound counter-clockwise
drawing  = "wheel.dxf"
layers   = ["TEETH"]
pivot    = ["0 mm", "0 mm"]
angle    = "{wheel!r}°"              # a locking face on the nose
inertia  = "{values.wheel_inertia:.15g} mg·cm²"

[bodies.click]                       # goes with the teeth both ways, but for its bank
drawing  = "click.dxf"
layers   = ["NOSE"]
pivot    = ["0 mm", "0 mm"]
position = ["0 mm", "{distance!r} mm"]
angle    = "{values.bank!r}°"
inertia  = "{values.click_inertia:.15g} mg·cm²"

[[springs]]                          # a leaf, which holds the click on its bank
body        = "click"
leaf        = {{ {leaf} }}
preload     = "{preload!r} µN·m"
stop        = "{values.bank!r}°"
restitution = {values.restitution!r}

[[torques]]                          # the mainspring; from {values.full:g}° on its coils lie on each other
body  = "wheel"
over  = "angle"
table = [["{wheel!r}°", "{held:.15g} mN·m"], ["{full!r}°", "{held:.15g} mN·m"], ["{beyond!r}°", "{tight!r} mN·m"]]

[[torques]]                          # the hand that winds, and lets go
body  = "wheel"
over  = "time"
table = [["{t0!r} s", "0 mN·m"], ["{t1!r} s", "{wind} mN·m"], ["{t2!r} s", "{wind} mN·m"], ["{t3!r} s", "0 mN·m"]]

[[damping]]
body    = "wheel"
viscous = "{values.viscous:.15g} mN·m·s/rad"

{contacts}
[run]
duration  = "{duration!r} s"
tolerance = 1e-9
"""

CONTACTS = (("click.NOSE", "wheel.TEETH"),)
BEYOND = 1.0  # rad past the full mainspring: as far as its table goes


def scene_text(values: WindingClick) -> str:
    """The text of scene.toml: the click holds, the wheel is wound until its spring is full, and let go."""
    full, times = held(values) + values.full, (BEGIN, BEGIN + EASE, BEGIN + values.wound_for, BEGIN + values.wound_for + EASE)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        recoil=least_recoil(values),
        pitch=360.0 / values.teeth,
        wheel=held(values),
        distance=distance(values),
        leaf=leaf_text(values),
        preload=values.leaf_force * values.leaf_arm,  # mN·mm = µN·m
        held=-values.mainspring,
        full=full,
        beyond=full + math.degrees(BEYOND),
        tight=-(values.mainspring + values.bound * BEYOND),
        wind=f"{values.winding:.15g}",
        **{f"t{i}": round(time, 9) for i, time in enumerate(times)},
        duration=round(times[3] + AFTER, 9),
    )
