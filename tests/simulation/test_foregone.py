"""Does a run end when nothing can change any more, and only then?"""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import watchsim as ws
from watchsim.analysis.flows import efficiency
from watchsim.simulation.foregone import _after
from watchsim.simulation.state import Stop


def run(key: str, value: str, duration: float = 20.0, profile: str = "swiss_lever") -> ws.Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / profile).set(key, value), duration, to_the_end=False)


def test_a_wheel_out_of_mesh_races_and_ends_the_run() -> None:
    """It turns freely under 1 µN·m with 0.05 mg·cm²: (1/2) 2·10⁵ rad/s² t² would be 16 000 turns in a second."""
    raced = run("bodies.wheel.position.1", "-0.3 mm")
    assert raced.stop == Stop.FOREGONE
    assert raced.simulated == pytest.approx(0.5, abs=0.01)
    assert "wheel races" in raced.stop_message
    found = ws.verdict(raced)
    assert (found.name, found.works, found.t) == ("trips", False, pytest.approx(0.0, abs=0.01))
    assert efficiency(raced) == pytest.approx(0.0, abs=0.01)  # what the wheel has run up did not reach the balance
    assert ws.summary(raced)["efficiency"] is None


def test_a_watch_that_came_to_rest_ends_the_run() -> None:
    stood = run("torques.0.value", "-0.01 µN·m", 120.0, "bench_lever")
    assert stood.stop == Stop.FOREGONE
    whole = ws.simulate(stood.scene, 120.0)
    assert whole.stop == Stop.DURATION
    assert (ws.verdict(stood).name, ws.verdict(whole).name) == ("stops", "stops")
    assert ws.verdict(stood).message == ws.verdict(whole).message


@pytest.mark.parametrize("profile", ["swiss_lever", "detent", "graham", "remontoir"])
def test_what_ticks_runs_to_its_end_bit_by_bit(profile: str) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    short, usual = ws.simulate(scene, 6.0, to_the_end=False), ws.simulate(scene, 6.0)
    assert short.stop == usual.stop == Stop.DURATION
    assert (short.end_q == usual.end_q).all()
    assert len(short.events) == len(usual.events)


@given(st.floats(1e-4, 10.0), st.integers(1, 10_000))
def test_the_next_look_is_later(spacing: float, number: int) -> None:
    """A look at a time that rounding had put before its own multiple of the period was due again at that very time: a pin-wheel
    clock stood still for ever at its fifth swing."""
    assert (number + 0.5) * spacing < _after(number * spacing, spacing) < (number + 1.5) * spacing
