"""How is a scene file written again with some of its values changed, comments and order kept?

Each value is replaced on its line, new keys and tables get lines of their own. What is read back must be what was intended;
where that fails the scene is rewritten, without comments.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from watchsim.scene.assign import assign
from watchsim.scene.errors import Faults
from watchsim.scene.keys import LISTED, path_of
from watchsim.scene.load import changed
from watchsim.scene.scene import Scene
from watchsim.scene.toml import key_lines, parsed, toml_text, value_text

_VALUE = r"\"(?:\\.|[^\"\\])*\"|'[^']*'|[^\s,\]\}#]+"


def rewritten(scene: Scene, changes: Mapping[str, str | float]) -> str:
    """The text of the scene's file with the values at those dotted paths; SceneError for paths that lead nowhere."""
    new = changed(scene, changes)
    wanted = copy.deepcopy(new.written.mapping if new.written is not None else new.source)
    if new.written is not None:
        changes = {**new.written.changes, **changes}  # type: ignore[dict-item]
        for key in changes:
            _over_design(wanted, new.source, key, changes[key])
    else:
        faults = Faults("scene")
        for key, value in changes.items():
            assign(wanted, key, value, faults)
        faults.raise_any()
    text = scene.path.read_text(encoding="utf-8-sig") if scene.path is not None and scene.path.is_file() else ""
    try:
        text = _edited(text, wanted)
        kept = parsed(text) == wanted
    except ValueError:
        kept = False
    return text if kept else toml_text(wanted)


def _over_design(mapping: dict[str, Any], whole: Mapping[str, Any], key: str, value: object) -> None:
    """What a scene with a design says for the value: dimensions by name, entries of lists by what they are of."""
    section, name, *rest = path_of(key)
    if section in LISTED:
        entry = whole[section][int(name)]
        same = {one: entry[one] for one in ("between", "body") if one in entry}
        entries = mapping.setdefault(section, [])
        own = next((one for one in entries if {k: one.get(k) for k in same} == same), None)
        if own is None:
            entries.append(own := dict(same))
        own[rest[0]] = entry[rest[0]]
    elif rest:
        mapping.setdefault(section, {}).setdefault(name, {})[rest[0]] = whole[section][name][rest[0]]
    else:
        mapping.setdefault(section, {})[name] = value


def _edited(text: str, wanted: Mapping[str, Any]) -> str:
    """The text, to be read as that mapping, as far as lines and tables can be replaced, added and left out."""
    added: dict[str, Any] = {}
    for key, value in list(_differences(parsed(text), wanted)):
        section, *names = key.split(".")
        if not isinstance(value, Mapping):
            text = _with(text, key, value)
        elif isinstance(wanted[section], list):
            added.setdefault(section, []).append(value)
        elif names:
            added.setdefault(section, {})[".".join(names)] = value
        else:
            added[section] = value
    if not added:
        return text
    return "\n".join(part for part in (text and f"{text.rstrip()}\n", toml_text(added)) if part)


def _differences(old: Any, new: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Key and new value of all that differs, None for what goes."""
    ours, theirs = (dict(enumerate(one)) if isinstance(one, list) else one for one in (old, new))
    yield from ((f"{path}{name}", None) for name in ours if name not in theirs)
    for name, value in theirs.items():
        there = ours.get(name)
        if isinstance(value, (dict, list)) and type(value) is type(there):
            yield from _differences(there, value, f"{path}{name}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            yield from ((f"{path}{name}.{number}", one) for number, one in enumerate(value))
        elif value != there or type(value) is not type(there):
            yield f"{path}{name}", value


def _with(text: str, key: str, value: object) -> str:
    """The text with one value replaced, or a line added to its table or left out; as it is where none of it can be done."""
    lines, found = text.splitlines(keepends=True), key_lines(text)
    table, _, name = key.rpartition(".")
    written = value_text(value)
    if key in found:
        at = found[key] - 1
        if value is None:
            return "".join(lines[:at] + lines[at + 1 :])
        place = _within(lines[at], key, name)
        if place is not None:
            lines[at] = lines[at][: place[0]] + written + lines[at][place[1] :]
        return "".join(lines)
    if table in found:
        lines.insert(found[table], f"{name} = {written}\n")
    return "".join(lines)


def _within(line: str, key: str, name: str) -> tuple[int, int] | None:
    """Where on its line the value begins and ends; an element of a list is found by its number."""
    owner = key.split(".")[-2] if name.isdigit() and "." in key else name
    start = re.search(rf"(?:^|[\s{{,.\"']){re.escape(owner)}[\"']?\s*=\s*", line)
    if start is None:
        return None
    if not name.isdigit():
        value = re.match(_VALUE, line[start.end() :])
        return None if value is None else (start.end(), start.end() + value.end())
    elements = list(re.finditer(_VALUE, line[start.end() :].partition("]")[0].replace("[", " ", 1)))
    if int(name) >= len(elements):
        return None
    one = elements[int(name)]
    return start.end() + one.start(), start.end() + one.end()


def write_scene(scene: Scene, changes: Mapping[str, str | float], folder: Path) -> None:
    """Write scene.toml and the drawings that it names into a folder, as `write_folder` hands it out."""
    made = scene.written.made if scene.written is not None else frozenset()
    names = [name for name in scene.drawings if name not in made]
    moved = {name: f"drawings/{Path(name).name}" for name in names if Path(name).is_absolute() or ".." in Path(name).parts}
    bodies = scene.source.get("bodies", {})
    elsewhere = {
        f"bodies.{body}.drawing": moved[entry["drawing"]] for body, entry in bodies.items() if entry.get("drawing") in moved
    }
    shocks = enumerate(scene.source.get("shocks", ()))
    elsewhere |= {f"shocks.{i}.file": moved[one["file"]] for i, one in shocks if one.get("file") in moved}
    (folder / "scene.toml").write_text(rewritten(scene, {**changes, **elsewhere}), encoding="utf-8")
    for name in names:
        place = folder / moved.get(name, name)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(scene.drawings[name])
