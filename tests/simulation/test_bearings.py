"""Does the friction of a bearing go with what it carries?"""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import watchsim as ws
from watchsim.analysis.flows import flows
from watchsim.analysis.forces import bearing_friction
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EventKind

MASS, INERTIA, STIFFNESS, START, G = 50e-6, 1.2e-9, 7.58e-7, 4.0, 9.80665
FRICTION, RADIUS, FLAT = 0.12, 0.05e-3, 0.02e-3


def balance(folder: Path, scene: str = "", bearing: str = "") -> Scene:
    """A poised balance on its spring, with the bearing described, in a file."""
    described = bearing or f'body = "balance"\nradius = "{RADIUS * 1e3} mm"\nfriction = {FRICTION}\nflat = "{FLAT * 1e3} mm"'
    file = folder / "scene.toml"
    file.write_text(f"""{scene}
[bodies.balance]
mass = "{MASS} kg"
inertia = "{INERTIA} kg·m²"
angle = "{START} rad"

[bodies.post]
motion = "fixed"
[[springs]]
body = "balance"
stiffness = "{STIFFNESS} N·m/rad"
[[bearings]]
{described}
[run]
duration = "4 s"
tolerance = 1e-12
""")
    return ws.load(file)


@pytest.mark.parametrize(
    ("scene", "arm"),
    [
        ("", FLAT),  # without gravity in the plane the balance lies flat, on its cap stone
        ('[scene]\ngravity = ["0 m/s²", "-9.80665 m/s²"]', RADIUS),
        ('[scene]\ngravity = ["9.80665 m/s²", "0 m/s²"]', RADIUS),
        ('[watch]\nposition = "CH"', FLAT),
        ('[watch]\nposition = "3H"', RADIUS),
        ('[scene]\ngravity = ["0 m/s²", "-5 m/s²"]', (RADIUS * 5.0 + FLAT * math.sqrt(G * G - 25.0)) / G),
    ],
)
def test_each_half_swing_loses_twice_the_friction_over_the_stiffness(tmp_path: Path, scene: str, arm: float) -> None:
    """Coulomb's oscillator: turning points A₀ − 2 n T / k, with T = μ m g times the radius that carries the weight."""
    run = ws.simulate(balance(tmp_path, scene))
    turns = np.abs(run.events["value"][run.events["kind"] == EventKind.TURN])
    lost = 2.0 * FRICTION * MASS * G * arm / STIFFNESS
    assert len(turns) > 20
    assert turns == pytest.approx(START - lost * np.arange(1, len(turns) + 1), rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


def test_time_stepping_loses_as_much(tmp_path: Path) -> None:
    scene = balance(tmp_path, '[scene]\ngravity = ["0 m/s²", "-9.80665 m/s²"]')
    exact, errors = ws.simulate(scene).energy["dissipated"]["damping"], []
    for step in (4e-5, 2e-5):
        errors.append(abs(ws.simulate(scene, method="moreau", step=step).energy["dissipated"]["damping"] / exact - 1.0))
    assert errors[1] < 1e-4


@pytest.mark.parametrize(
    ("bearing", "said"),
    [
        ('radius = "0.05 mm"\nfriction = 0.1', "body"),
        ('body = "balance"\nfriction = 0.1', "missing: radius"),
        ('body = "balance"\nradius = "0.05 mm"', "missing: friction"),
        ('body = "balance"\nradius = "0 mm"\nfriction = 0.1', "above zero"),
        ('body = "balance"\nradius = "0.05 mm"\nfriction = -0.1', "negative friction"),
        ('body = "balance"\nradius = "0.05 mm"\nfriction = 0.1\nflat = "-1 mm"', "must not be negative"),
        ('body = "post"\nradius = "0.05 mm"\nfriction = 0.1', "post"),
        ('body = "balnce"\nradius = "0.05 mm"\nfriction = 0.1', 'Did you mean "balance"'),
    ],
)
def test_a_bearing_that_cannot_be_meant_is_refused_with_its_place(tmp_path: Path, bearing: str, said: str) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        balance(tmp_path, bearing=bearing)
    assert "bearings.0" in str(caught.value)


# Does it feel its full load? The force on the pivot is what the momentum of the body changes by, less weight and contacts.


def written(folder: Path, text: str) -> Scene:
    file = folder / "scene.toml"
    file.write_text(text + '[run]\nduration = "3 s"\ntolerance = 1e-12\n')
    return ws.load(file)


PENDULUM = f"""[scene]
gravity = ["0 m/s²", "-{G} m/s²"]
[bodies.pendulum]
mass = "0.01 kg"
inertia = "0.0001 kg·m²"
centre_of_mass = ["0 m", "-0.1 m"]
angle = "1.2 rad"
[bodies.post]
motion = "fixed"
[[bearings]]
body = "pendulum"
radius = "2 mm"
friction = 0.15
"""


def next_turn(start: float, length: float, k: float) -> float:
    """Where a point on a rod turns after its swing from `start` (rad), with friction of k times the tension, by its length.

    y = ω² obeys dy/dθ = -2 (g/l) sin θ ∓ 2 k (y + (g/l) cos θ), linear in y: a cos θ + b sin θ + C exp(∓2 k θ).
    """
    way, w = -math.copysign(1.0, start), G / length
    c = 2.0 * k * way
    b = -3.0 * c * w / (1.0 + c * c)
    a = 2.0 * w + c * b

    def square(angle: float) -> float:
        """Of the speed, but for what the start takes away."""
        return a * math.cos(angle) + b * math.sin(angle)

    return float(brentq(lambda x: square(x) - square(start) * math.exp(-c * (x - start)), -start, -0.5 * start, xtol=1e-15))


def test_a_pendulum_on_a_dry_shaft_feels_gravity_and_centrifugal_force(tmp_path: Path) -> None:
    """The tension is m (l ω² + g cos θ); across the rod friction itself presses: T (1 - (μ r/l)²)^½ = μ r times the tension."""
    scene = written(tmp_path, PENDULUM)
    share = 0.15 * 0.002 / 0.1
    turns = [1.2]
    run = ws.simulate(scene)
    found = run.events["value"][run.events["kind"] == EventKind.TURN]
    for _ in found:
        turns.append(next_turn(turns[-1], 0.1, share / math.sqrt(1.0 - share * share)))
    assert len(found) == 8
    assert found == pytest.approx(turns[1:], rel=1e-11)
    assert run.energy["residual_relative"] < 1e-10
    misses = []
    for step in (4e-4, 2e-4, 1e-4):
        stepped = ws.simulate(scene, method="moreau", step=step)
        value = stepped.events["value"][stepped.events["kind"] == EventKind.TURN]
        misses.append(float(np.max(np.abs(value[:6] - turns[1:7]))))
    assert misses[0] < 1e-7 and misses[2] < misses[0] / 8.0  # of second order


def pressed_disc(folder: Path, presses: tuple[float, float], frictions: tuple[float, float]) -> Scene:
    """A disc of 10 mm that turns at 50 rad/s; blocks press on it from the right and from above."""
    blocks = "".join(
        f"""[bodies.{name}]
motion = "slide"
axis = [{-x}, {-y}]
position = ["{12 * x} mm", "{12 * y} mm"]
circle = "2 mm"
mass = "1 g"
[[torques]]
body = "{name}"
value = "{press} N"
[[contacts]]
between = ["disc", "{name}"]
friction = {friction}
"""
        for name, (x, y), press, friction in zip(("right", "top"), ((1, 0), (0, 1)), presses, frictions, strict=True)
    )
    return written(
        folder,
        f"""[scene]
gravity = ["0 m/s²", "-{G} m/s²"]
[bodies.disc]
circle = "10 mm"
mass = "20 g"
inertia = "1e-6 kg·m²"
velocity = "50 rad/s"
[[bearings]]
body = "disc"
radius = "1 mm"
friction = 0.2
{blocks}""",
    )


@pytest.mark.parametrize("frictions", [(0.0, 0.0), (0.1, 0.3)])
def test_two_contacts_load_a_bearing_by_normal_and_friction_force(tmp_path: Path, frictions: tuple[float, float]) -> None:
    """All forces are constant: the disc stops after J ω / (T + ρ (μ₁ F₁ + μ₂ F₂)), T = μ r |R|; above weighs, too."""
    scene = pressed_disc(tmp_path, (0.03, 0.05), frictions)
    right, top = 0.03, 0.05 + 1e-3 * G
    rubs = frictions[0] * right, frictions[1] * top
    # Turning to the left the disc is rubbed downwards on its right, to the right on its top.
    load = math.hypot(-right + rubs[1], -top - 20e-3 * G - rubs[0])
    torque = 0.2 * 1e-3 * load + 10e-3 * sum(rubs)
    run = ws.simulate(scene)
    stopped = float(run.t[np.flatnonzero(np.abs(run.u[:, run.slices["disc"].start]) > 1e-9)[-1] + 1])
    assert run.sample(0.1)[1][run.slices["disc"].start] == pytest.approx(50.0 - torque / 1e-6 * 0.1, rel=1e-10)
    assert stopped == pytest.approx(1e-6 * 50.0 / torque, rel=1e-9)
    assert run.energy["dissipated"]["damping"] == pytest.approx(0.5e-6 * 2500.0 * 0.2e-3 * load / torque, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-10
    stepped = ws.simulate(scene, 0.1, method="moreau", step=1e-5)
    assert stepped.end_u[run.slices["disc"]] == pytest.approx([50.0 - torque / 1e-6 * 0.1], rel=1e-6)


CAM, OFF, PUSH = 1e-7, 3e-3, 2e-3  # kg·m² about the pivot; m; kg of the block


def eccentric(folder: Path, friction: float, radius: float) -> Scene:
    """A disc of 8 mm whose middle is 3 mm from its pivot lifts a flat block of 2 g against gravity; its own weight, too."""
    return written(
        folder,
        f"""[scene]
gravity = ["0 m/s²", "-{G} m/s²"]
[bodies.cam]
circle = "8 mm"
pivot = ["-{OFF} m", "0 m"]
mass = "1 g"
centre_of_mass = ["{OFF} m", "0 m"]
inertia = "{CAM} kg·m²"
velocity = "20 rad/s"
[bodies.block]
motion = "slide"
axis = [0, 1]
position = ["0 m", "8 mm"]
velocity = "0.06 m/s"
line = [["-20 mm", "0 mm"], ["20 mm", "0 mm"]]
mass = "{PUSH} kg"
[[contacts]]
between = ["cam", "block"]
friction = 0.1
[[bearings]]
body = "cam"
radius = "{radius} m"
friction = {friction}
""",
    )


def lifted(t: float, y: np.ndarray, grip: float) -> list[float]:
    """(ω, α) of the cam, from the equations of both bodies and the root of T - μ r |R(T)|; with it the contact in force."""
    angle, speed = y
    c, s, rub, mass = OFF * math.cos(angle), OFF * math.sin(angle), 0.1, 1e-3

    def turning(torque: float) -> tuple[float, float]:
        arm = c + (s + 8e-3) * rub
        most = PUSH * (G - s * speed**2)
        spin = (-mass * G * c - arm * most - torque) / (CAM + arm * PUSH * c)
        return spin, most + PUSH * c * spin

    def missing(torque: float) -> float:
        spin, press = turning(torque)
        load = math.hypot(mass * (-s * spin - c * speed**2) - rub * press, mass * (c * spin - s * speed**2 + G) + press)
        return torque - grip * load

    return [speed, turning(brentq(missing, 0.0, 1e-3, xtol=1e-19, rtol=1e-15))[0]]


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_contact_and_the_bearing_that_it_loads_are_solved_as_one(tmp_path: Path, friction: float) -> None:
    """An eccentric lifts a block: what slows it in its bearing goes with the force that this takes. The books close."""
    scene, end = eccentric(tmp_path, max(friction, 1e-12), 1e-3), 0.02
    exact = solve_ivp(lifted, (0.0, end), [0.0, 20.0], "DOP853", args=(friction * 1e-3,), rtol=1e-13, atol=1e-15).y[:, -1]
    run = ws.simulate(scene, end)
    assert run.end_q[0] == pytest.approx(exact[0], rel=1e-9) and run.end_u[0] == pytest.approx(exact[1], rel=1e-9)
    assert run.energy["residual_relative"] < 1e-10
    misses = [abs(ws.simulate(scene, end, method="moreau", step=h).end_q[0] - exact[0]) for h in (4e-5, 2e-5, 1e-5)]
    assert misses[2] < misses[0] / 3.0 and misses[2] < 1e-5
    found = ws.forces(run, [0.01])
    load = float(np.hypot(*found.pivots["cam"][0]))
    assert bearing_friction(run, np.array([0.01]))[0, 0] == pytest.approx(friction * 1e-3 * load, abs=1e-15, rel=1e-9)
    taken = flows(run, compile_scene(scene)).damped[-1, 0]
    assert taken == pytest.approx(run.energy["dissipated"]["damping"], abs=1e-14, rel=1e-6)


def arm_and_block(folder: Path, turning: float, radius: float, centre: float, mass: float, block: str, contact: str) -> Scene:
    """An arm that turns at so many rad/s on a pivot of that radius (m) meets a block 8 mm from it; lines for both."""
    return written(
        folder,
        f"""[bodies.arm]
polygon = [["0 mm", "1 mm"], ["8 mm", "0 mm"], ["7 mm", "2 mm"], ["0 mm", "2 mm"]]
mass = "1 g"
inertia = "4e-8 kg·m²"
centre_of_mass = ["{centre} m", "0 m"]
angle = "-90°"
velocity = "{turning} rad/s"
[bodies.block]
motion = "slide"
axis = [1, 0]
line = [["0 m", "-20 mm"], ["0 m", "20 mm"]]
mass = "{mass} kg"
{block}
[[contacts]]
between = ["arm", "block"]
{contact}
[[bearings]]
body = "arm"
radius = "{radius} m"
friction = 0.25
""",
    )


def hammer(folder: Path, back: float, radius: float = 2e-3, centre: float = 0.0) -> Scene:
    """The arm at 30 rad/s strikes a block of 0.3 g that lies before it."""
    block, contact = 'position = ["-1e-9 m", "0 m"]', f"restitution = {back}"
    return arm_and_block(folder, -30.0, radius, centre, 3e-4, block, contact)


@pytest.mark.parametrize(
    ("back", "centre", "radius"), [(0.0, 0.0, 2e-3), (0.6, 0.0, 2e-3), (0.6, 2e-3, 2e-3), (0.0, 0.0, 0.1), (0.3, 0.0, 0.1)]
)
def test_an_impulse_rubs_in_the_bearing_by_its_size(tmp_path: Path, back: float, centre: float, radius: float) -> None:
    """In both phases μ r (Λ - m c Δω), c of the centre of mass: compression ends at one speed, expansion gives a share back.

    So it is where the impulse passes within the circle of friction, and load and friction, found in turn, never settle.
    """
    arm, grip, inertia, mass = 8e-3, 0.25 * radius, 4e-8, 3e-4
    turned = (arm + grip) / (inertia + grip * 1e-3 * centre)  # rad/s by N·s
    impulse = (1.0 + back) * arm * 30.0 / (arm * turned + 1.0 / mass)
    scene = hammer(tmp_path, back, radius, centre)
    run = ws.simulate(scene, 1e-3 if radius < 0.05 else 1e-4)
    struck = run.events[run.events["kind"] == EventKind.IMPACT]
    assert len(struck) == 1
    after = run.u[np.searchsorted(run.t, struck["t"][0], side="right") - 1]
    assert struck["impulse_normal"][0] == pytest.approx(impulse, rel=3e-8)
    assert after == pytest.approx([-30.0 + turned * impulse, -impulse / mass], rel=3e-8)
    assert run.energy["residual_relative"] < 1e-12
    stepped = ws.simulate(scene, run.simulated, method="moreau", step=1e-6)
    assert stepped.end_u == pytest.approx(run.end_u, rel=1e-5)


# Where a force passes within the circle of friction, pressing on a body that turns slows it down: it locks by itself.

TURNING, LIGHT, HEAVY = 30.0, 1e-4, 1e-3  # rad/s of the arm; kg of a block with which it goes on, and of one that stops it


def pushed(folder: Path, mass: float, press: float, centre: float = 0.0) -> Scene:
    """The arm on a pivot with a circle of friction of 25 mm turns before a block with its speed, pushed by `press`."""
    block = f'velocity = "{8e-3 * TURNING} m/s"\n[[torques]]\nbody = "block"\nvalue = "{press} N"'
    return arm_and_block(folder, TURNING, 0.1, centre, mass, block, "")


def driven_back(t: float, y: np.ndarray) -> list[float]:
    """(ω, α) of the arm with the light block: (l cos φ - μ r) F = J α, m d²(l sin φ)/dt² = f - F, φ from its start."""
    arm, inertia, press = 8e-3, 4e-8, 0.05
    c, s = arm * math.cos(y[0]), arm * math.sin(y[0])
    return [y[1], (press + LIGHT * s * y[1] ** 2) / (LIGHT * c + inertia / (c - 25e-3))]


def test_a_light_body_that_pushes_within_the_circle_of_friction_is_slowed(tmp_path: Path) -> None:
    """1/m > l (μ r - l)/J: forces exist, and what is pushed forward goes slower."""
    scene, end = pushed(tmp_path, LIGHT, 0.05), 8e-4
    exact = solve_ivp(driven_back, (0.0, end), [0.0, TURNING], "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    run = ws.simulate(scene, end)
    assert run.counts["jams"] == 0 and exact[1] < 0.3 * TURNING
    assert run.end_q[0] + 0.5 * math.pi == pytest.approx(exact[0], rel=1e-9)
    assert run.end_u[0] == pytest.approx(exact[1], rel=1e-9)
    assert run.energy["residual_relative"] < 1e-10
    misses = [abs(ws.simulate(scene, end, method="moreau", step=h).end_u[0] - exact[1]) for h in (4e-6, 2e-6, 1e-6)]
    assert misses[2] < 0.4 * misses[0] and misses[2] < 1e-3 * TURNING


def test_a_heavy_body_that_pushes_within_the_circle_of_friction_stops_dead(tmp_path: Path) -> None:
    """1/m < l (μ r - l)/J: no finite force keeps them apart. The impulse m v stops both, and the push no longer moves them."""
    scene = pushed(tmp_path, HEAVY, 0.05)
    run = ws.simulate(scene)
    before = 0.5 * (4e-8 + HEAVY * 8e-3**2) * TURNING**2
    struck = run.events[run.events["kind"] == EventKind.IMPACT]
    assert run.stop.name == "DURATION" and run.counts["jams"] == 1 and len(struck) == 1
    assert struck["t"][0] == 0.0 and struck["impulse_normal"][0] == pytest.approx(HEAVY * 8e-3 * TURNING, rel=1e-12)
    assert run.energy["dissipated"]["damping"] == pytest.approx(before, rel=1e-12)  # all of it in the bearing
    assert not run.end_u.any() and run.energy["residual_relative"] < 1e-12
    stepped = ws.simulate(scene, 1e-3, method="moreau", step=1e-6)
    assert stepped.end_q == pytest.approx(run.end_q, abs=1e-6) and stepped.end_u == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_body_that_is_pulled_away_goes_on(tmp_path: Path) -> None:
    """Both stopping and parting obey the laws then: what needs no impulse happens."""
    run = ws.simulate(pushed(tmp_path, HEAVY, -0.05), 1e-3)
    assert run.counts["jams"] == 0 and run.end_u == pytest.approx([TURNING, 8e-3 * TURNING - 50.0 * 1e-3], rel=1e-12)


def test_a_rotor_that_its_own_centrifugal_force_jams_ends_the_run_with_the_reason(tmp_path: Path) -> None:
    """Its circle of friction is larger than J/(m c): the harder it is slowed, the harder it presses. Nothing touches it."""
    file = tmp_path / "scene.toml"
    pushed(tmp_path, HEAVY, -0.05, centre=4e-3)
    file.write_text(file.read_text().replace("axis = [1, 0]", 'axis = [1, 0]\nposition = ["-1 mm", "0 mm"]'))
    run = ws.simulate(ws.load(file), 1e-3)
    assert run.stop.name == "BEARING_JAMS" and "passes nearer to the pivot" in str(run.stop.sentence)


@pytest.mark.parametrize(
    ("body", "more", "said"),
    [
        ("balance", '[bodies.bob]\nmass = "1 g"\non = "balance"\nposition = ["1 mm", "0 mm"]', "carries bob"),
        (
            "balance",
            '[bodies.wheel]\ninertia = "1 g·mm²"\n[[gears]]\nbetween = ["balance", "wheel"]\nratio = -2',
            "geared without",
        ),
        (
            "wheel",
            '[bodies.wheel]\nmass = "1 g"\ninertia = "1 g·mm²"\n[[gears]]\nbetween = ["balance", "wheel"]\nratio = -2',
            "geared",
        ),
    ],
)
def test_a_bearing_whose_load_nobody_knows_is_refused(tmp_path: Path, body: str, more: str, said: str) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        balance(tmp_path, bearing=f'body = "{body}"\nradius = "0.05 mm"\nfriction = 0.1\n{more}')
    assert "bearings.0.body" in str(caught.value)
