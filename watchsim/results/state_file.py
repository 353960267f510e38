"""How does a saved state become a file, and a file a saved state?"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.results.archive import whole
from watchsim.simulation.record.saved_state import SavedState

FORMAT = 2
PARTS = ("state", "tally", "recorded")  # of a state: what the names of their arrays begin with


def write_state(state: SavedState, path: Path) -> None:
    """Write `path` (npz): every array in full precision, a header in JSON; nothing is pickled."""
    header = {
        "format": FORMAT,
        "digest": state.digest,
        "settings": state.settings,
        "stored_at_start": state.stored_at_start,
        "rows": state.rows,
        "events": state.events,
    }
    arrays: dict[str, Any] = {f"state_{name}": array for name, array in state.arrays.items()}
    arrays.update({f"tally_{name}": array for name, array in state.tally.items()})
    arrays.update({f"recorded_{name}": array for name, array in state.recorded.items()})
    np.savez_compressed(path, header=np.frombuffer(json.dumps(header).encode(), dtype=np.uint8), **arrays)


def read_state(path: Path) -> SavedState:
    """The state kept in `path`; ValueError where the file is damaged or of another version."""
    with whole(path, "saved state"), np.load(path, allow_pickle=False) as archive:
        header: dict[str, Any] = json.loads(archive["header"].tobytes())
        arrays = {name: archive[name] for name in archive.files if name != "header"}
        kind = header.pop("format", None)
    if kind != FORMAT:
        raise ValueError(f"{path} was written by another version of watchsim; run the scene again")
    with whole(path, "saved state"):
        own, tally, recorded = (_of(arrays, f"{part}_") for part in PARTS)
        state = SavedState(arrays=own, tally=tally, recorded=recorded, **header)
        if not state.is_whole():
            raise ValueError("its parts do not fit together")
    return state


def _of(arrays: dict[str, Any], prefix: str) -> dict[str, Any]:
    return {name.removeprefix(prefix): array for name, array in arrays.items() if name.startswith(prefix)}
