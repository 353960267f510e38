"""Where does a body stand in the frame of the one that carries it?"""

from __future__ import annotations

import pytest

import watchsim as ws
from watchsim.candidates.cell_frame import MOVEMENT, seen_from
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import FIXED
from watchsim.profiles_path import profiles_dir


def carried() -> list[tuple[object, int, int]]:
    """Bodies, the number of one that is carried, and of what carries it."""
    bodies = compile_scene(ws.load(profiles_dir() / "carriage")).model.bodies
    return [(bodies, b, int(bodies[b].carrier)) for b in range(len(bodies)) if bodies[b].carrier >= 0]


@pytest.mark.parametrize("k", range(len(carried())))
def test_a_carried_body_stands_where_it_hangs(k: int) -> None:
    bodies, b, frame = carried()[k]
    seen, itself = seen_from(bodies, b, frame), seen_from(bodies, frame, frame)
    assert (seen.x, seen.y, seen.carrier) == (bodies[b].x, bodies[b].y, -1)
    assert (itself.motion, itself.x, itself.y, itself.angle, itself.c, itself.s) == (FIXED, 0.0, 0.0, 0.0, 1.0, 0.0)
    assert seen_from(bodies, b, MOVEMENT).x == bodies[b].x
