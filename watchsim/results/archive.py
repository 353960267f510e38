"""How does a trajectory become one file, and one file a trajectory?

An npz archive of plain arrays (nothing is pickled) with a header in JSON. The scene is stored beside it, as text.
"""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.results.tables import plain
from watchsim.scene.scene import Scene
from watchsim.simulation.recording import Pair, Pairs, as_pairs
from watchsim.simulation.saved_state import SavedState
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.columns import blocks, unpacked

FORMAT_ARCHIVE = 4
OLDER = 3  # in which every pair was written out in words
SCALARS = ("stop_message", "simulated", "wall", "compile", "method", "tolerance", "step", "keep")
FLOATS = ("simulated", "wall", "compile", "tolerance", "worst_penetration", "worst_residual")
AS_IT_IS = 16e6  # bytes: a shorter array is not packed, which would take a tenth of the time of its run to save a third
COLUMNS = ("t", "q", "u", "a", "events", "end_q", "end_u")
NUMBERS = ("worst_penetration", "worst_residual", "overlap", "energy", "counts", "sums")


def write_trajectory(run: Trajectory, path: Path | IO[bytes]) -> None:
    """Write the file `path` (npz): t, q, u, a and events in full precision, and everything else but the scene."""
    header = {
        "format": FORMAT_ARCHIVE,
        "stop": run.stop.name,
        "slices": {body: [columns.start, columns.stop] for body, columns in run.slices.items()},
        "names": as_pairs(run.pairs).names,
        "spans": run.spans,
        **{name: getattr(run, name) for name in (*SCALARS, *NUMBERS)},
    }
    text = np.frombuffer(json.dumps(plain(header)).encode(), dtype=np.uint8)
    arrays: dict[str, NDArray[Any]] = {"header": text, "t": run.t, "q": run.q, "u": run.u, "a": run.a, "events": run.events}
    arrays |= {"end_q": run.end_q, "end_u": run.end_u, "pairs": as_pairs(run.pairs).table}
    # Level 1 takes a third of the time of numpy's own level 6 for a tenth more bytes.
    with zipfile.ZipFile(path, "w", compresslevel=1) as archive:
        for name, array in arrays.items():
            archive.compression = zipfile.ZIP_DEFLATED if array.nbytes > AS_IT_IS else zipfile.ZIP_STORED
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                write_array(file, array)


def write_array(file: IO[bytes], array: NDArray[Any]) -> None:
    """As `numpy.lib.format.write_array`, in pieces that are let go: an array may lie in a file, and be larger than memory."""
    whole = np.ascontiguousarray(array)
    np.lib.format.write_array_header_1_0(file, np.lib.format.header_data_from_array_1_0(whole))
    for (part,) in blocks(whole):
        file.write(part.tobytes())


def read_trajectory(path: Path, scene: Scene) -> Trajectory:
    """The trajectory of `scene` kept in `path`; ValueError where the file is damaged or belongs to another scene.

    Long columns are mapped from files without a name, so that a run may be larger than memory.
    """
    with whole(path, "trajectory"), np.load(path, allow_pickle=False) as archive:
        header: dict[str, Any] = json.loads(archive["header"].tobytes())
        kind = header["format"]
        columns: dict[str, Any] = {name: unpacked(archive, name, path.parent) for name in COLUMNS}
        table = archive.get("pairs")
    if kind not in (FORMAT_ARCHIVE, OLDER):
        raise ValueError(f"{path} has format {kind}; this version reads format {FORMAT_ARCHIVE}. Run the scene again")
    with whole(path, "trajectory"):
        slices = {body: slice(*ends) for body, ends in header["slices"].items()}
    moving = {body.name for body in scene.bodies if body.motion != "fixed"}
    if set(slices) != moving:
        raise ValueError(
            f"{path} holds the motion of {', '.join(sorted(slices)) or 'nothing'}, but in the scene beside it "
            f"{', '.join(sorted(moving)) or 'nothing'} can move: the two do not belong together"
        )
    with whole(path, "trajectory"):
        columns["events"] = columns["events"].astype(EVENT_DTYPE, copy=False)
        header.setdefault("overlap", {})  # of files written before it was looked for
        kept = {name: header[name] for name in (*SCALARS, *NUMBERS)}
        if table is None:
            pairs = as_pairs([Pair(**pair) for pair in header["pairs"]])
        else:
            pairs = Pairs([(body, word, index, layer) for body, word, index, layer in header["names"]], table)
        spans = tuple((float(start), float(end)) for start, end in header["spans"])
        run = Trajectory(scene=scene, slices=slices, pairs=pairs, spans=spans, stop=Stop[header["stop"]], **columns, **kept)
        _check(run)
    return run


@contextmanager
def whole(path: Path, what: str) -> Iterator[None]:
    """ValueError for whatever reading a damaged file brings: an archive can be wrong in more ways than anybody has named."""
    try:
        yield
    except Exception as error:
        if isinstance(error, OSError) and error.errno is not None:  # not the content: no such file, no permission
            raise
        words = str(error) or type(error).__name__
        raise ValueError(f"{path} is damaged or is not a {what} of watchsim ({words[:200]})") from error


def _check(run: Trajectory) -> None:
    """ValueError where the parts do not fit together."""
    rows, width = len(run.t), max((columns.stop for columns in run.slices.values()), default=0)
    if run.t.shape != (rows,) or any(array.shape != (rows, width) for array in (run.q, run.u, run.a)):
        raise ValueError("its columns are of different lengths")
    if any(array.dtype != np.float64 for array in (run.t, run.q, run.u, run.a)) or not _finite(run):
        raise ValueError("it holds something that is not a number")
    if any(array.dtype != np.float64 or array.shape not in ((0,), (width,)) for array in (run.end_q, run.end_u)):
        raise ValueError("its end is no state")
    if not _in_order(run.t) or any(not _within(part["contact"], -1, len(run.pairs)) for (part,) in blocks(run.events)):
        raise ValueError("its rows are out of order, or its events of unknown contacts")
    for (part,) in blocks(run.events):
        if not _within(part["body"], -1, len(run.scene.bodies)) or not set(np.unique(part["kind"]).tolist()) <= set(EventKind):
            raise ValueError("its events name unknown bodies or kinds")
    _check_pairs(as_pairs(run.pairs), _groups(run.scene))
    if not all(isinstance(getattr(run, name), (int, float)) for name in FLOATS) or not isinstance(run.stop_message, str):
        raise ValueError("its header holds something that is not a number")
    if not all(isinstance(mapping, dict) for mapping in (run.overlap, run.energy, run.counts, run.sums)):
        raise ValueError("its header holds no sums")


def _groups(scene: Scene) -> int:
    """How many contacts there are: those declared, of stops of springs, and of gears with play."""
    return len(scene.contacts) + sum(spring.stop is not None for spring in scene.springs) + len(scene.gears)


def _check_pairs(pairs: Pairs, groups: int) -> None:
    """ValueError where a contact is not one of two named primitives and of one of the scene's `groups` of contacts."""
    table = pairs.table
    if table.dtype.kind != "i" or table.shape != (len(table), 3):
        raise ValueError("its contacts are not whole numbers in threes")
    if not (_within(table[:, 0], 0, groups) and _within(table[:, 1:], 0, len(pairs.names))):
        raise ValueError("its contacts are of unknown primitives")


def _within(numbers: NDArray[Any], first: int, end: int) -> bool:
    """True if all lie in [first, end)."""
    return not numbers.size or bool(first <= numbers.min() and numbers.max() < end)


def _finite(run: Trajectory) -> bool:
    return all(
        np.isfinite(part["t"] if part.dtype.names else part).all()
        for array in (run.t, run.q, run.u, run.a, run.events)
        for (part,) in blocks(array)
    )


def _in_order(t: NDArray[np.float64]) -> bool:
    before = -np.inf
    for (part,) in blocks(t):
        if part[0] < before or np.any(np.diff(part) < 0.0):
            return False
        before = part[-1]
    return True


# How does a saved state become a file, and a file a saved state?

FORMAT = 2
PARTS = ("state", "tally", "recorded")  # of a state: what the names of their arrays begin with


def write_state(state: SavedState, path: Path) -> None:
    """Write `path` (npz): every array in full precision, a header in JSON; nothing is pickled."""
    names = ("digest", "settings", "stored_at_start", "rows", "events")
    header = {"format": FORMAT, **{name: getattr(state, name) for name in names}}
    groups = zip(PARTS, (state.arrays, state.tally, state.recorded), strict=True)
    arrays: dict[str, Any] = {f"{part}_{name}": array for part, group in groups for name, array in group.items()}
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
        own, tally, recorded = (
            {name.removeprefix(f"{part}_"): array for name, array in arrays.items() if name.startswith(f"{part}_")}
            for part in PARTS
        )
        state = SavedState(arrays=own, tally=tally, recorded=recorded, **header)
        if not state.is_whole():
            raise ValueError("its parts do not fit together")
    return state
