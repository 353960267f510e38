"""How is one value of a scene changed, from Python or by KEY=VALUE on the command line?"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping

from watchsim.mechanism.assign import assign
from watchsim.mechanism.errors import Fault, Faults, SceneError
from watchsim.mechanism.load import from_mapping
from watchsim.mechanism.parsed import parsed
from watchsim.mechanism.scene import Scene


def changed(scene: Scene, changes: Mapping[str, object]) -> Scene:
    """The scene with those dotted keys changed and everything checked again; SceneError lists what does not fit."""
    if scene.written is not None:
        later = {**scene.written.changes, **changes}
        faults = Faults(str(scene.path) if scene.path else "scene", changed=frozenset(later))
        return from_mapping(scene.written.mapping, scene.path, faults, later)
    mapping = copy.deepcopy(scene.source)
    faults = Faults(str(scene.path) if scene.path else "scene", changed=frozenset(changes))
    for key, value in changes.items():
        assign(mapping, key, value, faults)
    faults.raise_any()
    return from_mapping(mapping, scene.path, faults)


def assignments(texts: Iterable[str]) -> dict[str, object]:
    """{"torques.0.value": "-1.2 µN·m"} from "torques.0.value=-1.2 µN·m"; lists are written as in the file."""
    found: dict[str, object] = {}
    for text in texts:
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not key or not value:
            raise SceneError([Fault(text, 'write KEY=VALUE, such as "torques.0.value=-1.2 µN·m"', place="--set")])
        found[key] = _literal(text, value) if value[0] in "[{\"'" else value
    return found


def _literal(text: str, value: str) -> object:
    try:
        return parsed(f"value = {value}")["value"]
    except ValueError:
        raise SceneError([Fault(text, "the value is not a list or text as in a scene file", place="--set")]) from None
