"""Which records does this DXF file hold?

A DXF file is a long list of pairs, a group code and a value; code 0 begins a record. Nothing is interpreted here, but
the list must be whole: every fault says where it is. Binary files are decoded by ezdxf.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from watchsim.drawing.findings import Finding, words

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
            fault = f'this is not a DXF file: it begins with "{_printable(lines[0])}"'
            raise DxfError(f"{fault}. Save the drawing as DXF in CAD; renaming a file does not make it one") from None
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


# Group codes that an entity may have, after the DXF reference (Autodesk), those of old versions included. Another one is the
# trace of a damaged file: a coordinate may have gone astray with it.

EXTENDED = 1000  # from here on: data of applications, which may hold anything
COMMON = frozenset(
    (
        *(5, 6, 8, 38, 39, 48, 60, 62, 66, 67, 92, 100, 102, 160, 170, 210, 220, 230, 284, 310, 330, 340, 347, 348),
        *(350, 360, 370, 380, 390, 410, 420, 430, 440, 999),
    )
)
OWN = {
    "LINE": frozenset((10, 20, 30, 11, 21, 31)),
    "POINT": frozenset((10, 20, 30, 50)),
    "CIRCLE": frozenset((10, 20, 30, 40)),
    "ARC": frozenset((10, 20, 30, 40, 50, 51)),
    "ELLIPSE": frozenset((10, 20, 30, 11, 21, 31, 40, 41, 42)),
    "LWPOLYLINE": frozenset((10, 20, 30, 40, 41, 42, 43, 70, 90, 91)),
    "POLYLINE": frozenset((10, 20, 30, 40, 41, 70, 71, 72, 73, 74, 75)),
    "VERTEX": frozenset((10, 20, 30, 40, 41, 42, 50, 70, 71, 72, 73, 74, 91)),
    "SEQEND": frozenset((-2,)),
    "INSERT": frozenset((2, 10, 20, 30, 41, 42, 43, 44, 45, 50, 70, 71)),
    "SPLINE": frozenset((10, 20, 30, 11, 21, 31, 12, 22, 32, 13, 23, 33, 40, 41, 42, 43, 44, 70, 71, 72, 73, 74)),
}


def strange_codes(record: Record) -> list[int]:
    """The codes that do not belong to this type of entity, ascending."""
    strange = set(record.codes) - COMMON - OWN[record.kind] if record.kind in OWN else ()
    return sorted(code for code in strange if code < EXTENDED)


SECTIONS = words("HEADER CLASSES TABLES BLOCKS ENTITIES OBJECTS THUMBNAILIMAGE ACDSDATA")
DRAWN = words("LINE POINT CIRCLE ARC ELLIPSE LWPOLYLINE SPLINE POLYLINE VERTEX SEQEND INSERT TEXT")
OF_SECTION = frozenset((2, 999))  # groups of the record that begins a section
FROZEN = 1


@dataclass(frozen=True, slots=True)
class Block:
    """A named group of entities; `base` is the point that an INSERT puts in place."""

    head: Record
    entities: tuple[Record, ...]


@dataclass(frozen=True, slots=True)
class Layer:
    """A layer's spelling and whether it is shown."""

    name: str
    frozen: bool = False
    off: bool = False


@dataclass(frozen=True)
class Sections:
    """The parts of a file; layer and block names in lower case, as the format ignores case."""

    insunits: int = 0
    layers: dict[str, Layer] = field(default_factory=dict)
    blocks: dict[str, Block] = field(default_factory=dict)
    entities: tuple[Record, ...] = ()
    findings: tuple[Finding, ...] = ()


def divide(tags: Tags) -> Sections:
    """Header variables, layers, blocks and the entities of model space; old and minimal files have entities only.

    Whatever is incomplete becomes a finding of severity "error".
    """
    findings: list[Finding] = []
    parts = _sections(tags, findings)
    insunits = 0
    try:
        insunits = _header_integer(parts.get("HEADER", []), "$INSUNITS")
    except DxfError as error:
        findings.append(Finding("damaged", "error", f"$INSUNITS in the header cannot be read: {error}"))
    layers = _layers(parts.get("TABLES", []), findings)
    blocks = _blocks(parts.get("BLOCKS", [])[1:], findings)
    return Sections(insunits, layers, blocks, tuple(parts.get("ENTITIES", [])[1:]), tuple(findings))


def _sections(tags: Tags, findings: list[Finding]) -> dict[str, list[Record]]:
    """Section name -> its records, the SECTION record first."""
    parts: dict[str, list[Record]] = {}
    inside: list[Record] | None = None
    name = ""
    for record in tags.records:
        if record.kind == "SECTION":
            if inside is not None:
                findings.append(_unclosed(name, inside))
            name = record.text(2).upper()
            if name not in SECTIONS:
                findings.append(_lost(record, f'it begins a section "{name}", which DXF does not have'))
            elif name in ("TABLES", "BLOCKS", "ENTITIES") and set(record.codes) - OF_SECTION:
                findings.append(_lost(record, f"section {name} begins with groups of something else: an entity may be lost"))
            inside = parts.setdefault(name, [])
            inside.append(record)
        elif record.kind == "ENDSEC":
            if inside is None:
                findings.append(_lost(record, "it ends a section that never began"))
            inside = None
        elif inside is None:
            findings.append(_lost(record, "it stands outside all sections"))
        elif record.kind in DRAWN and name not in ("ENTITIES", "BLOCKS"):
            findings.append(_lost(record, f"it stands in section {name}, where nothing is drawn"))
        else:
            inside.append(record)
    if tags.fault:
        findings.append(_truncated(tags))
    elif inside is not None:
        findings.append(_unclosed(name, inside))
    if lost := [kind for kind in tags.beyond if kind in DRAWN]:
        message = f"the file ends (EOF) and goes on after its end with {len(lost)} entities ({lost[0]}); these were not read"
        findings.append(Finding("trash", "error", message, "Export it again from CAD: it is damaged or two files in one."))
    elif tags.trash:
        findings.append(Finding("trash", "notice", "what follows EOF was not read"))
    return parts


def _truncated(tags: Tags) -> Finding:
    whole = next((r for r in reversed(tags.records) if r.kind not in ("SECTION", "ENDSEC")), None)
    last = f"The last whole record is {whole.name}, {whole.place}. " if whole else "Not one record is whole. "
    fix = "Export it again from CAD, or copy it again: the file is incomplete or damaged."
    return Finding("truncated", "error", f"{tags.fault}. {last}What comes after is missing.", fix)


def _unclosed(name: str, records: list[Record]) -> Finding:
    message = f"section {name} has no ENDSEC; its last record is {records[-1].name}, {records[-1].place}"
    return Finding("truncated", "error", message, "Export the file again from CAD: something is missing here.")


def _lost(record: Record, why: str) -> Finding:
    return Finding("damaged", "error", f"{record.kind} at {record.place}: {why}", "Export the file again from CAD.")


def _header_integer(records: list[Record], variable: str) -> int:
    """The value after the variable's name; 0 where it is absent. The header has no records, only pairs."""
    for record in records[:1]:
        values = [str(value).strip() for value in record.values]
        if variable in values:
            at = values.index(variable)
            following = Record("", record.codes[at + 1 : at + 2], record.values[at + 1 : at + 2], record.place)
            if list(following.codes) != [70]:
                raise DxfError("it is not followed by its value (group 70)")
            return following.integer(70)
    return 0


def _layers(records: list[Record], findings: list[Finding]) -> dict[str, Layer]:
    layers: dict[str, Layer] = {}
    for record in records:
        if record.kind == "LAYER" and 2 in record.codes:
            name = record.text(2)
            try:
                layers[name.lower()] = Layer(name, bool(record.integer(70) & FROZEN), record.integer(62, 7) < 0)
            except DxfError as error:
                layers[name.lower()] = Layer(name)
                message = f'the properties of layer "{name}" ({record.place}) cannot be read: {error}; it is taken as visible'
                findings.append(Finding("damaged", "error", message, layer=name))
    return layers


def _blocks(records: list[Record], findings: list[Finding]) -> dict[str, Block]:
    blocks: dict[str, Block] = {}
    head: Record | None = None
    entities: list[Record] = []
    for record in records:
        if record.kind in ("BLOCK", "ENDBLK"):
            if record.codes.count(8) > 1:
                findings.append(_lost(record, "it names two layers: the entity behind it seems to have been swallowed"))
            if head is not None:
                if head.text(2).lower() in blocks:
                    findings.append(_lost(head, f'block "{head.text(2)}" is defined twice; the second definition is used'))
                blocks[head.text(2).lower()] = Block(head, tuple(entities))
                if record.kind == "BLOCK":
                    findings.append(_lost(head, f'block "{head.text(2)}" has no ENDBLK'))
            elif record.kind == "ENDBLK":
                findings.append(_lost(record, "it ends a block that never began"))
            head, entities = (record, []) if record.kind == "BLOCK" else (None, [])
        elif head is None:
            findings.append(_lost(record, "it stands between two blocks"))
        else:
            entities.append(record)
    if head is not None:
        blocks[head.text(2).lower()] = Block(head, tuple(entities))
        findings.append(_lost(head, f'block "{head.text(2)}" has no ENDBLK'))
    return blocks
