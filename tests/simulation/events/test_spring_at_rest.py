"""Do bodies part where a spring that pushes one against the other passes its rest?

There all forces vanish together, so that none of them tells what rounding is. Closed form: the pushed body flies on with the
speed ω x₀ of both, ω² = k / (m₁ + m₂), from a quarter period on.
"""

from __future__ import annotations

import math

import pytest
from moving_scenes import polygon, turned

from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate

STIFFNESS, PUSHING, PUSHED, DRAWN = 32.45, 0.02, 0.03, 6e-3


def pushed(tilt: float, place: float, friction: float) -> Scene:
    """A corner at the rest of its spring + DRAWN pushes a face that leans by `tilt`; the pusher is drawn at `place`."""
    corner = polygon((-0.01, -0.004), (0.0, 0.0), (-0.01, 0.004))
    lean = 0.01 * math.tan(tilt)
    face = polygon((0.01, -0.01), (0.01, 0.01), (-lean, 0.01), (lean, -0.01))
    a = Body("a", "slide", (-DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHING, loops=(corner,))
    b = Body("b", "slide", (-DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHED, loops=(face,))
    return Scene(
        "pushed",
        (a, b),
        springs=(Spring("a", STIFFNESS, DRAWN),),
        contacts=(Contact((Side("a"), Side("b")), friction, 0.0),),
        duration=0.15,
    )


@pytest.mark.parametrize("friction", [0.0, 0.79])
@pytest.mark.parametrize("place", [0.0, 1e-3 / 3.0, -1e-3 / 7.0])
@pytest.mark.parametrize("tilt", [0.0, 0.3, -0.4])
@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
def test_part_at_rest(tilt: float, place: float, friction: float, tolerance: float) -> None:
    run = simulate(pushed(tilt, place, friction), tolerance=tolerance)
    assert not run.stop.gave_up
    rate = math.sqrt(STIFFNESS / (PUSHING + PUSHED))
    quarter = 0.5 * math.pi / rate
    opened = run.events[run.events["kind"] == EventKind.OPEN]
    # The force may vanish within its rounding, 1e-10 of that of a spring stretched by the size.
    assert opened["t"] == pytest.approx([quarter], abs=10.0 * tolerance * quarter)
    assert run.u[-1, 1] == pytest.approx(rate * DRAWN, rel=10.0 * tolerance)
    travelled = DRAWN + rate * DRAWN * (run.simulated - quarter)
    assert run.q[-1, 1] - run.q[0, 1] == pytest.approx(travelled, rel=10.0 * tolerance)


@pytest.mark.parametrize("turn", [0.0, 1.3, 0.16 * 26])  # the last was one of 360 starts in which no time went on
def test_a_row_parts_at_rest(turn: float) -> None:
    """The middle one of three has no spring: what it passes on has the rounding of the force that the spring loses."""
    place = 1e-3 / 3.0
    wedge = polygon((-0.004, -0.004), (0.004, 0.0), (-0.004, 0.004))
    blocks = tuple(
        Body(name, "slide", (0.008 * i - DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHED, loops=(wedge,))
        for i, name in enumerate("abc")
    )
    contacts = tuple(Contact((Side(one), Side(other)), 0.0, 0.0) for one, other in ("ab", "bc"))
    scene = Scene("row", blocks, springs=(Spring("a", STIFFNESS, DRAWN),), contacts=contacts, duration=0.15)
    run = simulate(turned(scene, turn))
    assert not run.stop.gave_up
    rate = math.sqrt(STIFFNESS / (3.0 * PUSHED))
    assert run.u[-1, 1:] == pytest.approx([rate * DRAWN] * 2, rel=1e-8)
    after = run.simulated - 0.5 * math.pi / rate
    assert run.q[-1, 1:] - run.q[0, 1:] == pytest.approx([DRAWN + rate * DRAWN * after] * 2, rel=1e-8)
