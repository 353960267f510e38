"""Does a torque over time with a `period` act again and again, from before its first row on, and is nonsense refused?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tomllib

import watchsim as ws
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene

TABLE = 'over = "time"\ntable = [["0.02 s", "0 mN·m"], ["0.03 s", "1 mN·m"], ["0.05 s", "1 mN·m"], ["0.06 s", "0 mN·m"]]'
IMPULSE = 1e-3 * 0.03  # N·m·s of one period: a trapezium


def made(torque: str) -> Scene:
    wheel = '[bodies.wheel]\ncircle = "1 mm"\ninertia = "1 g·cm²"\n[run]\nduration = "1 s"\n'
    return from_mapping(tomllib.loads(f'{wheel}[[torques]]\nbody = "wheel"\n{torque}\n'), Path("x/scene.toml"))


@pytest.mark.parametrize("method", ["events", "moreau"])
def test_each_period_gives_the_same_impulse(method: str) -> None:
    how = {} if method == "events" else {"method": "moreau", "step": 1e-5}
    run = ws.simulate(made(f'{TABLE}\nperiod = "0.1 s"'), **how)
    ends = np.array([0.1, 0.2, 0.5, 0.9])
    tight = 1e-9 if method == "events" else 1e-3
    assert run.sample(ends)[1][:, 0] == pytest.approx(IMPULSE / 1e-7 * ends / 0.1, rel=tight)
    assert run.sample(np.array([0.71]))[1][0, 0] == pytest.approx(7.0 * IMPULSE / 1e-7, rel=tight)
    assert run.energy["residual_relative"] < 1e-9 or method == "moreau"


def test_from_the_last_row_it_goes_on_to_the_first_a_period_later() -> None:
    """From 1 mN·m at 0.03 s down to 0 at 0.11 s, which is the first row: read between and before the rows alike."""
    torque = made('over = "time"\ntable = [["0.01 s", "0 mN·m"], ["0.03 s", "1 mN·m"]]\nperiod = "0.1 s"').torques[0]
    assert [torque.over_time(t) for t in (0.01, 0.02, 0.03, 0.07, 0.11, 0.12, 5.07)] == pytest.approx(
        [0.0, 5e-4, 1e-3, 5e-4, 0.0, 5e-4, 5e-4], abs=1e-15
    )
    assert torque.over_time(0.0) == pytest.approx(1e-3 * 0.01 / 0.08)


REFUSED = [
    (f'{TABLE}\nperiod = "0.03 s"', "must be longer than the table"),
    ('value = "1 mN·m"\nperiod = "1 s"', "belongs to a table"),
    ('over = "angle"\ntable = [["0°", "0 mN·m"], ["9°", "1 mN·m"]]\nperiod = "1 s"', 'belongs to a table with over = "time"'),
    (f'{TABLE}\nperiod = "1 mm"', "length"),
]


@pytest.mark.parametrize(("torque", "why"), REFUSED)
def test_what_cannot_be_is_refused(torque: str, why: str) -> None:
    with pytest.raises(SceneError, match=why):
        made(torque)
