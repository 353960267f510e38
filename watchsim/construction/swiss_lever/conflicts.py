"""Which dimensions of a Swiss lever do not go together?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.swiss_lever.dimensions import SwissLever
from watchsim.construction.swiss_lever.follow import swiss
from watchsim.construction.swiss_lever.sheets import sheets


def conflicts(values: SwissLever) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    if (values.embraced % 1.0) != 0.5:
        yield Conflict("embraced", "must be a whole number and a half, so that one stone locks while the other is free")
        return
    sheets(swiss(values))
