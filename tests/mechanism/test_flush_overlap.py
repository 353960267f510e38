"""Is what the geometry engine says of flush faces checked?"""

import pytest
import shapely

from watchsim.mechanism.overlap_depth import regions_depth

FIRST = (
    "POLYGON ((-0.0159015249051065 0.0003520508906315, -0.0125485936271036 0.0097731894547855, "
    "-0.0219697321912577 0.0131261207327883, -0.0253226634692605 0.0037049821686343, -0.0159015249051065 0.0003520508906315))"
)
SECOND = (
    "POLYGON ((-0.0253226634692605 0.0037049821686343, -0.0219697321912577 0.0131261207327883, "
    "-0.0313908707554117 0.0164790520107912, -0.0347438020334145 0.0070579134466371, -0.0253226634692605 0.0037049821686343))"
)
WHOLE = shapely.from_wkt(FIRST)


def test_flush_squares_touch(monkeypatch: pytest.MonkeyPatch) -> None:
    """GEOS 3.14 takes all of the first square for what they have in common; here it always does."""
    monkeypatch.setattr(shapely, "intersection", lambda a, b: WHOLE)
    depth, _ = regions_depth(WHOLE, shapely.from_wkt(SECOND), 2e-9)
    assert depth == 0.0


def test_squares_that_overlap_do() -> None:
    depth, _ = regions_depth(WHOLE, shapely.affinity.translate(shapely.from_wkt(SECOND), 1e-4, 0.0), 2e-9)
    assert depth == pytest.approx(1e-4 * 0.9421 / 1.0, rel=0.02)


def test_regions_apart_have_a_depth_below_zero_and_those_that_touch_none() -> None:
    one = shapely.box(0.0, 0.0, 1e-3, 1e-3)
    assert regions_depth(one, shapely.box(2e-3, 0.0, 3e-3, 1e-3), 2e-9)[0] < 0.0
    assert regions_depth(one, shapely.box(1e-3, 0.0, 3e-3, 1e-3), 2e-9)[0] == 0.0
    assert regions_depth(one, shapely.box(0.9e-3, -1e-3, 3e-3, 2e-3), 2e-9)[0] == pytest.approx(1e-4, rel=1e-9, abs=0.0)
