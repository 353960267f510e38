"""What does the scene of a tourbillon say?"""

from __future__ import annotations

from watchsim.construction.design import told
from watchsim.construction.swiss_lever.swiss_lever_derived import swiss
from watchsim.construction.swiss_lever.swiss_lever_scene import parts, rest
from watchsim.construction.tourbillon.tourbillon_dimensions import Tourbillon

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
