"""Which lines and arcs does this SVG file hold?

Every element that is drawn is read by itself, symbols and groups are unfolded where they are used, and everything is placed
in the plane with y upwards. Lines, circles and circular arcs stay exact; ellipses and Béziers are followed by arcs. Nothing
is left out without a finding.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from watchsim.drawing.content import Content
from watchsim.drawing.curves.affine import IDENTITY, Affine, shifted
from watchsim.drawing.curves.bezier_to_arcs import emit_row
from watchsim.drawing.curves.curves_to_arcs import follow
from watchsim.drawing.curves.plane_projection import Gathering, TooLarge, most_strokes
from watchsim.drawing.curves.plane_shapes import Dot
from watchsim.drawing.dxf_records import LARGEST
from watchsim.drawing.findings import Finding
from watchsim.drawing.svg.authoring_program import other_pixels
from watchsim.drawing.svg.css import Styles, read_styles
from watchsim.drawing.svg.element_layers import Place, inside
from watchsim.drawing.svg.element_names import CONTAINERS, SILENT
from watchsim.drawing.svg.element_shapes import READERS, Measures
from watchsim.drawing.svg.path_data import PathData
from watchsim.drawing.svg.svg_page import page_unit, read_page
from watchsim.drawing.svg.transforms import fitted, placed, plane, view_box
from watchsim.drawing.svg.unread_elements import BURIED, DRAWN, LeftOut, drawn_within
from watchsim.drawing.svg.xml_elements import Node, SvgError, Tree, read_tree

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
    return Content(
        strokes=tuple(found.strokes),
        points=tuple(found.points),
        units=page.units,
        units_from=page.units_from,
        fitted_curves=found.curves,
        fitted_arcs=found.arcs,
        fitted_deviation=found.deviation,
        drawn=found.drawn(),
        ignored=dict(walker.left_out.ignored),
        findings=(*notes, *styles.findings, *found.findings, *walker.left_out.findings(root)),
    )


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
        if spot.uses >= DEEPEST_USE or lies_in(spot, target):
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


def lies_in(spot: Spot, node: Node) -> bool:
    """Is the spot part of what this element draws?"""
    at: Spot | None = spot
    while at is not None:
        if at.node is node:
            return True
        at = at.above
    return False


def conditions_hold(node: Node) -> bool:
    """Is the element drawn by a program that knows no extensions and speaks English?"""
    if node.attributes.get("requiredExtensions"):
        return False
    languages = node.attributes.get("systemLanguage")
    return languages is None or any(word.strip().lower().split("-")[0] == "en" for word in languages.split(","))
