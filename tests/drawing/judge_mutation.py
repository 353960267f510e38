"""Was a damaged drawing read as it must be: no exception, and nothing missing in silence?"""

from __future__ import annotations

import json
import traceback
from pathlib import Path

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspect import inspect_report, inspect_text
from watchsim.drawing.read import FIT, read, read_content

LEFT_OUT = ("layer-off", "paper-space", "edge-on")


def amount(drawing: Drawing) -> int:
    """How much geometry a drawing holds: closed loops count double, so that one torn open is less."""
    return 2 * len(drawing.loops) + len(drawing.open_chains) + len(drawing.points)


def fault(path: Path, whole: Drawing, entities: int = 0) -> str:
    """What is wrong with how the damaged file at `path` is read; empty if all is well.

    `whole` is the drawing before, which had no finding: without any finding at least as much must be there. `entities` is how
    many a plain look at the file finds: all must be drawn or told of.
    """
    try:
        content = read_content(path, path.suffix[1:], None, FIT)
        drawing = read(path)
        json.dumps(inspect_report(drawing), allow_nan=False)
        inspect_text(drawing)
    except Exception:
        return "exception: " + traceback.format_exc(limit=-3)
    if not drawing.findings and amount(drawing) < amount(whole):
        return f"silent loss: {amount(whole)} before, {amount(drawing)} after, and nothing said"
    drawn = len({stroke.run for stroke in content.strokes}) + len(content.points) + sum(content.ignored.values())
    told = any(finding.severity == "error" or finding.code in LEFT_OUT for finding in content.findings)
    if drawn < entities and not told:
        return f"silent loss: {entities} entities in the file, {drawn} read, and nothing said"
    return ""
