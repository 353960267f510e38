"""From which body is a pair seen, and on what do places then depend? Bodies made up one by one, answers worked out by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest

import watchsim as ws
from watchsim.candidates.cell_frame import MOVEMENT, TRAVEL, TURN, axes_of, choose_frames, seen_from
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import BODY, BODY_PAIR, FIXED, FREE, PIVOT, SLIDE, Records, records
from watchsim.profiles_path import profiles_dir

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


Given = list[tuple[int, int, int, float]]  # coordinate, less which, kind, arm
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
