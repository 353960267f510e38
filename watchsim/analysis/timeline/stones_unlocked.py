"""On which stone did the wheel rest before each beat: that of the entry or of the exit?"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.body_contacts import between, contact_columns
from watchsim.mechanism.compile import Compiled
from watchsim.scene.roles import Roles, drive_direction
from watchsim.simulation.record.trajectory import Array, Trajectory


class StonesUnlocked:
    """`at` names the stone on which the wheel rested until a beat began: that of the last contact of wheel and lever.

    None where there are none on either side: a balance that the wheel touches itself turns too far, and both pallets of a pin
    wheel's anchor lie on the same side.
    """

    def __init__(self, run: Trajectory, compiled: Compiled, parts: Roles) -> None:
        self._run, self._compiled, self._parts = run, compiled, parts
        self._times, self._contacts = _rests(run, compiled, parts)
        self._are_told = parts.lever != parts.oscillator or _has_pallets(run, compiled, parts)

    def at(self, starts: Array) -> list[str]:
        """For beats that begin at these times (s): "entry", "exit", or "" where that cannot be told."""
        if not self._are_told:
            return [""] * len(starts)
        last = np.searchsorted(self._times, starts, side="right") - 1
        known = last >= 0
        used, of_contact = np.unique(self._contacts[last[known]], return_inverse=True)
        stone_of = np.array([_stone(self._compiled, self._parts, contact) for contact in used.tolist()], np.int64)
        stones, first, of_stone = np.unique(stone_of[of_contact], return_index=True, return_inverse=True)
        rested = zip(stones.tolist(), starts[known][first].tolist(), strict=True)
        sides = [_side(self._run, self._compiled, self._parts, stone, time) for stone, time in rested]
        found = np.full(len(starts), "", object)
        found[known] = np.array(sides, object)[of_stone]
        return found.tolist()


def _rests(run: Trajectory, compiled: Compiled, parts: Roles) -> tuple[Array, NDArray[np.int64]]:
    """When wheel and lever touch or part, and the number of the contact."""
    assert parts.wheel and parts.lever
    times, contacts = contact_columns(run, between(parts.lever, {parts.wheel}), ["t", "contact"])
    known = contacts < len(compiled.model.contacts)
    return times[known], contacts[known]


def _has_pallets(run: Trajectory, compiled: Compiled, parts: Roles) -> bool:
    """Does an anchor have pallets on either side of the line to its wheel?"""
    on_spring = any(spring.body == parts.oscillator for spring in run.scene.springs) and not any(run.scene.gravity)
    both = {parts.wheel, parts.lever}
    stones = {_stone(compiled, parts, k) for k, pair in enumerate(run.pairs) if {pair.body_a, pair.body_b} == both}
    return not on_spring and len({_side(run, compiled, parts, one, float(run.t[0])) for one in stones}) > 1


def _stone(compiled: Compiled, parts: Roles, contact: int) -> int:
    """The primitive of the lever in a contact with the wheel."""
    p = compiled.model.contacts[contact]
    return int(p.a if compiled.owners[int(p.a)] == parts.lever else p.b)


def _side(run: Trajectory, compiled: Compiled, parts: Roles, stone: int, time: float) -> str:
    """Entry where the stone lies before the line from wheel to lever, in the wheel's sense of turning."""
    assert parts.wheel and parts.lever
    x0, y0, _ = run.pose(parts.wheel, time)
    x1, y1, angle = run.pose(parts.lever, time)
    p = compiled.model.primitives[stone]
    c, s = math.cos(angle), math.sin(angle)
    x, y = x1 + c * p.px - s * p.py, y1 + s * p.px + c * p.py
    turn = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
    return "entry" if drive_direction(run.scene, parts.wheel) * turn < 0.0 else "exit"
