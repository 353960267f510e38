"""Are cells small steps in the right frame, with keys of their own, and are symmetries found where they are?"""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from test_cell_travel import coordinates, curve, each_case, made, poses, seen

import watchsim as ws
from watchsim.contact.cell_frames import MOVEMENT, TRAVEL, TURN, axes_of, choose_frames, seen_from
from watchsim.contact.symmetry import turn_symmetry
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, moved
from watchsim.mechanism.compile import compile_scene
from watchsim.mechanism.contacts import features
from watchsim.model import BODY, BODY_PAIR, FIXED, FREE, PIVOT, SLIDE, Model, Records, records
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene

# Is a cell a small step for the outermost point of the body that its coordinate moves, and do cells make whole turns?

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


# From which body is a pair seen, and on what do places then depend? Bodies made up one by one, answers worked out by hand.

HUB, SECOND, CART, PLATE = "hub", "second", "cart", "plate"  # pivots, slides, is free
MADE: dict[str, dict[str, Any]] = {
    HUB: {"motion": PIVOT, "first": 0, "x": 0.3, "y": -0.2},
    "a": {"motion": PIVOT, "first": 1, "x": 0.12, "y": -0.35, "carrier": HUB},
    "b": {"motion": PIVOT, "first": 2, "x": 0.4, "y": 0.3, "carrier": HUB},
    "part": {"motion": FIXED, "first": -1, "x": 0.28, "y": 0.45, "carrier": HUB},
    "coaxial": {"motion": PIVOT, "first": 3, "x": 0.3, "y": -0.2},
    "above": {"motion": PIVOT, "first": 4, "x": 0.3, "y": 0.5},
    "beside": {"motion": PIVOT, "first": 5, "x": 0.7, "y": -0.2},
    "bar": {"motion": SLIDE, "first": 6, "x": 0.3, "y": -0.2},
    "faster": {"motion": PIVOT, "first": 3, "x": 0.1, "y": 0.2, "carrier": HUB, "ratio": 2.5},
    "shifted": {"motion": PIVOT, "first": 3, "x": 0.1, "y": 0.2, "carrier": HUB, "phase": 0.7},
    "planet": {"motion": PIVOT, "first": 0, "x": 0.1, "y": 0.2, "carrier": HUB, "ratio": 2.5, "phase": 0.6},
    "still": {"motion": PIVOT, "first": 0, "x": 0.1, "y": 0.2, "carrier": HUB, "phase": 0.4},
    SECOND: {"motion": PIVOT, "first": 7, "x": -0.6, "y": 0.9},
    "c": {"motion": PIVOT, "first": 8, "x": 0.1, "y": 0.1, "carrier": SECOND},
    "there": {"motion": PIVOT, "first": 9, "x": -0.6, "y": 0.9, "carrier": HUB},
    "here": {"motion": PIVOT, "first": 9, "x": 0.3, "y": -0.2, "carrier": SECOND},
    CART: {"motion": SLIDE, "first": 10, "x": 0.3, "y": -0.2, "angle": 0.6, "c": math.cos(0.6), "s": math.sin(0.6)},
    "d": {"motion": PIVOT, "first": 11, "x": 0.5, "y": 0.2, "carrier": CART},
    "quick": {"motion": PIVOT, "first": 3, "x": 0.5, "y": 0.2, "carrier": CART, "ratio": 2.5},
    "rack": {"motion": PIVOT, "first": 10, "x": 0.5, "y": 0.2, "carrier": CART, "ratio": 3.5},
    PLATE: {"motion": FREE, "first": 12, "x": 0.0, "y": 0.0},
    "e": {"motion": PIVOT, "first": 15, "x": 0.2, "y": -0.15, "carrier": PLATE},
    "back": {"motion": PIVOT, "first": 14, "x": 0.2, "y": 0.6, "carrier": PLATE, "ratio": -0.4},
}
NUMBER = {name: i for i, name in enumerate(MADE)}


def bodies() -> Records:
    rows = records(BODY, len(MADE))
    rows.carrier, rows.ratio, rows.c = -1, 1.0, 1.0
    for row, given in zip(rows, MADE.values(), strict=True):
        for name, value in given.items():
            row[name] = NUMBER[value] if name == "carrier" else value
    return rows


SEEN_FROM = {
    ("a", "b"): HUB, ("a", HUB): HUB, (HUB, "a"): HUB, ("part", "a"): HUB, ("a", "coaxial"): HUB, ("coaxial", "b"): HUB,
    ("a", "above"): None, ("a", "beside"): None, ("a", "bar"): None, ("above", "beside"): None,
    ("a", "faster"): None, ("shifted", "a"): None, (HUB, "faster"): None, ("a", "planet"): HUB, ("still", "a"): HUB,
    ("c", "there"): None, ("here", "a"): None, ("a", "c"): None,
    ("d", CART): CART, ("d", "quick"): CART, ("quick", CART): CART, ("d", "coaxial"): None, ("d", "bar"): None,
    ("e", PLATE): PLATE, ("back", "e"): PLATE, ("e", "a"): None,
}  # fmt: skip


@pytest.mark.parametrize("pair", SEEN_FROM, ids="-".join)
def test_the_carrier_from_which_both_only_turn(pair: tuple[str, str]) -> None:
    row = records(BODY_PAIR, 1)
    row.a, row.b, row.on0, row.on1, row.on2 = *(NUMBER[name] for name in pair), 5, 6, 7
    choose_frames(bodies(), row)
    frame = SEEN_FROM[pair]
    assert row.frame[0] == (MOVEMENT if frame is None else NUMBER[frame])
    assert (row.on0[0], row.on1[0], row.on2[0]) == (-1, -1, -1)


Place = tuple[int, float, float, float, float]  # motion, x, y, angle, ratio
Given = list[tuple[int, int, int, float]]  # coordinate, less which, kind, arm
PLACES: dict[tuple[str, str], Place] = {
    ("a", HUB): (PIVOT, 0.12, -0.35, 0.0, 1.0),
    (HUB, HUB): (FIXED, 0.0, 0.0, 0.0, 1.0),
    ("coaxial", HUB): (PIVOT, 0.0, 0.0, 0.0, 1.0),
    ("planet", HUB): (PIVOT, 0.1, 0.2, 0.0, 1.5),
    ("still", HUB): (PIVOT, 0.1, 0.2, 0.0, 0.0),
    (CART, CART): (FIXED, 0.0, 0.0, 0.6, 1.0),
    ("d", CART): (PIVOT, 0.5 * math.cos(0.6) - 0.2 * math.sin(0.6), 0.5 * math.sin(0.6) + 0.2 * math.cos(0.6), 0.0, 1.0),
    ("rack", CART): (PIVOT, 0.5 * math.cos(0.6) - 0.2 * math.sin(0.6), 0.5 * math.sin(0.6) + 0.2 * math.cos(0.6), 0.0, 3.5),
    (PLATE, PLATE): (FIXED, 0.0, 0.0, 0.0, 1.0),
    ("back", PLATE): (PIVOT, 0.2, 0.6, 0.0, -1.4),
}


@pytest.mark.parametrize("case", PLACES, ids="-from-".join)
def test_where_a_body_is_seen(case: tuple[str, str]) -> None:
    name, frame = case
    before = bodies()
    seen = seen_from(before, NUMBER[name], NUMBER[frame])
    assert (int(seen.motion), seen.x, seen.y, seen.angle, seen.ratio) == pytest.approx(PLACES[case], rel=1e-14)
    assert seen.phase == MADE[name].get("phase", 0.0)
    assert seen.carrier < 0
    if name == frame:
        assert (seen.c, seen.s) == (math.cos(seen.angle), math.sin(seen.angle)) and seen.first < 0
    assert before.tobytes() == bodies().tobytes()
    assert seen_from(before, NUMBER[name], MOVEMENT) == before[NUMBER[name]]


AXES: dict[tuple[str, str | None], Given] = {
    (HUB, None): [(0, -1, TURN, 0.0)],
    ("a", None): [(0, -1, TURN, 0.37), (1, -1, TURN, 0.0)],
    ("part", None): [(0, -1, TURN, 0.53)],
    ("bar", None): [(6, -1, TRAVEL, 0.0)],
    (PLATE, None): [(12, -1, TRAVEL, 0.0), (13, -1, TRAVEL, 0.0), (14, -1, TURN, 0.0)],
    ("e", None): [(12, -1, TRAVEL, 0.0), (13, -1, TRAVEL, 0.0), (14, -1, TURN, 0.25), (15, -1, TURN, 0.0)],
    ("d", None): [(10, -1, TRAVEL, 0.0), (11, -1, TURN, 0.0)],
    ("planet", None): [(0, -1, TURN, math.hypot(0.1, 0.2)), (0, -1, TURN, 0.0)],
    (HUB, HUB): [],
    ("a", HUB): [(1, 0, TURN, 0.0)],
    ("part", HUB): [],
    ("coaxial", HUB): [(3, 0, TURN, 0.0)],
    ("planet", HUB): [(0, -1, TURN, 0.0)],
    ("still", HUB): [],
    (CART, CART): [],
    ("d", CART): [(11, -1, TURN, 0.0)],
    ("rack", CART): [(10, -1, TURN, 0.0)],
    ("quick", CART): [(3, -1, TURN, 0.0)],
    (PLATE, PLATE): [],
    ("e", PLATE): [(15, 14, TURN, 0.0)],
    ("back", PLATE): [(14, -1, TURN, 0.0)],
}


@pytest.mark.parametrize("case", AXES, ids=lambda case: f"{case[0]}-from-{case[1]}")
def test_on_what_the_place_of_a_body_depends(case: tuple[str, str | None]) -> None:
    b, frame = NUMBER[case[0]], MOVEMENT if case[1] is None else NUMBER[case[1]]
    found = axes_of(bodies(), b, frame)
    assert [(axis.coordinate, axis.on, axis.kind) for axis in found] == [one[:3] for one in AXES[case]]
    turning = [(axis, arm) for axis, (*_, arm) in zip(found, AXES[case], strict=True) if axis.kind == TURN]
    assert [axis.arm for axis, _ in turning] == pytest.approx([arm for _, arm in turning], rel=1e-14)
    assert {axis.body for axis in found} <= {b}


def test_turns_and_travels_are_told_apart() -> None:
    assert TURN != TRAVEL and MOVEMENT < 0


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


# Is the symmetry of an outline found where there is one, and only there?

TOLERANCE = 1e-6


def wheel(teeth: int, spokes: int = 0, shift: float = 0.0, spoilt: float = 0.0) -> Records:
    """Primitives of saw teeth with a rounded root and of round spoke holes; `spoilt` lengthens one tooth."""
    edges: list[Edge] = []
    for k in range(teeth):
        tip = 1.0 + (spoilt if k == 3 else 0.0)
        angle = 2.0 * math.pi * k / teeth + shift
        c, s = math.cos(2.0 * math.pi / teeth), math.sin(2.0 * math.pi / teeth)
        end = (0.8 * c, 0.8 * s)
        edges += [moved(Line(0.8, 0.0, tip, 0.05), angle, (0.0, 0.0)), moved(Line(tip, 0.05, *end), angle, (0.0, 0.0))]
    holes = [
        Arc(0.4 * math.cos(a), 0.4 * math.sin(a), 0.1, 0.0, -2.0 * math.pi) for a in np.arange(spokes) * 2.0 * math.pi / spokes
    ]
    loops = [Loop(tuple(edges)), *(Loop((hole,), hole=True) for hole in holes)]
    return np.concatenate([features(loop, 0, 1.0) for loop in loops]).view(np.recarray)


def points(rows: Records, at: np.ndarray) -> np.ndarray:
    """Where the reference points of some primitives are: middles, or centres of full circles."""
    x, y = np.where(rows.extent > 0, rows.x, rows.px), np.where(rows.extent > 0, rows.y, rows.py)
    return (x + 1j * y)[at]


@pytest.mark.parametrize("teeth", [2, 15, 20, 97])
@pytest.mark.parametrize("shift", [0.0, 0.1, math.pi])
def test_every_primitive_lies_on_its_image(teeth: int, shift: float) -> None:
    rows = wheel(teeth, shift=shift)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == teeth and not found.loose.any()
    assert sorted(found.image) == list(range(len(rows)))
    every = np.arange(len(rows))
    assert np.abs(points(rows, every) * np.exp(2j * math.pi / teeth) - points(rows, found.image)).max() < 1e-12
    assert np.array_equal(rows.kind, rows.kind[found.image])


def test_spokes_that_do_not_fit_the_teeth_are_loose() -> None:
    rows = wheel(15, spokes=4)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == 15
    assert np.array_equal(found.loose, rows.extent > 0)


def test_spokes_that_fit_share_the_smaller_symmetry_or_are_loose() -> None:
    rows = wheel(15, spokes=5)
    found = turn_symmetry(rows, TOLERANCE)
    assert found.fold == 15 and np.count_nonzero(found.loose) == 5


@pytest.mark.parametrize(("spoilt", "fold"), [(1e-9, 15), (1e-3, 1)])
def test_a_spoilt_tooth_ends_the_symmetry_unless_it_is_rounding(spoilt: float, fold: int) -> None:
    found = turn_symmetry(wheel(15, spoilt=spoilt), TOLERANCE)
    assert found.fold == fold


def test_no_primitives_have_no_symmetry() -> None:
    assert turn_symmetry(wheel(5)[:0], TOLERANCE).fold == 1
