"""Which lines and arcs does this DXF file hold?

Every entity of model space is read by itself, blocks are unfolded where they are inserted, and everything is projected
to the drawing plane. Lines, arcs, circles and bulges stay exact; ellipses and splines are followed by arcs. Nothing is left
out without a finding.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from watchsim.drawing.curves import follow
from watchsim.drawing.dxf_records import (
    LARGEST,
    Block,
    DxfError,
    Layer,
    Record,
    Sections,
    as_number,
    divide,
    read_tags,
    strange_codes,
)
from watchsim.drawing.findings import INSUNITS, Content, Finding, Inserted, named_length, words
from watchsim.drawing.projection import (
    IDENTITY,
    MOST_COPIES,
    Affine,
    Conic,
    Dot,
    Gathering,
    Shape,
    Spline,
    Straight,
    TooLarge,
    Vector,
    bulge,
    circle,
    cross,
    emit,
    most_strokes,
    object_plane,
    shifted,
    turned_scaled,
    unit,
)
from watchsim.drawing.splines import spline_from
from watchsim.drawing.write import Sheet, degrees_of
from watchsim.geometry.primitives import TURN, Line

# Each reader of an entity takes a record and gives shapes in world coordinates and drawing units. Group codes after the DXF
# reference (Autodesk); missing or doubled coordinates raise DxfError instead of becoming zero.

UP: Vector = (0.0, 0.0, 1.0)
CLOSED, SPLINE_FIT, MESH, FRAME_POINT, SPACE_POLYLINE = 1, 4, 16 | 64, 16, 8


@dataclass(frozen=True, slots=True)
class Insert:
    """A reference to a block: its name and the maps of the copies (before the block's base point is taken off)."""

    block: str
    maps: tuple[Affine, ...]


def plane_of(record: Record) -> Affine:
    return object_plane(record.point(210, UP))


def line(record: Record) -> list[Shape]:
    return [Straight(record.point(10), record.point(11))]


def point(record: Record) -> list[Shape]:
    return [Dot(record.point(10))]


def full_circle(record: Record) -> list[Shape]:
    return [circle(record.point(10), radius_of(record)).mapped(plane_of(record))]


def arc(record: Record) -> list[Shape]:
    start, end = record.number(50), record.number(51)
    sweep = (end - start) % 360.0 or 360.0
    shape = circle(record.point(10), radius_of(record), math.radians(start), math.radians(sweep))
    return [shape.mapped(plane_of(record))]


def radius_of(record: Record) -> float:
    """Zero is let through: such circles are points left behind by editing, and are reported as pieces of no length."""
    return abs(record.number(40))


def ellipse(record: Record) -> list[Shape]:
    major = record.point(11)
    normal = unit(record.point(210, UP))
    ratio = record.number(40)
    a, b, c = cross(normal, major)
    if ratio == 0.0 or not any(major):
        raise DxfError("one of its axes has no length")
    start, end = record.number(41, 0.0), record.number(42, TURN)
    sweep = (end - start) % TURN
    if min(sweep, TURN - sweep) < 1e-9:
        sweep = TURN
    return [Conic(record.point(10), major, (ratio * a, ratio * b, ratio * c), start, sweep)]


def lightweight(record: Record) -> list[Shape]:
    """LWPOLYLINE: vertices in a row, each 10, 20 and perhaps a bulge 42."""
    elevation = record.number(38, 0.0)
    corners: list[list[float]] = []
    for code, value in record.pairs():
        if code == 10:
            corners.append([as_number(value, code)])
        elif code in (20, 42):
            if not corners or len(corners[-1]) != (1 if code == 20 else 2):
                raise DxfError(f"group {code} stands where it does not belong among its corners")
            corners[-1].append(as_number(value, code))
    if any(len(corner) < 2 for corner in corners):
        raise DxfError("a corner without its y coordinate (group 20)")
    if record.integer(90, len(corners)) != len(corners):
        raise DxfError(f"it announces {record.integer(90)} corners and holds {len(corners)}")
    vertices = [((c[0], c[1], elevation), c[2] if len(c) > 2 else 0.0) for c in corners]
    return traced(vertices, bool(record.integer(70) & CLOSED), plane_of(record))


def heavyweight(record: Record, vertices: Sequence[Record]) -> list[Shape]:
    """POLYLINE with the VERTEX records that follow it."""
    flags = record.integer(70)
    corners: list[tuple[Vector, float]] = []
    for vertex in vertices:
        if flags & SPLINE_FIT and vertex.integer(70) & FRAME_POINT:
            continue  # control points of a curve whose approximation follows
        corners.append((vertex.point(10), vertex.number(42, 0.0)))
    if flags & SPACE_POLYLINE:
        return traced([(corner, 0.0) for corner, _ in corners], bool(flags & CLOSED), Affine())
    elevation = record.number(30, 0.0)
    flat = [((x, y, elevation), amount) for (x, y, _), amount in corners]
    return traced(flat, bool(flags & CLOSED), plane_of(record))


def traced(corners: list[tuple[Vector, float]], closed: bool, plane: Affine) -> list[Shape]:
    """The segments from corner to corner; a corner's bulge belongs to the segment that leaves it. One corner alone gives a
    segment without length, so that it is not left out in silence."""
    if not corners:
        raise DxfError("it has no corners")
    following = [*corners[1:], corners[0]] if closed or len(corners) == 1 else corners[1:]
    pairs = zip(corners, following, strict=False)
    if closed and len(corners) == 2 and corners[0][1] == corners[1][1] == 0.0:
        pairs = zip(corners[:1], following[:1], strict=True)  # there and back along one line
    return [bulge(a, b, amount).mapped(plane) for (a, amount), (b, _) in pairs]


def spline(record: Record) -> list[Shape]:
    for code, what in ((72, "knots"), (73, "control points"), (74, "fit points")):
        found = record.codes.count({72: 40, 73: 10, 74: 11}[code])
        if record.integer(code, found) != found:
            raise DxfError(f"it announces {record.integer(code)} {what} and holds {found}")
    shape: Spline = spline_from(
        degree=record.integer(71, 3),
        closed=bool(record.integer(70) & CLOSED),
        knots=record.numbers(40),
        weights=record.numbers(41),
        points=points_of(record, 10),
        fit_points=points_of(record, 11),
        tangents=[record.point(12), record.point(13)] if 12 in record.codes and 13 in record.codes else (),
    )
    return [shape]


def points_of(record: Record, code: int) -> list[Vector]:
    """All points of groups code, code + 10 and code + 20 (the last may be missing throughout)."""
    x, y, z = (record.numbers(code + step) for step in (0, 10, 20))
    z = z or [0.0] * len(x)
    if not len(x) == len(y) == len(z):
        raise DxfError(f"the coordinates of its points (groups {code}, {code + 10}, {code + 20}) do not match up")
    return list(zip(x, y, z, strict=True))


READERS: dict[str, Callable[[Record], list[Shape]]] = {
    "LINE": line,
    "POINT": point,
    "CIRCLE": full_circle,
    "ARC": arc,
    "ELLIPSE": ellipse,
    "LWPOLYLINE": lightweight,
    "SPLINE": spline,
}


def insert(record: Record, most: int) -> Insert:
    """INSERT: rows and columns step along the turned axes, unscaled. More than `most` copies raise DxfError."""
    columns, rows = max(1, record.integer(70, 1)), max(1, record.integer(71, 1))
    if columns * rows > most:
        raise DxfError(f"{columns} × {rows} copies of a block are too many (the limit is {most})")
    angle = math.radians(record.number(50, 0.0))
    scale = (record.number(41, 1.0), record.number(42, 1.0), record.number(43, 1.0))
    if scale[0] == 0.0 or scale[1] == 0.0:
        raise DxfError(f"its scale is {scale[0]:g} × {scale[1]:g}: nothing would be left")
    place = plane_of(record).after(shifted(record.point(10)))
    turned, form = turned_scaled(angle, (1.0, 1.0, 1.0)), turned_scaled(angle, scale)
    across, up = record.number(44, 0.0), record.number(45, 0.0)
    offsets = [turned.direction((column * across, row * up, 0.0)) for row in range(rows) for column in range(columns)]
    return Insert(record.text(2), tuple(place.after(shifted(offset)).after(form) for offset in offsets))


# Some records look damaged, though they can be read.


def swallowed(record: Record, following: Record | None, layer: str) -> list[Finding]:
    """Signs that the record behind it was lost. What is read complains itself where groups stand twice."""
    if record.kind == "SEQEND":
        return strange_groups(record, layer)
    if record.kind not in READERS and record.codes.count(8) > 1:
        message = f"{record.name} at {record.place} names two layers: the entity behind it seems to have been swallowed"
        return [Finding("damaged", "error", message, "Draw again what is missing there, or export it again.")]
    announced = record.kind == "INSERT" and record.text(66, "0") not in ("0", "")
    if announced and (following is None or following.kind != "ATTRIB"):
        message = f"{record.name} at {record.place} announces attributes (group 66) and none follow: it may be damaged"
        return [Finding("strange-group", "warning", message, "Check that it is complete.", layer)]
    return []


def strange_groups(record: Record, layer: str) -> list[Finding]:
    strange = strange_codes(record)
    if not strange:
        return []
    codes = ", ".join(map(str, strange[:6]))
    message = f"{record.name} at {record.place} has groups that do not belong there ({codes}): it may be damaged"
    return [Finding("strange-group", "warning", message, "Check its shape.", layer)]


def odd_numbers(record: Record, layer: str) -> list[Finding]:
    """An INSERT without rows or columns; a negative radius."""
    found = []
    counts = ((70, "columns"), (71, "rows")) if record.kind == "INSERT" else ()
    for code, what in counts:
        if (count := record.integer(code, 1)) < 1:
            message = f"{record.name} has {count} {what} (group {code}); one is read"
            found.append(Finding("strange-group", "warning", message, "Insert it again.", layer))
    if record.kind in ("CIRCLE", "ARC") and record.number(40) < 0.0:
        message = f"the radius of {record.name} is {record.number(40):g}; it is read without its sign"
        found.append(Finding("negative-radius", "warning", message, "Draw it again.", layer))
    return found


# Types that are not read: without an outline, and with one.
TEXT_LIKE = words(
    """TEXT MTEXT RTEXT ATTRIB ATTDEF DIMENSION ARC_DIMENSION LARGE_RADIAL_DIMENSION TOLERANCE LEADER MULTILEADER MLEADER
    VIEWPORT HATCH IMAGE WIPEOUT ACAD_TABLE OLEFRAME OLE2FRAME"""
)
KNOWN_BUT_NOT_READ = words(
    """POLYLINE 3DFACE SOLID TRACE MLINE REGION BODY 3DSOLID MESH RAY XLINE SHAPE SURFACE EXTRUDEDSURFACE LOFTEDSURFACE
    REVOLVEDSURFACE SWEPTSURFACE PLANESURFACE HELIX UNDERLAY PDFUNDERLAY DWFUNDERLAY DGNUNDERLAY LIGHT SUN POINTCLOUD
    GEOPOSITIONMARKER ACAD_PROXY_ENTITY SECTION"""
)


def left_out(found: Gathering, layers: dict[str, Layer]) -> list[Finding]:
    """One finding for each thing that was left out, however often."""
    result = []
    for layer, count in found.hidden.items():
        state = layers.get(layer.lower(), Layer(layer))
        what = f"layer {layer} is {'frozen' if state.frozen else 'off'}: its" if layer else "invisible:"
        result.append(Finding("layer-off", "notice", f"{what} {count} entities were left out", layer=layer or None))
    if found.tilted:
        message = f"{found.tilted} pieces are not parallel to the drawing plane; their projection is used"
        result.append(Finding("tilted", "warning", message))
    return [*result, *(_ignored(kind, count) for kind, count in found.ignored.items())]


def _ignored(kind: str, count: int) -> Finding:
    if kind in TEXT_LIKE:
        return Finding("ignored", "notice", f"{count} × {kind} not read: it is not an outline")
    if kind in KNOWN_BUT_NOT_READ:
        return Finding("ignored", "warning", f"{count} × {kind} not read", "Draw it with lines and arcs where it matters.")
    message = f"{count} × {kind[:40]} not read: no type of entity known here; the file may be damaged"
    return Finding("ignored", "warning", message)


DEEPEST = 32  # blocks within blocks


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
    findings = (*notes, *sections.findings, *found.findings, *left_out(found, sections.layers))
    return found.content(name, origin, findings)


def content_of_sheet(sheet: Sheet, fit: float) -> Content:
    """What `read_dxf` would find in the sheet's own DXF file, to the last bit, without the detour."""
    found = Gathering(INSUNITS[4][1], fit)
    if sheet.pivot is not None:
        emit(found, Dot((*sheet.pivot, 0.0)), "PIVOT", "POINT")
    for loop in sheet.loops:
        for edge in loop.edges:
            found.runs += 1
            if isinstance(edge, Line):
                emit(found, Straight((edge.x0, edge.y0, 0.0), (edge.x1, edge.y1, 0.0)), loop.layer, "LINE")
            elif edge.is_circle:
                emit(found, circle((edge.x, edge.y, 0.0), edge.radius), loop.layer, "CIRCLE")
            else:
                start, end = degrees_of(edge)
                sweep = (end - start) % 360.0 or 360.0
                whole = circle((edge.x, edge.y, 0.0), edge.radius, math.radians(start), math.radians(sweep))
                emit(found, whole, loop.layer, "ARC")
    return replace(found.content(INSUNITS[4][0], "header", found.findings), format="dxf")


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
                self.found.findings += odd_numbers(head, layer)
                return Item(layer, head.name, insert=insert(head, MOST_COPIES))
            if head.kind == "POLYLINE" and not head.integer(70) & MESH:
                return Item(layer, head.name, tuple(heavyweight(head, vertices)))
            if head.kind in READERS and vertices:
                raise DxfError("VERTEX records follow it that belong to no POLYLINE")
            if head.kind in READERS:
                self.found.findings += odd_numbers(head, layer)
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
        code, why = "", ""
        if block is None:
            code, why = "block-missing", "is not in the file"
        elif name in path or len(path) >= DEEPEST:
            code, why = "block-loop", "contains itself" if name in path else "is nested too deeply"
        elif not block.entities and block.head.text(1):
            code, why = "external", f'is drawn in another file, "{block.head.text(1)}", which is not read'
        if block is None or code:
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
