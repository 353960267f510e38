"""What does the scene of a Geneva drive say?"""

from __future__ import annotations

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.geneva.geneva_dimensions import Geneva
from watchsim.construction.geneva.geneva_proportions import centre_distance, half_pitch

TURNS = 2.25  # of the driver, which starts square to the line of centres: the pin then stands deepest in the third slot

TEXT = """\
# A Geneva drive, drawn to these dimensions:
{dimensions}

[scene]
title  = "Geneva drive, {values.slots} slots"
schema = 1

[bodies.driver]                      # turns counter-clockwise, evenly
drawing  = "driver.dxf"
layers   = ["PIN", "DISC"]
pivot    = "PIVOT"
position = ["{distance!r} mm", "0 mm"]
angle    = "90°"
motion   = "driven"
velocity = "{values.speed!r} °/s"

[bodies.wheel]                       # locked at the start; turns clockwise, {pitch:.6g}° at a time
drawing  = "wheel.dxf"
layers   = ["WHEEL"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{half!r}°"
inertia  = "{values.wheel_inertia:.15g} g·mm²"
{load}
{contacts}
[run]
duration  = "{duration:.15g} s"
tolerance = 1e-9
"""

LOAD = """
[[damping]]                          # holds the wheel back against the driving side of a slot
body    = "wheel"
coulomb = "{load:.15g} mN·m"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("driver.PIN", "wheel.WHEEL"),
    ("driver.DISC", "wheel.WHEEL", "the lock"),
)


def scene_text(values: Geneva) -> str:
    """The text of scene.toml: the wheel locked, the pin outside."""
    return TEXT.format(
        dimensions=told(values),
        values=values,
        contacts=contact_tables(values, *CONTACTS),
        distance=centre_distance(values),
        half=half_pitch(values),
        pitch=2.0 * half_pitch(values),
        load=LOAD.format(load=values.load) if values.load > 0.0 else "",
        duration=TURNS * 360.0 / values.speed,
    )
