"""What becomes of a scene over which another one is written? Hand-worked, entry by entry."""

import copy
import math
import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomllib
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_scenes import drawing, square

import watchsim as ws
from watchsim import units
from watchsim.construction.design import Conflict, Design, dim
from watchsim.scene.assign import assign, paths_of
from watchsim.scene.designed import chosen, kind_of, merged, number_of, with_si
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.load import assignments, changed, from_mapping, load
from watchsim.scene.scene import Scene

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
        *({"rest": 1}, {"body": 3}, {"body": "a", "rest": 7}, {"body": "a", "rest": 6}, {"rest": 9}, {"body": 3, "rest": 8})
    ]


@dataclass(frozen=True)
class Values:
    """Of a design that is never drawn."""

    lock: float = dim(1.5, "°", 0.5, 4.0, "depth", "chosen")
    length: float = dim(200.0, "mm", 10.0, 2000.0, "way", "chosen")
    teeth: int = dim(15, "", 8, 30, "number", "chosen")
    beat: float = dim(28800.0, "vph", 3600.0, 72000.0, "pace", "chosen")


def conflicts(values: Values) -> Any:
    if values.length > 1000.0 and values.teeth < 10:
        yield Conflict("teeth", "too few for so long a way")
    if values.beat > 50000.0:
        yield Conflict("", "too fast altogether")


DESIGN = Design("made", "Made", Values, lambda _: {}, lambda _: "", conflicts)


@pytest.mark.parametrize(
    ("name", "text", "number"),
    [
        ("lock", "1.7°", 1.7),
        ("lock", "0.02 rad", math.degrees(0.02)),
        ("length", "123.456 mm", 123.456),
        ("length", "0.3 m", 300.0),
        ("length", "3 inch", 76.2),
        ("length", "12345.678 µm", 12.345678),
        ("teeth", 17, 17.0),
        ("teeth", "17", 17.0),
        ("beat", "21600 vph", 21600.0),
        ("beat", "3 Hz", 21600.0),
    ],
)
def test_a_text_in_any_unit_is_a_number_in_the_dimension_s_own(name: str, text: object, number: float) -> None:
    """To the last of fifteen digits."""
    assert number_of(DESIGN.dimension(name), text) == float(f"{number:.15g}")
    values = chosen(DESIGN, {name: text})
    assert getattr(values, name) == pytest.approx(number, rel=1e-14, abs=0.0)
    assert [getattr(values, one) == getattr(Values(), one) for one in ("lock", "length", "teeth", "beat") if one != name] == [
        True
    ] * 3


@pytest.mark.parametrize(
    ("name", "kind", "si"),
    [
        ("lock", units.ANGLE, "0.25 rad"),
        ("length", units.LENGTH, "0.25 m"),
        ("teeth", units.NUMBER, 0.25),
        ("beat", units.FREQUENCY, "0.25 Hz"),
    ],
)
def test_numbers_from_python_are_in_si(name: str, kind: units.Dimension, si: object) -> None:
    assert kind_of(DESIGN.dimension(name)) is kind
    assert with_si(DESIGN, name, 0.25) == si
    assert with_si(DESIGN, name, True) is True and with_si(DESIGN, name, "3 mm") == "3 mm"
    assert with_si(DESIGN, "none", 0.25) == 0.25


@pytest.mark.parametrize(
    ("given", "faults"),
    [
        ({"lock": "1 mm"}, [("design.lock", ' = "1 mm"')]),
        ({"lock": 2}, [("design.lock", " = 2")]),
        ({"lok": "2°"}, [("design.lok", "")]),
        ({"lock": "0.4°", "length": "3 m"}, [("design.lock", ' = "0.4°"'), ("design.length", ' = "3 m"')]),
        ({"length": "1.5 m", "teeth": 9}, [("design.teeth", " = 9")]),
        ({"length": "1.5 m", "teeth": 10}, []),
        ({"beat": "60000 vph"}, [("design", ""), ("design.beat", ' = "60000 vph"')]),  # how far it may go
    ],
)
def test_what_does_not_fit_is_said_with_the_value(given: dict[str, object], faults: list[tuple[str, str]]) -> None:
    noted = Faults()
    noted.add("before", "another fault")
    values = chosen(DESIGN, given, noted)
    assert (values is None) is bool(faults)
    assert [(fault.key, fault.shown) for fault in noted.found[1:]] == faults
    if faults:
        with pytest.raises(SceneError) as caught:
            chosen(DESIGN, given)
        assert len(caught.value.faults) == len(faults)


def test_a_default_that_stands_in_the_way_is_shown() -> None:
    short = Design("made", "Made", Values, lambda _: {}, lambda _: "", lambda _: (Conflict("length", "does not fit"),))
    noted = Faults()
    assert chosen(short, {"teeth": 9}, noted) is None
    assert noted.found[0].shown == " = 200 mm (default)"


@pytest.fixture
def scene(desk):
    return load(desk.scene())


def test_text_values_are_read_as_in_the_file(scene):
    assert scene.set("torques.0.value", "-1.2 µN·m").torques[0].value == -1.2e-6
    assert scene.set("bodies.wheel.inertia", "0.07 mg·cm²").body("wheel").inertia == pytest.approx(7e-12)
    assert scene.set("contacts.0.friction", "0.3").contacts[0].friction == 0.3
    assert scene.set("bodies.lever.position.1", "9.5 mm").body("lever").position == (0.0, 0.0095)
    assert scene.set("run.duration", "2 s").duration == 2.0
    assert scene.set("scene.title", "Other").title == "Other"
    assert scene.set("expect.amplitude.value", "280°").expect[0].value == 280.0


def test_numbers_are_si(scene):
    assert scene.set("torques.0.value", -1.2e-6).torques[0].value == -1.2e-6
    assert scene.set("bodies.wheel.inertia", np.float64(7e-12)).body("wheel").inertia == 7e-12
    assert scene.set("contacts.0.friction", 0.3).contacts[0].friction == 0.3
    assert scene.set("contacts.0.restitution", np.int64(0)).contacts[0].restitution == 0.0
    assert scene.set("bodies.lever.position", (1e-3, 0.01)).body("lever").position == (1e-3, 0.01)
    assert scene.set("run.record", [(0.0, 1.0), (2.0, 3.0)]).record.windows == ((0.0, 1.0), (2.0, 3.0))
    assert scene.set("bodies.balance.velocity", 3.5).body("balance").velocity == (3.5,)


def test_units_follow_the_motion_of_the_body(desk):
    slider = '[bodies.s]\nmotion = "slide"\naxis = [1, 0]\nmass = "1 g"\n'
    free = '[bodies.f]\nmotion = "free"\ncircle = "1 mm"\nmass = "1 g"\n'
    scene = load(desk.scene(slider + free + '[[springs]]\nbody = "s"\nstiffness = "1 N/m"\n'))
    assert scene.set("springs.0.stiffness", 2.5).springs[0].stiffness == 2.5
    assert scene.set("springs.0.rest", 1e-3).springs[0].rest == 1e-3
    assert scene.set("bodies.s.velocity", 0.1).body("s").velocity == (0.1,)
    assert scene.set("bodies.f.velocity.1", 0.1).body("f").velocity == (0.0, 0.1, 0.0)
    assert scene.set("bodies.f.spin", 4.0).body("f").velocity == (0.0, 0.0, 4.0)


def test_keys_that_were_left_out_can_be_set(scene):
    assert scene.set("springs.0.rest", "2°").springs[0].rest == pytest.approx(np.radians(2))
    assert scene.set("scene.gravity.1", "-9.81 m/s²").gravity == (0.0, -9.81)
    assert scene.set("bodies.wheel.position.0", "-40 mm").body("wheel").position == (-0.04, 0.0)


def test_one_coordinate_of_a_place_that_the_drawing_gives_leaves_the_other(desk):
    """Both bodies stand where they are drawn, their pivots at (3, 4) and (5, -7) mm: moving one along x keeps its y."""
    marks = (("P", 3e-3, 4e-3), ("Q", 5e-3, -7e-3))
    desk.put(drawing("plate.dxf", (square(1e-3, (3e-3, 4e-3), "A"), square(2e-3, (5e-3, -7e-3), "B")), points=marks))
    body = '[bodies.{}]\ndrawing = "plate.dxf"\nlayers = ["{}"]\npivot = "{}"\nmass = "2 g"\n'
    scene = load(desk.scene(body.format("a", "A", "P") + body.format("b", "B", "Q")))
    assert scene.set("bodies.b.position.0", "6 mm").body("b").position == pytest.approx((6e-3, -7e-3))
    assert scene.set("bodies.b.position.0", 6e-3).set("bodies.b.position.1", 0.0).body("b").position == (6e-3, 0.0)
    both = changed(scene, {"bodies.b.position.0": "6 mm", "bodies.b.pivot": ["5 mm", "-8 mm"]})
    assert both.body("b").position == pytest.approx((6e-3, -8e-3))
    heavy = changed(scene, {"bodies.b.pivot": ["4 mm", "-8 mm"], "bodies.b.inertia": "1 g·cm²"})
    assert heavy.set("bodies.b.centre_of_mass.0", "2 mm").body("b").centre_of_mass == pytest.approx((2e-3, 1e-3))
    assert scene.set("bodies.a.position.1", "1 mm").body("b").position == pytest.approx((5e-3, -7e-3))


def test_what_follows_from_a_value_follows_it(scene):
    heavier = scene.set("bodies.balance.inertia", "24 mg·cm²")
    assert heavier.springs[0].stiffness == pytest.approx(2 * scene.springs[0].stiffness), "the frequency was given"
    assert heavier.damping[0].viscous == pytest.approx(2 * scene.damping[0].viscous)


def test_a_key_takes_the_place_of_its_alternative(scene):
    softer = scene.set("springs.0.stiffness", "0.5 µN·m/rad")
    assert softer.springs[0].stiffness == 5e-7
    assert softer.set("springs.0.frequency", "4 Hz").springs == scene.springs
    assert scene.set("damping.0.viscous", "1 nN·m·s/rad").damping[0].viscous == 1e-9


def test_the_original_is_untouched(scene):
    before = repr(scene.source)
    scene.set("bodies.lever.position.1", "9.5 mm").set("run.tolerance", 1e-6)
    assert repr(scene.source) == before
    assert scene.set("run.tolerance", scene.tolerance) == scene


def test_changes_add_up(scene):
    both = scene.set("contacts.0.friction", 0.0).set("torques.0.value", "-2 µN·m")
    assert (both.contacts[0].friction, both.torques[0].value) == (0.0, -2e-6)
    assert changed(scene, {"contacts.0.friction": 0.0, "torques.0.value": "-2 µN·m"}) == both


REFUSED = [
    ("torque.0.value", 1.0, 'Did you mean "torques"?'),
    ("torques.0.valu", 1.0, 'Did you mean "value"?'),
    ("torques.1.value", 1.0, "torques has no entry 1: there are 1, counted from 0"),
    ("torques.x.value", 1.0, "torques has no entry x"),
    ("torques", 1.0, "Write torques.NUMBER.KEY, the number counted from 0"),
    ("expect.amplitude", 1.0, "Write expect.amplitude.value and expect.amplitude.tolerance"),
    ("bodies.whel.inertia", 1.0, 'there is no "whel" in bodies. Did you mean "wheel"?'),
    ("bodies.wheel", 1.0, "Write bodies.NAME.KEY, with the name of a body"),
    ("bodies.wheel.inertya", 1.0, 'Did you mean "inertia"?'),
    ("bodies.wheel.solids.0.density", 1.0, "bodies.wheel.solids has no entry 0: there are 0"),
    ("bodies.lever.position.2", 1.0, "there is no element 2 in it"),
    ("bodies.lever.position.x", 1.0, "there is no element x in it"),
    ("bodies.lever.polygon.7.0", 1.0, "there is no element 7.0 in it"),
    ("bodies.lever.angle.0", 1.0, "there is no element 0 in it"),
    ("run.duratoin", 1.0, 'Did you mean "duration"?'),
    ("run", 1.0, "Known here: duration, record, tolerance."),
    ("lock.versions", "1", "unknown key"),
    ("design.lock", "2°", "This scene has no [design]"),
    ("torques.0.value", "-1.2", "a bare number needs a unit here"),
    ("torques.0.value", "3 mm", "is a length; here a torque is needed"),
    ("torques.0.value", float("nan"), "does not begin with a number"),
    ("contacts.0.friction", -0.1, "a negative friction coefficient"),
    ("contacts.0.friction", True, "true or false"),
    ("bodies.wheel.inertia", 0.0, "has no inertia"),
    ("bodies.wheel.drawing", "none.dxf", "there is no such file"),
    ("bodies.wheel.on", "fork", "there is no such body"),
    ("bodies.wheel.adjust", "lever", "a table of layers is needed here"),
]


@pytest.mark.parametrize(("key", "value", "message"), REFUSED)
def test_refused_changes(scene, key, value, message):
    with pytest.raises(SceneError) as caught:
        scene.set(key, value)
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"changed value  {key}")


def test_a_scene_without_a_file_says_how_to_change_it():
    with pytest.raises(SceneError, match=r"run\.duration\n  this scene was made in Python.*dataclasses\.replace"):
        Scene("bare", ()).set("run.duration", "1 s")


def test_a_scene_that_was_pickled_can_be_changed(scene):
    back = pickle.loads(pickle.dumps(scene))
    assert back == scene
    assert back.set("torques.0.value", -1.2e-6) == scene.set("torques.0.value", -1.2e-6)


def test_assignments_of_the_command_line(scene):
    changes = assignments(["torques.0.value=-1.2 µN·m", "run.tolerance = 1e-6", 'bodies.lever.position=["1 mm", "9 mm"]'])
    assert changes == {"torques.0.value": "-1.2 µN·m", "run.tolerance": "1e-6", "bodies.lever.position": ["1 mm", "9 mm"]}
    new = changed(scene, changes)
    assert (new.torques[0].value, new.tolerance, new.body("lever").position) == (-1.2e-6, 1e-6, (0.001, 0.009))


@pytest.mark.parametrize("text", ["torques.0.value", "=3", "a=", "a=[1, ", 'a="b'])
def test_malformed_assignments(text):
    with pytest.raises(SceneError, match="--set"):
        assignments([text])


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.floats(min_value=-1e3, max_value=1e3))
def test_set_keeps_every_bit(scene, value):
    assert scene.set("bodies.lever.angle", value).body("lever").angle == value
    assert scene.set("bodies.lever.position.0", value).body("lever").position[0] == value


TABLE = 'over = "time"\ntable = [["0.02 s", "0 mN·m"], ["0.03 s", "1 mN·m"], ["0.05 s", "1 mN·m"], ["0.06 s", "0 mN·m"]]'
IMPULSE = 1e-3 * 0.03  # N·m·s of one period: a trapezium


def made(torque: str) -> Scene:
    wheel = '[bodies.wheel]\ncircle = "1 mm"\ninertia = "1 g·cm²"\n[run]\nduration = "1 s"\n'
    return from_mapping(tomllib.loads(f'{wheel}[[torques]]\nbody = "wheel"\n{torque}\n'), Path("x/scene.toml"))


@pytest.mark.parametrize("method", ["events", "moreau"])
def test_each_period_gives_the_same_impulse(method: str) -> None:
    how = {} if method == "events" else {"method": "moreau", "step": 1e-5}
    run = ws.simulate(made(f'{TABLE}\nperiod = "0.1 s"'), **how)
    ends = np.array([0.1, 0.2, 0.5, 0.9])
    tight = 1e-9 if method == "events" else 1e-3
    assert run.sample(ends)[1][:, 0] == pytest.approx(IMPULSE / 1e-7 * ends / 0.1, rel=tight)
    assert run.sample(np.array([0.71]))[1][0, 0] == pytest.approx(7.0 * IMPULSE / 1e-7, rel=tight)
    assert run.energy["residual_relative"] < 1e-9 or method == "moreau"


def test_from_the_last_row_it_goes_on_to_the_first_a_period_later() -> None:
    """From 1 mN·m at 0.03 s down to 0 at 0.11 s, which is the first row: read between and before the rows alike."""
    torque = made('over = "time"\ntable = [["0.01 s", "0 mN·m"], ["0.03 s", "1 mN·m"]]\nperiod = "0.1 s"').torques[0]
    assert [torque.over_time(t) for t in (0.01, 0.02, 0.03, 0.07, 0.11, 0.12, 5.07)] == pytest.approx(
        [0.0, 5e-4, 1e-3, 5e-4, 0.0, 5e-4, 5e-4], abs=1e-15
    )
    assert torque.over_time(0.0) == pytest.approx(1e-3 * 0.01 / 0.08)


REFUSED_REPEATED_TABLES = [
    (f'{TABLE}\nperiod = "0.03 s"', "must be longer than the table"),
    ('value = "1 mN·m"\nperiod = "1 s"', "belongs to a table"),
    ('over = "angle"\ntable = [["0°", "0 mN·m"], ["9°", "1 mN·m"]]\nperiod = "1 s"', 'belongs to a table with over = "time"'),
    (f'{TABLE}\nperiod = "1 mm"', "length"),
]


@pytest.mark.parametrize(("torque", "why"), REFUSED_REPEATED_TABLES)
def test_what_cannot_be_is_refused(torque: str, why: str) -> None:
    with pytest.raises(SceneError, match=why):
        made(torque)


def test_a_layer_with_points_and_blanks_stands_in_quotes(desk, good):
    """Programs name layers after heights: "TEETH 1.30"."""
    scene = load(desk.scene(good))
    layer = scene.body("wheel").loops[0].layer
    mapping = {"bodies": {"wheel": {"adjust": {"TEETH 1.30": {"turn": "0.1°"}}}}}
    (path,) = paths_of(mapping)
    assert path == 'bodies.wheel.adjust."TEETH 1.30".turn'
    faults = Faults("--set")
    assign(mapping, path, "0.2°", faults)
    faults.raise_any()
    assert mapping["bodies"]["wheel"]["adjust"] == {"TEETH 1.30": {"turn": "0.2°"}}
    turned = scene.set(f'bodies.wheel.adjust."{layer}".turn', "10°")
    assert turned.body("wheel").loops[0].edges[0].start != scene.body("wheel").loops[0].edges[0].start
    assert assignments(['"design.lock"=2°', 'bodies.wheel.adjust."A.1".turn=1°']) == {
        "design.lock": "2°",
        'bodies.wheel.adjust."A.1".turn': "1°",
    }


@pytest.mark.parametrize(("of", "key", "unit"), [("pin_wheel", "torque", "mN·m"), ("swiss_lever", "torque", "µN·m")])
def test_a_bare_dimension_gets_an_example_in_the_unit_of_its_design(of: str, key: str, unit: str, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[design]\nof = "{of}"\n{key} = 20\n', encoding="utf-8")
    with pytest.raises(SceneError, match=f'Write "20 {unit}"'):
        load(scene)
