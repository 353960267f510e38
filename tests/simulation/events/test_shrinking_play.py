"""Do rebounds without loss go on where something resists or their play stays, and end where it closes without resistance?"""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from moving_scenes import box, of_kind, touching

from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.options import options_for
from watchsim.simulation.simulate import simulate

WIDTH, SPEED = 0.01, 1.0  # m, m/s
ROCKING = Path(__file__).resolve().parents[2] / "data" / "hunt" / "levers-2001-15091.toml"
SHORT = options_for(1.0, 1e-9, 1.0).accumulation_time


def slider(name: str, place: float, velocity: float, mass: float) -> Body:
    """A box that slides along x, its middle at `place`."""
    return Body(name, "slide", (place, 0.0), axis=(1.0, 0.0), velocity=(velocity,), mass=mass, loops=(box(WIDTH, WIDTH),))


def wall(name: str, place: float) -> Body:
    return Body(name, "fixed", (place, 0.0), loops=(box(WIDTH, WIDTH),))


@pytest.mark.parametrize("ratio", [1e2, 1e6])
def test_a_light_body_between_a_wall_and_a_heavy_one_counts_the_digits_of_pi(ratio: float) -> None:
    """Galperin: unfolded, the motion is a straight line past a corner of atan(sqrt(m/M)), each of whose faces it meets."""
    bodies = wall("wall", -WIDTH), slider("light", 0.001, 0.0, 1.0), slider("heavy", 0.002 + WIDTH, -SPEED, ratio)
    contacts = touching("wall", "light", restitution=1.0) + touching("light", "heavy", restitution=1.0)
    run = simulate(Scene("pi", bodies, contacts=contacts, duration=0.02))
    hits = of_kind(run, EventKind.IMPACT)
    angle = math.atan(math.sqrt(1.0 / ratio))
    assert len({hit["t"] for hit in hits}) == math.ceil(math.pi / angle) - 1
    assert 0.5 * (run.u[-1] ** 2) @ [1.0, ratio] == pytest.approx(0.5 * ratio * SPEED**2, rel=1e-9)
    if ratio > 1e4:  # closer than the time within which rebounds may be ended
        assert np.diff([hit["t"] for hit in hits]).min() < 0.1 * SHORT


def test_a_body_between_two_walls_goes_on() -> None:
    play, many = 2e-7, 5000
    bodies = wall("left", -WIDTH), slider("body", 0.5 * play, SPEED, 1.0), wall("right", WIDTH + play)
    contacts = touching("left", "body", restitution=1.0) + touching("body", "right", restitution=1.0)
    run = simulate(Scene("play", bodies, contacts=contacts, duration=many * play / SPEED))
    assert play < 0.5 * SPEED * SHORT
    assert len(of_kind(run, EventKind.IMPACT)) == pytest.approx(many, abs=1)
    assert abs(run.u[-1, 0]) == pytest.approx(SPEED, rel=1e-12)


def test_levers_that_rock_flat_on_each_other_end_where_any_loss_leaves_them() -> None:
    """Nearly flat, two levers throw each other from corner to corner; their play closes by a factor e in 6 ms."""
    scene = load(ROCKING)
    run = simulate(scene)
    lossy = tuple(dataclasses.replace(contact, restitution=min(contact.restitution, 0.99)) for contact in scene.contacts)
    assert of_kind(run, EventKind.ACCUMULATION)
    assert abs(run.u[-1]).max() == 0.0
    assert run.q[-1] == pytest.approx(simulate(dataclasses.replace(scene, contacts=lossy)).q[-1], abs=1e-11)


def test_which_rebounds_end_belongs_to_the_state() -> None:
    scene = load(ROCKING)
    whole, first = simulate(scene, 0.106), simulate(scene, 0.1055)
    after = whole.t >= 0.1055
    assert not of_kind(first, EventKind.ACCUMULATION)
    rest = simulate(scene, 0.106, start=first)
    assert np.array_equal(rest.events, whole.events)
    assert np.array_equal(rest.q[rest.t >= 0.1055], whole.q[after])
