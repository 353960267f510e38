"""Do biarcs meet their points and tangents?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.biarcs import arc_from, arcs_from, biarc_joints
from watchsim.geometry.primitives import Arc, Line


def test_arc_from_semicircle_and_line() -> None:
    arc = arc_from((0.0, 0.0), (0.0, -1.0), (2.0, 0.0))
    assert isinstance(arc, Arc)
    assert (arc.x, arc.y, arc.radius, arc.sweep) == pytest.approx((1.0, 0.0, 1.0, math.pi))
    assert isinstance(arc_from((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), Line)


@pytest.mark.parametrize("direction", [0.0, 0.5, math.pi / 2, 3.0, -math.pi / 2])
def test_an_arc_of_a_radius_above_a_million_chords_is_a_line(direction: float) -> None:
    """Where it leaves its chord at an angle ε, that is twice ε of a chord over the radius."""
    end = (1.0 + 3e-3 * math.cos(direction), 2.0 + 3e-3 * math.sin(direction))
    for off, kind in ((4.9e-7, Line), (-4.9e-7, Line), (5.1e-7, Arc), (-5.1e-7, Arc)):
        assert type(arc_from((1.0, 2.0), (math.cos(direction + off), math.sin(direction + off)), end)) is kind


@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2), st.floats(1e-6, 10.0), st.floats(-3.2, 3.2), st.floats(0.2, 5.0))
def test_biarc_meets_points_and_tangents(u: float, v: float, length: float, turn: float, ratio: float) -> None:
    p, q = np.array([[0.3, -0.2]]), np.array([[0.3 + length * math.cos(turn), -0.2 + length * math.sin(turn)]])
    tp, tq = (np.array([[math.cos(turn + w), math.sin(turn + w)]]) for w in (u, v))
    joint, along = biarc_joints(p, tp, q, tq, np.array([ratio]))
    arcs = arcs_from(np.concatenate((p, joint)), np.concatenate((tp, along)), np.concatenate((joint, q)))
    first, second = arcs.edges()
    assert first.start == pytest.approx(p[0], abs=1e-9 * length) and second.end == pytest.approx(q[0], abs=1e-9 * length)
    assert first.end == pytest.approx(second.start, abs=1e-9 * length)
    assert first.tangent(0.0) == pytest.approx(tp[0], abs=3e-6) and second.tangent(1.0) == pytest.approx(tq[0], abs=3e-6)
    assert first.tangent(1.0) == pytest.approx(second.tangent(0.0), abs=3e-6)
    assert arcs.end_tangents[0] == pytest.approx(first.tangent(1.0), abs=1e-9)
    for edge, bend in zip((first, second), arcs.curvatures, strict=True):
        assert abs(bend) == pytest.approx(1.0 / edge.radius if isinstance(edge, Arc) else 0.0, rel=1e-9)
