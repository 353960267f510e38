"""Does a hairspring that bends and weighs do what its elastica, solved by other means, says?"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import tomllib
from numpy.polynomial import chebyshev
from scipy.integrate import quad, solve_bvp
from scipy.optimize import brentq

from watchsim.analysis.forces import bearing_friction
from watchsim.geometry.elastic_coil import bend, bending, spiral_line
from watchsim.geometry.hairspring import Coil
from watchsim.mechanism.coiled import coil_lines, rate
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Bearing
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

INERTIA, STIFFNESS, MASS, G = 1.2e-9, 7.58e-7, 2.4e-6, 9.80665
COIL = Coil(0.6e-3, 2.8e-3, 12.25, math.radians(40.0), 3e-5)
SLOPE = (COIL.outer - COIL.inner) / (math.tau * COIL.turns)


def balance(gravity: tuple[float, float] = (0.0, 0.0), amplitude: float = 4.0, coil: str = "", more: str = "") -> Scene:
    text = f"""[scene]
gravity = ["{gravity[0]} m/s²", "{gravity[1]} m/s²"]
[bodies.balance]
inertia = "{INERTIA} kg·m²"
angle = "{amplitude} rad"
[[springs]]
body = "balance"
stiffness = "{STIFFNESS} N·m/rad"
coil = {coil or '{ inner = "0.6 mm", outer = "2.8 mm", turns = 12.25, stud = "40°", mass = "2.4 mg" }'}
{more}
[run]
duration = "2 s"
"""
    return from_mapping(tomllib.loads(text), None)


@cache
def solved(angle: float) -> tuple[complex, complex, float]:
    """(force, centre of gravity, torque), E I = 1: the boundary value problem over the polar angle of the strip at rest."""
    swept, first = math.tau * COIL.turns, COIL.stud - math.tau * COIL.turns
    length = quad(lambda p: math.hypot(COIL.inner + SLOPE * p, SLOPE), 0.0, swept, limit=200)[0]
    slant = [math.atan2(r, SLOPE) for r in (COIL.inner, COIL.outer)]
    begin = COIL.inner * np.exp(1j * (first + angle))
    end = COIL.outer * np.exp(1j * COIL.stud)

    def right(p: np.ndarray, y: np.ndarray, sought: np.ndarray) -> np.ndarray:
        x, z, turned = 1e-3 * y[0], 1e-3 * y[1], y[2]
        r = COIL.inner + SLOPE * p
        ds = np.hypot(r, SLOPE)
        bent = (r * r + 2.0 * SLOPE**2) / ds**3 + (sought[0] - x * 1e3 * sought[2] + z * 1e3 * sought[1]) / length
        return np.array([1e3 * ds * np.cos(turned), 1e3 * ds * np.sin(turned), ds * bent, 1e3 * ds * x, 1e3 * ds * z])

    def ends(a: np.ndarray, b: np.ndarray, _sought: np.ndarray) -> np.ndarray:
        missed = [a[0] - 1e3 * begin.real, a[1] - 1e3 * begin.imag, a[2] - first - slant[0] - angle, a[3], a[4]]
        return np.array([*missed, b[0] - 1e3 * end.real, b[1] - 1e3 * end.imag, b[2] - COIL.stud - slant[1]])

    p = np.linspace(0.0, swept, 1500)
    r = COIL.inner + SLOPE * p
    path = 1e3 * r * np.exp(1j * (first + p + angle * (1.0 - p / swept)))
    guess = np.array([path.real, path.imag, first + p + np.arctan2(r, SLOPE), np.zeros_like(p), np.zeros_like(p)])
    found = solve_bvp(right, ends, p, guess, p=[-angle, 0.0, 0.0], tol=1e-9, max_nodes=40000)
    assert found.success, found.message
    torque, fx, fy = found.p / length * np.array([1.0, 1e3, 1e3])
    centre = 1e-3 * complex(found.y[3][-1], found.y[4][-1]) / (1e3 * length)
    return complex(fx, fy), 1e3 * centre, torque


@pytest.mark.parametrize("angle", [-5.0, -1.0, 0.5, 2.0, 5.0])
def test_the_strip_bends_as_the_boundary_value_problem_does(angle: float) -> None:
    force, centre, torque = solved(angle)
    found = bend(spiral_line(COIL), np.array([angle]))
    assert found.torque[0] == pytest.approx(torque, rel=1e-7)
    assert abs(found.force[0] - force) < 1e-6 * abs(force)
    assert abs(found.centre[0] - centre) < 1e-7 * COIL.outer
    # The torque is what the energy changes by.
    step = 1e-4
    pair = bend(spiral_line(COIL), np.array([angle - step, angle + step])).energy
    assert -(pair[1] - pair[0]) / (2.0 * step) == pytest.approx(torque, rel=1e-6)


def test_the_centre_of_gravity_at_rest_is_that_of_an_archimedean_spiral() -> None:
    def moment(part: str) -> float:
        def density(p: float) -> float:
            r = COIL.inner + SLOPE * p
            return float(getattr(r * np.exp(1j * (COIL.stud - math.tau * COIL.turns + p)) * math.hypot(r, SLOPE), part))

        return float(quad(density, 0.0, math.tau * COIL.turns, limit=400, epsabs=1e-16, epsrel=1e-10)[0])

    length = quad(lambda p: math.hypot(COIL.inner + SLOPE * p, SLOPE), 0.0, math.tau * COIL.turns, limit=200)[0]
    found = [float(chebyshev.chebval(0.0, part)) for part in bending(COIL).centre]
    assert found == pytest.approx([moment("real") / length, moment("imag") / length], abs=1e-12 * COIL.outer / 1e-3)
    assert bending(COIL).length == pytest.approx(length, rel=1e-12)


def test_a_strip_with_its_centre_of_gravity_on_the_axis_does_not_press_at_first() -> None:
    """Phillips: whole turns of a circle; an open spiral presses at right angles to the way from its centre to the axis."""
    circle = Coil(2.0e-3, 2.0e-3, 10.0, 0.0, 3e-5)
    small = np.array([1e-3])
    assert abs(bend(spiral_line(circle), np.zeros(1)).centre[0]) < 1e-15
    off = abs(bend(spiral_line(COIL), small).force[0])
    assert abs(bend(spiral_line(circle), small).force[0]) < 1e-2 * off
    open_end = replace(circle, turns=10.4)
    found = bend(spiral_line(open_end), small)
    toward = -1j * found.centre[0]
    assert abs((found.force[0] * toward.conjugate()).imag) < 0.02 * abs(found.force[0] * toward)


def exact_hertz(gravity: tuple[float, float], amplitude: float) -> float:
    """By the integral of dθ/u over a swing that begins at `amplitude`, forces and places by the boundary value problem."""
    reach, share = 1.05 * amplitude, chebyshev.chebpts1(22)
    found = [solved(float(reach * x)) for x in share]
    strip = chebyshev.chebfit(share, [one[2] for one in found], 21)
    weighed = chebyshev.chebfit(share, [MASS * (gravity[0] * one[1].real + gravity[1] * one[1].imag) for one in found], 21)
    bending_stiffness = -STIFFNESS * reach / chebyshev.chebval(0.0, chebyshev.chebder(strip))
    potential = -bending_stiffness * reach * chebyshev.chebint(strip)
    potential[:-1] -= weighed

    def depth(angle: np.ndarray | float) -> np.ndarray:
        """Below the turning point, J."""
        return np.asarray(chebyshev.chebval(amplitude / reach, potential) - chebyshev.chebval(angle / reach, potential))

    other = float(brentq(depth, -1.04 * amplitude, -0.96 * amplitude, xtol=1e-15))
    nodes, weights = np.polynomial.legendre.leggauss(120)
    phase = 0.5 * math.pi * nodes
    half = 0.5 * (amplitude - other)
    times = half * np.cos(phase) / np.sqrt(2.0 / INERTIA * depth(0.5 * (amplitude + other) + half * np.sin(phase)))
    return float(1.0 / (2.0 * 0.5 * math.pi * np.sum(weights * times)))


def hertz(scene: Scene) -> float:
    events = simulate(scene, tolerance=1e-10).events
    turns = events["t"][events["kind"] == EventKind.TURN]
    return float(1.0 / np.mean(np.diff(turns[::2])))


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [2.0, 3.5])
def test_its_weight_changes_the_rate_in_positions(amplitude: float) -> None:
    """Flat and upright; to first order the mean of m g · dc/dθ over a swing, of which elasticity and weight change a little."""
    flat, exact_flat = hertz(balance(amplitude=amplitude)), exact_hertz((0.0, 0.0), amplitude)
    assert flat == pytest.approx(exact_flat, rel=1e-9)
    for gravity in ((G, 0.0), (0.0, -G)):
        scene = balance(gravity, amplitude)
        change, expected = hertz(scene) / flat - 1.0, exact_hertz(gravity, amplitude) / exact_flat - 1.0
        assert change == pytest.approx(expected, abs=1e-9)
        assert abs(expected) > 1e-6
        mean = (rate(scene.springs[0], gravity, amplitude) - rate(scene.springs[0], (0.0, 0.0), amplitude)) / 86400.0
        assert change == pytest.approx(mean, rel=0.2)


def test_energy_balances_and_time_stepping_agrees() -> None:
    scene = balance((G, -3.0))
    run = simulate(scene)
    assert run.energy["residual_relative"] < 1e-10
    errors = [abs(simulate(scene, 0.3, method="moreau", step=h).end_q[0] - simulate(scene, 0.3).end_q[0]) for h in (4e-5, 2e-5)]
    assert errors[1] < 0.3 * errors[0]


def test_its_side_force_is_a_load_of_the_bearing() -> None:
    scene = balance(amplitude=3.0)
    bearing = Bearing("balance", 5e-5, 0.1)
    run = simulate(replace(scene, bearings=(bearing,)), duration=0.3)
    times = np.linspace(0.01, 0.29, 7)
    dry = bearing_friction(run, times)[:, 0]
    angles = run.sample(times)[0][:, 0]
    scale = STIFFNESS / -bend(spiral_line(COIL), np.array([1e-4])).torque[0] * 1e-4
    expected = [0.1 * 5e-5 * scale * abs(bend(spiral_line(COIL), np.array([a])).force[0]) for a in angles]
    assert dry == pytest.approx(expected, rel=1e-6)
    assert run.energy["residual_relative"] < 1e-9


def test_check_says_phillips_and_grossmann() -> None:
    text = "\n".join(coil_lines(balance().springs[0]))
    assert "0.060 mm from the axis" in text and "does not hold" in text
    assert "s/d at 200°" in text and "isochronism" in text and "upright" in text


@pytest.mark.parametrize(
    ("coil", "said"),
    [
        ('"13 turns"', "a table is needed"),
        ('{ inner = "0.6 mm", outer = "0.5 mm", turns = 12 }', "stud must stand outside"),
        ('{ inner = "0.6 mm", outer = "2.8 mm", turns = 12, mass = "-1 mg" }', "must not be negative"),
        ('{ inner = "0.6 mm", outer = "2.8 mm" }', "turns"),
    ],
)
def test_coils_that_cannot_be_are_refused(coil: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        balance(coil=coil)
