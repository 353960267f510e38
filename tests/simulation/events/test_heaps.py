"""Do free bodies that tumble onto each other, stick, slide and rock come to rest, or to the end of the run?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from moving_scenes import box, circle, ground

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

WIDE = 0.015  # m, half the width of the slot
PLACES = {
    "floor": ground(),
    "groove": Body("ground", "fixed", loops=(Loop((Line(0.1, 0.1, 0.0, 0.0), Line(0.0, 0.0, -0.1, 0.1)), closed=False),)),
    "slot": Body(
        "ground",
        "fixed",
        loops=(Loop((Line(WIDE, 1.0, WIDE, 0.0), Line(WIDE, 0.0, -WIDE, 0.0), Line(-WIDE, 0.0, -WIDE, 1.0)), closed=False),),
    ),
}


def falling(rng: np.random.Generator, name: str, bottom: float) -> tuple[Body, float]:
    """A disc or a block thrown from above `bottom`, and the height of its top."""
    width, height = rng.uniform(2e-3, 2e-2, 2)
    reach, inertia, loop = 0.5 * math.hypot(width, height), 0.01 * (width**2 + height**2) / 12.0, box(width, height)
    if rng.random() < 0.3:
        reach, inertia, loop = 0.5 * height, 0.005 * (0.5 * height) ** 2, circle(0.5 * height)
    y = bottom + reach + float(rng.uniform(1e-4, 2e-3))
    velocity = (0.1 * float(rng.normal()), 0.1 * float(rng.normal()), 5.0 * float(rng.normal()))
    body = Body(
        name,
        "free",
        (0.0, y),
        angle=float(rng.uniform(-1.0, 1.0)),
        velocity=velocity,
        mass=0.01,
        inertia=float(inertia),
        loops=(loop,),
    )
    return body, y + reach


def heap(rng: np.random.Generator, place: str, count: int) -> Scene:
    bodies, top = [], 0.02 if place == "groove" else 0.0
    for i in range(count):
        body, top = falling(rng, f"body{i}", top)
        bodies.append(body)
    names = [*(body.name for body in bodies), "ground"]
    friction, restitution = float(rng.choice([0.1, 0.3, 0.6, 1.0])), float(rng.choice([0.0, 0.2, 0.5]))
    contacts = tuple(
        Contact((Side(one), Side(other)), friction, restitution) for i, one in enumerate(names) for other in names[i + 1 :]
    )
    return Scene(f"{place} with {count}", (*bodies, PLACES[place]), contacts=contacts, gravity=(0.0, -9.81), duration=1.0)


MANY = 12  # scenes
SOME = [(place, count, (MANY, 2, 1)[count - 1]) for place in PLACES for count in (1, 2, 3) if (place, count) != ("groove", 3)]
ALL = [pytest.param(place, count, MANY, marks=pytest.mark.slow) for place, count, scenes in SOME if scenes < MANY]


@pytest.mark.parametrize(("place", "count", "scenes"), [*SOME, *ALL])
def test_a_heap_comes_to_the_end(place: str, count: int, scenes: int) -> None:
    """No hang, no stop, nothing runs into anything, and the energy ledger closes."""
    rng = np.random.default_rng(22)
    for number in range(scenes):
        run = simulate(heap(rng, place, count))
        assert run.stop == Stop.DURATION, number
        assert run.worst_penetration < 1e-9
        assert run.energy["residual_relative"] < 1e-6


def test_a_long_flight_does_not_make_short_looks() -> None:
    """A disc that leaves a corner with no force, and might fly for long: with bounds of the whole flight it took 63 million."""
    rng = np.random.default_rng(2)
    scene = [heap(rng, "floor", 3) for _ in range(10)][-1]
    run = simulate(scene, 0.4)
    assert run.stop == Stop.DURATION
    assert run.counts["gap_evaluations"] < 5_000_000
