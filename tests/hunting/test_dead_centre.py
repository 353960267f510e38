"""Do levers stop where friction locks them on their line of centres, and stay there?

Where two pivoted bodies have no relative velocity is known from their turning rates alone: on the line of centres, whose parts
are as the rates. The outlines must touch there, found from their edges.
"""

from __future__ import annotations

import hunt_path
import numpy as np
import pytest
from hunt.energies import masses
from hunt.impulses import Touches, touching
from hunt.views import perturbed, views

from watchsim.scene.file.load import load
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate

SCENES = hunt_path.ROOT / "tests" / "data" / "hunt"


@pytest.fixture(scope="module", params=["levers-801-2130", "levers-801-2838"])
def stopped(request):
    """A run, its first jam, and the row before it."""
    run = simulate(load(SCENES / f"{request.param}.toml"))
    jam = run.events[run.events["kind"] == EventKind.JAM][0]
    return run, jam, int(np.flatnonzero(run.t == jam["t"])[0])


def test_they_touch_where_they_do_not_slip(stopped):
    run, jam, row = stopped
    pair = run.pairs[int(jam["contact"])]
    one, two = run.scene.body(pair.body_a), run.scene.body(pair.body_b)
    at = Touches(run.scene, run.slices, np.ones(run.q.shape[1]), 1e-9)
    (a,), (b,) = (run.u[row, run.slices[name]] for name in (one.name, two.name))
    still = np.array(one.position) + b / (b - a) * (np.array(two.position) - np.array(one.position))
    points = [point for point, _ in touching(*(at._placed(body, run.q[row]) for body in (one, two)), 1e-10)]
    assert min(np.hypot(*(still - point)) for point in points) < 1e-8


def test_they_lose_all_they_had_and_stay(stopped):
    run, jam, row = stopped
    after = np.flatnonzero(run.t == jam["t"])[-1]
    locked = (run.u[row] != 0.0) & (run.u[after] == 0.0)
    assert locked.sum() == 2
    had = 0.5 * masses(run.scene)[locked] @ run.u[row][locked] ** 2
    assert jam["energy_lost"] == pytest.approx(float(had), rel=1e-9)
    touched = run.events[(run.events["t"] > jam["t"]) & (run.events["kind"] == EventKind.IMPACT)]
    until = touched["t"].min() if len(touched) else run.t[-1]
    rows = (run.t > jam["t"]) & (run.t < until)
    assert not run.u[rows][:, locked].any()


def test_forces_that_rounding_allows_do_not_carry_them_over():
    """A disc a hundredth of a micrometre off its centre, and a bar: in one orientation 3e14 N seemed to let them go on."""
    scene = load(SCENES / "kink_twin-801-11924.toml")
    for seen in (scene, *(view.of(scene) for view in views(scene, 11924, 2))):
        run = simulate(seen)
        (jam,) = run.events[run.events["kind"] == EventKind.JAM]
        assert run.simulated == seen.duration
        assert not run.u[run.t > jam["t"]].any()
        assert jam["t"] == pytest.approx(0.0748486, abs=2e-7)


@pytest.mark.parametrize("twin", [0, 4])
def test_what_an_impact_leaves_of_a_slip_is_no_slip(twin):
    """It stops a disc and a bar with 1e6 N s across a face of 2e-6 rad; the rounding of mu times that counted as motion."""
    scene = perturbed(load(SCENES / "kink-801-11924.toml"), 1e-5, 2 * 11924 + 1000 + twin, -1.0)
    run = simulate(scene)
    assert run.simulated == scene.duration
    assert abs(run.u[-1]).max() < 1e-4
