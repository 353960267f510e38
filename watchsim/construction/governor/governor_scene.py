"""What does the scene of a governor fly say?"""

from __future__ import annotations

import math

from watchsim.construction.design import told
from watchsim.construction.governor.governor_dimensions import Governor

TEXT = """\
# The governor of a striking train: a weight on a drum drives a fly through gears, and the air on its vanes takes what that
# gives. From rest it comes up to the speed at which both are equal, {terminal:.4g} rad/s of the fly. Drawn to these dimensions:
{dimensions}

[scene]
title  = "Governor fly of a striking train"
schema = 1

[bodies.drum]
drawing  = "drum.dxf"
layers   = ["DRUM"]
pivot    = ["0 mm", "0 mm"]
position = ["0 mm", "0 mm"]
inertia  = "{values.drum_inertia:.15g} kg·cm²"

[bodies.fly]
drawing  = "fly.dxf"
layers   = ["VANES"]
draw     = ["COLLAR"]
pivot    = ["0 mm", "0 mm"]
position = ["{apart:.15g} mm", "0 mm"]
inertia  = "{values.fly_inertia:.15g} g·cm²"

[[gears]]                            # through the arbors between them
between = ["drum", "fly"]
ratio   = {values.ratio!r}

[[torques]]
body  = "drum"
value = "{values.torque:.15g} mN·m"

[[damping]]                          # vanes in air: torque c w²
body      = "fly"
quadratic = "{drag:.15g} nN·m·s²/rad²"

[run]
duration = "{duration:.2g} s"
"""

SETTLED = 6.0  # times the time constant of tanh: within 10⁻⁵ of the terminal speed


def drag(values: Governor) -> float:
    """Torque of the air by the fly's speed squared, N·m·s²/rad²: ½ ρ C h r² on each strip of both vanes, at the arm r."""
    reach, root, height = (1e-3 * length for length in (values.reach, values.root, values.height))
    return 0.25 * values.air * values.drag_coefficient * height * (reach**4 - root**4)


def terminal_speed(values: Governor) -> float:
    """Of the fly, rad/s."""
    return math.sqrt(1e-3 * values.torque / (values.ratio * drag(values)))


def time_constant(values: Governor) -> float:
    """T of ω tanh(t/T), s: inertia felt at the drum by torque, times the drum's terminal speed."""
    felt = 1e-4 * values.drum_inertia + values.ratio**2 * 1e-7 * values.fly_inertia
    return felt * terminal_speed(values) / values.ratio / (1e-3 * values.torque)


def scene_text(values: Governor) -> str:
    """The text of scene.toml: all at rest."""
    return TEXT.format(
        dimensions=told(values),
        values=values,
        apart=1.1 * (values.drum_radius + values.reach),
        drag=1e9 * drag(values),
        terminal=terminal_speed(values),
        duration=SETTLED * time_constant(values),
    )
