"""The tourbillon as a design: its dimensions, what follows from them, its outlines and its scene."""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.design import Design, dim, told
from watchsim.construction.outline import rounded
from watchsim.construction.swiss_lever import conflicts, parts, rest, swiss
from watchsim.construction.swiss_lever import draw as draw_lever
from watchsim.construction.swiss_lever_outlines import ESTIMATE, SwissLever
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop

# Which numbers does the designer of a tourbillon choose?


@dataclass(frozen=True)
class Tourbillon(SwissLever):
    """Those of the Swiss lever, of its carriage, and of what gravity acts on."""

    ratio: int = dim(16, "", 4, 60, "teeth of the fixed fourth wheel by those of the escape pinion", "a turn in a minute")
    carriage_inertia: float = dim(20.0, "mg·cm²", 0.1, 1e5, "carriage without what it carries", ESTIMATE)
    carriage_mass: float = dim(150.0, "mg", 10.0, 1e5, "carriage without what it carries", ESTIMATE)
    wheel_mass: float = dim(4.0, "mg", 0.1, 1e4, "escape wheel with its pinion", ESTIMATE)
    lever_mass: float = dim(3.0, "mg", 0.1, 1e4, "lever", ESTIMATE)
    balance_mass: float = dim(50.0, "mg", 1.0, 1e5, "balance with roller and hairspring", ESTIMATE)
    poise_error: float = dim(
        5.0, "µm", 0.0, 1000.0, "of the balance's centre of mass, from its axis", "33 s/d between positions"
    )
    gravity: float = dim(9.81, "m/s²", 0.0, 20.0, "in the plane: the watch stands upright; 0: it lies flat", "mean on earth")


# What does the scene of a tourbillon say?

HEAD = """\
# A tourbillon: a Swiss lever on a carriage, the balance on its axis. The escape pinion rolls round the fixed fourth wheel, of
# {values.ratio} times its teeth, and the train drives the carriage. The watch stands upright, and the balance is out of
# poise: what this gains in one position it loses in the opposite one. Drawn to these dimensions:
{dimensions}

[scene]
title   = "Tourbillon, {values.frequency:.0f} vph, a turn in {turn:.15g} s"
schema  = 1
gravity = ["0 m/s²", "{gravity:.15g} m/s²"]

[bodies.carriage]                    # a bridge, only drawn: nothing is declared to touch it
drawing        = "carriage.dxf"
layers         = ["BRIDGE"]
pivot          = ["0 mm", "0 mm"]
mass           = "{values.carriage_mass:.15g} mg"
inertia        = "{values.carriage_inertia:.15g} mg·cm²"
centre_of_mass = ["0 mm", "{poised!r} mm"]   # poised with wheel and lever

"""

DRIVE = """\
[[gears]]                            # the wheel against the carriage: both clockwise
between = ["carriage", "wheel"]
ratio   = {values.ratio}

[[torques]]                          # the train turns the carriage, nothing else drives the wheel
body  = "carriage"
value = "{torque:.15g} µN·m"

"""


def scene_text(values: Tourbillon) -> str:
    """The text of scene.toml: as the lever by itself begins, the wheel below the balance."""
    design = swiss(values)
    wheel_y, lever_y = -design.balance_pivot[1], design.lever_pivot[1] - design.balance_pivot[1]
    head = HEAD.format(
        dimensions=told(values),
        values=values,
        turn=values.ratio * values.teeth * 7200.0 / values.frequency,
        gravity=-values.gravity,
        poised=-(values.wheel_mass * wheel_y + values.lever_mass * lever_y) / values.carriage_mass,
    )
    carried = 'on       = "carriage"\n'
    more = {
        "wheel": f'{carried}mass     = "{values.wheel_mass:.15g} mg"\n',
        "lever": f'{carried}mass     = "{values.lever_mass:.15g} mg"\n',
        "balance": f'{carried}mass     = "{values.balance_mass:.15g} mg"\n'
        f'centre_of_mass = ["{values.poise_error:.15g} µm", "0 mm"]\n',
        "banking": carried,
    }
    drive = DRIVE.format(values=values, torque=-values.ratio * values.torque)
    return head + parts(values, design.balance_pivot[1], more) + drive + rest(values, "1e-11")


# What makes a tourbillon a design?

# Shares of the distance from wheel to balance, with each corner's radius: a foot under the wheel, two arms over the balance.
BRIDGE = (
    *((-0.23, -1.2, 0.1), (0.0, -1.34, 0.3), (0.23, -1.2, 0.1), (0.12, 0.0, 0.15), (0.38, 0.55, 0.05), (0.28, 0.71, 0.05)),
    *((0.0, 0.22, 0.08), (-0.28, 0.71, 0.05), (-0.38, 0.55, 0.05), (-0.12, 0.0, 0.15)),
)


def draw(values: Tourbillon) -> dict[str, Sheet]:
    """The sheets of the lever, and the carriage about the balance's axis."""
    scale = swiss(values).balance_pivot[1]
    bridge = Loop(tuple(rounded([(scale * x, scale * y, scale * radius) for x, y, radius in BRIDGE])), "BRIDGE")
    return {**draw_lever(values), "carriage": Sheet((bridge,))}


DESIGN = Design("tourbillon", "Swiss lever on the carriage of a tourbillon", Tourbillon, draw, scene_text, conflicts)
