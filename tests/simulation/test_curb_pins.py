"""Does a hairspring that plays between curb pins swing as a piecewise linear oscillator?"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import tomllib

from watchsim.analysis.timeline import shown_beats
from watchsim.paths import profiles_dir
from watchsim.render.energy_plot import pushes, torque_on
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Curb
from watchsim.scene.load import from_mapping, load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

INERTIA, STIFFNESS = 1.2e-9, 7.58e-7


def balance(curb: str, amplitude: float, more: str = "") -> Scene:
    return from_mapping(
        tomllib.loads(f"""[bodies.balance]
inertia = "{INERTIA} kg·m²"
angle = "{amplitude} rad"
[[springs]]
body = "balance"
stiffness = "{STIFFNESS} N·m/rad"
curb = {curb}
{more}
[run]
duration = "3 s"
tolerance = 1e-12
"""),
        None,
    )


def period(amplitude: float, share: float, gap: float, offset: float = 0.0) -> float:
    """Half cycles of sines between turning points: inside about rest, beyond a pin about where its line meets zero.

    The energy is that of the turning point; J. P. Den Hartog, *Mechanical Vibrations*, 4th ed. 1956, chapter 8 (elasticity that
    is made of straight lines).
    """
    more = STIFFNESS * share / (1.0 - share)
    stiff = STIFFNESS + more

    def energy(x: float, edge: float) -> float:
        return 0.5 * STIFFNESS * x * x + 0.5 * more * max(x - edge, 0.0) ** 2

    edges = (gap + offset, gap - offset)  # in the direction of the first turning point, and in the other
    total, time = energy(amplitude, edges[0]), 0.0
    for edge in edges:
        if energy(edge, edge) >= total:  # does not reach this pin
            time += 0.5 * math.pi * math.sqrt(INERTIA / STIFFNESS)
            continue
        middle = edge * more / stiff
        far = middle + math.sqrt(2.0 * total / stiff - more * edge * edge * STIFFNESS / stiff**2)
        assert energy(far, edge) == pytest.approx(total, rel=1e-12)
        time += math.sqrt(INERTIA / STIFFNESS) * math.asin(edge / math.sqrt(2.0 * total / STIFFNESS))
        time += math.sqrt(INERTIA / stiff) * math.acos((edge - middle) / (far - middle))
    return 2.0 * time


@pytest.mark.parametrize(
    ("amplitude", "share", "gap", "offset"),
    [(a, 0.03, 0.35, 0.0) for a in (0.3, 0.4, 1.0, 2.5, 5.0)]
    + [(4.0, 0.5, 1.0, 0.0), (3.0, 0.03, 0.35, 0.2), (3.0, 0.03, 0.35, -0.35), (3.0, 0.03, 0.0, 0.0)],
)
def test_its_period_is_the_sum_of_the_half_cycles(amplitude: float, share: float, gap: float, offset: float) -> None:
    run = simulate(balance(f'{{ share = {share}, gap = "{gap} rad", offset = "{offset} rad" }}', amplitude))
    turns = run.events["t"][run.events["kind"] == EventKind.TURN]
    assert len(turns) > 15
    assert np.diff(turns[::2]) == pytest.approx(period(amplitude, share, gap, offset), rel=1e-9)
    assert run.energy["residual_relative"] < 1e-10


def test_steps_end_on_the_pins_so_that_periods_are_exact_at_the_usual_tolerance() -> None:
    run = simulate(balance('{ share = 0.2, gap = "0.35 rad" }', 4.0), tolerance=1e-9)
    turns = run.events["t"][run.events["kind"] == EventKind.TURN]
    assert np.diff(turns[::2]) == pytest.approx(period(4.0, 0.2, 0.35), rel=1e-9)
    on_pin = np.abs(np.abs(run.q[:, 0]) - 0.35) < 1e-11
    assert np.count_nonzero(on_pin) >= 4 * (len(turns) // 2 - 1)
    assert run.energy["residual_relative"] < 1e-10
    assert run.counts["rejected_steps"] < 0.6 * run.counts["steps"]


@pytest.mark.parametrize("bend", [{"curb": Curb(0.05, math.radians(20.0))}, {"cubic": 1e-9}])
def test_the_energy_of_a_lever_watch_with_a_bent_spring_balances(bend: dict[str, Any]) -> None:
    scene = load(profiles_dir() / "swiss_lever" / "scene.toml")
    run = simulate(replace(scene, springs=(replace(scene.springs[0], **bend),)), duration=10.0)
    assert run.energy["residual_relative"] < 1e-9


def test_time_stepping_has_its_period_to_second_order() -> None:
    scene, errors = balance('{ share = 0.2, gap = "0.35 rad" }', 4.0), []
    end = 0.4
    exact = simulate(scene, end).end_q[0]
    for step in (4e-5, 2e-5, 1e-5):
        errors.append(abs(simulate(scene, end, method="moreau", step=step).end_q[0] - exact))
    assert errors[2] < 0.4 * errors[1] < 0.16 * errors[0]


def test_an_open_play_of_the_pins_loses_at_short_arcs_and_the_index_gains() -> None:
    """Within the pins the spring is as long as to its stud; the index, as a share of it, is a key that can be changed."""
    scene = balance('{ share = 0.03, gap = "20°" }', 4.0)

    def hertz(of: Scene) -> float:
        turns = simulate(of).events
        times = turns["t"][turns["kind"] == EventKind.TURN]
        return float(2.0 / np.mean(times[2:] - times[:-2]) / 2.0)

    shorter = scene.set("springs.0.curb.share", 0.04)
    assert hertz(shorter) > hertz(scene) > hertz(scene.set("bodies.balance.angle", 1.0))


@pytest.mark.parametrize(
    ("curb", "more", "said"),
    [
        ("{ share = 0.03 }", "", "gap"),
        ('{ share = 1.0, gap = "20°" }', "", "below 1"),
        ('{ share = 0.03, gap = "-2°" }', "", "must not be negative"),
        ('{ share = 0.03, gap = "20°", offset = "30°" }', "", "no more than gap"),
        ('"20°"', "", "a table is needed"),
        ('{ share = 0.03, gap = "20°" }', '[[springs]]\nbody = "balance"\nstiffness = "1e-9 N·m/rad"', "several springs"),
    ],
)
def test_pins_that_cannot_be_are_refused(curb: str, more: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        balance(curb, 4.0, more)


def test_what_the_lever_gives_a_balance_between_pins() -> None:
    """Work and impulse of its books, which count what the pins press, against the contact forces and impacts."""
    scene = load(profiles_dir() / "swiss_lever" / "scene.toml")
    spring = replace(scene.springs[0], curb=Curb(0.05, math.radians(20.0)))
    run = simulate(replace(scene, springs=(spring,)), duration=1.4)
    quiet = 0
    for found in pushes(run, shown_beats(run, None, rubbed=False)[-2:]):
        for push in found:
            assert push.forces + push.impacts == pytest.approx(push.stage.energy.to_balance, abs=1e-12)
            if not push.struck and push.stage.name == "run to banking":
                times = np.linspace(push.stage.phase.start, push.stage.phase.end, 2001)[1:-1]
                pressed = float(np.trapezoid(torque_on(run, "balance", times), times))
                assert push.stage.impulse == pytest.approx(pressed, rel=5e-3)
                quiet += 1
    assert quiet
