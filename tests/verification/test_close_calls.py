"""By how little do the cases at the edge of contact differ from one another? Measured in their scenes; nothing is run."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from watchsim.geometry.primitives import Arc
from watchsim.scene.body import Body
from watchsim.verification.benchmarks import Benchmark
from watchsim.verification.edge_cases import corner, edge_cases, graze, standing
from watchsim.verification.hard_cases import friction_angle
from watchsim.verification.repeated_impacts import cradle


def radius(body: Body) -> float:
    (edge,) = body.loops[0].edges
    assert isinstance(edge, Arc)
    return edge.radius


def body(case: Benchmark, name: str) -> Body:
    return case.scene.body(name)


@pytest.mark.parametrize("nanometres", [1.0, 0.01, -0.003, -0.7])
def test_a_pin_would_pass_the_post_by_so_much(nanometres: float) -> None:
    pin, post = body(graze(nanometres), "pin"), body(graze(nanometres), "post")
    assert pin.position[1] - radius(pin) - radius(post) == pytest.approx(1e-9 * nanometres, rel=1e-3, abs=1e-18)
    assert pin.position[0] == -2e-3 and pin.velocity == (0.1, 0.0, 0.0)


@pytest.mark.parametrize("nanometres", [1.0, 0.01, -0.003, -0.7, 0.0])
def test_a_tooth_passes_the_corner_by_so_much(nanometres: float) -> None:
    """Its tip slides along the diagonal, the block's corner is the origin."""
    tooth = body(corner(nanometres), "tooth")
    x, y = tooth.position
    assert tooth.axis == pytest.approx((-math.sqrt(0.5), -math.sqrt(0.5)), rel=1e-12)
    assert (x - y) / math.sqrt(2.0) == pytest.approx(1e-9 * nanometres, rel=1e-4, abs=1e-18)
    assert (x + y) / 2.0 == pytest.approx(1e-3, rel=1e-12)


@pytest.mark.parametrize("split", [0.0, 1e-9, 3e-6])
def test_balls_of_a_cradle_lie_so_far_apart(split: float) -> None:
    """But for the first, which comes from a millimetre away."""
    balls = cradle(split).scene.bodies
    places = [ball.position[0] for ball in balls]
    gaps = [b - a - 2.0 * radius(balls[0]) for a, b in pairwise(places[1:])]
    assert gaps == pytest.approx([split] * 3, rel=1e-5, abs=1e-16)
    assert places[1] - places[0] == pytest.approx(0.011 + split, rel=1e-12)


def test_frictions_lie_a_millionth_above_and_below_the_limit() -> None:
    shares = [case.scene.contacts[0].friction / math.tan(0.3) - 1.0 for case in friction_angle()]
    assert shares == pytest.approx([1e-6, 0.0, -1e-6], abs=1e-12)


def test_gaps_from_a_nanometre_to_none_on_either_side() -> None:
    names = [case.name for case in edge_cases()]
    gaps = ["+1", "+0.1", "+0.01", "+0.001", "-0.001", "-0.01", "-0.1", "-1"]
    assert names[:8] == [f"graze, gap {gap} nm" for gap in gaps]
    assert names[8:17] == [f"tooth at a corner, {gap} nm aside" for gap in ("+0", *gaps)]
    assert names[17:] == [f"start at rest on {count} contacts" for count in range(1, 7)]


@pytest.mark.parametrize("count", range(1, 7))
def test_what_stands_on_each_other_touches(count: int) -> None:
    """Blocks two contacts each, and a disc beside them on the ground for what is left."""
    scene = standing(count).scene
    heights = {}
    for one in scene.bodies[:-1]:
        box = [point for edge in one.loops[0].edges for point in (edge.start, edge.end)]
        low = -radius(one) if isinstance(one.loops[0].edges[0], Arc) else min(y for _, y in box)
        heights[one.name] = one.position[1] + low, one.position[1] + max(y for _, y in box)
    assert len(heights) == (count + 1) // 2
    for contact in scene.contacts:
        upper, lower = (side.body for side in contact.sides)
        assert heights[upper][0] == pytest.approx(0.0 if lower == "ground" else heights[lower][1], abs=1e-15)
    disc = [one for one in scene.bodies if one.name == "disc"]
    assert len(disc) == count % 2 and all(one.position[0] - 0.02 > 0.05 for one in disc)
