"""How is a small SVG file damaged at random?

One accident per file: bytes, numbers, names, letters of paths, lines, the nesting of elements, or the end of the file.
"""

import random
import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from xml.parsers.expat import ExpatError

import accidents
from accidents import Accident, after_accidents, bytes_overwritten, cut_off, line_lost, lines_swapped

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "naive"))
import svg_length

ENDING = "svg"
TOLD = ("hidden", "unused", "zero-size", "page", "edge-on")  # findings that account for elements not drawn
NUMBERS = (*accidents.NUMBERS, b"50%", b"2em")
NAMES = (
    *(b"rect", b"circle", b"path", b"g", b"use", b"symbol", b"defs", b"svg", b"style", b"switch", b"text", b"polygon", b"line"),
    *(b"id", b"d", b"r", b"cx", b"x", b"width", b"points", b"transform", b"viewBox", b"href", b"class", b"xmlns", b"clip-path"),
)
FRAGMENTS = (
    *(b"<g>", b"</g>", b"</svg>", b"<!--", b"-->", b"<![CDATA[", b"]]>", b"&amp;", b"&x;", b"<use href='#a'/>", b"<?x?>"),
    b"<x:y>",
    *(b"<!DOCTYPE svg [<!ENTITY x 'y'>]>", b"\x00", b"\xff\xfe", b'"', b"'", b">", b"<defs>", b"</defs>"),
    b"transform='scale(0)'",
)
HEAD = 'xmlns="http://www.w3.org/2000/svg"\nxmlns:xlink="http://www.w3.org/1999/xlink"'


def samples() -> list[bytes]:
    """Whole files without any finding. Lines end inside of tags, so that no line alone is a whole element."""
    return [every_element(), nested(), layered()]


def every_element() -> bytes:
    """Every element that is drawn, all outlines closed."""
    return f"""<?xml version="1.0" encoding="utf-8"?>
<svg
{HEAD}
width="100mm" height="80mm"
viewBox="0 0 100 80"
><path id="a1"
d="M1 1L5,1 5-3 Q7 0 9,4 T 5 9 S3 3 2 9C1 7 0 5 1 1z m40 40 h3v3 H41 Z"
/><path
d="M60 10a3 3 0 1 0 6 0A3 3 0 10 60 10Z"
/><rect
x="10" y="20"
width="5" height="4" rx="1"
/><circle
cx="30" cy="20"
r="2.15"
/><ellipse
cx="45" cy="20" rx="3" ry="2"
/><polygon
points="60,20 64,20
64,25"
/><polyline points="70,20 74,20 74,25
70,20"
/><line
x1="80" y1="20" x2="85" y2="20"
/><path
d="M85 20L85 25L80 20"
/></svg>""".encode()


def nested() -> bytes:
    """Groups, transformations, symbols, viewports and what is used again."""
    return f"""<svg
{HEAD} width="10cm" height="10cm"
viewBox="-50 -50 100 100"
preserveAspectRatio="xMinYMax slice"><defs
><symbol id="tooth" viewBox="0 0 10 10"
><path
d="M1 1H9V9z"
/></symbol><circle id="hub"
r="5"
/><g id="wheel"
><circle r="7"
/><circle
r="6" cx="1"
/></g></defs><g
transform="translate(3,4) rotate(30)"
><use xlink:href="#tooth" x="1" y="2"
width="20" height="20"
/><g transform="scale(1 -1)"
><use href="#wheel"
transform="matrix(1 0 0 1 20 -10)"
/></g></g><svg x="-40" y="-40"
width="20" height="10" viewBox="0 0 40 20"
><rect
width="8" height="8"
/></svg><use
href="#hub" x="-20" y="30"
/></svg>""".encode()


def layered() -> bytes:
    """Layers, styles, a switch, and a document type with an entity, as drawing programs write them."""
    return f"""<!DOCTYPE svg [
<!ENTITY ns "http://www.w3.org/2000/svg"> ]>
<svg {HEAD.replace("http://www.w3.org/2000/svg", "&ns;")}
xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
width="4in" height="3in"
><style
>.shown {{ display: inline }}
#pivot {{ visibility: visible }}</style><g
inkscape:groupmode="layer"
inkscape:label="TEETH"
><rect class="shown"
width="10" height="12"
/><switch
><g systemLanguage="en"
><path style="fill:none;display:inline"
d="M 100 100 l 50 0 0 30 z"
/></g></switch></g><g id="HUB"
><circle id="pivot" cx="50" cy="60"
r="4"
/></g></svg>""".encode()


def entities(data: bytes) -> int:
    """How many pieces are drawn by a plain look at the elements: of a path each part; what is used counts once."""
    try:
        return sum(map(pieces, svg_length.tree(data).iter()))
    except (ExpatError, ValueError, LookupError):
        return 0


def pieces(element: ET.Element) -> int:
    kind = svg_length.local(element)
    if kind != "path":
        return kind in svg_length.DRAWN
    rows = re.findall(r"[Mm]([^Mm]*)", element.get("d", ""))
    return sum(re.search(r"[ZzLlHhVvCcSsQqTtAa]", row) is not None for row in rows)


def lost(data: bytes) -> bool:
    """Is the file no XML, or does a drawn element stand where it is text?"""
    try:
        root = svg_length.tree(data)
    except (ExpatError, ValueError, LookupError):
        return True
    begun = sum(svg_length.local(element) in svg_length.DRAWN for element in root.iter())
    plain = re.sub(rb"<!--.*?-->", b"", data, flags=re.DOTALL)
    return len(re.findall(rb"<(?:%s)\b" % "|".join(svg_length.DRAWN).encode(), plain)) > begun


def length(path: Path) -> float | None:
    """How much `tests/naive/svg_length.py` draws, in units of the page; None where it gives up."""
    try:
        return svg_length.length(path.read_bytes())
    except Exception:
        return None


def mutate(rng: random.Random, data: bytes) -> bytes:
    """The file after one to three accidents."""
    return after_accidents(rng, data, ACCIDENTS)


def _replaced(rng: random.Random, data: bytes, pattern: bytes, words: tuple[bytes, ...]) -> bytes:
    places = list(re.finditer(pattern, data))
    if not places:
        return data
    place = rng.choice(places)
    return data[: place.start()] + rng.choice(words) + data[place.end() :]


def number_changed(rng: random.Random, data: bytes) -> bytes:
    return _replaced(rng, data, rb"-?[0-9.]+", NUMBERS)


def name_changed(rng: random.Random, data: bytes) -> bytes:
    return _replaced(rng, data, rb"[A-Za-z][\w:-]*", NAMES)


def letter_changed(rng: random.Random, data: bytes) -> bytes:
    """Path commands, units and names alike."""
    return _replaced(rng, data, rb"[A-Za-z]", tuple(bytes([letter]) for letter in b"MmZzLlHhVvCcSsQqTtAaeX#,"))


def fragment_inserted(rng: random.Random, data: bytes) -> bytes:
    at = rng.randrange(len(data))
    return data[:at] + rng.choice(FRAGMENTS) + data[at:]


def nesting_changed(rng: random.Random, data: bytes) -> bytes:
    """A tag moves to another place, or is lost."""
    tags = list(re.finditer(rb"<[^<>]*>", data))
    if not tags:
        return data
    tag, place = rng.choice(tags), rng.choice(tags)
    rest = data[: tag.start()] + data[tag.end() :]
    at = min(place.start(), len(rest))
    return rest[:at] + tag[0] + rest[at:]


def lines_doubled(rng: random.Random, data: bytes) -> bytes:
    return accidents.lines_doubled(rng, data, most=12)


ACCIDENTS: tuple[Accident, ...] = (
    *(bytes_overwritten, cut_off, line_lost, lines_swapped, lines_doubled, number_changed, name_changed, letter_changed),
    *(fragment_inserted, nesting_changed),
)
