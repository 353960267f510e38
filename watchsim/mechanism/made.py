"""How does a sheet that a design draws become a drawing, without a file?

By way of its DXF all the same: what is simulated then is what the results folder holds, to the last bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read_data
from watchsim.drawing.sheet import Sheet

Made = Mapping[str, Sheet]  # name of a drawing in the scene -> the sheet


@lru_cache(maxsize=256)
def made_drawing(name: str, sheet: Sheet, snap: float) -> Drawing:
    """Made once per sheet: of a design of which one dimension changes, most sheets stay as they are."""
    return read_data(sheet.dxf(), Path(name), snap=snap)
