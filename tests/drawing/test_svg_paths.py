"""Does a path draw what its definition says, however it is written?"""

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from itertools import pairwise, product
from pathlib import Path

import numpy as np
import pytest
import svg_text as s
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_outlines import compare, parts, same_edge
from naive import svg_curve

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.projection import Conic, Shape, Spline, Straight
from watchsim.drawing.read import read
from watchsim.drawing.svg_elements import SvgError
from watchsim.drawing.svg_shapes import elliptic_arc, read_path
from watchsim.drawing.write import svg_text
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point
from watchsim.geometry.solids import section

Reader = Callable[..., Drawing]
COORDINATE = st.integers(-9999, 9999).map(lambda n: n / 100)
RADIUS = st.integers(1, 3000).map(lambda n: n / 100)
PAIR = st.tuples(COORDINATE, COORDINATE)
FLAG = st.sampled_from((0, 1))


def commands() -> st.SearchStrategy[list[tuple]]:
    """Random paths: absolute commands, as tuples of a letter and numbers."""
    pairs = {"L": 1, "C": 3, "S": 2, "Q": 2, "T": 1}
    polynomial = [
        st.tuples(*[PAIR] * count).map(lambda p, kind=kind: (kind, *(x for pair in p for x in pair)))
        for kind, count in pairs.items()
    ]
    arc = st.tuples(st.just("A"), RADIUS, RADIUS, st.integers(-180, 180), FLAG, FLAG, COORDINATE, COORDINATE)
    piece = st.one_of(
        *polynomial, st.tuples(st.just("H"), COORDINATE), st.tuples(st.just("V"), COORDINATE), st.just(("Z",)), arc
    )
    move = PAIR.map(lambda p: ("M", *p))
    return st.tuples(move, st.lists(st.one_of(piece, piece, piece, move), min_size=1, max_size=8)).map(lambda t: [t[0], *t[1]])


def written(path: list[tuple], relative: bool, compact: bool) -> str:
    """The path as text: with relative numbers, and without every letter and blank that can be spared."""
    text, last = "", ""
    x = y = sx = sy = 0.0
    for kind, *a in path:
        dx, dy = (x, y) if relative else (0.0, 0.0)
        shifts = {"H": [dx], "V": [dy], "A": [0, 0, 0, 0, 0, dx, dy]}.get(kind, [dx, dy] * (len(a) // 2))
        numbers = [f"{round(value - shift, 9):.10g}" for value, shift in zip(a, shifts, strict=True)]
        letter = kind.lower() if relative else kind
        spared = compact and (letter == last or (last in "Mm" and kind == "L" and last != "")) and kind not in "ZM"
        if compact:
            numbers = [n.replace("0.", ".", 1) if n.startswith(("0.", "-0.")) else n for n in numbers]
            body = ""
            for k, n in enumerate(numbers):
                tight = k > 0 and kind == "A" and k in (4, 5)  # after a flag nothing need stand
                before = numbers[k - 1] if k else ""
                sparable = tight or n.startswith("-") or (n.startswith(".") and "." in before and k > 0)
                first = k == 0 and not spared
                body += n if first or sparable else (" " if k or spared else "") + n
            text += body if spared else letter + body
        else:
            text += f" {letter} " + " , ".join(numbers)
        last = letter
        if kind == "M":
            sx, sy = a
        x = sx if kind == "Z" else x if kind == "V" else a[0] if kind == "H" else a[-2]
        y = sy if kind == "Z" else y if kind == "H" else a[-1]
    return text


def samples(shape: Shape) -> list[tuple[float, float]]:
    """Three points of a shape."""
    if isinstance(shape, Straight):
        return [shape.a[:2], shape.b[:2]]
    if isinstance(shape, Conic):
        t = [shape.start + k * shape.sweep / 2 for k in range(3)]
        c, u, v = shape.centre, shape.u, shape.v
        return [(c[0] + u[0] * math.cos(a) + v[0] * math.sin(a), c[1] + u[1] * math.cos(a) + v[1] * math.sin(a)) for a in t]
    assert isinstance(shape, Spline)
    return [point[:2] for point in shape.points]


@given(commands())
def test_every_way_of_writing_draws_the_same(path: list[tuple]) -> None:
    plain = read_path(written(path, False, False))
    assert not plain.fault
    for relative, compact in ((False, True), (True, False), (True, True)):
        text = written(path, relative, compact)
        other = read_path(text)
        assert not other.fault, text
        # A close or a step that leads nowhere is only visible up to rounding.
        one, two = ([p for row in data.rows for shape in row.shapes for p in samples(shape)] for data in (plain, other))
        if len(one) == len(two):
            # Radii just too small or just large enough turn rounding into its square root.
            assert np.array(two) == pytest.approx(np.array(one), abs=2e-5), text
        else:
            assert abs(len(one) - len(two)) <= 2 * sum(kind == "Z" for kind, *_ in path), text


@given(commands(), st.booleans())
def test_edges_lie_on_the_curve_and_the_curve_on_edges(path: list[tuple], compact: bool) -> None:
    from watchsim.drawing.svg import read_svg

    content = read_svg(s.svg(s.path(written(path, compact, compact))).encode(), None, 1e-6)
    assert not [finding for finding in content.findings if finding.severity == "error"]
    truth = svg_curve.points(path)
    edges = [stroke.edge for stroke in content.strokes]
    assert bool(edges) == bool(len(truth))
    if not edges:
        return
    missed = s.distances(truth, edges)
    assert np.max(missed) < 1.5e-3  # fit is 1 µm; the truth is in mm, radii at their limit conditioned badly
    step = np.max(np.hypot(*np.diff(truth, axis=0).T)) if len(truth) > 1 else 0.0
    ours = np.array([edge.point(f) for edge in edges for f in (0.0, 0.3, 0.7, 1.0)]) * [1e3, -1e3]
    apart = np.array([np.min(np.hypot(*(truth - p).T)) for p in ours])
    assert np.max(apart) < step + 1.5e-3


@pytest.mark.parametrize("large", [0, 1])
@pytest.mark.parametrize("sweep", [0, 1])
@pytest.mark.parametrize("mirror", ["", "scale(-1,1)", "rotate(33)", "scale(2)", "matrix(0,3,3,0,7,8)"])
def test_circular_arcs_stay_exact_under_similarities(read_svg: Reader, large: int, sweep: int, mirror: str) -> None:
    drawing = read_svg(s.svg(s.path(f"M10 20A5 5 40 {large}{sweep}17 21", f'transform="{mirror}"')))
    (edge,) = s.edges(drawing)
    assert isinstance(edge, Arc)
    truth = np.array(svg_curve.arc(10 + 20j, (5, 5, 40, large, sweep, 17, 21), 50))
    points = np.column_stack((truth.real, truth.imag))
    if mirror:
        name, numbers = mirror[:-1].split("(")
        points = svg_curve.mapped(svg_curve.matrix(name, *map(float, numbers.split(","))), points)
    assert np.max(s.distances(points, [edge])) < 1e-12
    assert 1e3 * edge.length == pytest.approx(np.sum(np.hypot(*np.diff(points, axis=0).T)), rel=1e-3)
    assert drawing.fitted_curves == 0


def test_semicircles_are_as_exact_as_their_numbers(read_svg: Reader) -> None:
    (loop,) = read_svg(s.svg(s.path("M 2.85 5 A 2.15 2.15 0 1 0 7.15 5 A 2.15 2.15 0 1 0 2.85 5 Z"))).loops
    for edge in loop.edges:
        assert isinstance(edge, Arc)
        assert (edge.x, edge.y, edge.radius) == pytest.approx((5e-3, -5e-3, 2.15e-3), rel=1e-14, abs=0.0)


def test_radii_grow_where_they_are_too_small(read_svg: Reader) -> None:
    (edge,) = s.edges(read_svg(s.svg(s.path("M 10 10 A 1 1 0 0 1 16 18"))))
    assert isinstance(edge, Arc)
    assert (edge.x, edge.y, edge.radius) == pytest.approx((13e-3, -14e-3, 5e-3), rel=1e-14, abs=0.0)


@pytest.mark.parametrize("arc", ["A0 3 0 0 0 9 9", "A3 0 0 1 1 9 9", "a0 0 0 0 0 8 8"])
def test_arcs_without_radius_are_lines(read_svg: Reader, arc: str) -> None:
    assert s.edges(read_svg(s.svg(s.path(f"M1 1{arc}")))) == [Line(1e-3 * 1, 1e-3 * -1, 1e-3 * 9, 1e-3 * -9)]


@pytest.mark.parametrize(
    ("d", "count", "word"),
    [
        ("L 5 5", 0, "begins with"),
        ("M1 1 L 5 5 6", 1, "ends"),
        ("M1 1 L 5 5 X 7 7", 1, '"X'),
        ("M1 1 L 5 5 L 7#7", 1, '"#7"'),
        ("M1 1 L 5 5 A 3 3 0 2 0 9 9", 1, '"2 0 9'),
        ("M1 1 L 5 5,,7 7", 1, '",,7'),
        ("M1 1 L ,5 5", 0, '",5'),
        ("M1 1 H 1e999", 0, "beyond"),
        ("M1 1 L 5 5 z 7 7", 2, "closed"),
        ("M1 1 L 5 5 nan 7", 1, '"n"'),
        ("M1 1 H 7 V", 1, "ends"),
    ],
)
def test_a_fault_ends_the_path_and_is_told(d: str, count: int, word: str) -> None:
    data = read_path(d)
    assert sum(len(row.shapes) for row in data.rows) == count
    assert word in data.fault


def test_damaged_paths_are_errors_and_drawn_to_the_fault(read_svg: Reader) -> None:
    drawing = read_svg(s.svg(s.path("M1 1 H5 V5 H$", 'id="flank"')))
    assert "path #flank" in s.errors(drawing)["damaged"]
    assert len(s.edges(drawing)) == 2


def test_relative_steps_that_close_leave_no_remainder(read_svg: Reader) -> None:
    steps = " ".join(f"l {0.1 * math.cos(k * math.pi / 50):.17g} {0.1 * math.sin(k * math.pi / 50):.17g}" for k in range(100))
    drawing = read_svg(s.svg(s.path(f"M 33.3 44.4 {steps} z")))
    (loop,) = drawing.loops
    assert len(loop.edges) == 100
    assert "zero-length" not in s.codes(drawing)


def kappa_circle(x: float, y: float, r: float, digits: int = 12) -> str:
    k = 4.0 / 3.0 * math.tan(math.pi / 8.0) * r
    corners = [(r, 0, 0, 1), (0, r, -1, 0), (-r, 0, 0, -1), (0, -r, 1, 0), (r, 0, 0, 1)]
    d = f"M{x + r:.{digits}f} {y:.{digits}f}"
    for (ax, ay, ux, uy), (bx, by, vx, vy) in pairwise(corners):
        numbers = (x + ax + k * ux, y + ay + k * uy, x + bx - k * vx, y + by - k * vy, x + bx, y + by)
        d += "C" + " ".join(f"{number:.{digits}f}" for number in numbers)
    return d + "Z"


@pytest.mark.parametrize("digits", [4, 12])
def test_four_cubics_within_the_tolerance_of_a_circle_are_one(read_svg: Reader, digits: int) -> None:
    drawing = read_svg(s.svg(s.path(kappa_circle(20, 30, 0.2, digits))))
    (edge,) = s.edges(drawing)
    assert isinstance(edge, Arc)
    assert edge.is_circle
    assert (edge.x, edge.y, edge.radius) == pytest.approx((20e-3, -30e-3, 0.2e-3), abs=10.0 ** -(digits + 3) + 1e-17)
    # The farthest the quarter gets from the circle is 2.7253e-4 of the radius (at t = 1/2 ± √3/6).
    t = 0.5 - math.sqrt(3.0) / 6.0
    k = 4.0 / 3.0 * math.tan(math.pi / 8.0)
    x = (1 - t) ** 3 + 3 * (1 - t) ** 2 * t + 3 * (1 - t) * t * t * k
    y = 3 * (1 - t) ** 2 * t * k + 3 * (1 - t) * t * t + t**3
    truth = (math.hypot(x, y) - 1.0) * 0.2e-3
    assert drawing.fitted_curves == 4
    assert truth * (1 - 1e-9) - 1e-4 * 10.0**-digits <= drawing.fitted_deviation <= 1.05 * truth + 1e-3 * 10.0**-digits


def test_four_cubics_farther_from_a_circle_are_followed_and_it_is_said(read_svg: Reader) -> None:
    drawing = read_svg(s.svg(s.path(kappa_circle(20, 30, 5.0))))
    (finding,) = [finding for finding in drawing.findings if finding.code == "near-circle"]
    assert (finding.x_mm, finding.y_mm) == pytest.approx((20.0, -30.0))
    assert "radius 5 mm" in finding.message
    assert len(s.edges(drawing)) > 8
    (edge,) = s.edges(read_svg(s.svg(s.path(kappa_circle(20, 30, 5.0))), fit=2e-6))
    assert isinstance(edge, Arc)


def test_an_ellipse_of_cubics_and_a_semicircle_are_no_circle(read_svg: Reader) -> None:
    ellipse = read_svg(s.svg(s.path(kappa_circle(20, 30, 0.2), 'transform="scale(1 1.1)"')))
    assert len(s.edges(ellipse)) > 4
    assert "near-circle" not in s.codes(ellipse)


@settings(max_examples=25)
@given(st.integers(3, 12), st.floats(0.5, 20.0))
def test_smooth_rows_of_cubics_share_their_arcs(count: int, size: float) -> None:
    """A wave cut into many pieces needs no more arcs than the whole, and they join tangentially."""
    from watchsim.drawing.svg import read_svg

    p = np.array([(0.0, 0.0), (1.0, 2.0), (2.0, -2.0), (3.0, 0.0)]) * size
    d = f"M{p[0][0]} {p[0][1]}"
    rest = p
    for k in range(count):
        t = 1.0 / (count - k)
        levels = [rest]
        while len(levels[-1]) > 1:
            levels.append(levels[-1][:-1] * (1 - t) + levels[-1][1:] * t)
        d += "C" + " ".join(f"{level[0][0]!r} {level[0][1]!r}" for level in levels[1:])
        rest = np.array([level[-1] for level in reversed(levels)])
    d = d.replace("np.float64(", "").replace(")", "")
    whole = "C" + " ".join(f"{x} {y}" for x, y in p[1:])
    one = read_svg(s.svg(s.path(f"M{p[0][0]} {p[0][1]}{whole}")).encode(), None, 1e-7)
    many = read_svg(s.svg(s.path(d)).encode(), None, 1e-7)
    assert many.fitted_curves == count
    assert len(many.strokes) <= len(one.strokes) * 1.3 + 2
    assert many.fitted_deviation <= 1e-7
    edges = [stroke.edge for stroke in many.strokes]
    for a, b in pairwise(edges):
        assert math.dist(a.tangent(1.0), b.tangent(0.0)) < 1e-5
    truth = svg_curve.points([("M", *p[0]), ("C", *p[1:].ravel())], 500)
    assert np.max(s.distances(truth, edges)) < 1.01e-4


@pytest.mark.parametrize("radii", [(1.0, 1e-13), (1e-13, 1.0)])
def test_radii_as_unlike_as_no_ellipse_is_are_refused(radii: tuple[float, float]) -> None:
    with pytest.raises(SvgError, match="radii as different"):
        elliptic_arc((0.0, 0.0), (1.0, 0.0), *radii, 0.0, False, True)
    assert isinstance(elliptic_arc((0.0, 0.0), (1.0, 0.0), 1.0, 1e-3, 0.0, False, True), Conic)


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6])
def test_half_a_circle_is_half_a_circle_however_far_it_lies_from_the_origin(far: float) -> None:
    """The rounding of its ends must not show as the square root of itself."""
    rng = np.random.default_rng(7)
    for x, y, radius in rng.uniform((-far, -far, 0.3), (far, far, 0.9), (50, 3)).tolist():
        shape = elliptic_arc((x, y), (x + 2.0 * radius, y), radius, radius, 0.0, False, True)
        assert isinstance(shape, Conic)
        assert abs(shape.sweep) == pytest.approx(math.pi, abs=1e-12)
        assert shape.centre[:2] == pytest.approx((x + radius, y), abs=1e-15 * max(1.0, far) * 2.0)


Place = tuple[float, float]
FLAGS = list(product((False, True), repeat=2))
P, Q = (0.3, -0.7), (2.5, 1.1)
CHORD = math.dist(P, Q)


def at(conic: Conic, share: float) -> np.ndarray:
    t = conic.start + share * conic.sweep
    return np.array(conic.centre[:2]) + math.cos(t) * np.array(conic.u[:2]) + math.sin(t) * np.array(conic.v[:2])


def arc(p: Place, q: Place, rx: float, ry: float, turn: float, large: bool, positive: bool) -> Conic:
    found = elliptic_arc(p, q, rx, ry, turn, large, positive)
    assert isinstance(found, Conic)
    return found


@pytest.mark.parametrize(("large", "positive"), FLAGS)
@pytest.mark.parametrize(("rx", "ry"), [(3.0, 3.0), (4.0, 2.0), (1.6, 5.0), (2.0, 1.9), (70.0, 30.0)])
@pytest.mark.parametrize("turn", [0.0, 0.4, -1.3, 2.9])
def test_it_runs_from_end_to_end_on_an_ellipse_of_those_radii(
    large: bool, positive: bool, rx: float, ry: float, turn: float
) -> None:
    for p, q in ((P, Q), (Q, P), ((0.0, 0.0), (0.0, 2.0)), ((5.0, 1.0), (3.0, 1.0))):
        found = arc(p, q, rx, ry, turn, large, positive)
        assert at(found, 0.0) == pytest.approx(np.array(p), abs=1e-12) and at(found, 1.0) == pytest.approx(
            np.array(q), abs=1e-12
        )
        assert (math.hypot(*found.u), math.hypot(*found.v)) == pytest.approx((rx, ry), rel=1e-14, abs=0.0)
        axis = turn if rx != ry else 0.0
        assert abs(found.u[0] * math.sin(axis) - found.u[1] * math.cos(axis)) < 1e-13 * rx
        assert abs(found.u[0] * found.v[0] + found.u[1] * found.v[1]) < 1e-12 * rx * ry
        assert found.sweep > 0.0 and (found.sweep > math.pi) is large
        assert (found.u[0] * found.v[1] - found.u[1] * found.v[0] > 0.0) is positive
        assert found.centre[2] == found.u[2] == found.v[2] == 0.0


@pytest.mark.parametrize(("large", "positive"), FLAGS)
@pytest.mark.parametrize("small", [1e-3, 1e-8, 1e-11, 1e-200])
def test_radii_that_are_too_small_grow_in_proportion_until_the_ends_are_opposite(
    large: bool, positive: bool, small: float
) -> None:
    for ratio, turn in ((1.0, 0.0), (2.0, 0.6), (0.3, -1.0)):
        found = arc(P, Q, small, small * ratio, turn, large, positive)
        assert math.hypot(*found.v) / math.hypot(*found.u) == pytest.approx(ratio, rel=1e-9)
        assert found.centre[:2] == pytest.approx(((P[0] + Q[0]) / 2, (P[1] + Q[1]) / 2), rel=1e-12)
        assert found.sweep == pytest.approx(math.pi, abs=1e-12)
        assert at(found, 0.0) == pytest.approx(np.array(P), abs=1e-11) and at(found, 1.0) == pytest.approx(
            np.array(Q), abs=1e-11
        )
        along = np.subtract(Q, P)
        side = at(found, 0.5) - np.array(found.centre[:2])
        # y points down: positive turns clockwise on the screen
        assert bool(along[0] * side[1] - along[1] * side[0] < 0.0) is positive


def test_arcs_without_a_radius_or_a_length_are_lines() -> None:
    for rx, ry in ((0.0, 3.0), (3.0, 0.0), (0.0, 0.0)):
        assert elliptic_arc(P, Q, rx, ry, 0.3, True, True) == Straight((*P, 0.0), (*Q, 0.0))
    assert isinstance(elliptic_arc(P, Q, 5e-4, 5e-4, 0.3, True, True), Conic)
    tiny = (0.0, 1e-320)
    assert elliptic_arc((0.0, 0.0), tiny, 1e10, 1e10, 0.0, False, True) == Straight((0.0, 0.0, 0.0), (*tiny, 0.0))


@pytest.mark.parametrize(("narrow", "drawn"), [(0.9e-9, False), (1.1e-9, True)])
def test_radii_of_too_unlike_size_are_refused(narrow: float, drawn: bool) -> None:
    for rx, ry in ((5.0, 5.0 * narrow), (5.0 * narrow, 5.0)):
        if drawn:
            arc((0.0, 0.0), (rx, ry), rx, ry, 0.0, False, True)
        else:
            with pytest.raises(SvgError, match="radii as different as"):
                elliptic_arc((0.0, 0.0), (1.0, 1.0), rx, ry, 0.0, False, True)


@pytest.mark.parametrize("far", [0.0, 1.0, 1e3, 1e6, -1e6])
def test_a_semicircle_keeps_its_centre_on_the_chord_wherever_it_lies(far: float) -> None:
    """Half a chord, rounded, is a little too long or too short for a radius; by its root the centre would be off."""
    for k in range(20):
        p, q = (far + 0.1 * k, 0.3), (far + 2.0 - 0.05 * k, 0.7 + 0.1 * k)
        half = 0.5 * math.dist(p, q)
        noise = math.ulp(1.0) * (1.0 + max(map(abs, (*p, *q))) / half)
        for radius in (half, math.nextafter(half, 9.0), half * (1.0 + 0.5 * noise)):
            found = arc(p, q, radius, radius, 0.0, False, True)
            middle = (0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))
            assert math.dist(found.centre[:2], middle) <= 2.0 * math.ulp(abs(far) + 4.0)
        wider = half * (1.0 + 20.0 * noise)
        off = math.sqrt((wider - half) * (wider + half))
        found = arc(p, q, wider, wider, 0.0, False, True)
        assert math.dist(found.centre[:2], middle) == pytest.approx(off, rel=0.2)


ROOT = Path(__file__).resolve().parents[2]
SVG, INKSCAPE = "{http://www.w3.org/2000/svg}", "{http://www.inkscape.org/namespaces/inkscape}"


def gauss(text: str) -> float:
    """mm² between all curves of all paths, y up, by plain arithmetic: circles by their radius, the rest sampled."""
    total = 0.0
    for element in ET.fromstring(text).iter():
        if element.tag == f"{SVG}circle" and element.get("fill") is None:
            total += math.pi * float(element.get("r", "")) ** 2
        elif element.tag == f"{SVG}path" and element.get("fill") != "none":
            for part in re.findall(r"M[^M]*", element.get("d", "")):
                words = re.findall(r"([MLAZ])([^MLAZ]*)", part)
                commands = [(letter, *map(float, numbers.split())) for letter, numbers in words]
                points = svg_curve.points(commands, 33).tolist()
                total -= 0.5 * sum(ax * by - bx * ay for (ax, ay), (bx, by) in pairwise([*points, points[0]]))
    return total


@given(parts())
def test_random_outlines_enclose_the_same_area(loops: tuple[Loop, ...]) -> None:
    assert gauss(svg_text(loops)) == pytest.approx(1e6 * section(loops).area, rel=3e-4)


def read_back(text: str, folder: Path) -> tuple[tuple[Loop, ...], tuple[Loop, ...]]:
    """Loops and open chains, in the coordinates from before: a drawing's origin is the corner of its page."""
    path = folder / "again.svg"
    path.write_text(text, encoding="utf-8")
    drawing = read(path)
    assert drawing.units == "mm" and drawing.units_from == "page"
    assert {finding.code for finding in drawing.findings} <= ({"open-outline"} if drawing.open_chains else set())
    left, top, *_ = map(float, ET.fromstring(text).get("viewBox", "").split())
    shift = (1e-3 * left, -1e-3 * top)
    loops, chains = ([loop.moved(0.0, shift) for loop in found] for found in (drawing.loops, drawing.open_chains))
    return tuple(loops), tuple(chains)


def quartered(loop: Loop, whole_discs: bool) -> Loop:
    """With arcs of at most a quarter turn, as they are written; circles may be elements of their own."""
    if whole_discs and not loop.hole and len(loop.edges) == 1:
        return loop
    edges: list[Edge] = []
    for edge in loop.edges:
        parts = math.ceil(abs(edge.sweep) / (math.pi / 2) - 1e-9) if isinstance(edge, Arc) else 1
        for k in range(parts) if parts > 1 and isinstance(edge, Arc) else ():
            start, sweep = edge.start_angle + k * edge.sweep / parts, edge.sweep / parts
            edges.append(Arc(edge.x, edge.y, edge.radius, start, sweep))
        edges += [edge] if parts <= 1 else []
    return Loop(tuple(edges), loop.layer, loop.closed, loop.hole)


def written_write_svg(loops: tuple[Loop, ...]) -> tuple[Loop, ...]:
    pierced = {loop.layer for loop in loops if loop.hole}
    return tuple(quartered(loop, loop.layer not in pierced) for loop in loops)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(parts())
def test_random_outlines_come_back_the_same(tmp_path: Path, loops: tuple[Loop, ...]) -> None:
    again, chains = read_back(svg_text(loops), tmp_path)
    compare(written_write_svg(loops), again)
    assert not chains


@pytest.mark.parametrize("name", ["escape_wheel", "lever", "roller", "banking"])
def test_real_outlines_come_back_the_same(name: str, tmp_path: Path) -> None:
    drawing = read(ROOT / "profiles" / "swiss_lever" / f"{name}.dxf")
    pivot: Point = (0.1e-3, 0.2e-3)
    again, _ = read_back(svg_text(drawing.loops, [("MARK", pivot)]), tmp_path)
    compare(written_write_svg(drawing.loops), tuple(loop for loop in again if loop.layer != "MARK"))
    (mark,) = [loop.edges[0] for loop in again if loop.layer == "MARK"]
    assert isinstance(mark, Arc) and (mark.x, mark.y) == pytest.approx(pivot, abs=1e-15)


def test_open_chains_stay_open(tmp_path: Path) -> None:
    chain = Loop((Line(0.0, 0.0, 1e-3, 0.0), Arc(1e-3, 1e-3, 1e-3, -math.pi / 2, 1.0)), "FACE", closed=False)
    _, (again,) = read_back(svg_text((chain,)), tmp_path)
    assert again.layer == "FACE" and all(same_edge(a, b, 1e-15) for a, b in zip(chain.edges, again.edges, strict=True))


def test_page_layers_and_arcs() -> None:
    half = Loop((Arc(0.0, 0.0, 2e-3, 0.0, math.pi), Line(-2e-3, 0.0, 2e-3, 0.0)), "HALF & HALF")
    disc = Loop((Arc(5e-3, 1e-3, 0.5e-3, 0.0, TURN),), "DISC")
    text = svg_text((half, disc), [("PIVOT", (1e-3, 2e-3))], {"DISC": "#c4234f"}, title="a < b & c")
    root = ET.fromstring(text)
    width, height = (float(root.get(name, "").removesuffix("mm")) for name in ("width", "height"))
    box = [float(value) for value in root.get("viewBox", "").split()]
    assert box[2:] == [width, height] and width == pytest.approx(7.5 + 0.75) and height == pytest.approx(2.0 + 0.75)
    assert root.findtext(f"{SVG}title") == "a < b & c"
    groups = {group.get(f"{INKSCAPE}label"): group for group in root.iter(f"{SVG}g")}
    assert list(groups) == ["HALF & HALF", "DISC", "PIVOT"]
    assert all(group.get(f"{INKSCAPE}groupmode") == "layer" for group in groups.values())
    (path,) = groups["HALF & HALF"]
    words = path.get("d", "").split()
    assert words.count("A") == 2 and words[-1] == "Z"
    top = [float(word) for word in words[words.index("A") + 6 : words.index("A") + 8]]
    assert top == pytest.approx([0.0, -2.0], abs=1e-12)  # y points down in SVG
    (circle,) = groups["DISC"]
    assert [float(circle.get(name, "")) for name in ("cx", "cy", "r")] == pytest.approx([5.0, -1.0, 0.5], rel=1e-15)
    (mark,) = groups["PIVOT"]
    assert [float(mark.get(name, "")) for name in ("cx", "cy")] == pytest.approx([1.0, -2.0], rel=1e-15)


def test_a_bore_shares_the_path_of_its_ring() -> None:
    ring = (Loop((Arc(0.0, 0.0, 2e-3, 0.0, TURN),), "R"), Loop((Arc(0.0, 0.0, 1e-3, 0.0, -TURN),), "R", hole=True))
    text = svg_text(ring)
    assert text.count("<path") == 1 and "<circle" not in text
    assert gauss(text) == pytest.approx(3.0 * math.pi, rel=1e-3)


def test_the_page_holds_the_drawing_and_little_more() -> None:
    """An outline far from the origin, y up in the drawing and down on the page."""
    points = [(3e-3, 7e-3), (9e-3, 7e-3), (9e-3, 9e-3), (3e-3, 9e-3)]
    text = svg_text([Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))])
    root = ET.fromstring(text)
    left, top, width, height = (float(word) for word in root.get("viewBox", "").split())
    assert left < 3.0 and 9.0 < left + width < 9.0 + 6.0 and left > 3.0 - 3.0
    assert top < -9.0 and -7.0 < top + height < -7.0 + 3.0 and top > -9.0 - 3.0
    assert (root.get("width"), root.get("height")) == (f"{width!r}mm", f"{height!r}mm")
