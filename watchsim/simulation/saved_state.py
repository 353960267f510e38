"""What is a saved state, and does it belong to this scene?

The state of the loop in full precision, with a digest of the model it was made with and the settings: from it the same
future follows bit by bit.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled

TALLIED = ("kinds", "beats", "moments", "last", "carried")
# Not in states of earlier versions: they begin blank.
TALLIED_LATER = (
    *("late", "places", "pending", "row", "holding", "swung", "wheel.numbers", "wheel.off", "wheel.steps"),
    *("knocks.contacts", "knocks.together"),
)
LATER = ("returning", "returned", "row_a", "row_jerk", "since_row")  # the same of the state itself
EARLIER_NUMBERS = 6  # integers of `Instant`; the next one decides all islands where it is zero
# Of systems side by side: rows and events that wait to be merged, and how many of each system.
AHEAD = ("ahead", "ahead_events", "ahead_counts")
REQUESTED = ("method", "step", "tolerance")


@dataclass(frozen=True)
class SavedState:
    """A state to go on from. `rows` and `events` say how many of its run's kept rows and events lie before it.

    `tally` holds sums over all events before it (see `Tally` in tally.py); `recorded` what decides about the next rows
    (see `Recorder.unfinished`).
    """

    arrays: dict[str, NDArray[Any]]
    digest: str  # of the model and its start
    settings: dict[str, Any]  # method, tolerances, step
    stored_at_start: float  # J, of the whole run
    tally: dict[str, NDArray[Any]] = field(default_factory=dict)
    rows: int = 0
    events: int = 0
    recorded: dict[str, NDArray[Any]] = field(default_factory=dict)

    @property
    def time(self) -> float:
        """Simulated time it belongs to, s."""
        return float(self.arrays["clock"][0])

    def is_whole(self) -> bool:
        """True if it holds what every state holds, whatever the model."""
        clock = self.arrays.get("clock")
        return (
            clock is not None
            and clock.shape == (3,)
            and all(np.isfinite(array).all() for array in self.arrays.values())
            and set(TALLIED) <= set(self.tally) <= {*TALLIED, *TALLIED_LATER}
            and self._recorded_is_whole()
            and isinstance(self.settings, dict)
            and isinstance(self.stored_at_start, float)
            and all(isinstance(count, int) and count >= 0 for count in (self.rows, self.events))
        )

    def _recorded_is_whole(self) -> bool:
        if not self.recorded:
            return True
        if not {"met", "last", "row", "stays"} <= set(self.recorded) <= {"met", "last", "row", "stays", *AHEAD}:
            return False
        met, last, row, stays = (self.recorded[name] for name in ("met", "last", "row", "stays"))
        shapes = met.shape == () and last.shape == (2,) and row.ndim == 1 and stays.shape == (self.rows,)
        return bool(shapes and met.dtype.kind == "i" and last.dtype.kind == row.dtype.kind == "f" and stays.dtype == bool)

    def check(self, compiled: Compiled, settings: Mapping[str, Any]) -> None:
        """ValueError where the model or a setting is not the one the state was made with."""
        if self.digest != model_digest(compiled):
            raise ValueError(
                "the saved state belongs to another scene: bodies, outlines, forces, contacts or start values have changed "
                "since. Go on with the scene as it was (scene.lock.toml in the results folder), or start again"
            )
        changed = [name for name in {**self.settings, **settings} if self.settings.get(name) != settings.get(name)]
        if not changed:
            return
        requested = [name for name in REQUESTED if name in changed]
        changes = "; ".join(
            f"{name} was {self.settings.get(name)}, now {settings.get(name)}" for name in requested[:1] or changed
        )
        if not requested:
            # They follow from what is requested and from the scene, both of which are the same.
            raise ValueError(f"the saved state was written by another version of watchsim ({changes}); start again")
        raise ValueError(f"the saved state was made with other settings ({changes}). Use the same ones, or start again")

    def restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write the state into `arrays`; ValueError where another version of the package has saved it."""
        own = {**{name: np.zeros_like(arrays[name]) for name in LATER if name in arrays}, **self.arrays}
        if own.get("numbers", np.zeros(0)).shape == (EARLIER_NUMBERS,):
            own["numbers"] = np.append(own["numbers"], np.int64(0))
        shapes = {name: array.shape for name, array in own.items()}
        row = self.recorded.get("row", np.zeros(0)).shape in ((0,), (1 + 3 * len(arrays["q"]),))
        if shapes != {name: array.shape for name, array in arrays.items()} or not row:
            raise ValueError("the saved state was written by another version of watchsim; start again")
        for name, array in arrays.items():
            array[...] = own[name]


def save_state(
    compiled: Compiled,
    settings: Mapping[str, Any],
    arrays: Mapping[str, NDArray[Any]],
    stored: float,
    tally: dict[str, NDArray[Any]],
) -> SavedState:
    """A copy of the state in `arrays`."""
    copies = {name: np.array(array) for name, array in arrays.items()}
    return SavedState(copies, model_digest(compiled), dict(settings), float(stored), tally)


def model_digest(compiled: Compiled) -> str:
    """Of every number of the model and of the start."""
    digest = hashlib.sha256()
    for part in (*compiled.model, compiled.q, compiled.u):
        digest.update(f"({_described(part.dtype)}, {part.shape!r})".encode())
        digest.update(np.ascontiguousarray(part).reshape(-1).view(np.uint8).data)
    return digest.hexdigest()[:16]


@functools.cache
def _described(dtype: np.dtype[Any]) -> str:
    """The fields of a record; to put them into words takes longer than to digest a small model."""
    return repr(dtype.descr)
