"""Are the outlines of a sheet sound, once they are read back from its file?"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import SNAP, read_data
from watchsim.drawing.sheet import Sheet


@lru_cache(maxsize=256)
def drawing_of(sheet: Sheet, name: str, snap: float = SNAP) -> Drawing:
    """The drawing of a sheet, by way of its DXF: what is simulated is then what a file of it holds, to the last bit.

    Made once per sheet: of a design of which one dimension changes, most sheets stay as they are.
    """
    return read_data(sheet.dxf(), Path(name), snap=snap)


def unsound(sheet: Sheet, name: str) -> Iterator[str]:
    """What is wrong with the outlines, a sentence for each layer."""
    wrong = [finding for finding in drawing_of(sheet, name, SNAP).findings if finding.severity == "error"]
    for layer in dict.fromkeys(finding.layer for finding in wrong):
        first = next(finding for finding in wrong if finding.layer == layer)
        at = "" if first.x_mm is None else f" at ({first.x_mm:.3f}, {first.y_mm:.3f}) mm"
        what = "cross itself" if first.code == "crossing" else "not be sound"
        yield f"the outline of {name}, layer {layer}, would {what}{at}"
