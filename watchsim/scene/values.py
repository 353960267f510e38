"""What do the values of one TOML table mean?

A view of one table that turns values into SI numbers and notes every fault with its dotted key. A value that could not
be read comes back as NaN, which fails no comparison made afterwards: one mistake gives one fault.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from watchsim import units
from watchsim.geometry.primitives import Point
from watchsim.scene.errors import Faults
from watchsim.scene.keys import Keys, belongs, closest, nearest
from watchsim.scene.toml import value_text
from watchsim.units import NUMBER, Dimension, UnitError, parse

NAN = math.nan
FURTHEST = 1e9  # m or rad: beyond, the places of what is a micrometre small are lost to rounding
LARGEST, TOO_LARGE = 1e50, "is too large to compute with"  # SI: products and powers of what is read must stay numbers
MOST_UNKNOWN = 100  # unknown keys of one table that are looked up and reported one by one
UNREADABLE: Point = (NAN, NAN)


def shown(value: object) -> str:
    """' = value' as it stands in the file, shortened."""
    try:
        text = value_text(value)
    except (TypeError, ValueError):  # a number of thousands of digits
        text = repr(value)
    return f" = {shortened(text)}"


def shortened(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def understood(mapping: Mapping[str, Any], keys: Iterable[str], what: str, path: str, faults: Faults) -> dict[str, Any]:
    """The mapping with misspelt names put right: each is noted, and all else is read as it was meant.

    Of very many unknown names the first are noted, the others counted and left out.
    """
    found: dict[str, Any] = {}
    unknown = [key for key in mapping if key not in keys]
    beyond = frozenset(unknown[MOST_UNKNOWN:])
    if beyond:
        where = f"{path}{unknown[MOST_UNKNOWN]}"
        faults.add(where, f"unknown {what}, and {len(beyond) - 1} more after it. Known here: {', '.join(keys)}")
    for key, value in mapping.items():
        if key in beyond:
            continue
        meant = key if key in keys else closest(key, [one for one in keys if one not in mapping and one not in found])
        if key not in keys:
            homes = "" if meant else belongs(key)
            faults.add(f"{path}{key}", f"unknown {what}. {homes or nearest(key, keys)}")
            if meant:
                faults.spelt[f"{path}{meant}"] = f"{path}{key}"
        found[meant or key] = value
    return found


class Table:
    """One table of the scene at the dotted `path`; unknown keys are noted as soon as it is made."""

    def __init__(self, mapping: object, path: str, keys: Keys, faults: Faults, motion: str = "pivot") -> None:
        self.mapping = understood(mapping, keys, "key", f"{path}.", faults) if isinstance(mapping, dict) else {}
        self.is_table = isinstance(mapping, dict)  # otherwise that has been noted, and is enough
        self.path, self.keys, self.faults, self.motion = path, keys, faults, motion
        if not self.is_table:
            faults.add(path, "a table of keys is needed here", shown(mapping))

    def __contains__(self, key: str) -> bool:
        return key in self.mapping

    def fault(self, key: str, message: str, with_value: bool = False) -> None:
        """Notes a fault at `key` of this table; an empty key means the table itself."""
        path = f"{self.path}.{key}" if key else self.path
        self.faults.add(path, message, shown(self.mapping.get(key)) if with_value else "")

    def text(self, key: str, default: str = "") -> str:
        value = self.mapping.get(key, default)
        if isinstance(value, str):
            return value
        self.fault(key, "a text in quotes is needed here", with_value=True)
        return default

    def needed_text(self, key: str, example: str) -> str:
        if key not in self:
            self.fault(key, f'missing. Write e.g. {key} = "{example}"')
        return self.text(key)

    def lacks(self, example: str, *also: str) -> bool:
        """Notes the required keys, and those `also` needed here, that are not there, all in one fault."""
        needed = dict.fromkeys((*(key for key, one in self.keys.items() if one.required), *also))
        missing = [key for key in needed if key not in self]
        if missing and self.is_table:
            self.fault("", f"missing: {', '.join(missing)}. Write e.g. {example}")
        return bool(missing)

    def one_of(self, key: str, default: str, choices: Sequence[str] = ()) -> str:
        """One of the choices of the key; after a fault the one that was probably meant, so that all else is read by it, or ""
        where none is near."""
        value, choices = self.mapping.get(key, default), choices or self.keys[key].choices
        if value in choices:
            return str(value)
        meant = closest(value, choices) if isinstance(value, str) else None
        hint = f' Did you mean "{meant}"?' if meant else ""
        quoted = "" if isinstance(value, str) else ": a text in quotes is needed here"
        self.fault(key, f"not one of {', '.join(choices)}{quoted}.{hint}", with_value=True)
        return meant or ""

    def note_motion(self, motion: str) -> None:
        """Notes the keys that are for bodies of another motion."""
        for key, one in self.keys.items():
            if key in self and one.motions and motion not in one.motions:
                others = " or ".join(f'"{other}"' for other in one.motions)
                self.fault(key, f"belongs to motion = {others}{one.beside}")

    def texts(self, key: str, example: str = "TEETH") -> tuple[str, ...]:
        value = self.mapping.get(key, [])
        if isinstance(value, (list, tuple)) and all(isinstance(item, str) for item in value):
            return tuple(value)
        self.fault(key, f'a list of texts is needed here, such as {key} = ["{example}"]', with_value=True)
        return ()

    def names(self, key: str, numbers: Sequence[int], needed: str, twice: bool = False) -> tuple[str, ...]:
        """So many texts in a list, different ones unless one may stand there `twice`; none after a fault."""
        value = self.mapping.get(key)
        texts = value if isinstance(value, (list, tuple)) and all(isinstance(item, str) for item in value) else ()
        if len(texts) in numbers and (twice or len(set(texts)) == len(texts)):
            return tuple(texts)
        if self.is_table:
            self.fault(key if key in self else "", needed, with_value=key in self)
        return ()

    def tables(self, key: str) -> list[Any]:
        value = self.mapping.get(key, [])
        if isinstance(value, (list, tuple)):
            return list(value)
        self.fault(key, f"a list of tables is needed here: write [[{self.path}.{key}]] with double brackets")
        return []

    def dimension(self, key: str) -> Dimension:
        return self.keys[key].dimension_for(self.motion) or NUMBER

    def quantity(self, key: str, default: float | None = None) -> float:
        """The SI value of one number within its limits, NaN where it is not or cannot be read; the key's default where it is
        absent."""
        if key not in self:
            return self.keys[key].default if default is None else default
        return self.within(key, self.parsed(key, self.mapping[key], self.dimension(key)))

    def within(self, key: str, value: float) -> float:
        """The value of the key; NaN, and a fault, where it is out of its limits."""
        for limit in () if math.isnan(value) else self.keys[key].limits:
            if not limit.holds(value):
                self.fault(key, limit.message, with_value=True)
                return NAN
        return value

    def pair(self, key: str, default: Point = (0.0, 0.0)) -> Point:
        return self.point(key, self.mapping[key], self.dimension(key)) if key in self else default

    def point(self, path: str, value: object, dimension: Dimension) -> Point:
        """Two numbers in a list, at `path` below this table."""
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            self.faults.add(
                f"{self.path}.{path}", f"two values are needed here, such as {_pair_example(dimension)}", shown(value)
            )
            return UNREADABLE
        first, second = (self.parsed(f"{path}.{i}", item, dimension) for i, item in enumerate(value))
        return (first, second)

    def parsed(self, path: str, value: object, dimension: Dimension) -> float:
        try:
            number = parse(value, dimension)
            if abs(number) <= (FURTHEST if dimension in (units.LENGTH, units.ANGLE) else LARGEST):
                return number
            self.faults.add(f"{self.path}.{path}", TOO_LARGE, shown(value))
        except UnitError as error:
            self.faults.add(f"{self.path}.{path}", str(error), shown(value))
        return NAN


def _pair_example(dimension: Dimension) -> str:
    unit = dimension.usual[1]
    return "[1.0, 0.0]" if dimension is NUMBER else f'["1 {unit}", "0 {unit}"]'


def listed(mapping: Mapping[str, Any], section: str, faults: Faults) -> list[Any]:
    """The elements of an array of tables; a single table in its place is a fault."""
    value = mapping.get(section, [])
    if isinstance(value, (list, tuple)):
        return list(value)
    faults.add(
        section,
        f"write [[{section}]] with double brackets: there can be several",
        "" if isinstance(value, dict) else shown(value),
    )
    return []
