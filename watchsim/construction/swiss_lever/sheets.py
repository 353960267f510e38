"""Which sheets does a Swiss lever escapement need?"""

from __future__ import annotations

from watchsim.construction.swiss_lever.lever import lever
from watchsim.construction.swiss_lever.points import Swiss
from watchsim.construction.swiss_lever.roller import banking, roller
from watchsim.construction.swiss_lever.wheel import wheel
from watchsim.drawing.sheet import Sheet


def sheets(swiss: Swiss) -> dict[str, Sheet]:
    """File name without ending -> the part. ValueError where a fillet does not fit."""
    parts = {"escape_wheel": wheel(swiss), "lever": lever(swiss), "roller": roller(swiss), "banking": banking(swiss)}
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}
