"""Which program wrote this SVG file, and is its pixel that of browsers?

A pixel is 1/96 inch since CSS 2.1. Adobe Illustrator writes points (1/72 inch) and calls them pixels; Inkscape counted 1/90
inch up to version 0.91 (its release notes of 0.92). Such drawings come out too small without being wrong in any place.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from watchsim.drawing.findings import Finding
from watchsim.drawing.svg.svg_page import Page

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
        return [_warning("Adobe Illustrator", ILLUSTRATOR, 'Set units = "pt".')]
    version = _VERSION.match(root.get("inkscape:version", ""))
    if version is not None and (int(version[1]), int(version[2])) < CHANGED:
        return [
            _warning(f"Inkscape {version[0].strip()}", OLD_INKSCAPE, "Save it with a newer Inkscape, which asks about this.")
        ]
    return []


def _warning(program: str, pixels: int, fix: str) -> Finding:
    message = (
        f"{program} wrote this drawing, which counts {pixels} pixels to the inch instead of {BROWSERS}: it was probably drawn "
        f"{BROWSERS / pixels:.6g} times as large as it is read"
    )
    return Finding("pixels", "warning", message, fix)
