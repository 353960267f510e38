"""What does a scene hold that is made from a design?

`[design] of = "swiss_lever"` stands for the design's own scene; the other keys of the table are dimensions. What else the file
says is written over that scene, and what was changed since over both.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from watchsim.construction import known
from watchsim.construction.design import Design
from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.file.assign import assign
from watchsim.scene.file.design_dimensions import chosen, with_si
from watchsim.scene.file.keys.key_values import shown
from watchsim.scene.file.keys.schema import DESIGN, nearest
from watchsim.scene.file.merge import merged
from watchsim.scene.file.outlines.made import Made
from watchsim.scene.file.parsed import parsed
from watchsim.scene.scene import Written


@dataclass(frozen=True)
class _Drawn:
    """What a design gives for some values: its scene and its sheets, by the names that the scene gives them."""

    scene: dict[str, Any]
    sheets: Made


def with_design(written: Written, faults: Faults) -> tuple[dict[str, Any], Made]:
    """The mapping of the whole scene, and the drawings that the design makes; SceneError where it cannot be drawn."""
    table = written.mapping[DESIGN]
    if not isinstance(table, dict):
        faults.add(DESIGN, 'a table is needed here: [design] with of = "swiss_lever" and dimensions', shown(table))
        faults.raise_any()
    mine = {key.partition(".")[2]: value for key, value in written.changes.items() if _of_design(key)}
    design = designed({**table, **mine}.get("of"), faults)
    given = {**table, **{name: with_si(design, name, value) for name, value in mine.items()}}
    given.pop("of")
    values = chosen(design, given, faults)
    faults.raise_any()
    drawn = _drawn(design.name, values)
    mapping = merged(drawn.scene, {key: value for key, value in written.mapping.items() if key != DESIGN})
    for key, value in written.changes.items():
        if not _of_design(key):
            assign(mapping, key, value, faults)
    mapping[DESIGN] = {"of": design.name, **{one.name: one.shown(getattr(values, one.name)) for one in design.dimensions}}
    return mapping, drawn.sheets


def designed(of: object, faults: Faults | None = None) -> Design:
    """The design of that name; SceneError where there is none."""
    if isinstance(of, str) and of in known.NAMES:
        return known.design(of)
    all_known = f"Known: {', '.join(known.NAMES)}"
    if of is None:
        said = f"missing. {all_known}"
    else:
        hint = nearest(str(of), known.NAMES)
        said = f"there is no such design. {hint if hint.startswith('Did') else all_known}"
    if faults is None:
        raise SceneError([Fault(str(of), said, place="design")])
    faults.add(f"{DESIGN}.of", said, "" if of is None else shown(of))
    faults.raise_any()
    raise AssertionError("a fault was noted")


def _of_design(key: str) -> bool:
    return key.partition(".")[0] == DESIGN


@lru_cache(maxsize=64)
def _drawn(name: str, values: Any) -> _Drawn:
    """Scene and sheets; the drawings are called after the design, so that a file beside the scene is never meant."""
    design = known.design(name)
    scene = parsed(design.scene(values))
    sheets = design.sheets(values)
    for entry in scene["bodies"].values():
        if f"{name}/{entry.get('drawing')}" in sheets:
            entry["drawing"] = f"{name}/{entry['drawing']}"
    return _Drawn(scene, sheets)
