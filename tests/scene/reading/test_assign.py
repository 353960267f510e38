"""Which value of a scene's mapping does a dotted path change, and what is said of a path that means none?"""

from __future__ import annotations

import copy
from typing import Any

import pytest

from watchsim.scene.assign import assign, with_unit
from watchsim.scene.errors import Faults
from watchsim.scene.keys import key_at, siblings
from watchsim.units import ANGLE, NUMBER, TORQUE

TRAIN = [{"ratio": 7}, {"ratio": 8, "inertia": "9 g·cm²"}]
MAPPING: dict[str, Any] = {
    "scene": {"title": "old"},
    "bodies": {
        "wheel": {
            "solids": [{"layer": "A"}, {"layer": "B", "turned": [["1 mm", "2 mm"], ["3 mm", "4 mm"]]}],
            "adjust": {"STONES": {"turn": "1°"}, "PINS": [{"turn": "2°"}, {"turn": "3°", "shift": ["5 µm", "6 µm"]}]},
            "polygon": [["1 mm", "2 mm"], ["3 mm", "4 mm"], ["5 mm", "7 mm"]],
        },
        "rack": {"motion": "slide", "axis": [1, 0]},
        "cam": {"motion": "driven", "axis": [1, 0], "swing": {"amplitude": "1 mm"}},
        "arm": {"motion": "driven", "swing": {"amplitude": "1°"}},
        "stone": {"motion": "free"},
    },
    "springs": [
        {"body": "wheel", "frequency": "3 Hz", "rest": "2°"},
        {"body": "rack", "stiffness": "3 N/m", "draw": 5},
        {"body": "wheel", "leaf": {"arm": "2 mm"}},
    ],
    "torques": [
        {"body": "wheel", "over": "barrel", "table": [1], "ratio": 8, "train": TRAIN},
        {"body": "rack", "value": "1 N"},
    ],
    "damping": [{"body": "wheel", "q_factor": 200}],
    "line_springs": [{"between": ["wheel"]}],
    "expect": {"rate": {"value": 5}},
    "lock": {"versions": "1"},
}


def set_to(key: str, value: object) -> tuple[dict[str, Any], list[str]]:
    mapping, faults = copy.deepcopy(MAPPING), Faults()
    assign(mapping, key, value, faults)
    assert {fault.key for fault in faults.found} <= {key}
    assert mapping == MAPPING or not faults.found or "setdefault" in key or "adjust" in key
    return mapping, [fault.message for fault in faults.found]


def at(mapping: Any, path: str) -> Any:
    for step in path.split("."):
        mapping = mapping[int(step) if isinstance(mapping, list) else step]
    return mapping


SET = [  # path, value, what stands there then
    ("scene.title", "new", "new"),
    ("scene.nu", 0.25, 0.25),
    ("scene.gravity.1", -9.5, "-9.5 m/s²"),
    ("run.duration", 3, "3.0 s"),
    ("timegrapher.lift_angle", 0.75, "0.75 rad"),
    ("bodies.wheel.angle", 0.25, "0.25 rad"),
    ("bodies.wheel.velocity", 0.25, "0.25 rad/s"),
    ("bodies.rack.velocity", 0.25, "0.25 m/s"),
    ("bodies.stone.velocity.1", 0.25, "0.25 m/s"),
    ("bodies.cam.swing.amplitude", 0.25, "0.25 m"),
    ("bodies.arm.swing.amplitude", 0.25, "0.25 rad"),
    ("bodies.cam.velocity", 0.25, "0.25 m/s"),
    ("bodies.arm.velocity", 0.25, "0.25 rad/s"),
    ("bodies.wheel.solids.1.density", 8000, "8000.0 kg/m³"),
    ("bodies.wheel.solids.0.layer", "C", "C"),
    ("bodies.wheel.solids.1.turned.1.0", 0.25, "0.25 m"),
    ("bodies.wheel.solids", [3], [3]),
    ("bodies.wheel.polygon.2.1", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.STONES.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.STONES.shift.1", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.NEW.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.PINS.1.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.PINS.1.shift.0", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.PINS", [3], [3]),
    ("bodies.rack.adjust.LAYER.along", 0.25, "0.25 m"),
    ("springs.0.rest", 0.25, "0.25 rad"),
    ("springs.1.rest", 0.25, "0.25 m"),
    ("springs.1.stiffness", 2, "2.0 N/m"),
    ("springs.0.stiffness", 2, "2.0 N·m/rad"),
    ("springs.2.leaf.arm", 0.25, "0.25 m"),
    ("springs.2.draw.turns", 7, 7),
    ("line_springs.0.leaf.width", 0.25, "0.25 m"),
    ("line_springs.0.stiffness", 2, "2.0 N/m"),
    ("line_springs.0.between", ["rack", "wheel"], ["rack", "wheel"]),
    ("torques.0.ratio", 9, 9),
    ("torques.0.train.1.inertia", 0.25, "0.25 kg·m²"),
    ("torques.0.train.0.ratio", 0.25, 0.25),
    ("torques.1.value", 0.25, "0.25 N"),
    ("torques.0.value", 0.25, "0.25 N·m"),
    ("damping.0.viscous", 0.25, "0.25 N·m·s/rad"),
    ("expect.rate.tolerance", 3, 3),
    ("bodies.wheel.mass", "5 g", "5 g"),
    ("bodies.wheel.mass", True, True),
]


@pytest.mark.parametrize(("key", "value", "expected"), SET)
def test_the_value_of_that_path_and_no_other_is_changed(key: str, value: object, expected: object) -> None:
    mapping, said = set_to(key, value)
    assert said == [] and at(mapping, key) == expected and type(at(mapping, key)) is type(expected)
    section = key.split(".", maxsplit=1)[0]
    assert {name: one for name, one in mapping.items() if name != section} == {
        name: one for name, one in MAPPING.items() if name != section
    }


def test_a_pair_begins_as_zeros() -> None:
    assert set_to("bodies.rack.position.1", 0.25)[0]["bodies"]["rack"]["position"] == ["0.0 m", "0.25 m"]
    assert set_to("bodies.wheel.axis.0", 0.25)[0]["bodies"]["wheel"]["axis"] == [0.25, 0.0]


@pytest.mark.parametrize(
    ("key", "entry"),
    [
        ("springs.0.stiffness", {"body": "wheel", "rest": "2°", "stiffness": "3"}),
        ("springs.0.preload", {"body": "wheel", "frequency": "3 Hz", "preload": "3"}),
        ("springs.1.rest", {"body": "rack", "stiffness": "3 N/m", "draw": 5, "rest": "3"}),
        ("springs.1.leaf", {"body": "rack", "draw": 5, "leaf": "3"}),
        ("springs.2.frequency", {"body": "wheel", "frequency": "3"}),
        ("torques.0.value", {"body": "wheel", "value": "3"}),
        ("damping.0.viscous", {"body": "wheel", "viscous": "3"}),
    ],
)
def test_what_says_the_same_goes(key: str, entry: dict[str, Any]) -> None:
    section, number, _ = key.split(".")
    assert set_to(key, "3")[0][section][int(number)] == entry


def test_elsewhere_nothing_goes() -> None:
    """An expectation's value has no table."""
    mapping = {"expect": {"a": {"table": 1, "value": 2}}}
    assign(mapping, "expect.a.value", 3, Faults())
    assert mapping == {"expect": {"a": {"table": 1, "value": 3}}}


REFUSED = [
    ("springs.3.rest", "springs has no entry 3: there are 3, counted from 0"),
    ("springs.x.rest", "springs has no entry x: there are 3"),
    ("gears.0.ratio", "gears has no entry 0: there are 0"),
    ("bodies.wheel.solids.2.layer", "bodies.wheel.solids has no entry 2: there are 2"),
    ("torques.0.train.2.ratio", "the train has no wheel 2: there are 2, counted from 0"),
    ("torques.1.train.0.ratio", "the train has no wheel 0: there are 0"),
    ("torques.0.train.x.ratio", "the train has no wheel x"),
    ("bodies.wheel.adjust.PINS.2.turn", "no such table under adjust: it has 2 entries, counted from 0"),
    ("bodies.wheel.adjust.PINS.turn", "no such table under adjust: it has 2 entries"),
    ("bodies.wheel.polygon.3.1", "there is no element 3.1 in it"),
    ("bodies.wheel.polygon.2.x", "there is no element 2.x in it"),
    ("bodies.wheel.polygon.2.2", "there is no element 2.2 in it"),
    ("bodies.wheel.polygon.x.1", "there is no element x.1 in it"),
    ("bodies.lever.angle", 'there is no "lever" in bodies. Known here: wheel, rack, cam, arm, stone.'),
    ("bodies.whel.angle", 'Did you mean "wheel"?'),
    ("expect.beats.value", 'there is no "beats" in expect. Known here: rate.'),
    ("duration", 'Did you mean "run.duration"?'),
    ("sprongs.0.rest", 'Did you mean "springs"?'),
    ("springs.0.rost", 'Did you mean "rest"?'),
    ("bodies.cam.swing.amplitud", 'Did you mean "amplitude"?'),
    ("bodies.cam.swing.amplitude.1", "there is no element 1 in it"),
    ("springs.0.draw.turn", 'Did you mean "turns"?'),
    ("springs.2.leaf.wodth", 'Did you mean "width"?'),
    ("line_springs.0.leaf.wodth", 'Did you mean "width"?'),
    ("bodies.wheel.solids.0.densty", 'Did you mean "density"?'),
    ("bodies.wheel.adjust.STONES.trun", 'Did you mean "turn"?'),
    ("bodies.wheel.adjust.PINS.0.trun", 'Did you mean "turn"?'),
    ("bodies.wheel.matreial", 'Did you mean "material"?'),
    ("bodies.wheel.matreial.0.1", 'Did you mean "material"?'),
    ("springs.0.rost.1.2", 'Did you mean "rest"?'),
    ("run.duraton", 'Did you mean "duration"?'),
    ("scene", "Known here: title, schema, gravity, tangential_law, nu."),
    ("springs.0", "Write springs.NUMBER.KEY, the number counted from 0."),
    ("springs", "Write springs.NUMBER.KEY"),
    ("bodies.wheel", "Write bodies.NAME.KEY, with the name of a body."),
    ("bodies", "Write bodies.NAME.KEY"),
    ("expect", "Write expect.amplitude.value and expect.amplitude.tolerance, one by one."),
    ("expect.rate", "Write expect.rate.value and expect.rate.tolerance, one by one."),
    ("lock.versions", "watchsim writes this table; it cannot be changed."),
    ("design.lock", "This scene has no [design]"),
]


@pytest.mark.parametrize(("key", "words"), REFUSED)
def test_a_path_to_nothing_is_refused_with_what_is_near(key: str, words: str) -> None:
    (message,) = set_to(key, 0.25)[1]
    assert words in message


@pytest.mark.parametrize(
    ("value", "dimension", "expected"),
    [
        (3, ANGLE, "3.0 rad"),
        (-0.125, TORQUE, "-0.125 N·m"),
        (3, NUMBER, 3),
        (0.5, None, 0.5),
        (True, ANGLE, True),
        ("3 mm", ANGLE, "3 mm"),
        ([1, (0.5, "x")], ANGLE, ["1.0 rad", ["0.5 rad", "x"]]),
        (None, NUMBER, None),
    ],
)
def test_numbers_get_the_unit_of_their_key(value: object, dimension: Any, expected: object) -> None:
    found = with_unit(value, dimension)
    assert found == expected and type(found) is type(expected)


def test_siblings_are_the_keys_of_the_table_that_was_entered() -> None:
    """Whatever stands beside a known key is a key itself."""
    bodies, springs = ["x", "solids.0.x", "adjust.L.x", "swing.x"], ["x", "draw.x", "leaf.x"]
    paths = [f"bodies.a.{one}" for one in bodies] + [f"springs.0.{one}" for one in springs]
    for text in (*paths, "scene.x", "run.x", "expect.a.x", "gears.0.x", "line_springs.0.leaf.x"):
        path = tuple(text.split("."))
        names = siblings(path)
        assert key_at(path) is None and len(names) > 1 and all(key_at((*path[:-1], name)) for name in names), path
    assert siblings(("bodies", "a", "solids", "0")) == siblings(("bodies", "a", "x"))
    assert siblings(("bodies", "a", "adjust", "L")) == siblings(("bodies", "a", "x"))
    assert siblings(("springs", "0", "draw")) == siblings(("springs", "0", "x"))
    assert "bodies" in siblings(()) and siblings(("nothing",)) == siblings(())
