"""Which sheets does a Swiss lever escapement need?"""

from __future__ import annotations

from watchsim.construction.swiss_lever.swiss_lever_lever import lever
from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_roller import INERTIA, banking, roller
from watchsim.construction.swiss_lever.swiss_lever_wheel import wheel
from watchsim.drawing.sheet import Sheet


def sheets(swiss: Swiss, inertia: float = INERTIA) -> dict[str, Sheet]:
    """File name without ending -> the part; the rim is that of a balance of `inertia` (mg·cm²).

    ValueError where a fillet does not fit.
    """
    parts = {"escape_wheel": wheel(swiss), "lever": lever(swiss), "roller": roller(swiss, inertia), "banking": banking(swiss)}
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}
