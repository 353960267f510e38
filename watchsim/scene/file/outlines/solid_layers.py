"""Which layers do the solids of a body name, and what for?

Asked before the solids are read, because what is drawn there is no outline that could touch: the table may hold anything.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


def set_apart(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that solids name for sections, axes and hairsprings."""
    for solid in _entries(mapping):
        if "turned" in solid or solid.get("hairspring") is True:
            yield from (name for name in (solid.get("layer"), solid.get("turned")) if isinstance(name, str))


def weighed(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that decide the mass: those of solids and of their bores."""
    for solid in _entries(mapping):
        yield from (name for name in (solid.get("layer"), *_texts(solid.get("bores"))) if isinstance(name, str))


def bored(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers that plates name as their bores."""
    for solid in _entries(mapping):
        yield from _texts(solid.get("bores"))


def hollow(mapping: Mapping[str, Any]) -> Iterator[str]:
    """The layers of bores that nothing fills: no solid is made of them, and `layers` does not ask for them."""
    made_of = {solid.get("layer") for solid in _entries(mapping) if isinstance(solid.get("layer"), str)}
    filled = made_of.union(_texts(mapping.get("layers")))
    yield from (name for name in bored(mapping) if name not in filled)


def _entries(mapping: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    solids = mapping.get("solids")
    yield from (solid for solid in (solids if isinstance(solids, (list, tuple)) else ()) if isinstance(solid, Mapping))


def _texts(value: object) -> list[str]:
    return [item for item in value if isinstance(item, str)] if isinstance(value, (list, tuple)) else []
