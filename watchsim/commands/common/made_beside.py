"""What does the second process make of a run while the first one steps it?

At first the empty panels of the plots; then of settled events the text of events.csv, and of beats that are over the text of
phases.csv; when the run is over, its plots. (See `second_process`.)
"""

from __future__ import annotations

import functools
import math
import os
import socket
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.beat_tables import finished_phases, time_of_a_part
from watchsim.commands.common.run_pictures import Draw, empty_panels, plots
from watchsim.mechanism.compile import compile_scene
from watchsim.results.tables import EventLines
from watchsim.scene.recording import EVERYTHING
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.simulation.stops import Stop
from watchsim.storage.columns import MOST
from watchsim.storage.handed_over import hand_over, memory_file, take_over

Arrays = Sequence[NDArray[Any]]
SURE = 1.02  # of the time of a part of the beats: by then it is over, and what follows it has begun


def work(line: socket.socket) -> None:
    """Serve the first process until it has all, or has gone."""
    scene, folder, method, tolerance = take_over(line)
    panels = empty_panels(scene)
    phases = PhasesMeanwhile(scene, method, tolerance)
    lines: EventLines | None = None
    message = take_over(line)
    while len(message) > 1:
        pairs, events, rows = message
        lines = lines or EventLines(scene, pairs, folder)
        lines.add(events)
        phases.add(pairs, events, rows)
        message = take_over(line)
    (run,) = message
    hand_over(line, phases.texts)
    table = (lines or EventLines(scene, run.pairs, folder)).rest(run)
    hand_over(line, table)
    with ThreadPoolExecutor(1) as disk:
        disk.submit(os.fsync, table.fileno())  # as it must be in the end; the disk needs no processor
        hand_over(line, _drawn(plots(run, panels)))


def _drawn(draws: Mapping[str, Draw]) -> dict[str, IO[bytes]]:
    """The pictures: the first drawn here, every other one in a copy of this process, at the same time."""
    files = {name: memory_file() for name in draws}
    copies = {name: _copy_that(functools.partial(_draw, draws[name], files[name])) for name in list(draws)[1:]}
    for name in draws:
        if name not in copies or os.waitpid(copies[name], 0)[1]:
            _draw(draws[name], files[name])
    return files


def _draw(draw: Draw, file: IO[bytes]) -> None:
    file.seek(0)
    draw(file)
    file.flush()
    file.truncate()


def _copy_that(work: Callable[[], object]) -> int:
    """The number of a copy of this process that does some work and ends, with status 0 where all went well."""
    child = os.fork()
    if child:
        return child
    status = 1
    try:
        work()
        status = 0
    finally:
        os._exit(status)


class PhasesMeanwhile:
    """The text of phases.csv of beats that are over while a run goes on, a few hundred at a time; of its first minutes."""

    def __init__(self, scene: Scene, method: str, tolerance: float) -> None:
        self.texts: dict[bytes, str] = {}
        self._scene, self._method, self._tolerance = scene, method, tolerance
        self._pairs: Sequence[Pair] = ()
        self._events: list[NDArray[Any]] = []
        self._rows: list[Arrays] = []
        self._held = 0  # bytes
        self._part = time_of_a_part(scene) if scene.record == EVERYTHING else math.inf
        self._next = SURE * self._part

    def add(self, pairs: Sequence[Pair] | None, events: NDArray[Any], rows: Arrays) -> None:
        """The next events and rows; `pairs` once."""
        if self._next == math.inf:
            return
        self._pairs = pairs or self._pairs
        self._events.append(events)
        self._rows.append(rows)
        self._held += events.nbytes + sum(column.nbytes for column in rows)
        time = float(rows[0][-1]) if len(rows[0]) else -math.inf
        if time >= self._next:
            self.texts |= finished_phases(self._run(time), self.texts)
            self._next += self._part
        if self._held > MOST:
            self._next, self._events, self._rows = math.inf, [], []

    def _run(self, time: float) -> Trajectory:
        """The run up to now."""
        t, q, u, a = (np.concatenate(columns) for columns in zip(*self._rows, strict=True))
        return Trajectory(
            self._scene,
            *(t, q, u, a),
            slices=compile_scene(self._scene).slices,
            events=np.concatenate(self._events),
            pairs=self._pairs,
            stop=Stop.DURATION,
            simulated=time,
            method=self._method,
            tolerance=self._tolerance,
            spans=((0.0, time),),
        )
