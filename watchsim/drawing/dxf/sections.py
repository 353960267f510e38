"""Which parts does this DXF file have?

Header variables, layers, blocks and the entities of model space, found in the list of records. Old and minimal files have
entities only.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from watchsim.drawing.dxf_records import DxfError, Record, Tags
from watchsim.drawing.findings import Finding

SECTIONS = frozenset(("HEADER", "CLASSES", "TABLES", "BLOCKS", "ENTITIES", "OBJECTS", "THUMBNAILIMAGE", "ACDSDATA"))
DRAWN = frozenset(
    ("LINE", "POINT", "CIRCLE", "ARC", "ELLIPSE", "LWPOLYLINE", "SPLINE", "POLYLINE", "VERTEX", "SEQEND", "INSERT", "TEXT")
)
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
    """The sections of a file. Whatever is incomplete becomes a finding of severity "error"."""
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
