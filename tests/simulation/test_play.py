"""Does a pivot with play roll and slide in its hole as a shaft does?"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tomllib
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

from watchsim.analysis.forces import forces
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Shock
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import frames

G, MASS, INERTIA, RADIUS, PLAY = 9.80665, 50e-6, 3e-13, 0.05e-3, 8e-6
OFF = 0.5 * PLAY  # of the middle of the shaft, where it touches


def loads(text: str, path: Path | None = None) -> Scene:
    return from_mapping(tomllib.loads(text), path)


def shaft(
    friction: float, side: float, spin: float = 0.0, more: str = "", duration: float = 0.02, inertia: float = INERTIA
) -> Scene:
    """A body whose pivot touches its hole in that direction, seen from the lowest point."""
    return loads(f"""[scene]
gravity = ["0 m/s²", "-{G} m/s²"]
[bodies.wheel]
mass = "{MASS} kg"
inertia = "{inertia} kg·m²"
velocity = "{spin} rad/s"
circle = "1 mm"
{more}
[[bearings]]
body = "wheel"
radius = "{RADIUS} m"
friction = {friction}
play = "{PLAY} m"
side = "{side - 0.5 * math.pi} rad"
[run]
duration = "{duration} s"
tolerance = 1e-12
""")


def angle_and_middle(scene: Scene, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The body's angle (rad), and how far its pivot is to the right of the middle of the hole (m)."""
    run = simulate(scene)
    assert run.energy["residual_relative"] < 1e-9
    found = frames(scene, run.slices, run.sample(times)[0])["wheel"]
    return found[:, 2], found[:, 0]


@pytest.mark.parametrize(("friction", "rolls"), [(5.0, 1.0), (0.0, 0.0)])
def test_a_shaft_that_rolls_or_slips_is_a_pendulum_as_long_as_half_of_the_play(friction: float, rolls: float) -> None:
    """Rolling its middle, a pendulum of that length, turns it by -off/radius: ψ'' = -g sin ψ / (off (1 + J / m r²)).

    Swings of a pendulum: ψ = 2 asin(k sn(K - ω t)), k = sin(ψ₀/2) (Landau & Lifshitz, *Mechanics*, § 11).
    """
    start, times = 0.5, np.linspace(0.0, 0.02, 60)
    w = math.sqrt(G / (OFF * (1.0 + rolls * INERTIA / (MASS * RADIUS**2))))
    square = math.sin(0.5 * start) ** 2
    swing = 2.0 * np.arcsin(math.sqrt(square) * ellipj(ellipk(square) - w * times, square)[0])
    angle, aside = angle_and_middle(shaft(friction, start), times)
    assert aside == pytest.approx(OFF * np.sin(swing), abs=1e-9 * OFF)
    assert angle == pytest.approx(rolls * (start - swing) * OFF / RADIUS, abs=1e-9 * OFF / RADIUS)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_shaft_that_spins_climbs_to_its_angle_of_friction_and_slows_down_evenly(way: float) -> None:
    """The weight passes the circle of friction: its torque is m g r sin(atan μ)."""
    friction, spin, times = 0.15, 300.0, np.linspace(0.0, 0.015, 10)
    lean = math.atan(friction)
    slowing = MASS * G * RADIUS * math.sin(lean) / INERTIA
    angle, aside = angle_and_middle(shaft(friction, -way * lean, way * spin, duration=0.015), times)
    assert way * angle == pytest.approx(spin * times - 0.5 * slowing * times**2, rel=1e-9)
    assert aside == pytest.approx(np.full(10, -way * OFF * math.sin(lean)), rel=1e-9)


def test_a_pivot_off_the_centre_of_mass_hangs_as_a_double_pendulum() -> None:
    """Without friction: a link without mass as long as half of the play, and the body below (Lagrange's equations)."""
    arm, inertia, start, times = 0.1e-3, 3e-12, 0.4, np.linspace(0.0, 0.02, 30)

    def falling(_: float, at: np.ndarray) -> list[float]:
        link, body, link_rate, body_rate = at
        c, s = math.cos(link - body), math.sin(link - body)
        matrix = [[MASS * OFF**2, MASS * OFF * arm * c], [MASS * OFF * arm * c, inertia]]
        pulls = [
            -MASS * OFF * arm * s * body_rate**2 - MASS * G * OFF * math.sin(link),
            MASS * OFF * arm * s * link_rate**2 - MASS * G * arm * math.sin(body),
        ]
        return [link_rate, body_rate, *np.linalg.solve(matrix, pulls)]

    known = solve_ivp(falling, (0.0, 0.02), [start, 0.2, 0.0, 0.0], "DOP853", times, rtol=1e-13, atol=1e-15).y
    scene = shaft(0.0, start, 0.0, f'centre_of_mass = ["0 m", "-{arm} m"]\nangle = "0.2 rad"', inertia=inertia)
    angle, aside = angle_and_middle(scene, times)
    assert angle == pytest.approx(known[1], abs=1e-9)
    assert aside == pytest.approx(OFF * np.sin(known[0]), abs=1e-8 * OFF)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_shaft_that_falls_through_its_hole_is_stopped_by_dry_friction_and_stays_so(way: float) -> None:
    """It was held by dry friction of twice the size, which drove it backwards while nothing touched it."""
    spin, slowing, times = 1.0, 2500.0, np.linspace(0.0, 1.2e-3, 25)
    more = f'[[damping]]\nbody = "wheel"\ncoulomb = "{slowing * INERTIA} N·m"'
    run = simulate(shaft(0.0, math.pi, way * spin, more, duration=1.2e-3))
    found = frames(run.scene, run.slices, run.sample(times)[0])["wheel"]
    moving = np.minimum(times, spin / slowing)
    assert way * found[:, 2] == pytest.approx(spin * moving - 0.5 * slowing * moving**2, rel=1e-9, abs=1e-13)
    assert found[:, 1] - found[0, 1] == pytest.approx(-0.5 * G * times**2, rel=1e-9, abs=1e-15)
    assert run.energy["residual_relative"] < 1e-9


def test_time_stepping_converges_to_it() -> None:
    scene = shaft(5.0, 0.5, duration=2e-3)
    exact = simulate(scene).end_q
    off = [np.abs(simulate(scene, method="moreau", step=step).end_q - exact)[2] / (OFF / RADIUS) for step in (4e-6, 2e-6)]
    assert off[1] < 0.6 * off[0] < 0.01


def test_its_hole_presses_as_the_weight_does() -> None:
    found = forces(simulate(shaft(0.15, 0.0, duration=0.01)), [0.005])
    assert found.normal[0] == pytest.approx([MASS * G], rel=1e-9)


LEVER = Path("profiles/swiss_lever")


def lever_with_play() -> Scene:
    text, masses = (LEVER / "scene.toml").read_text(), {"12": "50 mg", "0.03": "2 mg", "0.05": "3 mg"}
    for inertia, mass in masses.items():
        given = f'inertia  = "{inertia} mg·cm²"'
        text = text.replace(given, f'{given}\nmass = "{mass}"\ncentre_of_mass = ["0 mm", "0 mm"]')
    for body in ("balance", "lever", "wheel"):
        text += f'\n[[bearings]]\nbody = "{body}"\nradius = "0.05 mm"\nfriction = 0.1\nplay = "8 µm"\n'
    return loads(text, LEVER / "scene.toml")


def test_a_lever_with_play_in_all_its_pivots_ticks_and_no_candidate_is_missed() -> None:
    scene = lever_with_play()
    run = simulate(scene, 0.5)
    every = simulate(scene, 0.5, prefilter=False)
    assert np.array_equal(run.end_q, every.end_q)
    assert run.energy["residual_relative"] < 1e-9
    assert run.overlap["worst_m"] == 0.0
    places = frames(scene, run.slices, run.q)
    for name in ("balance", "lever", "wheel"):
        off = np.hypot(*(places[name][:, :2] - scene.body(name).position).T)
        assert 0.99 * OFF < off.max() < OFF + 1e-10


def test_a_blow_on_a_lever_with_loaded_bearings_keeps_the_ledger() -> None:
    scene = lever_with_play()
    tight = tuple(replace(bearing, play=0.0) for bearing in scene.bearings)
    blow = Shock(0.15, 0.35e-3, (2.6e4, 1.5e4))
    run = simulate(replace(scene, bearings=tight, shocks=(blow,), gravity=(0.0, -G)), 1.0)
    assert run.energy["residual_relative"] < 1e-10


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('play = "-1 µm"', "cannot be negative"),
        ('side = "90°"', "write play"),
        ('play = "8 µm"\n[[bearings]]\nbody = "wheel"\nradius = "1 mm"\nfriction = 0.1', "several bearings"),
        ('play = "8 µm"\n[[springs]]\nbody = "wheel"\nstiffness = "1 N·m/rad"\nstop = "0°"\npreload = "1 N·m"', "a stop"),
    ],
)
def test_play_that_cannot_be_is_refused(more: str, said: str) -> None:
    text = '[bodies.wheel]\nmass = "1 g"\ninertia = "1 g·cm²"\n[[bearings]]\nbody = "wheel"\nradius = "1 mm"\nfriction = 0.1\n'
    with pytest.raises(SceneError, match=said):
        loads(text + more)


def test_play_needs_inertia_about_the_centre_of_mass() -> None:
    body = '[bodies.wheel]\nmass = "1 g"\ninertia = "1 g·mm²"\ncentre_of_mass = ["1 mm", "0 mm"]\n'
    with pytest.raises(SceneError, match="centre of mass, and of wheel none is left"):
        loads(body + '[[bearings]]\nbody = "wheel"\nradius = "1 mm"\nfriction = 0.1\nplay = "8 µm"')
