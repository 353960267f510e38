"""Which unit does an SVG drawing have, and on which layers does it lie?"""

from collections.abc import Callable

import pytest
import svg_text as s

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspection import inspect_report
from watchsim.drawing.svg import FOREIGN, page_unit, read_page
from watchsim.geometry.loops import extents
from watchsim.geometry.primitives import Arc

Reader = Callable[..., Drawing]
SQUARE = '<rect width="4.3" height="4.3"/>'


def across(drawing: Drawing) -> float:
    """Metres."""
    box = extents(drawing.loops)
    assert box is not None
    return box[2] - box[0]


@pytest.mark.parametrize(
    ("page", "units", "size"),
    [
        ('width="4.3mm" height="4.3mm" viewBox="0 0 4.3 4.3"', "mm", 4.3e-3),
        ('width="4.3mm" viewBox="0 0 4.3 4.3"', "mm", 4.3e-3),
        ('height="4.3mm" viewBox="0 0 4.3 4.3"', "mm", 4.3e-3),
        ('width="4.3mm" height="100%" viewBox="0 0 4.3 4.3"', "mm", 4.3e-3),
        ('width="43mm" height="43mm" viewBox="-10 -20 4.3 4.3"', "mm", 43e-3),
        ('width="4.3cm" height="43mm" viewBox="0 0 4.3 4.3"', "cm", 43e-3),
        ('width="4.3in" height="4.3in" viewBox="0 0 4.3 4.3"', "inch", 4.3 * 0.0254),
        ('width="4.3pt" height="4.3pt" viewBox="0 0 4.3 4.3"', "pt", 4.3 * 0.0254 / 72),
        ('width="4.3pc" height="4.3pc" viewBox="0 0 4.3 4.3"', "pc", 4.3 * 0.0254 / 6),
        ('width="4.3Q" height="4.3Q" viewBox="0 0 4.3 4.3"', "Q", 4.3e-3 / 4),
        ('width="4.3px" height="4.3px" viewBox="0 0 4.3 4.3"', "px", 4.3 * 0.0254 / 96),
        ('width="10mm" height="10mm"', "mm", 4.3 * 0.0254 / 96),
        ('width="8.6mm" height="43mm" viewBox="0 0 4.3 4.3"', "mm", 8.6e-3),
        ('width="8.6mm" height="43mm" viewBox="0 0 4.3 4.3" preserveAspectRatio="xMidYMid slice"', "mm", 43e-3),
    ],
)
def test_a_page_with_a_size_says_the_unit(read_svg: Reader, page: str, units: str, size: float) -> None:
    drawing = read_svg(s.svg(SQUARE, page))
    assert across(drawing) == pytest.approx(size, rel=1e-14, abs=0.0)
    assert inspect_report(drawing)["units"] == units
    assert inspect_report(drawing)["units_from"] == "page"
    assert not drawing.findings


ILLUSTRATOR = "<!-- Generator: Adobe Illustrator 27.0.0, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->"
OLD, NEW = ('inkscape:version="0.91 r13725"', 'inkscape:version="0.92.4 (5da689c313, 2019-01-14)"')


@pytest.mark.parametrize(
    ("before", "page", "factor"),
    [
        (ILLUSTRATOR, 'width="28.346px" height="28.346px" viewBox="0 0 28.346 28.346"', "1.33333"),
        (ILLUSTRATOR, 'viewBox="0 0 28.346 28.346"', "1.33333"),
        ("", f'width="210mm" height="297mm" {OLD}', "1.06667"),
        ("", f'width="372px" height="1052px" viewBox="0 0 372 1052" {OLD}', "1.06667"),
    ],
)
def test_programs_that_count_pixels_differently_are_named(read_svg: Reader, before: str, page: str, factor: str) -> None:
    drawing = read_svg(before + s.svg(SQUARE, page))
    assert f"{factor} times as large" in s.codes(drawing)["pixels"]
    assert "pixels" not in s.codes(read_svg(before + s.svg(SQUARE, page), units="pt"))


@pytest.mark.parametrize(
    ("before", "page"),
    [
        (ILLUSTRATOR, 'width="10mm" height="10mm" viewBox="0 0 28.346 28.346"'),
        ("", f'width="210mm" height="297mm" viewBox="0 0 210 297" {OLD}'),
        ("", f'width="372px" height="1052px" viewBox="0 0 372 1052" {NEW}'),
        ("<!-- drawn by hand -->", 'width="372px" height="1052px"'),
    ],
)
def test_pages_that_do_not_rest_on_such_pixels_are_fine(read_svg: Reader, before: str, page: str) -> None:
    assert not read_svg(before + s.svg(SQUARE, page)).findings


def test_points_named_by_the_caller_give_the_size_that_was_drawn(read_svg: Reader) -> None:
    page = 'width="28.346px" height="28.346px" viewBox="0 0 28.346 28.346"'
    drawing = read_svg(ILLUSTRATOR + s.svg('<circle cx="14.173" cy="14.173" r="14.173"/>', page), units="pt")
    assert across(drawing) == pytest.approx(10e-3, rel=1e-4)


def test_millimetres_are_exact(read_svg: Reader) -> None:
    drawing = read_svg(s.svg('<circle cx="1.7" cy="2.3" r="1.15"/>', 'width="4.3mm" height="4.3mm" viewBox="0 0 4.3 4.3"'))
    (edge,) = s.edges(drawing)
    assert isinstance(edge, Arc)
    assert (edge.x, edge.y, edge.radius) == (1e-3 * 1.7, 1e-3 * -2.3, 1e-3 * 1.15)


@pytest.mark.parametrize(
    "page",
    ["", 'viewBox="0 0 9 9"', 'width="430" height="430" viewBox="0 0 4.3 4.3"', 'width="100%" height="100%" viewBox="0 0 9 9"'],
)
def test_a_page_without_a_unit_has_none_until_it_is_said(read_svg: Reader, page: str) -> None:
    drawing = read_svg(s.svg(SQUARE, page))
    assert drawing.units is None
    assert drawing.units_from is None
    assert set(s.errors(drawing)) == {"units-missing"}
    assert "4.3 mm or 109.2 mm" in s.errors(drawing)["units-missing"]
    for unit, metres in (("mm", 1e-3), ("inch", 0.0254), ("px", 0.0254 / 96)):
        said = read_svg(s.svg(SQUARE, page), units=unit)
        assert (said.units, said.units_from) == (unit, "option")
        assert across(said) == pytest.approx(4.3 * metres, rel=1e-14, abs=0.0)
        assert not said.findings


def test_the_caller_overrules_the_page_with_a_warning(read_svg: Reader) -> None:
    text = s.svg(SQUARE, 'width="43mm" height="43mm" viewBox="0 0 4.3 4.3"')
    agreed = read_svg(text, units="mm")
    assert (agreed.units_from, across(agreed), agreed.findings) == ("page", pytest.approx(43e-3), ())
    overruled = read_svg(text, units="inch")
    assert across(overruled) == pytest.approx(4.3 * 0.0254)
    assert "2.54 times as large" in s.codes(overruled)["units-overruled"]
    with pytest.raises(ValueError, match="furlong"):
        read_svg(text, units="furlong")


@pytest.mark.parametrize(
    ("page", "word"),
    [
        ('width="wide" height="3mm"', "wide"),
        ('width="3em" height="3mm"', "unit"),
        ('viewBox="0 0 4"', "viewBox"),
        ('viewBox="0 0 4 -4"', "viewBox"),
        ('width="3mm" height="3mm" viewBox="0 0 3 3" preserveAspectRatio="middle"', "middle"),
    ],
)
def test_pages_that_cannot_be_read_are_errors(read_svg: Reader, page: str, word: str) -> None:
    assert word in s.errors(read_svg(s.svg(SQUARE, page)))["damaged"]


def test_pages_of_two_minds_or_without_size_are_told(read_svg: Reader) -> None:
    mixed = read_svg(s.svg(SQUARE, 'width="43mm" height="43" viewBox="0 0 4.3 4.3"'))
    assert "one of its sides" in s.codes(mixed)["page"]
    assert {"page", "empty"} <= set(s.codes(read_svg(s.svg(SQUARE, 'width="0" height="0"'))))


LAYER = 'inkscape:groupmode="layer"'
ROUND = '<circle r="1"/>'
PIVOT, ONE = '<circle id="PIVOT" r="1"/>', '<circle id="one" r="1"/>'


@pytest.mark.parametrize(
    ("content", "layers"),
    [
        (ROUND, ["0"]),
        (PIVOT, ["PIVOT"]),
        ('<circle id="circle12-3" r="1"/>', ["0"]),
        (f'<g id="TEETH">{ROUND}</g>', ["TEETH"]),
        (f'<g id="g10">{ROUND}</g>', ["0"]),
        (f'<g id="WHEEL"><g id="TEETH"><g id="g7">{ROUND}</g></g></g>', ["TEETH"]),
        (f'<g id="WHEEL">{PIVOT}</g>', ["PIVOT"]),
        (f'<g id="layer1" {LAYER} inkscape:label="TEETH">{ONE}</g>', ["TEETH"]),
        (f'<g id="layer1" {LAYER}>{ROUND}</g>', ["layer1"]),
        (f'<g {LAYER} inkscape:label="A"><g {LAYER} inkscape:label="B">{ROUND}</g>{ROUND}</g>', ["B", "A"]),
        (f'<g {LAYER} inkscape:label="A"><circle inkscape:label="PIVOT" r="1"/></g>', ["PIVOT"]),
        (f'<g id="Escape_x20_wheel">{ROUND}</g>', ["Escape wheel"]),
        (f'<g id="a_1_" data-name="a">{ROUND}</g>', ["a"]),
        ('<line id="EDGE" x2="3"/>', ["0"]),
        ('<path id="EDGE" d="M1 1h3"/>', ["0"]),
        ('<path id="CAM" d="M1 1h3v3z"/>', ["CAM"]),
        (f'<defs>{ONE}</defs><g id="TEETH"><use id="u" href="#one"/></g>', ["TEETH"]),
        (f'<defs>{ONE}</defs><use href="#one"/>', ["one"]),
        (f'<defs>{ONE}</defs><use id="PIN" href="#one"/>', ["PIN"]),
    ],
)
def test_layers(read_svg: Reader, content: str, layers: list[str]) -> None:
    assert list(read_svg(s.svg(content)).layers) == layers


def test_outlines_of_single_lines_with_names_of_their_own_close(read_svg: Reader) -> None:
    lines = '<line id="a" x2="3"/><line id="b" x1="3" x2="3" y2="3"/><path id="c" d="M3 3L0 0"/>'
    assert len(read_svg(s.svg(lines)).loops) == 1


def test_elements_of_no_namespace_are_read_and_said(read_svg: Reader) -> None:
    """Browsers draw nothing that is not in the namespace of SVG."""
    bare = '<svg width="9mm" height="9mm" viewBox="0 0 9 9"><circle cx="4" cy="4" r="2"/></svg>'
    (finding,) = read_svg(bare).findings
    assert (finding.code, finding.severity) == ("namespace", "warning") and "browsers draw nothing of it" in finding.message
    assert len(read_svg(bare).loops) == 1 and 'xmlns="http://www.w3.org/2000/svg"' in finding.fix
    named = bare.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"')
    assert not read_svg(named).findings
    inside = named.replace("</svg>", '<g xmlns=""><rect width="1" height="1"/></g></svg>')
    (finding,) = read_svg(inside).findings
    assert "2 of 4 elements are in no namespace" in finding.message


@pytest.mark.parametrize(
    "foreign", ['<x:rect width="1" height="1"/>', f"<x:thing>{s.path('M0 0h1v1z')}</x:thing>"], ids=["itself", "within"]
)
def test_what_is_drawn_in_another_namespace_is_said(read_svg: Reader, foreign: str) -> None:
    drawing = read_svg(s.svg(f'<g xmlns:x="http://example.org">{foreign}{s.path("M0 0h2v2z")}</g>'))
    assert len(drawing.loops) == 1
    assert any(FOREIGN in finding.message for finding in drawing.findings)
    silent = read_svg(s.svg(f'<g xmlns:x="http://example.org"><x:note/>{s.path("M0 0h2v2z")}</g>'))
    assert silent.findings == ()


def test_a_rectangle_of_a_micrometre_is_one(read_svg: Reader) -> None:
    """Sizes are compared with nothing, not with something small."""
    (loop,) = read_svg(s.svg('<rect x="1" y="1" width="0.0009" height="2"/>')).loops
    assert len(loop.edges) == 4


@pytest.mark.parametrize("size", ['width="0" height="2"', 'width="2" height="0"'])
def test_a_rectangle_without_width_or_height_is_none(read_svg: Reader, size: str) -> None:
    drawing = read_svg(s.svg(f'<rect x="1" y="1" {size}/><rect x="5" y="5" width="1" height="1"/>'))
    assert [len(loop.edges) for loop in drawing.loops] == [4]
    assert [finding.code for finding in drawing.findings] == ["zero-size"]


def test_what_is_damaged_or_drawn_is_not_called_empty(read_svg: Reader) -> None:
    drawing = read_svg(s.svg(s.path("M0 0h2v2z") + s.path("Q")))
    assert [finding.code for finding in drawing.findings] == ["damaged"]
    drawing = read_svg(s.svg(s.path("M0 0h2v2z") + s.path("")))
    assert [finding.code for finding in drawing.findings] == ["zero-size"]


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
