"""Does shooting find the limit cycle of a balance with dry friction in its pivot?

At the turning point where each oscillation begins the friction changes sides. The reference is a run of a minute, taken to rest
by the geometric series of its own beats (Aitken), which knows nothing of sections.
"""

from __future__ import annotations

import numpy as np
import pytest
from every_time import few

import watchsim as ws


@pytest.mark.parametrize("friction", few(["3.06 nN·m", "2 nN·m"], 1))
def test_the_cycle_is_that_of_a_run(friction: str) -> None:
    scene = ws.load(ws.profiles_dir() / "swiss_lever" / "scene.toml").set("damping.0.coulomb", friction)
    cycle = ws.steady(scene)
    beats = ws.beats(ws.simulate(scene.set("bodies.balance.angle", f"-{cycle.amplitude_deg + 2.0} °"), 25.0))
    a, b, c = (float(np.mean(beats.amplitude_deg[k : k + 40])) for k in (60, 100, 140))
    assert c - (c - b) ** 2 / ((c - b) - (b - a)) == pytest.approx(cycle.amplitude_deg, abs=2e-3)
    assert abs(c - cycle.amplitude_deg) < abs(b - cycle.amplitude_deg) < abs(a - cycle.amplitude_deg)
