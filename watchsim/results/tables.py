"""How are numbers and events written for other programs: JSON and CSV?"""

from __future__ import annotations

import csv
import functools
import io
import json
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from enum import Enum
from itertools import chain, repeat
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.scene.scene import Scene
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.columns import blocks
from watchsim.storage.destination import give_name, nameless

HEAD = b"t_s,event,pair,bodies,primitives,impulse_N_s,tangential_impulse_N_s,energy_lost_J,value\r\n"
ROWS = 1 << 13  # of the table that are made into text together
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")  # what a text begins with that spreadsheets compute
NO_IMPULSE = "0.0,0.0,0.0,"  # of an event that is no impact


def plain(value: Any) -> Any:
    """The value in what JSON knows: numpy numbers and arrays unpacked, names for enums, null for what is not finite."""
    if type(value) in (str, int):  # most of it
        return value
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def json_text(mapping: Mapping[str, Any]) -> str:
    """Readable, valid JSON."""
    return json.dumps(plain(mapping), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def write_events(run: Trajectory, path: Path) -> None:
    """Write the event table as CSV. `pair` is a row of the trajectory's pairs; turning points and crossings have none.

    `value` is the direction of sliding, the end of an accumulation (s), a turning point (rad or m) or the velocity at rest
    position (rad/s or m/s), by the kind of event.
    """
    EventLines(run.scene, run.pairs).write(run, path)


class EventLines:
    """The rows of events.csv, which may be begun while the run goes on, in a file in `folder` that has no name yet.

    Then `add` takes the first ones, and `settle` the others.
    """

    def __init__(self, scene: Scene, pairs: Sequence[Pair], folder: Path | None = None) -> None:
        names = [body.name for body in scene.bodies]
        self._kinds = {int(kind): kind.name.lower() for kind in EventKind}
        self._sides = functools.cache(lambda contact, body: _row(_sides(pairs, contact, body, names)))
        self._begun = nameless(folder) if folder else None
        self._settled: Future[None] | None = None
        self.rows = 0
        if self._begun:
            self._begun.write(HEAD)

    def add(self, events: NDArray[Any]) -> None:
        """The next events of the run, in order."""
        assert self._begun
        self._begun.writelines(self._of(events))
        self.rows += len(events)

    def settle(self, run: Trajectory) -> None:
        """Add what is missing of a run, and let a thread wait until the disk has it all."""
        assert self._begun
        thread = ThreadPoolExecutor(1)
        self._settled = thread.submit(self._finish, run)
        thread.shutdown(wait=False)

    def _finish(self, run: Trajectory) -> None:
        os.fsync(self.rest(run).fileno())

    def rest(self, run: Trajectory) -> IO[bytes]:
        """Add what is missing of a run; the file that then holds all."""
        assert self._begun
        self.add(run.events[self.rows :])
        self._begun.flush()
        return self._begun

    def write(self, run: Trajectory, path: Path) -> None:
        """Write the table of a run: what was begun, once it is settled, or again where that failed."""
        if self._begun and self._settled and not self._settled.exception():
            give_name(self._begun, path)
            return
        with path.open("wb") as file:
            file.write(HEAD)
            file.writelines(self._of(run.events))

    def _of(self, events: NDArray[Any]) -> Iterator[bytes]:
        # What is the same in thousands of rows is made into text once, and of the rest a column at a time: half the time of a
        # csv.writer that sees every field.
        for (part,) in blocks(events, length=ROWS):
            yield "".join(_lines(part, self._kinds, self._sides)).encode()


def _lines(events: NDArray[Any], kinds: Mapping[int, str], sides: Callable[[int, int], str]) -> Iterator[str]:
    """The rows as text, cut anywhere."""
    times, back = _runs(events["t"])  # at one instant there is often more than one event
    instants = np.array([f"{t!r}," for t in times.tolist()], object)[back].tolist()
    places = [events[name].astype(np.int64) + 1 for name in ("kind", "contact", "body")]
    sizes = [int(np.max(place, initial=0)) + 1 for place in places]
    what, back = np.unique(np.ravel_multi_index(places, sizes), return_inverse=True)
    each = (np.array(np.unravel_index(what, sizes)).T - 1).tolist()
    causes = np.array([f"{kinds[kind]},{sides(contact, body)}," for kind, contact, body in each], object)[back].tolist()
    impulses = [events[name] for name in ("impulse_normal", "impulse_tangential", "energy_lost")]
    struck = np.flatnonzero(np.any([(values != 0.0) | np.signbit(values) for values in impulses], axis=0))
    pushed = np.full(len(events), NO_IMPULSE, object)
    rows = zip(*(values[struck].tolist() for values in impulses), strict=True)
    pushed[struck] = [f"{normal!r},{tangential!r},{lost!r}," for normal, tangential, lost in rows]
    values = map(repr, events["value"].tolist())
    return chain.from_iterable(zip(instants, causes, pushed.tolist(), values, repeat("\r\n")))


def _runs(values: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """What differs from the one before, and the number of that for every value."""
    begins = np.append(True, values[1:] != values[:-1])[: len(values)]
    return values[begins], np.cumsum(begins) - 1


def cell(text: str) -> str:
    """A text as a spreadsheet shall show it: one that begins like a formula would be computed, whoever wrote the scene."""
    whole = text.replace("\r", " ").replace("\n", " ")  # csv.writer does not always put line breaks in quotes
    return f"'{whole}" if text.startswith(FORMULA) else whole


def _row(fields: Iterable[object]) -> str:
    """Fields with commas between them, in quotes where they must be."""
    out = io.StringIO()
    csv.writer(out, lineterminator="").writerow([cell(one) if isinstance(one, str) else one for one in fields])
    return out.getvalue()


def _sides(pairs: Sequence[Pair], contact: int, body: int, names: list[str]) -> tuple[object, str, str]:
    if contact < 0:
        return "", names[body] if body >= 0 else "", ""
    pair = pairs[contact]
    first = f"{pair.layer_a} {pair.primitive_a} {pair.index_a}"
    second = f"{pair.layer_b} {pair.primitive_b} {pair.index_b}"
    return contact, f"{pair.body_a}/{pair.body_b}", f"{first} / {second}"
