"""On which layer does an SVG element lie?

SVG has no layers. Inkscape marks groups as such; elsewhere groups and closed outlines with a name of their own serve as
layers, the innermost first. Names that programs make up (path1234, g10) are none. What has no name lies on layer 0, as in DXF.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

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
