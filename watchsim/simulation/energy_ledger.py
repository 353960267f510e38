"""Does the energy ledger of a run close, and what do its watchdogs say in words?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from watchsim.model.records import PIVOT, Model
from watchsim.simulation.advance import BEARING, KINDS, TOUCHED
from watchsim.simulation.loop_state.scratch import RECENT, Ended
from watchsim.simulation.loop_state.state import State
from watchsim.simulation.motion.coupled_motion import EXTENT, NORMAL, PARADOX, TANGENTIAL
from watchsim.simulation.record.trajectory import Pair
from watchsim.simulation.tolerances import LEDGER_PER_TOLERANCE, LEDGER_SHARE

MANY = 6  # different causes named

_WORDS = {
    NORMAL: "the force ends at {}",
    TANGENTIAL: "slip or grip ends at {}",
    EXTENT: "an edge ends at {}",
    PARADOX: "no finite force holds {}",
    TOUCHED: "{} touch",
}


def ledger_fails(energy: dict[str, Any], held: float, tolerance: float) -> bool:
    """True if the residual of the ledger is more than rounding; `held` (J): the most energy that was ever in the motion."""
    turned_over = held + abs(energy["in_J"]) + abs(energy["stored_J"]) + sum(energy["dissipated"].values())
    return bool(abs(energy["residual_J"]) > max(LEDGER_SHARE, LEDGER_PER_TOLERANCE * tolerance) * turned_over)


def what_alternates(ended: Ended, pairs: Sequence[Pair], bodies: Sequence[str]) -> str:
    """What ended the last steps, most frequent first, with bodies and edges; "" where nothing did."""
    counted = Counter(ended.by[: min(int(ended.number), RECENT)].tolist())
    words = [f"{_cause(code, pairs, bodies)} ({times}×)" for code, times in counted.most_common(MANY)]
    return f"what alternates: {'; '.join(words)}" if words else ""


def _cause(code: int, pairs: Sequence[Pair], bodies: Sequence[str]) -> str:
    number, kind = divmod(code, KINDS)
    if kind == BEARING:
        return f"dry friction in the bearing of {bodies[number]} holds or lets go"
    return _WORDS[kind].format(pairs[number])


def furthest(state: State, model: Model, bodies: Sequence[str]) -> str:
    """The body that has gone furthest, in words: how far, and to what its position is rounded."""
    i = int(np.argmax(np.abs(state.q) / model.coordinates.scale))
    b = int(model.coordinates[i].body)
    turns = model.bodies[b].motion == PIVOT or i == model.bodies[b].first + 2
    place, unit = abs(float(state.q[i])), "rad" if turns else "m"
    return f"{bodies[b]} is at {place:.2g} {unit}, rounded to {np.spacing(place):.1g} {unit}. Check forces, masses and gravity"


def touching(state: State, pairs: Sequence[Pair]) -> str:
    """The contacts in force, in words."""
    ids = state.active[: state.now.awake_contacts].tolist()
    return "in contact: " + "; ".join(str(pairs[k]) for k in ids[:MANY]) if ids else ""
