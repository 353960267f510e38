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

from watchsim.analysis.beat_tables import finished_phases, time_of_a_part
from watchsim.commands.common.run_pictures import empty_panels, plots
from watchsim.commands.second.drawn_in_two import drawn
from watchsim.commands.second.settled import Settled
from watchsim.mechanism.compile import compile_scene
from watchsim.results.tables import EventLines
from watchsim.scene.recording import EVERYTHING
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.simulation.stops import Stop
from watchsim.storage.handed_over import hand_over, take_over

SURE = 1.02  # of the time of a part of the beats: by then it is over, and what follows it has begun
LATE = 0.5  # of that time before the end of the run: plots come first then, and the first process can do the rest as well


def work(line: socket.socket) -> None:
    """Serve the first process until it has all, or has gone."""
    _load()
    scene, folder, *how = take_over(line)
    panels = empty_panels(scene)
    settled, phases = Settled(), PhasesMeanwhile(scene, *how)
    lines: EventLines | None = None
    known: Sequence[Pair] = ()
    message = take_over(line)
    while len(message) > 1:
        pairs, events, rows = message
        lines = lines or EventLines(scene, pairs, folder)
        lines.add(events)
        settled.add(events, rows)
        known = pairs or known
        if not select.select([line], [], [], 0.0)[0]:  # who is behind catches up first
            phases.work(known, settled)
        message = take_over(line)
    run = settled.whole(*message)
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
        self._part = time_of_a_part(scene) if scene.record == EVERYTHING else math.inf
        self._next, self._late = SURE * self._part, duration - LATE * self._part

    def work(self, pairs: Sequence[Pair], settled: Settled) -> None:
        """Make text of what is over and was not made yet."""
        time = settled.time
        if settled.is_held and self._next <= time < self._late:
            self.texts |= finished_phases(self._run(pairs, settled), self.texts)
            self._next = time + self._part - time % self._part + (SURE - 1.0) * self._part

    def _run(self, pairs: Sequence[Pair], settled: Settled) -> Trajectory:
        """The run up to now."""
        events, t, q, u, a = settled.columns()
        return Trajectory(
            self._scene,
            *(t, q, u, a),
            slices=compile_scene(self._scene).slices,
            events=events,
            pairs=pairs,
            stop=Stop.DURATION,
            simulated=settled.time,
            method=self._method,
            tolerance=self._tolerance,
            spans=((0.0, settled.time),),
        )
