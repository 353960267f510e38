"""What is true about a drawing of another program, and what is read of it?

The truth lists what the file draws: doubles are kept, and what hangs on a branch is neither loop nor chain. So the edges as
drawn are also chained by the plainest rule, without gaps closed or doubles taken out.
"""

import json
import math
import sys
from collections import Counter, defaultdict
from collections.abc import Sequence
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Stroke
from watchsim.drawing.inspection import inspect_report
from watchsim.drawing.read import read, read_content
from watchsim.geometry.loops import Loop, extents
from watchsim.geometry.primitives import Edge

sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[1] / "naive")]
from chaining import Component, components  # noqa: E402
from drawing.own_cases import OWN, own_truth  # noqa: E402
from strangers import DRAWINGS as FOLDER  # noqa: E402

MM_PER_UNIT = {"inch": 25.4, "mm": 1.0, "cm": 10.0, "m": 1000.0, None: 1.0}
CURVES = ("spline", "ellipse", "ellipse_arc", "bezier2", "bezier3")
EXACT_FIT, CURVED_FIT = 1e-7, 2e-9  # metres: with curves lengths and areas are wanted to a millionth
EXACT, CURVED = 1e-9, 1e-6
CELL = 1e-8  # metres
REACH = 1e-6  # of the diagonal: within that the truth's ends meet


class Truth(NamedTuple):
    """What independent readers found, in mm (as if in mm where the file says no unit), y upwards."""

    kinds: dict[str, int]
    extents: tuple[float, float, float, float]
    length: float
    loops: int
    chains: int
    branched: int
    area: float
    largest: float
    ignored: dict[str, int] | None  # None: not stated

    @property
    def curves(self) -> int:
        return sum(self.kinds.get(kind, 0) for kind in CURVES)

    @property
    def diagonal(self) -> float:
        return math.hypot(self.extents[2] - self.extents[0], self.extents[3] - self.extents[1])


class Case(NamedTuple):
    """What is read and reported (mm), what is true, the relative tolerance; the drawn edges chained plainly, those that
    repeat an earlier one of their layer, and those of them that come out nowhere (m)."""

    drawing: Drawing
    found: dict[str, Any]
    truth: Truth
    rel: float
    plain: list[Component]
    doubles: list[Edge]
    slits: list[Edge]

    def areas(self, *kinds: str) -> list[float]:
        """Areas (mm²) of the plain components of some kinds."""
        return [1e6 * c.area for c in self.plain if c.kind in kinds]

    @property
    def drawn(self) -> dict[str, int]:
        """How many of each kind are drawn, counted as in the truth."""
        drawn = Counter(self.found["drawn"]["kinds"])
        if self.drawing.format == "dxf":  # LINEs without length count there, but no such pieces of polylines
            zero = (f for f in self.found["findings"] if f["code"] == "zero-length")
            drawn["line"] += sum(f["message"].startswith("LINE") for f in zero)
        return {kind: count for kind, count in drawn.items() if count}

    @property
    def drawn_extents(self) -> tuple[float, ...]:
        """Millimetres."""
        box = extents([Loop(tuple(component.edges), "", closed=False) for component in self.plain])
        assert box is not None
        return tuple(1e3 * side for side in box)


def facts(folder: Path = FOLDER) -> dict[str, Any]:
    """The stored truth, by file; empty where the folder is absent."""
    path = folder / "truth.json"
    return json.loads(path.read_text())["files"] if path.is_file() else {}


@cache
def case(name: str, folder: Path = FOLDER) -> Case:
    stored = own_truth(folder / name) if folder == OWN else facts(folder)[name]
    fit = CURVED_FIT if any(stored["kinds"].get(kind) for kind in CURVES) else EXACT_FIT
    drawing = read(folder / name, fit=fit)
    truth = in_millimetres(stored, drawing)
    path = folder / name
    strokes = read_content(path, path.suffix[1:].lower(), None, fit).strokes
    plain = components([stroke.edge for stroke in strokes], 1e-3 * REACH * truth.diagonal)
    out = {cell for loop in (*drawing.loops, *drawing.open_chains) for edge in loop.edges for cell in cells(edge)}
    doubles = repeated(strokes)
    slits = [edge for edge in doubles if out.isdisjoint(cells(edge))]
    rel = CURVED if truth.curves else EXACT
    return Case(drawing, inspect_report(drawing), truth, rel, plain, doubles, slits)


def repeated(strokes: Sequence[Stroke]) -> list[Edge]:
    """Edges with the same middle and ends as an earlier one of their layer."""
    known: dict[str, set[tuple[int, ...]]] = defaultdict(set)
    found = []
    for stroke in strokes:
        if stroke.edge.length > 0.0:
            same = cells(stroke.edge)
            if not known[stroke.layer].isdisjoint(same):
                found.append(stroke.edge)
            known[stroke.layer] |= same
    return found


def cells(edge: Edge) -> set[tuple[int, ...]]:
    """Middle and ends, in whatever order, of an edge in cells of 10 nm, and the neighbouring cells."""
    (x, y), (a, b), (c, d) = edge.point(0.5), edge.start, edge.end
    near = [(math.floor(v / CELL - 0.05), math.floor(v / CELL + 0.05)) for v in (x, y, a, b, c, d)]
    places = {(xy, frozenset((start, end))) for xy, start, end in product(*[product(*near[k : k + 2]) for k in (0, 2, 4)])}
    return {(*xy, *sum(sorted(ends), ())) for xy, ends in places}


def in_millimetres(stored: dict[str, Any], drawing: Drawing) -> Truth:
    """The stored truth is in drawing units, for SVG in pixels of the page with y downwards."""
    kinds: Counter[str] = Counter()
    for kind, count in stored["kinds"].items():
        kinds["spline" if kind.startswith("bezier") else kind] += count
    mm = MM_PER_UNIT[drawing.units] if drawing.format == "dxf" else 25.4 / 96.0 if drawing.units else 1.0
    low_x, low_y, high_x, high_y = (mm * side for side in stored["extents"])
    if drawing.format == "svg":
        low_y, high_y = -high_y, -low_y
    return Truth(
        {kind: count for kind, count in kinds.items() if count},
        (low_x, low_y, high_x, high_y),
        mm * stored["length"],
        stored["closed_loops"],
        stored["open_chains"],
        stored["branching_components"],
        mm * mm * stored["loop_area_sum"],
        mm * mm * stored["largest_loop_area"],
        stored.get("ignored_entities"),
    )
