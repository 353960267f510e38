"""Does a wheel with cycloidal teeth turn its pinion as exact curves do, evenly after the line of centres and not before it?"""

import math

import numpy as np
import pytest
from naive.rolled_teeth import Teeth
from numpy.typing import NDArray
from scipy.integrate import quad

import watchsim as ws
from watchsim import designs
from watchsim.construction.cycloidal_pair import CycloidalPair, lead_after_centres
from watchsim.construction.involute_pair import InvolutePair, departure, pair
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]


def exact(values: CycloidalPair) -> Teeth:
    rounding = values.ogive * values.pinion_teeth / 2.0 * math.tan(values.leaf / values.pinion_teeth)
    heights = values.addendum, values.wheel_dedendum, values.tooth, values.leaf
    return Teeth(values.wheel_teeth, values.pinion_teeth, *heights, rounding)


def angles(run: Trajectory) -> tuple[Array, Array]:
    """Wheel and pinion once the play is taken up, rad; the pinion's from where a leaf is on the line of centres."""
    q = run.sample(np.linspace(0.3 * run.t[-1], run.t[-1], 401))[0]
    return q[:, 0], math.pi - q[:, 1]


def error(run: Trajectory, values: CycloidalPair) -> float:
    """Largest difference from exact curves, rad of the pinion; which leaf it is does not matter."""
    wheel, pinion = angles(run)
    pitch = 2.0 * math.pi / values.pinion_teeth
    off = pinion - exact(values).driven(wheel)
    return float(np.abs(off - pitch * np.round(off / pitch)).max())


def test_exact_curves_turn_evenly_after_the_line_of_centres() -> None:
    """The oracle itself: half of the widths on the pitch circles plus the ratio, until the next leaf is met."""
    values = CycloidalPair()
    last = lead_after_centres(values) * 2.0 * math.pi / values.wheel_teeth
    begin = -values.tooth / values.wheel_teeth  # the flank that leads is half a tooth ahead of the tooth's middle
    wheel = begin + last * np.linspace(0.05, 0.5, 50)
    even = 8.0 * wheel + 8.0 * values.tooth / values.wheel_teeth + values.leaf / values.pinion_teeth
    assert np.abs(exact(values).driven(wheel) - even).max() < 1e-8


def test_the_profile_turns_in_the_ratio_of_its_teeth() -> None:
    """From pitch to pitch; the pinion's mean speed is torque / (8 drag) = 5 rad/s."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "cycloidal_pair"))
    wheel, pinion = angles(run)
    assert run.stop.name == "DURATION"
    assert run.worst_penetration < 1e-9
    assert run.energy["residual_relative"] < 1e-9
    pitches = int((wheel[-1] - wheel[0]) / (2.0 * math.pi / 80))
    moved = np.interp(wheel[0] + pitches * 2.0 * math.pi / 80, wheel, pinion) - pinion[0]
    assert pitches > 4
    assert moved == pytest.approx(pitches * 2.0 * math.pi / 10, abs=2e-5)
    assert (pinion[-1] - pinion[0]) / (0.7 * run.t[-1]) == pytest.approx(5.0, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chosen", "ripple"),
    [
        ({"pinion_teeth": 6, "wheel_teeth": 60, "ogive": 2.0, "addendum": 1.25}, 2.8e-2),
        ({"pinion_teeth": 8, "ogive": 1.0, "addendum": 1.3}, 1.5e-3),
        ({}, 1.9e-3),
        ({"pinion_teeth": 12, "wheel_teeth": 96, "addendum": 1.62, "pinion_dedendum": 1.9, "ogive": 1.0}, 4.6e-4),
    ],
)
def test_the_pinion_is_where_exact_curves_lead_it(chosen: dict[str, float], ripple: float) -> None:
    """Whatever leads, epicycloid, tip, or radial flank before the line of centres: to what the arcs depart."""
    values = CycloidalPair(**chosen)  # type: ignore[arg-type]
    run = ws.simulate(designs.cycloidal_pair(**chosen).scene(), duration=1.0)
    wheel, pinion = angles(run)
    assert error(run, values) < 5e-5
    assert np.ptp(pinion - values.wheel_teeth / values.pinion_teeth * wheel) == pytest.approx(ripple, rel=0.05)


@pytest.mark.slow
def test_the_error_falls_with_the_arcs() -> None:
    """An arc through three points departs from the curve with the third power of its length."""
    few, many = (
        error(ws.simulate(designs.cycloidal_pair(arcs=arcs).scene(), duration=1.0), CycloidalPair(arcs=arcs)) for arcs in (3, 6)
    )
    assert few / many > 5.0


@pytest.mark.slow
def test_the_other_method_agrees_at_its_order() -> None:
    scene = designs.cycloidal_pair().scene()
    end = ws.simulate(scene, duration=0.1).end_q
    few, many = (np.abs(ws.simulate(scene, duration=0.1, method="moreau", step=h).end_q - end).max() for h in (2e-5, 5e-6))
    assert many < 0.4 * few
    assert many < 1e-3


def error_of(run: Trajectory, ratio: float) -> float:
    """Transmission error, rad of the pinion, peak to peak, once the play is taken up."""
    q = run.sample(np.linspace(0.5 * run.t[-1], run.t[-1], 20001))[0]
    return float(np.ptp(q[:, 1] + ratio * q[:, 0]))


def test_the_profile_turns_evenly():
    """Wheel 40, pinion 20, drag c on the pinion: its speed is torque / (2 c) = 5 rad/s.

    The normal at a contact is tangent to the pinion's base circle, so what both flanks lack there turns it by that much over
    the base radius: the error is at most twice what the arcs depart from the involute.
    """
    run = ws.simulate(ws.load(ws.profiles_dir() / "involute_pair" / "scene.toml"))
    assert run.stop.name == "DURATION"
    pinion, wheel = pair(InvolutePair())
    off = (departure(pinion) + departure(wheel)) / pinion.base_radius
    assert 0.2 * off < error_of(run, 2.0) < 2.0 * off
    assert off < 5e-5
    turned = run.q[-1] - run.sample(np.array([0.5 * run.t[-1]]))[0][0]
    assert turned[1] / turned[0] == pytest.approx(-2.0, abs=1e-5)
    assert turned[1] / (0.5 * run.t[-1]) == pytest.approx(-5.0, rel=1e-5)
    assert run.worst_penetration < 1e-9


@pytest.mark.slow
def test_the_error_falls_with_the_arcs_involute_pair():
    """An arc through three points departs from the curve with the third power of its length."""
    few, many = (error_of(ws.simulate(designs.involute_pair(arcs=arcs).scene(), duration=1.0), 2.0) for arcs in (3, 6))
    assert few / many > 5.0


M, R, DRUM, FLY = 60e-3, 600.0, 2e-4, 15e-7  # SI, as in profiles/governor
RHO, COEFFICIENT, HEIGHT, ROOT, REACH = 1.2, 1.2, 0.035, 0.006, 0.03
# The air on strips of both vanes, each of width dr at the arm r: ½ ρ C h (ω r)² r dr
C = quad(lambda r: 2.0 * 0.5 * RHO * COEFFICIENT * HEIGHT * r**3, ROOT, REACH)[0]


def test_it_comes_up_to_its_terminal_speed_as_tanh() -> None:
    """(J_d + r² J_f) w' = M - r³ c w² of the drum: w = w_t tanh(t / T), w_t = sqrt(M / (r³ c)), T = J w_t / M."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "governor"))
    terminal = math.sqrt(M / (R**3 * C))
    time = (DRUM + R * R * FLY) * terminal / M
    times = np.linspace(0.0, run.simulated, 50)
    fly = run.sample(times)[1][:, run.slices["fly"].start]
    assert fly == pytest.approx(R * terminal * np.tanh(times / time), abs=1e-5)
    assert run.energy["residual_relative"] < 1e-9


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_the_speed_goes_with_the_root_of_the_weight(share: float) -> None:
    scene = ws.load(ws.profiles_dir() / "governor").set("torques.0.value", f"{60.0 * share} mN·m")
    run = ws.simulate(scene, duration=30.0)
    assert run.end_u[run.slices["fly"].start] == pytest.approx(math.sqrt(share * M / (R * C)), rel=1e-6)


def test_the_other_method_agrees_at_its_order_governor() -> None:
    scene = ws.load(ws.profiles_dir() / "governor")
    exact = ws.simulate(scene, duration=0.3).end_q[0]
    errors = [abs(ws.simulate(scene, duration=0.3, method="moreau", step=h).end_q[0] - exact) for h in (4e-3, 2e-3)]
    assert errors[1] < 0.6 * errors[0] < 1e-2
