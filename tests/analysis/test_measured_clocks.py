"""Do the figures that docs/reports/measured_clocks.md states come out, and do they follow from closed forms?"""

import importlib.util
import math
from pathlib import Path
from types import ModuleType

import pytest
from scipy.special import ellipk

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def clocks() -> ModuleType:
    place = ROOT / "scripts" / "reports" / "measured_clocks.py"
    spec = importlib.util.spec_from_file_location("measured_clocks", place)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.parametrize(("linear", "power", "shown"), [(True, 2.0, "2.03"), (False, 3.0, "3.05")])
def test_a_restart_is_as_many_times_as_fast_as_the_loss_grows(
    clocks: ModuleType, linear: bool, power: float, shown: str
) -> None:
    steady, ratio = clocks.restart_over_decay(linear)
    assert 1.0 < math.degrees(steady) < 4.0
    assert ratio == pytest.approx(power, rel=0.03)
    assert f"{ratio:.2f}" == shown and shown in page()


def page() -> str:
    return (ROOT / "docs" / "reports" / "measured_clocks.md").read_text(encoding="utf-8")


def test_pressure_acts_by_buoyancy_and_by_the_air_carried_along(clocks: ModuleType) -> None:
    for density, carried in ((7100.0, 1.0), (7850.0, 0.0)):
        expected = -0.5 * (1.0 + carried) * clocks.AIR / density * 86400.0
        found = clocks.barometric(density, carried)
        assert found == pytest.approx(expected, rel=1e-3)
        assert f"−{-1e3 * found:.1f}" in page()


def test_the_other_figures_of_the_page(clocks: ModuleType) -> None:
    modulus = math.sin(0.5 * 0.053319) ** 2
    assert clocks.circular(0.053319) == pytest.approx(86400.0 * (math.pi / (2.0 * ellipk(modulus)) - 1.0), rel=1e-10)
    assert f"−{-clocks.circular(0.053319):.2f} s/d" in page()
    assert [f"−{-1e3 * clocks.temperature(one):.0f}" in page() for one in clocks.STEEL] == [True, True]
    assert f"−{-1e6 * clocks.drive_and_period():.0f} ppm" in page()
