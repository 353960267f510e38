"""Does the wheel of a Geneva drive turn as geometry says while the pin drives it, and stand still while it is locked?

Closed form: the pin's middle lies `play` beside the slot's middle line, on the trailing side. With the pin at x, y from the
wheel's axis, W = atan2(y, x) + asin(play / hypot(x, y)); the speed is its derivative, taken by hand. The pin enters along the
slot and takes up the play within the first few degrees, which are left out.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from profiles.running import polygon
from scipy.optimize import brentq
from shapely import affinity
from shapely.geometry import LinearRing, Point, Polygon
from shapely.geometry import Point as Spot

import watchsim as ws
from watchsim import designs
from watchsim.construction.geneva_stop import GenevaStop
from watchsim.scene.scene import Prescribed
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

TAKEN_UP = 0.15  # rad of the driver from the entry until the play is taken up
CLEAR = 0.02  # rad of the driver before the entry and after the exit


def wheel_and_speed(angle, speed, crank, distance, play):
    """Of the driven wheel while the pin rests on the driving side; the driver's angle counts from the line of centres."""
    x, y = distance + crank * np.cos(angle), crank * np.sin(angle)
    square = x * x + y * y
    far = np.sqrt(square)
    polar_speed = crank * (crank + distance * np.cos(angle)) / square
    far_speed = -distance * crank * np.sin(angle) / far
    lag_speed = -play * far_speed / (far * np.sqrt(square - play * play))
    return np.unwrap(np.arctan2(y, x)) + np.arcsin(play / far), speed * (polar_speed + lag_speed)


def departures(run: Trajectory, slots: int, crank: float, play: float) -> tuple[float, float, float]:
    """Largest differences from the closed form (rad, driver's speeds), and the largest turning while locked (rad)."""
    distance = crank / math.sin(math.pi / slots)
    entry, pitch = math.pi / 2.0 + math.pi / slots, 2.0 * math.pi / slots
    t = np.linspace(0.0, run.t[-1], 20001)
    q, u = run.sample(t)
    driver, wheel = q[:, 0], q[:, 1]
    turn = np.floor(driver / (2.0 * math.pi))
    inside = np.mod(driver, 2.0 * math.pi)
    driven = (inside > entry + TAKEN_UP) & (inside < 2.0 * math.pi - entry - CLEAR)
    assert np.count_nonzero(driven) > 1000
    angle, speed = wheel_and_speed(inside[driven], u[driven, 0], crank, distance, play)
    locked = (inside < entry - CLEAR) | (inside > 2.0 * math.pi - entry + CLEAR)
    standing = math.pi / slots - pitch * (turn + (inside > math.pi))
    return (
        float(np.abs(wheel[driven] + pitch * turn[driven] - angle).max()),
        float(np.abs((u[driven, 1] - speed) / u[driven, 0]).max()),
        float(np.abs(wheel[locked] - standing[locked]).max()),
    )


def test_the_profile_follows_the_closed_form():
    run = ws.simulate(ws.load(ws.profiles_dir() / "geneva" / "scene.toml"))
    angle, speed, locked = departures(run, 4, 10e-3, 0.01e-3)
    assert angle < 1e-8
    assert speed < 1e-6
    assert locked < math.radians(0.5)
    assert run.worst_penetration < 1e-9


@pytest.mark.parametrize(
    ("slots", "lock", "friction", "load"),
    [(3, "7 mm", 0.0, "1 mN·m"), (6, "7 mm", 0.2, "0.1 mN·m"), (8, "7.5 mm", 0.1, "0.1 mN·m")],
)
def test_other_numbers_of_slots(slots, lock, friction, load):
    drawn = designs.geneva(slots=slots, lock_radius=lock, pin_radius="1 mm", friction=friction, load=load)
    run = ws.simulate(drawn.scene())
    angle, speed, locked = departures(run, slots, 10e-3, 0.01e-3)
    assert angle < 1e-8
    assert speed < 1e-6
    assert locked < math.radians(0.5)


def wound(turns: int, hand: str) -> Trajectory:
    """Turned to the stop, without mainspring, from a start a quarter of a turn past the lower stop."""
    made = designs.geneva_stop(turns=turns, mainspring="0.001 mN·m")
    return ws.simulate(made.scene().set("torques.0.value", hand))


@pytest.mark.parametrize("turns", [3, 4, 6])
def test_between_the_stops_are_so_many_turns(turns):
    """Both stops are where the pin is all but deepest in the slot beside the blunt arm: the same arm, from either side."""
    up, down = (wound(turns, hand) for hand in ("8 mN·m", "-8 mN·m"))
    upper, lower = (float(run.q[-1, run.slices["arbor"].start]) for run in (up, down))
    assert math.degrees(upper - lower) == pytest.approx(360.0 * turns, abs=8.0)
    for run in (up, down):
        assert np.abs(run.u[-1]).max() < 1e-9
        assert run.worst_penetration < 1e-9 and abs(run.energy["residual_relative"]) < 1e-9
    gone = up.q[-1, up.slices["cross"].start] - down.q[-1, down.slices["cross"].start]
    assert abs(math.degrees(gone)) == pytest.approx(360.0 * turns / (turns + 1), rel=0.07)


def test_by_the_outlines_there_is_no_way_on():
    """A hundredth of a degree before the stop some place of the cross is free; as much behind it none is. Polygons alone."""
    run = wound(4, "8 mN·m")
    arbor, cross = run.scene.body("arbor"), run.scene.body("cross")
    moving = affinity.translate(polygon(run.scene, "arbor", {"PIN", "DISC"}), *arbor.position)
    wheel = polygon(run.scene, "cross", {"CROSS"})
    end, stands = (float(run.q[-1, run.slices[name].start]) for name in ("arbor", "cross"))

    def free(beyond: float) -> bool:
        there = affinity.rotate(moving, end + beyond, origin=tuple(arbor.position), use_radians=True)
        places = stands + np.radians(np.linspace(-1.0, 1.0, 2001))
        return any(not there.intersects(affinity.rotate(wheel, one, origin=(0.0, 0.0), use_radians=True)) for one in places)

    assert tuple(cross.position) == (0.0, 0.0)
    assert free(-math.radians(0.05)) and not free(math.radians(0.05))


def test_a_motor_that_cannot_stall_is_refused_at_the_stop():
    """Driven, the arbor runs into the blunt arm, which no force turns aside: there the hand is stopped."""
    scene = designs.geneva_stop().scene()
    arbor = replace(scene.body("arbor"), prescribed=Prescribed(), velocity=(math.tau,))
    cross = tuple(one for one in scene.damping if one.body == "cross")
    driven = replace(scene, bodies=(arbor, scene.body("cross")), damping=cross, springs=(), torques=(), duration=5.0)
    stopped = ws.simulate(scene)
    for run in (ws.simulate(driven), ws.simulate(driven, method="moreau", step=2e-5)):
        assert run.stop == ws.Stop.BLOCKED and run.stop.gave_up
        assert "arbor, which is driven, leaves cross no way out at" in run.stop_message
        assert run.energy["in_J"] < 1e-3
        end, held = (float(one.q[-1, one.slices["arbor"].start]) for one in (run, stopped))
        assert end == pytest.approx(held, abs=math.radians(3.0))


@pytest.mark.parametrize(("name", "driven"), [("swiss_lever", "wheel"), ("swiss_lever", "lever"), ("ratchet", "click")])
def test_a_motor_on_what_is_locked_says_so(name: str, driven: str) -> None:
    scene = ws.load(ws.profiles_dir() / name)
    bodies = tuple(replace(b, prescribed=Prescribed(), velocity=(3.0,)) if b.name == driven else b for b in scene.bodies)
    springs, torques, damping = (
        tuple(one for one in ones if one.body != driven) for ones in (scene.springs, scene.torques, scene.damping)
    )
    run = ws.simulate(replace(scene, bodies=bodies, springs=springs, torques=torques, damping=damping), 1.0)
    assert run.stop.gave_up and f"{driven}, which is driven, leaves" in run.stop_message


def test_the_stop_holds_what_the_hand_has_more_than_the_mainspring():
    """Moments of the forces on the arbor, about its axis."""
    values = GenevaStop()
    run = ws.simulate(designs.geneva_stop().scene())
    pressed = ws.forces(run, [float(run.t[-1])])
    arbor = run.slices["arbor"].start
    wound_up = float(run.q[-1, arbor] - run.q[0, arbor])
    asked = 1e-3 * (values.hand - values.mainspring * wound_up / (math.tau * values.turns))
    names = [run.pairs[int(one)].body_b for one in pressed.pairs]
    moment = 0.0
    for k, name in enumerate(names):
        normal, point = pressed.direction[0, k], pressed.point[0, k]
        force = pressed.normal[0, k] * normal + pressed.tangential[0, k] * np.array([-normal[1], normal[0]])
        arm = point - np.array(run.scene.body("arbor").position)
        moment += (-1.0 if name == "arbor" else 1.0) * float(arm[0] * force[1] - arm[1] * force[0])
    assert moment == pytest.approx(-asked, rel=1e-6)


BEAK, LENGTH = 0.4e-3, 6e-3


def angles(run: Trajectory, name: str, times: np.ndarray) -> np.ndarray:
    return run.sample(times)[0][:, run.slices[name].start]


@pytest.mark.parametrize(
    ("teeth", "changed"),
    [
        (7, {}),
        (5, {"crank": "5 mm"}),
        (12, {"depth": "0.8 mm", "pin_radius": "0.2 mm"}),
        (7, {"friction": 0.0, "restitution": 0.6}),
    ],
)
def test_a_turn_is_a_tooth(teeth: int, changed: dict[str, str | float]) -> None:
    run = ws.simulate(designs.jumper(teeth=teeth, **changed).scene())
    pitch = 2.0 * np.pi / teeth
    # Seated in its root by both flanks, against the dry friction of the star, at rest before the pin comes again.
    turned = angles(run, "star", np.array([0.0, 1.0, 2.0]))
    assert turned == pytest.approx([0.0, pitch, 2.0 * pitch], abs=1e-6)
    assert angles(run, "jumper", np.array([1.0, 2.0])) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert run.energy["residual_relative"] < 1e-8


def test_the_beak_rides_on_the_star() -> None:
    """By distances of the drawn outline itself, with arcs as chords of 1e-9 m rise: it never comes nearer than its radius."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "jumper"), duration=0.7)
    star = run.scene.body("star")
    points = [edge.point(i / 400) for edge in max(star.loops, key=lambda loop: len(loop.edges)).edges for i in range(400)]
    ring, (x, y) = LinearRing(points), run.scene.body("jumper").position
    times = np.linspace(0.0, 0.7, 1401)
    apart = []
    for turn, lift in zip(angles(run, "star", times), angles(run, "jumper", times), strict=True):
        beak = complex(x + LENGTH * np.sin(lift), y - LENGTH * np.cos(lift)) * np.exp(-1j * turn)
        apart.append(ring.distance(Point(beak.real, beak.imag)) - BEAK)
    riding = times < 0.5
    assert np.abs(np.array(apart)[riding]).max() < 3e-9
    assert min(apart) > -3e-9


def test_what_the_finger_takes_is_what_the_spring_gets() -> None:
    """Slowly and without friction the torque on the finger is the spring's energy over the finger's angle."""
    slow = designs.jumper(friction=0.0, restitution=0.0, drag="0 µN·m", speed="3.6 °/s").scene()
    run = ws.simulate(slow, duration=49.0)
    spring = slow.springs[0]
    times = np.linspace(43.5, 46.0, 26)

    def energy(t: np.ndarray) -> np.ndarray:
        return 0.5 * spring.stiffness * (angles(run, "jumper", t) - spring.rest) ** 2

    step, speed = 1e-3, np.radians(-3.6)
    expected = (energy(times + step) - energy(times - step)) / (2.0 * step * speed)
    torque = ws.forces(run, times).drives["finger"]
    assert np.abs(expected).min() > 1e-6
    assert torque == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"teeth": 40, "depth": "0.25 mm", "nose_radius": "0.04 mm"},
        {"teeth": 12, "click_angle": "30°", "undercut": "10°"},
        {"friction": 0.0, "restitution": 0.6},
    ],
)
def test_it_is_held_at_a_whole_number_of_teeth(changed: dict[str, str | float]) -> None:
    drawn = designs.ratchet(**changed)
    run = ws.simulate(drawn.scene(), duration=1.0)
    pitch = math.tau / changed.get("teeth", 24)
    wheel = run.sample(np.linspace(0.0, 1.0, 2001))[0][:, 0]
    teeth = wheel[-1] / pitch
    assert round(teeth) >= 3
    assert teeth == pytest.approx(round(teeth), abs=1e-7)
    assert np.abs(run.u[-1]).max() < 1e-9
    # It runs back by no more than the tooth on which the click was, and the nose that has not yet fallen behind its point.
    assert (np.maximum.accumulate(wheel) - wheel).max() < pitch + 2.0 * 0.08 / 3.0
    assert run.energy["residual_relative"] < 1e-8


def test_the_torque_of_the_mainspring_rests_on_the_click() -> None:
    """So do the moments of the forces on its nose: about the wheel's axis the mainspring's, about its pivot its spring's."""
    scene = designs.ratchet(friction=0.0).scene()
    run = ws.simulate(scene, duration=0.04)
    found = ws.forces(run, [0.03])
    push = found.normal[0, :, None] * found.direction[0]  # on the nose, from each of the two flanks
    x, y = found.point[0].T
    assert (x * push[:, 1] - y * push[:, 0]).sum() == pytest.approx(-0.5e-3, rel=1e-9)
    px, py = scene.body("click").position
    spring = scene.springs[0]
    held = spring.stiffness * (spring.rest - run.q[-1][1])
    assert ((x - px) * push[:, 1] - (y - py) * push[:, 0]).sum() == pytest.approx(-held, rel=1e-9)


def test_it_sleeps_once_the_hand_has_let_go() -> None:
    """The torque of the hand is a table over time; behind its last knot nothing changes any more, and no step is needed."""
    scene = ws.load(ws.profiles_dir() / "ratchet")
    short, long = (ws.simulate(scene, duration=duration) for duration in (1.0, 5.0))
    assert long.counts["steps"] < short.counts["steps"] + 20
    assert (long.end_q == short.end_q).all()


R, LENGTH_WINDING_CLICK, NOSE, APART = 3.0, 2.0, 0.1, 4.75  # mm, the defaults: 3 + 2 + 0.1 - 0.35
Array = NDArray[np.float64]


def nose(angle: float) -> Array:
    return np.array([LENGTH_WINDING_CLICK * math.sin(angle), APART - LENGTH_WINDING_CLICK * math.cos(angle)])


def teeth(count: int) -> tuple[Array, Array]:
    """The root and the point of the first locking face of the drawing, with the wheel at 0°."""
    loop = next(one for one in designs.winding_click(teeth=count).scene().body("wheel").loops if not one.hole)
    corners = 1e3 * np.array([edge.start for edge in loop.edges])
    root = int(np.argmin(np.abs(corners[:, 1]) + np.abs(np.hypot(*corners.T) - 2.4)))
    return corners[root], corners[(root + 1) % len(corners)]


def least_recoil(count: int, bank: float) -> float:
    """Degrees, by the drawn corners: from where a point lets the nose off until its face meets it at the bank."""
    root, point = teeth(count)
    leaves = brentq(lambda one: np.hypot(*nose(one)) - (R + NOSE), math.radians(-80.0), 0.0)

    def at(turn: float, place: Array) -> Array:
        c, s = math.cos(turn), math.sin(turn)
        return np.array([c * place[0] - s * place[1], s * place[0] + c * place[1]])

    def gap(turn: float) -> float:
        foot, face = at(turn, root), at(turn, point - root) / np.hypot(*(point - root))
        away = nose(bank) - foot
        return float(away[0] * face[1] - away[1] * face[0]) - NOSE

    off = math.atan2(*nose(leaves)[::-1]) - math.atan2(point[1], point[0])
    return math.degrees(off - brentq(gap, off - 1.0, off))


def wound_winding_click(**changed: str | float) -> tuple[Trajectory, Array]:
    """A run, and the angles of wheel and click in it."""
    scene = designs.winding_click(**changed).scene()
    run = ws.simulate(scene)
    return run, np.degrees(run.sample(np.linspace(0.0, scene.duration, 4001))[0])


@pytest.mark.parametrize("bank", [2.0, -8.0, 10.0])
@pytest.mark.parametrize("wound_for", ["0.1 s", "0.14 s", "0.18 s", "0.3 s"])
def test_it_recoils_by_the_least_and_up_to_a_pitch_more(bank: float, wound_for: str) -> None:
    run, q = wound_winding_click(bank=f"{bank}°", wound_for=wound_for)
    start, end = q[0, 0], q[-1, 0]
    assert (end - start) / 20.0 == pytest.approx(round((end - start) / 20.0), abs=1e-9)
    assert q[-1, 1] == pytest.approx(bank, abs=1e-10)
    # As many points have passed the nose as the wheel had turned beyond where the first one does.
    least = least_recoil(18, math.radians(bank))
    assert 0.0 < q[:, 0].max() - end - least < 20.0
    assert run.energy["residual_relative"] < 1e-9
    assert run.worst_penetration < 1e-9


@pytest.mark.parametrize("reach", [0.35, 0.25])
def test_a_point_lets_the_nose_off_on_the_line_to_the_axis(reach: float) -> None:
    """cos β = (d² + l² - (R + r)²) / (2 d l): the furthest that the click ever swings."""
    _, q = wound_winding_click(reach=f"{reach} mm", friction=0.0)
    d = R + LENGTH_WINDING_CLICK + NOSE - reach
    off = -math.degrees(math.acos((d**2 + LENGTH_WINDING_CLICK**2 - (R + NOSE) ** 2) / (2.0 * d * LENGTH_WINDING_CLICK)))
    assert q[:, 1].min() == pytest.approx(off, abs=2e-3)


def test_it_takes_the_tightness_out_of_the_mainspring() -> None:
    """Coils on each other at the end of the winding: nearly three times the torque. After the recoil they are free."""
    run, q = wound_winding_click(friction=0.0)
    full = q[0, 0] + 120.0
    assert 0.5 + 4.0 * math.radians(q[:, 0].max() - full) > 1.35
    assert q[-1, 0] < full
    found = ws.forces(run, [run.t[-1]])
    push = found.normal[0, :, None] * found.direction[0]
    on_wheel = np.abs(np.hypot(*found.point[0].T) - 2.7e-3) < 0.4e-3
    moments = [x * fy - y * fx for (x, y), (fx, fy) in zip(found.point[0][on_wheel], push[on_wheel], strict=True)]
    assert [abs(one) for one in moments] == pytest.approx([0.5e-3], rel=1e-6)


def test_time_stepping_agrees() -> None:
    scene = designs.winding_click(wound_for="0.1 s").scene()
    true = ws.simulate(scene, tolerance=1e-11)
    for step, close in ((4e-5, 4e-3), (1e-5, 1e-3)):
        stepped = ws.simulate(scene, method="moreau", step=step)
        assert np.abs(stepped.at(0.12)[0] - true.at(0.12)[0]).max() < close
        assert stepped.end_q == pytest.approx(true.end_q, abs=1e-5)


TOOTH, HOUR, FREE, REST = math.radians(2.5), 0.5, 0.125, 0.29  # rad; s: let go, at rest on a step
INERTIA, PRELOAD = 1e-7, 40e-3 * 3e-3  # kg·m², N·m
STIFF = 3.0 * 200e9 * (1.5e-3 * 0.25e-3**3 / 12.0) / 50e-3**3 * 3e-3**2  # N·m/rad


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"friction": 0.0, "restitution": 0.6},
        {"tail": "19 mm", "tooth": "2°", "least": "5 mm"},
        {"distance": "18 mm", "steps": 4, "tooth": "6°"},
    ],
)
def test_it_falls_by_whole_teeth(changed: dict[str, str | float]) -> None:
    run = ws.simulate(designs.snail(**changed).scene())
    steps, tooth = int(changed.get("steps", 12)), math.radians(float(str(changed.get("tooth", "2.5°")).rstrip("°")))
    at_rest = np.array([(n - 1) * HOUR + REST for n in range(1, steps + 1)])
    q, u = run.sample(at_rest)
    assert q[:, 1] == pytest.approx(tooth * np.arange(1, steps + 1), abs=1e-9)
    assert np.abs(u[:, 1]).max() < 1e-9
    assert run.energy["residual_relative"] < 1e-9
    assert run.worst_penetration < 1e-9


def test_time_and_speed_of_the_fall_and_its_rebound() -> None:
    """q = (P / k) (1 - cos ω t) on the leaf alone; the pin comes away with `restitution` times its speed along the radius."""
    run = ws.simulate(designs.snail(friction=0.0, restitution=0.3).scene(), tolerance=1e-11)
    w, far = math.sqrt(STIFF / INERTIA), PRELOAD / STIFF
    for n in range(1, 13):
        fall = math.acos(1.0 - n * TOOTH / far) / w
        speed = far * w * math.sin(w * fall)
        meets = (n - 1) * HOUR + FREE + fall
        near = run.events["t"][run.events["kind"] == EventKind.IMPACT]
        moment = near[np.argmin(np.abs(near - meets))]
        assert moment == pytest.approx(meets, abs=2e-6)  # it is let go over a microsecond
        before, after = run.sample(np.array([moment - 1e-8, moment + 1e-8]))[1][:, 1]
        assert (before, after) == pytest.approx((speed, -0.3 * speed), rel=1e-4)


def test_an_even_division_miscounts_by_eight_hundredths_of_a_tooth() -> None:
    """Goodrich divides the fall of the snail evenly; how far would the pin, by polygons, let the rack fall on such steps?"""
    scene = designs.snail().scene()
    pin = next(loop for loop in scene.body("rack").loops if loop.layer == "PIN").edges[0]
    centre, r = 1e3 * np.array((pin.x, pin.y)), 1e3 * pin.radius

    def fallen(radius: float) -> float:
        """Teeth until a pin of the drawing touches a disc, by halving."""
        disc = Polygon([(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(0.0, math.tau, 4001)])
        low, high = 0.0, 14.0
        for _ in range(40):
            middle = 0.5 * (low + high)
            turn = middle * TOOTH
            x = 20.0 + centre[0] * math.cos(turn) - centre[1] * math.sin(turn)
            y = centre[0] * math.sin(turn) + centre[1] * math.cos(turn)
            low, high = (middle, high) if Spot(x, y).distance(disc) > r else (low, middle)
        return low

    steps = next(loop for loop in scene.body("snail").loops if not loop.hole)
    heights = sorted((1e3 * edge.radius for edge in steps.edges if hasattr(edge, "radius")), reverse=True)
    assert len(heights) == 12
    assert [fallen(one) for one in heights] == pytest.approx(range(1, 13), abs=1e-3)
    even = np.linspace(heights[0], heights[-1], 12)
    assert max(fallen(one) - n for n, one in enumerate(even, 1)) == pytest.approx(0.078, abs=1e-3)


def test_time_stepping_comes_nearer_with_its_step() -> None:
    """After the first impact on the fifth step, without friction: Newton's and Poisson's restitution are then the same.

    Fixed steps do not see the microsecond in which the rack is let go; that leaves 2·10⁻⁵ rad.
    """
    scene = designs.snail(friction=0.0).scene()
    true = ws.simulate(scene, duration=2.2, tolerance=1e-11).at(2.147)[0][1]
    off = [float(ws.simulate(scene, duration=2.2, method="moreau", step=h).at(2.147)[0][1] - true) for h in (4e-5, 2e-5, 1e-5)]
    assert (off[1] - off[0]) / (off[2] - off[1]) == pytest.approx(2.0, abs=0.1)
    assert 2.0 * off[2] - off[1] == pytest.approx(0.0, abs=3e-5)


@pytest.mark.parametrize("method", ["events", "moreau"])
def test_friction_on_the_turning_snail_acts_alike_in_both_phases_of_an_impact(method: str) -> None:
    """The snail slips on under the pin when the pin has been stopped: Poisson's law then throws it back with ε times its speed.

    Time stepping once used friction of the slip before, against that of the expansion: 0.187 instead of 0.2.
    """
    scene = designs.snail(friction=0.1, restitution=0.2).scene()
    how = {"tolerance": 1e-11} if method == "events" else {"method": "moreau", "step": 1e-6}
    run = ws.simulate(scene, duration=0.136, record="all", **how)
    u = run.u[:, 1]
    k = int(np.argmax(u < -1.0))
    assert u[k] / u[:k].max() == pytest.approx(-0.2, rel=1e-4)


def test_it_counts_the_same_hours_again_in_the_next_turn() -> None:
    """The torque of the striking train repeats; the pin, on its way up, is above the wall of the first step by then."""
    run = ws.simulate(designs.snail().scene(), duration=12.6, record="all")
    hours = np.arange(24)
    q = run.sample(hours * HOUR + REST)[0]
    assert q[:, 1] == pytest.approx(TOOTH * (hours % 12 + 1), abs=1e-9)
    assert np.abs(run.sample(hours * HOUR + 0.45)[0][:, 1]).max() < 1e-9  # gathered up each time


R_CAM, E, END, MASS, FORCE, RATE = 5e-3, 1.5e-3, 1e-3, 2e-3, 0.2, 100.0  # SI, the design's defaults
REACH = R_CAM + END


def rise(angle: np.ndarray) -> np.ndarray:
    """Of the follower above its lowest place; the disc's middle starts below the axis."""
    phi = angle - 0.5 * math.pi
    return E * np.sin(phi) + np.sqrt(REACH**2 - (E * np.cos(phi)) ** 2) - (REACH - E)


def test_rise_and_force_follow_the_closed_form() -> None:
    run = ws.simulate(designs.cam(friction=0.0).scene())
    times = np.linspace(0.05, 0.89, 400)
    q, u = run.sample(times)
    cam, follower = q.T
    assert np.abs(follower - rise(cam)).max() < 1e-10
    # Speed and acceleration by differences of the closed form, force along the slide by Newton's law.
    w, step = math.radians(1200.0), 1e-5
    speed = w * (rise(cam + step) - rise(cam - step)) / (2.0 * step)
    bend = w * w * (rise(cam + step) - 2.0 * rise(cam) + rise(cam - step)) / step**2
    assert np.abs(u[:, 1] - speed).max() < 1e-8
    along = MASS * bend + FORCE + RATE * rise(cam)
    found = ws.forces(run, times)
    assert found.normal[:, 0] * found.direction[:, 0, 1] == pytest.approx(along, rel=1e-4)
    # Without friction the cam takes what the follower gets: torque × angle = force × rise.
    assert found.drives["cam"] == pytest.approx(along * speed / w, rel=1e-3, abs=1e-8)
    # It comes back to where it began: nothing was lost but what the start took (the follower starts at rest).
    assert run.energy["residual_relative"] < 1e-8


def leaves_at() -> float:
    """°/s, written down apart from the design: at the top the spring just keeps the follower on the cam."""
    fastest = (FORCE + RATE * 2.0 * E) / (MASS * E * (1.0 + E / REACH))
    return math.degrees(math.sqrt(fastest))


def test_it_leaves_the_cam_just_above_the_limit() -> None:
    slow = designs.cam(friction=0.0, restitution=0.0, speed=f"{0.995 * leaves_at()!r} °/s").scene()
    for speed, leaves in ((0.995, False), (1.005, True)):
        run = ws.simulate(slow.set("bodies.cam.velocity", f"{speed * leaves_at()!r} °/s"), duration=0.9 * 360.0 / leaves_at())
        after = run.events["t"] > 0.1 * 360.0 / leaves_at()
        opened = run.events[after & (run.events["kind"] == EventKind.OPEN)]
        assert bool(len(opened)) == leaves
        if leaves:  # near the top, half a turn from the start
            assert run.at(float(opened["t"][0]))[0][0] == pytest.approx(math.pi, abs=0.15)


def test_too_fast_and_too_eccentric_are_refused() -> None:
    with pytest.raises(ws.SceneError, match="leaves the cam at the top from"):
        designs.cam(speed=f"{1.01 * leaves_at()!r} °/s")
    with pytest.raises(ws.SceneError, match="no room in the disc"):
        designs.cam(eccentricity="4.5 mm")
