"""Does a path draw what its definition says, however it is written?"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import svg_text as s
from hypothesis import given, settings
from hypothesis import strategies as st

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.projection import Conic, Shape, Spline, Straight
from watchsim.drawing.svg_elements import SvgError
from watchsim.drawing.svg_shapes import elliptic_arc, read_path
from watchsim.geometry.primitives import Arc, Line

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from naive import svg_curve

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
