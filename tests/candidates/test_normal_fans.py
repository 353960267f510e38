"""Is a pair taken for possible up to where it may touch, and no further? One circle by one line or arc, places made up."""

from __future__ import annotations

import cmath
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.candidates.normal_fans import Regions, _angle, _fan, _Pieces, _turned
from watchsim.model.records import ARC, CORNER, FULL, LINE, PART

NEAR, FAR = 0.999, 1.001  # of what is allowed
SHIFT, SWING = (0.011, 0.004), (0.03, 0.017)  # of the circle's body, of the other one
CLEARANCE = 0.005
TURNS, PLACE_B = (0.8, -0.35), 0.4 - 0.9j
CENTRE, RADIUS, FAN = 0.3 + 0.2j, 0.15, 0.5  # of the circle, in its body's frame
LENGTH, START, WAY = 0.7, -0.2 + 0.55j, cmath.rect(1.0, 0.45)  # of a line; its material is on the left
BEND, MIDDLE, HALF = 0.9, cmath.rect(1.0, 2.1), 0.6  # of an arc about START


def possible(
    at: complex,
    normal: complex,
    met: dict[str, Any],
    swapped: bool = False,
    still: bool = False,
    centre: complex = CENTRE,
    radius: float = RADIUS,
) -> bool:
    """Could a circle touch whose centre lies at `at` in the other body's frame, with the middle of its fan along `normal`?"""
    turn_a, turn_b = TURNS
    origin = PLACE_B + at * cmath.rect(1.0, turn_b) - centre * cmath.rect(1.0, turn_a)
    n = normal * cmath.rect(1.0, turn_b - turn_a)
    circle = {"x": centre.real, "y": centre.imag, "radius": radius, "nx": n.real, "ny": n.imag, "kind": ARC, "fan": FAN}
    zero = dict.fromkeys(_Pieces._fields, 0.0)
    order = (1, 0) if swapped else (0, 1)
    rows = [zero | circle, zero | met]
    poses = {order[0]: (origin.real, origin.imag, turn_a), order[1]: (PLACE_B.real, PLACE_B.imag, turn_b)}
    made: Any = object.__new__(Regions)
    made._motion = SimpleNamespace(
        pose=lambda b, _: tuple(np.array([99.0, v]) for v in poses[b]),
        freedom=lambda b, _: (0.0, 0.0) if still else (SHIFT[order.index(b)], SWING[order.index(b)]),
    )
    made._clearance, made._bodies = 0.0 if still else CLEARANCE, (0, 1)
    made._pieces = _Pieces._make(np.array([row[name] for row in rows], float) for name in _Pieces._fields)
    made._circle, made._met, made._is_first = np.array([9, 0]), np.array([9, 1]), np.array([not swapped, swapped])
    return bool(made.possible(np.array([1]), np.array([1]), np.zeros((2, 0)), np.zeros(0))[0])


def travel(at: complex) -> float:
    """How far the circle's centre may be from there."""
    own = SHIFT[0] + SWING[0] * abs(CENTRE)
    return own + SHIFT[1] + SWING[1] * (abs(at) + own) + CLEARANCE


def line() -> dict[str, Any]:
    normal = -1j * WAY
    return {"x": START.real, "y": START.imag, "tx": WAY.real, "ty": WAY.imag, "nx": normal.real, "ny": normal.imag} | {
        "length": LENGTH, "kind": LINE, "side": 1.0, "fan": 0.1,
    }  # fmt: skip


def arc(side: float) -> dict[str, Any]:
    n = side * MIDDLE
    own = {"x": START.real, "y": START.imag, "radius": BEND, "nx": n.real, "ny": n.imag, "side": side, "kind": ARC}
    return own | {"fan": HALF, "tx": 0.6, "ty": 0.8, "length": 0.01}


def reached(where: Any, share: float) -> complex:
    """The place at that share of the allowance, which depends on the place: `where` gives one for an allowance."""
    at = where(0.0)
    for _ in range(30):
        at = where(share * travel(at))
    return complex(at)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("edge", ["gap", "begin", "end"])
def test_up_to_where_a_line_is_met(edge: str, swapped: bool) -> None:
    where = {
        "gap": lambda t: START + WAY * (0.3 - 1j * (RADIUS + t)),
        "begin": lambda t: START + WAY * (-t - 1j * RADIUS),
        "end": lambda t: START + WAY * (LENGTH + t - 1j * RADIUS),
    }[edge]
    for share, wanted in ((NEAR, True), (FAR, False), (0.0, True)):
        assert possible(reached(where, share), 1j * WAY, line(), swapped) is wanted


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_up_to_where_the_circle_reaches_as_it_turns(sense: float) -> None:
    """Both bodies may swing; a line's normal stays."""
    at = START + WAY * (0.3 - 1j * RADIUS)
    for share, wanted in ((NEAR, True), (FAR, False)):
        off = cmath.rect(1.0, sense * share * (FAN + SWING[0] + SWING[1]))
        assert possible(at, 1j * WAY * off, line()) is wanted


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("swapped", [False, True])
def test_how_near_an_arc_is_met(side: float, swapped: bool) -> None:
    for share, wanted in ((NEAR, True), (FAR, False), (-FAR, True)):
        at = reached(lambda t: START + MIDDLE * (BEND + side * (RADIUS + t)), share)
        assert possible(at, -side * MIDDLE, arc(side), swapped) is wanted


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_up_to_which_end_of_an_arc(side: float, sense: float) -> None:
    """The direction from its centre may change as the circle travels, and both bodies swing."""
    apart = BEND + side * RADIUS
    for share, wanted in ((NEAR, True), (FAR, False)):
        at = START + MIDDLE * apart
        for _ in range(30):
            at = START + MIDDLE * apart * cmath.rect(1.0, sense * share * (HALF + math.asin(travel(at) / apart)))
        assert possible(at, -side * (at - START), arc(side)) is wanted
        at = START + MIDDLE * apart
        off = cmath.rect(1.0, sense * share * (FAN + SWING[0] + SWING[1] + math.asin(travel(at) / apart)))
        assert possible(at, -side * MIDDLE * off, arc(side)) is wanted


@pytest.mark.parametrize(("share", "wanted"), [(0.0, True), (NEAR, True), (1.1, False)])
def test_by_the_centre_of_an_arc_every_direction_may_come(share: float, wanted: bool) -> None:
    """As near as the circle may travel; the bite is hardly larger than it."""
    at = reached(lambda t: START - MIDDLE * t, share)
    assert possible(at, 1j * MIDDLE, arc(-1.0) | {"radius": RADIUS + 0.01}) is wanted


@pytest.mark.parametrize("which", ["arm", "far", "circle", "arc"])
@pytest.mark.parametrize("size", [2e4, 7e4])
def test_places_are_rounded_by_what_they_are_computed_from(which: str, size: float) -> None:
    """A hundred-million-millionth of it: the arm of the circle, its way to the other origin, its radius, that of an arc."""
    centre = size * CENTRE / abs(CENTRE) if which == "arm" else CENTRE
    radius = size if which == "circle" else RADIUS
    normal = MIDDLE if which == "arc" else -1j * WAY
    at = size * WAY if which == "far" else 0.0j
    if which == "arc":
        middle = at - size * normal
        met = arc(1.0) | {"x": middle.real, "y": middle.imag, "radius": size - radius}
    else:
        start = at - radius * normal - 0.3 * WAY
        met = line() | {"x": start.real, "y": start.imag}
    allowed = 1e-14 * (abs(centre) + abs(at) + radius + (size - radius if which == "arc" else 0.0))
    for share, wanted in ((0.85, True), (1.15, False)):
        assert possible(at + share * allowed * normal, -normal, met, still=True, centre=centre, radius=radius) is wanted


def test_fans() -> None:
    """Half the angle of the normals and, beyond each end, the clearance seen from the centre, or of a corner from its size."""
    rows = np.rec.fromrecords(
        [
            (ARC, PART, 0.4, 0.0, math.cos(0.7), math.sin(0.7)),
            (CORNER, PART, 0.0, 2.5, math.cos(1.9), math.sin(1.9)),
            (ARC, FULL, 0.25, 0.0, 0.3, 0.4),
            (ARC, PART, 0.4, 0.8, math.cos(2.2), math.sin(2.2)),
            (CORNER, PART, 0.0, 0.0, math.cos(0.3), math.sin(0.3)),
            (ARC, PART, 5e-4, 0.0, math.cos(0.3), math.sin(0.3)),
        ],
        names="kind,extent,radius,length,half_cos,half_sin",
    )
    wanted = [0.7 + 0.03 / 0.4, 1.9 + 0.03 / 2.5, math.pi + 0.03 / 0.25, 2.2 + 0.03 / 0.8, 0.3 + math.pi, 0.3 + 60.0]
    assert _fan(rows, 0.03) == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize("angle", [0.3, -1.2, 2.9, -3.1])
def test_angles_between_directions_and_turned_ones(angle: float) -> None:
    one, other = cmath.rect(1.7, 0.4), cmath.rect(0.6, 0.4 + angle)
    args = [np.array([v]) for v in (one.real, one.imag, other.real, other.imag)]
    assert _angle(*args)[0] == pytest.approx(abs(angle), rel=1e-12, abs=0.0)
    x, y = _turned(args[0], args[1], np.array([angle]))
    assert complex(x[0], y[0]) == pytest.approx(cmath.rect(1.7, 0.4 + angle), rel=1e-14, abs=0.0)
