"""Do convex pieces fill the outline they were cut from?"""

import math
from itertools import pairwise

import pytest

from watchsim.bench.engines.convex import Circle, convex_pieces
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load


def area(points):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))


def is_convex(points):
    turns = [
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        for a, b, c in zip(points, points[1:] + points[:1], points[2:] + points[:2], strict=True)
    ]
    return min(turns) > 0.0


@pytest.mark.parametrize("body", ["wheel", "lever"])
def test_the_pieces_of_a_body_fill_it(body: str) -> None:
    for loop in load(profiles_dir() / "bench_lever" / "scene.toml").body(body).loops:
        pieces = convex_pieces(loop, 1e-7)
        assert all(isinstance(piece, tuple) and is_convex(piece) and len(piece) <= 8 for piece in pieces)
        whole = area(tuple(edge.start for edge in loop.edges))
        assert sum(area(piece) for piece in pieces) == pytest.approx(whole, rel=1e-9, abs=0.0)


def test_a_full_circle_stays_one() -> None:
    assert convex_pieces(Loop((Arc(1.0, 2.0, 0.5, 0.0, 2.0 * math.pi),)), 1e-3) == [Circle((1.0, 2.0), 0.5)]


def test_an_arc_becomes_chords_that_stray_no_further_than_asked() -> None:
    half = Loop((Arc(0.0, 0.0, 1.0, 0.0, math.pi), Line(-1.0, 0.0, 1.0, 0.0)))
    corners = {corner for piece in convex_pieces(half, 0.01) for corner in piece}
    angles = sorted(math.atan2(y, x) % math.tau for x, y in corners)
    sagitta = [1.0 - math.cos(0.5 * (after - before)) for before, after in pairwise(angles)]
    assert 0.002 < max(sagitta) <= 0.01


@pytest.mark.parametrize("loop", [Loop((Arc(0.0, 0.0, 1.0, 0.0, -6.283185307179586),), hole=True)])
def test_holes_are_refused(loop: Loop) -> None:
    with pytest.raises(ValueError, match="cannot be filled"):
        convex_pieces(loop, 1e-3)
