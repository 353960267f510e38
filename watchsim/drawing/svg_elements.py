"""Which elements does an SVG file hold, and which names of elements and attributes does SVG know?

A tree of elements, read with expat. Nothing outside the file is ever opened. Entities of the document type may stand for
plain text or elements (drawing programs write their namespaces so); those that name others, that lie outside or that would
unfold into too much are refused.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field
from xml.parsers import expat

from watchsim.drawing.findings import Finding, words

NONE = ""  # no namespace
SVG = "http://www.w3.org/2000/svg"
PREFIXES = {"http://www.w3.org/1999/xlink": "xlink", "http://www.inkscape.org/namespaces/inkscape": "inkscape"}
DEEPEST = 256  # elements within elements
MOST_ELEMENTS = 300_000
MOST_UNPACKED = 64 * 2**20  # bytes in a .svgz
MOST_UNFOLDED = 16 * 2**20  # bytes that the entities of a file may become
# Elements that hold no text
WORDLESS = words("svg g defs symbol switch use path rect circle ellipse line polyline polygon")
PREDEFINED = words("amp lt gt apos quot")
CUT_SHORT = frozenset(
    expat.errors.codes[getattr(expat.errors, f"XML_ERROR_{name}")]
    for name in ("NO_ELEMENTS", "UNCLOSED_TOKEN", "PARTIAL_CHAR", "UNCLOSED_CDATA_SECTION")
)
_REFERENCE = re.compile(rb"&([A-Za-z_:][\w.:-]*);")
_STYLESHEET = re.compile(r"href\s*=\s*[\"']([^\"']*)")


class SvgError(ValueError):
    """What is wrong with a file or an element, as part of a sentence."""


@dataclass(slots=True, eq=False)
class Node:
    """One element. `tag` is its name in SVG; of other vocabularies "prefix:name", or "*:name" where they are declared.

    Attribute names are as written, with the prefixes "xlink" and "inkscape" for those two namespaces.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    parent: Node | None
    children: list[Node] = field(default_factory=list)
    text: str = ""

    @property
    def name(self) -> str:
        """As it is named in messages."""
        identity = self.attributes.get("id")
        return f"{self.tag} #{identity[:60]}" if identity else f"{self.tag} in line {self.line}"


@dataclass(frozen=True)
class Tree:
    """The root (None where the file is no XML at all), all elements by id, the style sheets, and what was wrong.

    `remarks` are the comments before the root, where programs sign; `size`: how many bytes there were, unpacked.
    """

    root: Node | None
    by_id: dict[str, Node]
    sheets: tuple[str, ...]
    findings: tuple[Finding, ...]
    remarks: tuple[str, ...] = ()
    size: int = 0


def read_tree(data: bytes) -> Tree:
    """All elements up to the first fault, which is a finding of severity "error"."""
    builder = _Builder()
    findings: list[Finding] = []
    try:
        data = unpacked(data, findings)
        builder.parse(data)
    except SvgError as error:
        findings.append(Finding("unreadable", "error", str(error)))
        return Tree(None, {}, (), tuple(findings))
    except expat.ExpatError as error:
        findings.append(_fault(error, builder, data))
    except (ValueError, LookupError) as error:  # an encoding that expat cannot use
        findings.append(Finding("unreadable", "error", f"this is not an SVG file ({error})"))
    findings += builder.findings
    sheets = tuple(node.text for node in builder.styles)
    if builder.nameless and builder.root is not None:
        findings.append(_nameless(builder))
    return Tree(builder.root, builder.by_id, sheets, tuple(findings), tuple(builder.remarks), len(data))


def _nameless(builder: _Builder) -> Finding:
    """Browsers and drawing programs draw only what is in the namespace of SVG."""
    what = f"{builder.nameless} of {builder.count} elements are in no namespace: browsers do not draw them"
    if builder.nameless == builder.count:
        what = "the file names no namespace: browsers draw nothing of it"
    return Finding("namespace", "warning", f"{what}; here they are read", f'Write xmlns="{SVG}" in the svg element.')


def unpacked(data: bytes, findings: list[Finding]) -> bytes:
    """The file itself, or what a .svgz (gzip) holds; text of two bytes a character becomes UTF-8."""
    if data[:2] == b"\x1f\x8b":
        stream = zlib.decompressobj(31)
        try:
            data = stream.decompress(data, MOST_UNPACKED)
        except zlib.error as error:
            raise SvgError(f"it cannot be unpacked ({error})") from None
        if stream.unconsumed_tail:
            raise SvgError(f"it unpacks into more than {MOST_UNPACKED // 2**20} MB")
        if not stream.eof:
            findings.append(Finding("truncated", "error", "the packed file is cut short", "Save or copy the file again."))
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        try:
            return data.decode("utf-16").encode()
        except UnicodeError as error:
            raise SvgError(f"its text cannot be decoded ({error})") from None
    return data


def _fault(error: expat.ExpatError, builder: _Builder, data: bytes) -> Finding:
    reason = expat.errors.messages.get(error.code, "it is not well formed")
    if builder.root is None:
        what = "it is empty" if not data.strip() else f"{reason} in line {error.lineno}"
        return Finding("unreadable", "error", f"this is not an SVG file: {what}")
    last = f"the last whole element is {builder.last.name}" if builder.last else "no element is whole"
    if builder.here is None and b"<" not in data[builder.end :]:
        message = f"there is something after the end of the drawing, in line {error.lineno}; it was not read"
        return Finding("trailing", "warning", message)
    if error.code in CUT_SHORT:
        message = f"the file ends in line {error.lineno} inside <{builder.inside}>; {last}"
        return Finding("truncated", "error", message, "Save or copy the file again.")
    message = f"line {error.lineno}, column {error.offset + 1}: {reason}; what follows was not read; {last}"
    return Finding("damaged", "error", message, "Save the file again.")


class _Builder:
    """Makes nodes from what expat reports."""

    def __init__(self) -> None:
        self.root: Node | None = None
        self.here: Node | None = None
        self.last: Node | None = None
        self.end = 0
        self.depth = 0
        self.count = 0
        self.spaces: list[dict[str, str]] = [{"": NONE}]
        self.nameless = 0
        self.by_id: dict[str, Node] = {}
        self.styles: list[Node] = []
        self.findings: list[Finding] = []
        self.remarks: list[str] = []
        self.entities: dict[str, int] = {}
        self.has_doctype = False

    @property
    def inside(self) -> str:
        return self.here.tag if self.here else "svg"

    def parse(self, data: bytes) -> None:
        self.parser = parser = expat.ParserCreate(encoding="utf-8" if _was_recoded(data) else None)
        parser.buffer_text = True
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.finish
        parser.CharacterDataHandler = self.characters
        parser.StartDoctypeDeclHandler = lambda *_: setattr(self, "has_doctype", True)
        parser.EndDoctypeDeclHandler = lambda: self.check_entities(data)
        parser.EntityDeclHandler = self.entity
        parser.SkippedEntityHandler = lambda name, _: self.refuse(f"the entity {name} is not declared in the file")
        parser.ExternalEntityRefHandler = lambda *_: self.refuse("it refers to another file, which is never opened")
        parser.ProcessingInstructionHandler = self.instruction
        parser.CommentHandler = lambda text: self.remarks.append(text) if self.root is None else None
        parser.Parse(data, True)

    def refuse(self, message: str) -> int:
        raise SvgError(message)

    def entity(self, name: str, parameter: bool, value: str | None, *_: object) -> None:
        if value is None or parameter:
            raise SvgError(f'the entity "{name[:60]}" lies outside the file or steers how it is read; it is not followed')
        if "&" in value or "%" in value:
            raise SvgError(f'the entity "{name[:60]}" is made of other entities, which is refused')
        self.entities[name] = len(value.encode())

    def check_entities(self, data: bytes) -> None:
        """Bounds what the entities unfold into before the first of them is met."""
        names = [name.decode(errors="replace") for name in _REFERENCE.findall(data)]
        unknown = [name for name in names if name not in self.entities and name not in PREDEFINED]
        if unknown:
            raise SvgError(f'the entity "{unknown[0][:60]}" is not declared in the file')
        if sum(self.entities.get(name, 1) for name in names) > MOST_UNFOLDED:
            raise SvgError(f"its entities unfold into more than {MOST_UNFOLDED // 2**20} MB; such files are refused")

    def instruction(self, target: str, text: str) -> None:
        if target == "xml-stylesheet":
            where = _STYLESHEET.search(text)
            message = f"the style sheet {where[1][:60] if where else text[:60]} is another file and was not read"
            self.findings.append(Finding("external", "warning", message, "What it hides is shown here."))

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        self.count += 1
        if self.depth > DEEPEST:
            raise SvgError(f"its elements are nested more than {DEEPEST} deep (line {self.parser.CurrentLineNumber})")
        if self.count > MOST_ELEMENTS:
            raise SvgError(f"it holds more than {MOST_ELEMENTS} elements")
        spaces = self.spaces[-1]
        if any(key.startswith("xmlns") for key in attributes):
            spaces = {**spaces, **{key[6:]: value or NONE for key, value in attributes.items() if key.startswith("xmlns")}}
        self.spaces.append(spaces)
        self.nameless += ":" not in tag and spaces[""] == NONE
        node = Node(_resolved(tag, spaces), _prefixed(attributes, spaces), self.parser.CurrentLineNumber, self.here)
        if self.here is None:
            self.root = node
        else:
            self.here.children.append(node)
        if (identity := attributes.get("id")) is not None:
            self.by_id.setdefault(identity, node)
        if node.tag == "style":
            self.styles.append(node)
        self.here = node

    def finish(self, _tag: str) -> None:
        assert self.here is not None
        self.last = self.here
        self.here = self.here.parent
        self.depth -= 1
        self.spaces.pop()
        self.end = self.parser.CurrentByteIndex + 1

    def characters(self, text: str) -> None:
        if self.here is None:
            return
        if self.here.tag == "style":
            self.here.text += text
        elif text.strip() and self.here.tag in WORDLESS:
            message = f'"{text.strip()[:40]}" stands between the elements near line {self.parser.CurrentLineNumber}'
            self.findings.append(Finding("stray-text", "warning", f"{message}: the file may be damaged"))


def _was_recoded(data: bytes) -> bool:
    """Is this UTF-8 although its first line may still say UTF-16?"""
    return re.match(rb"\s*<\?xml[^>]*encoding\s*=\s*[\"']utf-16", data, re.IGNORECASE) is not None


def _resolved(tag: str, spaces: dict[str, str]) -> str:
    prefix, _, local = tag.rpartition(":")
    space = spaces.get(prefix)
    if space in (SVG, NONE):
        return local
    return tag if space is None else f"*:{local}"


def _prefixed(attributes: dict[str, str], spaces: dict[str, str]) -> dict[str, str]:
    if not any(":" in key for key in attributes):
        return attributes
    result = {}
    for key, value in attributes.items():
        prefix, _, local = key.rpartition(":")
        known = PREFIXES.get(spaces.get(prefix, ""))
        result[f"{known}:{local}" if known else key] = value
    return result


CONTAINERS = words("g a svg")
SILENT = words(  # neither drawn by themselves nor missed
    """defs symbol clipPath mask pattern marker linearGradient radialGradient meshgradient filter style script title desc
    metadata view cursor font font-face glyph stop animate animateColor animateMotion animateTransform set solidcolor hatch
    color-profile discard"""
)
TEXT_LIKE = words(
    """text tspan textPath tref image foreignObject flowRoot flowPara flowRegion altGlyph video audio canvas iframe mesh"""
)
MOVING = words("animateMotion animateTransform")
_ANY = words(
    """id class style transform lang tabindex requiredFeatures requiredExtensions systemLanguage externalResourcesRequired
    pathLength transform-origin transform-box autofocus role space base alignment-baseline baseline-shift clip clip-path
    clip-rule color color-interpolation color-interpolation-filters color-profile color-rendering cursor direction display
    dominant-baseline enable-background fill fill-opacity fill-rule filter flood-color flood-opacity font font-family font-size
    font-size-adjust font-stretch font-style font-variant font-weight glyph-orientation-horizontal glyph-orientation-vertical
    image-rendering kerning letter-spacing lighting-color marker marker-end marker-mid marker-start mask opacity overflow
    paint-order pointer-events shape-rendering solid-color solid-opacity stop-color stop-opacity stroke stroke-dasharray
    stroke-dashoffset stroke-linecap stroke-linejoin stroke-miterlimit stroke-opacity stroke-width text-align text-anchor
    text-decoration text-overflow text-rendering unicode-bidi vector-effect visibility white-space word-spacing writing-mode
    mix-blend-mode isolation line-height xmlns"""
)
_VIEWPORT = "x y width height viewBox preserveAspectRatio"
_OWN = {
    **{"path": words("d"), "line": words("x1 y1 x2 y2"), "polyline": words("points"), "polygon": words("points")},
    **{"rect": words("x y width height rx ry"), "circle": words("cx cy r"), "ellipse": words("cx cy rx ry")},
    **{
        "use": words("x y width height href"),
        "symbol": words(f"{_VIEWPORT} refX refY"),
        "defs": words(""),
        "switch": words(""),
    },
    "svg": words(f"{_VIEWPORT} version baseProfile zoomAndPan contentScriptType contentStyleType"),
    "g": words("x y width height"),  # without meaning, and often written
}


def strange_attributes(tag: str, attributes: dict[str, str]) -> list[str]:
    """Attributes that this element cannot have: perhaps a damaged name, whose value is then missing."""
    known = _ANY | _OWN[tag] if tag in _OWN else attributes
    names = (name for name in attributes if name not in known and ":" not in name)
    return [name for name in names if not name.startswith(("on", "data-", "aria-"))]
