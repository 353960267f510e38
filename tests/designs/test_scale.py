"""Is a design whose lengths are all a quarter longer the same design, a quarter larger?

Masses, springs and torques do not decide what is drawn, and angles stay. A constant length in the construction, or a size by
which is divided where it should multiply, shows in any outline that does not grow.
"""

import numpy as np
import pytest

import watchsim as ws
from watchsim.construction.registry import design, names
from watchsim.geometry.primitives import Arc

FACTOR = 1.25
UNSIZED = {"winder"}  # an axle of the remontoir: what drives it is no part of its design


def lengths(scene: ws.Scene) -> dict[str, np.ndarray]:
    """Of every body: every length (m) of its outlines, and where it sits."""
    found = {}
    for body in scene.bodies:
        numbers = [*body.position]
        for edge in (edge for loop in body.loops for edge in loop.edges):
            numbers += [edge.x, edge.y, edge.radius] if isinstance(edge, Arc) else [edge.x0, edge.y0, edge.x1, edge.y1]
        found[body.name] = np.array(numbers)
    return found


@pytest.mark.parametrize("name", names())
def test_larger_by_a_quarter(name: str) -> None:
    make = getattr(ws.designs, name)
    longer = {one.name: one.shown(FACTOR * one.default) for one in design(name).dimensions if one.unit == "mm"}
    usual, large = lengths(make().scene()), lengths(make(**longer).scene())
    assert longer and list(usual) == list(large)
    for body, numbers in ((body, numbers) for body, numbers in usual.items() if body not in UNSIZED):
        assert large[body] == pytest.approx(FACTOR * numbers, rel=1e-9, abs=1e-12), body
