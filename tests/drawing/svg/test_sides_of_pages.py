"""Where does a page put the points of a drawing, whichever of its sides are given and in whatever unit?"""

from __future__ import annotations

import pytest

from watchsim.drawing.svg import page_unit, read_page

INCH = 0.0254
PX = INCH / 96.0


def placed(values: dict[str, str], x: float, y: float, stated: tuple[str, float] | None = None) -> tuple[float, float]:
    """The place in metres of a point in user units."""
    page = read_page(values, stated)
    px, py, _ = page.root.point((x, y, 0.0))
    return px * page.scale, py * page.scale


@pytest.mark.parametrize(
    ("values", "scale", "corner"),
    [
        ({"viewBox": "2 3 40 20", "width": "80mm", "height": "40mm"}, 2e-3, (2.0, 3.0)),
        ({"viewBox": "2 3 40 20", "width": "80mm"}, 2e-3, (2.0, 3.0)),
        ({"viewBox": "2 3 40 20", "height": "40mm"}, 2e-3, (2.0, 3.0)),
        ({"viewBox": "2 3 40 20", "width": "8cm", "height": "40mm"}, 2e-3, (2.0, 3.0)),
        ({"viewBox": "2 3 40 20", "width": "40mm", "height": "40mm"}, 1e-3, (2.0, -7.0)),  # 10 mm of page above
        ({"viewBox": "2 3 40 20", "width": "80mm", "height": "20mm"}, 1e-3, (-18.0, 3.0)),
        (
            {"viewBox": "2 3 40 20", "width": "80mm", "height": "20mm", "preserveAspectRatio": "xMinYMin slice"},
            2e-3,
            (2.0, 3.0),
        ),
        ({"viewBox": "0 0 96 96", "width": "1in", "height": "96"}, PX, (0.0, 0.0)),
        ({"width": "80mm", "height": "40mm"}, PX, (0.0, 0.0)),
        ({"width": "1in"}, PX, (0.0, 0.0)),
        ({"viewBox": "0 0 50 25", "width": "5e-4mm"}, 1e-8, (0.0, 0.0)),
    ],
    ids=str,
)
def test_the_upper_left_corner_of_the_page_is_the_origin_and_y_points_up(
    values: dict[str, str], scale: float, corner: tuple[float, float]
) -> None:
    assert placed(values, *corner) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert placed(values, corner[0] + 1.0, corner[1] + 3.0) == pytest.approx((scale, -3.0 * scale))


@pytest.mark.parametrize(
    ("values", "sides"),
    [
        ({"viewBox": "2 3 40 20", "width": "80mm"}, (40.0, 20.0)),
        ({"width": "1in", "height": "2in"}, (96.0, 192.0)),
        ({"width": "50"}, (50.0, 0.0)),
        ({}, (0.0, 0.0)),
        ({"width": "10%", "height": "auto"}, (0.0, 0.0)),
    ],
)
def test_a_page_is_so_wide_and_high_in_user_units(values: dict[str, str], sides: tuple[float, float]) -> None:
    page = read_page(values, None)
    assert (page.width, page.height) == pytest.approx(sides) and not page.empty and not page.findings


def test_without_a_unit_a_number_is_one_and_the_caller_may_name_it() -> None:
    for values in ({"viewBox": "2 3 40 20", "width": "80", "height": "40"}, {"width": "80"}):
        page = read_page(values, None)
        assert page.units is None is page.units_from
        assert placed(values, 7.0, 0.0, ("inch", INCH))[0] - placed(values, 6.0, 0.0, ("inch", INCH))[0] == pytest.approx(INCH)
        assert read_page(values, ("inch", INCH)).units_from == "option"
    said = {"viewBox": "0 0 40 20", "width": "80mm", "height": "40mm"}
    (finding,) = read_page(said, ("inch", INCH)).findings
    assert finding.code == "units-overruled" and f"everything is {INCH / 2e-3:.6g} times as large" in finding.message
    assert placed(said, 1.0, 1.0, ("inch", INCH)) == pytest.approx((INCH, -INCH))
    same = read_page(said, ("mm", 1e-3))
    assert not same.findings and same.units_from == "page" and same.units == "mm"


def test_empty_and_mixed_pages_are_told() -> None:
    for values in ({"width": "0"}, {"height": "0mm", "width": "5mm"}, {"width": "-3", "height": "9"}, {"width": "0%"}):
        assert read_page(values, None).empty
    assert not read_page({"width": "5e-4", "height": "1"}, None).empty
    assert [f.code for f in read_page({"width": "10mm", "height": "50"}, None).findings] == ["page"]
    assert [f.code for f in read_page({"viewBox": "0 0 1", "width": "x"}, None).findings] == ["damaged", "damaged"]
    wrong = read_page({"viewBox": "0 0 4 2", "width": "80mm", "height": "40mm", "preserveAspectRatio": "middle"}, None)
    assert [f.code for f in wrong.findings] == ["damaged"] and wrong.root.ax[0] * wrong.scale == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("name", "metres"), [("px", PX), (" PT ", INCH / 72), ("pc", INCH / 6), ("Q", 0.25e-3), ("mm", 1e-3), ("inch", INCH)]
)
def test_units_of_pages_are_known_by_name(name: str, metres: float) -> None:
    assert page_unit(name)[1] == pytest.approx(metres, rel=1e-15, abs=0.0)
