"""Does a tourbillon turn with its escape wheel, and does its rate over a turn average that of all positions?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim.scene.scene import Scene

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
