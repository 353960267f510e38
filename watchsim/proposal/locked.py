"""Where do lever and wheel stand when a watch waits to be unlocked?"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np

from watchsim.proposal.bodies.part_names import LEVER, OSCILLATOR, WHEEL
from watchsim.proposal.bodies.part_roles import Role
from watchsim.proposal.clearance import clearance
from watchsim.proposal.facing import Facing, turns_fully

FINE = 96  # steps of a pitch, and of the way to a bank
MOST_BANK, USUAL_BANK = math.radians(20.0), math.radians(5.0)
BACK = math.radians(0.1)  # short of touching


def locked(
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
        reach = _first_touch(lambda angle: clearance(still, {**angles, lever.name: angle}), MOST_BANK) if still else USUAL_BANK
        angles = {**angles, lever.name: max(reach - BACK, 0.0)}
        why[lever.name] = "just before its bank, on the side from which the pin comes" if still else "as if at its bank"
    own = [f for f in facings if wheel in (f.first, f.second)]
    free = _free_way(lambda angle: clearance(own, {**angles, wheel.name: direction * angle}), 2.0 * math.pi / wheel.teeth)
    if free is None:
        return None
    angles = {**angles, wheel.name: direction * free}
    why[wheel.name] = "turned on, the way it is driven, until a tooth is just before a surface that stops it"
    return angles, why


def _first_touch(open_at: Callable[[float], float], most: float) -> float:
    """The angle, from 0 on, at which there is no clearance any more, at most `most`."""
    steps = np.linspace(0.0, most, FINE + 1).tolist()
    for before, angle in itertools.pairwise(steps):
        if open_at(angle) <= 0.0:
            return _edge(open_at, before, angle)
    return most


def _free_way(open_at: Callable[[float], float], pitch: float) -> float | None:
    """The end, in the driven direction, of the widest stretch of angles within a pitch where there is clearance."""
    step = pitch / FINE
    free = [open_at(k * step) > 0.0 for k in range(FINE)]
    if all(free) or not any(free):
        return 0.0 if all(free) else None
    ends = [k for k in range(FINE) if free[k] and not free[(k + 1) % FINE]]
    longest = max(ends, key=lambda k: next(n for n in range(1, FINE + 1) if not free[(k - n) % FINE]))
    return max(_edge(open_at, longest * step, (longest + 1) * step) - BACK, longest * step - step)


def _edge(open_at: Callable[[float], float], free: float, blocked: float) -> float:
    while abs(blocked - free) > 0.1 * BACK:
        middle = 0.5 * (free + blocked)
        free, blocked = (middle, blocked) if open_at(middle) > 0.0 else (free, middle)
    return free
