"""Is a cell a small step for the outermost point of the body that its coordinate moves, and do cells make whole turns?"""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np
import pytest
from test_cell_travel import coordinates, curve, each_case, made, poses, seen

from watchsim.candidates import cell_grid
from watchsim.candidates.cell_frame import TRAVEL, TURN, Axis
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import Model
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

COARSE, FINE = 0.02, 0.01  # of the reach: of outlines of few long pieces, of many short ones


def movers(case: tuple[str | bool | float, ...]) -> list[int]:
    """Which of the two bodies move in the frame of their cells."""
    if len(case) == 2:
        return [i for i in (0, 1) if case[i] != "fixed"]
    return [0] if case[1] in ("carrier", "part", "fixed") else [0, 1]


@each_case
def test_a_cell_is_a_fiftieth_of_the_reach_however_a_body_is_geared(case: tuple[str | bool | float, ...]) -> None:
    """One cell further no point has moved more, and the outermost one nearly as far; so many cells are one turn."""
    scene, compiled = made.__wrapped__(*case)
    pair, rng, primitives = compiled.model.pairs[0], np.random.default_rng(4), compiled.model.primitives
    curves = [np.concatenate([curve(row) for row in primitives[primitives.body == b]]) for b in (pair.a, pair.b)]
    step = COARSE * max(float(np.abs(curves[i]).max()) for i in movers(case))
    at, rest = rng.uniform(-3.0, 3.0, pair.axes), rng.uniform(-3.0, 3.0, len(compiled.q))
    for i, way in enumerate(np.eye(pair.axes)):
        size, wrap = float(pair[f"size{i}"]), int(pair[f"wrap{i}"])
        before, beside, round_ = (
            poses(scene, compiled, coordinates(compiled, at + n * size * way, rest)) for n in (0, 1, wrap)
        )
        moved = []
        for order in ([0, 1], [1, 0]):
            a, b = order
            one, other, back = (seen(curves[a], both[a], both[b]) for both in (before, beside, round_))
            moved.append(float(np.abs(other - one).max()))
            assert np.abs(back - one).max() < 1e-9
        # Seen from the body that this coordinate moves the other one goes farther.
        assert min(moved) <= step * (1.0 + 1e-9)
        is_carried = len(case) > 2 and i == 0 and int(pair.axes) > 1
        assert min(moved) > (0.2 if is_carried else 0.99) * step or len(movers(case)) == 2
        assert max(moved) > 0.2 * step


def turning(shape: Loop, met: Loop, motion: str = "slide", away: float = 0.5) -> Model:
    """What stands for a body of that shape which turns beside another one, by default one that slides."""
    a = Body("a", "pivot", (0.0, 0.0), inertia=1.0, loops=(shape,))
    b = Body("b", motion, (away, 0.0), mass=1.0, inertia=1.0, loops=(met,))
    return compile_scene(Scene("sizes", (a, b), contacts=(Contact((Side("a"), Side("b"))),))).model


def spiral(length: float, size: float, round_: bool = False) -> Loop:
    """Pieces of that length, chords or arcs, nearly once round from 0.9 of the size to all of it; a chord closes it."""
    bend = 3.0 * length
    chord = 2.0 * bend * math.sin(0.5 * length / bend) if round_ else length
    corners, angle = [size + 0.0j], 0.0
    while angle < 5.5:
        near = size * (1.0 - 0.018 * angle)
        angle += chord / near
        corners.append(corners[-1] + chord * np.exp(1j * (angle - 0.5 * chord / near + 0.5 * math.pi + 0.018)))
    pieces: list[Edge] = []
    for a, b in pairwise(corners):
        centre = 0.5 * (a + b) - 1j * (b - a) / chord * math.sqrt(bend**2 - 0.25 * chord**2)
        sweep = float(np.angle((b - centre) / (a - centre)))
        arc = Arc(centre.real, centre.imag, bend, float(np.angle(a - centre)), sweep)
        pieces.append(arc if round_ else Line(a.real, a.imag, b.real, b.imag))
    a, b = corners[-1], corners[0]
    return Loop((*pieces, Line(a.real, a.imag, b.real, b.imag)))


def wedge(size: float) -> Loop:
    """Three lines and as many corners."""
    return Loop((Line(-size, 0.0, size, 0.0), Line(size, 0.0, 0.0, 0.6 * size), Line(0.0, 0.6 * size, -size, 0.0)))


@pytest.mark.parametrize("round_", [False, True], ids=["chords", "arcs"])
@pytest.mark.parametrize("size", [1.0, 1e-3])
@pytest.mark.parametrize(("piece", "step"), [(0.3, COARSE), (0.021, COARSE), (0.019, 0.019), (0.012, 0.012), (0.009, FINE)])
def test_outlines_of_short_pieces_have_finer_cells(piece: float, step: float, size: float, round_: bool) -> None:
    """As long as a usual piece, within limits, in shares of the reach; in any unit of length."""
    pair = turning(spiral(piece * size, size, round_), wedge(0.5 * size), away=0.5 * size).pairs[0]
    assert pair.fold0 == 1
    assert pair.wrap0 == math.ceil(2.0 * math.pi / step)
    assert pair.size0 * pair.wrap0 == pytest.approx(2.0 * math.pi, rel=1e-14, abs=0.0)
    assert (pair.size1, pair.wrap1, pair.fold1) == (pytest.approx(step * size, rel=1e-6), 0, 1)


def test_a_small_body_beside_a_large_one_has_a_few_cells_in_a_turn() -> None:
    """Though even its outermost point gets less far in half a turn than the large one in a cell."""
    pair = turning(spiral(0.002, 0.004), spiral(0.1, 1.0), "pivot", 1.0).pairs[0]
    assert pair.wrap0 == 8
    assert pair.wrap1 == math.ceil(2.0 * math.pi / FINE)


@pytest.mark.parametrize("teeth", [5, 7, 60])
def test_alike_parts_of_a_turn_have_the_same_number_of_cells(teeth: int) -> None:
    """The least number of cells that are not too large."""
    corners = np.exp(2j * math.pi * np.arange(teeth) / teeth)
    toothed = Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in zip(corners, np.roll(corners, -1), strict=True)))
    pair = turning(toothed, wedge(0.5)).pairs[0]
    assert pair.fold0 == teeth
    assert pair.wrap0 == next(n for n in range(0, 9999, teeth) if n >= 2.0 * math.pi / COARSE)


def test_few_contacts_are_not_worth_cells() -> None:
    """Three corners and three lines of one body meet those of another in 18 ways; a search costs more than it saves."""
    assert turning(wedge(1.0), wedge(1.0)).pairs[0].listed == 0
    assert turning(wedge(1.0), spiral(0.3, 1.0)).pairs[0].listed == 1


def cornered(corners: int, size: float) -> Loop:
    """Corners evenly round the origin."""
    points = [cmath.rect(size, 2.0 * math.pi * k / corners) for k in range(corners)]
    return Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in zip(points, points[1:] + points[:1], strict=True)))


@pytest.mark.parametrize(("most", "folds"), [(20, (5, 4)), (19, (5, 1)), (5, (5, 1)), (4, (1, 4)), (3, (1, 1))])
def test_both_bodies_share_the_most_parts(most: int, folds: tuple[int, int], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cell_grid, "MOST_PARTS", most)
    pair = turning(cornered(5, 1.0), cornered(4, 0.9), "pivot").pairs[0]
    assert (pair.fold0, pair.fold1) == folds and pair.wrap0 % folds[0] == pair.wrap1 % folds[1] == 0


@pytest.mark.parametrize("carried", [False, True])
@pytest.mark.parametrize("motion", ["slide", "free", "pivot", "fixed"])
def test_how_far_apart_bodies_that_travel_cannot_touch(motion: str, carried: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both outermost points and the clearance of each; of what hangs on the first body of all nothing is known."""
    monkeypatch.setattr(cell_grid, "FEW_CONTACTS", 0)
    rail = Body("rail", "slide", (0.0, 0.0), mass=1.0)
    on = "rail" if carried else None
    a = Body("a", "pivot" if carried else "fixed", (0.1, 0.2), mass=1.0, inertia=1.0, loops=(cornered(5, 0.7),), on=on)
    b = Body("b", motion, (0.5, 0.1), mass=1.0, inertia=1.0, loops=(cornered(7, 0.3),))
    pair = compile_scene(Scene("far", (rail, a, b), contacts=(Contact((Side("a"), Side("b"))),))).model.pairs[0]
    assert pair.axes == {"slide": 1, "free": 3, "pivot": 1, "fixed": 0}[motion] + 2 * carried or pair.axes == 0
    if carried or motion in ("pivot", "fixed"):
        assert pair.reach == 0.0
    else:
        assert pair.reach - 2.0 * pair.clearance == pytest.approx(0.7 + 0.3, rel=1e-9) and pair.clearance > 1e-4


@pytest.mark.parametrize("kind", [TURN, TRAVEL])
@pytest.mark.parametrize("ratio", [1.0, -0.4, 2.5])
def test_cells_of_what_is_geared(kind: int, ratio: float) -> None:
    """So much smaller as the body goes faster; of a turn as many as before, and eight at least."""
    for travel, arm, reach, fold in ((0.03, 0.4, 0.7, 5), (0.9, 0.1, 0.2, 3), (0.9, 0.1, 0.2, 1)):
        found = cell_grid._cells(Axis(0, 4, 2, kind, arm), travel, reach, fold, ratio)
        cells = fold * math.ceil(max(8.0, math.tau * (arm + reach) / travel) / fold)
        wanted = (4, 2, math.tau / cells / abs(ratio), cells, fold) if kind == TURN else (4, 2, travel / abs(ratio), 0, 1)
        assert tuple(found) == pytest.approx(wanted, rel=1e-14, abs=0.0)
    usual = cell_grid._cells(Axis(0, 4, -1, kind, 0.3), 0.02, 0.6)
    assert tuple(usual) == tuple(cell_grid._cells(Axis(0, 4, -1, kind, 0.3), 0.02, 0.6, 1, 1.0))
