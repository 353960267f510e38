"""At which angles can the bodies begin without standing in each other?

Where the drawing shows teeth in stones, the wheel is turned within a pitch, and the lever a little, to where all is clear.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.proposal.bodies.part_names import CLICK, LEVER, OSCILLATOR, WHEEL
from watchsim.proposal.bodies.part_roles import Role
from watchsim.proposal.bodies.piece import Piece
from watchsim.proposal.clearance import clearance, overlaps
from watchsim.proposal.facing import Facing, turns_fully
from watchsim.proposal.locked import locked

WHEEL_STEPS = 48  # of a pitch
LEVER_ANGLES = np.radians((0.0, 3.0, -3.0, 5.0, -5.0, 8.0, -8.0, 11.0, -11.0)).tolist()
SWINGS = np.radians((250.0, 235.0, 265.0, 220.0, 200.0, 280.0, 180.0, 150.0, 120.0, 90.0)).tolist()  # of a balance, from rest
ANCHOR_SWINGS = np.radians((4.0, 3.0, 5.0, 2.0, 6.0, 1.0, 8.0)).tolist()
AT_REST = math.radians(3.0)  # a pin this near to the line to the lever is drawn where it rests


@dataclass(frozen=True)
class Start:
    """Angles of the bodies (rad) by name, with a reason, and the spring's rest angle of the oscillator."""

    angles: dict[str, float]
    why: dict[str, str]
    rest: float
    rest_why: str
    swing: float


def start_of(roles: Sequence[Role], facings: Sequence[Facing], direction: int) -> Start:
    """Free angles, as far as they can be found: the lever at its bank, a tooth of the wheel, driven that way, at the stone."""
    swinging = next((role for role in roles if role.task == OSCILLATOR), None)
    levers = [role for role in roles if role.task == LEVER]
    rest, rest_why = _rest(swinging, levers, facings)
    angles = dict.fromkeys((role.name for role in roles if role.moves), 0.0)
    why: dict[str, str] = {}
    swing = 0.0
    if swinging is not None:
        ways = SWINGS if turns_fully(swinging) else ANCHOR_SWINGS
        own = [facing for facing in facings if swinging in (facing.first, facing.second)]
        clear = [way for way in ways if turns_fully(swinging) and not overlaps(own, {**angles, swinging.name: rest - way})]
        swing = clear[0] if clear else ways[0]
        angles[swinging.name] = rest - swing
        why[swinging.name] = "let go at the end of a swing" if turns_fully(swinging) else "let go a little beside its rest"
    waiting = locked(roles, facings, angles, direction)
    if waiting is not None:
        angles, told = waiting
        why.update(told)
    elif overlaps(facings, angles):
        found = _searched(roles, facings, angles)
        if found is not None:
            for name in [name for name in found if found[name] != angles[name]]:
                why[name] = "turned so far that nothing overlaps at the start; in the drawing it does"
            angles = found
    return Start(angles, why, rest, rest_why, swing)


def _rest(swinging: Role | None, levers: Sequence[Role], facings: Sequence[Facing]) -> tuple[float, str]:
    """How far the balance must be turned for its pin to point at the lever."""
    drawn = "as it is drawn"
    if swinging is None or not turns_fully(swinging) or not levers or swinging.part.centre is None:
        return 0.0, drawn
    lever = levers[0]
    touching = {
        layer for f in facings for role, layer in ((f.first, f.first_layer), (f.second, f.second_layer)) if role is swinging
    }
    at = np.array(swinging.part.centre.at)
    pins = [piece for piece in swinging.part.pieces if piece.layer in touching and _is_pin(piece, at)]
    if not pins or lever.part.centre is None:
        return 0.0, drawn
    pin = min(pins, key=lambda piece: piece.area)
    to_pin, to_lever = np.array(pin.centroid) - at, np.array(lever.part.centre.at) - at
    turn = math.atan2(*to_lever[::-1]) - math.atan2(*to_pin[::-1])
    turn = math.remainder(turn, 2.0 * math.pi)
    if abs(turn) <= AT_REST:
        return 0.0, f"{drawn}: its pin points at the lever"
    return turn, "so that its pin points at the lever"


def _is_pin(piece: Piece, centre: np.ndarray) -> bool:
    away = float(np.hypot(*(np.array(piece.centroid) - centre)))
    return away > 0.5 * math.sqrt(piece.area / math.pi)


def _searched(roles: Sequence[Role], facings: Sequence[Facing], angles: dict[str, float]) -> dict[str, float] | None:
    """The first angles, nearest to those drawn, at which nothing overlaps: the most open ones of the wheel."""
    ways: dict[str, list[float]] = {}
    for role in roles:
        if role.task in (LEVER, CLICK):
            ways[role.name] = LEVER_ANGLES
        elif role.task == OSCILLATOR and not turns_fully(role):
            drawn = angles[role.name]
            ways[role.name] = [drawn, *(side * way for way in ANCHOR_SWINGS for side in (1.0, -1.0)), 0.0]
        elif role.task == WHEEL and role.teeth:
            pitch = 2.0 * math.pi / role.teeth
            ways[role.name] = (np.arange(WHEEL_STEPS) * pitch / WHEEL_STEPS).tolist()
    names = [name for name in ways if name not in _wheels(roles)]
    wheels = [name for name in ways if name in _wheels(roles)][:1]
    for others in sorted(itertools.product(*(ways[name] for name in names)), key=lambda found: sum(map(abs, found))):
        tried = {**angles, **dict(zip(names, others, strict=True))}
        found = [(clearance(facings, candidate), candidate) for candidate in _with(tried, wheels, ways)]
        best = max(found, key=lambda pair: pair[0])
        if best[0] > 0.0:
            return best[1]
    return None


def _wheels(roles: Sequence[Role]) -> set[str]:
    return {role.name for role in roles if role.task == WHEEL}


def _with(angles: dict[str, float], wheels: Sequence[str], ways: dict[str, list[float]]) -> Iterable[dict[str, float]]:
    if not wheels:
        yield angles
        return
    for angle in ways[wheels[0]]:
        yield {**angles, wheels[0]: angle}
