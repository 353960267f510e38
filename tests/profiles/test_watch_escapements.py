"""Does the detent escapement tick, one tooth in every other half swing, and does its rate hardly follow the drive?"""

import math

import numpy as np
import pytest
from every_time import few
from profiles.running import DAY, Led, of_profile, work_and_rate

import watchsim as ws
from watchsim import designs
from watchsim.analysis.phases import phases
from watchsim.analysis.timeline import shown_beats
from watchsim.construction.cylinder import Cylinder, Shell, shell
from watchsim.construction.detent import Detent, Points
from watchsim.construction.duplex import Duplex, DuplexPoints
from watchsim.construction.registry import design
from watchsim.escapement.function_report import judgements
from watchsim.escapement.measure import measure
from watchsim.scene.roles import Roles, roles
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

POINTS = Points(Detent())


@pytest.fixture(scope="module")
def ticking() -> ws.Trajectory:
    return ws.simulate(designs.detent(start="268 °").scene(), duration=4.0)


def teeth(run: ws.Trajectory) -> float:
    column = run.slices["wheel"].start
    return float(run.scene.body("wheel").angle - run.end_q[column]) / (math.tau / 15.0)


def test_the_detent_is_the_lever_by_its_passing_spring():
    assert roles(designs.detent().scene()) == Roles("balance", "wheel", "detent")


def test_one_tooth_in_each_oscillation(ticking):
    assert teeth(ticking) == pytest.approx(8.0, abs=1e-3)
    assert ws.summary(ticking)["missed_beats"] == 0
    assert abs(ticking.energy["residual_relative"]) < 1e-9 and ticking.worst_penetration < 1e-9


def test_phases_are_where_the_construction_says(ticking):
    """Only half swings one way have phases; the tooth is let go and lets the impulse stone go at the angles of the drawing."""
    found = phases(ticking)
    assert {one.beat % 2 for one in found} == {found[0].beat % 2}
    unlocks = [one for one in found if one.name == "unlock"]
    pushes = [one for one in found if one.name == "impulse"]
    assert len(unlocks) >= 6 and {one.on for one in pushes} == {"balance"}
    for one in unlocks:
        assert math.degrees(one.turns[1]) == pytest.approx(-Detent().lock, abs=1e-3)
        assert math.degrees(one.angles[2] + one.turns[2]) == pytest.approx(Detent().letting_go, abs=2e-3)
    end = Detent().letting_go + 2.0 * POINTS.half_impulse - Detent().inside
    for one in pushes:
        assert math.degrees(one.angles[2] + one.turns[2]) == pytest.approx(end, abs=2e-3)
    for beat in shown_beats(ticking):
        assert abs(beat.residual) < 1e-7 * sum(stage.energy.supplied for stage in beat.stages)


def test_on_the_way_back_the_leaf_gives_way_alone(ticking):
    """The detent lies on its bank while the discharging stone bends the passing spring by some degrees."""
    t = np.linspace(2.0, 4.0, 200001)
    q, u = ticking.sample(t)
    detent, leaf, balance = (ticking.slices[name].start for name in ("detent", "passing", "balance"))
    back = u[:, balance] < 0.0
    assert math.degrees(q[back, leaf].max()) > 5.0
    # The leaf that springs back strikes the horn, and lifts the detent by next to nothing.
    assert np.degrees(np.abs(q[back, detent]).max()) < 0.01
    assert math.degrees(q[~back, detent].min()) == pytest.approx(-Detent().travel, abs=0.1)
    assert math.degrees(q[~back, leaf].max()) < 1.0


@pytest.mark.slow
def test_nearly_isochronous_and_set_by_where_the_tooth_is_let_go():
    """Airy: an impulse whose middle is θ̄ behind the middle of the swing loses 86400 θ̄ / (2 Q A) seconds a day."""
    cycles = [ws.steady(designs.detent(torque=f"{torque} µN·m").scene()) for torque in (20.0, 45.0, 60.0)]
    rates = [cycle.rate_s_per_d for cycle in cycles]
    assert cycles[0].amplitude_deg < 180.0 and cycles[-1].amplitude_deg > 310.0
    assert max(rates) - min(rates) < 0.15
    early = ws.steady(designs.detent(letting_go="-24.5 °").scene())
    airy = 86400.0 * 2.0 / (2.0 * Detent().q_factor * early.amplitude_deg)
    assert early.rate_s_per_d - rates[1] == pytest.approx(airy, rel=0.05)


def test_a_balance_that_swings_too_far_unlocks_twice():
    """Beyond a turn less the angle at which the stone meets the leaf it comes round to it again: the watch trips."""
    run = ws.simulate(designs.detent().scene().set("bodies.balance.angle", "-345°"), duration=4.0)
    assert ws.verdict(run).name == "trips" and ws.summary(run)["missed_beats"] > 0


def led(made: Shell, scene: ws.Scene) -> list[tuple[np.ndarray, np.ndarray]]:
    """Both impulses, by the drawn outlines alone; at wheel angle 0 a tooth is in the middle of the cylinder."""
    hands, half = Led(scene, "balance", {"TEETH"}, {"SHELL"}), made.values.tooth_width / 2.0
    right = made.left_lip - made.span
    ways = (
        (made.entry[0] - made.left_lip, made.entry[1] - made.left_lip + 2e-3, made.rests_outside),
        (made.exit[0] - right, made.exit[1] - right - 2e-3, made.rests_inside),
    )
    return [
        hands.impulse(math.radians(first), math.radians(last), -math.radians(rests + half) - 5e-4)
        for first, last, rests in ways
    ]


@pytest.mark.parametrize("chosen", few([{}, {"tooth_width": 9.5, "drop": 1.6, "lift": 34.0}], 1))
def test_led_by_hand_the_drops_are_those_chosen(chosen):
    """What two impulses leave of a pitch are the two drops."""
    values = design("cylinder").chosen(chosen)
    made = shell(values)
    scene = designs.cylinder(**{name: design("cylinder").dimension(name).shown(x) for name, x in chosen.items()}).scene()
    gone = [math.degrees(wheel[-1] - wheel[0]) for _, wheel in led(made, scene)]
    assert gone == pytest.approx(made.driven, abs=0.03)
    assert (made.pitch - sum(gone)) / 2.0 == pytest.approx(values.drop, abs=0.03)
    assert sum(made.lifts) / 2.0 == pytest.approx(values.lift, abs=1e-9)
    assert min(made.locks) == pytest.approx(values.lock, abs=1e-9)


@pytest.mark.slow
def test_amplitude_and_rate_as_airy_says():
    """A light wheel without friction: the drive's work is what damping takes; impulse after the middle loses.

    Neither knows the wheel's catching up and the impact when it has: 4 % of the work, 12 % of the rate.
    """
    torque, q_factor = 0.15e-6, Cylinder().q_factor
    drawn = designs.cylinder(friction=0.0, wheel_inertia="0.02 mg·cm²", torque=f"{1e6 * torque} µN·m")
    cycle = ws.steady(drawn.scene())
    stiffness = 1e-10 * Cylinder().balance_inertia * (math.pi * Cylinder().frequency / 3600.0) ** 2
    swing = math.radians(cycle.amplitude_deg)
    work, airy = work_and_rate(led(shell(Cylinder()), drawn.scene()), torque, stiffness, swing)
    assert math.pi * stiffness * swing**2 / q_factor == pytest.approx(work, rel=0.04)
    assert cycle.rate_s_per_d + DAY / (8.0 * q_factor**2) == pytest.approx(airy, rel=0.12)


def test_friction_at_rest_takes_what_coulomb_says():
    """A tooth at rest presses along the radius of the shell, which rubs along it: moments about the wheel's axis give N."""
    values = Cylinder(friction=0.15, torque=0.2)
    made, scene = shell(values), designs.cylinder(friction=0.15, torque="0.2 µN·m").scene()
    run = ws.simulate(scene, duration=0.2)
    contact = math.radians(made.rests_outside)
    point = 1e-3 * made.point_radius * np.array([-math.sin(contact), math.cos(contact)])
    normal = (1e3 * point - np.array(made.balance)) / made.outer
    arm = abs(normal[0] * point[1] - normal[1] * point[0])
    # The friction on the point, μ N along the shell, turns the wheel, too: it is with the drive or against it.
    along = np.array([-normal[1], normal[0]])
    lever = point[0] * along[1] - point[1] * along[0]
    t = np.linspace(0.01, 0.05, 21)
    forces = ws.forces(run, t)
    torque = values.torque * 1e-6
    expected = sorted(torque / (arm + sign * values.friction * lever) for sign in (1.0, -1.0))
    press = np.asarray(forces.normal).sum(axis=1)
    assert press.max() == pytest.approx(press.min(), rel=1e-3)
    assert min(abs(press[0] / one - 1.0) for one in expected) < 1e-3


def test_friction_lowers_amplitude_and_rate():
    """Frictional rest: the loss grows with the drive, so that twice the drive gives far less than √2 of the amplitude."""
    weak, strong = (ws.steady(designs.cylinder(torque=f"{torque} µN·m").scene()) for torque in (0.2, 0.4))
    assert 1.2 < strong.amplitude_deg / weak.amplitude_deg < 1.35
    assert abs(strong.rate_s_per_d - weak.rate_s_per_d) < 2.0
    rough = ws.steady(designs.cylinder(friction=0.15).scene())
    assert rough.amplitude_deg < strong.amplitude_deg - 25.0 and rough.rate_s_per_d < strong.rate_s_per_d


@pytest.fixture(scope="module")
def ticking_duplex() -> ws.Trajectory:
    return of_profile("duplex", 4.0)


def test_one_tooth_in_an_oscillation_and_a_dip_on_the_way_back(ticking_duplex):
    """Counter-clockwise the wheel goes on by a pitch; clockwise the tooth dips into the notch and is put back."""
    t = np.linspace(2.0, 4.0, 200001)
    q, u = ticking_duplex.sample(t)
    wheel, balance = (ticking_duplex.slices[name].start for name in ("wheel", "balance"))
    turns = np.flatnonzero(np.diff(np.sign(u[:, balance])))
    gone = -np.degrees(np.diff(q[turns, wheel]))
    way = np.sign(np.diff(q[turns, balance]))
    assert gone[way > 0] == pytest.approx(24.0, abs=1e-6)
    assert gone[way < 0] == pytest.approx(0.0, abs=1e-6)
    back = [np.degrees(q[a:b, wheel]) for a, b, one in zip(turns, turns[1:], way, strict=False) if one < 0]
    dips = [float(np.ptp(one)) for one in back]
    # No deeper than the notch is broad, along the circle of the points.
    points = DuplexPoints(Duplex())
    broad = math.degrees(2.0 * points.roller * math.sin(math.radians(Duplex().notch / 2.0)) / Duplex().tip_radius)
    assert all(0.1 < dip < broad for dip in dips)


def test_the_tooth_is_let_go_where_the_notch_says(ticking_duplex):
    """The tip leaves the notch on the right of the roller, as far from the line of centres as it came in on the left."""
    t = np.linspace(2.0, 2.4, 400001)
    q, u = ticking_duplex.sample(t)
    wheel, balance = (ticking_duplex.slices[name].start for name in ("wheel", "balance"))
    points = DuplexPoints(Duplex())
    at_rest = q[np.argmin(q[:, balance]), wheel]  # before the impulse the balance is far clockwise
    turned = np.degrees(at_rest - q[:, wheel])
    passing = (u[:, balance] > 0.0) & (turned < 2.0 * points.rests)
    last = np.flatnonzero(passing)[-1]
    assert math.degrees(q[last, balance]) == pytest.approx(Duplex().letting_go, abs=0.3)


@pytest.mark.slow
def test_its_rate_is_set_by_where_the_tooth_is_let_go():
    """Airy: what is given near the middle of a swing, and what is taken there on the way back, loses where it comes later.

    Both works together are k (A+² - A-²), from the turning points: between them the balance gains half of what is given and
    taken, the rest is damping. Shifted by δ the rate changes by 86400 δ (A+² - A-²) / (2 π A³).
    """
    rates, swings = [], []
    for at in (6.0, -2.0):
        scene = designs.duplex(letting_go=f"{at} °", friction=0.0, torque="2 µN·m").scene()
        rates.append(ws.steady(scene).rate_s_per_d)
        ends = ws.beats(ws.simulate(scene, duration=100.0)).end_at[-2:]
        swings.append((float(ends.max()), float(-ends.min())))
    (far, near), shift = np.mean(swings, axis=0), math.radians(8.0)
    airy = 86400.0 * shift * (far**2 - near**2) / (2.0 * math.pi * (0.5 * (far + near)) ** 3)
    assert rates[1] - rates[0] == pytest.approx(airy, rel=0.03)


def test_friction_at_rest_holds_the_amplitude_down():
    """Twice the drive gives less than √2 of the amplitude; the tooth presses the roller twice as hard."""
    weak, strong = (ws.steady(designs.duplex(torque=f"{torque} µN·m").scene()) for torque in (2.8, 5.6))
    assert 1.1 < strong.amplitude_deg / weak.amplitude_deg < 1.3


@pytest.mark.parametrize(
    "chosen",
    few([{}, {"lock": 2.5, "lift": 8.5, "drop": 3.4, "draw": 14.0}, {"teeth": 18, "pallet_pin": 0.2, "lift_angle": 46.0}], 1),
)
def test_led_by_hand_it_has_the_angles_chosen(chosen):
    """Lever and wheel are turned against each other along the drawn outlines, which knows nothing of the construction."""
    values = design("pin_pallet").chosen(chosen)
    scene = designs.pin_pallet(**{name: design("pin_pallet").dimension(name).shown(x) for name, x in chosen.items()}).scene()
    found = measure(scene)
    assert found.missing == () and found.pallets and found.fork and found.teeth == values.teeth
    for one in found.pallets:
        assert math.degrees(one.lock.value) == pytest.approx(values.lock, abs=1e-4)
        assert math.degrees(one.run.value) == pytest.approx(values.run, abs=1e-4)
        assert math.degrees(one.lift.value) == pytest.approx(values.lift, abs=1e-4)
        assert math.degrees(one.drop.value) == pytest.approx(values.drop, abs=1e-4)
        assert math.isnan(one.draw_end.value), "a corner rounds the pin as it unlocks"
    assert math.degrees(min(one.draw.value for one in found.pallets)) == pytest.approx(values.draw, abs=1e-4)
    for one in found.fork.lift_angle:
        assert math.degrees(one.value) == pytest.approx(values.lift_angle, abs=1e-3)
    assert [one.code for one in judgements(scene, found) if one.severity == "warning"] == []


def test_the_amplitude_goes_as_the_root_of_the_drive():
    """Free but for the lift: A ∝ √T, were there no losses that grow less than the drive; and a weaker drive loses more."""
    weak, strong = (ws.steady(designs.pin_pallet(torque=f"{torque} µN·m").scene()) for torque in (1.4, 2.8))
    assert strong.amplitude_deg / weak.amplitude_deg == pytest.approx(math.sqrt(2.0), rel=0.01)
    assert weak.rate_s_per_d < strong.rate_s_per_d < 0.0


def test_without_draw_friction_holds_the_lever_where_it_is():
    with pytest.raises(ws.SceneError, match=r"does not hold at a friction of 0\.25"):
        designs.pin_pallet(friction=0.25)


def test_the_drop_that_is_asked_for_is_just_enough():
    """Then the wheel can be turned back by next to nothing as a pin is about to be unlocked."""
    (conflict,) = design("pin_pallet").refusals({"drop": 1.5})
    needed = float(conflict.message.split("must be at least ")[1].split("°")[0])
    enough = measure(designs.pin_pallet(drop=f"{needed + 0.01} °").scene())
    assert enough.pallets is not None
    assert 0.0 <= min(math.degrees(one.shake.value) for one in enough.pallets) < 0.2


OFF = "5 µm"  # of the balance's centre of mass
TURN = 60.0  # s


def tourbillon(off: str = OFF) -> Scene:
    return ws.load(ws.profiles_dir() / "tourbillon").set("design.poise_error", off)


def upright(position: float, off: str = OFF) -> Scene:
    """The same watch without a carriage, whose inertia its wheel feels through the gears; turned by `position` (rad)."""
    carriage = 37.0544949e-10  # kg·m², what `watchsim check` shows as felt there with all that is geared to it
    scene = ws.designs.swiss_lever().scene().set("bodies.wheel.inertia", f"{carriage / 16**2!r} kg·m²")
    scene = scene.set("bodies.balance.mass", "50 mg").set("bodies.balance.centre_of_mass", [off, "0 mm"])
    g = (9.81 * math.sin(position), -9.81 * math.cos(position))
    return scene.set("scene.gravity", [f"{part!r} m/s²" for part in g])


def rate(scene: Scene, duration: float, over: float) -> float:
    """Mean over the last `over` seconds, s/d; an even number of beats."""
    rates = np.array(ws.beats(ws.simulate(scene, duration=duration + 0.2, record="events")).rate_s_per_d)
    return float(rates[-round(8 * over) - 1 : -1].mean())


def test_the_carriage_turns_by_a_sixteenth_of_what_its_wheel_turns_against_it() -> None:
    scene = tourbillon()
    run = ws.simulate(scene, duration=7.5)
    carriage, wheel = (run.end_q[run.slices[name]][0] for name in ("carriage", "wheel"))
    start = scene.body("wheel").angle
    assert wheel - start == pytest.approx(16.0 * carriage, abs=1e-12)
    assert math.degrees(carriage) == pytest.approx(-45.0, abs=0.4)  # a tooth is 1.5° of the carriage
    assert run.energy["residual_relative"] < 1e-9
    assert ws.verdict(run).name == "ticks"


def test_the_other_method_agrees_at_its_order() -> None:
    scene = tourbillon()
    exact = ws.simulate(scene, duration=0.3)
    ends = [ws.simulate(scene, duration=0.3, method="moreau", step=h).end_q for h in (1e-5, 2.5e-6)]
    column = exact.slices["balance"].start
    errors = [abs(end[column] - exact.end_q[column]) for end in ends]
    assert errors[1] < 0.6 * errors[0]
    assert errors[1] < 1e-2


@pytest.mark.parametrize("changed", [{"ratio": 8, "frequency": "21600 vph"}, {"teeth": 20, "lever_to_balance": "5 mm"}])
def test_others_turn_too(changed: dict[str, object]) -> None:
    made = ws.designs.tourbillon(**changed)
    run = ws.simulate(made.scene(), duration=1.0)
    ratio, teeth = made.values.ratio, made.values.teeth
    beats = made.values.frequency / 3600.0
    carriage = run.end_q[run.slices["carriage"].start]
    assert ws.summary(run)["missed_beats"] == 0
    assert carriage == pytest.approx(-beats * math.pi / teeth / ratio, abs=1.5 * math.pi / teeth / ratio)


def test_the_carriage_is_poised() -> None:
    """Masses of all but the balance, in the drawing at rest, about the axis."""
    scene = ws.designs.tourbillon().scene()
    moment = sum(scene.body(name).mass * scene.body(name).position[1] for name in ("wheel", "lever"))
    carriage = scene.body("carriage")
    assert carriage.mass * carriage.centre_of_mass[1] == pytest.approx(-moment, rel=1e-12)


@pytest.mark.slow
def test_the_rate_over_a_turn_is_the_mean_of_the_positions() -> None:
    """Within 1 % of their spread; of that, nearly all is there without a poise error, from the turning of the stud."""
    positions = [rate(upright(k * math.pi / 4.0), 120.0, TURN) for k in range(8)]
    spread = max(positions) - min(positions)
    turned = rate(tourbillon(), 180.0, TURN)
    assert spread == pytest.approx(33.25, abs=0.1)
    assert turned == pytest.approx(np.mean(positions), abs=0.01 * spread)
    without = rate(tourbillon("0 µm"), 180.0, TURN) - rate(upright(0.0, "0 µm"), 120.0, TURN)
    assert turned - np.mean(positions) == pytest.approx(without, abs=1e-3 * spread)


PITCH = 2.0 * np.pi / 15


@pytest.fixture(scope="module")
def short() -> Trajectory:
    scene = ws.load(ws.profiles_dir() / "swiss_lever" / "scene.toml")
    return ws.simulate(scene, duration=3.0)


def half_swings(run: Trajectory) -> int:
    return int(np.count_nonzero(run.events["kind"] == EventKind.CROSS))


def check_running_swiss_lever(run: Trajectory) -> None:
    """One half pitch per half swing; nothing but teeth, stones, fork, pin and banking ever touches."""
    assert run.stop.name == "DURATION"
    advance = (run.q[0, 0] - run.q[-1, 0]) / (0.5 * PITCH)
    assert abs(advance - half_swings(run)) < 1.0
    touched = {run.pairs[k].group for k in run.events["contact"] if k >= 0}
    safety = next(i for i, c in enumerate(run.scene.contacts) if "SAFETY" in {side.layer for side in c.sides})
    assert touched == set(range(len(run.scene.contacts))) - {safety}
    assert run.worst_penetration < 1e-9
    assert abs(run.energy["residual_relative"]) < 1e-8


def test_it_ticks(short: Trajectory) -> None:
    check_running_swiss_lever(short)
    assert half_swings(short) == 24


def test_locked_parts_stand_still_between_beats(short: Trajectory) -> None:
    """While the balance swings freely the wheel and the lever do not move by a single bit."""
    quiet = (short.t > 1.10) & (short.t < 1.17)
    assert np.count_nonzero(quiet) > 10
    for column in (0, 1):
        assert np.ptp(short.q[quiet, column]) == 0.0


@pytest.mark.slow
def test_three_minutes_of_steady_running() -> None:
    """The amplitude comes to its steady value with a time constant of some 10 s: after 40 s 0.1° are still missing."""
    scene = ws.load(ws.profiles_dir() / "swiss_lever" / "scene.toml")
    run = ws.simulate(scene, duration=180.0, record=((0.0, 0.1), (179.0, 180.0)))
    check_running_swiss_lever(run)
    turns = np.abs(np.degrees(run.events["value"][run.events["kind"] == EventKind.TURN]))
    assert 250.0 < turns[-16:].mean() < 310.0
    assert abs(turns[-16:].mean() - turns[-160:-144].mean()) < 1e-4
