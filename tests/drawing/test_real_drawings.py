"""Are the drawings of other people's programs read as an independent reader reads them?

The truth lists what the file draws: doubles are kept, and what hangs on a branch is neither loop nor chain. So every file is
compared twice: what was drawn, chained by the plainest rule; and what comes out tidied, where the two need not differ.
"""

from __future__ import annotations

import json
import math
import sys
from collections import Counter
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf import read_dxf
from watchsim.drawing.inspect import inspect_report
from watchsim.drawing.read import read

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "naive"))
from chaining import Component, components

FOLDER = Path(__file__).resolve().parents[2].parent / "shared" / "drawings"
TRUTH: dict[str, Any] = json.loads((FOLDER / "truth.json").read_text())["files"] if FOLDER.is_dir() else {}
NAMES = sorted(name for name in TRUTH if name.startswith("dxf/") and TRUTH[name].get("length"))
MM_PER_UNIT = {"inch": 25.4, "mm": 1.0, "cm": 10.0, "m": 1000.0, None: 1.0}
CURVES = ("spline", "ellipse", "ellipse_arc")
REACH = 1e-6  # of the diagonal: the truth's


class Case(NamedTuple):
    """What is read and reported (mm), what is true (drawing units), the tolerance, and the drawn edges chained plainly (m)."""

    drawing: Drawing
    found: dict[str, Any]
    truth: dict[str, Any]
    mm: float
    rel: float
    plain: list[Component]

    def areas(self, *kinds: str) -> list[float]:
        """Areas of the plain components of some kinds, in square units of the drawing."""
        return [c.area * (1e3 / self.mm) ** 2 for c in self.plain if c.kind in kinds]


@cache
def case(name: str) -> Case:
    truth = TRUTH[name]
    curved = any(truth["kinds"].get(kind) for kind in CURVES)
    fit = 2e-9 if curved else 1e-7
    drawing = read(FOLDER / name, fit=fit)
    found = inspect_report(drawing)
    mm = MM_PER_UNIT[drawing.units]
    xmin, ymin, xmax, ymax = truth["extents"]
    reach = REACH * math.hypot(xmax - xmin, ymax - ymin) * mm * 1e-3
    edges = [stroke.edge for stroke in read_dxf((FOLDER / name).read_bytes(), None, fit).strokes]
    return Case(drawing, found, truth, mm, 1e-6 if curved else 1e-9, components(edges, reach))


def keys(edge: Any) -> set[tuple[int, ...]]:
    """Middle and extent of an edge in cells of 0.2 µm, and the neighbouring cells."""
    (x, y), (a, b), (c, d) = edge.point(0.5), edge.start, edge.end
    exact = [v / 2e-7 for v in (x, y, abs(a - c), abs(b - d))]
    return set(product(*[(math.floor(v - 0.05), math.floor(v + 0.05)) for v in exact]))


@pytest.mark.parametrize("name", NAMES)
def test_counts_of_what_is_drawn(name: str) -> None:
    found, truth = case(name).found, case(name).truth
    drawn = Counter(found["drawn"]["kinds"])
    # The truth counts LINEs without length, but no such pieces of polylines.
    drawn["line"] += sum(f["code"] == "zero-length" and f["message"].startswith("LINE") for f in found["findings"])
    assert {kind: count for kind, count in drawn.items() if count} == {k: c for k, c in truth["kinds"].items() if c}
    assert {kind: count for kind, count in found["ignored"].items() if kind != "POINT"} == truth["ignored_entities"]


@pytest.mark.parametrize("name", NAMES)
def test_counts_of_what_comes_out(name: str) -> None:
    """Lines and arcs are those drawn less doubles, and those that stand for curves."""
    found, truth = case(name).found, case(name).truth
    doubles = sum(f["code"] == "duplicate" for f in found["findings"])
    curves = sum(truth["kinds"].get(kind, 0) for kind in CURVES)
    exact = found["lines"] + found["arcs"] - found["fitted"]["arcs"]
    plain = sum(found["drawn"]["kinds"].get(kind, 0) for kind in ("line", "arc", "circle"))
    assert found["fitted"]["curves"] <= curves
    if curves == 0:
        assert exact == plain - doubles
    else:
        # Where a curve changes its bend one of its arcs may be a line; straight and round parts of it are lines and arcs.
        assert exact >= plain - doubles


@pytest.mark.parametrize("name", NAMES)
def test_length(name: str) -> None:
    found, truth, mm, rel = case(name)[1:5]
    assert found["drawn"]["length_mm"] / mm == pytest.approx(truth["length"], rel=rel, abs=0)
    # Doubles taken out, and gaps below the truth's reach closed by moving the ends of lines.
    twice = sum(min(e.length for e in c.edges) * 1e3 / mm for c in case(name).plain if c.kind == "double")
    assert found["length_mm"] / mm == pytest.approx(truth["length"] - twice, rel=max(rel, 3e-9), abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_extents(name: str) -> None:
    found, truth, mm, rel = case(name)[1:5]
    xmin, ymin, xmax, ymax = truth["extents"]
    size = math.hypot(xmax - xmin, ymax - ymin) + max(map(abs, truth["extents"]))
    assert [side / mm for side in found["extents_mm"]] == pytest.approx(truth["extents"], abs=rel * size)


@pytest.mark.parametrize("name", NAMES)
def test_loops_and_areas_of_what_is_drawn(name: str) -> None:
    this = case(name)
    truth = this.truth
    kinds = Counter(c.kind for c in this.plain)
    assert kinds["loop"] + kinds["double"] == truth["closed_loops"]
    assert kinds["chain"] == truth["open_chains"]
    assert kinds["branched"] == truth["branching_components"]
    areas = this.areas("loop", "double")
    assert math.fsum(areas) == pytest.approx(truth["loop_area_sum"], rel=this.rel, abs=0)
    assert max(areas, default=0.0) == pytest.approx(truth["largest_loop_area"], rel=this.rel, abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_loops_and_areas_of_what_comes_out(name: str) -> None:
    """Loops that hang on a branch come besides those of the truth; a line there and back is an open chain."""
    this = case(name)
    truth = this.truth
    branched = {k for c in this.plain if c.kind == "branched" for e in c.edges for k in keys(e)}

    def hangs(loop: Any) -> bool:
        return all(not branched.isdisjoint(keys(edge)) for edge in loop.edges)

    doubles = sum(c.kind == "double" for c in this.plain)
    free = [k for k, loop in enumerate((*this.drawing.loops, *this.drawing.open_chains)) if not hangs(loop)]
    loops = [this.found["loops"][k] for k in free]
    assert sum(loop["closed"] for loop in loops) == truth["closed_loops"] - doubles
    assert sum(not loop["closed"] for loop in loops) == truth["open_chains"] + doubles
    areas = [loop["area_mm2"] / this.mm**2 for loop in loops if loop["closed"]]
    # Where ends do not meet exactly, the truth integrates across the gaps and depends on the origin; here they are closed.
    gaps = math.fsum(c.gaps * (1e3 / this.mm) ** 2 for c in this.plain if c.kind == "loop")
    assert sum(areas) == pytest.approx(truth["loop_area_sum"] + gaps, rel=this.rel, abs=0)
    assert abs(gaps) <= max(this.rel, 1e-8) * truth["loop_area_sum"]


@pytest.mark.parametrize("name", sorted(name for name in TRUTH if name.startswith("dxf/") and not TRUTH[name].get("length")))
def test_drawings_without_geometry_are_errors(name: str) -> None:
    assert any(finding.code == "empty" and finding.severity == "error" for finding in read(FOLDER / name).findings)


@pytest.mark.parametrize("name", NAMES)
def test_units_are_those_of_the_header(name: str) -> None:
    code = TRUTH[name]["format"]["insunits"]
    found = case(name).found
    assert found["units"] == {None: None, "0": None, "1": "inch", "4": "mm", "5": "cm", "6": "m"}[code and str(code)]
    assert any(finding["code"] == "units-missing" for finding in found["findings"]) == (found["units"] is None)
