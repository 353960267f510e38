"""Does a body on a carriage that rolls round a fixed wheel with play move, strike and lose as closed forms say?"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from scene.made_gears import read

import watchsim as ws
from watchsim.scene.errors import SceneError
from watchsim.simulation.event_kinds import EventKind

J_C, J_P, MASS, APART, PLAY = 1e-7, 1e-8, 2e-3, 5e-3, math.radians(2.0)
CARRIAGE = J_C + MASS * APART**2  # what turns about the carriage's axis, the planet not turning

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
    bend = torque / CARRIAGE
    meets = math.sqrt(PLAY / abs(s) / bend)
    impact = run.events[run.events["kind"] == EventKind.IMPACT][0]
    assert impact["t"] == pytest.approx(meets, rel=1e-9, abs=0.0)
    whole = CARRIAGE + s * s * J_P
    speed, left = CARRIAGE * bend * meets / whole, 0.5 - meets
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
    bend = (torque + load - felt * load) / (CARRIAGE + felt * s * J_P)
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
