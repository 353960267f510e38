"""Do lines and arcs survive the way to trimesh and back?"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from made_outlines import parts
from same_outlines import compare
from trimesh.path import Path2D, entities

import watchsim as ws
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line

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
