"""On which line of a TOML file does a key stand?

The TOML reader of the standard library forgets lines, and a fault without its line must be searched by hand. This scanner
expects text that is valid TOML and notes where each dotted key begins; elements of arrays count as "key.0", "key.1".
"""

from __future__ import annotations

import re

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
