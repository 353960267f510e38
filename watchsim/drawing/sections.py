"""Which outlines does a solid show where it is cut?

The plane of the drawing is the x-y plane of the file, heights are along its z axis. A cut gives corners joined by straight
pieces; these become the lines and arcs that the mesh was made of, and go on as those of any drawing do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from watchsim.drawing.facets import fitted
from watchsim.drawing.findings import UNITS, Content, Drawn, Finding, Slab, Stroke, named_length
from watchsim.geometry.meshes import Solid, solids_of

Array = NDArray[np.float64]

ROUNDING = float(np.finfo(np.float32).eps)  # of the coordinates: most files hold 32 bits
UPRIGHT = 1e-5  # z of the normal of a wall that counts as upright
SHOWN = 12  # heights in a message


class _Cut(NamedTuple):
    strokes: list[Stroke]
    pieces: int  # straight ones, as cut
    arcs: int
    deviation: float


def read_solid(data: bytes, ending: str, units: str | None, fit: float, section: float | None) -> Content:
    """What a cut at the height `section` (m) shows; without one, that of a plate, which is the same at all heights.

    ValueError where `units` is not a unit of length.
    """
    stated = named_length(units) if units is not None else None
    try:
        solids, own = solids_of(data, ending)
    except ImportError as error:
        fix = "Install them with pip install 'watchsim[solids]', or save the solid as STL or GLB."
        return _nothing("format", f"{ending.upper()} files are read with packages that are not installed ({error})", fix)
    except Exception as error:  # each reader of trimesh has exceptions of its own
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        return _nothing("damaged", f"it cannot be read as {ending.upper()}: {reason}", "Export the solid again.")
    solids = [solid for solid in solids if len(solid.faces)]
    if not solids:
        return _nothing("empty", "the file holds no triangle that has an area", "Export the solid, not its sketch.")
    name, metres = stated or (own, dict(UNITS).get(own or "", 1e-3))
    findings = []
    if stated and own and dict(UNITS)[own] != metres:
        times = f"everything is {metres / dict(UNITS)[own]:.6g} times as large"
        findings.append(Finding("units-overruled", "warning", f"the file says {own}, you say {name}: {times}"))
    solids = [solid._replace(vertices=metres * solid.vertices) for solid in solids]
    findings += _open_edges(solids)
    rounding = ROUNDING * max(float(np.abs(solid.vertices).max()) for solid in solids)
    slabs = tuple(_slabs(solids, rounding))
    if not slabs:
        return _nothing("empty", "the solid has no height: all of it lies in planes across z", "Export a solid, not a face.")
    at, faults = _height(slabs, section, rounding)
    cut = _cut(solids, at, fit, rounding)
    return Content(
        strokes=tuple(cut.strokes),
        units=name,
        units_from="option" if stated else "header" if own else None,
        fitted_curves=cut.arcs,
        fitted_arcs=cut.arcs,
        fitted_deviation=cut.deviation,
        drawn=Drawn({"line": cut.pieces}, math.fsum(stroke.edge.length for stroke in cut.strokes)),
        section=at,
        slabs=slabs,
        findings=(*faults, *findings),
    )


def _nothing(code: str, message: str, fix: str) -> Content:
    return Content(findings=(Finding(code, "error", message, fix),))


def _open_edges(solids: Sequence[Solid]) -> Iterator[Finding]:
    """A warning for each mesh with a hole; where the cut meets it the outline is open, an error of its own."""
    for solid in solids:
        sides = np.sort(solid.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        count = int(np.sum(np.unique(sides, axis=0, return_counts=True)[1] % 2))
        if count:
            message = f"the mesh is not closed: {count} of its edges belong to one face only, or to three"
            yield Finding("mesh", "warning", message, "Repair the mesh, or export it again.", solid.name)


def _slabs(solids: Sequence[Solid], rounding: float) -> Iterator[Slab]:
    """From level to level, upwards; a level is a height at which something begins or ends. Gaps are left out."""
    corners = np.concatenate([solid.vertices[solid.faces] for solid in solids])
    z = corners[..., 2]
    low, high = z.min(axis=1), z.max(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rising = high - low > rounding
    leaning = rising & (np.abs(normals[:, 2]) > UPRIGHT * np.linalg.norm(normals, axis=1))
    ends = [low[~rising], [low.min(), high.max()]]
    order = np.argsort(low[leaning])
    if len(order):  # stretches in which walls lean, one above the other
        lows, tops = low[leaning][order], np.maximum.accumulate(high[leaning][order])
        new = np.append(True, lows[1:] > tops[:-1] + rounding)
        ends += [lows[new], tops[np.append(new[1:], True)]]
    levels = np.unique(np.concatenate(ends))
    levels = levels[np.append(True, np.diff(levels) > 2.0 * rounding)]
    for bottom, top in pairwise(levels.tolist()):
        inside = (low < 0.5 * (bottom + top)) & (high > 0.5 * (bottom + top))
        if inside.any():
            yield Slab(bottom, top, not bool((inside & leaning).any()))


def _height(slabs: Sequence[Slab], section: float | None, rounding: float) -> tuple[float, list[Finding]]:
    """Where to cut, and what is wrong with the height that was given, or that none was."""
    best = max(slabs, key=lambda slab: (slab.same, slab.top - slab.bottom)).middle
    levels = sorted({height for slab in slabs for height in (slab.bottom, slab.top)})
    few = ", ".join(f"{1e3 * level:.6g}" for level in levels[:SHOWN]) + (", ..." if len(levels) > SHOWN else "") + " mm"
    fix = f'Set section = "{_mm(best)}".'
    if section is None:
        if len(slabs) == 1 and slabs[0].same:
            return best, []
        what = f"the section of the solid changes at {few}" if len(slabs) > 1 else f"it changes all the way between {few}"
        return best, [Finding("section-missing", "error", f"{what}; at which height is it cut?", fix)]
    if not any(slab.bottom - rounding <= section <= slab.top + rounding for slab in slabs):
        why = "the solid has a gap there" if levels[0] < section < levels[-1] else "the solid does not reach there"
        return section, [Finding("section-outside", "error", f"section {_mm(section)}: {why}; levels are {few}", fix)]
    if any(abs(section - level) <= rounding for level in levels):
        message = f"section {_mm(section)}: there the section changes; cut above or below"
        return section, [Finding("section-missing", "error", message, fix)]
    return section, []


def _mm(height: float) -> str:
    return f"{1e3 * height:.6g} mm"


def _cut(solids: Sequence[Solid], at: float, fit: float, rounding: float) -> _Cut:
    """The lines and arcs of all solids at that height; each solid is a layer."""
    strokes: list[Stroke] = []
    pieces = arcs = run = 0
    deviation = 0.0
    for solid in solids:
        segments = _segments(solid, at)
        pieces += len(segments)
        merged = shapely.line_merge(shapely.multilinestrings(shapely.linestrings(segments))) if len(segments) else None
        for line in shapely.get_parts(merged):
            corners, closed = _corners(shapely.get_coordinates(line), rounding)
            if len(corners) < 2:
                continue
            found = fitted(corners, closed, fit, rounding)
            strokes += [Stroke(edge, solid.name, f"edge {len(strokes) + k}", run + k) for k, edge in enumerate(found.edges, 1)]
            run += len(found.edges)
            arcs, deviation = arcs + found.arcs, max(deviation, found.deviation)
    return _Cut(strokes, pieces, arcs, deviation)


def _segments(solid: Solid, at: float) -> Array:
    """The pieces (n, 2, 2) in which faces meet the plane. Each edge is cut once, so that neighbours share points exactly.

    A vertex on the plane counts as above it.
    """
    above = solid.vertices[:, 2] >= at
    faces = solid.faces[above[solid.faces].any(axis=1) & ~above[solid.faces].all(axis=1)]
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    sides = sides[above[sides[:, 0]] != above[sides[:, 1]]]  # two of each face
    a, b = solid.vertices[sides[:, 0]], solid.vertices[sides[:, 1]]
    share = ((at - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None]
    segments: Array = (a + share * (b - a))[:, :2].reshape(-1, 2, 2)
    return segments[np.any(segments[:, 0] != segments[:, 1], axis=1)]


def _corners(points: Array, rounding: float) -> tuple[Array, bool]:
    """Where the outline turns; of a closed one the last corner is not the first."""
    closed = bool(np.all(points[0] == points[-1]))
    for _ in range(1 + closed):  # of a ring the first point stays, corner or not: the second time it is another
        points = shapely.get_coordinates(shapely.simplify(shapely.linestrings(points), rounding, preserve_topology=False))
        if closed and len(points) > 3:
            points = np.roll(points[:-1], -(len(points) // 2), axis=0)
            points = np.concatenate((points, points[:1]))
    return (points[:-1], True) if closed else (points, False)
