"""Does the disc bounce, slide and roll down its incline as the closed form says?"""

from __future__ import annotations

import functools

import pytest
from moving_scenes import of_kind, profile
from reference import incline_closed_form as closed_form

from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

FILES = {"0.3": "scene.toml", "0.13": "scene_mu013.toml", "0.10": "scene_mu010.toml"}
TIMES = ("0.1", "0.3", "0.5", "1", "2", "3")


@functools.cache
def run(mu: str) -> Trajectory:
    return simulate(profile("incline", FILES[mu]), 3.0)


@pytest.mark.parametrize("mu", FILES)
@pytest.mark.parametrize("t", TIMES)
def test_motion(mu: str, t: str) -> None:
    """Position, angle, speed and spin to 1e-9 of themselves; the disc rolls towards +x, so its angle runs negative."""
    truth = closed_form.reference(t, mu)
    q, u = run(mu).at(float(t))
    found = [q[0], -q[2], u[0], -u[2]]
    wanted = [float(value) for value in (truth.x, truth.theta, truth.v, truth.spin)]
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("mu", FILES)
def test_the_bouncing_ends_when_it_should(mu: str) -> None:
    found = of_kind(run(mu), EventKind.ACCUMULATION)
    assert len(found) == 1
    assert found[0]["value"] == pytest.approx(float(closed_form.accumulation()), rel=1e-9)
    first = of_kind(run(mu), EventKind.IMPACT)[0]
    assert first["t"] == pytest.approx(float(closed_form.first_impact()), rel=1e-13, abs=0.0)


@pytest.mark.parametrize("mu", FILES)
def test_the_disc_rests_on_the_plane_afterwards(mu: str) -> None:
    done = run(mu)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-9
    assert abs(done.at(3.0)[0][1] - 0.05) < 1e-15
    assert done.energy["residual_relative"] < 1e-10


def test_sliding_turns_into_rolling_when_it_should() -> None:
    """With friction 0.13 the disc slides on after the bouncing and rolls from 1.2507... s on."""
    sticks = of_kind(run("0.13"), EventKind.STICK)
    assert [event["t"] for event in sticks] == pytest.approx([float(rolling_begins())], rel=1e-9)


def rolling_begins():
    return closed_form.rolling_begins(closed_form.settled(closed_form.mpf("0.13")), closed_form.mpf("0.13"))


def test_it_never_rolls_with_friction_010() -> None:
    assert not of_kind(run("0.10"), EventKind.STICK)
