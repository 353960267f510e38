"""Does the rack fall by a tooth for each blow, in the time and with the rebound that the closed forms say?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shapely.geometry import Point as Spot
from shapely.geometry import Polygon

import watchsim as ws
from watchsim import designs
from watchsim.simulation.state import EventKind

TOOTH, HOUR, FREE, REST = math.radians(2.5), 0.5, 0.125, 0.29  # rad; s: let go, at rest on a step
INERTIA, PRELOAD = 1e-7, 40e-3 * 3e-3  # kg·m², N·m
STIFF = 3.0 * 200e9 * (1.5e-3 * 0.25e-3**3 / 12.0) / 50e-3**3 * 3e-3**2  # N·m/rad


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"friction": 0.0, "restitution": 0.6},
        {"tail": "19 mm", "tooth": "2°", "least": "5 mm"},
        {"distance": "18 mm", "steps": 4, "tooth": "6°"},
    ],
)
def test_it_falls_by_whole_teeth(changed: dict[str, str | float]) -> None:
    run = ws.simulate(designs.snail(**changed).scene())
    steps, tooth = int(changed.get("steps", 12)), math.radians(float(str(changed.get("tooth", "2.5°")).rstrip("°")))
    at_rest = np.array([(n - 1) * HOUR + REST for n in range(1, steps + 1)])
    q, u = run.sample(at_rest)
    assert q[:, 1] == pytest.approx(tooth * np.arange(1, steps + 1), abs=1e-9)
    assert np.abs(u[:, 1]).max() < 1e-9
    assert run.energy["residual_relative"] < 1e-9
    assert run.worst_penetration < 1e-9


def test_time_and_speed_of_the_fall_and_its_rebound() -> None:
    """q = (P / k) (1 - cos ω t) on the leaf alone; the pin comes away with `restitution` times its speed along the radius."""
    run = ws.simulate(designs.snail(friction=0.0, restitution=0.3).scene(), tolerance=1e-11)
    w, far = math.sqrt(STIFF / INERTIA), PRELOAD / STIFF
    for n in range(1, 13):
        fall = math.acos(1.0 - n * TOOTH / far) / w
        speed = far * w * math.sin(w * fall)
        meets = (n - 1) * HOUR + FREE + fall
        near = run.events["t"][run.events["kind"] == EventKind.IMPACT]
        moment = near[np.argmin(np.abs(near - meets))]
        assert moment == pytest.approx(meets, abs=2e-6)  # it is let go over a microsecond
        before, after = run.sample(np.array([moment - 1e-8, moment + 1e-8]))[1][:, 1]
        assert (before, after) == pytest.approx((speed, -0.3 * speed), rel=1e-4)


def test_an_even_division_miscounts_by_eight_hundredths_of_a_tooth() -> None:
    """Goodrich divides the fall of the snail evenly; how far would the pin, by polygons, let the rack fall on such steps?"""
    scene = designs.snail().scene()
    pin = next(loop for loop in scene.body("rack").loops if loop.layer == "PIN").edges[0]
    centre, r = 1e3 * np.array((pin.x, pin.y)), 1e3 * pin.radius

    def fallen(radius: float) -> float:
        """Teeth until a pin of the drawing touches a disc, by halving."""
        disc = Polygon([(radius * math.cos(a), radius * math.sin(a)) for a in np.linspace(0.0, math.tau, 4001)])
        low, high = 0.0, 14.0
        for _ in range(40):
            middle = 0.5 * (low + high)
            turn = middle * TOOTH
            x = 20.0 + centre[0] * math.cos(turn) - centre[1] * math.sin(turn)
            y = centre[0] * math.sin(turn) + centre[1] * math.cos(turn)
            low, high = (middle, high) if Spot(x, y).distance(disc) > r else (low, middle)
        return low

    steps = next(loop for loop in scene.body("snail").loops if not loop.hole)
    heights = sorted((1e3 * edge.radius for edge in steps.edges if hasattr(edge, "radius")), reverse=True)
    assert len(heights) == 12
    assert [fallen(one) for one in heights] == pytest.approx(range(1, 13), abs=1e-3)
    even = np.linspace(heights[0], heights[-1], 12)
    assert max(fallen(one) - n for n, one in enumerate(even, 1)) == pytest.approx(0.078, abs=1e-3)


def test_time_stepping_comes_nearer_with_its_step() -> None:
    """After the first impact on the fifth step, without friction: Newton's and Poisson's restitution are then the same.

    Fixed steps do not see the microsecond in which the rack is let go; that leaves 2·10⁻⁵ rad.
    """
    scene = designs.snail(friction=0.0).scene()
    true = ws.simulate(scene, duration=2.2, tolerance=1e-11).at(2.147)[0][1]
    off = [float(ws.simulate(scene, duration=2.2, method="moreau", step=h).at(2.147)[0][1] - true) for h in (4e-5, 2e-5, 1e-5)]
    assert (off[1] - off[0]) / (off[2] - off[1]) == pytest.approx(2.0, abs=0.1)
    assert 2.0 * off[2] - off[1] == pytest.approx(0.0, abs=3e-5)


@pytest.mark.parametrize("method", ["events", "moreau"])
def test_friction_on_the_turning_snail_acts_alike_in_both_phases_of_an_impact(method: str) -> None:
    """The snail slips on under the pin when the pin has been stopped: Poisson's law then throws it back with ε times its speed.

    Time stepping once used friction of the slip before, against that of the expansion: 0.187 instead of 0.2.
    """
    scene = designs.snail(friction=0.1, restitution=0.2).scene()
    how = {"tolerance": 1e-11} if method == "events" else {"method": "moreau", "step": 1e-6}
    run = ws.simulate(scene, duration=0.136, record="all", **how)
    u = run.u[:, 1]
    k = int(np.argmax(u < -1.0))
    assert u[k] / u[:k].max() == pytest.approx(-0.2, rel=1e-4)


def test_it_counts_the_same_hours_again_in_the_next_turn() -> None:
    """The torque of the striking train repeats; the pin, on its way up, is above the wall of the first step by then."""
    run = ws.simulate(designs.snail().scene(), duration=12.6, record="all")
    hours = np.arange(24)
    q = run.sample(hours * HOUR + REST)[0]
    assert q[:, 1] == pytest.approx(TOOTH * (hours % 12 + 1), abs=1e-9)
    assert np.abs(run.sample(hours * HOUR + 0.45)[0][:, 1]).max() < 1e-9  # gathered up each time


REFUSED = [
    ({"tail": "16 mm", "least": "5 mm"}, "find room on step 1 "),
    ({"tail": "10 mm"}, "does not bring the pin to the lowest step"),
    ({"leaf_force": "15 mN"}, "the leaf slackens before the lowest step"),
    ({"lifting": "0.13 mN·m"}, "to gather the rack up"),
    ({"hour": "0.2 s"}, "no time to come to rest"),
    ({"tail": "24.5 mm", "least": "5 mm"}, "find room on step 12"),
    ({"pin_radius": "1.6 mm"}, "find room on step 12"),
    ({"tooth": "4.5°", "least": "2 mm", "leaf_force": "80 mN", "lifting": "1 mN·m"}, "would reach the rack's axis"),
]


@pytest.mark.parametrize(("changed", "why"), REFUSED)
def test_what_does_not_fit_is_refused(changed: dict[str, str], why: str) -> None:
    with pytest.raises(ws.SceneError, match=why):
        designs.snail(**changed)
