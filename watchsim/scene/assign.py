"""How is the value at one dotted path of a scene's mapping changed?

The path is followed through the mapping and through the table of keys at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any

from watchsim.scene.errors import Faults
from watchsim.scene.keys import (
    DESIGN,
    DOTTED,
    DRIVEN,
    LAYERS,
    LISTED,
    NAMED,
    NAMED_TABLES,
    NUMBER_OR_TABLE,
    SECTIONS,
    TABLE,
    TABLES,
    TABLES_LISTED,
    TRAIN,
    Key,
    dotted,
    entered,
    key_at,
    nearest,
    path_of,
    steps_into,
    words_of,
)
from watchsim.scene.scene import MOTIONS, Scene
from watchsim.scene.values import shown
from watchsim.units import DIMENSIONS, NUMBER, Dimension, UnitError, known_unit, split


def full_key(mapping: Mapping[str, Any], name: str) -> str:
    """ "lock" of a scene with a design is "design.lock"."""
    table = mapping.get(DESIGN)
    return f"{DESIGN}.{name}" if "." not in name and isinstance(table, dict) and name in table and name != "of" else name


def assign(mapping: dict[str, Any], key: str, value: object, faults: Faults) -> None:
    """Put the value there, into tables that are made where they are missing; what says the same thing beside it goes."""
    path = path_of(key)
    described = key_at(path)
    if described is None or path[0] == "lock":
        faults.add(key, f"unknown key. {_advice(path)}", shown(value))
        return
    holder, rest = _holder(mapping, path, faults)
    if holder is None:
        return
    name = path[1] if path[0] == "bodies" else holder.get("body")
    dimension = described.dimension_for(motion_of(mapping.get("bodies", {}), name))
    value = with_unit(value, dimension)
    if len(rest) == 1:
        for other in described.instead_of if path[0] in LISTED else ():
            holder.pop(other, None)
        holder[rest[0]] = value
        return
    if described.inner:
        _put_whole(described, holder, path, rest[1:], value, faults)
        return
    zero = with_unit(0.0, dimension)  # a pair that is not there yet begins as zeros
    element: object = holder.setdefault(rest[0], [zero, zero])
    for step in rest[1:-1]:
        element = _element(element, step)
    if _element(element, rest[-1]) is None or not isinstance(element, list):
        faults.add(key, f"there is no element {'.'.join(rest[1:])} in it", shown(holder[rest[0]]))
    else:
        element[int(rest[-1])] = value


def _put_whole(
    key: Key, holder: dict[str, Any], path: tuple[str, ...], steps: tuple[str, ...], value: object, faults: Faults
) -> None:
    """A whole table in place of the one that the last steps of the path lead to."""
    name = path[-1 - len(steps)]
    if key.form == LAYERS and len(steps) == 1:
        layers = holder.setdefault(name, {})
        if isinstance(layers, dict):
            layers[steps[0]] = value
        return
    _, words = _inside(key, holder, path[: len(path) - len(steps)], steps)
    if words:
        faults.add(".".join(path), words)
        return
    elements = holder[name] if key.form == TABLES_LISTED else holder[name][steps[0]]
    if isinstance(elements, list):
        elements[int(steps[-1])] = value


def paths_of(mapping: Mapping[str, Any]) -> dict[str, str | float]:
    """Every dotted path of a scene's mapping that `--set` can change and that leads to one value, with that value."""
    found: dict[str, str | float] = {}

    def enter(path: tuple[str, ...], value: object) -> None:
        inside = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, list) else ()
        for step, one in inside:
            enter((*path, str(step)), one)
        if isinstance(value, str | int | float):
            found[".".join(path) if path[0] in DOTTED else dotted(path)] = value

    enter((), {name: value for name, value in mapping.items() if name not in ("lock", "expect")})
    return found


def _holder(mapping: dict[str, Any], path: tuple[str, ...], faults: Faults) -> tuple[dict[str, Any] | None, tuple[str, ...]]:
    """The table that holds the key, and the rest of the path from the key on.

    None after a fault, and where something else stands in the table's place: that is refused when the scene is read.
    """
    keys, holder, rest = SECTIONS, mapping, path
    while True:
        key = keys[rest[0]]
        steps = steps_into(key, rest[1:])
        if not key.inner or len(rest) <= 1 + steps:
            return holder, rest
        found, words = _inside(key, holder, path[: len(path) - len(rest) + 1], rest[1 : 1 + steps])
        if words:
            faults.add(".".join(path), words)
        if not isinstance(found, dict):
            return None, ()
        keys, holder, rest = key.inner, found, rest[1 + steps :]


def _inside(key: Key, holder: dict[str, Any], path: tuple[str, ...], steps: tuple[str, ...]) -> tuple[object, str]:
    """The table that the steps lead to from the key at `path` of `holder`, or what is said where there is none."""
    name = path[-1]
    if key.form == TABLE:
        return holder.setdefault(name, {}), ""
    if key.form == NUMBER_OR_TABLE:  # a number becomes the required entry of the table
        if not isinstance(holder.get(name, {}), dict):
            holder[name] = {next(inner for inner, one in key.inner.items() if one.required): holder[name]}
        return holder.setdefault(name, {}), ""
    if key.form == LAYERS:  # a layer that has none yet gets an empty table
        layers = holder.setdefault(name, {})
        entry = layers.setdefault(steps[0], {}) if isinstance(layers, dict) else None
        many = f": it has {len(entry)} entries, counted from 0" if isinstance(entry, list) else ""
        entry = _element(entry, steps[1]) if len(steps) > 1 else entry
        return entry, "" if isinstance(entry, dict) else f"there is no such table under adjust{many}"
    if key.form == NAMED_TABLES:
        named = holder.setdefault(name, {}) if name == "tolerances" else holder.get(name, {})
        if name == "tolerances" and isinstance(named, dict):
            named.setdefault(steps[0], {})  # a tolerance of what has none yet; nonsense is found where it is read
        if not isinstance(named, dict) or steps[0] in named:
            return named[steps[0]] if isinstance(named, dict) else None, ""
        return None, f'there is no "{steps[0]}" in {name}. {nearest(steps[0], named)}'
    elements = holder.get(name, [])
    many = str(len(elements)) if isinstance(elements, list) else "0"
    if key.inner is TRAIN and _element(elements, steps[0]) is None:
        return None, f"the train has no wheel {steps[0]}: there are {many}, counted from 0"
    if isinstance(elements, list) and _element(elements, steps[0]) is None:
        return None, f"{'.'.join(path)} has no entry {steps[0]}: there are {many}, counted from 0"
    return _element(elements, steps[0]), ""


def _element(elements: object, step: str) -> object:
    """The element of that number; None where there is none."""
    inside = isinstance(elements, list) and step.isdigit() and int(step) < len(elements)
    return elements[int(step)] if isinstance(elements, list) and inside else None


def motion_of(bodies: object, name: object) -> str:
    """The motion a body asks for, "pivot" where it says nothing readable."""
    entry = bodies.get(name) if isinstance(bodies, Mapping) and isinstance(name, str) else None
    motion = entry.get("motion", "pivot") if isinstance(entry, Mapping) else "pivot"
    if motion == DRIVEN:
        return "slide" if isinstance(entry, Mapping) and "axis" in entry else "pivot"
    return motion if motion in MOTIONS else "pivot"


def dimension_of(scene: Scene, key: str) -> Dimension | None:
    """What kind of quantity the scene holds at a dotted path; None where it is no quantity, or there is no such path."""
    path = words_of(key)
    if path[0] == DESIGN and len(path) == 2:
        return _of_design(scene, path[1])
    found = key_at(path)
    if found is None:
        return None
    name: object = path[1] if path[0] in NAMED else None
    if path[0] in LISTED:
        entries = scene.source.get(path[0], [])
        number = int(path[1]) if path[1].isdigit() else len(entries)
        name = entries[number].get("body") if number < len(entries) else None
    return found.dimension_for(motion_of(scene.source.get("bodies", {}), name))


def _of_design(scene: Scene, name: str) -> Dimension | None:
    """What a dimension of the scene's design measures: a scene that is made from one holds all of them with their units."""
    table = scene.source.get(DESIGN)
    value = table.get(name) if isinstance(table, dict) else None
    try:
        powers = known_unit(split(value)[1]).powers
    except UnitError:
        return None
    return next((one for one in DIMENSIONS if powers in one.powers), None)


def with_unit(value: object, dimension: Dimension | None) -> object:
    """Numbers get the SI unit of their key, so that they are checked like everything in a file."""
    if isinstance(value, (list, tuple)):
        return [with_unit(item, dimension) for item in value]
    if isinstance(value, bool) or not isinstance(value, Real):
        return value
    if dimension is None or dimension is NUMBER:
        return int(value) if isinstance(value, int) else float(value)
    return f"{float(value)!r} {dimension.si}"


def _advice(path: tuple[str, ...]) -> str:
    """What to write instead of a path that leads to no key."""
    section = path[0]
    if section not in SECTIONS:
        home = next((name for name, keys in TABLES.items() if section in keys), None)
        return f'Did you mean "{home}.{section}"?' if home else nearest(section, SECTIONS)
    if section == "lock":
        return "watchsim writes this table; it cannot be changed."
    if section == "design":
        written_out = "This scene has no [design]: its bodies, springs, torques and contacts are written out"
        return f"{written_out}. Change a key of these, or start from a design: watchsim new swiss_lever"
    _, keys, at = entered(path)
    if at:
        return nearest(path[at], keys)
    if section == "expect":
        what = ".".join((*path, "amplitude")[:2])
        return f"Write {what}.value and {what}.tolerance, one by one."
    if section in LISTED:
        return f"Write {section}.NUMBER.KEY, the number counted from 0."
    return "Write bodies.NAME.KEY, with the name of a body." if section == "bodies" else nearest("", keys)
