"""At which angles can the bodies begin without standing in each other?

Where the drawing shows teeth in stones, the wheel is turned within a pitch, and the lever a little, to where all is clear.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.mechanism.material_polygons import material
from watchsim.proposal.facing import Facing, about, turns_fully
from watchsim.proposal.piece import Piece, Region
from watchsim.proposal.roles import Role
from watchsim.proposal.words import LEVER, OSCILLATOR, WHEEL

WHEEL_STEPS = 48  # of a pitch
LEVER_ANGLES = np.radians((0.0, 3.0, -3.0, 5.0, -5.0, 8.0, -8.0, 11.0, -11.0)).tolist()
SWINGS = np.radians((250.0, 235.0, 265.0, 220.0, 200.0, 280.0, 180.0, 150.0, 120.0, 90.0)).tolist()  # of a balance, from rest
ANCHOR_SWINGS = np.radians((4.0, 3.0, 5.0, 2.0, 6.0, 1.0, 8.0)).tolist()
FINE = 96  # steps of a pitch, and of the way to a bank
MOST_BANK, USUAL_BANK = math.radians(20.0), math.radians(5.0)
BACK = math.radians(0.1)  # short of touching
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
        clear = [way for way in ways if turns_fully(swinging) and not _overlaps(own, {**angles, swinging.name: rest - way})]
        swing = clear[0] if clear else ways[0]
        angles[swinging.name] = rest - swing
        why[swinging.name] = "let go at the end of a swing" if turns_fully(swinging) else "let go a little beside its rest"
    locked = _locked(roles, facings, angles, direction)
    if locked is not None:
        angles, told = locked
        why.update(told)
    elif _overlaps(facings, angles):
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


def _locked(
    roles: Sequence[Role], facings: Sequence[Facing], angles: dict[str, float], direction: int
) -> tuple[dict[str, float], dict[str, str]] | None:
    """The lever turned to its bank, on the side from which the pin comes, and the wheel on until a tooth is at a stone.

    Of an anchor that swings itself the wheel alone is turned on. None where there is no such place.
    """
    wheel = next((role for role in roles if role.task == WHEEL and role.teeth), None)
    levers = [role for role in roles if role.task == LEVER]
    swinging = next((role for role in roles if role.task == OSCILLATOR), None)
    if wheel is None or swinging is None:
        return None
    why = {}
    if turns_fully(swinging):
        if not levers:
            return None
        lever = levers[0]
        still = [f for f in facings if lever in (f.first, f.second) and not (f.first.moves and f.second.moves)]
        reach = _first_touch(lambda angle: _clearance(still, {**angles, lever.name: angle}), MOST_BANK) if still else USUAL_BANK
        angles = {**angles, lever.name: max(reach - BACK, 0.0)}
        why[lever.name] = "just before its bank, on the side from which the pin comes" if still else "as if at its bank"
    own = [f for f in facings if wheel in (f.first, f.second)]
    free = _free_way(lambda angle: _clearance(own, {**angles, wheel.name: direction * angle}), 2.0 * math.pi / wheel.teeth)
    if free is None:
        return None
    angles = {**angles, wheel.name: direction * free}
    why[wheel.name] = "turned on, the way it is driven, until a tooth is just before a surface that stops it"
    return angles, why


def _first_touch(clearance: Callable[[float], float], most: float) -> float:
    """The angle, from 0 on, at which there is no clearance any more, at most `most`."""
    steps = np.linspace(0.0, most, FINE + 1).tolist()
    for before, angle in itertools.pairwise(steps):
        if clearance(angle) <= 0.0:
            return _edge(clearance, before, angle)
    return most


def _free_way(clearance: Callable[[float], float], pitch: float) -> float | None:
    """The end, in the driven direction, of the widest stretch of angles within a pitch where there is clearance."""
    step = pitch / FINE
    free = [clearance(k * step) > 0.0 for k in range(FINE)]
    if all(free) or not any(free):
        return 0.0 if all(free) else None
    ends = [k for k in range(FINE) if free[k] and not free[(k + 1) % FINE]]
    longest = max(ends, key=lambda k: next(n for n in range(1, FINE + 1) if not free[(k - n) % FINE]))
    return max(_edge(clearance, longest * step, (longest + 1) * step) - BACK, longest * step - step)


def _edge(clearance: Callable[[float], float], free: float, blocked: float) -> float:
    while abs(blocked - free) > 0.1 * BACK:
        middle = 0.5 * (free + blocked)
        free, blocked = (middle, blocked) if clearance(middle) > 0.0 else (free, middle)
    return free


def _searched(roles: Sequence[Role], facings: Sequence[Facing], angles: dict[str, float]) -> dict[str, float] | None:
    """The first angles, nearest to those drawn, at which nothing overlaps: the most open ones of the wheel."""
    ways: dict[str, list[float]] = {}
    for role in roles:
        if role.task == LEVER:
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
        found = [(_clearance(facings, candidate), candidate) for candidate in _with(tried, wheels, ways)]
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


def _overlaps(facings: Sequence[Facing], angles: dict[str, float]) -> bool:
    return _clearance(facings, angles) <= 0.0


def _clearance(facings: Sequence[Facing], angles: dict[str, float]) -> float:
    """The least distance of what can meet, m; 0 where something overlaps."""
    least = math.inf
    for facing in facings:
        first = [
            _turned(facing.first, piece, angles) for piece in facing.first.part.pieces if piece.layer == facing.first_layer
        ]
        second = [
            _turned(facing.second, piece, angles) for piece in facing.second.part.pieces if piece.layer == facing.second_layer
        ]
        least = min([least, *(float(p.distance(q)) for p in first for q in second)])
        if least <= 0.0:
            break
    return least


def _turned(role: Role, piece: Piece, angles: dict[str, float]) -> Region:
    angle = angles.get(role.name, 0.0)
    if angle == 0.0 or role.part.centre is None:
        return piece.region
    parts = material([(about(points, role.part.centre.at, angle), hole) for points, hole in piece.rings])
    whole = parts[0]
    for part in parts[1:]:
        whole = whole.union(part)
    return whole
