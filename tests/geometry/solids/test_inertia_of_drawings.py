"""Are area and polar moment of drawn parts those of an independent quadrature with 30 digits?"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest
from strangers import PIN_LEVER, marks

from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import section

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))

from measure_lever import moments  # noqa: E402

WHEELS = {
    "club teeth": ROOT / "profiles" / "swiss_lever" / "escape_wheel.dxf",
    "lever": ROOT / "profiles" / "swiss_lever" / "lever.dxf",
    "pointed teeth": ROOT / "profiles" / "bench_lever" / "wheel.dxf",
    "pin lever wheel": PIN_LEVER / "siconos_pin_lever_wheel.dxf",
    "pin lever": PIN_LEVER / "siconos_pin_lever_lever.dxf",
}


def ring(outer: float, inner: float) -> tuple[Loop, ...]:
    return (Loop((Arc(0, 0, outer, 0.3, TURN),)), Loop((Arc(0, 0, inner, 0.1, -TURN),), hole=True))


def test_the_quadrature_knows_a_ring_and_a_sector() -> None:
    area, polar = moments(ring(3e-3, 2e-3))
    assert float(area) == pytest.approx(math.pi * 5e-6, rel=1e-15, abs=0.0)
    assert float(polar) == pytest.approx(math.pi / 2 * (81e-12 - 16e-12), rel=1e-15, abs=0.0)
    r, a = 2e-3, 1.1
    sector = Loop((Line(0, 0, r, 0), Arc(0, 0, r, 0, a), Line(r * math.cos(a), r * math.sin(a), 0, 0)))
    assert float(moments([sector])[1]) == pytest.approx(a * r**4 / 4, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("name", [pytest.param(name, marks=marks(path)) for name, path in WHEELS.items()])
def test_real_parts(name: str) -> None:
    loops = read(WHEELS[name], units="mm").loops
    found = section(loops).about((0.0, 0.0))
    area, polar = moments(loops)
    assert (found.area, found.polar) == pytest.approx((float(area), float(polar)), rel=1e-12, abs=0.0)
