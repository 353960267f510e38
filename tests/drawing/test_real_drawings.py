"""Are our drawings, and those of other people's programs, read as an independent reader reads them?

Every file is compared twice: what was drawn, chained by the plainest rule; and what comes out tidied, where the two need not
differ.
"""

import math
from collections import Counter
from typing import Any

import pytest
from drawing.own_cases import OWN, own_truth
from every_time import few
from real_cases import FOLDER, Case, cells, facts
from real_cases import case as case_in
from strangers import marks

from watchsim.drawing.read import read

FACTS = facts()
LONG = (  # to read
    *("dxf/dxf__issue53.dxf", "dxf/dxf__supported_entities.dxf", "svg/openMEMSdesign__Schrittschaltwerke.svg"),
    *("dxf/trimesh__spline.DXF", "dxf/trimesh__ae.r2000a.dxf", "dxf/trimesh__ae.r2000b.dxf"),
)
THEIRS = few(sorted(name for name in FACTS if FACTS[name].get("length")), lambda name: name not in LONG) if FACTS else ["all"]
EMPTY = sorted(name for name in FACTS if not FACTS[name].get("length"))
OURS = [path.relative_to(OWN).as_posix() for path in sorted(OWN.glob("*/*.dxf"))]
MARKS = marks(FOLDER / "truth.json")
NAMES = [*OURS, *(pytest.param(*getattr(one, "values", [one]), marks=[*getattr(one, "marks", ()), *MARKS]) for one in THEIRS)]
HEADER_UNITS = {None: None, "0": None, "1": "inch", "4": "mm", "5": "cm", "6": "m"}
PAGE_UNITS = {
    "svg/openMEMSdesign__Schrittschaltwerke.svg": "mm",
    "svg/openMEMSdesign__gear.svg": "mm",
    "svg/trimesh__polygon.svg": "mm",
    "svg/ezdxf__gear.svg": "pt",
    "svg/svgpathtools__polygons.svg": "px",
}


def case(name: str) -> Case:
    return case_in(name, OWN if name in OURS else FOLDER)


@pytest.mark.parametrize("name", NAMES)
def test_counts_of_what_is_drawn(name: str) -> None:
    this = case(name)
    assert this.drawn == this.truth.kinds
    if this.truth.ignored is not None:
        assert {kind: count for kind, count in this.found["ignored"].items() if kind != "POINT"} == this.truth.ignored


@pytest.mark.parametrize("name", NAMES)
def test_counts_of_what_comes_out(name: str) -> None:
    """Lines and arcs are those drawn less doubles and slits, and those that stand for curves."""
    this = case(name)
    found = this.found
    assert sum(finding["code"] == "slit" for finding in found["findings"]) == len(this.slits)
    less = len(this.doubles) + len(this.slits)
    exact = found["lines"] + found["arcs"] - found["fitted"]["arcs"]
    plain = sum(found["drawn"]["kinds"].get(kind, 0) for kind in ("line", "arc", "circle"))
    assert found["fitted"]["curves"] <= this.truth.curves
    if this.truth.curves == 0:
        assert exact == plain - less
    else:
        # Where a curve changes its bend one of its arcs may be a line; straight and round parts of it are lines and arcs.
        assert exact >= plain - less


@pytest.mark.parametrize("name", NAMES)
def test_length(name: str) -> None:
    this = case(name)
    assert this.found["drawn"]["length_mm"] == pytest.approx(this.truth.length, rel=this.rel, abs=0)
    # Doubles and slits taken out, and gaps below the truth's reach closed by moving the ends of lines.
    twice = 1e3 * math.fsum(edge.length for edge in (*this.doubles, *this.slits))
    assert this.found["length_mm"] == pytest.approx(this.truth.length - twice, rel=max(this.rel, 3e-9), abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_extents(name: str) -> None:
    this = case(name)
    size = this.truth.diagonal + max(map(abs, this.truth.extents))
    for box in (this.found["extents_mm"], this.drawn_extents):
        assert box == pytest.approx(this.truth.extents, abs=this.rel * size)


@pytest.mark.parametrize("name", NAMES)
def test_loops_and_areas_of_what_is_drawn(name: str) -> None:
    this = case(name)
    truth = this.truth
    kinds = Counter(c.kind for c in this.plain)
    assert kinds["loop"] + kinds["double"] == truth.loops
    assert kinds["chain"] == truth.chains
    assert kinds["branched"] == truth.branched
    areas = this.areas("loop", "double")
    assert math.fsum(areas) == pytest.approx(truth.area, rel=this.rel, abs=0)
    assert max(areas, default=0.0) == pytest.approx(truth.largest, rel=this.rel, abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_loops_and_areas_of_what_comes_out(name: str) -> None:
    """Loops that hang on a branch come besides those of the truth; a line there and back is an open chain."""
    this = case(name)
    truth = this.truth
    branched = {k for c in this.plain if c.kind == "branched" for e in c.edges for k in cells(e)}

    def hangs(loop: Any) -> bool:
        return all(not branched.isdisjoint(cells(edge)) for edge in loop.edges)

    doubles = sum(c.kind == "double" for c in this.plain)
    free = [k for k, loop in enumerate((*this.drawing.loops, *this.drawing.open_chains)) if not hangs(loop)]
    loops = [this.found["loops"][k] for k in free]
    assert sum(loop["closed"] for loop in loops) == truth.loops - doubles
    assert sum(not loop["closed"] for loop in loops) == truth.chains + doubles
    areas = [loop["area_mm2"] for loop in loops if loop["closed"]]
    # Where ends do not meet exactly, the truth integrates across the gaps and depends on the origin; here they are closed.
    gaps = 1e6 * math.fsum(c.gaps for c in this.plain if c.kind == "loop")
    assert sum(areas) == pytest.approx(truth.area + gaps, rel=this.rel, abs=0)
    assert abs(gaps) <= max(this.rel, 1e-8) * truth.area


@pytest.mark.parametrize("name", [pytest.param(name, marks=MARKS) for name in EMPTY or ["all"]])
def test_drawings_without_geometry_are_errors(name: str) -> None:
    assert any(finding.code == "empty" and finding.severity == "error" for finding in read(FOLDER / name).findings)


@pytest.mark.parametrize("name", NAMES)
def test_units_are_those_of_the_header_or_the_page(name: str) -> None:
    found = case(name).found
    if name.startswith("svg/"):
        assert found["units"] == PAGE_UNITS.get(name)
        assert found["units_from"] == ("page" if found["units"] else None)
    else:
        code = (own_truth(OWN / name) if name in OURS else FACTS[name])["format"]["insunits"]
        assert found["units"] == HEADER_UNITS[code and str(code)]
        assert found["units_from"] == ("header" if found["units"] else None)
    assert any(finding["code"] == "units-missing" for finding in found["findings"]) == (found["units"] is None)
