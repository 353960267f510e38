"""How often does an outline run round a point: by its edges, and by the angle that a point on it sweeps as it runs along?"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from watchsim.geometry.loops import Inside, Loop, winding
from watchsim.geometry.primitives import TURN, Arc, Edge, Line

STEPS = 400  # along each edge
NEAR = 5e-3  # of the outline's size: so near to an arc its chords do not tell


def arc_between(a: complex, b: complex, sweep: float) -> Arc:
    """The arc from a to b that turns by `sweep` on its way."""
    centre = 0.5 * (a + b) + 0.5j * (b - a) / math.tan(0.5 * sweep)
    return Arc(centre.real, centre.imag, abs(a - centre), cmath.phase(a - centre), sweep)


def made_up(rng: np.random.Generator, count: int) -> Loop:
    """A loop of lines and arcs that may cross itself; arcs turn by up to a whole turn, either way."""
    corners = rng.uniform(-1.0, 1.0, count) + 1j * rng.uniform(-1.0, 1.0, count)
    edges: list[Edge] = []
    for a, b in zip(corners, np.roll(corners, -1), strict=True):
        sweep = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 5.5))
        edges.append(arc_between(a, b, sweep) if rng.random() < 0.7 else Line(a.real, a.imag, b.real, b.imag))
    return Loop(tuple(edges))


def dense(loop: Loop) -> np.ndarray:
    return np.concatenate([[complex(*edge.point(share)) for share in np.linspace(0.0, 1.0, STEPS)] for edge in loop.edges])


def turns(points: np.ndarray, p: complex) -> int:
    steps = np.angle((np.append(points[1:], points[0]) - p) / (points - p))
    return round(float(steps.sum()) / TURN)


@pytest.mark.parametrize("count", [2, 3, 7, 40])
@pytest.mark.parametrize("shift", [0.0, 30.0])
def test_against_the_angle_swept(count: int, shift: float) -> None:
    """Also far from the origin, where what is measured from there would give other strips."""
    rng = np.random.default_rng(count)
    loop = made_up(rng, count).moved(0.0, (shift, -shift))
    points = dense(loop)
    size = float(np.abs(points - points.mean()).max())
    inside, asked, found = Inside(loop), 0, set()
    for _ in range(300):
        p = points.mean() + size * complex(*rng.uniform(-1.0, 1.0, 2))
        if np.abs(points - p).min() > NEAR * size:
            asked += 1
            truth = turns(points, p)
            assert winding(loop, (p.real, p.imag)) == inside.winding((p.real, p.imag)) == truth
            found.add(truth)
    assert asked > 200 and len(found) > 1


@pytest.mark.parametrize("sweep", [-TURN, TURN])
def test_a_circle(sweep: float) -> None:
    """From any start: points within, beside, above and below, level with its start as well."""
    for start in np.linspace(-4.0, 4.0, 9):
        loop = Loop((Arc(1.0, -2.0, 0.5, float(start), sweep),))
        inside, level = Inside(loop), loop.edges[0].start[1]
        for x in (0.4, 0.6, 0.9, 1.3, 1.6):
            for y in (-2.6, -2.4, -2.0, -1.7, -1.4, level):
                away = math.hypot(x - 1.0, y + 2.0) - 0.5
                if abs(away) > 1e-6:
                    truth = 0 if away > 0.0 else round(sweep / TURN)
                    assert winding(loop, (x, y)) == inside.winding((x, y)) == truth
