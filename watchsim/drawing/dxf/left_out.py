"""What was left out, and does it matter?"""

from __future__ import annotations

from watchsim.drawing.curves.plane_projection import Gathering
from watchsim.drawing.dxf.sections import Layer
from watchsim.drawing.findings import Finding

TEXT_LIKE = frozenset(
    (
        *("TEXT", "MTEXT", "RTEXT", "ATTRIB", "ATTDEF", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "TOLERANCE"),
        *("LEADER", "MULTILEADER", "MLEADER", "VIEWPORT", "HATCH", "IMAGE", "WIPEOUT", "ACAD_TABLE", "OLEFRAME", "OLE2FRAME"),
    )
)
KNOWN_BUT_NOT_READ = frozenset(
    (
        *("POLYLINE", "3DFACE", "SOLID", "TRACE", "MLINE", "REGION", "BODY", "3DSOLID", "MESH", "RAY", "XLINE", "SHAPE"),
        *("SURFACE", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "REVOLVEDSURFACE", "SWEPTSURFACE", "PLANESURFACE", "HELIX"),
        *("UNDERLAY", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY", "LIGHT", "SUN", "POINTCLOUD", "GEOPOSITIONMARKER"),
        *("ACAD_PROXY_ENTITY", "SECTION"),
    )
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
    for kind, count in found.ignored.items():
        result.append(_ignored(kind, count))
    return result


def _ignored(kind: str, count: int) -> Finding:
    if kind in TEXT_LIKE:
        return Finding("ignored", "notice", f"{count} × {kind} not read: it is not an outline")
    if kind in KNOWN_BUT_NOT_READ:
        return Finding("ignored", "warning", f"{count} × {kind} not read", "Draw it with lines and arcs where it matters.")
    message = f"{count} × {kind[:40]} not read: no type of entity known here; the file may be damaged"
    return Finding("ignored", "warning", message)
