"""With what torques do wheel and oscillator work on the lever, and who is the stronger?

The parts stand still. The lever is thought to begin to turn one way; the contacts' directions say how wheel and oscillator go
with it and how the contacts slip, and friction resists. The equilibrium of the part on the other side of a contact gives the
force there, and its arms the torque at the lever.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.analysis.verdicts.equilibrium.lever_arms import Arms


def at_lever(found: Arms, row: int, other: str, lever: str, way: float) -> float | None:
    """N·m on the lever along `way` (+1 or -1) by what acts on body `other` through the contact `row`, as the lever begins to
    turn that way; negative where it resists. None where friction jams it or the contact cannot carry it.
    """
    (n_lever, t_lever), (n_other, t_other) = found.of(row, lever), found.of(row, other)
    if n_other == 0.0:
        return None
    turn = -n_lever * way / n_other  # of the other body, so that the contact neither opens nor overlaps
    slip = t_lever * way + t_other * turn
    rub = -float(found.friction[row]) * (math.copysign(1.0, slip) if slip else 0.0)
    column = found.columns[other]
    load = float(found.loads[column] - np.sign(turn) * found.dry[column])
    arm = n_other + rub * t_other
    if arm * n_other <= 0.0:  # friction alone holds what the normal force would move
        return None
    force = -load / arm
    return None if force < 0.0 else way * force * (n_lever + rub * t_lever)
