"""Scenes of dead-beat escapements without friction on a spring, whose motion follows from energy and Airy's rule alone.

The locking arcs have the pivot as centre and exert no torque, so only the impulse faces act. `designs.graham` draws them.
"""

from pathlib import Path

import watchsim as ws
from watchsim.scene.scene import Scene

ALONE = """
[scene]
schema  = 1
gravity = ["0 m/s²", "0 m/s²"]

[design]
of            = "graham"
lift          = "0.5°"
lock          = "{lock}°"
tip_width     = "0.1°"
friction      = 0
wheel_inertia = "1 g·mm²"
q_factor      = {quality}
torque        = "{torque} mN·m"
start         = "{start}°"

[[springs]]
body      = "pendulum"
frequency = "2 Hz"

[run]
duration  = "60 s"
tolerance = {tolerance}
"""

# A catch that the pendulum throws over, from one stop to the other and back, where it swings far enough.
CATCH = """
[bodies.pin]
on       = "pendulum"
motion   = "fixed"
circle   = "1 mm"
position = ["0 mm", "40 mm"]

[bodies.catch]
polygon  = [["-5 mm", "-2 mm"], ["-5 mm", "-40 mm"], ["-3.8 mm", "-40 mm"], ["-3.8 mm", "-4 mm"],
            ["3.8 mm", "-4 mm"], ["3.8 mm", "-40 mm"], ["5 mm", "-40 mm"], ["5 mm", "-2 mm"]]
position = ["0 mm", "98.284271 mm"]
angle    = "-5°"
inertia  = "100 g·mm²"

[bodies.left]
circle   = "1 mm"
motion   = "fixed"
position = ["-9.2 mm", "68 mm"]

[bodies.right]
circle   = "1 mm"
motion   = "fixed"
position = ["9.2 mm", "68 mm"]

[[torques]]
body  = "catch"
over  = "angle"
table = [["-0.2°", "-10 mN·m"], ["0.2°", "10 mN·m"]]

[[contacts]]
between = ["pin", "catch"]

[[contacts]]
between = ["catch", "left"]

[[contacts]]
between = ["catch", "right"]
"""

# A second wheel above the pivot, whose pallets are turned by 3° about it: swings below that do not let it off.
SECOND = """
[bodies.second_anchor]
drawing  = "second/pendulum.dxf"
layers   = ["PALLETS"]
draw     = []
pivot    = "PIVOT"
on       = "pendulum"
motion   = "fixed"
angle    = "183°"
position = ["0 mm", "0 mm"]

[bodies.second_wheel]
drawing  = "second/escape_wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "56.56854249492381 mm"]
angle    = "5.2°"
inertia  = "1 g·mm²"

[[torques]]
body  = "second_wheel"
value = "-4 mN·m"

[[contacts]]
between = ["second_wheel.TEETH", "second_anchor.PALLETS"]
"""


def one_wheel(
    folder: Path,
    *,
    lock: float = 0.4,
    quality: float = 250,
    torque: float,
    start: float,
    more: str = "",
    tolerance: float = 1e-10,
) -> Scene:
    """An oscillator of 2 Hz with that escapement; `lock`, `start` in degrees, `torque` in mN·m."""
    text = ALONE.format(lock=lock, quality=quality, torque=torque, start=start, tolerance=tolerance)
    (folder / "scene.toml").write_text(text + more, encoding="utf-8")
    return ws.load(folder)


def with_catch(folder: Path, torque: float) -> Scene:
    """The catch is thrown over above about 4°."""
    return one_wheel(folder, quality=20, torque=torque, start=4.5, more=CATCH)


def two_wheels(folder: Path, start: float) -> Scene:
    """The second wheel, of twice the torque, is let off above about 3°."""
    sizes = {"lift": "0.5°", "lock": "0.4°", "tip_width": "0.1°"}
    ws.designs.graham(**sizes).write(folder / "second", force=True)
    return one_wheel(folder, quality=100, torque=2, start=start, more=SECOND)
