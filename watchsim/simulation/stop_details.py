"""What is known of where and why a run ended, in words?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from watchsim.model.records import PIVOT, Model
from watchsim.simulation.advance import BEARING, KINDS, TOUCHED
from watchsim.simulation.loop_state.scratch import RECENT, Ended
from watchsim.simulation.loop_state.state import State
from watchsim.simulation.motion.coupled_motion import EXTENT, NORMAL, PARADOX, TANGENTIAL
from watchsim.simulation.record.contact_names import Pair

ADVICE = "Try a tighter tolerance; if that does not help, this is a fault of the program, and the scene shows it"
MANY = 6  # different causes named

_WORDS = {
    NORMAL: "the force ends at {}",
    TANGENTIAL: "slip or grip ends at {}",
    EXTENT: "an edge ends at {}",
    PARADOX: "no finite force holds {}",
    TOUCHED: "{} touch",
}


def unaccounted(energy: Mapping[str, Any]) -> str:
    """How far the ledger is from closing."""
    return f"{energy['residual_J']:.3g} J are unaccounted for, of {energy['in_J']:.3g} J put in. {ADVICE}"


def unexplained(state: State, pairs: Sequence[Pair]) -> str:
    """The contacts in force where velocities changed by more than impulses explain."""
    ids = state.active[: state.now.awake_contacts].tolist()
    touching = "in contact: " + "; ".join(str(pairs[k]) for k in ids[:MANY]) if ids else ""
    return ". ".join(filter(None, (touching, ADVICE)))


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
