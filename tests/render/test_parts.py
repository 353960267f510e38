"""Are outlines filled as drawn, holes left open, and colours those of a watch?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from render.fake_runs import MM, circle, polygon, watch_scene

from watchsim.mechanism.body import Body
from watchsim.mechanism.scene import Scene
from watchsim.render.palette import BLUED, BRASS, GILT, NIGHT, PLATE, RUBY, STEEL, body_finish, finish
from watchsim.render.parts import hatching, is_round, parts, signed_area


def shapes(*loops, motion="pivot", decoration=()):
    return parts(Scene("", (Body("wheel", motion, loops=loops, decoration=decoration),)), 1e-8, 1e-3)


def test_arcs_are_as_round_as_asked():
    (part,) = shapes(circle(0, 0, 2, "A"))
    radii = np.hypot(*part.faces.vertices.T)
    middles = np.hypot(*(0.5 * (part.faces.vertices[1:] + part.faces.vertices[:-1])).T)
    assert radii == pytest.approx(2 * MM, abs=1e-12)
    assert 2 * MM - middles.min() <= 1e-8


def test_a_hole_is_empty_even_on_a_layer_of_its_own_or_wrongly_oriented():
    wrong = circle(0, 0, 1, "BORE", hole=True)
    for hole in (circle(0, 0, 1, "A", hole=True), wrong, type(wrong)(wrong.reversed().edges, "BORE", True, True)):
        (part,) = shapes(circle(0, 0, 2, "A"), hole)
        assert part.area == pytest.approx(math.pi * 4 * MM**2, rel=1e-4)
        total = sum(signed_area(ring) for ring in part.faces.to_polygons(closed_only=True))
        assert total == pytest.approx(math.pi * 3 * MM**2, rel=1e-4)


def test_a_hole_goes_to_the_smallest_outline_around_it():
    found = shapes(circle(0, 0, 5, "BIG"), circle(0, 0, 2, "SMALL"), circle(0, 0, 1, "BORE", hole=True))
    rings = [len(part.faces.to_polygons()) for part in found]
    assert rings == [1, 2]


def test_small_parts_lie_on_top_and_decoration_is_drawn():
    found = shapes(circle(0, 0, 1, "A"), circle(0, 0, 0.2, "C"), decoration=(circle(0, 0, 3, "B"),))
    assert [part.area for part in found] == sorted((part.area for part in found), reverse=True)
    assert len(found) == 3


def test_open_outlines_are_ground_hatched_on_the_left():
    (part,) = shapes(polygon([(10, 0), (0, 0)], "line", closed=False), motion="fixed")
    assert part.ground
    assert part.strokes.vertices[:, 1].max() <= 1e-15  # travelling towards -x the left is below
    assert part.strokes.vertices[:, 1].min() < -0.5e-3
    assert len(hatching(np.array([[0.0, 0.0], [1.0, 0.0]]), 0.1).vertices) == 20


def test_only_circles_about_the_origin_hide_their_turning():
    assert is_round(Body("disc", loops=(circle(0, 0, 5, "A"),)))
    assert not is_round(Body("disc", loops=(circle(0, 1, 5, "A"),)))
    assert not is_round(Body("disc", loops=(polygon([(0, 0), (1, 0), (0, 1)], "A"),)))
    assert not is_round(Body("disc"))


def test_watch_colours():
    scene = watch_scene()
    wheel, lever, balance, banking = scene.bodies
    assert finish(wheel, "TEETH") is BRASS
    assert finish(lever, "STONES") is RUBY and finish(lever, "ARMS") is STEEL and finish(lever, "FORK") is STEEL
    assert finish(Body("pallet_fork"), "0") is STEEL and finish(Body("lever"), "PALLET_FORK") is STEEL
    assert finish(balance, "ROLLER") is BLUED and finish(balance, "PIN") is RUBY and finish(balance, "SAFETY") is NIGHT
    assert finish(banking, "PINS") is GILT
    assert finish(Body("balance_wheel"), "0") is BLUED and finish(Body("escape_wheel"), "0") is BRASS
    assert finish(Body("plane", "fixed"), "0") is PLATE
    assert finish(Body("a"), "0", 0) is not finish(Body("b"), "0", 1)
    assert body_finish(Body("balance", loops=(circle(0, 0, 1, "PIN"),))) is RUBY
    assert body_finish(balance) is BLUED
