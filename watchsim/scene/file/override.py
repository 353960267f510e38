"""Which keys and values does KEY=VALUE on the command line name?"""

from __future__ import annotations

from collections.abc import Iterable

from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.file.parsed import parsed


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
