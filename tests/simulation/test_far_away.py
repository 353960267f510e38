"""Does a run end where a body goes so far that its contacts are lost in rounding, and say which one?"""

from __future__ import annotations

import math
from pathlib import Path

import watchsim as ws
from watchsim.mechanism.compile import compile_scene
from watchsim.simulation.stops import Stop
from watchsim.tolerances import FLIGHT_SIZES, FURTHEST_SIZES

SCENE = Path(__file__).parents[1] / "data" / "fuzz" / "endless-step.toml"
WHEEL = """
[scene]
title  = "A wheel without a load"
schema = 1

[bodies.wheel]
circle  = "5 mm"
motion  = "pivot"
mass    = "1 g"
inertia = "1e-9 kg·m²"

[[torques]]
body  = "wheel"
value = "1e20 N·m"

[run]
duration = "1 s"
"""


def test_what_flies_off_ends_the_run_at_the_distance_of_the_closed_form() -> None:
    scene = ws.load(SCENE)
    run = ws.simulate(scene)
    start, far = 0.15, FURTHEST_SIZES * compile_scene(scene).size
    # Looked at after each flight, which is no longer than FLIGHT_SIZES.
    assert math.isclose(run.simulated, math.sqrt(2.0 * (far - start) / 1e30), rel_tol=FLIGHT_SIZES / FURTHEST_SIZES)
    assert run.stop == Stop.FAR_AWAY and run.stop.gave_up and not run.stop.is_wrong
    assert "disc is at 5e+08 m, rounded to 6e-08 m" in run.stop_message


def test_what_spins_up_without_end_is_named_with_its_angle(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(WHEEL)
    run = ws.simulate(tmp_path / "scene.toml")
    # From rest under a constant torque M: angle = M t² / 2 J.
    assert math.isclose(run.simulated, math.sqrt(2.0 * FURTHEST_SIZES * 1e-9 / 1e20), rel_tol=FLIGHT_SIZES / FURTHEST_SIZES)
    assert run.stop == Stop.FAR_AWAY and "wheel is at 1e+10 rad, rounded to 2e-06 rad" in run.stop_message
