"""What becomes of a scene over which another one is written? Hand-worked, entry by entry."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from watchsim.scene.designed import merged

BASE: dict[str, Any] = {
    "scene": {"title": "base", "nu": 0.25},
    "run": {"duration": "3 s"},
    "bodies": {
        "wheel": {"drawing": "wheel.dxf", "layers": ["A"], "draw": ["B"], "inertia": "5 g·cm²", "mass": "2 g", "angle": "7°"},
        "lever": {"circle": "1 mm", "angle": "3°"},
    },
    "springs": [{"body": "wheel", "frequency": "3 Hz", "rest": "2°"}, {"body": "lever", "leaf": {"arm": "2 mm"}}],
    "torques": [{"body": "wheel", "over": "barrel", "table": [1, 2], "ratio": 8, "efficiency": 0.9, "train": [3]}],
    "damping": [{"body": "wheel", "q_factor": 200, "coulomb": "4 nN·m"}],
    "contacts": [{"between": ["wheel.A", "lever"], "friction": 0.2}, {"between": ["lever", "stop"], "friction": 0.3}],
    "expect": {"rate": {"value": 5, "tolerance": 2}},
}


def over(changes: dict[str, Any]) -> dict[str, Any]:
    before, given = copy.deepcopy(BASE), copy.deepcopy(changes)
    found = merged(BASE, changes)
    assert before == BASE and given == changes, "neither is changed"
    found["scene"]["touched"] = True
    assert before == BASE
    return found


CASES: list[tuple[dict[str, Any], tuple[str | int, ...], Any]] = [  # what is written over it, where, what is there then
    ({"scene": {"title": "new"}}, ("scene", "title"), "new"),
    ({"scene": {"title": "new"}}, ("scene", "nu"), 0.25),
    ({"run": 3}, ("run",), 3),
    ({"timegrapher": {"lift_angle": "52°"}}, ("timegrapher",), {"lift_angle": "52°"}),
    ({"expect": {"rate": {"value": 6}}}, ("expect", "rate"), {"value": 6, "tolerance": 2}),
    ({"expect": {"beats": {"value": 6}}}, ("expect", "rate", "value"), 5),
    ({"bodies": {"lever": {"angle": "4°"}}}, ("bodies", "lever"), {"circle": "1 mm", "angle": "4°"}),
    ({"bodies": {"lever": 5}}, ("bodies", "lever"), 5),
    ({"bodies": 5}, ("bodies",), 5),
    ({"bodies": {"stop": {"circle": "2 mm"}}}, ("bodies", "stop"), {"circle": "2 mm"}),
    (
        {"bodies": {"wheel": {"polygon": [9]}}},
        ("bodies", "wheel"),
        {"inertia": "5 g·cm²", "mass": "2 g", "angle": "7°", "polygon": [9]},
    ),
    ({"bodies": {"lever": {"line": [9]}}}, ("bodies", "lever"), {"angle": "3°", "line": [9]}),
    (
        {"bodies": {"wheel": {"drawing": "other.dxf"}}},
        ("bodies", "wheel"),
        {"drawing": "other.dxf", "layers": ["A"], "draw": ["B"], "inertia": "5 g·cm²", "mass": "2 g", "angle": "7°"},
    ),
    (
        {"bodies": {"wheel": {"solids": [8]}}},
        ("bodies", "wheel"),
        {"drawing": "wheel.dxf", "layers": ["A"], "draw": ["B"], "angle": "7°", "solids": [8]},
    ),
    ({"springs": [{"body": "wheel", "stiffness": 6}]}, ("springs", 0), {"body": "wheel", "rest": "2°", "stiffness": 6}),
    ({"springs": [{"body": "wheel", "leaf": 6}]}, ("springs", 0), {"body": "wheel", "rest": "2°", "leaf": 6}),
    ({"springs": [{"body": "wheel", "preload": 6}]}, ("springs", 0), {"body": "wheel", "frequency": "3 Hz", "preload": 6}),
    ({"springs": [{"body": "lever", "frequency": 6}]}, ("springs", 1), {"body": "lever", "frequency": 6}),
    ({"springs": [{"body": "lever", "frequency": 6}]}, ("springs", 0), BASE["springs"][0]),
    ({"springs": [{"body": "balance", "frequency": 6}]}, ("springs", 2), {"body": "balance", "frequency": 6}),
    ({"springs": [{"body": "wheel"}, {"body": "wheel", "rest": 6}]}, ("springs", 2), {"body": "wheel", "rest": 6}),
    ({"springs": [{"frequency": 6}]}, ("springs", 2), {"frequency": 6}),
    ({"springs": [5]}, ("springs", 2), 5),
    ({"springs": 5}, ("springs",), 5),
    ({"torques": [{"body": "wheel", "value": 6}]}, ("torques", 0), {"body": "wheel", "value": 6}),
    (
        {"torques": [{"body": "wheel", "table": [6]}]},
        ("torques", 0),
        {"body": "wheel", "over": "barrel", "table": [6], "ratio": 8, "efficiency": 0.9, "train": [3]},
    ),
    ({"damping": [{"body": "wheel", "viscous": 6}]}, ("damping", 0), {"body": "wheel", "coulomb": "4 nN·m", "viscous": 6}),
    ({"contacts": [{"between": ["lever", "wheel.A"], "friction": 6}]}, ("contacts", 0, "friction"), 6),
    ({"contacts": [{"between": ["lever", "wheel.A"], "friction": 6}]}, ("contacts", 1, "friction"), 0.3),
    ({"contacts": [{"between": ["stop", "lever"], "friction": 6}]}, ("contacts", 1, "friction"), 6),
    ({"contacts": [{"between": ["stop", "lever"], "friction": 6}]}, ("contacts", 0, "friction"), 0.2),
    ({"contacts": [{"between": ["wheel", "lever"]}]}, ("contacts", 2), {"between": ["wheel", "lever"]}),
    ({"contacts": [{"between": ["lever", 3]}]}, ("contacts", 2), {"between": ["lever", 3]}),
    ({"gears": [{"ratio": 6}]}, ("gears",), [{"ratio": 6}]),
]


@pytest.mark.parametrize(("changes", "where", "expected"), CASES)
def test_what_is_said_anew_stands_and_the_rest_stays(
    changes: dict[str, Any], where: tuple[str | int, ...], expected: Any
) -> None:
    whole = over(changes)
    found: Any = whole
    for key in where:
        found = found[key]
    assert found == expected
    for section, value in BASE.items():
        if section not in changes:
            assert (
                {key: one for key, one in whole[section].items() if key != "touched"} == value
                if section == "scene"
                else (whole[section] == value)
            )


def test_a_value_replaces_all_that_belongs_to_a_table() -> None:
    base = {"torques": [{"body": "a", "over": "time", "run_down": 4, "period": 2}, {"body": "b", "table": [5]}]}
    found = merged(base, {"torques": [{"body": "b", "value": 3}, {"body": "a", "value": 2}]})
    assert found == {"torques": [{"body": "a", "value": 2}, {"body": "b", "value": 3}]}


def test_a_table_replaces_a_constant_value() -> None:
    found = merged({"torques": [{"body": "a", "value": 4}]}, {"torques": [{"body": "a", "table": [5]}]})
    assert found == {"torques": [{"body": "a", "table": [5]}]}


def test_what_the_base_lacks_is_added() -> None:
    assert merged({"scene": {}}, {"contacts": [{"between": ["a", "b"]}], "bodies": {"a": {}}}) == {
        "scene": {},
        "contacts": [{"between": ["a", "b"]}],
        "bodies": {"a": {}},
    }


def test_an_entry_with_another_identity_is_another_entry() -> None:
    """Neither what names no body nor what names it by something else is the same."""
    base = {"springs": [{"rest": 1}, {"body": 3}, {"body": "a"}, {"body": "a", "rest": 2}]}
    found = merged(base, {"springs": [{"rest": 9}, {"body": 3, "rest": 8}, {"body": "a", "rest": 7}, {"body": "a", "rest": 6}]})
    assert found["springs"] == [
        {"rest": 1},
        {"body": 3},
        {"body": "a", "rest": 7},
        {"body": "a", "rest": 6},
        {"rest": 9},
        {"body": 3, "rest": 8},
    ]
