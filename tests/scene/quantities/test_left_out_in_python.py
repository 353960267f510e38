"""What holds of records made in Python where nothing is said?"""

from __future__ import annotations

import math

import pytest

from watchsim.scene.forces import Contact, Damping, LineSpring, Side, Spring, Torque
from watchsim.scene.roles import Oscillator
from watchsim.scene.scene import (
    ALL,
    EVENTS,
    EVERYTHING,
    STATISTICS,
    WHOLE_RUN,
    Body,
    Gear,
    Prescribed,
    Recording,
    Scene,
    as_recording,
)
from watchsim.scene.solids import Solid, Weight
from watchsim.scene.trains import MOVEMENT, Bond, Ride, Weighed

ZERO = (0.0, 0.0)


def test_bodies_and_scenes() -> None:
    body, scene = Body("a"), Scene("t", ())
    assert (body.motion, body.position, body.angle, body.velocity, body.axis) == ("pivot", ZERO, 0.0, (), (1.0, 0.0))
    assert (body.mass, body.inertia, body.centre_of_mass, body.loops, body.decoration) == (0.0, 0.0, ZERO, (), ())
    assert (scene.gravity, scene.tangential_law, scene.nu, scene.duration) == (ZERO, "coulomb", 0.0, 1.0)
    assert (scene.tolerance, scene.record, scene.lift_angle, scene.nominal) == (1e-9, EVERYTHING, None, None)
    assert (scene.springs, scene.contacts, scene.gears, scene.line_springs, scene.expect) == ((), (), (), (), ())


def test_forces_contacts_and_gears() -> None:
    assert Spring("a", 3.0) == Spring("a", 3.0, 0.0, None, None, None, None, 0.0)
    assert LineSpring(("a", None), (ZERO, ZERO), 3.0, 1.0).viscous == 0.0
    assert Torque("a") == Torque("a", 0.0, "constant", (), None, None, None)
    assert Damping("a") == Damping("a", 0.0, 0.0, 0.0, None)
    assert Contact((Side("a"), Side("b"))) == Contact((Side("a", None), Side("b", None)), 0.0, 0.0, 0.0)
    assert Gear(("a", "b"), 3.0, 0.1) == Gear(("a", "b"), 3.0, 0.1, 0.0, 1.0, math.radians(20.0))
    assert Prescribed() == Prescribed(0.0, 0.0, ())


def test_what_carries_and_what_weighs() -> None:
    assert Ride(5) == Ride(5, -1, ZERO, -1, 0.0, 0.0, 0.0) and MOVEMENT == -1
    assert Weighed() == Weighed(0.0, ZERO, 0.0)
    assert Bond(5) == Bond(5, 1.0, 0.0, 1.0, 0.0)
    assert Oscillator("a", 1.0, 2.0, 3.0, 4.0).weight == 0.0
    solid = Solid("plate", "L", Weight(1.0, ZERO, 1.0), 8.0)
    assert (solid.loops, solid.thickness, solid.pivot, solid.count, solid.width, solid.bores) == ((), 0.0, ZERO, 1, 0.0, ())


@pytest.mark.parametrize(
    ("recording", "tail", "windows"),
    [
        (Recording(), False, WHOLE_RUN),
        (Recording(((1.0, 2.0),)), False, ((1.0, 2.0),)),
        (Recording(keep=EVENTS), True, ()),
        (Recording(((1.0, 2.0),), EVENTS), True, ((1.0, 2.0),)),
        (Recording(keep=STATISTICS), True, ()),
    ],
)
def test_what_is_kept_of_a_run(recording: Recording, tail: bool, windows: tuple[tuple[float, float], ...]) -> None:
    assert recording.has_tail is tail and recording.row_windows == windows
    assert ((-math.inf, math.inf),) == WHOLE_RUN and Recording().keep == ALL and Recording().stride == 1


def test_recordings_from_what_is_convenient() -> None:
    assert as_recording(None) is None and as_recording(EVERYTHING) is EVERYTHING
    assert as_recording("statistics") == Recording(keep=STATISTICS)
    assert as_recording([(1, 2), (4, 7)]) == Recording(((1.0, 2.0), (4.0, 7.0)))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"keep": "some"}, '"some" cannot be kept; choose from all, events, statistics'),
        ({"stride": 0}, "n must be at least 1, not 0"),
        ({"windows": ((2.0, 2.0),)}, "not from 2 s to 2 s"),
        ({"windows": ((1.0, 2.0), (5.0, 4.0))}, "not from 5 s to 4 s"),
    ],
)
def test_what_cannot_be_kept(more: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Recording(**more)  # type: ignore[arg-type]
