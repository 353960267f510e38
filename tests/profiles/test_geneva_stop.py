"""Does a Geneva stop-work let the arbor turn so many times and no more, and is what holds it in balance?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from profiles.led_wheel import polygon
from shapely import affinity

import watchsim as ws
from watchsim import designs
from watchsim.construction.geneva_stop import GenevaStop
from watchsim.construction.registry import design
from watchsim.simulation.trajectory import Trajectory


def wound(turns: int, hand: str) -> Trajectory:
    """Turned to the stop, without mainspring, from a start a quarter of a turn past the lower stop."""
    made = designs.geneva_stop(turns=turns, mainspring="0.001 mN·m")
    return ws.simulate(made.scene().set("torques.0.value", hand))


@pytest.mark.parametrize("turns", [3, 4, 6])
def test_between_the_stops_are_so_many_turns(turns):
    """Both stops are where the pin is all but deepest in the slot beside the blunt arm: the same arm, from either side."""
    up, down = (wound(turns, hand) for hand in ("8 mN·m", "-8 mN·m"))
    upper, lower = (float(run.q[-1, run.slices["arbor"].start]) for run in (up, down))
    assert math.degrees(upper - lower) == pytest.approx(360.0 * turns, abs=8.0)
    for run in (up, down):
        assert np.abs(run.u[-1]).max() < 1e-9
        assert run.worst_penetration < 1e-9 and abs(run.energy["residual_relative"]) < 1e-9
    gone = up.q[-1, up.slices["cross"].start] - down.q[-1, down.slices["cross"].start]
    assert abs(math.degrees(gone)) == pytest.approx(360.0 * turns / (turns + 1), rel=0.07)


def test_by_the_outlines_there_is_no_way_on():
    """A hundredth of a degree before the stop some place of the cross is free; as much behind it none is. Polygons alone."""
    run = wound(4, "8 mN·m")
    arbor, cross = run.scene.body("arbor"), run.scene.body("cross")
    moving = affinity.translate(polygon(run.scene, "arbor", {"PIN", "DISC"}), *arbor.position)
    wheel = polygon(run.scene, "cross", {"CROSS"})
    end, stands = (float(run.q[-1, run.slices[name].start]) for name in ("arbor", "cross"))

    def free(beyond: float) -> bool:
        there = affinity.rotate(moving, end + beyond, origin=tuple(arbor.position), use_radians=True)
        places = stands + np.radians(np.linspace(-1.0, 1.0, 2001))
        return any(not there.intersects(affinity.rotate(wheel, one, origin=(0.0, 0.0), use_radians=True)) for one in places)

    assert tuple(cross.position) == (0.0, 0.0)
    assert free(-math.radians(0.05)) and not free(math.radians(0.05))


def test_the_stop_holds_what_the_hand_has_more_than_the_mainspring():
    """Moments of the forces on the arbor, about its axis."""
    values = GenevaStop()
    run = ws.simulate(designs.geneva_stop().scene())
    pressed = ws.forces(run, [float(run.t[-1])])
    arbor = run.slices["arbor"].start
    wound_up = float(run.q[-1, arbor] - run.q[0, arbor])
    asked = 1e-3 * (values.hand - values.mainspring * wound_up / (math.tau * values.turns))
    names = [run.pairs[int(one)].body_b for one in pressed.pairs]
    moment = 0.0
    for k, name in enumerate(names):
        normal, point = pressed.direction[0, k], pressed.point[0, k]
        force = pressed.normal[0, k] * normal + pressed.tangential[0, k] * np.array([-normal[1], normal[0]])
        arm = point - np.array(run.scene.body("arbor").position)
        moment += (-1.0 if name == "arbor" else 1.0) * float(arm[0] * force[1] - arm[1] * force[0])
    assert moment == pytest.approx(-asked, rel=1e-6)


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"hand": 5.0}, "hand"),
        ({"lock_radius": 1.4}, "lock_radius"),
        ({"pin_radius": 0.5, "turns": 3, "lock_radius": 0.9, "bottom_play": 0.9}, "pin_radius"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in design("geneva_stop").refusals(chosen)]
