"""What does the scene of a star and its jumper say?"""

from __future__ import annotations

import math

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.jumper.jumper_dimensions import Jumper
from watchsim.construction.jumper.jumper_proportions import beak_at_rest, finger_direction, finger_distance, pitch
from watchsim.construction.outline import polar

TURNS = 2.0

TEXT = """\
# A calendar star with its jumper, drawn to these dimensions:
{dimensions}

[scene]
title  = "Calendar star of {values.teeth} teeth with its jumper"
schema = 1

[bodies.finger]                      # turns clockwise, evenly, and carries the star on by a tooth in each turn
drawing  = "finger.dxf"
layers   = ["PIN"]
pivot    = ["0 mm", "0 mm"]
position = ["{finger[0]!r} mm", "{finger[1]!r} mm"]
angle    = "{direction!r}°"
motion   = "driven"
velocity = "{speed!r} °/s"

[bodies.star]                        # turns counter-clockwise, {pitch:.6g}° at a time
drawing  = "star.dxf"
layers   = ["STAR"]
pivot    = ["0 mm", "0 mm"]
position = ["0 mm", "0 mm"]
inertia  = "{values.star_inertia:.15g} mg·cm²"

[bodies.jumper]                      # holds the star between two teeth, and throws it on once the beak has passed a point
drawing  = "jumper.dxf"
layers   = ["BEAK"]
pivot    = ["0 mm", "0 mm"]
position = ["{beak!r} mm", "{values.jumper_length!r} mm"]
inertia  = "{values.jumper_inertia:.15g} mg·cm²"

[[springs]]                          # {values.preload:.6g} mN on the beak at rest, {values.rate:.6g} mN/mm more as it is lifted
body      = "jumper"
stiffness = "{stiffness!r} µN·m/rad"
rest      = "{rest!r} rad"
{drag}
{contacts}
[run]
duration  = "{duration:.15g} s"
tolerance = 1e-9
"""

DRAG = """
[[damping]]
body    = "star"
coulomb = "{drag:.15g} µN·m"
"""

CONTACTS = (
    ("finger.PIN", "star.STAR"),
    ("jumper.BEAK", "star.STAR"),
)


def scene_text(values: Jumper) -> str:
    """The text of scene.toml: the star at rest, the pin on its far side."""
    direction = finger_direction(values)
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        finger=polar(finger_distance(values), direction),
        direction=direction,
        speed=-values.speed,
        pitch=pitch(values),
        beak=beak_at_rest(values),
        stiffness=values.rate * values.jumper_length**2,  # mN/mm · mm² = µN·m per rad
        rest=-values.preload / (values.rate * values.jumper_length),
        drag=DRAG.format(drag=values.drag) if values.drag > 0.0 else "",
        duration=math.ceil(TURNS * 360.0 / values.speed * 1e6) / 1e6,
    )
