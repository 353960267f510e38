"""Is the geometry of function of an anchor that swings with its pendulum the one it was constructed with?

Lift, lock, drop and the lean of the locking faces are dimensions of the design. How far the wheel is driven back is
found once more with polygons, which share nothing with the gap functions.
"""

from __future__ import annotations

import math

import pytest
import shapely
from escapement.made import mirrored_scene, turned_scene
from every_time import few
from shapely import affinity

from watchsim import designs
from watchsim.escapement.function_report import text
from watchsim.escapement.measure import Function, measure
from watchsim.geometry.polyline import polyline
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.scene.scene import Scene

DRAWN = {
    "dead-beat": ("graham", {}),
    "wide": ("graham", {"embraced": 10.5, "lift": "1.6°", "lock": "0.7°", "drop": "1°"}),
    "20 teeth": ("graham", {"teeth": 20, "embraced": 5.5, "tip_width": "0.4°", "lift": "3°"}),
    "recoil": ("recoil_anchor", {}),
    "little recoil": ("recoil_anchor", {"recoil": "8°", "lock": "0.6°"}),
}
CLOSE = 1e-6  # degrees


def drawn(name: str) -> tuple[Scene, object]:
    design, dimensions = DRAWN[name]
    made = getattr(designs, design)(**dimensions)
    return made.scene(), made.values


def outline(scene: Scene, body: str, layer: str, scale: float) -> shapely.Geometry:
    loops = [one for one in scene.body(body).loops if one.layer == layer]
    return shapely.union_all([shapely.Polygon(polyline(one, 1e-10) * scale) for one in loops])


def stops_at(scene: Scene, pendulum: float, free: float) -> float:
    """The wheel's angle (°) against the anchor, turned clockwise from `free`, by bisection with polygons."""
    pallets = outline(scene, "pendulum", "PALLETS", 1.0)
    teeth = outline(scene, "wheel", "TEETH", 1.0)
    anchor = affinity.translate(affinity.rotate(pallets, pendulum, origin=(0, 0)), *scene.body("pendulum").position)

    def clear(angle: float) -> bool:
        return affinity.rotate(teeth, angle, origin=(0, 0)).disjoint(anchor)

    step = 0.02
    while clear(free - step):
        free -= step
    low, high = free - step, free
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if clear(middle) else (middle, high)
    return high


def check(function: Function, values: object) -> None:
    assert function.pallets is not None and function.banks is None and function.swung is not None
    for one in function.pallets:
        assert math.degrees(one.lift.value) == pytest.approx(values.lift, abs=CLOSE)
        assert math.degrees(one.lock.value) == pytest.approx(values.lock, abs=CLOSE)
        assert math.degrees(one.draw_end.value) == pytest.approx(-getattr(values, "recoil", 0.0), abs=1e-4)
        assert math.isnan(one.total_lock.value) and math.isnan(one.run.value)
    released = 0.5 * (values.lift + values.lock)
    assert [math.degrees(end) for end in function.swung] == pytest.approx([2.0 * released, -2.0 * released], abs=CLOSE)


@pytest.mark.parametrize("name", few(DRAWN, 2))
def test_anchor_has_the_lift_and_lock_it_was_drawn_with(name):
    scene, values = drawn(name)
    check(measure(scene), values)


@pytest.mark.parametrize("name", few(["dead-beat", "wide", "20 teeth"], 1))
def test_dead_beat_anchor_drops_as_drawn_and_drives_nothing_back(name):
    """The dimension counts the drop from the heel of the tooth, the measure the whole free way of the wheel."""
    scene, values = drawn(name)
    for one in measure(scene).pallets:
        assert math.degrees(one.drop.value) == pytest.approx(values.drop + values.tip_width, abs=CLOSE)
        assert abs(math.degrees(one.recoil.value)) < CLOSE


@pytest.mark.parametrize("name", few(["recoil", "little recoil"], 1))
def test_recoil_is_what_polygons_say(name):
    scene, values = drawn(name)
    function = measure(scene)
    released, swung = 0.5 * (values.lift + values.lock), math.degrees(function.swung[0])
    for k, side in enumerate(function.sides):
        start = math.degrees(function.passages[k].start.wheel)
        free = start + 1.0  # turned back a little: still clear of the tooth before
        back = stops_at(scene, side * swung, free) - stops_at(scene, side * released, free)
        assert back > 0.05
        assert math.degrees(function.pallets[k].recoil.value) == pytest.approx(back, abs=2e-4)


def test_it_is_the_same_turned_and_seen_from_behind():
    scene, values = drawn("recoil")
    for other in (mirrored_scene(scene), turned_scene(scene, 0.0, (0.1, -0.2))):
        check(measure(other), values)


def test_started_on_the_other_pallet():
    scene, values = drawn("dead-beat")
    check(measure(scene.set("bodies.pendulum.angle", "-2°").set("bodies.wheel.angle", "-0.825°")), values)


def test_a_detent_is_told_what_is_measured():
    function = measure(load(profiles_dir() / "detent"))
    assert function.pallets is None
    (line,) = text(function)
    assert "detent is stopped on one side only" in line and "anchors that swing with the oscillator" in line
