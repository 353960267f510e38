"""Do SVG elements draw what SVG says: shapes, transformations, view boxes, what is used again and what is hidden?"""

import math
from collections.abc import Callable

import numpy as np
import pytest
import svg_text as s
from hypothesis import given
from hypothesis import strategies as st
from naive import svg_curve

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.svg_elements import SvgError
from watchsim.drawing.svg_shapes import Box, fitted, transform
from watchsim.geometry.loops import extents
from watchsim.geometry.primitives import Arc
from watchsim.geometry.solids import area

Reader = Callable[..., Drawing]
NUMBER = st.integers(-500, 500).map(lambda n: n / 10)
FACTOR = st.integers(1, 30).map(lambda n: n / 10)
SIGNED = st.builds(lambda a, b: a * b, FACTOR, st.sampled_from((-1, 1)))
SLANT = st.integers(-60, 60)
FUNCTION = st.one_of(
    st.tuples(st.just("translate"), NUMBER, NUMBER),
    st.tuples(st.just("scale"), SIGNED),
    st.tuples(st.just("scale"), SIGNED, SIGNED),
    st.tuples(st.just("rotate"), st.integers(-400, 400)),
    st.tuples(st.just("rotate"), st.integers(-400, 400), NUMBER, NUMBER),
    st.tuples(st.just("skewX"), SLANT),
    st.tuples(st.just("skewY"), SLANT),
    st.tuples(st.just("matrix"), FACTOR, st.just(0.5), st.just(-0.3), FACTOR, NUMBER, NUMBER),
)


def box_mm(drawing: Drawing) -> list[float]:
    """Extents as SVG has them: x and y downwards, millimetres."""
    x0, y0, x1, y1 = (1e3 * v for v in extents((*drawing.loops, *drawing.open_chains)) or (0, 0, 0, 0))
    return [x0, -y1, x1, -y0]


def area_mm2(drawing: Drawing) -> float:
    return 1e6 * sum(abs(area(loop)) for loop in drawing.loops)


# Shapes


@pytest.mark.parametrize(
    ("more", "rx", "ry"),
    [
        ("", 0, 0),
        ('rx="3"', 3, 3),
        ('ry="3"', 3, 3),
        ('rx="3" ry="auto"', 3, 3),
        ('rx="3" ry="2"', 3, 2),
        ('rx="40" ry="2"', 10, 2),
        ('rx="99"', 10, 6),
        ('rx="99" ry="99"', 10, 6),
        ('rx="0" ry="5"', 0, 0),
        ('rx="10%"', 10, 6),
    ],
)
def test_rounded_rectangles(read_svg: Reader, more: str, rx: float, ry: float) -> None:
    drawing = read_svg(s.svg(f'<rect x="10" y="20" width="20" height="12" {more}/>'))
    assert box_mm(drawing) == pytest.approx([10, 20, 30, 32], abs=1e-12)
    rel = 1e-13 if rx == ry else 1e-5
    assert area_mm2(drawing) == pytest.approx(20 * 12 - (4 - math.pi) * rx * ry, rel=rel)
    assert len(drawing.loops) == 1
    assert sum(isinstance(edge, Arc) for edge in s.edges(drawing)) == (4 if rx == ry and rx else drawing.fitted_arcs)


def test_a_rectangle_with_half_its_side_as_radius_has_no_empty_sides(read_svg: Reader) -> None:
    drawing = read_svg(s.svg('<rect x=".1" y=".2" width=".3" height=".3" rx=".15"/>'))
    assert len(s.edges(drawing)) == 4
    assert not drawing.findings


def test_circles_ellipses_lines_and_polygons(read_svg: Reader) -> None:
    circle = read_svg(s.svg('<circle cx="7" cy="8" r="2.15"/>'))
    assert s.edges(circle) == [Arc(1e-3 * 7, 1e-3 * -8, 1e-3 * 2.15, 0.0, -2 * math.pi)] or s.edges(circle)[0].is_circle
    assert area_mm2(circle) == pytest.approx(math.pi * 2.15**2, rel=1e-14, abs=0.0)
    ellipse = read_svg(s.svg('<ellipse cx="7" cy="8" rx="4" ry="2"/>'))
    assert area_mm2(ellipse) == pytest.approx(math.pi * 8, rel=1e-4)
    assert ellipse.fitted_curves == 1
    assert box_mm(read_svg(s.svg('<ellipse cx="7" cy="8" rx="4"/>'))) == pytest.approx([3, 4, 11, 12])
    assert box_mm(read_svg(s.svg('<line x2="3" y1="4"/>'))) == pytest.approx([0, 0, 3, 4])
    assert area_mm2(read_svg(s.svg('<polygon points="0,0 4-0,4 3 "/>'))) == pytest.approx(6.0)
    chain = read_svg(s.svg('<polyline points="0,0 4,0 4,3"/>'))
    assert not chain.loops
    assert len(s.edges(chain)) == 2


def test_an_ellipse_scaled_to_a_circle_is_exact(read_svg: Reader) -> None:
    (edge,) = s.edges(read_svg(s.svg('<ellipse cx="7" cy="8" rx="4" ry="2" transform="rotate(30) scale(.5 1)"/>')))
    assert isinstance(edge, Arc)
    assert edge.radius == pytest.approx(2e-3, rel=1e-14)


def test_a_circle_of_radius_zero_is_a_point(read_svg: Reader) -> None:
    drawing = read_svg(s.svg('<rect width="9" height="9"/><circle id="PIVOT" cx="3" cy="4" r="0"/>'))
    assert drawing.points == (("PIVOT", pytest.approx(3e-3), pytest.approx(-4e-3)),)


@pytest.mark.parametrize(
    ("element", "word"),
    [
        ('<circle cx="3" cy="3"/>', "no r"),
        ('<circle cx="3" cy="3" r="-1"/>', "r is -1"),
        ('<circle cx="3" cy="3" r="two"/>', '"two"'),
        ('<circle cx="3" cy="3" r="2em"/>', "unit"),
        ('<circle cx="3" cy="1e99" r="2"/>', "beyond"),
        ('<rect width="3"/>', "no height"),
        ('<rect width="3" height="-3"/>', "height is -3"),
        ('<rect width="3" height="3" rx="-1"/>', "rx is -1"),
        ('<ellipse cx="3"/>', "neither rx nor ry"),
        ("<path/>", "no d"),
        ('<polygon points="1 2 3"/>', "partner"),
        ('<polygon points="1 2 3,,4"/>', "not a number"),
        ("<polygon/>", "no points"),
        ("<line/>", "no coordinates"),
        ('<circle r="3" transform="turn(3)"/>', "turn"),
        ('<circle r="3" transform="scale(0)"/>', "flat"),
        ('<circle r="3" transform="scale(1,2,3)"/>', "scale"),
        ('<circle r="3" transform="rotate(1 2)"/>', "rotate"),
        ('<circle r="3" transform="skewX(90)"/>', "slant"),
        ('<circle r="3" transform="translate(1e20)"/>', "beyond"),
        ('<circle r="3" transform="rotate(9)" style="transform-box:fill-box;transform-origin:center"/>', "own box"),
    ],
)
def test_what_cannot_be_meant_is_an_error(read_svg: Reader, element: str, word: str) -> None:
    drawing = read_svg(s.svg(f'<rect width="9" height="9"/>{element}'))
    assert word in s.errors(drawing)["damaged"]
    assert len(drawing.loops) == 1


# Transformations and view boxes


def written(functions: list[tuple]) -> str:
    return " ".join(f"{name}({','.join(map(str, numbers))})" for name, *numbers in functions)


@given(st.lists(FUNCTION, max_size=5))
def test_transformations_are_products_of_matrices(functions: list[tuple]) -> None:
    truth = np.eye(3)
    for name, *numbers in functions:
        truth = truth @ svg_curve.matrix(name, *numbers)
    found = transform(written(functions))
    columns = np.array([found.ax[:2], found.ay[:2], found.origin[:2]]).T
    assert columns == pytest.approx(truth[:2], abs=1e-11 * max(1.0, np.max(np.abs(truth))))


@given(st.lists(st.lists(FUNCTION, max_size=2), min_size=1, max_size=4))
def test_groups_nest(levels: list[list[tuple]]) -> None:
    from watchsim.drawing.svg import read_svg

    content = '<path d="M1 2L30 4 20 25z"/>'
    for functions in reversed(levels):
        content = f'<g transform="{written(functions)}">{content}</g>'
    truth = np.eye(3)
    for name, *numbers in (function for functions in levels for function in functions):
        truth = truth @ svg_curve.matrix(name, *numbers)
    strokes = read_svg(s.svg(content).encode(), None, 1e-7).strokes
    starts = np.array([(1e3 * stroke.edge.x0, -1e3 * stroke.edge.y0) for stroke in strokes])
    expected = svg_curve.mapped(truth, np.array([(1.0, 2.0), (30.0, 4.0), (20.0, 25.0)]))
    assert starts == pytest.approx(expected, abs=1e-10 * max(1.0, np.max(np.abs(truth))))


def test_transformations_of_css_have_units_and_an_origin(read_svg: Reader) -> None:
    shape = '<rect width="10" height="10" style="{}"/>'
    turned = read_svg(s.svg(shape.format("transform: rotate(.25turn); transform-origin: 20px 50%")))
    assert box_mm(turned) == pytest.approx([60, 30, 70, 40])
    moved = read_svg(s.svg(shape.format("transform: translate(10px, 5px) rotate(90deg)")))
    assert box_mm(moved) == pytest.approx([0, 5, 10, 15])


ENDS = ("Min", "Mid", "Max")
ASPECTS = ["none", *(f"x{x}Y{y}{word}" for x in ENDS for y in ENDS for word in ("", " meet", " slice"))]


@pytest.mark.parametrize("aspect", ASPECTS)
@pytest.mark.parametrize("size", [(50, 20), (20, 50)])
def test_preserve_aspect_ratio(read_svg: Reader, aspect: str, size: tuple[int, int]) -> None:
    """The corners of the view box touch the sides of the viewport that the words name."""
    w, h = size
    inner = f'<svg x="10" y="20" width="{w}" height="{h}" viewBox="-5 3 8 4" preserveAspectRatio="{aspect}">'
    x0, y0, x1, y1 = box_mm(read_svg(s.svg(f'{inner}<rect x="-5" y="3" width="8" height="4"/></svg>')))
    if aspect == "none":
        assert [x0, y0, x1, y1] == pytest.approx([10, 20, 10 + w, 20 + h])
        return
    assert (x1 - x0) / (y1 - y0) == pytest.approx(2.0)
    slack = [w - (x1 - x0), h - (y1 - y0)]
    assert min(map(abs, slack)) == pytest.approx(0.0, abs=1e-9)
    assert sum(slack) < 0.0 if "slice" in aspect else sum(slack) > 0.0
    middle = (10 + w / 2 - (x0 + x1) / 2, 20 + h / 2 - (y0 + y1) / 2)
    sides = {"Min": (10 - x0, 20 - y0), "Mid": middle, "Max": (10 + w - x1, 20 + h - y1)}
    assert sides[aspect[1:4]][0] == pytest.approx(0.0, abs=1e-9)
    assert sides[aspect[5:8]][1] == pytest.approx(0.0, abs=1e-9)


def test_a_view_box_of_the_same_size_scales_by_one_exactly() -> None:
    assert fitted(Box(0, 0, 4.3, 4.3), 4.3, 4.3, None)[:2] == (1.0, 1.0)


# What is used again

TOOTH = '<path id="tooth" d="M1 2L30 4 20 25z"/>'


@given(st.lists(FUNCTION, max_size=2), NUMBER, NUMBER)
def test_use_is_a_translation_inside_its_transformation(functions: list[tuple], x: float, y: float) -> None:
    from watchsim.drawing.svg import read_svg

    used = f'<defs>{TOOTH}</defs><use href="#tooth" x="{x}" y="{y}" transform="{written(functions)}"/>'
    plain = f'<g transform="{written(functions)} translate({x} {y})">{TOOTH}</g>'
    one, two = (read_svg(s.svg(text).encode(), None, 1e-7).strokes for text in (used, plain))
    assert len(one) == 3
    assert [(a.edge.start, a.edge.end) for a in one] == [
        (pytest.approx(b.edge.start, abs=1e-12), pytest.approx(b.edge.end, abs=1e-12)) for b in two
    ]


@pytest.mark.parametrize(
    ("target", "use", "expected"),
    [
        ('<symbol id="a" viewBox="0 0 10 10">', 'x="20" y="30" width="40" height="40"', [20, 30, 60, 70]),
        ('<symbol id="a" viewBox="0 0 10 10">', 'x="20" y="30" width="40" height="20"', [30, 30, 50, 50]),
        ('<symbol id="a" viewBox="0 0 10 10" preserveAspectRatio="none">', 'width="40" height="20"', [0, 0, 40, 20]),
        ('<symbol id="a" viewBox="0 0 10 10">', "", [0, 0, 100, 100]),
        ('<symbol id="a" viewBox="0 0 10 10" width="30" height="30">', "", [0, 0, 30, 30]),
        ('<symbol id="a" viewBox="0 0 10 10" width="30" height="30">', 'width="50"', [10, 0, 40, 30]),
        ('<symbol id="a" viewBox="0 0 10 10" x="5" y="6">', 'width="20" height="20"', [5, 6, 25, 26]),
        ('<symbol id="a">', 'x="20" width="40"', [20, 0, 30, 10]),
        ('<symbol id="a" transform="scale(3)">', 'x="20"', [20, 0, 50, 30]),
        ('<svg id="a" viewBox="0 0 20 20" width="9" height="9">', 'x="1" width="50%" height="50"', [1, 0, 26, 25]),
        ('<svg id="a" viewBox="0 0 20 20" width="10" height="10">', 'x="1"', [1, 0, 6, 5]),
        ('<svg id="a" x="2" y="3">', 'x="1"', [3, 3, 13, 13]),
        ('<g id="a">', 'x="1" width="50"', [1, 0, 11, 10]),
    ],
)
def test_symbols_and_nested_drawings(read_svg: Reader, target: str, use: str, expected: list[float]) -> None:
    tag = target[1:-1].partition(" ")[0]
    defined = f'<defs>{target}<rect width="10" height="10"/></{tag}></defs>'
    drawing = read_svg(s.svg(f'{defined}<use xlink:href="#a" {use}/>'))
    assert box_mm(drawing) == pytest.approx(expected)
    assert len(drawing.loops) == 1


def test_a_symbol_alone_is_not_drawn_and_percentages_follow_the_viewport(read_svg: Reader) -> None:
    assert "empty" in s.errors(read_svg(s.svg(f"<symbol>{TOOTH}</symbol>")))
    inner = '<svg x="10" y="10" width="40" height="20"><rect x="25%" y="50%" width="50%" height="50%"/></svg>'
    assert box_mm(read_svg(s.svg(inner))) == pytest.approx([20, 20, 40, 30])
    tiny = '<svg width="5e-4" height="5e-4" viewBox="0 0 1e-6 1e-6"><rect width="0.02" height="0.02"/></svg>'
    assert box_mm(read_svg(s.svg(tiny))) == pytest.approx([0, 0, 10, 10])
    circle = read_svg(s.svg('<svg width="30" height="40" viewBox="0 0 30 40"><circle r="10%"/></svg>'))
    assert s.edges(circle)[0].radius == pytest.approx(1e-4 * math.sqrt((30**2 + 40**2) / 2))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ('<use href="#none"/>', "use-missing"),
        ("<use/>", "use-missing"),
        ('<use href="other.svg#a"/>', "external"),
        ('<use xlink:href="http://example.com/a.svg#a"/>', "external"),
        ('<use id="u" href="#u"/>', "use-loop"),
        ('<g id="a"><use href="#a"/></g>', "use-loop"),
        ('<defs><g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></defs><use href="#a"/>', "use-loop"),
        ('<symbol id="a"><use href="#a"/></symbol><use href="#a"/>', "use-loop"),
    ],
)
def test_references_that_lead_nowhere_outside_or_round_are_refused(read_svg: Reader, content: str, code: str) -> None:
    drawing = read_svg(s.svg(f'{content}<rect width="9" height="9"/>'))
    assert code in s.errors(drawing)
    assert len(drawing.loops) == 1


# What is hidden, and what is not drawn

BOX = '<rect width="9" height="9"'  # unfinished: attributes follow


@pytest.mark.parametrize(
    "content",
    [
        'BOX display="none"/>',
        'BOX visibility="hidden"/>',
        'BOX style="fill:red; display : none"/>',
        'BOX style="visibility:collapse"/>',
        '<g display="none"><g>BOX/></g></g>',
        '<g visibility="hidden"><g>BOX/></g></g>',
        '<g style="display:none" inkscape:groupmode="layer" inkscape:label="aux">BOX/></g>',
        "<style>rect{display:none}</style>BOX/>",
        '<style>.aux{fill:red;display:none}</style>BOX class="x aux"/>',
        '<style><![CDATA[ /* a { b */ @font-face{src:x} #k, #m { visibility: hidden } ]]></style>BOX id="k"/>',
        '<style>g.a > rect.b{display:none}</style><g class="a">BOX class="b"/></g>',
        '<style>g.a rect{display:none}</style><g class="a"><g>BOX/></g></g>',
        '<style>rect{display:inline} rect{display:none !important}</style>BOX style="display:inline"/>',
        '<style>[class=aux]{display:none}</style>BOX class="aux"/>',
        '<defs>BOX id="r"/></defs><use href="#r" visibility="hidden"/>',
        '<g requiredExtensions="http://x">BOX/></g>',
        '<switch><g systemLanguage="de">BOX/></g></switch>',
    ],
)
def test_what_is_hidden_is_left_out_and_said(read_svg: Reader, content: str) -> None:
    circle = '<circle cx="50" cy="50" r="1" style="display:inline !important"/>'
    drawing = read_svg(s.svg(f"<g style='display:inline !important'>{content}{circle}</g>".replace("BOX", BOX)))
    assert [len(loop.edges) for loop in drawing.loops] == [1]
    assert "hidden" in s.codes(drawing)
    assert not s.errors(drawing)


@pytest.mark.parametrize(
    "content",
    [
        '<g visibility="hidden">BOX visibility="visible"/></g>',
        '<style>rect{display:none}</style>BOX style="display:inline"/>',
        '<style>rect{display:none} #k{display:inline} .c{display:none}</style>BOX id="k" class="c"/>',
        "<style>@media print{rect{fill:red}} g > rect{display:none}</style>BOX/>",
        '<style>rect.aux{display:none}</style>BOX class="auxiliary"/>',
        '<switch><foreignObject requiredExtensions="x"/><g systemLanguage="de"/><g>BOX/></g></switch>',
        "<a>BOX/></a>",
        f"BOX/><clipPath>{TOOTH}</clipPath><mask>{TOOTH}</mask><pattern>{TOOTH}</pattern><marker>{TOOTH}</marker>",
    ],
)
def test_what_is_shown_is_read_and_nothing_else(read_svg: Reader, content: str) -> None:
    drawing = read_svg(s.svg(content.replace("BOX", BOX)))
    assert [len(loop.edges) for loop in drawing.loops] == [4]
    assert not drawing.findings


def test_text_pictures_and_strangers_are_counted(read_svg: Reader) -> None:
    others = '<text>A<tspan>B</tspan></text><image href="a.png"/><pth d="M1 1h3"/><x:y xmlns:x="urn:x"/>'
    drawing = read_svg(s.svg(f"{BOX}/>" + others))
    assert drawing.ignored == {"text": 1, "image": 1, "pth": 1}
    severity = {finding.message.split()[2]: finding.severity for finding in drawing.findings if finding.code == "ignored"}
    assert severity == {"text": "notice", "image": "notice", "pth": "warning"}
    strange = read_svg(s.svg('<rect width="9" height="9" xx="5" data-x="" onclick=""/>'))
    assert '"xx"' in s.codes(strange)["strange-attribute"]
    clipped = read_svg(s.svg(f'{BOX} clip-path="url(#c)"/>'))
    assert "clipped" in s.codes(clipped)


@pytest.mark.parametrize("selector", ["rect:hover", "g + rect", "rect:nth-child(2)"])
def test_selectors_that_are_not_read_are_errors_only_where_they_hide(read_svg: Reader, selector: str) -> None:
    assert "css" in s.errors(read_svg(s.svg(f"<style>{selector}{{display:none}}</style>{BOX}/>")))
    assert not read_svg(s.svg(f"<style>{selector}{{fill:red}}</style>{BOX}/>")).findings


def test_a_path_that_is_closed_in_part_only_waits_for_others_and_names_no_layer(read_svg: Callable[..., Drawing]) -> None:
    tip, whole = s.path("M0 0 h2 v2 z M5 5 h3", 'id="tip"'), s.path("M0 9 h2 v2 z", 'id="whole"')
    drawing = read_svg(s.svg(f'<g id="RIM">{tip}{whole}</g>'))
    assert {loop.layer for loop in drawing.loops} == {"RIM", "whole"}
    assert {chain.layer for chain in drawing.open_chains} == {"RIM"}


@pytest.mark.parametrize("map_", ["scale({0} 1) scale({1} 1)", "scale(1 {0}) scale(1 {1})", "scale({0} 1) translate({1} 0)"])
def test_transforms_that_go_together_beyond_any_drawing_are_refused_in_every_direction(map_: str) -> None:
    for sign in ("", "-"):
        with pytest.raises(SvgError, match="beyond any drawing"):
            transform(map_.format(f"{sign}2e6", "1e6"))
        transform(map_.format(f"{sign}2e5", "1e6"))


def shown(read_svg: Reader, style: str, attributes: str, around: str = "{}") -> bool:
    """Is a line with these attributes drawn, beside one that always is?"""
    line = s.path("M0 0L5 5", attributes)
    drawing = read_svg(s.svg(f"<style>{style}</style>{around.format(line)}<polyline points='9,9 20,9'/>"))
    return len(s.edges(drawing)) == 2


@pytest.mark.parametrize(
    ("style", "attributes", "is_shown"),
    [
        (".a{display:none}.b{display:none}", 'class="b"', False),
        (".a{display:none}\n.b{display:none}", 'class="c"', True),
        (".a{display:none} path{display:inline}", 'class="a"', False),
        ("path{display:none} .a{display:inline}", 'class="a"', True),
        (".a{display:inline} .b{display:none}", 'class="b a"', False),
        (".b{display:none} .a{display:inline}", 'class="b a"', True),
        ("#k{display:inline} .a.b{display:none}", 'id="k" class="a b"', True),
        (".a.b{display:inline} .a{display:none}", 'class="a b"', True),
        ("[id]{display:none} path{display:inline}", 'id="k"', False),
        (".a[id]{display:inline} .a{display:none}", 'id="k" class="a"', True),
        ("*{display:inline} path{display:none}", "", False),
        ("path{display:none} *{display:inline}", "", False),
        (".a{display:none!important} #k{display:inline}", 'id="k" class="a"', False),
        (".a{display:none ! IMPORTANT} #k{display:inline!important}", 'id="k" class="a"', True),
        (".a{display:none} ", 'class="a" style="display:inline"', True),
        (".a{display:none!important} ", 'class="a" style="display:inline"', False),
        (".a{display:inline!urgent} #k{display:none}", 'id="k" class="a"', False),
        (".a{display:inline;display:none}", 'class="a"', False),
        (".a{display:none!important;display:inline}", 'class="a"', False),
        ("@font-face{src:x}.a{display:none}", 'class="a"', False),
        ("@media print{.a{display:none}}.b{display:none}", 'class="b"', False),
        ("@media print{.a{display:none}}.b{display:none}", 'class="a"', True),
    ],
)
def test_the_most_particular_rule_counts_and_of_equals_the_last(
    read_svg: Reader, style: str, attributes: str, is_shown: bool
) -> None:
    assert shown(read_svg, style, attributes) is is_shown


@pytest.mark.parametrize(
    ("style", "around", "is_shown"),
    [
        ("g path{display:none}", "<g><g>{}</g></g>", False),
        ("g path{display:none}", "{}", True),
        ("g>path{display:none}", "<g>{}</g>", False),
        (".o>path{display:none}", '<g class="o"><g>{}</g></g>', True),
        (".o path{display:none}", '<g class="o"><g>{}</g></g>', False),
        (".o g>path{display:none}", '<g class="o"><g>{}</g></g>', False),
        (".o>.o path{display:none}", '<g class="o"><g>{}</g></g>', True),
        (".o,.p path{display:none}", '<g class="p">{}</g>', False),
    ],
)
def test_rules_for_what_lies_within(read_svg: Reader, style: str, around: str, is_shown: bool) -> None:
    assert shown(read_svg, style, "", around) is is_shown


@pytest.mark.parametrize(
    ("style", "told"),
    [
        ("@media print{.a{display:none}}", True),
        ("@media print{.a{stroke:red}}", False),
        ("@media print{.a{color:red;cursor:help}}", False),
        ("@media print{.a{r : 2px}}", True),
        ("@supports (x:y){.a{visibility:hidden}}", True),
        ("@font-face{display:none}", False),
        ('@import "other.css";', True),
    ],
)
def test_rules_that_are_not_read_are_told_where_they_could_hide_something(read_svg: Reader, style: str, told: bool) -> None:
    drawing = read_svg(s.svg(f"<style>{style}</style>{s.path('M9 9L20 9')}"))
    assert bool({"css", "external"} & set(s.codes(drawing))) is told
