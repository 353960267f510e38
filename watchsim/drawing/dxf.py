"""Which lines and arcs does this DXF file hold?

Every entity of model space is read by itself, blocks are unfolded where they are inserted, and everything is projected
to the drawing plane. Lines, arcs, circles and bulges stay exact; ellipses and splines are followed by arcs. Nothing is left
out without a finding.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from watchsim.drawing.affine import IDENTITY, Affine, shifted
from watchsim.drawing.content import Content, Stroke
from watchsim.drawing.dxf_sections import Block, Layer, Sections, divide
from watchsim.drawing.dxf_units import INSUNITS, named_length
from watchsim.drawing.ellipse import ellipse_edges
from watchsim.drawing.entities import READERS, Insert, heavyweight, insert, is_mesh
from watchsim.drawing.findings import Finding
from watchsim.drawing.nurbs import spline_edges
from watchsim.drawing.shapes import Conic, Dot, Shape, Spline, Straight, edge_on, exact_edge
from watchsim.drawing.tags import DxfError, Record, read_tags
from watchsim.geometry.primitives import Arc, Edge

MOST = 500_000  # strokes and copies of blocks: more is a fault in the file, not a drawing
DEEPEST = 32  # blocks within blocks
ROUNDING = 1e-12  # of the coordinates: a fit cannot be better than this
TEXT_LIKE = frozenset(
    ("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER", "MULTILEADER")
    + ("MLEADER", "TOLERANCE", "VIEWPORT", "HATCH", "IMAGE", "WIPEOUT", "ACAD_TABLE", "RTEXT", "OLE2FRAME", "OLEFRAME")
)
KNOWN_BUT_NOT_READ = frozenset(
    ("3DFACE", "SOLID", "TRACE", "MLINE", "REGION", "BODY", "3DSOLID", "SURFACE", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "MESH")
    + ("REVOLVEDSURFACE", "SWEPTSURFACE", "PLANESURFACE", "RAY", "XLINE", "SHAPE", "HELIX", "ACAD_PROXY_ENTITY", "LIGHT")
    + ("SECTION", "UNDERLAY", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY", "SUN", "POINTCLOUD", "GEOPOSITIONMARKER")
)


@dataclass(frozen=True, slots=True)
class Item:
    """A record read: its shapes, or the block it inserts, or nothing but the name of a type that is not read."""

    layer: str
    source: str
    shapes: tuple[Shape, ...] = ()
    insert: Insert | None = None
    ignored: str = ""


@dataclass
class Gathering:
    """What has been found so far; filled in while the file is walked through once."""

    scale: float
    tolerance: float
    strokes: list[Stroke] = field(default_factory=list)
    points: list[tuple[str, float, float]] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    ignored: Counter[str] = field(default_factory=Counter)
    hidden: Counter[str] = field(default_factory=Counter)
    tilted: int = 0
    copies: int = 0
    runs: int = 0
    curves: int = 0
    arcs: int = 0
    deviation: float = 0.0


class TooLarge(Exception):
    """The drawing unfolds into more than MOST pieces."""


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
    found = Gathering(scale, fit)
    walker = Walker(sections, found)
    try:
        walker.walk(walker.items(sections.entities, "model"), IDENTITY, "", ())
    except TooLarge:
        message = f"the drawing unfolds into more than {MOST} pieces; the rest was not read"
        found.findings.append(Finding("too-large", "error", message, "Look for arrays of blocks with huge counts."))
    findings = (*notes, *sections.findings, *found.findings, *_summaries(found, sections.layers))
    return Content(
        *(tuple(found.strokes), tuple(found.points), name, origin),
        *(found.curves, found.arcs, found.deviation, dict(found.ignored), findings),
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

    def items(self, records: Iterable[Record], where: str) -> list[Item]:
        """Every record read, polylines together with their vertices; findings for those that cannot be."""
        result = []
        paper = 0
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
            message = f"{paper} entities in paper space were left out: only model space is read"
            self.found.findings.append(Finding("paper-space", "warning", message))
        return result

    def _item(self, head: Record, vertices: list[Record]) -> Item | None:
        layer = self._spelling(head.text(8, "0") or "0")
        try:
            if head.kind == "INSERT":
                return Item(layer, head.name, insert=insert(head, MOST))
            if head.kind == "POLYLINE" and not is_mesh(head):
                return Item(layer, head.name, tuple(heavyweight(head, vertices)))
            if head.kind in READERS and vertices:
                raise DxfError("VERTEX records follow it that belong to no POLYLINE")
            if head.kind in READERS:
                self._warn_of_radius(head, layer)
                return Item(layer, head.name, tuple(READERS[head.kind](head)))
        except DxfError as error:
            message = f"{head.name} at {head.place} cannot be read: {error}. It is left out."
            self.found.findings.append(Finding("damaged", "error", message, "Draw it again or purge it in CAD.", layer))
            return None
        return Item(layer, head.name, ignored=head.kind or "(no type)")

    def _warn_of_radius(self, head: Record, layer: str) -> None:
        if head.kind in ("CIRCLE", "ARC") and head.number(40) < 0.0:
            message = f"the radius of {head.name} is {head.number(40):g}; it is read without its sign"
            self.found.findings.append(Finding("negative-radius", "warning", message, "Draw it again.", layer))

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
        if block is None or name in path or len(path) >= DEEPEST:
            why = "is not in the file" if block is None else "contains itself" if name in path else "is nested too deeply"
            message = f'block "{reference.block}" {why}; {item.source} is left out'
            self.found.findings.append(Finding("block-missing" if block is None else "block-loop", "error", message, "", layer))
            return
        if name not in self.read_blocks:
            self.read_blocks[name] = self.items(block.entities, reference.block)
        base = self._base(block)
        for placing in reference.maps:
            self.found.copies += 1
            if self.found.copies > MOST:
                raise TooLarge
            self.walk(self.read_blocks[name], affine.after(placing).after(base), layer, (*path, name))

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


def emit(found: Gathering, shape: Shape, layer: str, source: str) -> None:
    """Projects one shape in world coordinates to the plane and keeps its edges."""
    scale = found.scale
    if isinstance(shape, Dot):
        found.points.append((layer, scale * shape.at[0], scale * shape.at[1]))
        return
    found.tilted += tilted(shape)
    if isinstance(shape, Spline):
        fit, fitted = spline_edges(shape, scale, max(found.tolerance, ROUNDING * scale * reach(shape)))
    elif (edge := exact_edge(shape, scale)) is not None:
        keep(found, (edge,), layer, source)
        return
    elif isinstance(shape, Conic) and not edge_on(shape):
        fit, fitted = ellipse_edges(shape, scale, max(found.tolerance, ROUNDING * scale * reach(shape))), True
    else:
        message = f"{source} is seen edge-on, as a line drawn there and back; it is left out"
        found.findings.append(_at("edge-on", "warning", message, layer, scale, shape))
        return
    if fitted:
        found.curves += 1
        found.arcs += sum(isinstance(edge, Arc) for edge in fit.edges)
        found.deviation = max(found.deviation, fit.deviation)
        if fit.deviation > max(found.tolerance, ROUNDING * scale * reach(shape)):
            message = f"{source} could only be followed within {fit.deviation * 1e6:.3g} µm: it has a cusp or a gap"
            found.findings.append(_at("fit", "warning", message, layer, scale, shape))
    keep(found, fit.edges, layer, source)


def keep(found: Gathering, edges: Iterable[Edge], layer: str, source: str) -> None:
    found.strokes.extend(Stroke(edge, layer, source, found.runs) for edge in edges)
    if len(found.strokes) > MOST:
        raise TooLarge


def corner(shape: Straight | Conic | Spline) -> tuple[float, float, float]:
    """Some point that belongs to the shape."""
    return shape.a if isinstance(shape, Straight) else shape.centre if isinstance(shape, Conic) else shape.points[0]


def reach(shape: Straight | Conic | Spline) -> float:
    """The largest coordinate that matters for rounding, drawing units."""
    points = shape.points if isinstance(shape, Spline) else [corner(shape)]
    size = max(map(abs, (*shape.u, *shape.v))) if isinstance(shape, Conic) else 0.0
    return size + max(max(abs(x), abs(y)) for x, y, _ in points)


def tilted(shape: Straight | Conic | Spline) -> bool:
    """Does the shape leave its plane of constant height by more than a millionth of its size?"""
    if isinstance(shape, Conic):
        return max(abs(shape.u[2]), abs(shape.v[2])) > 1e-6 * max(math.hypot(*shape.u), math.hypot(*shape.v))
    if isinstance(shape, Straight):
        return shape.a[2] != shape.b[2] and abs(shape.a[2] - shape.b[2]) > 1e-6 * math.dist(shape.a, shape.b)
    points = shape.points
    first = points[0]
    return any(abs(p[2] - first[2]) > 1e-6 * math.dist(p, first) for p in points[1:])


def _at(code: str, severity: str, message: str, layer: str, scale: float, shape: Straight | Conic | Spline) -> Finding:
    x, y, _ = corner(shape)
    return Finding(code, severity, message, "", layer, 1e3 * scale * x, 1e3 * scale * y)


def _summaries(found: Gathering, layers: dict[str, Layer]) -> list[Finding]:
    """One finding for each thing that was left out many times."""
    result = []
    for layer, count in found.hidden.items():
        state = layers.get(layer.lower(), Layer(layer))
        what = f"layer {layer} is {'frozen' if state.frozen else 'off'}: its" if layer else "invisible:"
        result.append(Finding("layer-off", "notice", f"{what} {count} entities were left out", layer=layer or None))
    if found.tilted:
        message = f"{found.tilted} pieces are not parallel to the drawing plane; their projection is used"
        result.append(Finding("tilted", "warning", message))
    for kind, count in found.ignored.items():
        result.append(_ignored(kind, count))
    return result


def _ignored(kind: str, count: int) -> Finding:
    if kind in TEXT_LIKE:
        return Finding("ignored", "notice", f"{count} × {kind} not read: it is no outline")
    if kind in KNOWN_BUT_NOT_READ or kind in ("POLYLINE",):
        return Finding("ignored", "warning", f"{count} × {kind} not read", "Draw it with lines and arcs where it matters.")
    message = f"{count} × {kind[:40]} not read: no type of entity known here; the file may be damaged"
    return Finding("ignored", "warning", message)
