"""How is the value at one dotted path of a scene's mapping changed?"""

from __future__ import annotations

from numbers import Real
from typing import Any

from watchsim.scene.errors import Faults
from watchsim.scene.keys import LISTED, SECTIONS, TABLES, WITHIN, key_at, nearest, siblings
from watchsim.scene.read_bodies import motion_of
from watchsim.scene.values import shown
from watchsim.units import NUMBER, Dimension

# Keys that say the same thing: setting one takes the others away.
INSTEAD_OF = {
    "frequency": ("stiffness", "leaf"),
    "stiffness": ("frequency", "leaf"),
    "leaf": ("frequency", "stiffness"),
    "rest": ("preload",),
    "preload": ("rest",),
    "q_factor": ("viscous",),
    "viscous": ("q_factor",),
    "value": ("table", "over", "period", "ratio", "efficiency", "run_down", "train"),
}

Entered = tuple[dict[str, Any] | None, tuple[str, ...]]  # a table of the mapping, and the path within it


def assign(mapping: dict[str, Any], key: str, value: object, faults: Faults) -> None:
    path = tuple(key.split("."))
    described = key_at(path)
    if described is None or path[0] == "lock":
        faults.add(key, f"unknown key. {_advice(path)}", shown(value))
        return
    holder, rest = _enter(mapping, path, faults)
    if not isinstance(holder, dict):
        return
    dimension = described.dimension_for(motion_of(mapping.get("bodies", {}), _body_name(path, holder)))
    in_si = with_unit(value, dimension)
    if len(rest) == 1:
        for other in INSTEAD_OF.get(rest[0], ()) if path[0] in LISTED else ():
            holder.pop(other, None)
        holder[rest[0]] = in_si
    else:
        _assign_element(holder, rest, in_si, (key, dimension, faults))


def _enter(mapping: dict[str, Any], path: tuple[str, ...], faults: Faults) -> Entered:
    """The table that holds the key, and the rest of the path from the key on.

    None after a fault, and where something else stands in the table's place: that is refused when the scene is read.
    """
    section, key = path[0], ".".join(path)
    if section in TABLES:
        return mapping.setdefault(section, {}), path[1:]
    if section in LISTED:
        return _enter_element(section, mapping.get(section, []), path[1:], key, faults)
    named = mapping.get(section, {})
    if not isinstance(named, dict):
        return None, ()
    if path[1] not in named:
        faults.add(key, f'there is no "{path[1]}" in {section}. {nearest(path[1], named)}')
        return None, ()
    holder, rest = named[path[1]], path[2:]
    if isinstance(holder, dict) and rest[0] == "solids" and len(rest) > 1:
        return _enter_element(f"bodies.{path[1]}.solids", holder.get("solids", []), rest[1:], key, faults)
    return _enter_within(section, holder, rest, key, faults)


def _enter_element(name: str, elements: object, rest: tuple[str, ...], key: str, faults: Faults) -> Entered:
    """The table for one element of a list of tables."""
    if not isinstance(elements, list):
        return None, ()
    if not rest[0].isdigit() or int(rest[0]) >= len(elements):
        faults.add(key, f"{name} has no entry {rest[0]}: there are {len(elements)}, counted from 0")
        return None, ()
    return _enter_within(name, elements[int(rest[0])], rest[1:], key, faults)


def _enter_within(section: str, holder: object, rest: tuple[str, ...], key: str, faults: Faults) -> Entered:
    """The table within an entry where the path goes on into one."""
    if not isinstance(holder, dict):
        return None, ()
    if rest[0] == "adjust" and len(rest) > 1:
        return _enter_adjust(holder, rest, key, faults)
    if rest[0] == "train" and len(rest) > 2:
        return _enter_train(holder, rest, key, faults)
    if (section, rest[0]) not in WITHIN or len(rest) == 1:
        return holder, rest
    return holder.setdefault(rest[0], {}), rest[1:]


def _enter_train(holder: dict[str, Any], rest: tuple[str, ...], key: str, faults: Faults) -> Entered:
    """The table for one wheel of a train."""
    wheels = holder.get("train")
    inside = isinstance(wheels, list) and rest[1].isdigit() and int(rest[1]) < len(wheels)
    if isinstance(wheels, list) and inside:
        return wheels[int(rest[1])], rest[2:]
    many = len(wheels) if isinstance(wheels, list) else 0
    faults.add(key, f"the train has no wheel {rest[1]}: there are {many}, counted from 0")
    return None, ()


def _enter_adjust(holder: dict[str, Any], rest: tuple[str, ...], key: str, faults: Faults) -> Entered:
    """The table for one layer of a drawing, or for one outline of it; a layer that has none yet gets an empty one."""
    layers = holder.setdefault("adjust", {})
    if len(rest) == 2 and isinstance(layers, dict):
        return layers, rest[1:]
    entry = layers.setdefault(rest[1], {}) if isinstance(layers, dict) else None
    after = rest[2:] or ("",)
    many = f": it has {len(entry)} entries, counted from 0" if isinstance(entry, list) else ""
    if after[0].isdigit() and len(after) > 1:
        inside = isinstance(entry, list) and int(after[0]) < len(entry)
        entry, after = (entry[int(after[0])] if isinstance(entry, list) and inside else None), after[1:]
    if isinstance(entry, dict):
        return entry, after
    faults.add(key, f"there is no such table under adjust{many}")
    return None, ()


def _assign_element(
    holder: dict[str, Any], rest: tuple[str, ...], value: object, about: tuple[str, Dimension | None, Faults]
) -> None:
    """Sets one element of a list such as position.1; a pair that is not there yet begins as zeros."""
    key, dimension, faults = about
    zero = with_unit(0.0, dimension)
    element = holder.setdefault(rest[0], [zero, zero])
    for step in rest[1:-1]:
        element = _step(element, step)
    if not isinstance(element, list) or not rest[-1].isdigit() or int(rest[-1]) >= len(element):
        faults.add(key, f"there is no element {'.'.join(rest[1:])} in it", shown(holder[rest[0]]))
        return
    element[int(rest[-1])] = value


def _step(element: object, step: str) -> object:
    inside = isinstance(element, list) and step.isdigit() and int(step) < len(element)
    return element[int(step)] if isinstance(element, list) and inside else None


def _body_name(path: tuple[str, ...], holder: dict[str, Any]) -> object:
    return path[1] if path[0] == "bodies" else holder.get("body")


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
    if path[0] not in SECTIONS:
        home = next((name for name, keys in TABLES.items() if path[0] in keys), None)
        return f'Did you mean "{home}.{path[0]}"?' if home else nearest(path[0], SECTIONS)
    if path[0] == "lock":
        return "watchsim writes this table; it cannot be changed."
    if path[0] == "design":
        return "This scene has no [design]: its bodies, springs, torques and contacts are written out. Change a key of these."
    depth = 1 if path[0] in TABLES else 2
    if path[2:3] in (("solids",), ("adjust",)) and len(path) > 4:
        depth = 5 if path[2] == "adjust" and path[4].isdigit() and len(path) > 5 else 4
    if (path[0], *path[2:3]) in WITHIN and len(path) > 3:
        depth = 3
    if len(path) <= depth:
        if path[0] == "expect":
            what = ".".join((*path, "amplitude")[:2])
            return f"Write {what}.value and {what}.tolerance, one by one."
        if path[0] in LISTED:
            return f"Write {path[0]}.NUMBER.KEY, the number counted from 0."
        return "Write bodies.NAME.KEY, with the name of a body." if path[0] == "bodies" else nearest("", siblings(path))
    return nearest(path[depth], siblings(path))
