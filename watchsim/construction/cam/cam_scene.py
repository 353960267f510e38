"""What does the scene of an eccentric cam say?"""

from __future__ import annotations

from watchsim.construction.cam.cam_dimensions import Cam
from watchsim.construction.cam.cam_proportions import leaves_at, lowest
from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told

TURNS = 3.0

TEXT = """\
# An eccentric cam with its follower, drawn to these dimensions:
{dimensions}
# Without friction the follower leaves the cam from {leaves:.6g} °/s on.

[scene]
title  = "Eccentric cam with its follower"
schema = 1

[bodies.cam]                         # turns counter-clockwise, evenly; its middle is below the axis at the start
drawing  = "cam.dxf"
layers   = ["CAM"]
pivot    = ["0 mm", "0 mm"]
motion   = "driven"
velocity = "{values.speed!r} °/s"

[bodies.follower]
drawing  = "follower.dxf"
layers   = ["END"]
pivot    = ["0 mm", "0 mm"]
position = ["0 mm", "{lowest!r} mm"]
motion   = "slide"
axis     = [0.0, 1.0]
mass     = "{values.mass:.15g} g"

[[springs]]                          # presses from the start: its rest lies inside the cam
body      = "follower"
stiffness = "{values.rate:.15g} N/mm"
rest      = "{rest!r} mm"

{contacts}
[run]
duration  = "{duration:.15g} s"
tolerance = 1e-9
"""

CONTACTS = (("follower.END", "cam.CAM"),)


def scene_text(values: Cam) -> str:
    """The text of scene.toml: the follower on the lowest point of the cam."""
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        leaves=leaves_at(values),
        lowest=lowest(values),
        rest=-values.preload / values.rate,
        duration=round(TURNS * 360.0 / values.speed, 9),
    )
