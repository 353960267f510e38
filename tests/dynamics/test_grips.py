"""Below which velocity does a bearing with dry friction count as held? The same of a turn and of a travel, in any size."""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics.bearing_friction import set_grips
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Damping
from watchsim.scene.scene import Scene
from watchsim.simulation.loop_state.state import new_state
from watchsim.simulation.motion.contact_mode_end import _slack
from watchsim.simulation.options import options_for

_grips, _how_far_on = callable_kernel(set_grips), callable_kernel(_slack)
APART = 4.0  # m or mm, of the bodies: the size of the scene


@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_points_at_the_size_of_the_scene_may_move_so_fast(unit: float) -> None:
    """An angle by its rate times the size, a travel by itself; another island and a body without friction are left alone."""
    bodies = (
        Body("wheel", "pivot", (0.0, 0.0), inertia=1.0),
        Body("slide", "slide", (APART * unit, 0.0), mass=1.0),
        Body("free running", "pivot", (0.0, 0.0), inertia=1.0),
        Body("elsewhere", "pivot", (0.0, 0.0), inertia=1.0),
    )
    damping = tuple(Damping(body.name, coulomb=1e-3) for body in bodies if body.name != "free running")
    compiled = compile_scene(Scene("grips", bodies, damping=damping))
    size = float(compiled.model.coordinates[1].scale)
    options = options_for(size, 1e-9, 1.0)
    slowest = np.array([options.speed_zero / size, options.speed_zero, 0.0, 0.0])
    for share, expected in ((0.99, STICK), (1.01, FORWARD), (-0.99, STICK), (-1.01, BACKWARD)):
        grip = np.full(4, 77)
        _grips(compiled.model, share * slowest, np.array([3, 3, 3, 1]), 3, options, grip)
        assert grip.tolist() == [expected, expected, OPEN, 77]
    state = new_state(compiled.model, np.zeros(4), np.zeros(4))
    state.grip[:] = FORWARD
    # Reversals are looked for a little beyond them, by half of that.
    beyond = [_how_far_on(compiled.model, state, options, code) for code in range(2)]
    assert beyond == pytest.approx((0.5 * slowest[:2]).tolist(), rel=1e-12)
    state.grip[:] = STICK
    assert [_how_far_on(compiled.model, state, options, code) for code in range(2)] == [0.0, 0.0]
