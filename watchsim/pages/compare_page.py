"""How does a comparison become one page? The page of the last run, with the outlines of the first as ghosts over it."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Point
from watchsim.pages.html import joined, page, section, table
from watchsim.pages.player import drawn_parts, packed_part, picture_size
from watchsim.pages.report_page import check_page, page_parts
from watchsim.render.parts import Part, loops_of
from watchsim.scene.keys import in_words
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array
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
    data["ghost"] = _outlines(first.scene, last.scene, picture_size(last, window))
    rows = [(in_words(key), *values) for key, *values in changed_rows(found)]
    changed = table(("", *names), rows, "what differs between the scenes", numeric=False)
    words = f"difference: {names[-1]} less {names[0]}; {'±: its error' if found.off == '±' else 'scatter: of the beats'}"
    results = table(("", *names, "difference", found.off), result_rows(found), words)
    places["sheet"] = joined((section("changed", "What was changed", changed), section("results", "What came of it", results)))
    places["lead"] = f"{names[-1]} in motion; dashed: where {names[0]} was drawn otherwise (G hides it)"
    text = page(last.scene.title, places, data)
    write_file(target, lambda place: place.write_bytes(text.encode("utf-8", "replace")), "the page")
    return target


LOOKS = 8  # at a line or arc
ALIKE = 2e-5  # of the picture: a line as near to one of today is not drawn as a ghost, however much is zoomed in


def _outlines(scene: Scene, now: Scene, size: float) -> dict[str, Any]:
    """What of a scene's outlines is drawn otherwise `now`, for the player; `size` (m) is that of its picture."""
    names = [body.name for body in scene.bodies]
    bodies = [
        {"name": body.name, "motion": body.motion, "on": -1 if body.on is None else names.index(body.on), "at": body.position}
        for body in scene.bodies
    ]
    shown = (_otherwise(part, scene, now, ALIKE * size) for part in drawn_parts(scene, size))
    return {"bodies": bodies, "parts": [packed_part(part, names) for part in shown if part.outlines]}


def _otherwise(part: Part, scene: Scene, now: Scene, close: float) -> Part:
    """The part with those of its lines and arcs only that are nowhere within `close` (m) of its body's outlines `now`."""
    body = next((one for one in now.bodies if one.name == part.body), None)
    if body is None or body.position != scene.body(part.body).position:
        return part
    lines = [polyline(loop, 0.25 * close) for loop in loops_of(body)]
    if not lines:
        return part
    starts, ends = (np.concatenate([line[end] for line in lines]) for end in (slice(None, -1), slice(1, None)))
    pieces: list[Loop] = []
    for loop in part.outlines:
        off = [any(_apart(edge.point(k / LOOKS), starts, ends) > close for k in range(LOOKS + 1)) for edge in loop.edges]
        for differs, run in groupby(zip(off, loop.edges, strict=True), key=lambda one: one[0]):
            if differs:
                pieces.append(Loop(tuple(edge for _, edge in run), loop.layer, closed=all(off) and loop.closed))
    return replace(part, outlines=tuple(pieces))


def _apart(point: Point, starts: Array, ends: Array) -> float:
    """Distance of a point from the nearest of the stretches (m, 2), m."""
    way = ends - starts
    share = np.clip(np.sum((point - starts) * way, axis=1) / np.maximum(np.sum(way**2, axis=1), 1e-300), 0.0, 1.0)
    return float(np.hypot(*(starts + share[:, None] * way - point).T).min())
