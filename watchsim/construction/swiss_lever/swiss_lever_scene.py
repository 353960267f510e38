"""What does the scene of a Swiss lever say?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from watchsim.construction.contact_tables import contact_tables
from watchsim.construction.design import told
from watchsim.construction.outline import along, angle_of
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_dimensions import SwissLever
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_roller import wheel_of

CLEAR = 1e-4  # degrees by which lever and wheel stand off what they rest on
BODIES = ("wheel", "lever", "balance", "banking")
NO_MORE: Mapping[str, str] = MappingProxyType({})

HEAD = """\
# {title}, drawn to these dimensions:
{dimensions}

[scene]
title  = "Swiss lever, {values.frequency:.0f} vph, {values.teeth} teeth"
schema = 1

"""

PARTS = """\
[bodies.wheel]                       # turns clockwise
drawing  = "escape_wheel.dxf"
layers   = ["TEETH"]
pivot    = "PIVOT"
position = ["0 mm", "{wheel_y} mm"]
angle    = "{wheel_angle:.7f}°"      # a tooth a few nanometres off the locking face of the entry stone
inertia  = "{values.wheel_inertia:.15g} mg·cm²"      # with the train as felt here
{more[wheel]}
[bodies.lever]
drawing  = "lever.dxf"
layers   = ["STONES", "FORK", "DART", "ARMS"]
pivot    = "PIVOT"
position = ["0 mm", "{lever_y} mm"]
angle    = "{lever_angle:.15g}°"     # a few nanometres off the bank
inertia  = "{values.lever_inertia:.15g} mg·cm²"
{more[lever]}
[bodies.balance]                     # hangs at the end of a swing, the jewel far outside the fork
drawing  = "roller.dxf"
layers   = ["TABLE", "SAFETY", "PIN"]
draw     = ["RIM"]
pivot    = "PIVOT"
position = ["0 mm", "{balance_y} mm"]
angle    = "{start:.15g}°"
inertia  = "{values.balance_inertia:.15g} mg·cm²"
{more[balance]}
[bodies.banking]
drawing  = "banking.dxf"
layers   = ["PINS"]
pivot    = "PIVOT"
position = ["0 mm", "{wheel_y} mm"]
motion   = "fixed"
{more[banking]}
[[springs]]
body      = "balance"
frequency = "{values.frequency:.15g} vph"
draw      = {hairspring}

"""

DRIVE = """\
[[torques]]
body  = "wheel"
value = "{torque:.15g} µN·m"

"""

REST = """\
[[damping]]
body     = "balance"
q_factor = {values.q_factor!r}

{contacts}
[run]
duration  = "10 s"
tolerance = {tolerance}

[timegrapher]
lift_angle = "{values.lift_angle:.15g}°"
"""

CONTACTS: tuple[tuple[str, str] | tuple[str, str, str], ...] = (
    ("wheel.TEETH", "lever.STONES"),
    ("lever.FORK", "balance.PIN"),
    ("lever.DART", "balance.SAFETY", "safety action: never meets in normal running"),
    ("lever.ARMS", "banking.PINS"),
)


def scene_text(values: SwissLever) -> str:
    """The text of scene.toml: lever on its entry bank, a tooth on the entry stone, the balance about to be let go."""
    head = HEAD.format(title="A Swiss lever escapement", dimensions=told(values), values=values)
    return head + parts(values) + DRIVE.format(torque=-values.torque) + rest(values)


def parts(values: SwissLever, below: float = 0.0, more: Mapping[str, str] = NO_MORE) -> str:
    """Bodies and hairspring: the wheel `below` (mm) the origin, with `more` lines for each body."""
    design = swiss(values)
    return PARTS.format(
        values=values,
        more={name: more.get(name, "") for name in BODIES},
        wheel_angle=wheel_angle(design),
        wheel_y=_mm(-below),
        lever_y=_mm(design.lever_pivot[1] - below),
        lever_angle=round(design.bank - CLEAR, 10),
        balance_y=_mm(design.balance_pivot[1] - below),
        start=-values.start,
        hairspring=wheel_of(design, values.balance_inertia).hairspring(90.0),
    )


def rest(values: SwissLever, tolerance: str = "1e-9") -> str:
    """Damping, contacts, and how it is run."""
    return REST.format(values=values, contacts=contact_tables(values, *CONTACTS), tolerance=tolerance)


def _mm(length: float) -> str:
    return repr(length + 0.0).removesuffix(".0")


def wheel_angle(design: Swiss) -> float:
    """Of the wheel, °: a toe just off the entry stone's locking face, lever on its bank; at 0 one toe is on the x axis."""
    lever = design.bank - CLEAR
    corner = design.in_movement(design.locking_corner(1), lever)
    direction = design.face_direction(1) + lever
    x, y = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    middle = corner[0] * x + corner[1] * y
    reach = -middle + math.sqrt(middle**2 - math.hypot(*corner) ** 2 + design.tip_radius**2)
    toe = angle_of(along(corner, direction, reach)) + CLEAR
    pitch = 360.0 / design.teeth
    return (toe + pitch / 2.0) % pitch - pitch / 2.0
