"""Do bodies carried by others, and planets with play, move as closed forms, conserved quantities and other algorithms say?"""

import dataclasses
import functools
import math
from pathlib import Path

import numpy as np
import pytest
from moving_scenes import box, circle, of_kind, profile, touching
from reference import pendulum
from scene.made_gears import read
from scipy.optimize import brentq, minimize_scalar

import watchsim as ws
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# Do bodies carried by others move as closed forms, conserved quantities and other algorithms say?

CARRIAGE, MASS, ARM, DISC, STIFF = 3e-9, 2e-5, 4e-3, 1.2e-9, 7.58e-7
JOINED = CARRIAGE + MASS * ARM**2
HEAVY = 1e3  # kg·m²: nothing slows it down
NANOMETRE = 1e-9


def balance(on: str = "carriage", **more: object) -> Body:
    given = {"mass": MASS, "inertia": DISC, "on": on, **more}
    return Body("balance", "pivot", (ARM, 0.0), 2.0, (0.0,), **given)


def carriage(speed: float = 0.0, inertia: float = CARRIAGE) -> Body:
    return Body("carriage", "pivot", (1e-3, 2e-3), 0.3, (speed,), inertia=inertia)


def escapement(holder: Body, heavy_parts: bool = True) -> Scene:
    """The whole bench lever on a carriage; its wheel, lever and balance weigh something where asked."""
    scene = profile("bench_lever")
    mass = 1e-5 if heavy_parts else 0.0
    on = tuple(dataclasses.replace(body, on=holder.name, mass=mass) for body in scene.bodies)
    return dataclasses.replace(scene, bodies=(*on, holder))


@functools.cache
def bench(duration: float) -> Trajectory:
    return simulate(profile("bench_lever"), duration)


def test_two_discs_swing_at_their_own_frequency() -> None:
    """A sprung balance on a free carriage: w² = k (1/J + 1/(J_c + m r²)), and the carriage the other way by its share."""
    scene = Scene("two discs", (balance(), carriage()), springs=(Spring("balance", STIFF, 0.1),))
    done = simulate(scene, 1.0)
    w = math.sqrt(STIFF * (1.0 / DISC + 1.0 / JOINED))
    relative = 0.1 + 1.9 * np.cos(w * done.t)
    assert done.q[:, 0] == pytest.approx(relative, abs=2e-8)
    assert done.q[:, 1] == pytest.approx(0.3 - DISC * (relative - 2.0) / (JOINED + DISC), abs=2e-8)
    assert abs(done.energy["residual_J"]) < 1e-8 * STIFF
    turns, passages = of_kind(done, EventKind.TURN), of_kind(done, EventKind.CROSS)
    assert [turn["t"] for turn in turns] == pytest.approx([math.pi / w * (i + 1) for i in range(len(turns))], abs=1e-9)
    assert [turn["value"] for turn in turns[:2]] == pytest.approx([-1.8, 2.0], abs=1e-8)
    assert [one["t"] for one in passages] == pytest.approx([math.pi / w * (i + 0.5) for i in range(len(passages))], abs=1e-9)


@pytest.mark.parametrize("quality", [math.inf, 20.0])
def test_a_carriage_that_turns_evenly_changes_nothing(quality: float) -> None:
    """A poised balance feels no turning: against the carriage it swings as on a plate at rest."""
    viscous = math.sqrt(STIFF * DISC) / quality
    forces = {"springs": (Spring("balance", STIFF, 0.1),), "damping": (Damping("balance", viscous),) if viscous else ()}
    turning = simulate(Scene("turning", (balance(), carriage(50.0, HEAVY)), **forces), 1.0)
    decay = 0.5 * viscous / DISC
    w = math.sqrt(STIFF / DISC - decay**2)
    swing = np.exp(-decay * turning.t) * (np.cos(w * turning.t) + decay / w * np.sin(w * turning.t))
    assert turning.q[:, 0] == pytest.approx(0.1 + 1.9 * swing, abs=3e-8)
    assert turning.u[:, 1] == pytest.approx(50.0, rel=1e-9)


@pytest.mark.parametrize("rigid", [False, True])
def test_a_carriage_swings_as_a_pendulum(rigid: bool) -> None:
    """The weight of what it carries hangs at its pivot; its own inertia counts only where it is fixed there."""
    disc = dataclasses.replace(balance(), motion="fixed", velocity=()) if rigid else balance()
    scene = Scene("pendulum", (dataclasses.replace(carriage(), angle=-0.5 * math.pi + 1.0), disc), gravity=(0.0, -9.81))
    done = simulate(scene, 1.0)
    w = math.sqrt(MASS * 9.81 * ARM / (JOINED + (DISC if rigid else 0.0)))
    for t in (0.2, 0.71, 1.0):
        angle, rate = pendulum.swing(t, 1.0, w)
        q, u = done.at(t)
        assert q[0] + 0.5 * math.pi == pytest.approx(angle, abs=1e-6)
        assert u[0] == pytest.approx(rate, abs=1e-5)
    if not rigid:
        assert done.q[:, 0] + done.q[:, 1] == pytest.approx(done.q[0, 0] + done.q[0, 1], abs=1e-12)


def test_a_slide_carries() -> None:
    """A sprung balance on a falling slide swings undisturbed, and both masses fall; viscous drag acts on the slide alone."""
    slide = Body("slide", "slide", (1e-3, 0.0), 0.4, (0.2,), (0.0, 1.0), mass=5e-5)
    scene = Scene("slide", (balance("slide"), slide), springs=(Spring("balance", STIFF),), gravity=(0.0, -9.81))
    done = simulate(scene, 0.3)
    w = math.sqrt(STIFF / DISC)
    assert done.counts["flights"] > 0 and done.counts["steps"] == 0
    assert done.q[:, 0] == pytest.approx(2.0 * np.cos(w * done.t), abs=1e-12)
    assert done.q[:, 1] == pytest.approx(0.2 * done.t - 0.5 * 9.81 * done.t**2, abs=1e-14)
    x, y, angle = done.pose("balance", 0.2)
    shift = 0.2 * 0.2 - 0.5 * 9.81 * 0.04
    assert (x, y) == pytest.approx((1e-3 + ARM * math.cos(0.4), shift + ARM * math.sin(0.4)), abs=1e-12)
    assert angle == pytest.approx(0.4 + 2.0 * math.cos(w * 0.2), abs=1e-9)
    driven = dataclasses.replace(scene, gravity=(0.0, 0.0), torques=(Torque("slide", 1e-4),))
    assert simulate(driven, 0.1).a[-1, 1] == pytest.approx(1e-4 / (5e-5 + MASS), rel=1e-12)


def test_a_free_body_carries_what_balances_on_it() -> None:
    """Two rotors on a thrown plate: it flies as one mass; springs only turn the parts against each other."""
    plate = Body("plate", "free", (0.0, 0.0), 0.2, (0.3, 0.4, 5.0), mass=1e-4, inertia=CARRIAGE)
    right = balance("plate")
    left = dataclasses.replace(right, name="left", position=(-ARM, 0.0), angle=0.0, velocity=(30.0,))
    scene = Scene("thrown", (plate, right, left), springs=(Spring("balance", STIFF),), gravity=(0.0, -9.81))
    done = simulate(scene, 0.4)
    assert done.q[:, 0] == pytest.approx(0.3 * done.t, abs=1e-14)
    assert done.q[:, 1] == pytest.approx(0.4 * done.t - 0.5 * 9.81 * done.t**2, abs=1e-12)
    # One sprung rotor against plate and point masses; the other one keeps its turning rate.
    joined = CARRIAGE + 2.0 * MASS * ARM**2
    w = math.sqrt(STIFF * (1.0 / DISC + 1.0 / joined))
    assert done.q[:, 3] == pytest.approx(2.0 * np.cos(w * done.t), abs=2e-8)
    assert done.u[:, 4] + done.u[:, 2] == pytest.approx(35.0, rel=1e-9)
    unbalanced = dataclasses.replace(scene, bodies=(plate, right))
    with pytest.raises(ValueError, match="centre of mass moves"):
        simulate(unbalanced, 0.1)


def test_a_torque_over_the_relative_angle_drives_both() -> None:
    """A tabled torque -k x between the two is a spring, and viscous drag between them does not brake their sum."""
    table = ((-4.0, 4.0 * STIFF), (4.0, -4.0 * STIFF))
    bodies = (balance(), carriage(3.0))
    damping = (Damping("balance", 2e-9, 1e-11),)
    tabled = simulate(Scene("t", bodies, torques=(Torque("balance", over="angle", table=table),), damping=damping), 0.5)
    sprung = simulate(Scene("s", bodies, springs=(Spring("balance", STIFF),), damping=damping), 0.5)
    assert tabled.at(0.5)[0] == pytest.approx(sprung.at(0.5)[0], abs=1e-7)
    momentum = JOINED * sprung.u[:, 1] + DISC * (sprung.u[:, 0] + sprung.u[:, 1])
    assert momentum == pytest.approx((JOINED + DISC) * 3.0, rel=1e-12, abs=0.0)
    assert sprung.energy["dissipated"]["damping"] > 0.1 * STIFF
    assert sprung.energy["residual_relative"] < 1e-8


@pytest.mark.parametrize(("place", "angle"), [((0.0, 0.0), 0.0), ((1e-3, -2e-3), 0.7)])
def test_an_escapement_on_a_plate_that_stands(place: tuple[float, float], angle: float) -> None:
    """Fixed, the plate is no body of the motion: the same bits, or the same to rounding where it is turned."""
    plain, carried = bench(1.0), simulate(escapement(Body("plate", "fixed", place, angle)), 1.0)
    assert len(carried.events) == len(plain.events)
    if angle == 0.0:
        assert np.array_equal(carried.q, plain.q) and np.array_equal(carried.u, plain.u)
        assert np.array_equal(carried.events, plain.events)
    else:
        assert carried.events["t"] == pytest.approx(plain.events["t"], abs=1e-9)
        assert carried.q[-1] == pytest.approx(plain.q[-1], abs=1e-9)
        assert carried.pose("balance", 0.5)[2] == pytest.approx(0.7 + plain.at(0.5)[0][2], abs=1e-9)
    assert carried.pairs == plain.pairs


@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_an_escapement_on_a_heavy_carriage(speed: float) -> None:
    """All parts poised, an even turning is not felt, though every contact moves with it: event by event the same beats."""
    plain = bench(1.0)
    carried = simulate(escapement(Body("carriage", "pivot", (1e-3, -2e-3), 0.7, (speed,), inertia=HEAVY)), 1.0)
    assert carried.stop == Stop.DURATION
    kinds = [EventKind.IMPACT, EventKind.TURN, EventKind.CROSS]
    ours, theirs = (run.events[np.isin(run.events["kind"], kinds)] for run in (carried, plain))
    assert ours["kind"].tolist() == theirs["kind"].tolist()
    assert ours["t"] == pytest.approx(theirs["t"], abs=1e-7)
    assert carried.worst_penetration < NANOMETRE
    for t in (0.1, 0.33, 0.5, 0.9):
        assert carried.at(t)[0][:3] == pytest.approx(plain.at(t)[0], abs=2e-6)
    x, y, _ = carried.pose("balance", 0.33)
    turned = 0.7 + 6.0 * 0.33 if speed else 0.7
    height = profile("bench_lever").body("balance").position[1]
    assert (x, y) == pytest.approx((1e-3 - height * math.sin(turned), -2e-3 + height * math.cos(turned)), abs=1e-12)


def test_a_light_carriage_turns_back_what_the_escapement_turns() -> None:
    """Nothing acts from outside: the moment of momentum of all parts stays, through every impact; the ledger closes."""
    scene = escapement(Body("carriage", "pivot", (1e-3, -2e-3), 0.7, (2.0,), inertia=2e-8))
    done = simulate(scene, 1.0)
    parts = {body.name: body for body in scene.bodies}
    joined = 2e-8 + sum(1e-5 * math.hypot(*parts[name].position) ** 2 for name in ("wheel", "lever", "balance", "banking"))
    whole = sum(parts[name].inertia * (done.u[:, i] + done.u[:, 3]) for i, name in enumerate(("wheel", "lever", "balance")))
    momentum = joined * done.u[:, 3] + whole
    assert len(of_kind(done, EventKind.IMPACT)) > 50
    assert np.ptp(done.u[:, 3]) > 1.0
    assert np.ptp(momentum) < 1e-12 * joined * np.abs(done.u).max()
    assert done.energy["residual_relative"] < 1e-7
    assert done.worst_penetration < NANOMETRE
    assert done.counts["lcp_failures"] == 0


@pytest.mark.slow
def test_a_light_carriage_as_moreau_steps_it() -> None:
    """Another algorithm, at its order: all bodies after three beats."""
    scene = escapement(Body("carriage", "pivot", (1e-3, -2e-3), 0.7, (2.0,), inertia=2e-8))
    truth, errors = simulate(scene, 0.4), {}
    for step in (4e-5, 1e-5):
        done = simulate(scene, 0.4, method="moreau", step=step)
        assert done.stop == Stop.DURATION
        errors[step] = np.abs(done.q[-1] - truth.q[-1]).max()
        assert done.energy["residual_relative"] < 1e-9
    assert errors[1e-5] < 2e-3
    assert errors[1e-5] < 0.6 * errors[4e-5]


def struck(restitution: float, friction: float) -> Scene:
    """A pin of a disc on a turning carriage meets a wall."""
    wall = Body("wall", "fixed", loops=(Loop((Line(6e-3, 0.02, 6e-3, -0.02),), closed=False),))
    bodies = (
        Body("carriage", "pivot", (0.0, 0.0), 0.9, (-3.0,), inertia=CARRIAGE),
        Body(
            "disc",
            "pivot",
            (ARM, 0.0),
            0.2,
            (1.0,),
            mass=MASS,
            inertia=DISC,
            on="carriage",
            loops=(circle(5e-4, (1.8e-3, 0.0)),),
        ),
        wall,
    )
    return Scene("struck", bodies, contacts=touching("disc", "wall", friction=friction, restitution=restitution))


def test_a_pin_on_a_carriage_strikes_a_wall() -> None:
    """Free turning until the pin's circle meets the wall, then one impulse along its normal: by hand."""
    done = simulate(struck(0.6, 0.0), 0.4)
    hit = of_kind(done, EventKind.IMPACT)[0]

    def reach(t: float) -> float:
        return ARM * math.cos(0.9 - 3.0 * t) + 1.8e-3 * math.cos(1.1 - 2.0 * t) + 5e-4 - 6e-3

    begun = brentq(reach, 0.0, 0.3)
    assert hit["t"] == pytest.approx(begun, abs=1e-12)
    # The wall pushes along -x: on the carriage with the arm of the pivot, on the disc with that of the pin.
    w = np.array([ARM * math.sin(0.9 - 3.0 * begun), 1.8e-3 * math.sin(1.1 - 2.0 * begun)])
    inverse, u = np.array([1.0 / JOINED, 1.0 / DISC]), np.array([-3.0, -2.0])
    impulse = -1.6 * (w @ u) / (w @ (inverse * w))
    after = u + inverse * w * impulse
    row = int(np.searchsorted(done.t, hit["t"], side="right")) - 1
    assert hit["impulse_normal"] == pytest.approx(impulse, rel=1e-9, abs=0.0)
    assert done.u[row] == pytest.approx([after[0], after[1] - after[0]], rel=1e-9)


def test_a_pin_slides_along_a_wall_without_gaining_energy() -> None:
    """Pressed on by a torque, with friction: the contact holds to rounding and the ledger closes."""
    scene = dataclasses.replace(struck(0.0, 0.05), torques=(Torque("carriage", 2e-7),))
    done = simulate(scene, 0.5)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-12
    assert done.energy["dissipated"]["friction"] > 0.0
    assert done.energy["residual_relative"] < 1e-8


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("depth", [-NANOMETRE, NANOMETRE])
def test_a_carried_pin_grazes_a_post(depth: float, coupled: bool) -> None:
    """On a carriage that turns fast, a pin misses a fixed post by a nanometre, or touches it by as much."""
    post, arm, pin = np.array([5.6e-3, 1e-3]), 4e-3, 1.5e-3

    def away(t: float) -> float:
        place = arm * np.array([math.cos(7.0 * t), math.sin(7.0 * t)])
        place += pin * np.array([math.cos(3.1 - 4.0 * t), math.sin(3.1 - 4.0 * t)])
        return float(np.hypot(*(place - post)))

    times = np.linspace(0.0, 2.0, 20001)
    start = times[np.argmin([away(t) for t in times])]
    best = minimize_scalar(away, bounds=(start - 1e-4, start + 1e-4), method="bounded", options={"xatol": 1e-15})
    bodies = (
        Body("carriage", "pivot", (0.0, 0.0), 0.0, (7.0,), inertia=1e-9),
        Body(
            "disc",
            "pivot",
            (arm, 0.0),
            3.1,
            (-11.0,),
            inertia=3e-12,
            on="carriage",
            loops=(circle(0.3 * best.fun, (pin, 0.0)),),
        ),
        Body("post", "fixed", tuple(post), loops=(circle(0.7 * best.fun + depth),)),
    )
    damping = (Damping("carriage", 0.0, 1e-24),) if coupled else ()
    done = simulate(Scene("graze", bodies, damping=damping, contacts=touching("disc", "post")), best.x + 0.02)
    assert done.stop == Stop.DURATION
    assert (len(of_kind(done, EventKind.IMPACT)) >= 1) == (depth > 0.0)


def test_a_carriage_at_its_stop_is_lifted_by_its_balance() -> None:
    """Held by a torque T it stands, awake, until the spring's pull on it, -2 k cos(w t), exceeds T."""
    torque = 1e-6
    arm = Body("carriage", "pivot", (0.0, 0.0), 0.0, (0.0,), inertia=1e-6, loops=(box(8e-3, 1e-3),))
    stop = Body("stop", "fixed", (3e-3, -1.5e-3), loops=(circle(1e-3),))
    scene = Scene(
        "lifted",
        (arm, stop, dataclasses.replace(balance(), angle=-2.0)),
        springs=(Spring("balance", STIFF),),
        torques=(Torque("carriage", -torque),),
        contacts=touching("carriage", "stop"),
    )
    done = simulate(scene, 0.2)
    opened = of_kind(done, EventKind.OPEN)
    assert opened[0]["t"] == pytest.approx(math.acos(-torque / (2.0 * STIFF)) / math.sqrt(STIFF / DISC), abs=1e-8)
    before = done.t <= opened[0]["t"]
    assert np.abs(done.q[before, 0]).max() < 1e-12


def test_time_of_a_driven_carriage() -> None:
    """A constant torque from outside turns carriage and load as one mass at the pivot, and the disc not at all."""
    scene = Scene("driven", (carriage(), balance()), torques=(Torque("carriage", 1e-6),))
    done = simulate(scene, 0.2)
    assert done.counts["steps"] == 0
    assert done.q[-1, 0] - 0.3 == pytest.approx(0.5 * 1e-6 / JOINED * 0.04, rel=1e-12)
    assert done.q[-1, 0] + done.q[-1, 1] == pytest.approx(2.3, abs=1e-12)


def test_the_example_beats_as_the_bench_lever_at_rest() -> None:
    """profiles/carriage: the same swings, while all of it is carried round; its inertia is finite, so not the same bits."""
    plain, carried = bench(1.0), simulate(profile("carriage"), 1.0)
    kinds = [EventKind.TURN, EventKind.CROSS]
    ours, theirs = (run.events[np.isin(run.events["kind"], kinds)] for run in (carried, plain))
    assert ours["kind"].tolist() == theirs["kind"].tolist()
    assert ours["t"] == pytest.approx(theirs["t"], abs=1e-5)
    assert carried.pose("carriage", 1.0)[2] == pytest.approx(math.radians(6.0), abs=1e-3)
    assert carried.pose("lever", 1.0)[0] == pytest.approx(4.6e-3 * math.sin(carried.pose("carriage", 1.0)[2]), abs=1e-12)


# Does a body on a carriage that rolls round a fixed wheel with play move, strike and lose as closed forms say?

J_C, J_P, MASS_PLANETS_WITH_PLAY, APART, PLAY = 1e-7, 1e-8, 2e-3, 5e-3, math.radians(2.0)
CARRIAGE_PLANETS_WITH_PLAY = (
    J_C + MASS_PLANETS_WITH_PLAY * APART**2
)  # what turns about the carriage's axis, the planet not turning

SCENE = """
[scene]
title = "planet with play"

[bodies.carriage]
inertia = "1 g·cm²"
{carriage}

[bodies.planet]
on = "carriage"
position = ["3 mm", "4 mm"]
angle = "20°"
mass = "2 g"
inertia = "0.1 g·cm²"

[[gears]]
between = {between}
ratio = {ratio!r}
backlash = "{play!r} rad"
{gears}

{more}

[run]
duration = "0.5 s"
"""
DRIVE = '[[torques]]\nbody = "carriage"\nvalue = "1 mN·m"\n'
BETWEEN = {False: '["carriage", "planet"]', True: '["planet", "carriage"]'}


def planet(folder: Path, r: float, turned: bool = False, play: float = PLAY, **parts: str) -> ws.Scene:
    """`r`: turns of the planet against the carriage for one of that; `turned`: told from the planet to the carriage, where
    the play is how far the carriage can go while the planet is held against it."""
    texts = dict.fromkeys(("carriage", "gears", "more"), "") | parts
    told = 1.0 / r if turned else r
    return read(folder, SCENE.format(between=BETWEEN[turned], ratio=told, play=abs(play / r) if turned else play, **texts))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("r", [8.0, -3.0, -0.4])
def test_the_carriage_runs_free_through_the_play_and_then_takes_the_planet_along(tmp_path, r, turned) -> None:
    """Till (1 + r) φ is half the play; a plastic impact keeps J_c u + (1 + r) J_p v; then J_c + (1 + r)² J_p are driven."""
    torque, s = 1e-3, 1.0 + r
    run = ws.simulate(planet(tmp_path, r, turned, more=DRIVE))
    bend = torque / CARRIAGE_PLANETS_WITH_PLAY
    meets = math.sqrt(PLAY / abs(s) / bend)
    impact = run.events[run.events["kind"] == EventKind.IMPACT][0]
    assert impact["t"] == pytest.approx(meets, rel=1e-9, abs=0.0)
    whole = CARRIAGE_PLANETS_WITH_PLAY + s * s * J_P
    speed, left = CARRIAGE_PLANETS_WITH_PLAY * bend * meets / whole, 0.5 - meets
    carriage = 0.5 * bend * meets**2 + speed * left + 0.5 * torque / whole * left**2
    assert run.end_q[0] == pytest.approx(carriage, rel=1e-9)
    # Against the carriage, from 20°: r times as far, half the play behind.
    behind = math.copysign(0.5 * PLAY, s)
    assert run.end_q[1] == pytest.approx(math.radians(20.0) + r * carriage - behind, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-12


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("r", "eta"), [(8.0, 0.9), (8.0, 0.4), (-3.0, 0.9)])
def test_the_share_lost_is_that_of_the_gears_with_the_carriage_held(tmp_path, r, eta, turned) -> None:
    """Torque of the body T, of the fixed wheel r T / η: the carriage feels T (1 + r / η), and what loads the body back."""
    torque, load = 1e-3, math.copysign(2e-5, 1.0 + r)
    more = DRIVE + f'[[torques]]\nbody = "planet"\nvalue = "{-load!r} N·m"'
    scene = planet(tmp_path, r, turned, gears=f"efficiency = {eta}", more=more)
    run = ws.simulate(scene)
    s, felt = 1.0 + r, 1.0 + r / eta
    bend = (torque + load - felt * load) / (CARRIAGE_PLANETS_WITH_PLAY + felt * s * J_P)
    assert run.a[-1, 0] == pytest.approx(bend, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-10
    twin = ws.simulate(scene, method="moreau", step=1e-5)
    assert twin.end_u[0] == pytest.approx(run.end_u[0], rel=1e-4)


def test_the_driven_carriage_of_a_tourbillon_lets_its_pinion_rattle(tmp_path) -> None:
    """At rest on the carriage to begin with, the planet falls back by r ω in the play, e times as fast after each impact."""
    e, r, w = 0.5, 8.0, 10.0
    scene = planet(tmp_path, r, carriage=f'motion = "driven"\nvelocity = "{w!r} rad/s"', gears=f"restitution = {e}")
    run = ws.simulate(scene)
    closes = run.events[run.events["kind"] == EventKind.IMPACT]["t"]
    pace = r * w
    expected = [0.5 * PLAY / pace + PLAY / pace * sum(e**-k for k in range(1, n + 1)) for n in range(12)]
    assert closes == pytest.approx([t for t in expected if t < 0.5], rel=1e-9, abs=0.0)


def test_play_of_three_angles_is_refused(tmp_path) -> None:
    other = '[bodies.other]\non = "carriage"\nposition = ["-5 mm", "0 mm"]\nmass = "1 g"\ninertia = "0.1 g·cm²"\n'
    fixed = '[bodies.fixed]\nposition = ["20 mm", "0 mm"]\ninertia = "0.1 g·cm²"\n'
    for body, name in ((other, "other"), (fixed, "fixed")):
        gears = f'[[gears]]\nbetween = ["planet", "{name}"]\nratio = -1.5\nbacklash = "1°"'
        with pytest.raises(SceneError, match="bind three angles"):
            planet(tmp_path, 8.0, more=body + gears)
    with pytest.raises(SceneError, match="would not turn in the movement"):
        planet(tmp_path, -1.0)
