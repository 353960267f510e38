"""Do biarcs meet their points and tangents?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.geometry.fitting.biarc import arc_from, arcs_from, biarc_joints
from watchsim.geometry.primitives import Arc, Line


def test_arc_from_semicircle_and_line() -> None:
    arc = arc_from((0.0, 0.0), (0.0, -1.0), (2.0, 0.0))
    assert isinstance(arc, Arc)
    assert (arc.x, arc.y, arc.radius, arc.sweep) == pytest.approx((1.0, 0.0, 1.0, math.pi))
    assert isinstance(arc_from((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), Line)


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
