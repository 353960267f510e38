"""What does the second process make of a run while the first one steps it?

At first the empty panels of the plots; then of settled events the text of events.csv, and of beats that are over the text of
phases.csv; when the run is over, its plots. (See `second_process`.)
"""

from __future__ import annotations

import math
import os
import select
import socket
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.beat_tables import finished_phases, time_of_a_part
from watchsim.commands.common.run_pictures import empty_panels, plots
from watchsim.commands.second.drawn_in_two import drawn
from watchsim.mechanism.compile import compile_scene
from watchsim.results.tables import EventLines
from watchsim.scene.recording import EVERYTHING
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.simulation.stops import Stop
from watchsim.storage.columns import MOST
from watchsim.storage.handed_over import hand_over, take_over

Arrays = Sequence[NDArray[Any]]
SURE = 1.02  # of the time of a part of the beats: by then it is over, and what follows it has begun
LATE = 0.5  # of that time before the end of the run: plots come first then, and the first process can do the rest as well


def work(line: socket.socket) -> None:
    """Serve the first process until it has all, or has gone."""
    _load()
    scene, folder, *how = take_over(line)
    panels = empty_panels(scene)
    phases = PhasesMeanwhile(scene, *how)
    lines: EventLines | None = None
    message = take_over(line)
    while len(message) > 1:
        pairs, events, rows = message
        lines = lines or EventLines(scene, pairs, folder)
        lines.add(events)
        phases.add(pairs, events, rows)
        if not select.select([line], [], [], 0.0)[0]:  # who is behind catches up first
            phases.work()
        message = take_over(line)
    (run,) = message
    hand_over(line, phases.texts)
    table = (lines or EventLines(scene, run.pairs, folder)).rest(run)
    hand_over(line, table)
    with ThreadPoolExecutor(1) as disk:
        disk.submit(os.fsync, table.fileno())  # as it must be in the end; the disk needs no processor
        hand_over(line, drawn(plots(run, panels)))


def _load() -> None:
    """Load what draws plots, while the first process reads the scene."""
    import watchsim.render.figures.kinematics_plot
    import watchsim.render.figures.shown_figure  # noqa: F401


class PhasesMeanwhile:
    """The text of phases.csv of beats that are over while a run goes on, a few hundred at a time; of its first minutes."""

    def __init__(self, scene: Scene, duration: float, method: str, tolerance: float) -> None:
        self.texts: dict[bytes, str] = {}
        self._scene, self._method, self._tolerance = scene, method, tolerance
        self._pairs: Sequence[Pair] = ()
        self._events: list[NDArray[Any]] = []
        self._rows: list[Arrays] = []
        self._held = 0  # bytes
        self._time = 0.0  # s, that the run has reached
        self._part = time_of_a_part(scene) if scene.record == EVERYTHING else math.inf
        self._next, self._late = SURE * self._part, duration - LATE * self._part

    def add(self, pairs: Sequence[Pair] | None, events: NDArray[Any], rows: Arrays) -> None:
        """The next events and rows; `pairs` once."""
        if self._next == math.inf:
            return
        self._pairs = pairs or self._pairs
        self._events.append(events)
        self._rows.append(rows)
        self._held += events.nbytes + sum(column.nbytes for column in rows)
        if len(rows[0]):
            self._time = float(rows[0][-1])
        if self._held > MOST:
            self._next, self._events, self._rows = math.inf, [], []

    def work(self) -> None:
        """Make text of what is over and was not made yet."""
        if self._next <= self._time < self._late:
            self.texts |= finished_phases(self._run(self._time), self.texts)
            self._next = self._time + self._part - self._time % self._part + (SURE - 1.0) * self._part

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
