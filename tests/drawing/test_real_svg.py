"""Are the SVG drawings of other people's programs read as an independent reader reads them?

The truth counts y downwards, in pixels of the root's viewport, and in millimetres where the page says its size. It chains
all layers together, keeps duplicates, and does not count loops that hang on a branch. What differs by that is said below.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from watchsim.drawing.inspect import inspect_report
from watchsim.drawing.read import read

FOLDER = Path(__file__).resolve().parents[2].parent / "shared" / "drawings"
TRUTH: dict[str, Any] = json.loads((FOLDER / "truth.json").read_text())["files"] if FOLDER.is_dir() else {}
NAMES = sorted(name for name in TRUTH if name.startswith("svg/") and TRUTH[name].get("length"))
CURVES = ("bezier2", "bezier3", "ellipse", "ellipse_arc")
TWICE = "lines drawn twice are taken out here and counted in the truth"
BRANCHED = "the truth leaves out what hangs on a branch, here the same outline drawn twice; here it is one loop"
DIFFERENT = {
    ("openMEMSdesign__Schrittschaltwerke.svg", "counts"): TWICE,
    ("openMEMSdesign__Schrittschaltwerke.svg", "length"): TWICE,
    ("openMEMSdesign__Schrittschaltwerke.svg", "loops"): "three outlines are bridged to 258 holes: here they are loops",
    ("openMEMSdesign__Schrittschaltwerke.svg", "areas"): "outlines bridged to their holes are branches in the truth",
    ("openMEMSdesign__gear.svg", "loops"): "three outlines meet in one point, a branch: here they are loops",
    ("openMEMSdesign__gear.svg", "areas"): "three outlines meet in one point, a branch: here they are loops",
    ("ezdxf__gear.svg", "loops"): "the page's frame is drawn twice, on two layers: two loops here, a branch there",
    ("ezdxf__gear.svg", "areas"): "the page's frame is drawn twice, on two layers: two loops here, a branch there",
    ("resvg__M-L-Z-A.svg", "loops"): "the arc ends on a corner of the triangle: a branch there, a loop and a chain here",
    ("resvg__M-L-Z-A.svg", "areas"): "the arc ends on a corner of the triangle: a branch there, a loop and a chain here",
    ("resvg__invalid-data-in-L.svg", "counts"): TWICE,
    ("resvg__invalid-data-in-L.svg", "length"): TWICE,
    ("resvg__invalid-data-in-L.svg", "loops"): "a line drawn there and back is a loop of no area in the truth",
    ("svgpathtools__zero-radius-arcs.svg", "counts"): "three lines drawn there and back are taken once here",
    ("svgpathtools__zero-radius-arcs.svg", "length"): "three lines drawn there and back are taken once here",
    ("svgpathtools__zero-radius-arcs.svg", "loops"): "three lines drawn there and back are loops of no area in the truth",
    **{
        (f"resvg__{name}.svg", check): BRANCHED if check in ("loops", "areas") else TWICE
        for name in ("skewX", "transform-list", "rx-attribute-clamping")
        for check in ("counts", "length", "loops", "areas")
    },
}
UNITS = {
    "openMEMSdesign__Schrittschaltwerke.svg": "mm",
    "openMEMSdesign__gear.svg": "mm",
    "trimesh__polygon.svg": "mm",
    "ezdxf__gear.svg": "pt",
    "svgpathtools__polygons.svg": "px",
}
_REPORTS: dict[str, dict[str, Any]] = {}


def report(name: str, check: str, request: pytest.FixtureRequest) -> tuple[dict[str, Any], dict[str, Any], float]:
    """What is read, what is true (millimetres where the page says its size, else pixels), and the relative accuracy due."""
    reason = DIFFERENT.get((name.removeprefix("svg/"), check))
    if reason is not None:
        request.applymarker(pytest.mark.xfail(reason=reason, strict=True))
    truth = TRUTH[name]
    curved = any(truth["kinds"].get(kind) for kind in CURVES)
    if name not in _REPORTS:
        _REPORTS[name] = inspect_report(read(FOLDER / name, fit=2e-9 if curved else 1e-7))
    found = _REPORTS[name]
    if found["units"]:
        mm = truth["mm_at_96dpi"]
        largest = truth["largest_loop_area"] * (25.4 / 96.0) ** 2
        truth = {**truth, **mm, "largest_loop_area": largest}
    return found, truth, 1e-6 if curved else 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_counts(name: str, request: pytest.FixtureRequest) -> None:
    found, truth, _ = report(name, "counts", request)
    kinds = truth["kinds"]
    assert found["fitted"]["curves"] == sum(kinds.get(kind, 0) for kind in CURVES)
    assert found["arcs"] - found["fitted"]["arcs"] == kinds.get("arc", 0) + kinds.get("circle", 0)
    assert 0 <= found["lines"] - kinds.get("line", 0) <= found["fitted"]["curves"]


@pytest.mark.parametrize("name", NAMES)
def test_length(name: str, request: pytest.FixtureRequest) -> None:
    found, truth, due = report(name, "length", request)
    assert found["length_mm"] == pytest.approx(truth["length"], rel=due, abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_extents(name: str, request: pytest.FixtureRequest) -> None:
    found, truth, due = report(name, "extents", request)
    xmin, ymin, xmax, ymax = truth["extents"]
    size = math.hypot(xmax - xmin, ymax - ymin) + max(map(abs, truth["extents"]))
    assert found["extents_mm"] == pytest.approx([xmin, -ymax, xmax, -ymin], abs=due * size)


@pytest.mark.parametrize("name", NAMES)
def test_areas(name: str, request: pytest.FixtureRequest) -> None:
    found, truth, due = report(name, "areas", request)
    areas = [loop["area_mm2"] for loop in found["loops"] if loop["closed"]]
    assert sum(areas) == pytest.approx(truth["loop_area_sum"], rel=due, abs=0)
    assert max(areas, default=0.0) == pytest.approx(truth["largest_loop_area"], rel=due, abs=0)


@pytest.mark.parametrize("name", NAMES)
def test_loops(name: str, request: pytest.FixtureRequest) -> None:
    found, truth, _ = report(name, "loops", request)
    assert sum(loop["closed"] for loop in found["loops"]) == truth["closed_loops"]
    assert sum(not loop["closed"] for loop in found["loops"]) == truth["open_chains"]


@pytest.mark.parametrize("name", NAMES)
def test_units_are_those_of_the_page(name: str) -> None:
    drawing = read(FOLDER / name, fit=1e-5)
    assert drawing.units == UNITS.get(name.removeprefix("svg/"))
    assert drawing.units_from == ("page" if drawing.units else None)
    assert any(finding.code == "units-missing" for finding in drawing.findings) == (drawing.units is None)


@pytest.mark.parametrize("name", sorted(name for name in TRUTH if name.startswith("svg/") and not TRUTH[name].get("length")))
def test_pages_that_show_nothing_are_errors(name: str) -> None:
    assert any(finding.code == "empty" and finding.severity == "error" for finding in read(FOLDER / name).findings)
