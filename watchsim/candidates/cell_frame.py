"""In whose frame are the cells of two bodies given, and along which coordinates?

Two bodies on the same carrier, or one body and its carrier, do not care how the carrier stands: seen from it they depend on
relative angles alone. Everything else is seen from the movement.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from watchsim.model.records import FIXED, FREE, PIVOT, SLIDE, Records

TURN, TRAVEL = 0, 1
MOVEMENT = -1


class Axis(NamedTuple):
    """A coordinate that the place of `body` depends on: less coordinate `on` (-1: nothing), an angle (TURN) or a TRAVEL.

    `arm` is how far from that turning axis the body's own origin lies, m.
    """

    body: int
    coordinate: int
    on: int
    kind: int
    arm: float


def choose_frames(bodies: Records, pairs: Records) -> None:
    """Fill in the frame of each pair of bodies."""
    for pair in pairs:
        both = (int(pair.a), int(pair.b))
        carriers = [int(bodies[b].carrier) for b in both if bodies[b].carrier >= 0]
        pair.frame = next((c for c in carriers if all(_is_seen(bodies, b, c) for b in both)), MOVEMENT)
        pair.on0 = pair.on1 = pair.on2 = -1


def _is_seen(bodies: Records, b: int, carrier: int) -> bool:
    """Does the frame of body b, seen from the carrier, only turn, by an angle that one cell coordinate gives?"""
    turns = bodies[carrier].motion != SLIDE
    if turns and _is_geared(bodies[b]) and bodies[b].first != angle_of(bodies[carrier]):
        return False
    return b == carrier or bodies[b].carrier == carrier or _is_coaxial(bodies[b], bodies[carrier])


def _is_coaxial(body: Any, carrier: Any) -> bool:
    both_turn = body.motion == carrier.motion == PIVOT and body.carrier < 0
    return bool(both_turn and body.x == carrier.x and body.y == carrier.y)


def _is_geared(body: Any) -> bool:
    return bool(body.ratio != 1.0 or body.phase != 0.0)


def seen_from(bodies: Records, b: int, frame: int) -> Any:
    """The record of body b as seen from the frame, in which it is carried no more; from the movement it stays as it is."""
    body = bodies[b].copy()
    if frame == MOVEMENT:
        return body
    carrier = bodies[frame]
    # The frame of a slide does not turn: it is seen from a frame that only shifts with it.
    c, s, angle = (carrier.c, carrier.s, carrier.angle) if carrier.motion == SLIDE else (1.0, 0.0, 0.0)
    if b == frame:
        body.motion, body.first, body.x, body.y = FIXED, -1, 0.0, 0.0
        body.angle, body.c, body.s = angle, c, s
    elif body.carrier == frame:
        body.carrier = -1
        body.x, body.y = c * body.x - s * body.y, s * body.x + c * body.y
    else:
        body.x, body.y = 0.0, 0.0
    if b != frame and carrier.motion != SLIDE and body.first == angle_of(carrier):
        body.ratio -= 1.0  # geared to the carrier, it turns by so much against it
    return body


def axes_of(bodies: Records, b: int, frame: int) -> list[Axis]:
    """What the place of body b in the frame depends on."""
    body = seen_from(bodies, b, frame)
    if body.carrier >= 0:
        arm = math.hypot(body.x, body.y)
        return [*_own(b, bodies[body.carrier], -1, arm), *_own(b, body, -1, 0.0)]
    turning = frame != MOVEMENT and bodies[frame].motion != SLIDE and body.first != angle_of(bodies[frame])
    return _own(b, body, angle_of(bodies[frame]) if turning else -1, 0.0)


def angle_of(body: Any) -> int:
    """The coordinate that is the angle of a turning body."""
    return int(body.first) + (2 if body.motion == FREE else 0)


def _own(b: int, moving: Any, on: int, arm: float) -> list[Axis]:
    first = int(moving.first)
    if moving.motion == FIXED:
        return []
    if moving.motion == PIVOT:
        return [Axis(b, first, on, TURN, arm)] if moving.ratio != 0.0 else []
    shifts = [Axis(b, first + i, -1, TRAVEL, 0.0) for i in range(2 if moving.motion == FREE else 1)]
    return [*shifts, Axis(b, first + 2, -1, TURN, arm)] if moving.motion == FREE else shifts
