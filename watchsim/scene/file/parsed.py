"""Which mapping does a TOML text hold?"""

from __future__ import annotations

import sys
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DEEPEST = 20  # tables and lists within each other
TOO_DEEP = f"tables and lists are nested more than {DEEPEST} deep; no scene needs that"


def parsed(text: str) -> dict[str, Any]:
    """The mapping that a TOML text holds; ValueError where it is none, or one that no scene can be."""
    try:
        mapping = tomllib.loads(text)
    except RecursionError:
        raise ValueError(TOO_DEEP) from None
    level: list[Any] = [mapping]
    for _ in range(DEEPEST):
        level = [item for value in level for item in (value.values() if isinstance(value, dict) else value)]
        level = [item for item in level if isinstance(item, (dict, list))]
        if not level:
            return mapping
    raise ValueError(TOO_DEEP)
