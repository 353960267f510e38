"""Which dimensions of a Geneva stop-work do not go together?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.geneva import geneva_conflicts as of_drive
from watchsim.construction.geneva_stop.geneva_stop_dimensions import GenevaStop

SPARE = 1.1


def conflicts(values: GenevaStop) -> Iterator[Conflict]:
    """What cannot be drawn as a Geneva drive, and a hand that is too weak to wind."""
    for one in of_drive.conflicts(values.drive):
        yield Conflict("turns" if one.dimension == "slots" else one.dimension, one.message)
    if values.hand < SPARE * values.mainspring:
        yield Conflict("hand", f"must be at least {SPARE * values.mainspring:.4g} mN·m, or it does not wind the mainspring up")
