"""As which plain arrays is a state saved, whatever its records are called?

The names and places are those of all saved states: `state.npz` is read by later versions.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.model.named_fields import copy_of, row_of, words_of
from watchsim.simulation.loop_state.state import State

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

NUMBERS = 6  # integer fields of `Now`; its lenience is an array of its own
HITS = 2  # integer fields of `Returning`, the first


class StateArrays(NamedTuple):
    """All a state holds; arrays share its memory."""

    clock: Array
    q: Array
    u: Array
    a: Array
    mode: NDArray[np.int8]
    grip: NDArray[np.int8]
    awake: NDArray[np.int8]
    active: Integers
    upto: Integers
    numbers: Integers
    side_u: NDArray[np.int8]
    side_q: NDArray[np.int8]
    sums: Array
    counts: Integers
    worst: Array
    decided: Integers
    lenience: Array
    returning: Integers
    returned: Array


def arrays_of(state: State) -> StateArrays:
    """The arrays of a state: what is written into them is written into the state."""
    parts: dict[str, NDArray[Any]] = {name: getattr(state, name) for name in StateArrays._fields if hasattr(state, name)}
    parts |= {name: words_of(parts[name], float) for name in ("clock", "sums", "worst")}
    parts["counts"] = words_of(state.counts, int)
    parts["numbers"], parts["lenience"] = words_of(state.now, int)[:NUMBERS], row_of(state.now)["lenience"]
    parts["returning"], parts["returned"] = words_of(state.returning, int)[:HITS], words_of(state.returning, float)[HITS:]
    return StateArrays(**parts)


def copy_of_state(state: State) -> State:
    """A state of its own."""
    return State._make(part.copy() if isinstance(part, np.ndarray) else copy_of(part) for part in state)


def write_state(state: State, other: State) -> None:
    """Write `other` into `state`."""
    new = arrays_of(other)._asdict()
    for name, part in arrays_of(state)._asdict().items():
        part[...] = new[name]
