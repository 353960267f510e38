"""Is every unit of $INSUNITS the one of Autodesk's reference?"""

from __future__ import annotations

from pathlib import Path

import dxf_text as d
import pytest

from watchsim.drawing.findings import INSUNITS
from watchsim.drawing.read import read

# DXF reference, HEADER section, $INSUNITS; in metres from their definitions.
REFERENCE = {
    1: 25.4e-3,
    2: 12 * 25.4e-3,
    3: 63360 * 25.4e-3,
    4: 1e-3,
    5: 1e-2,
    6: 1.0,
    7: 1e3,
    8: 25.4e-9,
    9: 25.4e-6,
    10: 36 * 25.4e-3,
    11: 1e-10,
    12: 1e-9,
    13: 1e-6,
    14: 0.1,
    15: 10.0,
    16: 100.0,
    17: 1e9,
    18: 149597870700.0,
    19: 299792458.0 * 365.25 * 86400.0,
    20: 149597870700.0 * 648000.0 / 3.141592653589793,
    21: 1200.0 / 3937.0,
    22: 100.0 / 3937.0,
    23: 3600.0 / 3937.0,
    24: 5280.0 * 1200.0 / 3937.0,
}


@pytest.mark.parametrize("code", REFERENCE)
def test_every_code_has_its_length(code: int) -> None:
    assert INSUNITS[code][1] == pytest.approx(REFERENCE[code], rel=1e-15, abs=0.0)


def test_there_is_no_other() -> None:
    assert set(INSUNITS) == set(REFERENCE)


def test_a_unit_that_cannot_be_read_is_none(tmp_path: Path) -> None:
    """Said as an error; not taken for inches, nor for what the next file says."""
    path = tmp_path / "damaged.dxf"
    entities = f"0\nSECTION\n2\nENTITIES\n{d.circle(0.0, 0.0, 1.0)}0\nENDSEC\n0\nEOF\n"
    path.write_text(d.header(4).replace("70\n4", "70\nfour") + entities)
    drawing = read(path)
    assert drawing.units is None
    assert any("$INSUNITS" in finding.message for finding in drawing.findings if finding.severity == "error")
