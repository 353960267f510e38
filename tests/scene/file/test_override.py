"""Does changing one value change that value and nothing else, and check everything again?"""

import pickle

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_scenes import drawing, square

from watchsim.scene.errors import SceneError
from watchsim.scene.load import assignments, changed, load
from watchsim.scene.scene import Scene


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
