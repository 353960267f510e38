"""What do the values of one TOML table mean?

A view of one table that turns values into SI numbers and notes every fault with its dotted key. A value that could not
be read comes back as NaN, which fails no comparison made afterwards: one mistake gives one fault.
"""

from __future__ import annotations

import hashlib
import math
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from watchsim import units
from watchsim.geometry.primitives import Point
from watchsim.scene.errors import Faults
from watchsim.scene.keys import Keys, belongs, closest, nearest
from watchsim.scene.write_toml import value_text
from watchsim.units import NUMBER, Dimension, UnitError, parse

# By which digest is a drawing recognised?


def file_digest(path: Path) -> str:
    """SHA-256 of the file, hexadecimal."""
    return digest(path.read_bytes())


def digest(data: bytes) -> str:
    """SHA-256, hexadecimal."""
    return hashlib.sha256(data).hexdigest()


# Which mapping does a TOML text hold?

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


# On which line of a TOML file does a key stand?
#
# The TOML reader of the standard library forgets lines, and a fault without its line must be searched by hand. This scanner
# expects text that is valid TOML and notes where each dotted key begins; elements of arrays count as "key.0", "key.1".

_STRING = r'"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\''
_TOKEN = re.compile(
    rf"(?P<comment>#[^\n]*)|(?P<string>{_STRING})|(?P<newline>\n)|(?P<mark>[\[\]{{}}=,.])|(?P<bare>[^\s\[\]{{}}=,.#\"']+)", re.S
)


def key_lines(text: str) -> dict[str, int]:
    """Dotted key -> line (from 1) of its first character; array tables are numbered: "springs.0.body"."""
    return _Scanner(text).scan()


class _Scanner:
    """Walks over the tokens once; `prefix` is the table that the next key belongs to."""

    def __init__(self, text: str) -> None:
        self.tokens = list(_tokens(text))
        self.at = 0
        self.lines: dict[str, int] = {}
        self.counts: dict[str, int] = {}

    def scan(self) -> dict[str, int]:
        prefix: tuple[str, ...] = ()
        while self.at < len(self.tokens):
            word, line = self.tokens[self.at]
            if word in ("\n", "]"):  # an end of a header
                self.at += 1
            elif word == "[":
                prefix = self._header(line)
            else:
                self._assignment(prefix)
        return self.lines

    def _header(self, line: int) -> tuple[str, ...]:
        is_array = self._word(1) == "["
        self.at += 2 if is_array else 1
        path = self._path("]")
        path = self._numbered(path[:-1]) + path[-1:]
        if is_array:
            key = ".".join(path)
            self.lines.setdefault(key, line)
            self.counts[key] = self.counts.get(key, -1) + 1
            path = (*path, str(self.counts[key]))
        self.lines[".".join(path)] = line
        return path

    def _numbered(self, path: tuple[str, ...]) -> tuple[str, ...]:
        """A header below an array of tables speaks of its last element."""
        full: tuple[str, ...] = ()
        for part in path:
            full = (*full, part)
            count = self.counts.get(".".join(full))
            full = full if count is None else (*full, str(count))
        return full

    def _assignment(self, prefix: tuple[str, ...]) -> None:
        line = self.tokens[self.at][1]
        path = prefix + self._path("=")
        self.at += 1
        self.lines.setdefault(".".join(path), line)
        self._value(path)

    def _path(self, end: str) -> tuple[str, ...]:
        parts = []
        while self._word() != end:
            if self._word() != ".":
                parts.append(_unquoted(self._word()))
            self.at += 1
        return tuple(parts)

    def _value(self, path: tuple[str, ...]) -> None:
        """Steps over a value and notes the elements of arrays and inline tables."""
        opening = self._word()
        if opening not in ("[", "{"):
            while self._word() not in ("\n", ",", "]", "}", ""):
                self.at += 1
            return
        self.at += 1
        index = 0
        while self._word() not in ("]", "}", ""):
            if self._word() in ("\n", ","):
                self.at += 1
            elif opening == "{":
                self._assignment(path)
            else:
                element = (*path, str(index))
                self.lines[".".join(element)] = self.tokens[self.at][1]
                self._value(element)
                index += 1
        self.at += 1

    def _word(self, ahead: int = 0) -> str:
        at = self.at + ahead
        return self.tokens[at][0] if at < len(self.tokens) else ""


def _tokens(text: str) -> list[tuple[str, int]]:
    """(word, line) without comments; blanks vanish, line ends stay."""
    found, line = [], 1
    for match in _TOKEN.finditer(text):
        if match.lastgroup != "comment":
            found.append((match[0], line))
        line += match[0].count("\n")
    return found


def _unquoted(word: str) -> str:
    return word[1:-1] if word[:1] in ("'", '"') else word


# What do the values of one TOML table mean?

NAN = math.nan
FURTHEST = 1e9  # m or rad: beyond, the places of what is a micrometre small are lost to rounding
SMALLEST, LARGEST = 1e-100, 1e50  # SI: products and powers of what is read must stay numbers
TOO_SMALL, TOO_LARGE = "is too small to compute with", "is too large to compute with"
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
    """The mapping with misspelt names put right: each is noted, and all else is read as it was meant."""
    found: dict[str, Any] = {}
    for key, value in mapping.items():
        meant = key if key in keys else closest(key, [one for one in keys if one not in mapping and one not in found])
        if key not in keys:
            homes = "" if meant else belongs(key)
            faults.add(f"{path}{key}", f"unknown {what}. {homes or nearest(key, keys)}")
            faults.spelt |= {f"{path}{meant}": f"{path}{key}"} if meant else {}
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

    def lacks(self, keys: Iterable[str], example: str) -> bool:
        """Notes the keys that are not there, all in one fault."""
        missing = [key for key in keys if key not in self]
        if missing and self.is_table:
            self.fault("", f"missing: {', '.join(missing)}. Write e.g. {example}")
        return bool(missing)

    def one_of(self, key: str, choices: Sequence[str], default: str) -> str:
        """One of the words; after a fault the one that was probably meant, so that all else is read by it, or "" where none is
        near."""
        value = self.mapping.get(key, default)
        if value in choices:
            return str(value)
        meant = closest(value, choices) if isinstance(value, str) else None
        hint = f' Did you mean "{meant}"?' if meant else ""
        quoted = "" if isinstance(value, str) else ": a text in quotes is needed here"
        self.fault(key, f"not one of {', '.join(choices)}{quoted}.{hint}", with_value=True)
        return meant or ""

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

    def quantity(self, key: str, default: float = 0.0) -> float:
        """The SI value of one number, `default` where the key is absent, NaN where it cannot be read."""
        return self.parsed(key, self.mapping[key], self.dimension(key)) if key in self else default

    def positive(self, key: str, why: str) -> float:
        """A quantity that must be above zero; NaN where it is not."""
        value = self.quantity(key, NAN)
        if value <= 0.0:
            self.fault(key, f"must be above zero: {why}", with_value=True)
            return NAN
        if value < SMALLEST:
            self.fault(key, TOO_SMALL, with_value=True)
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
