"""Are outlines filled as drawn, holes left open, and colours those of a watch?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from render.fake_runs import MM, circle, polygon, watch_scene

from watchsim.render.palette import BLUED, BRASS, FIXED, NIGHT, OTHERS, RUBY, STEEL, finish, looks
from watchsim.render.parts import hatching, is_round, parts, signed_area
from watchsim.scene.scene import Body, Scene


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


def test_a_layer_named_for_bores_empties_the_wheel_and_a_pivot_is_not_drawn():
    (part,) = shapes(circle(0, 0, 2, "TEETH"), decoration=(circle(0, 0, 1, "Wheel bore"), circle(0, 0, 0.5, "PIVOT")))
    total = sum(signed_area(ring) for ring in part.faces.to_polygons(closed_only=True))
    assert total == pytest.approx(math.pi * 3 * MM**2, rel=1e-4)


def test_a_hole_goes_to_the_smallest_outline_around_it():
    found = shapes(circle(0, 0, 5, "BIG"), circle(0, 0, 2, "SMALL"), circle(0, 0, 1, "BORE", hole=True))
    rings = [len(part.faces.to_polygons()) for part in found]
    assert rings == [1, 2]


def test_a_slot_on_the_border_is_empty_and_what_fills_a_hole_is_not():
    plate, slot = polygon([(0, 0), (4, 0), (4, 2), (0, 2)], "A"), polygon([(1, 0), (2, 0), (2, 1), (1, 1)], "SLOT")
    (part,) = shapes(plate, decoration=(type(slot)(slot.reversed().edges, "SLOT", True, True),))
    assert not part.ground and len(part.faces.to_polygons()) == 2
    found = shapes(circle(0, 0, 2, "A"), circle(0, 0, 1, "A", hole=True), circle(0, 0, 1, "STONE"))
    assert [len(part.faces.to_polygons()) for part in found] == [2, 1]


def test_small_parts_lie_on_top_and_decoration_is_drawn():
    found = shapes(circle(0, 0, 1, "A"), circle(0, 0, 0.2, "C"), decoration=(circle(0, 0, 3, "B"),))
    assert [part.area for part in found] == sorted((part.area for part in found), reverse=True)
    assert len(found) == 3


def test_what_can_touch_lies_on_the_same_shape_of_another_section() -> None:
    one, again = circle(0, 0, 1, "PALLET"), circle(1e-9, 0, 1.00000001, "SECTION")
    for loops, decoration in (((one,), (again,)), ((again,), (one,))):
        body = Body("lever", loops=loops, decoration=decoration)
        assert [part.layer for part in parts(Scene("t", (body,)), 1e-6, 1e-3)] == [decoration[0].layer, loops[0].layer]


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
    _, lever, balance, _ = scene.bodies
    worn = looks(scene)
    assert worn == {"wheel": BRASS, "lever": STEEL, "balance": BLUED, "banking": FIXED}
    assert finish(lever, "STONES", STEEL) is RUBY and finish(lever, "ARMS", STEEL) is STEEL
    assert finish(lever, "PALLET_FORK", STEEL) is STEEL
    assert finish(balance, "ROLLER", BLUED) is BLUED and finish(balance, "PIN", BLUED) is RUBY
    assert finish(balance, "SAFETY", BLUED) is NIGHT
    for name, look in {"pallet_fork": STEEL, "balance_wheel": BLUED, "escape_wheel": BRASS}.items():
        assert looks(Scene("", (Body(name),))) == {name: look}
    assert looks(Scene("", (Body("plane", "fixed"),))) == {"plane": FIXED}
    assert looks(Scene("", (Body("balance", loops=(circle(0, 0, 1, "PIN"),)),))) == {"balance": RUBY}


def test_what_is_only_drawn_is_pale_and_no_stone_because_of_others() -> None:
    drawn = (circle(0, 0, 9, "BOB"), circle(0, 0, 3, "ROD"), circle(0, 5, 1, "JEWELS"), circle(0, 0, 2, "PALLETS"))
    pendulum = Body("pendulum", loops=(circle(0, 1, 1, "PALLETS"),), decoration=drawn)
    look = looks(Scene("", (pendulum,)))["pendulum"]
    assert look is RUBY and finish(pendulum, "PALLETS", look) is RUBY
    fills = {layer: finish(pendulum, layer, look) for layer in ("BOB", "ROD", "JEWELS")}
    assert all(one.pale for one in fills.values())
    assert [one.fill for one in fills.values()] == [BRASS.fill, STEEL.fill, RUBY.fill]


def test_no_two_moving_bodies_look_alike():
    """Words come first: a carriage named before the lever leaves it its steel."""
    names = ("carriage", "wheel", "lever", "balance", "click", "third_wheel", "cam")
    worn = looks(Scene("", tuple(Body(name) for name in names)))
    assert worn["lever"] is STEEL and worn["wheel"] is BRASS and worn["balance"] is BLUED
    assert len(set(worn.values())) == len({look.line for look in worn.values()}) == len(names)
    many = tuple(Body(f"part {k}") for k in range(20))
    assert set(looks(Scene("", many)).values()) == set(OTHERS)
