"""Does what starts in exact contact at rest stay there, without an impact nobody asked for?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from moving_scenes import box, circle, ground, on_slope

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.simulation.simulate import simulate

R, S = 0.02, 0.05


def disc(name: str, x: float, y: float) -> Body:
    return Body(name, "free", (x, y), mass=0.1, inertia=0.05 * R**2, loops=(circle(R),))


def block(name: str, y: float) -> Body:
    return Body(name, "free", (0.0, y), mass=0.1, inertia=1e-4, loops=(box(2.0 * S, 2.0 * S),))


def wall(x: float) -> Body:
    """A fixed upright plane with material on its left."""
    return Body("wall", "fixed", loops=(Loop((Line(x, 1.0, x, -1.0),), closed=False),))


SCENES = {
    1: ((disc("a", 0.0, R), ground()), (("a", "ground"),)),
    2: ((block("a", S), ground()), (("a", "ground"),)),
    3: ((block("a", S), disc("b", S + R, R), ground()), (("a", "ground"), ("b", "ground"))),
    4: ((block("a", S), block("b", 3.0 * S), ground()), (("a", "ground"), ("b", "a"))),
    5: ((block("a", S), block("b", 3.0 * S), disc("c", 0.0, 4.0 * S + R), ground()), (("a", "ground"), ("b", "a"), ("c", "b"))),
    6: ((block("a", S), block("b", 3.0 * S), block("c", 5.0 * S), ground()), (("a", "ground"), ("b", "a"), ("c", "b"))),
}


def started(count: int, friction: float, restitution: float, slope: float = 0.0) -> Trajectory:
    bodies, pairs = SCENES[count]
    contacts = tuple(Contact((Side(first), Side(last)), friction, restitution) for first, last in pairs)
    return simulate(Scene("start", bodies, contacts=contacts, gravity=on_slope(slope), duration=1.0))


@pytest.mark.parametrize("count", SCENES)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_no_artificial_impact(count: int, restitution: float, friction: float) -> None:
    run = started(count, friction, restitution)
    assert run.simulated == 1.0
    assert not np.any(run.events["kind"] == EventKind.IMPACT)
    assert np.any(run.events["kind"] == EventKind.CLOSE)
    # What rounding leaves of the balance of forces acts for a second on what nothing holds.
    assert run.q[-1] == pytest.approx(run.q[0], abs=1e-10)
    assert run.u[-1] == pytest.approx(np.zeros(run.u.shape[1]), abs=1e-10)


@pytest.mark.parametrize("count", [2, 4, 6])
def test_a_stack_on_a_slope_slides_as_one(count: int) -> None:
    """With little friction at the ground only, g (sin a - mu cos a) for all; between the blocks it sticks."""
    slope, mu = 0.2, 0.1
    bodies, pairs = SCENES[count]
    contacts = tuple(Contact((Side(first), Side(last)), mu if last == "ground" else 0.5, 0.0) for first, last in pairs)
    run = simulate(Scene("start", bodies, contacts=contacts, gravity=on_slope(slope), duration=0.5))
    way = 0.5 * 9.81 * (math.sin(slope) - mu * math.cos(slope)) * 0.5**2
    assert not np.any(run.events["kind"] == EventKind.IMPACT)
    assert run.q[-1, ::3] == pytest.approx(np.full(count // 2, way), rel=1e-9)
    assert run.q[-1, 2::3] == pytest.approx(np.zeros(count // 2), abs=1e-10)
