"""What comes of a mainspring's torque, and of its train's inertia, at the body that they drive?"""

import math

import numpy as np
import pytest
from scene.made_gears import wheels

import watchsim as ws
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.check import check_report, check_text
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.words import force_lines
from watchsim.scene.errors import SceneError
from watchsim.scene.layer_heights import slabs
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene
from watchsim.scene.solids import LYING, PLATE, UPRIGHT, Solid, Weight
from watchsim.scene.trains import bonds, felt, goes_with, note_gears, reached, rides, start_poses, ungeared, weigh
from watchsim.studies.steady import steady

WHEEL = """
[scene]
schema = 1

[bodies.wheel]
circle   = "2 mm"
angle    = "30°"
inertia  = "0.05 mg·cm²"

[[torques]]
body       = "wheel"
over       = "barrel"
table      = [["0 rev", "10 mN·m"], ["2 rev", "8 mN·m"], ["6 rev", "2 mN·m"]]
ratio      = {ratio}
efficiency = 0.8
run_down   = "{turned} rev"
train      = [{{ ratio = 10, inertia = "2 mg·cm²" }}, {{ ratio = -50, inertia = "30 mg·cm²" }}]

[run]
duration  = "{seconds} s"
tolerance = 1e-11
"""


def wheel(tmp_path, ratio=-100.0, turned=0.0, seconds=0.01):
    (tmp_path / "scene.toml").write_text(WHEEL.format(ratio=ratio, turned=turned, seconds=seconds), encoding="utf-8")
    return ws.load(tmp_path)


@pytest.mark.parametrize(
    "turned, at_barrel", [(0.0, 10e-3), (1.0, 9e-3), (2.0, 8e-3), (5.0, 3.5e-3), (9.0, 2e-3), (-1.0, 10e-3)]
)
@pytest.mark.parametrize("ratio", [-100.0, 250.0])
def test_torque_and_inertia_at_the_wheel(tmp_path, ratio, turned, at_barrel):
    """T = η T_barrel / i; I = I_wheel + Σ I_k / i_k²."""
    scene = wheel(tmp_path, ratio, turned)
    torque = scene.torques[0]
    assert torque.value == pytest.approx(0.8 * at_barrel / ratio, rel=1e-12, abs=0.0)
    angle = scene.body("wheel").angle
    assert np.interp(angle, *np.transpose(torque.table)) == pytest.approx(torque.value, rel=1e-9, abs=0.0)
    assert torque.mainspring.inertia == pytest.approx(2e-10 / 100.0 + 30e-10 / 2500.0, rel=1e-12)
    assert scene.body("wheel").inertia == pytest.approx(0.05e-10 + torque.mainspring.inertia, rel=1e-12)


def test_a_wheel_that_runs_down_swings_up_by_the_work_of_the_spring(tmp_path):
    """½ I ω² = η ∫ T dφ over two turns of the barrel, past a corner of its curve."""
    scene = wheel(tmp_path, -100.0, 1.0, 0.5)
    run = ws.simulate(scene)
    turns = (scene.body("wheel").angle - run.q[:, 0]) / 100.0
    at = int(np.searchsorted(turns, 2.0 * math.tau))
    assert 0 < at < len(turns)
    barrel = np.linspace(math.tau, math.tau + turns[at], 200001)
    spring = np.interp(barrel / math.tau, [0.0, 2.0, 6.0], [10e-3, 8e-3, 2e-3])
    work = 0.8 * float(np.trapezoid(spring, barrel))
    assert 0.5 * scene.body("wheel").inertia * run.u[at, 0] ** 2 == pytest.approx(work, rel=1e-7)


def test_a_limit_cycle_is_that_of_the_torque_at_that_hour(tmp_path):
    text = """
[design]
of = "swiss_lever"

[[torques]]
body       = "wheel"
over       = "barrel"
table      = [["0 rev", "10 mN·m"], ["7 rev", "5 mN·m"]]
ratio      = -6400
efficiency = 0.8
run_down   = "2.8 rev"
"""
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    scene = ws.load(tmp_path)
    wound, plain = steady(scene), steady(ws.designs.swiss_lever(torque="1 µN·m").scene())
    assert wound.amplitude_deg == pytest.approx(plain.amplitude_deg, abs=1e-7)
    assert wound.rate_s_per_d == pytest.approx(plain.rate_s_per_d, abs=1e-7)
    table = ws.sweep(scene, {"torques.0.run_down": [0.0, 5.6 * math.tau]})
    assert np.square(table.column("amplitude")) == pytest.approx(
        np.square(plain.amplitude_deg) * np.array([1.25, 0.75]), rel=2e-3
    )


@pytest.mark.parametrize(
    "key, value, why",
    [
        ("torques.0.ratio", 0.0, "must not be 0"),
        ("torques.0.efficiency", 1.2, "share of the work"),
        ("torques.0.efficiency", 0.0, "share of the work"),
        ("torques.0.over", "angle", 'belongs to a table with over = "barrel"'),
        ("torques.0.train.0.ratio", 0.0, "must not be 0"),
        ("torques.0.train.1.inertia", "-1 mg·cm²", "above zero"),
        ("torques.0.run_down", "3 s", "time"),
        ("torques.0.train.2.ratio", 3, "no wheel 2"),
    ],
)
def test_what_makes_no_train_is_refused(tmp_path, key, value, why):
    with pytest.raises(SceneError, match=why):
        wheel(tmp_path).set(key, value)


@pytest.mark.parametrize(
    "old, new, why",
    [
        ("ratio      = -100.0\n", "", "missing: ratio"),
        ("{ ratio = 10, inertia", "{ ratoi = 10, inertia", "ratio"),
        ('train      = [{ ratio = 10, inertia = "2 mg·cm²" }, { ratio = -50, inertia = "30 mg·cm²" }]', "train = 3", "a list"),
        ('{ ratio = -50, inertia = "30 mg·cm²" }', "-50", "an entry for each wheel"),
    ],
)
def test_a_slip_in_a_train_is_reported(tmp_path, old, new, why):
    text = WHEEL.format(ratio=-100.0, turned=0.0, seconds=1)
    assert old in text
    (tmp_path / "scene.toml").write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(SceneError, match=why):
        ws.load(tmp_path)


def test_check_says_where_the_torque_comes_from(tmp_path):
    shown = "\n".join(force_lines(wheel(tmp_path, turned=1.0)))
    assert "from 9 mN·m at the barrel 1 turns from full wind" in shown
    assert "0.032 mg·cm²" in shown


def test_a_plain_value_takes_its_place(tmp_path):
    scene = wheel(tmp_path).set("torques.0.value", "-1 µN·m")
    assert scene.torques[0].mainspring is None
    assert scene.torques[0].value == pytest.approx(-1e-6)
    assert scene.body("wheel").inertia == pytest.approx(0.05e-10)


THIRD = '[bodies.third]\nposition = ["20 mm", "0 mm"]\ninertia = "1 g·cm²"\n'


def faults(folder, **parts) -> dict[str, str]:
    with pytest.raises(SceneError) as caught:
        wheels(folder, **parts)
    return {fault.key: fault.message for fault in caught.value.faults}


def test_what_goes_with_a_body_either_way(tmp_path) -> None:
    scene = wheels(tmp_path)
    assert goes_with(scene, "wheel") == {"wheel": 1.0, "pinion": -8.0}
    assert goes_with(scene, "pinion") == {"pinion": 1.0, "wheel": -0.125}


def test_gears_without_play_bind_the_second_body_to_the_first(tmp_path) -> None:
    scene = wheels(tmp_path)
    assert scene.gears == () and scene.body("wheel").geared is None
    assert scene.body("pinion").geared == Geared("wheel", -8.0)
    compiled = compile_scene(scene)
    assert compiled.model.coordinates.mass.tolist() == [1e-7 + 64e-8]
    assert compiled.slices == {"wheel": slice(0, 1), "pinion": slice(1, 2)}


def test_gears_with_play_keep_both_coordinates(tmp_path) -> None:
    scene = wheels(tmp_path, gears='backlash = "0.5°"\nrestitution = 0.2\nefficiency = 0.95')
    assert scene.gears == (Gear(("wheel", "pinion"), -8.0, math.radians(0.5), 0.2, 0.95),)
    assert compile_scene(scene).model.coordinates.mass.tolist() == [1e-7, 1e-8]


def test_a_train_is_bound_to_one_of_its_wheels(tmp_path) -> None:
    """The one with a spring holds the coordinate; ratios multiply along the way."""
    more = THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\n[[springs]]\nbody = "third"\nfrequency = "2 Hz"'
    scene = wheels(tmp_path, more=more)
    assert scene.body("third").geared is None
    assert scene.body("pinion").geared == Geared("third", -0.5)
    assert scene.body("wheel").geared == Geared("third", 0.0625)
    mass = 1e-7 + 0.25 * 1e-8 + 0.0625**2 * 1e-7
    assert compile_scene(scene).model.coordinates.mass == pytest.approx([mass], rel=1e-12)
    assert scene.springs[0].stiffness == pytest.approx(mass * (4.0 * math.pi) ** 2, rel=1e-12)


def test_a_velocity_is_that_of_all(tmp_path) -> None:
    scene = wheels(tmp_path, pinion='velocity = "80 °/s"')
    assert scene.body("wheel").velocity == pytest.approx((math.radians(-10.0),))
    found = faults(tmp_path, pinion='velocity = "80 °/s"', wheel='velocity = "10 °/s"')
    assert "contradicts" in found["bodies.pinion.velocity"]


def test_values_that_cannot_be_are_faults(tmp_path) -> None:
    found = faults(tmp_path, gears='backlash = "-1°"\nrestitution = 2\nefficiency = 0\nplay = 1')
    assert set(found) == {"gears.0.backlash", "gears.0.restitution", "gears.0.efficiency", "gears.0.play"}
    assert "must not be 0" in faults(tmp_path, ratio=0.0)["gears.0.ratio"]
    assert 'backlash = "0.5°"' in faults(tmp_path, gears="efficiency = 0.9")["gears.0.efficiency"]


def test_unknown_and_fixed_bodies_are_faults(tmp_path) -> None:
    found = faults(tmp_path, more='[[gears]]\nbetween = ["wheel", "pinon"]\nratio = 2')
    assert 'Did you mean "pinion"?' in found["gears.1.between.1"]
    found = faults(tmp_path, pinion='motion = "fixed"')
    assert "turn or slide" in found["gears.0.between.1"]
    assert "two bodies" in faults(tmp_path, more="[[gears]]\nbetween = 3\nratio = 2")["gears.1.between"]


def test_the_ratio_of_a_rack_is_a_length(tmp_path) -> None:
    rack = '[bodies.rack]\nmotion = "slide"\naxis = [1.0, 0.0]\nmass = "1 g"\n[[gears]]\nbetween = ["wheel", "rack"]\nratio = '
    for text in ('"10 mm/rad"', '"10 mm"', f'"{20.0 * math.pi!r} mm/rev"'):
        assert wheels(tmp_path, more=rack + text).body("rack").geared.ratio == pytest.approx(0.01)
    assert "mm/rad" in faults(tmp_path, more=rack + "10")["gears.1.ratio"]
    back = rack.replace('["wheel", "rack"]', '["rack", "wheel"]') + '"0.1 rad/mm"'
    assert wheels(tmp_path, more=back).body("wheel").geared is None
    assert wheels(tmp_path, more=back).body("rack").geared.ratio == pytest.approx(0.01)


def test_gears_that_bind_the_same_bodies_twice_are_a_fault(tmp_path) -> None:
    third = THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\n'
    found = faults(tmp_path, more=third + '[[gears]]\nbetween = ["third", "wheel"]\nratio = 3.0')
    assert "already" in found["gears.2.between"]
    found = faults(tmp_path, more='[[gears]]\nbetween = ["wheel", "pinion"]\nratio = 3.0\nbacklash = "1°"')
    assert "already" in found["gears.1.between"]


def test_two_that_gravity_turns_cannot_be_bound(tmp_path) -> None:
    heavy = 'mass = "10 g"\ncentre_of_mass = ["1 mm", "0 mm"]'
    parts = {"scene": 'gravity = ["0 m/s²", "-9.81 m/s²"]', "pinion": heavy}
    assert wheels(tmp_path, **parts).body("pinion").geared is None
    found = faults(tmp_path, **parts, wheel=heavy)["gears.0.between"]
    assert "gravity turns pinion" in found and "gravity turns wheel" in found


def test_nothing_acts_on_what_is_geared_to_a_driven_body(tmp_path) -> None:
    parts = {"wheel": 'motion = "driven"\nvelocity = "10 rpm"', "more": '[[torques]]\nbody = "pinion"\nvalue = "1 µN·m"'}
    found = faults(tmp_path, **parts)
    assert "geared" in found["torques.0.body"]


def test_check_tells_of_gears(tmp_path) -> None:
    scene = wheels(tmp_path, more=THIRD + '[[gears]]\nbetween = ["third", "pinion"]\nratio = -0.5\nbacklash = "0.5°"')
    text = check_text(check_report(scene, ()), scene)
    assert "pinion is geared to wheel: -8 turns for one turn of it" in text
    assert "felt at wheel with all that is geared to it: 7400 mg·cm²" in text
    assert "gears third - pinion: -0.5 turns for one turn, play 0.5°" in text


BIG = Body("wheel", inertia=7.0, angle=0.3)
PINION = Body("pinion", inertia=0.5, angle=-0.2, geared=Geared("wheel", -4.0))
RACK = Body("rack", "slide", mass=2.0, angle=0.9, geared=Geared("wheel", 0.25))
FREE = Body("free", inertia=11.0)
TRAIN = (PINION, FREE, RACK, BIG)


def test_an_angle_is_linear_in_that_of_the_holder() -> None:
    """Both stand at their start angles at once; a rack at the start of its way."""
    pinion, free, rack, wheel = bonds(TRAIN, rides(TRAIN))
    assert (free.to, wheel.to, pinion.to, rack.to) == (1, 3, 3, 3)
    assert (free.ratio, free.phase, free.given, free.shift) == (1.0, 0.0, 1.0, 0.0)
    assert (pinion.ratio, pinion.given) == (-4.0, -4.0) and (rack.ratio, rack.given) == (0.25, 0.25)
    for bond, start in ((pinion, -0.2), (rack, 0.0)):
        assert bond.ratio * 0.3 + bond.phase == pytest.approx(start) and bond.given * 0.3 + bond.shift == pytest.approx(start)


def test_a_planet_turns_with_what_carries_it_besides() -> None:
    """At -4 against its carrier it turns at -3 in the movement; `given` is what the scene says."""
    planet = Body("planet", inertia=0.5, angle=-0.2, on="wheel", geared=Geared("wheel", -4.0))
    _, bond = bonds((BIG, planet), rides((BIG, planet)))
    assert (bond.ratio, bond.given) == (-3.0, -4.0)
    assert bond.ratio * 0.3 + bond.phase == pytest.approx(0.1) and bond.given * 0.3 + bond.shift == pytest.approx(-0.2)


def test_each_feels_all_that_is_geared_to_it() -> None:
    """The energy of one unit of its own rate, doubled: all go on with the wheel."""
    weighed = weigh(TRAIN, rides(TRAIN))
    whole = 7.0 + 16.0 * 0.5 + 2.0 / 16.0
    assert felt(TRAIN, rides(TRAIN), weighed) == pytest.approx((whole / 16.0, 11.0, whole * 16.0, whole))
    alone = tuple(Body(body.name, body.motion, mass=body.mass, inertia=body.inertia) for body in TRAIN)
    assert felt(alone, rides(alone), weigh(alone, rides(alone))) == (0.5, 11.0, 2.0, 7.0)


def test_what_goes_with_what() -> None:
    """Gears with play count as those without."""
    scene = Scene("t", TRAIN, gears=(Gear(("pinion", "free"), 5.0, 0.1),))
    assert goes_with(scene, "wheel") == {"wheel": 1.0, "pinion": -4.0, "rack": 0.25, "free": -20.0}
    assert goes_with(scene, "rack") == {"rack": 1.0, "wheel": 4.0, "pinion": -16.0, "free": -80.0}
    assert goes_with(Scene("t", TRAIN), "free") == {"free": 1.0}
    ways = {"a": {"b": 3.0}, "b": {"a": 1 / 3, "c": -0.5}, "c": {"b": -2.0, "a": 99.0}}
    assert reached(ways.__getitem__, "a") == {"a": 1.0, "b": 3.0, "c": -1.5} and reached(lambda _: {}, "z") == {"z": 1.0}


def test_out_of_its_train_every_body_is_free() -> None:
    loose, rigid = Gear(("pinion", "free"), 5.0, 0.1), Gear(("wheel", "pinion"), -4.0, 0.0)
    bare = ungeared(Scene("t", TRAIN, gears=(loose,), rigid_gears=(rigid,)))
    assert bare.gears == bare.rigid_gears == () and all(body.geared is None for body in bare.bodies)
    for scene in (Scene("t", (FREE, PINION)), Scene("t", (FREE,), gears=(loose,))):
        assert ungeared(scene) != scene
    plain = Scene("t", (FREE, BIG))
    assert ungeared(plain) is plain


def complaints(*bodies: Body, pulled: tuple[str, ...] = ()) -> list[str]:
    found: list[str] = []
    note_gears(bodies, rides(bodies), frozenset(pulled), lambda name, message: found.append(f"{name}: {message}"))
    return found


LAW = Prescribed()


def test_only_one_of_those_geared_may_be_held() -> None:
    driven = Body("wheel", inertia=7.0, prescribed=LAW)
    rider = Body("rider", inertia=1.0, on="pinion")
    assert complaints(driven, PINION) == complaints(BIG, PINION, FREE) == complaints(BIG, PINION, pulled=("wheel",)) == []
    (one,) = complaints(driven, PINION, pulled=("pinion",))
    assert one.startswith("pinion: gravity turns pinion, which is not poised; wheel is driven. Of bodies geared")
    (two,) = complaints(rider, BIG, PINION, pulled=("pinion",))
    assert two.startswith("pinion: pinion carries others; . Of bodies geared")
    three = complaints(BIG, Body("pinion", inertia=0.5, prescribed=LAW, geared=Geared("wheel", -4.0)), pulled=("wheel",))
    assert three[0].startswith("pinion: pinion is driven; gravity turns wheel, which is not poised.")


def test_gears_bind_in_the_movement_or_on_a_carrier_alone() -> None:
    carriage = Body("carriage", inertia=9.0)
    on_it = Body("wheel", inertia=7.0, on="carriage")
    planet = Body("planet", inertia=0.5, on="carriage", geared=Geared("carriage", 3.0))
    assert complaints(carriage, planet) == []
    (one,) = complaints(carriage, on_it, PINION)
    assert one.startswith("pinion: wheel is itself carried by a body that turns. Gears bind bodies in the movement")
    (two,) = complaints(carriage, BIG, Body("planet", inertia=0.5, on="carriage", geared=Geared("wheel", 3.0)))
    assert two.startswith("planet: what carries it is not wheel. Gears bind")


def test_what_nobody_carries_stands_in_the_movement() -> None:
    """Also where its carrier is missing."""
    scene = Scene(
        "t", (Body("a", position=(3.0, -2.0), angle=0.4, on="none"), Body("b", position=(1.0, 0.0), angle=0.5, on="a"))
    )
    poses = start_poses(scene)
    assert poses["a"] == pytest.approx((3.0, -2.0, 0.4), abs=1e-15)
    assert poses["b"] == pytest.approx((3.0 + 0.921060994, -2.0 + 0.389418342, 0.9))


@pytest.mark.parametrize(("off", "refused"), [(1.9e-9, False), (2.1e-9, True)])
@pytest.mark.parametrize("order", [1, -1])
def test_a_load_is_poised_by_the_farthest_of_its_edges(off: float, refused: bool, order: int) -> None:
    """The middles of its edges lie 0.1 mm and 2 mm from its pivot; that of its carrier's count for nothing."""
    near, far, wide = (Loop((Line(x, -1e-3, x, 1e-3),), closed=False) for x in (0.1e-3, -2e-3, 50e-3))
    load = Body(
        "b", inertia=1.0, mass=3.0, centre_of_mass=(0.0, off), position=(0.2e-3, 0.0), on="c", loops=(near, far)[::order]
    )
    bodies = (Body("c", inertia=1.0, loops=(wide,)), load)
    found: list[str] = []
    weigh(bodies, rides(bodies), lambda name, _: found.append(name))
    assert found == (["b"] if refused else [])


@pytest.mark.parametrize(("off", "refused"), [(0.19e-9, False), (0.21e-9, True), (0.5e-9, True)])
def test_a_load_without_outlines_is_poised_by_its_reach(off: float, refused: bool) -> None:
    """0.2 mm from its carrier: a millionth of that."""
    bodies = (
        Body("c", inertia=1.0),
        Body("b", inertia=1.0, mass=3.0, centre_of_mass=(off, 0.0), position=(0.2e-3, 0.0), on="c"),
    )
    found: list[str] = []
    weigh(bodies, rides(bodies), lambda name, _: found.append(name))
    assert found == (["b"] if refused else [])


def rectangle(x0: float, y0: float, x1: float, y1: float, layer: str) -> Loop:
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


def solid(kind: str, loop: Loop, thickness: float = 0.0) -> Solid:
    return Solid(kind, loop.layer, Weight(1.0, (0.0, 0.0), 1.0), 1.0, (loop,), thickness)


STAFF = solid(UPRIGHT, rectangle(-2.0, 0.0, 2.0, 0.1, "STAFF"))
LOW, HIGH = (solid(PLATE, rectangle(-2.0, -2.0, 2.0, 2.0, name), thick) for name, thick in (("LOW", 1.0), ("HIGH", 0.5)))


@pytest.mark.parametrize("order", [(STAFF, LOW, HIGH), (LOW, HIGH, STAFF), (LOW, STAFF, HIGH)])
def test_a_staff_goes_through_the_middle_of_its_own_body(order: tuple[Solid, ...]) -> None:
    """LOW from 0 to 1, HIGH above a tenth of that from 1.1 to 1.6; another body's plates are not its business."""
    other = Body("other", "fixed", solids=(solid(PLATE, rectangle(-1.0, -1.0, 1.0, 1.0, "ELSEWHERE"), 7.0),))
    found = {slab.layer: slab for slab in slabs(Scene("", (Body("a", "pivot", solids=order), other)), 0.2)}
    assert [found[name].middle for name in ("LOW", "HIGH")] == pytest.approx([0.5, 1.35])
    assert found["STAFF"].middle == pytest.approx(0.5 * (0.5 + 1.35))


def test_a_staff_alone_stands_on_the_ground() -> None:
    (only,) = slabs(Scene("", (Body("a", "pivot", solids=(STAFF,)),)), 0.2)
    assert only.middle == 0.0


def test_a_lying_part_is_as_high_as_it_is_wide() -> None:
    """A rod of radius 0.3 about the x axis: 0.6 high, and seen from above on both sides of its axis."""
    rod = solid(LYING, rectangle(1.0, 0.0, 3.0, 0.3, "ROD"))
    (lying,) = slabs(Scene("", (Body("a", "pivot", solids=(rod,)),)), 0.2)
    assert lying.thickness == pytest.approx(0.6) and lying.middle == pytest.approx(0.3)
    assert {round(y, 12) for loop in lying.loops for edge in loop.edges for _, y in (edge.start,)} == {-0.3, 0.0, 0.3}
