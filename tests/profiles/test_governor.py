"""Does a fly hold its train at the speed at which air takes what the weight gives?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

import watchsim as ws

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


def test_the_other_method_agrees_at_its_order() -> None:
    scene = ws.load(ws.profiles_dir() / "governor")
    exact = ws.simulate(scene, duration=0.3).end_q[0]
    errors = [abs(ws.simulate(scene, duration=0.3, method="moreau", step=h).end_q[0] - exact) for h in (4e-3, 2e-3)]
    assert errors[1] < 0.6 * errors[0] < 1e-2


@pytest.mark.parametrize(("wrong", "words"), [({"root": "29 mm"}, "no vane is left"), ({"thickness": "8 mm"}, "at most 6 mm")])
def test_what_does_not_fit_is_told(wrong: dict[str, str], words: str) -> None:
    with pytest.raises(ws.SceneError, match=words):
        ws.designs.governor(**wrong)
