"""What does a scene say that is written over another one?

Tables are merged key by key, bodies by name. Springs and damping are the same entry where they name the same body, torques as
well, contacts where they are between the same two; what has no counterpart is added.
"""

from __future__ import annotations

import copy
from typing import Any

from watchsim.mechanism.assign import INSTEAD_OF
from watchsim.mechanism.schema import LISTED, NAMED, SHAPES, TABLES

INSTEAD = {**INSTEAD_OF, "table": ("value",)}
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
            _over_entries(ours, value)
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


def _over_entries(ours: list[Any], entries: list[Any]) -> None:
    free = list(range(len(ours)))
    for entry in entries:
        at = next((i for i in free if _identity(entry) is not None and _identity(entry) == _identity(ours[i])), None)
        if at is None:
            ours.append(entry)
            continue
        free.remove(at)
        for key in entry:
            for other in INSTEAD.get(key, ()):
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
