"""How does a comparison become one page? The page of the last run, with the outlines of the first as ghosts over it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from watchsim.pages.html import joined, page, section, table
from watchsim.pages.player import drawn_parts, packed_part, picture_size
from watchsim.pages.report_page import check_page, page_parts
from watchsim.scene.scene import Scene
from watchsim.storage.write import write_file
from watchsim.studies.compare import Comparison, changed_rows, result_rows


def comparison_page(found: Comparison, path: str | Path) -> Path:
    """Write it as one self-contained HTML file; every side has a run (`watchsim.studies.compare.with_run`).

    ValueError for a path with another ending, or a side without a run.
    """
    target = check_page(path)
    first, last = found.sides[0].run, found.sides[-1].run
    if first is None or last is None:
        raise ValueError("only runs can be shown in motion")
    names = [side.name for side in found.sides]
    places, data = page_parts(last)
    window = (data["window"][0], data["window"][1])
    data["ghost"] = _outlines(first.scene, picture_size(last, window))
    changed = table(("", *names), changed_rows(found), "keys of the scene that differ", numeric=False)
    words = f"difference: {names[-1]} less {names[0]}; {'±: its error' if found.off == '±' else 'scatter: of the beats'}"
    results = table(("", *names, "difference", found.off), result_rows(found), words)
    places["sheet"] = joined((section("changed", "What was changed", changed), section("results", "What came of it", results)))
    places["lead"] = f"{names[-1]} in motion; dashed: where {names[0]} was drawn otherwise (G hides it)"
    text = page(last.scene.title, places, data)
    write_file(target, lambda place: place.write_bytes(text.encode("utf-8", "replace")), "the page")
    return target


def _outlines(scene: Scene, size: float) -> dict[str, Any]:
    """What the player compares with its own outlines; `size` (m) is that of its picture."""
    names = [body.name for body in scene.bodies]
    bodies = [
        {"name": body.name, "motion": body.motion, "on": -1 if body.on is None else names.index(body.on), "at": body.position}
        for body in scene.bodies
    ]
    return {"bodies": bodies, "parts": [packed_part(part, names) for part in drawn_parts(scene, size)]}
