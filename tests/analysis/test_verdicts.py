"""Is a watch that fails told from one that ticks, and is it said how it fails?"""

import cmath
import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import (
    DEGREE,
    PERIOD,
    Events,
    balance_only,
    chipped,
    knocked,
    lever_run,
    lever_scene,
    polygon,
    renamed,
    star,
    swiss,
    toothless,
    turned_over,
    unguarded,
)
from escapement.made import one_faced_anchor
from every_time import few
from profiles.running import polygon as outline
from scipy.integrate import quad
from scipy.optimize import brentq
from shapely import affinity

import watchsim as ws
from watchsim.analysis.summary import summary
from watchsim.analysis.timing import beats
from watchsim.analysis.verdict import overbanking, unsettled, verdict
from watchsim.analysis.verdict_kinds import Verdict
from watchsim.analysis.watch import arms, at_lever, face, in_force, unlocked, watch_of
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.lean import Teeth, teeth
from watchsim.scene.load import load
from watchsim.scene.roles import pitch, roles
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

# Is a watch that fails told from one that ticks, and is it said how it fails?

STRONG = "-10 µN·m"

# What fails, how long it takes to show, and what is said: name, body, words of the pair, drive (N·m), words of the message.
FAULTS = {
    "too strong": (
        *(swiss(torques_0_value=STRONG), 3.0, "knocks", "balance", ("PIN", "FORK"), 1e-5),
        ("strikes lever from outside at 338°", "gallops"),
    ),
    "reversed": (
        *(swiss(torques_0_value="1 µN·m"), 3.0, "backwards", "wheel", ("TEETH", "STONES"), 1e-6),
        ("against the lean of its teeth",),
    ),
    "shallow lock": (
        *(swiss(bodies_wheel_position_1="-0.04 mm"), 3.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("impulse face", "while balance is away"),
    ),
    "a tooth gone": (
        *(toothless(unguarded(swiss()), 7), 3.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("ran past lever",),
    ),
    "a locking chipped": (
        *(chipped(swiss(), 7, 1e-4), 6.0, "trips", "wheel", ("TEETH", "STONES"), 1e-6),
        ("tooth 8 rests on",),
    ),
    "no guard pin": (
        *(knocked(unguarded(swiss()), 2.05, -2e-6), 4.0, "overbanks", "lever", ("PIN", "FORK"), 1e-6),
        ("t = 2.05", "from outside at −21.8°", "guard pin"),
    ),
    "set on lock": (
        *(swiss(torques_0_value="-20 µN·m", bodies_balance_angle="-30°"), 2.0, "stops", "wheel", ("TEETH", "STONES"), 2e-5),
        ("tooth 6 rests on the entry locking face", "1.6 µN·m, is below the 4.3 µN·m needed to unlock"),
    ),
}
DRY = replace(swiss(contacts_0_friction="0.6"), damping=(*swiss().damping, Damping("balance", coulomb=5e-8)))
FAULTS["set on impulse"] = (
    *(DRY, 7.0, "stops", "wheel", ("TEETH", "STONES"), 1e-6),
    ("on the exit impulse face", "is below the 2 µN·m needed to move balance (set on impulse). Last amplitude 24.5°"),
)


def judged(scene: Scene, duration: float) -> Verdict:
    return verdict(simulate(scene, duration))


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_recognised_and_named(fault):
    scene, duration, name, body, layers, drive, words = FAULTS[fault]
    found = judged(scene, duration)
    assert (found.name, found.body) == (name, body) and not found.works
    assert all(layer in found.pair for layer in layers) and abs(found.torque) == pytest.approx(drive)
    assert 0.0 <= found.t <= duration
    assert all(part in found.message for part in words), found.message


@pytest.mark.parametrize("fault", few(FAULTS, 4))
def test_in_a_mirror_and_under_other_names_it_is_the_same_fault(fault):
    scene, duration, name, body, _, drive, _ = FAULTS[fault]
    found = judged(renamed(turned_over(scene)), duration)
    assert (found.name, found.body) == (name, {"wheel": "rad", "lever": "anker", "balance": "unruh"}[body])
    assert abs(found.torque) == pytest.approx(drive) and "anker" in found.message


def test_a_wheel_that_races_past_a_lever_that_went_over_is_said_to_race():
    """Its teeth are out of reach of the stones."""
    run = simulate(knocked(unguarded(swiss(bodies_wheel_position_1="-0.3 mm")), 0.05, 2e-6), 1.0)
    found = verdict(run)
    assert found.name == "overbanks" and found.body == "lever"
    assert "wheel runs through" in found.message and "is not unlocked" not in found.message
    assert summary(run)["efficiency"] is None and "nothing locks wheel" in summary(run)["timing_message"]


def test_a_wheel_that_runs_through_when_unlocked_is_said_to_be_locked_between():
    """The spring of a detent is too weak to bring it back before several teeth are past."""
    scene = load(profiles_dir() / "detent").set("springs.1.stiffness", "4e-06 N·m/rad")
    assert scene.springs[1].body == "detent"
    run = simulate(scene, 3.0, to_the_end=False)
    found, numbers = verdict(run), summary(run)
    whole = float(re.search(r"of the last (\S+) s", found.message)[1])
    times = np.linspace(run.simulated - whole, run.simulated, 100_001)
    turned = np.abs(np.diff(np.interp(times, run.t, run.q[:, run.slices["wheel"].start])))
    share = 100.0 * (turned < 1e-6).mean()  # 15 µs each: at the speed of a tooth that is let go it is more than 1e-4
    assert found.name == "trips" and "nothing locks" not in found.message + numbers["timing_message"]
    assert float(re.search(r"for (\d+) % of", found.message)[1]) == pytest.approx(share, abs=2.0) and 10.0 < share < 90.0


# Is a swing that ends with a blow distinguished from one that ends by itself?


def blocked(scene: Scene, angle: float) -> bool:
    """Do the outlines of pendulum and wheel overlap with the pendulum at that angle (rad), wherever the wheel stands?"""
    wheel, pendulum = (
        affinity.translate(outline(scene, name, {layer}), *scene.body(name).position)
        for name, layer in (("wheel", "TEETH"), ("pendulum", "PALLETS"))
    )
    held = affinity.rotate(pendulum, angle, scene.body("pendulum").position, use_radians=True)
    turned = np.linspace(0.0, pitch(scene, "wheel"), 400)
    return all(affinity.rotate(wheel, way, scene.body("wheel").position, use_radians=True).intersects(held) for way in turned)


@pytest.mark.parametrize("drive", ["-25 mN·m", "-40 mN·m"])
@pytest.mark.parametrize("restitution", ["0", "0.3"])
def test_a_swing_that_ends_on_the_wheel_is_no_tick(drive, restitution):
    """Too strong a drive swings a clock's anchor out until the corner of a pallet is at the bottom of the teeth."""
    scene = load(profiles_dir() / "graham").set("torques.0.value", drive).set("contacts.0.restitution", restitution)
    run = simulate(scene, 20.0)
    found = verdict(run)
    assert (found.name, found.body, found.works) == ("knocks", "pendulum", False)
    assert "pendulum strikes wheel at 9.88°, which ends its swing" in found.message and "wheel.TEETH arc" in found.pair
    assert "the clock gallops" in found.message and f"{found.count} times in" in found.message
    reached = min(beats(run).end_at[-2:], key=abs)  # the other side swings freely, a little further
    beyond = math.copysign(math.radians(0.05), reached)
    assert blocked(scene, reached + beyond) and not blocked(scene, reached - beyond)
    assert "30 of its 60 half swings end with a blow" in ws.steady(scene).message


@pytest.mark.parametrize("duration", [29.0, 29.5, 30.0])
def test_a_blow_knocks_though_rounding_puts_the_turn_after_it(duration, tmp_path):
    """A tooth between pallet and wheel ends every second swing, some of these 1e-14 s before the anchor turns round; in the
    window judged swings are even or odd in number."""
    run = simulate(one_faced_anchor(tmp_path)[0].set("torques.0.value", "-0.7 mN·m"), duration)
    found, turned = verdict(run), run.events[(run.events["kind"] == EventKind.TURN) & (run.events["body"] == 1)]["t"]
    blows = run.events[run.events["kind"] == EventKind.IMPACT]["t"]
    waits = np.array([(t - blows[blows <= t]).min(initial=1.0) for t in turned.tolist()])
    assert ((waits > 0.0) & (waits < 1e-12)).any()
    assert (found.name, found.body) == ("knocks", "pendulum")
    assert found.count == pytest.approx((waits < 1e-12).sum(), abs=1)


def test_a_swing_that_ends_by_itself_is_none():
    """As far out, with less drive, before it has come to the bottom of the teeth."""
    scene = load(profiles_dir() / "graham").set("torques.0.value", "-25 mN·m")
    assert judged(scene, 12.0).name == "unsettled"
    assert ws.steady(load(profiles_dir() / "graham")).message == ""


def test_a_balance_at_rest_beside_the_fork_is_named():
    """Its spring holds it at 90°, where its pin is far from the fork."""
    scene = swiss(springs_0_rest="90°", bodies_balance_angle="90°", bodies_balance_velocity="0 °/s")
    found = judged(scene, 3.0)
    assert found.name == "stops" and "rests on" in found.message
    assert "balance is at rest at 0° and does not touch lever" in found.message


def test_a_guard_pin_keeps_the_lever_from_going_over():
    """The same knock on the lever with the dart in place."""
    assert judged(knocked(swiss(), 2.05, -2e-6), 4.0).name == "unsettled"


def test_the_first_strike_from_outside_shows_that_it_overbanks():
    """Before it the same half swing saw the pin inside the fork, with the lever on its way to the banking."""
    run = simulate(knocked(unguarded(swiss()), 2.05, -2e-6), 4.0)
    struck = replace(run, events=run.events[run.events["t"] < 2.1])
    found = overbanking(watch_of(struck, beats(run)))
    assert found is not None and found.t == pytest.approx(2.05, abs=1e-3) and "outside at −21.8°" in found.message
    before = replace(run, events=run.events[run.events["t"] < 2.05])
    assert overbanking(watch_of(before, beats(run))) is None


def test_a_watch_that_ticks_and_one_that_will():
    run = simulate(swiss(), 40.0)
    early = simulate(swiss(), 3.0)
    assert verdict(run).name == "ticks" and verdict(run).message == "the watch ticks"
    told = verdict(early)
    assert told.name == "unsettled" and told.works and "on its way to about 279°" in told.message
    assert beats(run).amplitude_deg[-1] == pytest.approx(279.2, abs=0.3)
    assert "too few" in judged(swiss(), 0.5).message


def test_knocks_of_the_past_are_mentioned_not_judged():
    """Started too far, a light drive: it knocks until its swing has died down."""
    scene = swiss(torques_0_value="-0.5 µN·m", bodies_balance_velocity="-7000 °/s")
    found = judged(scene.set("damping.0.q_factor", 60.0), 20.0)
    assert found.name == "ticks" and "after it knocked until t = " in found.message


@pytest.mark.parametrize("share", [0.995, 1.005])
def test_the_torque_needed_to_unlock_is_where_it_unlocks(share):
    """From rest on the lock, the simulation moves the lever just below the drive at which statics says that the torques are
    equal, and leaves it alone just above."""
    held = simulate(swiss(torques_0_value="-20 µN·m", bodies_balance_angle="-30°"), 2.0)
    watch = watch_of(held, beats(held))
    sides = {number: {held.pairs[number].body_a, held.pairs[number].body_b} for number in in_force(held, [2.0])[0]}
    tooth, pin = (next(k for k, both in sides.items() if both == {other, "lever"}) for other in ("wheel", "balance"))
    found = arms(held, watch.compiled, 2.0, [tooth, pin])
    out = face(watch, found, 0).out
    given, needed = at_lever(found, 1, "balance", "lever", out), at_lever(found, 0, "wheel", "lever", out)
    assert given == pytest.approx(1.60e-6, rel=0.01) and needed == pytest.approx(-4.28e-6, rel=0.01)
    equal = 20.0 * given / -needed
    angles = {body: f"{float(held.end[0][held.slices[body].start])!r} rad" for body in ("wheel", "lever", "balance")}
    start = {f"bodies_{body}_angle": angle for body, angle in angles.items()}
    run = simulate(swiss(torques_0_value=f"{-share * equal} µN·m", **start), 0.05)
    lever = np.degrees(run.q[:, run.slices["lever"].start])
    assert (abs(lever - lever[0]).max() > 0.001) == (share < 1.0)


def test_without_rows_events_alone_say_that_it_knocks():
    run = simulate(swiss(torques_0_value=STRONG), 5.0, record="statistics")
    assert verdict(run).name == "knocks"


def test_the_last_rows_that_were_kept_say_that_nothing_locks():
    scene = swiss(bodies_wheel_position_1="-0.04 mm")
    assert verdict(simulate(scene, 4.0, record=[(1.0, 1.5)])).name == "trips"


def test_a_lever_without_banking_need_not_lock():
    run = simulate(swiss(bodies_wheel_position_1="-0.04 mm"), 3.0)
    free = replace(run.scene, contacts=tuple(one for one in run.scene.contacts if all(s.body != "banking" for s in one.sides)))
    watch = watch_of(replace(run, scene=free), beats(run))
    assert unlocked(watch_of(run, beats(run))) and not unlocked(watch)


def test_a_wheel_that_the_balance_drives_back_runs_backwards():
    """A drive of next to nothing, a lever that pushes: made by hand, since real wheels are held by their lever."""
    run = lever_run(40)
    back = replace(run, q=run.q * np.array([1.0, 1.0, -1.0]))
    found = verdict(back)
    assert found.name == "backwards" and "against its drive of 1 µN·m" in found.message
    idle = replace(back.scene, torques=tuple(replace(one, value=0.0) for one in back.scene.torques))
    assert verdict(replace(run, scene=idle)).message.endswith("and nothing drives it")


def test_the_wheel_is_the_body_whose_lever_meets_the_balance():
    """Whatever torque is listed first."""
    shaken = knocked(swiss(), 2.05, -2e-6)
    assert roles(replace(shaken, torques=shaken.torques[::-1])) == roles(swiss())


def test_made_runs_have_no_shapes_to_ask():
    assert verdict(lever_run(40)).name == "ticks"
    stands = verdict(lever_run(20, missed=range(10, 20)))
    assert stands.name == "stops" and "the escape wheel has stood still since t = 1.19" in stands.message


def pendulum() -> Scene:
    bob = Body("bob", angle=0.1, mass=1.0, inertia=1.0, centre_of_mass=(0.0, -1.0))
    return Scene("pendulum", (bob,), gravity=(0.0, -9.81))


def driven_spring() -> Scene:
    """A motor beside a flywheel on a spring: nothing lies between them."""
    bodies = (Body("motor", inertia=1e-9), Body("fly", inertia=1e-9, angle=1.0))
    return Scene("no escapement", bodies, (Spring("fly", 1e-6),), (Torque("motor", 1e-9),))


@pytest.mark.parametrize(
    "scene", [load(profiles_dir() / "balance"), load(profiles_dir() / "incline"), pendulum(), driven_spring()]
)
def test_what_is_no_watch_has_no_verdict(scene):
    found = judged(scene, 1.0)
    assert found.name is None and found.message is None and found.works


@pytest.mark.parametrize("profile", ["bench_lever", "carriage"])
def test_other_watches_tick(profile):
    assert judged(replace(load(profiles_dir() / profile), expect=()), 6.0).works


# Is it foretold where the amplitude settles?


def swung(amplitude, count=160):
    return told(amplitude, count)[1]


def told(amplitude, count=160):
    """Half swings of amplitude(t) degrees, and what is said of them."""
    events = Events()
    for k in range(count):
        way = 1.0 if k % 2 == 0 else -1.0
        middle, end = (k + 0.5) * 0.5 * PERIOD, (k + 1) * 0.5 * PERIOD
        events.passage(middle, EventKind.CROSS, way)
        events.passage(end, EventKind.TURN, way * amplitude(end) * DEGREE)
    run = balance_only(events, count * 0.5 * PERIOD)
    return run, unsettled(watch_of(run, beats(run)))


@pytest.mark.parametrize(("start", "goal", "constant"), [(200.0, 280.0, 8.0), (300.0, 260.0, 20.0), (100.0, 240.0, 5.0)])
def test_an_exponential_is_followed_to_its_end(start, goal, constant):
    said = swung(lambda t: goal + (start - goal) * math.exp(-t / constant))
    word = "rises" if goal > start else "falls"
    assert said.name == "unsettled" and said.works and word in said.message
    told = float(said.message.split("about ")[1].split("°")[0])
    assert told == pytest.approx(goal, abs=0.6)


def test_what_has_settled_has_settled():
    assert swung(lambda t: 280.0 + 80.0 * math.exp(-t / 2.0)) is None
    assert swung(lambda t: 280.0) is None


def test_a_wheel_out_of_round_is_no_drift():
    """Fifteen oscillations to a turn: the amplitude goes up and down for ever."""
    assert swung(lambda t: 280.0 + 2.0 * math.sin(math.tau * t / (15.0 * PERIOD)), 480) is None


def test_chance_is_no_drift():
    rng = np.random.default_rng(3)
    assert sum(swung(lambda t: 280.0 + rng.normal(0.0, 1.0)) is not None for _ in range(40)) <= 2


def test_a_steady_loss_has_no_end_foretold():
    said = swung(lambda t: 280.0 - 3.0 * t)
    assert "falls by 3° per second" in said.message and "on its way" not in said.message


@pytest.mark.parametrize(("start", "goal", "said"), [(2.0, 2.12, "about 2.12°"), (200.0, 280.0, "about 280°")])
def test_where_it_goes_is_said_as_exactly_as_it_differs(start, goal, said):
    found = swung(lambda t: goal + (start - goal) * math.exp(-t / 8.0), 80)
    assert said in found.message, found.message


def test_a_drift_counts_beyond_three_standard_errors():
    """Told by a regression of another make: of means over an oscillation about the straight line through each stretch."""
    known, noise = {}, np.random.default_rng(5).normal(0.0, 1.0, 161)
    for scatter in np.linspace(1.5, 5.0, 36):
        run, said = told(lambda t, by=scatter: 280.0 - 0.02 * t * t + by * noise[round(2.0 * t / PERIOD)])
        stretches = np.split(beats(run).amplitude_deg[-120:].reshape(-1, 2).mean(axis=1), 3)
        off = np.concatenate([part - np.polyval(np.polyfit(range(20), part, 1), range(20)) for part in stretches])
        error = math.sqrt(2.0 / 20.0 * np.mean(off**2))
        known[abs(stretches[2].mean() - stretches[1].mean()) / error] = said is not None
    assert [drifts for errors, drifts in known.items() if 2.4 < errors < 3.0].count(False) > 2
    assert [drifts for errors, drifts in known.items() if 3.0 < errors < 3.6].count(True) > 2
    assert all(drifts == (errors > 3.0) for errors, drifts in known.items())


# Is it seen which way teeth are made to turn?


def with_rim(*loops):
    scene = lever_scene()
    return replace(scene, bodies=tuple(replace(one, loops=loops) if one.name == "wheel" else one for one in scene.bodies))


def leaning(lean: float, count: int = 15, turned: float = 0.0):
    """Pointed teeth, rim 2.4 and root 1.9 mm, whose points stand `lean` (of the pitch) anticlockwise of their middle."""
    pitch = math.tau / count
    points = []
    for k in range(count):
        for radius, at in ((1.9e-3, -0.4), (2.4e-3, lean), (1.9e-3, 0.4)):
            angle = turned + (k + at) * pitch
            points.append(radius * complex(math.cos(angle), math.sin(angle)))
    return polygon(points)


@pytest.mark.parametrize("lean", [-0.35, -0.1, 0.1, 0.35])
@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_pointed_teeth(lean, turned):
    """At a share h of their height the middle of the teeth is at lean · h: half the lean lies between the halves, or less."""
    found = teeth(with_rim(leaning(lean, turned=turned)), "wheel")
    assert found.direction == math.copysign(1.0, lean)
    assert 0.25 * abs(lean) < abs(found.lean) / found.pitch < 0.6 * abs(lean)


def test_upright_teeth_are_made_for_no_direction():
    assert teeth(with_rim(leaning(0.0)), "wheel").direction == 0.0


def test_wheels_of_the_profiles_turn_as_their_teeth_lean():
    for name in ("swiss_lever", "bench_lever"):
        scene = load(profiles_dir() / name)
        assert teeth(scene, "wheel").direction == -1.0
        assert teeth(turned_over(scene), "wheel").direction == 1.0


def test_a_plain_disc_has_no_teeth():
    assert teeth(with_rim(polygon([1e-3 * complex(math.cos(t), math.sin(t)) for t in (0.0, 2.0, 4.5)])), "wheel") is None


def test_teeth_too_shallow_for_an_inner_half_lean_neither_way():
    """Corners of a polygon are teeth, 1 - cos 12° = 0.022 of its rim deep; the inner half begins at 0.4 · 24° / 2 = 0.084."""
    corners = [2e-3 * cmath.rect(1.0, k * math.tau / 15) for k in range(15)]
    scene = with_rim(polygon(corners))
    assert pitch(scene, "wheel") == pytest.approx(math.tau / 15, rel=1e-12)
    assert teeth(scene, "wheel") is None


def test_teeth_are_counted_anticlockwise_from_the_x_axis():
    found = teeth(with_rim(star(15)), "wheel")
    numbers = [found.number(k * math.tau / 15 + 0.02) for k in range(-1, 16)]
    assert numbers == [15, *range(1, 16), 1]
    swiss_teeth = teeth(swiss(), "wheel")
    assert [swiss_teeth.number(math.radians(angle)) for angle in (0.0, 4.0, 24.1, -24.0, 360.0)] == [1, 1, 2, 15, 1]


def phase(lean: float, low: float, high: float) -> float:
    """Of ∫∫ exp(i Z φ) dφ dr over the tooth of `leaning` at angle 0, between two radii (m)."""
    pitch = math.tau / 15

    def flank(at: float, radius: float) -> float:
        foot, tip = cmath.rect(1.9e-3, at * pitch), cmath.rect(2.4e-3, lean * pitch)
        share = brentq(lambda part: abs(foot + part * (tip - foot)) - radius, 0.0, 1.0, xtol=1e-15) if radius < 2.4e-3 else 1.0
        return cmath.phase(foot + share * (tip - foot))

    def across(radius: float, part: Callable[[float], float]) -> float:
        mean = quad(lambda angle: part(15 * angle), flank(-0.4, radius), flank(0.4, radius))
        return float(mean[0])

    real, imag = (quad(across, low, high, args=(part,))[0] for part in (math.cos, math.sin))
    return math.atan2(imag, real)


@pytest.mark.parametrize("lean", [-0.3, 0.12])
@pytest.mark.parametrize("turned", [0.0, 0.05])
@pytest.mark.parametrize("further", [False, True])
def test_the_middle_of_two_halves_of_a_tooth(lean, turned, further):
    """Down to 0.4 of the pitch at the rim. A smaller toothed outline beside it lies below that."""
    outlines = [leaning(lean, turned=turned), *([star(15, 1.1e-3, 0.9e-3)] if further else [])]
    found = teeth(with_rim(*outlines), "wheel")
    depth = 0.4 * math.tau / 15 * 2.4e-3
    outer, inner = phase(lean, 2.4e-3 - 0.5 * depth, 2.4e-3), phase(lean, 2.4e-3 - depth, 2.4e-3 - 0.5 * depth)
    assert found.pitch == pytest.approx(math.tau / 15, rel=1e-12)
    assert found.lean == pytest.approx((outer - inner) / 15, rel=2e-4)
    assert found.first == pytest.approx(outer / 15 + turned, rel=2e-4)


@pytest.mark.parametrize(("lean", "way"), [(0.019, 0.0), (-0.019, 0.0), (0.021, 1.0), (-0.021, -1.0)])
def test_a_fiftieth_of_the_pitch_is_a_lean(lean, way):
    assert Teeth(0.4, lean * 0.4, 0.1).direction == way


@pytest.mark.parametrize("count", [7, 15])
@pytest.mark.parametrize("first", [0.01, -0.11, 0.9, 3.0])
def test_each_tooth_has_a_number(count, first):
    """The one nearest to the x axis is the first, whichever of them was looked at; up to half a pitch off it is still that."""
    pitch = math.tau / count
    middles = sorted((first + k * pitch for k in range(count)), key=lambda angle: abs(math.remainder(angle, math.tau)))
    for k in range(-3, 2 * count):
        for off in (-0.49, 0.2, 0.49):
            assert Teeth(pitch, 0.1, first).number(middles[0] + (k + off) * pitch) == k % count + 1
    assert Teeth(pitch, 0.1, first).count == count
