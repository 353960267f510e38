"""Do involute gears turn in the ratio of their teeth, and is what is left of it the error of the arcs?"""

from __future__ import annotations

import numpy as np
import pytest

import watchsim as ws
from watchsim import designs
from watchsim.construction.involute_pair import InvolutePair, departure, pair
from watchsim.simulation.trajectory import Trajectory


def error(run: Trajectory, ratio: float) -> float:
    """Transmission error, rad of the pinion, peak to peak, once the play is taken up."""
    q = run.sample(np.linspace(0.5 * run.t[-1], run.t[-1], 20001))[0]
    return float(np.ptp(q[:, 1] + ratio * q[:, 0]))


def test_the_profile_turns_evenly():
    """Wheel 40, pinion 20, drag c on the pinion: its speed is torque / (2 c) = 5 rad/s.

    The normal at a contact is tangent to the pinion's base circle, so what both flanks lack there turns it by that much over
    the base radius: the error is at most twice what the arcs depart from the involute.
    """
    run = ws.simulate(ws.load(ws.profiles_dir() / "involute_pair" / "scene.toml"))
    assert run.stop.name == "DURATION"
    pinion, wheel = pair(InvolutePair())
    off = (departure(pinion) + departure(wheel)) / pinion.base_radius
    assert 0.2 * off < error(run, 2.0) < 2.0 * off
    assert off < 5e-5
    turned = run.q[-1] - run.sample(np.array([0.5 * run.t[-1]]))[0][0]
    assert turned[1] / turned[0] == pytest.approx(-2.0, abs=1e-5)
    assert turned[1] / (0.5 * run.t[-1]) == pytest.approx(-5.0, rel=1e-5)
    assert run.worst_penetration < 1e-9


@pytest.mark.slow
def test_the_error_falls_with_the_arcs():
    """An arc through three points departs from the curve with the third power of its length."""
    few, many = (error(ws.simulate(designs.involute_pair(arcs=arcs).scene(), duration=1.0), 2.0) for arcs in (3, 6))
    assert few / many > 5.0


def test_what_does_not_fit_is_told():
    for wrong, words in [
        ({"addendum": 1.2, "pinion_teeth": 6, "shift": 0.7}, "pointed"),
        ({"pinion_teeth": 8}, "cut in"),
        ({"spread": 0.3, "addendum": 0.5}, "contact ratio"),
        ({"arcs": 1, "spread": 0.01}, "more arcs"),
        ({"dedendum": 0.7}, "meet the floor"),
    ]:
        with pytest.raises(ws.SceneError, match=words):
            designs.involute_pair(**wrong)
