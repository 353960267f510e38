"""What does a scene hold that is made from a design?

`[design] of = "swiss_lever"` stands for the design's own scene; the other keys of the table are dimensions. What else the file
says is written over that scene, and what was changed since over both.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from numbers import Real
from typing import Any

from watchsim import units
from watchsim.construction import registry
from watchsim.construction.design import Design, Dimension
from watchsim.scene.assign import assign
from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.keys import DESIGN, LISTED, NAMED, SHAPES, TABLES, Keys, nearest
from watchsim.scene.outlines import Made
from watchsim.scene.scene import Written
from watchsim.scene.toml import parsed
from watchsim.scene.values import shown
from watchsim.units import UnitError

# What does a scene say that is written over another one?
#
# Tables are merged key by key, bodies by name. Springs and damping are the same entry where they name the same body, torques as
# well, contacts where they are between the same two; what has no counterpart is added.

OUTLINE = ("drawing", "layers", "draw", *SHAPES)


def merged(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """`base` with all that `over` says; neither is changed. What is not as it should be is left for the reader to refuse."""
    out = copy.deepcopy(base)
    for section, value in copy.deepcopy(over).items():
        ours = out.get(section)
        if section in TABLES and isinstance(ours, dict) and isinstance(value, dict):
            ours.update(value)
        elif section in NAMED and isinstance(ours, dict) and isinstance(value, dict):
            for name, entry in value.items():
                ours[name] = _over(ours.get(name), entry)
        elif section in LISTED and isinstance(ours, list) and isinstance(value, list):
            _over_entries(ours, value, LISTED[section])
        else:
            out[section] = value
    return out


def _over(ours: object, entry: object) -> object:
    """One body: another outline replaces all that belongs to the old one, solids replace a number for the inertia."""
    if not isinstance(ours, dict) or not isinstance(entry, dict):
        return entry
    dropped = set(OUTLINE) if any(shape in entry for shape in SHAPES) else set()
    dropped |= {"inertia", "mass"} if "solids" in entry else set()
    return {**{key: value for key, value in ours.items() if key not in dropped}, **entry}


def _over_entries(ours: list[Any], entries: list[Any], keys: Keys) -> None:
    free = list(range(len(ours)))
    for entry in entries:
        at = next((i for i in free if _identity(entry) is not None and _identity(entry) == _identity(ours[i])), None)
        if at is None:
            ours.append(entry)
            continue
        free.remove(at)
        for key in entry:
            for other in keys[key].instead_of if key in keys else ():
                ours[at].pop(other, None)
        ours[at].update(entry)


def _identity(entry: object) -> object:
    if not isinstance(entry, dict):
        return None
    between = entry.get("between")
    if isinstance(between, list) and all(isinstance(side, str) for side in between):
        return frozenset(between)
    body = entry.get("body")
    return body if isinstance(body, str) else None


# Which values has a design whose dimensions are given as texts with units?


def chosen(design: Design, given: Mapping[str, object], faults: Faults | None = None) -> Any:
    """The values with some dimensions given as in a scene file; None after a fault, without `faults` SceneError lists them."""
    noted = faults or Faults(design.name)
    before, names = len(noted.found), [one.name for one in design.dimensions]
    numbers = {}
    for name, value in given.items():
        if name not in names:
            noted.add(f"{DESIGN}.{name}", f"unknown dimension. {nearest(name, names)}")
            continue
        try:
            numbers[name] = number_of(design.dimension(name), value)
        except UnitError as error:
            noted.add(f"{DESIGN}.{name}", str(error), shown(value))
    refused = design.refusals(numbers)
    for conflict in refused:
        key = f"{DESIGN}.{conflict.dimension}" if conflict.dimension else DESIGN
        noted.add(key, conflict.message, _seen(design, conflict.dimension, given))
    changed = {name for name, number in numbers.items() if number != design.dimension(name).default}
    if any(conflict.dimension not in changed for conflict in refused):  # what is named is as usual: what is not, is to change
        for name, limit in _limits(design, numbers):
            if name not in {conflict.dimension for conflict in refused}:
                noted.add(f"{DESIGN}.{name}", f"works {limit} with all else as it is", shown(given[name]))
    if faults is None:
        noted.raise_any()
    return None if len(noted.found) > before else design.chosen(numbers)


STEPS = 12  # halvings of the way from a default to a value that is refused


def _limits(design: Design, numbers: Mapping[str, float]) -> Iterator[tuple[str, str]]:
    """Each given dimension without which nothing is refused: its name, and how far it may go, in words."""
    for name, number in numbers.items():
        one = design.dimension(name)
        works, fails = one.default, number
        if one.count or works == fails or design.refusals({**numbers, name: works}):
            continue
        for _ in range(STEPS):
            middle = 0.5 * (works + fails)
            works, fails = (works, middle) if design.refusals({**numbers, name: middle}) else (middle, fails)
        step = 10.0 ** (math.floor(math.log10(abs(works))) - 2) if works else 1.0
        last = (math.floor if number > one.default else math.ceil)(works / step) * step
        yield name, f"{'up to' if number > one.default else 'down to'} {one.shortly(last)}"


def number_of(dimension: Dimension, value: object) -> float:
    """The number in the dimension's own unit; UnitError where the value is none."""
    unit, kind = units.known_unit(dimension.unit), kind_of(dimension)
    if kind is units.NUMBER:
        return units.parse(value, kind)
    number, text = units.split(value)
    if text and units.known_unit(text, kind) == unit:
        return float(number)
    other = next((one for one in kind.usual if one != dimension.unit), dimension.unit)
    kind = replace(kind, usual=(other, dimension.unit))  # what a message suggests is of the size that the design has
    return float(f"{units.parse(value, kind) / unit.factor:.15g}")  # the sixteenth place is rounding of the conversion


def kind_of(dimension: Dimension) -> units.Dimension:
    """The kind of quantity that its unit measures."""
    unit = units.known_unit(dimension.unit)
    return next(one for one in units.DIMENSIONS if unit.powers in one.powers)


def with_si(design: Design, name: str, value: object) -> object:
    """A number from Python as text in SI units, as with every other key of a scene; all else as it is."""
    dimension = next((one for one in design.dimensions if one.name == name), None)
    if dimension is None or isinstance(value, bool) or not isinstance(value, Real):
        return value
    kind = kind_of(dimension)
    return float(value) if kind is units.NUMBER else f"{float(value)!r} {kind.si}"


def _seen(design: Design, name: str, given: Mapping[str, object]) -> str:
    """The value as it was given, or the default that stands in the way."""
    if name in given:
        return shown(given[name])
    return f" = {design.dimension(name).shortly(design.dimension(name).default)} (default)" if name else ""


# What does a scene hold that is made from a design?


@dataclass(frozen=True)
class _Drawn:
    """What a design gives for some values: its scene and its sheets, by the names that the scene gives them."""

    scene: dict[str, Any]
    sheets: Made


def in_full(mapping: Mapping[str, Any], changes: Mapping[str, object], faults: Faults) -> dict[str, object]:
    """Changes of a scene with a design, with "lock" as "design.lock"; SceneError where the design is not known."""
    table = mapping[DESIGN]
    if not isinstance(table, dict):
        faults.add(DESIGN, 'a table is needed here: [design] with of = "swiss_lever" and dimensions', shown(table))
        faults.raise_any()
    names = [one.name for one in designed(changes.get(f"{DESIGN}.of", table.get("of")), faults).dimensions]
    return {f"{DESIGN}.{key}" if key in names else key: value for key, value in changes.items()}


def with_design(written: Written, faults: Faults) -> tuple[dict[str, Any], Made]:
    """The mapping of the whole scene, and the drawings that the design makes; SceneError where it cannot be drawn."""
    table = written.mapping[DESIGN]
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
    """The design of that name; SceneError where there is none, or where that of another package does not load."""
    if isinstance(of, str) and (of in registry.own() or of in registry.names()):  # the others are looked for, which takes long
        try:
            return registry.design(of)
        except registry.BrokenDesign as error:
            said = str(error)
    elif of is None:
        said = f"missing. Known: {', '.join(registry.names())}"
    else:
        hint = nearest(str(of), registry.names())
        known = f"Known: {', '.join(registry.names())}"
        said = f"there is no such design. {hint if hint.startswith('Did') else known}"
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
    design = registry.design(name)
    scene = parsed(design.scene(values))
    sheets = design.sheets(values)
    for entry in scene["bodies"].values():
        if f"{name}/{entry.get('drawing')}" in sheets:
            entry["drawing"] = f"{name}/{entry['drawing']}"
    return _Drawn(scene, sheets)
