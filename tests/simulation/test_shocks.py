"""Does what happens in an accelerated and turning case come out as exactly as in one at rest?"""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipkinc

import watchsim as ws
from watchsim.analysis.flows import flows
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene

G, LONG, AWAY = 9.80665, 0.1, (0.03, 0.02)
AT, LASTS, PEAK, WAY = 0.05, 5e-3, 300.0, math.radians(30.0)


def pendulum(folder: Path, shocks: str, more: str = "") -> Scene:
    """A point of 10 g on a rod of 100 mm, 0.3 rad from rest."""
    file = folder / "scene.toml"
    file.write_text(f"""[scene]
gravity = ["0 m/s²", "-{G} m/s²"]
[bodies.pendulum]
mass = "0.01 kg"
inertia = "0.0001 kg·m²"
centre_of_mass = ["0 m", "-{LONG} m"]
position = ["{AWAY[0]} m", "{AWAY[1]} m"]
angle = "0.3 rad"
[bodies.post]
motion = "fixed"
{more}
{shocks}
[run]
duration = "0.6 s"
tolerance = 1e-12
""")
    return ws.load(file)


def blow(turn: float = 0.0, more: str = "") -> str:
    return f"""[[shocks]]
at = "{AT} s"
acceleration = "{PEAK} m/s²"
direction = "30°"
duration = "{LASTS} s"
turn = "{turn} rad/s²"
{more}
"""


def seen_from_outside(t: float, y: np.ndarray, turn: float, about: tuple[float, float]) -> list[float]:
    """Lagrange's equation of the rod's angle in space: its pivot goes on a path that is known."""
    since, pulse = t - AT, math.pi / LASTS
    height = math.sin(pulse * since) if 0.0 < since < LASTS else 0.0
    within = min(max(since, 0.0), LASTS)
    spin = turn * (1.0 - math.cos(pulse * within)) / pulse
    angle = turn * (within / pulse - math.sin(pulse * within) / pulse**2) + spin * max(since - LASTS, 0.0)
    c, s = math.cos(angle), math.sin(angle)
    # Of the pivot in space: the case's point, and the pivot round it.
    px, py = AWAY[0] - about[0], AWAY[1] - about[1]
    ax = PEAK * height * math.cos(WAY) - turn * height * py - spin**2 * px
    ay = PEAK * height * math.sin(WAY) + turn * height * px - spin**2 * py
    ax, ay = c * ax - s * ay, s * ax + c * ay
    theta = y[0] + angle
    bend = -((ay + G) * math.sin(theta) + ax * math.cos(theta)) / LONG
    return [y[1], bend - turn * height]


def swung(turn: float, end: float, about: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    y = np.array([0.3, 0.0])
    for start, stop in ((0.0, AT), (AT, AT + LASTS), (AT + LASTS, end)):
        y = solve_ivp(seen_from_outside, (start, stop), y, "DOP853", args=(turn, about), rtol=1e-13, atol=1e-15).y[:, -1]
    return y


@pytest.mark.parametrize(("turn", "about"), [(0.0, (0.0, 0.0)), (2000.0, (0.0, 0.0)), (-900.0, (0.01, -0.02))])
def test_a_pendulum_in_a_shaken_case_swings_as_its_pivot_moved_in_space(
    tmp_path: Path, turn: float, about: tuple[float, float]
) -> None:
    scene = pendulum(tmp_path, blow(turn, f'about = ["{about[0]} m", "{about[1]} m"]'))
    exact = swung(turn, 0.6, about)
    run = ws.simulate(scene)
    assert [run.end_q[0], run.end_u[0]] == pytest.approx(exact, rel=1e-10)
    books = flows(run, compile_scene(scene))
    assert books.stored[-1] - books.stored[0] == pytest.approx(books.drive[-1], rel=1e-6)
    misses = [abs(ws.simulate(scene, method="moreau", step=h).end_q[0] - exact[0]) for h in (4e-5, 2e-5)]
    assert misses[1] == pytest.approx(misses[0] / 4.0, rel=0.05)


def test_on_a_steadily_accelerated_support_a_pendulum_swings_by_the_elliptic_functions(tmp_path: Path) -> None:
    """As at rest, in gravity √(g² + a²) along the plumb line of the accelerated case."""
    (tmp_path / "steady.csv").write_text("t_s,ax_m_s2,ay_m_s2\n0,4,0\n1,4,0\n")
    run = ws.simulate(pendulum(tmp_path, '[[shocks]]\nfile = "steady.csv"\n'))
    pull, plumb = math.hypot(G, 4.0), -math.atan2(4.0, G)
    k, rate = math.sin(0.5 * (0.3 - plumb)), math.sqrt(pull / LONG)
    sine = ellipj(float(ellipkinc(0.5 * math.pi, k * k)) - rate * 0.6, k * k)[0]
    assert run.end_q[0] == pytest.approx(plumb + 2.0 * math.asin(k * sine), rel=1e-10)


def test_a_recording_of_a_half_sine_moves_as_the_half_sine(tmp_path: Path) -> None:
    """Straight lines between its values: the error goes with the square of their distance."""
    exact, misses = swung(2000.0, 0.6), []
    for rows in (50, 100):
        t = np.linspace(0.0, LASTS, rows + 1)
        height = np.sin(math.pi * t / LASTS)
        columns = (t, PEAK * height * math.cos(WAY), PEAK * height * math.sin(WAY), 2000.0 * height)
        lines = [",".join(repr(float(value)) for value in row) for row in zip(*columns, strict=True)]
        (tmp_path / "blow.csv").write_text("t_s,ax_m_s2,ay_m_s2,turn_rad_s2\n" + "\n".join(lines))
        run = ws.simulate(pendulum(tmp_path, f'[[shocks]]\nfile = "blow.csv"\nat = "{AT} s"\n'))
        misses.append(abs(run.end_q[0] - exact[0]))
    assert misses[0] < 2e-3 and misses[1] == pytest.approx(misses[0] / 4.0, rel=0.02)


def test_a_free_disc_goes_straight_on_in_space_whatever_the_case_does(tmp_path: Path) -> None:
    """Coriolis's, Euler's and the centrifugal force together: seen from outside nothing acts."""
    file = tmp_path / "scene.toml"
    file.write_text(f"""[bodies.disc]
motion = "free"
circle = "1 mm"
mass = "1 g"
position = ["20 mm", "-5 mm"]
velocity = ["0.1 m/s", "0.3 m/s"]
spin = "2 rad/s"
[bodies.slide]
motion = "slide"
axis = [0.6, 0.8]
mass = "1 g"
{blow(2000.0)}[run]
duration = "0.2 s"
tolerance = 1e-12
""")
    run = ws.simulate(ws.load(file))
    pulse = math.pi / LASTS
    spin, left = 2.0 * 2000.0 / pulse, 0.2 - AT - LASTS
    angle = 2000.0 * LASTS / pulse + spin * left
    # The case's point: half a sine, turned as the case turns within it.
    path = solve_ivp(
        lambda t, y: [*y[2:], *_in_space(t, pulse)], (0.0, LASTS), np.zeros(4), "DOP853", rtol=1e-13, atol=1e-16
    ).y[:, -1]
    way = path[:2] + path[2:] * left
    space = np.array([0.02 + 0.1 * 0.2, -0.005 + 0.3 * 0.2]) - way
    c, s = math.cos(angle), math.sin(angle)
    expected = [c * space[0] + s * space[1], c * space[1] - s * space[0], 2.0 * 0.2 - angle]
    assert run.end_q[run.slices["disc"]] == pytest.approx(expected, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


def _in_space(t: float, pulse: float) -> list[float]:
    angle = 2000.0 * (t / pulse - math.sin(pulse * t) / pulse**2) + WAY
    return [PEAK * math.sin(pulse * t) * math.cos(angle), PEAK * math.sin(pulse * t) * math.sin(angle)]


def test_a_bearing_feels_the_blow(tmp_path: Path) -> None:
    """A poised wheel is not turned by it, and is braked: μ r m |a|, integrated over half a sine."""
    file = tmp_path / "scene.toml"
    file.write_text(f"""[bodies.wheel]
mass = "2 g"
inertia = "1e-7 kg·m²"
velocity = "40 rad/s"
[bodies.post]
motion = "fixed"
[[bearings]]
body = "wheel"
radius = "0.1 mm"
friction = 0.2
{blow()}[run]
duration = "0.1 s"
""")
    run = ws.simulate(ws.load(file))
    assert run.end_u[0] == pytest.approx(40.0 - 0.2 * 1e-4 * 2e-3 * PEAK * 2.0 * LASTS / math.pi / 1e-7, rel=1e-10)
    assert np.hypot(*ws.forces(run, [AT + 0.5 * LASTS]).pivots["wheel"][0]) == pytest.approx(2e-3 * PEAK, rel=1e-9)


@pytest.mark.parametrize(
    ("shocks", "said"),
    [
        ('[[shocks]]\nduration = "1 ms"', "a shock accelerates the case"),
        ('[[shocks]]\nacceleration = "1 m/s²"', "missing: duration"),
        ('[[shocks]]\nacceleration = "-1 m/s²"\nduration = "1 ms"', "must not be negative"),
        ('[[shocks]]\nacceleration = "3100"\nduration = "1 ms"', "needs a unit"),
        ('[[shocks]]\nfile = "none.csv"', "cannot be read"),
        ('[[shocks]]\nfile = "scene.toml"', "first line must be"),
        ('[[shocks]]\nfile = "scene.toml"\nturn = "1 rad/s²"', "belongs to a half sine"),
        (blow(1.0) + blow(0.0, 'about = ["1 mm", "0 mm"]'), "said of one point"),
    ],
)
def test_a_shock_that_cannot_be_meant_is_refused(tmp_path: Path, shocks: str, said: str) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        pendulum(tmp_path, shocks)
    assert "shocks.0" in str(caught.value) or "shocks.1" in str(caught.value)
