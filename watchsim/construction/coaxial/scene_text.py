"""Which scene does a co-axial escapement run in?"""

from __future__ import annotations

from watchsim.construction.coaxial.dimensions import Coaxial
from watchsim.construction.coaxial.points import FIRST, HALF_SPAN, Points


def scene_text(values: Coaxial) -> str:
    """The commented TOML of a 3.5 Hz watch with this escapement: locked on the first stone, the balance at the end of a swing."""
    points = Points(values)
    tip = points.locked_tip(FIRST)
    px, py = points.lever_pivot
    bx, by = points.balance_pivot
    return f"""# A Daniels co-axial escapement for a 25 200 vph watch, drawn from its dimensions (watchsim new coaxial).
# Eight and eight teeth. The large wheel locks on two stones of the lever and pushes the roller's stone (direct impulse,
# balance counter-clockwise); the small one pushes the lever's third stone (indirect impulse, through fork and pin).

[scene]
title  = "Co-axial escapement, 3.5 Hz, 8 + 8 teeth"
schema = 1

[bodies.wheel]                       # turns clockwise; the inertia includes the train as felt here
drawing  = "escape_wheel.dxf"
layers   = ["TEETH", "SMALL_TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
angle    = "{tip + 2e-4:.4f}°"              # a tooth a hair off the first locking face
inertia  = "0.1 mg·cm²"

[bodies.lever]
drawing  = "lever.dxf"
layers   = ["LOCKING_STONES", "IMPULSE_STONE", "FORK", "GUARD", "ARMS"]
pivot    = "PIVOT"
position = ["{px:.9g} mm", "{py:.12g} mm"]
angle    = "{points.bank - 1e-4:.4f}°"                # a hair off the bank
inertia  = "0.06 mg·cm²"

[bodies.balance]                     # hangs at the end of a swing, its pin far outside the fork
drawing  = "roller.dxf"
layers   = ["TABLE", "SAFETY", "PIN", "IMPULSE_STONE"]
pivot    = "PIVOT"
position = ["{bx:.12g} mm", "{by:.12g} mm"]
angle    = "-290°"
inertia  = "12 mg·cm²"

[bodies.banking]
drawing  = "banking.dxf"
layers   = ["PINS"]
pivot    = "PIVOT"
position = ["0 mm", "0 mm"]
motion   = "fixed"

[[springs]]
body      = "balance"
frequency = "25200 vph"              # 0.580 µN·m/rad

[[torques]]
body  = "wheel"
value = "-0.6 µN·m"

[[damping]]
body     = "balance"
q_factor = 250

[[contacts]]                         # locking
between     = ["wheel.TEETH", "lever.LOCKING_STONES"]
friction    = 0.15

[[contacts]]                         # direct impulse
between     = ["wheel.TEETH", "balance.IMPULSE_STONE"]
friction    = 0.15

[[contacts]]                         # indirect impulse
between     = ["wheel.SMALL_TEETH", "lever.IMPULSE_STONE"]
friction    = 0.15

[[contacts]]                         # unlocking, and the indirect impulse handed on
between     = ["lever.FORK", "balance.PIN"]
friction    = 0.15

[[contacts]]                         # safety action: never meets in normal running
between     = ["lever.GUARD", "balance.SAFETY"]
friction    = 0.15

[[contacts]]
between     = ["lever.ARMS", "banking.PINS"]
friction    = 0.15

[run]
duration  = "60 s"
tolerance = 1e-9

[timegrapher]
lift_angle = "{values.lift_angle:.6g}°"
"""
