"""Which records does this DXF file hold?

A DXF file is a long list of pairs, a group code and a value; code 0 begins a record. Nothing is interpreted here, but
the list must be whole: every fault says where it is. Binary files are decoded by ezdxf.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

BINARY_MARK = b"AutoCAD Binary DXF"
LARGEST = 1e11  # drawing units; larger numbers are damage, and squares of them would lose the small ones
_ESCAPE = re.compile(r"\\U\+([0-9A-Fa-f]{4})")
_CODEPAGE = re.compile(r"\$DWGCODEPAGE\s+3\s+(?:ANSI_|ansi_|dos)?(\d+)")


class DxfError(ValueError):
    """A file or a record that cannot be read; the message is a sentence for the user."""


@dataclass(frozen=True, slots=True)
class Record:
    """One entity, table entry or marker: everything from a group code 0 up to the next one.

    `place` says where it begins ("line 120"), for messages. All readers raise DxfError for missing or unreadable values.
    """

    kind: str
    codes: Sequence[int]
    values: Sequence[object]
    place: str

    @property
    def name(self) -> str:
        """Type and handle as CAD programs show them: "ARC #4F"; without handle the place in the file."""
        handle = self.text(5)
        return f"{self.kind} #{handle.upper()}" if handle else f"{self.kind} ({self.place})"

    def pairs(self) -> Iterator[tuple[int, object]]:
        return zip(self.codes, self.values, strict=True)

    def text(self, code: int, default: str = "") -> str:
        return decoded(str(self.values[self.codes.index(code)])) if code in self.codes else default

    def integer(self, code: int, default: int = 0) -> int:
        if code not in self.codes:
            return default
        number = as_number(self.values[self.codes.index(code)], code)
        if number != int(number):
            raise DxfError(f"group {code} is {number:g} where a whole number belongs")
        return int(number)

    def number(self, code: int, default: float | None = None) -> float:
        """The value of that group, which may stand only once; DxfError where it is missing and has no default."""
        found = self.codes.count(code)
        if found == 1:
            return as_number(self.values[self.codes.index(code)], code)
        if found == 0 and default is not None:
            return default
        if found == 0:
            raise DxfError(f"group {code} is missing")
        raise DxfError(f"group {code} stands there {found} times; a record boundary seems to be lost")

    def numbers(self, code: int) -> list[float]:
        return [as_number(value, code) for key, value in self.pairs() if key == code]

    def point(self, code: int, default: tuple[float, float, float] | None = None) -> tuple[float, float, float]:
        """The point of groups code, code + 10 and code + 20; only the last may be left out (0)."""
        if default is not None and code not in self.codes:
            return default
        return (self.number(code), self.number(code + 10), self.number(code + 20, 0.0))


@dataclass(frozen=True, slots=True)
class Tags:
    """All whole records of a file.

    `fault` says what ended the reading early, empty for a whole file; `trash` whether something follows EOF, and `beyond` the
    types of the records among it.
    """

    records: tuple[Record, ...]
    fault: str = ""
    trash: bool = False
    beyond: tuple[str, ...] = ()


def as_number(value: object, code: int) -> float:
    """A finite float of sane size, DxfError otherwise."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise DxfError(f'group {code} is "{str(value).strip()[:40]}" where a number belongs') from None
    if not -LARGEST <= number <= LARGEST:
        raise DxfError(f"group {code} is {number:g}, not a sensible number")
    return number


def decoded(text: str) -> str:
    r"""The text with its \U+00B5 escapes replaced."""
    text = text.strip()
    return _ESCAPE.sub(lambda match: chr(int(match[1], 16)), text) if "\\" in text else text


def read_tags(data: bytes) -> Tags:
    """Splits the bytes of a DXF file into records; DxfError if this is not a DXF file at all."""
    if not data.strip():
        raise DxfError("the file is empty")
    if data.startswith(BINARY_MARK):
        return _grouped(*_binary_pairs(data))
    if re.match(rb"AC1\d\d\d", data):
        raise DxfError("this is a DWG file with the ending of a DXF file; save it as DXF in CAD")
    return _grouped(*_text_pairs(_as_text(data)))


def _as_text(data: bytes) -> str:
    """Since 2007 DXF is UTF-8; before that it is written in the code page it names."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        match = _CODEPAGE.search(data[:20000].decode("latin-1"))
    try:
        return data.decode(f"cp{match[1]}" if match else "cp1252", "replace")
    except LookupError:
        return data.decode("latin-1")


def _text_pairs(text: str) -> tuple[list[int], list[object], str, str]:
    """Group codes, values, fault, and the word that counts places."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    codes: list[int] = []
    values: list[object] = list(lines[1::2])
    try:
        codes.extend(map(int, lines[0 : 2 * len(values) : 2]))
    except ValueError:
        at = 2 * len(codes)
        if not codes:
            told = f'this is not a DXF file: it begins with "{_printable(lines[0])}"'
            raise DxfError(f"{told}. Save the drawing as DXF in CAD; another ending does not make it one") from None
        return codes, values, f'line {at + 1} reads "{_printable(lines[at])}" where a group code belongs', "line"
    return codes, values, "", "line"


def _printable(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text.strip()[:30])


def _binary_pairs(data: bytes) -> tuple[list[int], list[object], str, str]:
    """The same for a binary file, as far as it can be decoded."""
    import struct

    from ezdxf.lldxf.const import DXFError
    from ezdxf.lldxf.tagger import binary_tags_loader

    codes: list[int] = []
    values: list[object] = []
    fault = ""
    try:
        for tag in binary_tags_loader(data, errors="replace"):
            codes.append(tag.code)
            values.append(tag.value)
    except (DXFError, IndexError, ValueError, struct.error) as error:
        fault = f"the binary data cannot be decoded after tag {len(codes)} ({error})"
    return codes, values, fault, "tag"


def _grouped(codes: list[int], values: list[object], fault: str, word: str) -> Tags:
    """Records from code 0 to code 0, up to EOF."""
    step = 2 if word == "line" else 1
    starts = [i for i, code in enumerate(codes) if code == 0]
    if not starts:
        raise DxfError(f"this is not a DXF file: {fault or 'it holds no record'}")
    records: list[Record] = []
    for start, stop in zip(starts, [*starts[1:], len(codes)], strict=True):
        kind = str(values[start]).strip().upper()
        if kind == "EOF":
            beyond = tuple(str(values[at]).strip().upper() for at in starts if at > start)
            return Tags(tuple(records), "", bool(fault) or any(str(v).strip() for v in values[start + 1 :]), beyond)
        records.append(Record(kind, codes[start + 1 : stop], values[start + 1 : stop], f"{word} {step * start + 1}"))
    if records[-1].kind not in ("ENDSEC", "SECTION"):
        records.pop()  # it may be cut short
    return Tags(tuple(records), fault or "the file ends without EOF: it is incomplete")
