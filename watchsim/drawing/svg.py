"""Which lines and arcs does this SVG file hold?

Every element that is drawn is read by itself, symbols and groups are unfolded where they are used, and everything is placed
in the plane with y upwards. Lines, circles and circular arcs stay exact; ellipses and Béziers are followed by arcs. Nothing
is left out without a finding.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple, TypeVar

from watchsim.drawing.curves import emit_row, follow
from watchsim.drawing.dxf_records import LARGEST
from watchsim.drawing.findings import Content, Finding, named_length
from watchsim.drawing.projection import IDENTITY, Affine, Dot, Gathering, TooLarge, most_strokes, shifted
from watchsim.drawing.svg_elements import (
    CONTAINERS,
    MOVING,
    SILENT,
    TEXT_LIKE,
    Node,
    SvgError,
    Tree,
    read_tree,
    strange_attributes,
)
from watchsim.drawing.svg_shapes import METRES, READERS, Measures, PathData, fitted, placed, plane, split_length, view_box
from watchsim.drawing.svg_style import Styles, read_styles

# Only a size of the page in a unit of length says it: width="4.3mm" viewBox="0 0 4.3 4.3" is a drawing in millimetres. Numbers
# without a unit are none: they size a picture on a screen.

SPELLED = {"in": "inch", "q": "Q"}
Answer = TypeVar("Answer")
SAME = 1e-9  # relative difference of two units that differ only by rounding


class Page(NamedTuple):
    """`units` (None: unknown), where they come from, the metres of one, the map from the root's user units to these (y up).

    `width` and `height` are those of the root's viewport in its user units. An `empty` page shows nothing.
    """

    units: str | None
    units_from: str | None
    scale: float
    root: Affine
    width: float
    height: float
    empty: bool
    findings: tuple[Finding, ...]


class _Size(NamedTuple):
    """A side of the page: its length in `unit` ("" for a bare number); None where the page leaves it open."""

    value: float
    unit: str


def page_unit(name: str) -> tuple[str, float]:
    """The unit that a caller names, with those of pages besides the usual ones; ValueError where it is none."""
    plain = name.strip().lower()
    if plain in ("px", "pt", "pc", "q"):
        return SPELLED.get(plain, plain), float(METRES[plain])
    return named_length(name)


def read_page(values: Mapping[str, str], stated: tuple[str, float] | None) -> Page:
    """The page of a drawing with these attributes of its root; `stated` is what the caller says about the unit."""
    findings: list[Finding] = []

    def read(reader: Callable[[str | None], Answer], name: str) -> Answer | None:
        try:
            return reader(values.get(name))
        except SvgError as error:
            findings.append(Finding("damaged", "error", f"the page cannot be read: {error}", "Mend the first <svg> tag."))
            return None

    box = read(view_box, "viewBox")
    sides = [read(_side, "width"), read(_side, "height")]
    empty = any(side is not None and side.value <= 0.0 for side in sides)
    unit = next((side.unit for side in sides if side is not None and side.unit not in ("", "%")), "")
    if empty:
        sides = [None, None]
    if None not in sides and len({bool(side.unit) for side in sides if side}) > 1:
        message = "the page gives only one of its sides a unit; the other is taken in pixels"
        findings.append(Finding("page", "warning", message, "Give width and height in the same unit."))
    w, h = (_in_unit(side, unit) for side in sides)
    if box is None:
        sx = sy = float(METRES["px"] / METRES[unit]) if unit else 1.0  # a pixel in page units
        tx = ty = 0.0
        width, height = (side / sx if side is not None else 0.0 for side in (w, h))
    else:
        width, height = box.width, box.height
        if w is None and h is None:
            w, h = width, height
        w = h * width / height if w is None and h is not None else w
        h = w * height / width if h is None and w is not None else h
        assert w is not None and h is not None
        try:
            sx, sy, tx, ty = fitted(box, w, h, values.get("preserveAspectRatio"))
        except SvgError as error:
            findings.append(Finding("damaged", "error", f"the page cannot be read: {error}"))
            sx, sy, tx, ty = fitted(box, w, h, None)
    name, metres = (SPELLED.get(unit, unit), float(METRES[unit])) if unit else (None, 1e-3)
    origin = "page"
    if stated is not None and (name is None or abs(stated[1] - metres) > SAME * metres):
        if name is not None:
            message = f"the page says {name}, you say {stated[0]}: everything is {stated[1] / (sx * metres):.6g} times as large"
            findings.append(Finding("units-overruled", "warning", message))
        name, metres, origin = stated[0], stated[1], "option"
    if name is None or origin == "option":  # a unit is then one of the drawing's own numbers
        sy, tx, ty, sx = sy / sx, tx / sx, ty / sx, 1.0
    root = plane(sx, 0.0, 0.0, -sy, tx, -ty)
    return Page(name, origin if name else None, metres, root, width, height, empty, tuple(findings))


def _side(text: str | None) -> _Size | None:
    if text is None or text.strip() in ("", "auto"):
        return None
    value, unit = split_length(text)
    return None if unit == "%" and value > 0.0 else _Size(value, unit)


def _in_unit(side: _Size | None, unit: str) -> float | None:
    """A side of the page in the page's unit; a bare number counts pixels (or is the unit, where there is no other)."""
    if side is None:
        return None
    if side.unit == unit:
        return side.value
    ratio = METRES[side.unit or "px"] / METRES[unit]
    return side.value * ratio.numerator / ratio.denominator


# A pixel is 1/96 inch since CSS 2.1. Adobe Illustrator writes points (1/72 inch) and calls them pixels; Inkscape counted 1/90
# inch up to version 0.91 (its release notes of 0.92). Such drawings come out too small without being wrong in any place.

BROWSERS, ILLUSTRATOR, OLD_INKSCAPE = 96, 72, 90  # pixels per inch
CHANGED = (0, 92)  # the first Inkscape that counts as browsers do
_VERSION = re.compile(r"\s*(\d+)\.(\d+)")


def other_pixels(root: Mapping[str, str], remarks: Sequence[str], page: Page) -> list[Finding]:
    """A warning where the size of the drawing rests on pixels that its writer counts differently.

    `root` are the attributes of the root element. Nothing is said once the caller has named the unit.
    """
    in_pixels = page.units == "px" or (page.units is not None and "viewBox" not in root)
    if page.units_from == "option" or not (in_pixels or page.units is None):
        return []
    if any("Adobe Illustrator" in remark for remark in remarks):
        return [_odd_pixels("Adobe Illustrator", ILLUSTRATOR, 'Set units = "pt".')]
    version = _VERSION.match(root.get("inkscape:version", ""))
    if version is not None and (int(version[1]), int(version[2])) < CHANGED:
        fix = "Save it with a newer Inkscape, which asks about this."
        return [_odd_pixels(f"Inkscape {version[0].strip()}", OLD_INKSCAPE, fix)]
    return []


def _odd_pixels(program: str, pixels: int, fix: str) -> Finding:
    message = (
        f"{program} wrote this drawing, which counts {pixels} pixels to the inch instead of {BROWSERS}: it was probably drawn "
        f"{BROWSERS / pixels:.6g} times as large as it is read"
    )
    return Finding("pixels", "warning", message, fix)


# SVG has no layers. Inkscape marks groups as such; elsewhere groups and closed outlines with a name of their own serve as
# layers, the innermost first. Names that programs make up (path1234, g10) are none. What has no name lies on layer 0, as in
# DXF.

_MADE_UP = re.compile(
    r"(?:path|line|polyline|polygon|rect|circle|ellipse|g|a|use|svg|text|image|symbol|SVGID)?[-_]?[0-9][0-9_.-]*", re.IGNORECASE
)
_ENCODED = re.compile(r"_x([0-9A-F]{2,4})_")  # how Illustrator writes blanks and underscores


class Place(NamedTuple):
    """The layer, and what named it: nothing yet, a name, or a layer of Inkscape."""

    layer: str = "0"
    named: bool = False
    inkscape: bool = False


def inside(place: Place, tag: str, attributes: Mapping[str, str], used: bool, closed: bool) -> Place:
    """The place of an element that lies at `place`; `used` says it is seen through a <use>, `closed` that it may be a layer.

    What is used again takes the layer of its <use>; only where that has none does its own name count.
    """
    if place.named and (used or tag == "use"):
        return place
    label = attributes.get("inkscape:label") or attributes.get("data-name") or ""
    identity = attributes.get("id", "")
    if attributes.get("inkscape:groupmode") == "layer":
        return Place(label or identity or "0", True, True)
    if not closed:
        return place
    if label:
        return Place(label, True, place.inkscape)
    if identity and not place.inkscape and _MADE_UP.fullmatch(identity) is None:
        return Place(_ENCODED.sub(lambda match: chr(int(match[1], 16)), identity), True)
    return place


FOREIGN = "element of another vocabulary"
BURIED = "element inside of one that holds none"
DRAWN = frozenset((*READERS, "use"))
TEMPLATES = frozenset(("clipPath", "mask", "pattern", "marker"))  # what they hold is never drawn
DEFINED = frozenset(("defs", "symbol"))


@dataclass
class LeftOut:
    """Counts of what is not drawn as it stands in the file, by layer, kind or name; and the elements met."""

    hidden: Counter[str] = field(default_factory=Counter)
    ignored: Counter[str] = field(default_factory=Counter)
    sizeless: Counter[str] = field(default_factory=Counter)
    clipped: int = 0
    marks: int = 0
    met: set[Node] = field(default_factory=set)

    def silent(self, node: Node) -> bool:
        """Is this an element that draws nothing? It is counted if something may be missed."""
        if node.tag.startswith("*:"):
            self.ignored.update([FOREIGN] if node.tag[2:] in DRAWN | CONTAINERS or drawn_within(node) else [])
            return True
        if node.tag not in SILENT:
            return False
        if node.tag in MOVING:
            self.ignored[node.tag] += 1
        elif node.tag not in TEMPLATES and node.tag not in DEFINED and (count := drawn_within(node)):
            self.ignored[BURIED] += count
        return True

    def findings(self, root: Node) -> list[Finding]:
        """One finding for each thing, however often."""
        result = []
        for layer, count in self.hidden.items():
            message = f"hidden elements (display, visibility, conditions) left out: {count}"
            result += [Finding("hidden", "notice", message, layer=layer)] if count else []
        result += [_ignored(kind, count) for kind, count in self.ignored.items()]
        for kind, count in self.sizeless.items():
            result.append(Finding("zero-size", "notice", f"{count} × {kind} of no size, and so not drawn"))
        if self.marks:
            result.append(Finding("point", "notice", f"circles of radius 0, read as points: {self.marks}"))
        if self.clipped:
            message = f"elements clipped or masked in the picture, here read whole: {self.clipped}"
            result.append(Finding("clipped", "warning", message))
        return [*result, *self._of_the_whole(root)]

    def _of_the_whole(self, root: Node) -> list[Finding]:
        """What shows only when all elements are looked at once."""
        strange: Counter[tuple[str, str]] = Counter()
        unused = 0
        waiting = [(root, False)]
        while waiting:
            node, defined = waiting.pop()
            strange.update((node.tag, name) for name in strange_attributes(node.tag, node.attributes))
            defined = defined or node.tag in DEFINED
            unused += defined and node.tag in DRAWN and node not in self.met
            unused += node.tag == "symbol" and "id" not in node.attributes
            waiting += [(child, defined) for child in node.children if child.tag not in TEMPLATES]
        result = []
        for (tag, name), count in strange.items():
            message = f'{count} × {tag} with an attribute "{name[:40]}" that it cannot have: the file may be damaged'
            result.append(Finding("strange-attribute", "warning", message, "Check its shape."))
        if unused:
            message = f"elements defined but never used, and so not drawn: {unused}"
            result.append(Finding("unused", "notice", message))
        return result


def _ignored(kind: str, count: int) -> Finding:
    if kind in TEXT_LIKE:
        return Finding("ignored", "notice", f"{count} × {kind} not read: it is not an outline")
    why = "it moves" if kind in MOVING else "no element known here; the file may be damaged"
    return Finding("ignored", "warning", f"{count} × {kind[:40]} not read: {why}")


def drawn_within(node: Node) -> int:
    """How many elements would be drawn if this one were shown."""
    count, waiting = 0, [node]
    while waiting:
        at = waiting.pop()
        count += at.tag in DRAWN
        waiting += [child for child in at.children if child.tag not in SILENT]
    return count


DEEPEST_USE = 32  # <use> within <use>
MOST_VISITS = 100_000  # to elements that are shown by a <use>


@dataclass(frozen=True, slots=True)
class Spot:
    """An element where it is drawn: its surroundings, and the spots it is nested in."""

    node: Node
    affine: Affine
    place: Place
    visible: bool
    width: float
    height: float
    above: Spot | None = None
    uses: int = 0
    size: tuple[str | None, str | None] = (None, None)  # width and height that a <use> prescribes


def read_svg(data: bytes, units: str | None, fit: float) -> Content:
    """The content of an SVG file, plain or packed. `units` overrules the page; `fit` is in metres.

    Never raises for what is in the file; `units` must be a known name (ValueError).
    """
    stated = page_unit(units) if units is not None else None
    tree = read_tree(data)
    root = tree.root
    if root is None:
        return Content(findings=tree.findings)
    if root.tag != "svg":
        what = f"<{root.tag[:40]}>" if ":" not in root.tag else "another kind of XML"
        return Content(findings=(*tree.findings, Finding("unreadable", "error", f"this is not an SVG file: it holds {what}")))
    styles = read_styles(tree.sheets)
    values = styles.of(root)
    page = read_page(values, stated)
    notes = (*tree.findings, *page.findings, *other_pixels(root.attributes, tree.remarks, page))
    found = Gathering(page.scale, fit, most_strokes(tree.size))
    walker = Walker(tree, styles, found)
    if not page.empty:
        try:
            walker.walk(Spot(root, page.root, Place(), True, page.width, page.height))
            follow(found)
        except TooLarge:
            message = "its elements are used so often that they expand to too many; nothing was read"
            findings = (*notes, Finding("too-large", "error", message, "Check its <use> elements."))
            return Content(units=page.units, units_from=page.units_from, findings=findings)
    else:
        found.findings.append(Finding("page", "warning", "the page has no width or no height: nothing of it is shown"))
    found.ignored = walker.left_out.ignored
    findings = (*notes, *styles.findings, *found.findings, *walker.left_out.findings(root))
    return found.content(page.units, page.units_from, findings)


class Walker:
    """Walks through the elements once, unfolding what is used; results go to `found`."""

    def __init__(self, tree: Tree, styles: Styles, found: Gathering) -> None:
        self.tree = tree
        self.styles = styles
        self.found = found
        self.visits = 0
        self.left_out = LeftOut()
        self.known: dict[tuple[Node, float, float], PathData | SvgError] = {}
        self.values: dict[Node, dict[str, str]] = {}

    def walk(self, root: Spot) -> None:
        """In the order of the document, with a stack of its own: no file is too deep for it."""
        waiting = [root]
        while waiting:
            spot = waiting.pop()
            self.visits += spot.uses > 0
            if self.visits > MOST_VISITS:
                raise TooLarge
            try:
                waiting.extend(reversed(list(self.within(spot))))
            except SvgError as error:
                self.report("damaged", f"{spot.node.name} cannot be read: {error}. It is left out", spot.place.layer)

    def report(self, code: str, message: str, layer: str) -> None:
        self.found.findings.append(Finding(code, "error", message, "", layer))

    def within(self, spot: Spot) -> Iterator[Spot]:
        """Draws the element if it is a shape; the spots of what it holds or uses."""
        node, tag = spot.node, spot.node.tag
        if not (tag == "symbol" and spot.uses) and self.left_out.silent(node):
            return
        self.left_out.met.add(node)
        if node not in self.values:
            self.values[node] = self.styles.of(node)
        values = self.values[node]
        spot = self.named(spot)
        if values.get("display") == "none" or not conditions_hold(node):
            self.left_out.hidden[spot.place.layer] += drawn_within(node)
        elif tag in READERS:
            self.left_out.ignored.update(BURIED for child in node.children if child.tag in DRAWN)
            self.draw(self.moved(spot, values), values)
        elif tag in CONTAINERS or tag == "symbol":
            spot = self.moved(spot, values)
            spot = self.viewport(spot, values) if tag in ("svg", "symbol") and node.parent is not None else spot
            yield from (self.below(spot, child) for child in node.children)
        elif tag == "switch":
            spot = self.moved(spot, values)
            known = [child for child in node.children if ":" not in child.tag and child.tag not in SILENT]
            chosen = [child for child in known if conditions_hold(child)][:1]
            self.left_out.hidden[spot.place.layer] += sum(drawn_within(child) for child in known if child not in chosen)
            yield from (self.below(spot, child) for child in chosen)
        elif tag == "use":
            yield from self.used(self.moved(spot, values), values)
        else:
            self.left_out.ignored[tag] += 1

    def named(self, spot: Spot) -> Spot:
        """The spot on the layer that the element itself names; only open lines and paths wait for others to close them."""
        node = spot.node
        closed = node.parent is not None and node.tag not in ("line", "polyline")
        if closed and node.tag == "path" and not spot.place.inkscape and "id" in node.attributes:
            data = self.read(spot)
            closed = isinstance(data, SvgError) or all(row.closed for row in data.rows)
        place = inside(spot.place, node.tag, node.attributes, spot.uses > 0, closed)
        return spot if place is spot.place else replace(spot, place=place)

    def moved(self, spot: Spot, values: dict[str, str]) -> Spot:
        """The spot after the element's own transformation, with its visibility."""
        visible = {"visible": True, "hidden": False, "collapse": False}.get(values.get("visibility", ""), spot.visible)
        self.left_out.clipped += values.get("clip-path", "none") != "none" or values.get("mask", "none") != "none"
        inner = placed(values, spot.width, spot.height)
        if inner is IDENTITY:
            return spot if visible == spot.visible else replace(spot, visible=visible)
        return replace(spot, affine=self.turned(spot.affine, inner), visible=visible)

    def turned(self, outer: Affine, inner: Affine) -> Affine:
        affine = outer.after(inner)
        if not max(map(abs, (*affine.ax, *affine.ay, *affine.origin))) <= LARGEST:
            raise SvgError("its transform puts it beyond any drawing")
        if affine.ax[0] * affine.ay[1] == affine.ax[1] * affine.ay[0]:
            raise SvgError("its transform flattens it")
        return affine

    def below(self, spot: Spot, child: Node) -> Spot:
        return Spot(child, spot.affine, spot.place, spot.visible, spot.width, spot.height, spot, spot.uses)

    def viewport(self, spot: Spot, values: dict[str, str]) -> Spot:
        """The spot inside a nested <svg> or a <symbol>."""
        if "refX" in values or "refY" in values:
            raise SvgError("its refX and refY are not read")
        sides = {**values, **{name: value for name, value in zip(("width", "height"), spot.size, strict=True) if value}}
        m = Measures(sides, spot.width, spot.height)
        width, height = m.along("width", spot.width), m.up("height", spot.height)
        if width < 0.0 or height < 0.0:
            raise SvgError(f"its size is {width:g} × {height:g}")
        box = view_box(values.get("viewBox"))
        known = spot.width > 0.0 and spot.height > 0.0
        if (m.given("width") and width == 0.0) or (m.given("height") and height == 0.0):
            raise SvgError("its viewport has no size, so that nothing of it is drawn")
        inner = shifted((m.along("x"), m.up("y"), 0.0))
        if box is not None:
            if not known and not (m.given("width") and m.given("height")):
                raise SvgError("its size is a part of a page whose size is not given")
            sx, sy, tx, ty = fitted(box, width, height, values.get("preserveAspectRatio"))
            inner = inner.after(plane(sx, 0.0, 0.0, sy, tx, ty))
            width, height = box.width, box.height
        return replace(spot, affine=self.turned(spot.affine, inner), width=width, height=height)

    def used(self, spot: Spot, values: dict[str, str]) -> Iterator[Spot]:
        """The element that a <use> shows, where it shows it."""
        node, layer = spot.node, spot.place.layer
        reference = values.get("href", values.get("xlink:href", "")).strip()
        target = self.tree.by_id.get(reference[1:]) if reference.startswith("#") else None
        if target is None:
            outside = reference and not reference.startswith("#")
            why = "which is another file and never opened" if outside else "which is not in the file"
            what = f'{node.name} shows "{reference[:60]}", {why}' if reference else f"{node.name} names nothing to show"
            self.report("external" if outside else "use-missing", f"{what}; it is left out", layer)
            return
        above: Spot | None = spot
        while above is not None and above.node is not target:
            above = above.above
        if spot.uses >= DEEPEST_USE or above is not None:
            why = "is nested too deeply" if spot.uses >= DEEPEST_USE else f"shows {target.name}, of which it is a part"
            self.report("use-loop", f"{node.name} {why}; it is left out", layer)
            return
        m = Measures(values, spot.width, spot.height)
        x, y = m.along("x"), m.up("y")
        affine = self.turned(spot.affine, shifted((x, y, 0.0))) if x or y else spot.affine
        size = (values.get("width"), values.get("height")) if target.tag in ("svg", "symbol") else (None, None)
        yield Spot(target, affine, spot.place, spot.visible, spot.width, spot.height, spot, spot.uses + 1, size)

    def read(self, spot: Spot) -> PathData | SvgError:
        """The shapes of an element in its user units, read once."""
        key = (spot.node, spot.width, spot.height)
        if key not in self.known:
            try:
                measures = Measures(self.values[spot.node], spot.width, spot.height)
                self.known[key] = READERS[spot.node.tag](measures)
            except SvgError as error:
                self.known[key] = error
        return self.known[key]

    def draw(self, spot: Spot, values: dict[str, str]) -> None:
        node, layer = spot.node, spot.place.layer
        if not spot.visible:
            self.left_out.hidden[layer] += 1
            return
        if values is not node.attributes and values.get("d") != node.attributes.get("d"):
            raise SvgError("its shape is given by CSS, which is not read")
        data = self.read(spot)
        if isinstance(data, SvgError):
            raise data
        if data.fault:
            message = f"{node.name} cannot be read to its end: {data.fault}. What comes before is drawn"
            self.report("damaged", message, layer)
        if not data.rows and not data.fault:
            self.left_out.sizeless[node.tag] += 1
        self.left_out.marks += any(isinstance(shape, Dot) for row in data.rows for shape in row.shapes)
        for row in data.rows:
            self.found.runs += 1
            emit_row(self.found, [shape.mapped(spot.affine) for shape in row.shapes], layer, node.name)


def conditions_hold(node: Node) -> bool:
    """Is the element drawn by a program that knows no extensions and speaks English?"""
    if node.attributes.get("requiredExtensions"):
        return False
    languages = node.attributes.get("systemLanguage")
    return languages is None or any(word.strip().lower().split("-")[0] == "en" for word in languages.split(","))
