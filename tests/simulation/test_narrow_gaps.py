"""Is no gap between the ends of an arc passed unseen, however long the steps are?"""

import math

import numpy as np
import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Side, Spring
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind


@pytest.mark.parametrize("tolerance", [1e-5, 3e-6, 3e-7, 1e-7])
def test_a_duplex_goes_at_every_tolerance(tolerance: float) -> None:
    """A tooth that rested on the roller passed the notch in one step; at the other corner of the notch it held the balance."""
    scene = load(profiles_dir() / "duplex")
    coarse, fine = (simulate(scene, 1.0, tolerance=one) for one in (tolerance, 1e-9))
    assert coarse.q[-1] == pytest.approx(fine.q[-1], abs=3e-4)


@pytest.mark.parametrize("seed", range(24))
def test_a_point_leaves_a_turning_disc_where_its_arc_ends(seed: int) -> None:
    """Without friction the disc keeps its rate, so that the angle of the flat gives the time."""
    dice = np.random.default_rng([2026, seed])
    radius = 2e-3
    gap, rate = 10.0 ** dice.uniform(-2.0, 0.3), dice.choice([-1.0, 1.0]) * 10.0 ** dice.uniform(-1.0, 3.0)
    way = dice.uniform(0.05, 5.0)  # rad, from the start to the flat
    arc = Arc(0.0, 0.0, radius, 0.5 * gap, 2.0 * math.pi - gap)
    angle = 0.5 * math.pi + math.copysign(0.5 * gap + way, -rate)
    wedge = ((0.0, 0.0), (0.1 * radius, radius), (-0.1 * radius, radius))
    disc = Loop((arc, Line(*arc.end, *arc.start)))
    scene = Scene(
        "a disc with a flat",
        (
            Body("disc", "pivot", (0.0, 0.0), angle, velocity=(rate,), inertia=1e-8, loops=(disc,)),
            Body(
                "point",
                "slide",
                (0.0, radius),
                axis=(0.0, 1.0),
                mass=1e-5,
                loops=(Loop(tuple(Line(*wedge[i - 1], *wedge[i]) for i in range(3))),),
            ),
        ),
        springs=(Spring("point", 2.0, -2e-3),),
        contacts=(Contact((Side("point"), Side("disc")), 0.0, 0.0),),
        duration=30.0 / abs(rate),
    )
    run = simulate(scene, (way + 0.5 * gap) / abs(rate), tolerance=10.0 ** dice.uniform(-10.0, -3.0))
    ends = run.events["t"][np.isin(run.events["kind"], (EventKind.OPEN, EventKind.HANDOVER))]
    assert ends[0] == pytest.approx(way / abs(rate), rel=1e-9)
