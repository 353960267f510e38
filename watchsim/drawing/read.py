"""What is in this drawing file?

The one door to all formats: bytes in, a Drawing out. Whatever is wrong with the file is a finding, never an exception.
"""

from __future__ import annotations

import gc
import math
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from watchsim.drawing.chaining import chain
from watchsim.drawing.circles import facets
from watchsim.drawing.drawing import SNAP, Drawing
from watchsim.drawing.dxf import content_of_sheet, read_dxf
from watchsim.drawing.findings import Content, Facts, Finding
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop, extents
from watchsim.units import metric

FIT = 1e-7
LARGEST_FILE = 75_000_000  # bytes; to take it apart needs thirteen times as much memory
SOLIDS = ("stl", "obj", "glb", "3mf", "step", "stp")
ENDINGS = ("dxf", "svg", "svgz", *SOLIDS)
OTHER_SOLIDS = ("iges", "igs", "brep", "sldprt", "ipt", "f3d", "fcstd")
SMALLEST = 20.0  # times the snap: the smallest drawing that is believed
LARGEST = 10.0  # m: the largest


def read(
    path: Path | str, units: str | None = None, snap: float = SNAP, fit: float = FIT, section: float | None = None
) -> Drawing:
    """Reads a drawing. `units` overrules what the file says; `snap` and `fit` are in metres.

    A solid (STL, OBJ, GLB, 3MF, STEP) is cut at the height `section`, metres along its z axis.
    Raises ValueError where `units` is not a unit of length, or `snap` or `fit` is not positive.
    """
    path = Path(path)
    if not snap > 0.0 or not fit > 0.0:
        raise ValueError(f"snap and fit must be positive lengths, not {snap:g} m and {fit:g} m")
    ending = path.suffix.lower().lstrip(".")
    return assembled(path, ending, lambda: read_content(path, ending, units, fit, section), snap)


def read_data(data: bytes, path: Path, units: str | None = None, snap: float = SNAP, section: float | None = None) -> Drawing:
    """The same of a file that is in memory; `path` is its name."""
    ending = path.suffix.lower().lstrip(".")
    return assembled(path, ending, lambda: content_of(data, ending, units, FIT, section), snap)


def read_sheet(sheet: Sheet, path: Path, snap: float = SNAP) -> Drawing:
    """What `read_data` gives of the sheet's DXF file, to the last bit; entities are named without handles."""
    return assembled(path, "dxf", lambda: content_of_sheet(sheet, FIT), snap)


def assembled(path: Path, ending: str, reader: Callable[[], Content], snap: float) -> Drawing:
    """The drawing of what the reader finds in the file."""
    with collector_paused():
        content = reader()
        chains = chain(content.strokes, snap, content.fitted_deviation)
        everything = (*chains.loops, *chains.open_chains)
        findings = [*content.findings, *chains.findings, *facets(everything)]
    if not content.strokes and not any(finding.severity == "error" for finding in findings):
        findings.insert(0, emptiness(content))
    if content.units is None and content.strokes:
        findings.insert(0, units_missing(everything))
    findings += odd_size(everything, snap, content.units is not None)
    layers = dict.fromkeys([stroke.layer for stroke in content.strokes] + [layer for layer, _, _ in content.points])
    facts = {name: getattr(content, name) for name in Facts.__dataclass_fields__}
    facts |= {"format": content.format or ending, "findings": tuple(findings)}
    return Drawing(path=path, loops=chains.loops, open_chains=chains.open_chains, layers=tuple(layers), **facts)


def unread_solid(name: str, ending: str) -> Finding:
    """The error for a solid of exact surfaces, or in a format of one program only."""
    message = f'"{name}" is a solid in the format {ending.upper()}, which is not read'
    fix = "Export it as STL or 3MF with chords within 0.2 µm, or as STEP."
    return Finding("format", "error", message, fix)


@contextmanager
def collector_paused() -> Iterator[None]:
    """A drawing is very many small objects and no cycles; Python's collector would walk over them again and again."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def read_content(path: Path, ending: str, units: str | None, fit: float, section: float | None = None) -> Content:
    """What the reader for that ending and content finds; a file that is not there or cannot be opened is a finding too."""
    if path.is_dir():
        return Content(findings=(Finding("unreadable", "error", f"{path} is a folder", "Name one of the drawings in it."),))
    if ending in OTHER_SOLIDS:
        return Content(findings=(unread_solid(path.name, ending),))
    if ending not in ENDINGS:
        message = f'"{path.name}" ends in neither .dxf nor .svg: this kind of file is not read'
        fix = "Save the drawing as DXF or SVG, a solid as STL, OBJ, GLB, 3MF or STEP."
        return Content(findings=(Finding("format", "error", message, fix),))
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            message = f"the file has {size / 1e6:.0f} MB, more than the {LARGEST_FILE / 1e6:.0f} MB allowed for a drawing"
            fix = (
                "Export it with longer chords."
                if ending in SOLIDS
                else "Save only the part: without pictures, hatches and meshes."
            )
            return Content(findings=(Finding("too-large", "error", f"{message}; it was not read", fix),))
        data = path.read_bytes()
    except OSError as error:
        reason = "there is no such file" if isinstance(error, FileNotFoundError) else error.strerror or "it cannot be read"
        return Content(findings=(Finding("unreadable", "error", f"{path}: {reason}"),))
    return content_of(data, ending, units, fit, section)


def content_of(data: bytes, ending: str, units: str | None, fit: float, section: float | None = None) -> Content:
    """What the reader for that ending and content finds in a file's bytes."""
    if ending in SOLIDS:
        from watchsim.drawing.sections import read_solid

        return replace(read_solid(data, ending, units, fit, section), format=ending, data=data)
    if section is not None:
        finding = Finding("section", "error", f"a {ending.upper()} file is flat: only solids are cut", "Leave out section.")
        return Content(findings=(finding,), format=ending, data=data)
    form = format_of(data, ending[:3])
    if form == "svg":
        from watchsim.drawing.svg import read_svg

        content = read_svg(data, units, fit)
    else:
        content = read_dxf(data, units, fit)
    if form != ending[:3]:
        message = f"the name ends in .{ending} but the file is {form.upper()} inside; it is read as such"
        content = replace(content, findings=(Finding("format", "warning", message), *content.findings))
    return replace(content, format=form, data=data)


def format_of(data: bytes, ending: str) -> str:
    """ "dxf" or "svg", by the ending unless the content is clearly the other."""
    head = data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n")
    if ending == "dxf" and (data[:2] == b"\x1f\x8b" or (head[:1] == b"<" and b"<svg" in head)):
        return "svg"
    if ending == "svg" and (head.startswith(b"AutoCAD Binary DXF") or re.match(rb"(?:0|999)\s*\r?\n", head)):
        return "dxf"
    return ending


def emptiness(content: Content) -> Finding:
    """The error for a file that holds no line and no arc: the reasons stand in its other findings."""
    other = f"; it holds {len(content.points)} points" if content.points else ""
    if content.ignored:
        other += "; what it holds is not read: " + ", ".join(f"{count} × {kind}" for kind, count in content.ignored.items())
    message = f"the drawing holds no line and no arc that is visible{other}"
    place = "text, which must be turned into paths" if content.format == "svg" else "paper space"
    return Finding("empty", "error", message, f"Check hidden layers and {place}.")


def odd_size(loops: Sequence[Loop], snap: float, known: bool) -> list[Finding]:
    """A warning where the whole drawing is hardly larger than what counts as one point: its units are wrong.

    Likewise where their unit is known and it is larger than any clock: millimetres in a file that says metres.
    """
    box = extents(loops)
    if box is None:
        return []
    across, point, fix = max(box[2] - box[0], box[3] - box[1]), SMALLEST * snap, "Check the units of the drawing."
    if across > LARGEST and known:
        return [Finding("huge", "warning", f"the whole drawing is {metric(across, 'm', 4)} across", fix)]
    if across > point or any(math.dist(edge.start, edge.end) > point for loop in loops for edge in loop.edges):
        return []
    message = f"the whole drawing is {1e6 * across:.3g} µm across, and ends within {1e6 * snap:.3g} µm are taken for one point"
    return [Finding("tiny", "warning", message, fix)]


def units_missing(loops: Sequence[Loop]) -> Finding:
    """The error for a drawing without units, with the sizes it could have."""
    box = extents(loops) or (0.0, 0.0, 0.0, 0.0)
    across = 1e3 * max(box[2] - box[0], box[3] - box[1])
    message = f"the drawing does not say its units; it would be {across:.4g} mm or {25.4 * across:.4g} mm across"
    return Finding("units-missing", "error", message, 'Set units = "mm" (or "inch").')
