"""Which lines and arcs does this DXF file hold?

Every entity of model space is read by itself, blocks are unfolded where they are inserted, and everything is projected
to the drawing plane. Lines, arcs, circles and bulges stay exact; ellipses and splines are followed by arcs. Nothing is left
out without a finding.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import zip_longest

from watchsim.drawing.content import Content, Inserted
from watchsim.drawing.curves.affine import IDENTITY, Affine, shifted
from watchsim.drawing.curves.curves_to_arcs import follow
from watchsim.drawing.curves.plane_projection import MOST_COPIES, Gathering, TooLarge, emit, most_strokes
from watchsim.drawing.curves.plane_shapes import Shape
from watchsim.drawing.dxf.damaged_records import odd_copies, odd_radius, strange_groups, swallowed
from watchsim.drawing.dxf.entities import READERS, Insert, heavyweight, insert, is_mesh
from watchsim.drawing.dxf.left_out import left_out
from watchsim.drawing.dxf.sections import Block, Layer, Sections, divide
from watchsim.drawing.dxf_records import LARGEST, DxfError, Record, read_tags
from watchsim.drawing.findings import Finding
from watchsim.drawing.length_units import INSUNITS, named_length

DEEPEST = 32  # blocks within blocks
MISSING = ("block-missing", "is not in the file")


@dataclass(frozen=True, slots=True)
class Item:
    """A record read: its shapes, or the block it inserts, or nothing but the name of a type that is not read."""

    layer: str
    source: str
    shapes: tuple[Shape, ...] = ()
    insert: Insert | None = None
    ignored: str = ""


def read_dxf(data: bytes, units: str | None, fit: float) -> Content:
    """The content of a DXF file, text or binary. `units` overrules the header; `fit` is in metres.

    Never raises for what is in the file; `units` must be a known name (ValueError).
    """
    stated = named_length(units) if units is not None else None
    try:
        sections = divide(read_tags(data))
    except DxfError as error:
        return Content(findings=(Finding("unreadable", "error", str(error)),))
    name, scale, origin, notes = _unit_of(sections.insunits, stated)
    found = Gathering(scale, fit, most_strokes(len(data)))
    walker = Walker(sections, found)
    try:
        if len(sections.entities) > found.most:
            raise TooLarge
        walker.walk(walker.items(sections.entities), IDENTITY, "", ())
        follow(found)
    except TooLarge:
        message = f"the drawing unfolds into more than {found.most} pieces, or {MOST_COPIES} copies of blocks; nothing was read"
        fix = "Look for curves made of points, and for arrays of blocks with huge counts."
        refusal = Finding("too-large", "error", message, fix)
        return Content(units=name, units_from=origin, findings=(*notes, *sections.findings, refusal))
    return Content(
        strokes=tuple(found.strokes),
        points=tuple(found.points),
        units=name,
        units_from=origin,
        fitted_curves=found.curves,
        fitted_arcs=found.arcs,
        fitted_deviation=found.deviation,
        ignored=dict(found.ignored),
        drawn=found.drawn(),
        inserted=tuple(found.inserted),
        findings=(*notes, *sections.findings, *found.findings, *left_out(found, sections.layers)),
    )


def _unit_of(code: int, stated: tuple[str, float] | None) -> tuple[str | None, float, str | None, list[Finding]]:
    """Name, metres, origin of the name, and a finding where file and caller disagree or the code is unknown."""
    header = INSUNITS.get(code)
    if stated is None and header is not None:
        return header[0], header[1], "header", []
    notes = []
    if header is None and code != 0:
        notes.append(Finding("units-unknown", "warning", f"$INSUNITS is {code}, a code that DXF does not define"))
    if stated is None:
        return None, 1e-3, None, notes
    if header is not None and header[1] != stated[1]:
        message = f"the file says {header[0]}, you say {stated[0]}: everything is {stated[1] / header[1]:.6g} times as large"
        notes.append(Finding("units-overruled", "warning", message))
    return stated[0], stated[1], "option", notes


class Walker:
    """Walks through the records once, unfolding blocks; results go to `found`."""

    def __init__(self, sections: Sections, found: Gathering) -> None:
        self.sections = sections
        self.found = found
        self.read_blocks: dict[str, list[Item]] = {}

    def items(self, records: Iterable[Record]) -> list[Item]:
        """Every record read, polylines together with their vertices; findings for those that cannot be."""
        records = list(records)
        result = []
        paper = 0
        for record, following in zip_longest(records, records[1:]):
            self.found.findings += swallowed(record, following, self._spelling(record.text(8, "0")))
        for head, vertices in _grouped(records):
            if head.text(67) == "1":
                paper += head.kind != "VIEWPORT"  # every file with paper space has one
            elif head.text(60) == "1":
                self.found.hidden[""] += 1
            else:
                item = self._item(head, vertices)
                if item is not None:
                    result.append(item)
        if paper:
            message = f"{paper} {'entity' if paper == 1 else 'entities'} in paper space left out: only model space is read"
            self.found.findings.append(Finding("paper-space", "warning", message))
        return result

    def _item(self, head: Record, vertices: list[Record]) -> Item | None:
        layer = self._spelling(head.text(8, "0") or "0")
        for record in (head, *vertices):
            self.found.findings += strange_groups(record, layer)
        try:
            if head.kind == "INSERT":
                self.found.findings += odd_copies(head, layer)
                return Item(layer, head.name, insert=insert(head, MOST_COPIES))
            if head.kind == "POLYLINE" and not is_mesh(head):
                return Item(layer, head.name, tuple(heavyweight(head, vertices)))
            if head.kind in READERS and vertices:
                raise DxfError("VERTEX records follow it that belong to no POLYLINE")
            if head.kind in READERS:
                self.found.findings += odd_radius(head, layer)
                return Item(layer, head.name, tuple(READERS[head.kind](head)))
        except DxfError as error:
            message = f"{head.name} at {head.place} cannot be read: {error}. It is left out."
            self.found.findings.append(Finding("damaged", "error", message, "Draw it again or purge it in CAD.", layer))
            return None
        return Item(layer, head.name, ignored=head.kind or "(no type)")

    def _spelling(self, layer: str) -> str:
        known = self.sections.layers.get(layer.lower())
        return known.name if known else layer

    def walk(self, items: list[Item], affine: Affine, inherited: str, path: tuple[str, ...]) -> None:
        """Puts items in place. Layer 0 inside a block means the layer of the INSERT (`inherited`)."""
        for item in items:
            layer = inherited if inherited and item.layer == "0" else item.layer
            state = self.sections.layers.get(layer.lower(), Layer(layer))
            if state.frozen or (state.off and item.insert is None):
                self.found.hidden[layer] += 1
            elif item.insert is not None:
                self._unfold(item, item.insert, layer, affine, path)
            elif item.ignored:
                self.found.ignored[item.ignored] += 1
            else:
                self.found.runs += 1
                for shape in item.shapes:
                    emit(self.found, shape if affine is IDENTITY else shape.mapped(affine), layer, item.source)

    def _unfold(self, item: Item, reference: Insert, layer: str, affine: Affine, path: tuple[str, ...]) -> None:
        name = reference.block.lower()
        block = self.sections.blocks.get(name)
        fault = MISSING if block is None else _unusable(block, path)
        if block is None or fault is not None:
            code, why = fault or MISSING
            message = f'block "{reference.block}" {why}; {item.source} is left out'
            self.found.findings.append(Finding(code, "error", message, "", layer))
            return
        if name not in self.read_blocks:
            self.read_blocks[name] = self.items(block.entities)
            if not block.entities:
                message = f'block "{reference.block}" is empty: where it is inserted nothing is drawn'
                self.found.findings.append(Finding("empty-block", "notice", message, layer=layer))
        base = self._base(block)
        for placing in reference.maps:
            self.found.copies += 1
            if self.found.copies > MOST_COPIES:
                raise TooLarge
            place = affine.after(placing).after(base)
            if max(abs(number) for column in place for number in column) > LARGEST:
                message = f"{item.source} puts its block at coordinates beyond any drawing; it is left out"
                self.found.findings.append(Finding("damaged", "error", message, "", layer))
                return
            before = self.found.runs
            self.walk(self.read_blocks[name], place, layer, (*path, name))
            if not path:
                self.found.inserted.append(Inserted(reference.block, before + 1, self.found.runs))

    def _base(self, block: Block) -> Affine:
        try:
            x, y, z = block.head.point(10, (0.0, 0.0, 0.0))
        except DxfError as error:
            message = f"the base point of {block.head.name} at {block.head.place} cannot be read: {error}"
            self.found.findings.append(Finding("damaged", "error", message))
            return IDENTITY
        return shifted((-x, -y, -z))


def _unusable(block: Block, path: tuple[str, ...]) -> tuple[str, str] | None:
    """Code and reason for a block that cannot be unfolded inside those of `path`."""
    if block.head.text(2).lower() in path:
        return "block-loop", "contains itself"
    if len(path) >= DEEPEST:
        return "block-loop", "is nested too deeply"
    if not block.entities and block.head.text(1):
        return "external", f'is drawn in another file, "{block.head.text(1)}", which is not read'
    return None


def _grouped(records: Iterable[Record]) -> Iterable[tuple[Record, list[Record]]]:
    """Each record with the VERTEX records that follow it; SEQEND only closes such a row, attributes belong to an INSERT."""
    head: Record | None = None
    vertices: list[Record] = []
    for record in records:
        if record.kind == "VERTEX" and head is not None:
            vertices.append(record)
        elif record.kind != "SEQEND":
            if head is not None:
                yield head, vertices
            head, vertices = record, []
    if head is not None:
        yield head, vertices
