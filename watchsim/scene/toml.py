"""Which mapping does a TOML text hold, on which line does each key stand, and how is a mapping written?

tomllib does not remember lines, and a fault that names no line must be searched by hand. The scanner here expects text that is
valid TOML and notes where each dotted key begins; elements of arrays count as "key.0", "key.1".
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
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


_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(mapping: Mapping[str, Any]) -> str:
    """TOML of nested mappings, lists, texts, numbers and truth values; reading it back gives an equal mapping."""
    return "\n".join(_lines(mapping, "")).strip() + "\n"


def _lines(mapping: Mapping[str, Any], path: str) -> Iterator[str]:
    for key, value in mapping.items():
        if not isinstance(value, Mapping) and not _is_table_list(value):
            yield f"{_key(key)} = {value_text(value)}"
    for key, value in mapping.items():
        full = f"{path}.{_key(key)}" if path else _key(key)
        if isinstance(value, Mapping):
            if not value or any(not isinstance(item, Mapping) and not _is_table_list(item) for item in value.values()):
                yield f"\n[{full}]"
            yield from _lines(value, full)
        elif _is_table_list(value):
            for item in value:
                yield f"\n[[{full}]]"
                yield from _lines(item, full)


def _is_table_list(value: object) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _text(key)


def value_text(value: object) -> str:
    """One value as it stands after the equals sign; TypeError for what TOML cannot hold there."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(value_text(item) for item in value)}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(key)} = {value_text(item)}' for key, item in value.items())} }}" if value else "{}"
    raise TypeError(f"TOML cannot hold {type(value).__name__}")


def _text(text: str) -> str:
    # JSON escapes are TOML escapes; only DEL passes JSON unescaped and is forbidden in TOML.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def file_digest(path: Path) -> str:
    """SHA-256 of the file, hexadecimal."""
    return digest(path.read_bytes())


def digest(data: bytes) -> str:
    """SHA-256, hexadecimal."""
    return hashlib.sha256(data).hexdigest()
