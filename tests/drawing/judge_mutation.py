"""Was a damaged drawing read as it must be: no exception, and nothing missing in silence?"""

import json
import traceback
from pathlib import Path
from typing import Any

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspection import inspect_report, inspect_text
from watchsim.drawing.read import FIT, read, read_content
from watchsim.drawing.svg import page_unit
from watchsim.geometry.loops import total_length


def amount(drawing: Drawing) -> int:
    """How much geometry a drawing holds: closed loops count double, so that one torn open is less."""
    return 2 * len(drawing.loops) + len(drawing.open_chains) + len(drawing.points)


def agreed(drawing: Drawing, length: float | None) -> bool:
    """Does the other reader draw as much, by its coarser chords?"""
    scale = page_unit(drawing.units)[1] if drawing.units else 1e-3
    found = total_length((*drawing.loops, *drawing.open_chains)) / scale
    return length is not None and abs(found - length) <= 1e-2 * max(found, length)


def fault(path: Path, whole: Drawing, mutator: Any) -> str:
    """What is wrong with how the damaged file at `path` is read; empty if all is well.

    `whole` is the drawing before, which had no finding. `mutator` is the module that damaged it; it looks at files without the
    package: `entities(data)`, how many stand in the file; `lost(data)`, whether the name of one stands where none begins;
    `length(path)`, how much another reader draws (drawing units), None where that one gives up; `TOLD`, the codes of findings
    that account for entities which are not drawn.

    All entities must be drawn or reported; without any finding at least as much as before must be there, unless the other
    reader agrees that the damaged file draws less.
    """
    data = path.read_bytes()
    try:
        content = read_content(path, path.suffix[1:], None, FIT)
        drawing = read(path)
        json.dumps(inspect_report(drawing), allow_nan=False)
        inspect_text(drawing)
        runs = {stroke.run for stroke in content.strokes}
    except Exception:
        return "exception: " + traceback.format_exc(limit=-3)
    if not drawing.findings and amount(drawing) < amount(whole) and not agreed(drawing, mutator.length(path)):
        return f"silent loss: {amount(whole)} before, {amount(drawing)} after, and nothing said"
    drawn = len(runs) + len(content.points) + sum(content.ignored.values())
    told = any(finding.severity == "error" or finding.code in mutator.TOLD for finding in content.findings)
    entities = mutator.entities(data)
    if drawn < entities and not told:
        return f"silent loss: {entities} entities in the file, {drawn} read, and nothing said"
    if not drawing.findings and mutator.lost(data):
        return "silent loss: an entity begins nowhere, and nothing said"
    return ""
