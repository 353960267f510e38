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
MOST_BITS = 64  # of a whole number, as TOML promises; thousands of them could not even be shown in a message


def parsed(text: str) -> dict[str, Any]:
    """The mapping that a TOML text holds; ValueError where it is none, or one that no scene can be."""
    try:
        mapping = tomllib.loads(text)
    except RecursionError:
        raise ValueError(TOO_DEEP) from None
    level: list[Any] = [mapping]
    for _ in range(DEEPEST):
        level = [item for value in level for item in (value.values() if isinstance(value, dict) else value)]
        longest = max((item.bit_length() for item in level if isinstance(item, int)), default=0)
        if longest > MOST_BITS:
            raise ValueError(f"holds a whole number of {longest} bits; a number has at most {MOST_BITS}. Write it as 1.0e30")
        level = [item for item in level if isinstance(item, (dict, list))]
        if not level:
            return mapping
    raise ValueError(TOO_DEEP)
