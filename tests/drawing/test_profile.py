"""Do lines and arcs survive the way to trimesh and back?"""

import cmath
import math
import random
import tempfile
from pathlib import Path

import dxf_text as d
import numpy as np
import pytest
import svg_text as s
from hypothesis import given
from hypothesis import strategies as st
from made_outlines import compare, parts
from trimesh.path import Path2D, entities

import watchsim as ws
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.geometry.solids import section

ROOT = Path(__file__).resolve().parents[2]


def test_its_short_form_names_what_it_holds() -> None:
    half = Loop((Line(0, 0, 1, 0), Line(1, 0, 1, 1), Line(1, 1, 0, 0)), "RIM")
    assert repr(ws.Profile()) == "<Profile: 0 closed outlines, 0 open chains on no layer>"
    assert repr(ws.Profile((half,))) == "<Profile: 1 closed outlines, 0 open chains on RIM>"


@given(parts())
def test_random_outlines_come_back(loops: tuple[Loop, ...]) -> None:
    """Centres come from three points: a flat arc has its ends to 1e-12, its centre as well as they fix it."""
    again = ws.Profile.from_path2d(ws.Profile(loops).to_path2d())
    one, other = ws.Profile(loops).section(), again.section().about(ws.Profile(loops).section().origin)
    assert (other.area, other.polar) == pytest.approx((one.area, one.polar), rel=1e-12, abs=0.0)
    bent = [loop for loop in loops if any(isinstance(edge, Arc) and abs(edge.sweep) < 0.1 for edge in loop.edges)]
    if not bent:
        compare(loops, again.loops)


def length(entity: entities.Entity, vertices: np.ndarray) -> float:
    """Of a chain of lines, or of an arc from its three points by the inscribed angle; trimesh's own is wrong before 5.2."""
    points = vertices[entity.points]
    if isinstance(entity, entities.Line):
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    first, middle, last = points
    (ax, ay), (bx, by) = first - middle, last - middle
    inscribed = abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
    radius = math.dist(first, last) / (2.0 * math.sin(inscribed))
    return radius * (math.tau if entity.closed else math.tau - 2.0 * inscribed)


def test_real_wheel_keeps_its_entities_and_layers() -> None:
    profile = ws.read(ROOT / "profiles/swiss_lever/escape_wheel.dxf").profile
    path = profile.to_path2d()
    assert path.units == "mm"
    kinds = [type(entity).__name__ for entity in path.entities]
    assert (kinds.count("Line"), kinds.count("Arc")) == (53, 70)
    assert {entity.layer for entity in path.entities} == {"TEETH"}
    closed = [entity for entity in path.entities if entity.closed]
    bore = next(loop for loop in profile.loops if len(loop.edges) == 1)
    assert len(closed) == 1 and length(closed[0], path.vertices) == pytest.approx(1e3 * bore.length, rel=1e-12)
    compare(profile.loops, ws.Profile.from_path2d(path).loops)
    whole = sum(length(entity, path.vertices) for entity in path.entities)
    assert whole == pytest.approx(1e3 * sum(loop.length for loop in profile.loops), rel=1e-9)


def test_edges_share_vertices_so_that_trimesh_sees_them_closed() -> None:
    path = ws.read(ROOT / "profiles/swiss_lever/escape_wheel.dxf").profile.to_path2d()
    ends = [node for entity in path.entities if not entity.closed for node in (entity.points[0], entity.points[-1])]
    assert all(ends.count(node) == 2 for node in ends)


def test_arcs_of_trimesh_in_both_directions_and_inches() -> None:
    vertices = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
    path = Path2D(entities=[entities.Arc([0, 1, 2]), entities.Line([2, 3, 0])], vertices=vertices, process=False)
    path.units = "inches"
    (loop,) = ws.Profile.from_path2d(path).loops
    assert ws.Profile((loop,)).section().area == pytest.approx(25.4e-3**2 * (math.pi / 2 + 1.0), rel=1e-12, abs=0.0)
    (arc,) = (edge for edge in loop.edges if isinstance(edge, Arc))
    assert (arc.x, arc.y, arc.radius) == pytest.approx((0.0, 0.0, 25.4e-3), abs=1e-17)
    backward = Path2D(entities=[entities.Arc([2, 1, 0])], vertices=vertices, process=False)
    (chain,) = ws.Profile.from_path2d(backward, units="mm").chains
    assert chain.edges[0].sweep == pytest.approx(-math.pi)


def test_more_than_a_half_turn() -> None:
    arc = Arc(1e-3, 2e-3, 3e-3, 0.4, 5.9)
    (chain,) = ws.Profile.from_path2d(ws.Profile(chains=(Loop((arc,), closed=False),)).to_path2d()).chains
    found = chain.edges[0]
    assert isinstance(found, Arc)
    assert (found.x, found.y, found.radius, found.sweep) == pytest.approx((1e-3, 2e-3, 3e-3, 5.9), rel=1e-12, abs=0.0)


def test_mass_of_a_profile_and_of_one_layer() -> None:
    disc, ring = Loop((Arc(0.0, 0.0, 1e-3, 0.0, TURN),), "A"), Loop((Arc(5e-3, 0.0, 2e-3, 0.0, TURN),), "B")
    profile = ws.Profile((disc, ring))
    assert profile.layers == ("A", "B") and profile.only("B").loops == (ring,)
    assert profile.only("A").mass_properties(1e-3, 8e3).mass == pytest.approx(math.pi * 8e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("entity", "units", "message"),
    [
        (entities.Bezier([0, 1, 2, 3]), "mm", "is a Bezier: only lines and arcs"),
        (entities.Arc([0, 1, 4]), "mm", "in a straight line"),
        (entities.Line([0, 1]), None, "does not say its units"),
        (entities.Line([0, 1]), "kg", "not a unit of length"),
        (entities.Line([0, 1]), "furlong", "not a unit known here"),
    ],
)
def test_what_is_no_outline_is_refused(entity: entities.Entity, units: str | None, message: str) -> None:
    vertices = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (2.0, 0.0)])
    path = Path2D(entities=[entity], vertices=vertices, process=False)
    with pytest.raises(ValueError, match=message):
        ws.Profile.from_path2d(path, units=units)


def test_three_edges_in_one_point_are_refused() -> None:
    star = tuple(Loop((Line(0.0, 0.0, *end),), closed=False) for end in ((1e-3, 0.0), (0.0, 1e-3), (-1e-3, 0.0)))
    with pytest.raises(ValueError, match="3 edges meet"):
        ws.Profile.from_path2d(ws.Profile(chains=star).to_path2d())


def test_an_arc_of_a_path_is_the_circle_through_its_points() -> None:
    """Any arc, far from the origin, either way round, also more than half a turn: against centre and radius as given."""
    from watchsim.geometry.meshes import edges_of, path2d

    rng = np.random.default_rng(5)
    for _ in range(50):
        x, y, radius = 1e-3 * rng.normal(3.0, 5.0), 1e-3 * rng.normal(-4.0, 5.0), 1e-3 * rng.uniform(0.1, 4.0)
        arc = Arc(x, y, radius, rng.uniform(-3.0, 3.0), rng.choice((-1.0, 1.0)) * rng.uniform(0.2, 6.0))
        ((_, (again,)),) = edges_of(path2d([Loop((arc,), "A", closed=False)]), 1e-3)
        assert isinstance(again, Arc)
        assert (again.x, again.y, again.radius) == pytest.approx((x, y, radius), abs=1e-12)
        assert again.sweep == pytest.approx(arc.sweep, abs=1e-9)
        assert np.allclose(again.point(0.3), arc.point(0.3), atol=1e-12)


SAME = 1e-12

Corner = tuple[complex, float]  # a place (mm) and the bulge of the edge that leaves it


@st.composite
def outlines(draw: st.DrawFn) -> list[Corner]:
    """A star of lines and arcs about the origin; arcs stay within their sector, so nothing crosses."""
    count = draw(st.integers(3, 14))
    corners = [cmath.rect(draw(st.floats(1.0, 3.0)), math.tau * k / count) for k in range(count)]
    bulges = [draw(st.sampled_from((0.0, 0.0, 0.05, -0.04, 0.08))) for _ in range(count)]
    return list(zip(corners, bulges, strict=True))


@st.composite
def holes(draw: st.DrawFn) -> list[Corner]:
    """A slot or triangle well inside."""
    size = draw(st.floats(0.02, 0.15))
    if draw(st.booleans()):
        return [
            (complex(-size, -size / 4), 0.0),
            (complex(size, -size / 4), 1.0),
            (complex(size, size / 4), 0.0),
            (complex(-size, size / 4), 1.0),
        ]
    return [(size * cmath.exp(2j * math.pi * k / 3), 0.0) for k in range(3)]


def as_polyline(corners: list[Corner]) -> str:
    return d.lwpolyline([(z.real, z.imag, bulge) for z, bulge in corners], True)


def as_entities(corners: list[Corner], rng: random.Random) -> str:
    """Single lines and arcs in any order and direction."""
    pieces = []
    for (a, bulge), (b, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if bulge == 0.0:
            p, q = (a, b) if rng.random() < 0.5 else (b, a)
            pieces.append(d.line((p.real, p.imag), (q.real, q.imag)))
        else:
            centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge * bulge) / (4 * bulge)
            first, last = (a, b) if bulge > 0.0 else (b, a)
            angles = [math.degrees(cmath.phase(p - centre)) for p in (first, last)]
            pieces.append(d.arc(centre.real, centre.imag, abs(a - centre), *angles))
    rng.shuffle(pieces)
    return "".join(pieces)


def read_text(entities: str) -> Drawing:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "outline.dxf"
        path.write_bytes(d.dxf(entities))
        return read(path)


def facts(drawing: Drawing) -> tuple[float, float, complex]:
    """Area (mm²), polar moment about the centroid (mm⁴), centroid (mm), after a look at the loops."""
    assert not [finding for finding in drawing.findings if finding.code != "facets"]
    outer, inner = sorted(drawing.loops, key=lambda loop: loop.hole)
    assert not outer.hole and inner.hole and not drawing.open_chains
    total = section(drawing.loops)
    x, y = total.centroid
    return 1e6 * total.area, 1e12 * total.about((x, y)).polar, complex(1e3 * x, 1e3 * y)


def kinds(drawing: Drawing) -> list[list[str]]:
    return sorted(sorted(type(edge).__name__ for edge in loop.edges) for loop in drawing.loops)


@given(outlines(), holes(), st.randoms(use_true_random=False), st.floats(-3.2, 3.2), st.floats(0.1, 20.0), st.booleans())
def test_the_same_outline_however_it_is_written_turned_mirrored_and_scaled(
    outer: list[Corner], inner: list[Corner], rng: random.Random, angle: float, scale: float, mirrored: bool
) -> None:
    plain = read_text(as_polyline(outer) + as_polyline(inner))
    area, polar, centroid = facts(plain)
    backward = [(outer[k][0], -outer[k - 1][1]) for k in range(len(outer) - 1, -1, -1)]
    factor, shift = scale * cmath.exp(1j * angle), complex(3.0, -2.0)

    def moved(corners: list[Corner]) -> list[Corner]:
        """In Python's complex numbers, without the package."""
        if mirrored:
            return [(factor * z.conjugate() + shift, -bulge) for z, bulge in corners]
        return [(factor * z + shift, bulge) for z, bulge in corners]

    centre = factor * (centroid.conjugate() if mirrored else centroid) + shift
    versions = {
        "backward": (as_polyline(backward) + as_polyline(inner), 1.0, centroid),
        "single": (as_entities(outer, rng) + as_entities(inner, rng), 1.0, centroid),
        "moved": (as_polyline(moved(outer)) + as_polyline(moved(inner)), scale, centre),
    }
    for name, (text, by, where) in versions.items():
        drawing = read_text(text)
        found_area, found_polar, found_centroid = facts(drawing)
        assert kinds(drawing) == kinds(plain), name
        assert found_area == pytest.approx(by**2 * area, rel=SAME, abs=0), name
        assert found_polar == pytest.approx(by**4 * polar, rel=SAME, abs=0), name
        assert abs(found_centroid - where) <= SAME * (abs(where) + 3.0 * by), name


@given(outlines(), holes(), st.floats(-180.0, 180.0), st.booleans())
def test_a_block_turned_and_mirrored_by_its_insert_is_the_same(
    outer: list[Corner], inner: list[Corner], degrees: float, mirrored: bool
) -> None:
    text = as_polyline(outer) + as_polyline(inner)
    area, polar, _ = facts(read_text(text))
    placed = d.insert("PART", (5.0, -7.0), (41, -1.5 if mirrored else 1.5), (42, 1.5), (50, degrees))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "block.dxf"
        path.write_bytes(d.dxf(placed, blocks=d.block("PART", text, base=(0.3, 0.4))))
        found_area, found_polar, _ = facts(read(path))
    assert found_area == pytest.approx(1.5**2 * area, rel=SAME, abs=0)
    assert found_polar == pytest.approx(1.5**4 * polar, rel=SAME, abs=0)


def as_path(corners: list[Corner]) -> str:
    """SVG counts y downwards, so that a turn to the left is one to the right there."""
    words = [f"M {corners[0][0].real!r} {-corners[0][0].imag!r}"]
    for (a, bulge), (b, _) in zip(corners, [*corners[1:], corners[0]], strict=True):
        radius = abs(b - a) * (1 + bulge * bulge) / (4 * abs(bulge)) if bulge else 0.0
        arc = f"A {radius!r} {radius!r} 0 0 {int(bulge < 0.0)}" if bulge else "L"
        words.append(f"{arc} {b.real!r} {-b.imag!r}")
    return " ".join([*words, "Z"])


@given(outlines(), st.floats(-180.0, 180.0), st.floats(0.1, 20.0), st.booleans())
def test_an_svg_path_turned_mirrored_and_scaled_by_its_transform_is_the_same(
    outer: list[Corner], degrees: float, scale: float, mirrored: bool
) -> None:
    inner: list[Corner] = [
        (complex(-0.1, -0.02), 0.0),
        (complex(0.1, -0.02), 0.9),
        (complex(0.1, 0.02), 0.0),
        (-0.1 + 0.02j, 0.9),
    ]
    area, polar, centroid = facts(read_text(as_polyline(outer) + as_polyline(inner)))
    placed = f"translate(3 2) rotate({degrees!r}) scale({scale!r} {-scale if mirrored else scale!r})"
    page = 'width="100mm" height="100mm" viewBox="0 0 100 100"'
    text = s.svg(f'<g transform="{placed}"><path d="{as_path(outer)} {as_path(inner)}"/></g>', page)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "outline.svg"
        path.write_text(text)
        found_area, found_polar, found_centroid = facts(read(path))
    turned = scale * cmath.exp(-1j * math.radians(degrees)) * (centroid.conjugate() if mirrored else centroid)
    assert found_area == pytest.approx(scale**2 * area, rel=SAME, abs=0)
    assert found_polar == pytest.approx(scale**4 * polar, rel=SAME, abs=0)
    where = turned + complex(3.0, -2.0)
    assert abs(found_centroid - where) <= SAME * (abs(where) + 3.0 * scale)


@given(outlines())
def test_area_and_moment_agree_with_a_fine_polygon(outer: list[Corner]) -> None:
    """Chords of the arcs, in complex numbers: the error falls with the square of their number."""
    (loop,) = read_text(as_polyline(outer)).loops
    assert isinstance(loop, Loop) and {type(edge) for edge in loop.edges} <= {Line, Arc}
    points: list[complex] = []
    for (a, bulge), (b, _) in zip(outer, [*outer[1:], outer[0]], strict=True):
        points.append(a)
        if bulge:
            centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge * bulge) / (4 * bulge)
            sweep = 4 * math.atan(bulge)
            points += [centre + (a - centre) * cmath.exp(1j * sweep * k / 200) for k in range(1, 200)]
    following = [*points[1:], points[0]]
    crosses = [(p.conjugate() * q).imag for p, q in zip(points, following, strict=True)]
    squares = [abs(p) ** 2 + abs(q) ** 2 + (p.conjugate() * q).real for p, q in zip(points, following, strict=True)]
    total = section([loop]).about((0.0, 0.0))
    assert 1e6 * total.area == pytest.approx(sum(crosses) / 2, rel=1e-5)
    assert 1e12 * total.polar == pytest.approx(sum(c * s for c, s in zip(crosses, squares, strict=True)) / 12, rel=1e-5)
