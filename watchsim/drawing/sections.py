"""Which outlines does a solid show where it is cut?

The plane of the drawing is the x-y plane of the file, heights are along its z axis. The straight pieces of a cut become the
lines and arcs that the mesh was made of, and go on as those of any drawing do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from watchsim.drawing.facets import fitted
from watchsim.drawing.findings import UNITS, Content, Drawn, Finding, Stroke, named_length
from watchsim.geometry.meshes import solids_of
from watchsim.geometry.sections import Slab, outlines_at, slabs

ROUNDING = float(np.finfo(np.float32).eps)  # of the coordinates: most files hold 32 bits
ALIKE = 1e-8  # m: thicknesses this close are the same, and the lowest slab is proposed
SHOWN = 12  # heights in a message


SHORT = "the file holds no triangle, or was cut short"


def read_solid(data: bytes, ending: str, units: str | None, fit: float, section: float | None) -> Content:
    """What a cut at the height `section` (m) shows; without one, that of a plate, which is the same at all heights.

    ValueError where `units` is not a unit of length.
    """
    stated = named_length(units) if units is not None else None
    if ending == "stl" and _is_short(data):
        return _nothing("empty", SHORT, "Export the solid again.")
    try:
        solids, own = solids_of(data, ending, fit)
    except ImportError as error:
        fix = "Install them with pip install 'watchsim[solids]', or save the solid as STL."
        return _nothing("format", f"{ending.upper()} files need packages that are not installed ({error})", fix)
    except Exception as error:  # each reader of trimesh has exceptions of its own
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        return _nothing("damaged", f"it cannot be read as {ending.upper()}: {reason}", "Export the solid again.")
    solids = [solid for solid in solids if len(solid.faces)]
    if not solids:
        return _nothing("empty", SHORT, "Export the solid again.")
    known = dict(UNITS)
    name, metres = stated or (own, known.get(own or "", 1e-3))
    findings = [_open_mesh(solid.name, solid.open_edges) for solid in solids if solid.open_edges]
    if stated and own and known[own] != metres:
        message = f"the file says {own}, you say {name}: everything is {metres / known[own]:.6g} times as large"
        findings.append(Finding("units-overruled", "warning", message))
    solids = [solid._replace(vertices=metres * solid.vertices) for solid in solids]
    rounding = ROUNDING * max(float(np.abs(solid.vertices).max()) for solid in solids)
    heights = tuple(slabs(solids, rounding))
    if not heights:
        return _nothing("empty", "the solid has no height: all of it lies in planes across z", "Export a solid, not a face.")
    at, faults = _height(heights, section, rounding)
    strokes: list[Stroke] = []
    corners = arcs = 0
    deviation = 0.0
    for solid in solids:  # each is a layer
        for outline in outlines_at(solid, at, rounding):
            found = fitted(*outline, fit, rounding)
            run = len(strokes)
            strokes += [Stroke(edge, solid.name, f"edge {run + k}", run) for k, edge in enumerate(found.edges, 1)]
            corners += len(outline.corners)
            arcs, deviation = arcs + found.arcs, max(deviation, found.deviation)
    return Content(
        strokes=tuple(strokes),
        units=name,
        units_from="option" if stated else "header" if own else None,
        fitted_curves=arcs,
        fitted_arcs=arcs,
        fitted_deviation=deviation,
        drawn=Drawn({"corner": corners}, math.fsum(stroke.edge.length for stroke in strokes)),
        section=at,
        slabs=heights,
        findings=(*faults, *findings),
    )


def _is_short(data: bytes) -> bool:
    """Is this neither text nor a whole binary STL: 80 bytes, the number of triangles, and 50 bytes for each?"""
    return data.lstrip()[:5].lower() != b"solid" and len(data) < 84 + 50 * int.from_bytes(data[80:84], "little")


def _nothing(code: str, message: str, fix: str) -> Content:
    return Content(findings=(Finding(code, "error", message, fix),))


def _open_mesh(layer: str, count: int) -> Finding:
    """A warning: only where the cut meets the hole the outline is open, which is an error of its own."""
    message = f"the mesh is not closed: {count} of its edges belong to one face only, or to three"
    return Finding("mesh", "warning", message, "Repair the mesh, or export it again.", layer)


def _height(heights: Sequence[Slab], section: float | None, rounding: float) -> tuple[float, list[Finding]]:
    """Where to cut, and what is wrong with the height that was given, or that none was."""
    best = max(heights, key=lambda slab: (slab.same, round((slab.top - slab.bottom) / ALIKE))).middle
    levels = sorted({height for slab in heights for height in (slab.bottom, slab.top)})
    few = ", ".join(f"{1e3 * level:.6g}" for level in levels[:SHOWN]) + (", ..." if len(levels) > SHOWN else "") + " mm"
    fix = f'Set section = "{_mm(best)}".'
    if section is None:
        if len(heights) == 1 and heights[0].same:
            return best, []
        what = f"changes at the heights {few}" if len(heights) > 1 else f"changes all the way between {few}"
        return best, [Finding("section-missing", "error", f"the section of the solid {what}: say where it is cut", fix)]
    if not any(slab.bottom - rounding <= section <= slab.top + rounding for slab in heights):
        why = "the solid has a gap there" if levels[0] < section < levels[-1] else "the solid does not reach there"
        return section, [Finding("section-outside", "error", f"section {_mm(section)}: {why}; it changes at {few}", fix)]
    if any(abs(section - level) <= rounding for level in levels):
        message = f"section {_mm(section)}: there the section changes; cut above or below"
        return section, [Finding("section-missing", "error", message, fix)]
    return section, []


def _mm(height: float) -> str:
    return f"{1e3 * height:.6g} mm"
