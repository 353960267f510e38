"""How does a watch run for an hour, minute by minute, and does a locked lever creep?"""

from __future__ import annotations

import dataclasses
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing.beats import DAY, beats
from watchsim.analysis.timing.escape_wheel import missed_beats
from watchsim.scene.recording import EVERYTHING
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

PIECE = 60.0  # s
TIGHTER = 0.01  # of the tolerance, for comparison
STEADY = 1e-6  # °, what the amplitude should be steady to
Floats = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Long:
    """A long run: one entry per window of a minute, and what is said of the whole."""

    title: str
    end: Floats  # s
    amplitude: Floats  # °, mean of the half swings
    spread: Floats  # °, between the smallest and the largest of them
    rate: Floats  # s/d
    residual: Floats  # J, of the ledger since the start
    supplied: Floats  # J, work of the drive since the start
    half_swings: int
    missed: int | None
    penetration: float
    complementarity: float
    counts: dict[str, int]
    cpu: float
    tight: tuple[float, float]  # a tighter tolerance, and the residual's share of the work put in there

    @property
    def settled(self) -> int:
        """First window from which on the mean amplitude stays within `STEADY` of its mean."""
        for first in range(len(self.amplitude)):
            rest = self.amplitude[first:]
            if np.abs(rest - rest.mean()).max() <= 0.5 * STEADY:
                return first
        return len(self.amplitude)

    @property
    def growth(self) -> tuple[float, float]:
        """J a minute that the residual grows by, least squares over the settled half, and the error of that slope."""
        half = len(self.end) // 2
        t, r = self.end[half:] / PIECE, self.residual[half:]
        (slope, _), covariance = np.polyfit(t, r, 1, cov=True)
        return float(slope), float(np.sqrt(covariance[0, 0]))


def pieces(scene: Scene, duration: float) -> list[Trajectory]:
    """The run minute by minute, of each what analysis needs: turning points, passages, and where all bodies are then."""
    kept: list[Trajectory] = []
    start, reached = None, 0.0
    while reached < duration:
        reached = min(duration, reached + PIECE)
        run = simulate(scene, reached, record=EVERYTHING, start=start)
        if run.stop != Stop.DURATION or run.end_state is None:
            raise SystemExit(f"{scene.title}: {run.stop_message}")
        start = run.end_state
        # What lies beyond the saved state is told again by the next piece.
        events = run.events[: start.events] if reached < duration else run.events
        turns = events[events["kind"] == EventKind.TURN]
        q, u = run.sample(turns["t"])
        events = events[np.isin(events["kind"], (EventKind.TURN, EventKind.CROSS))]
        kept.append(dataclasses.replace(run, t=turns["t"], q=q, u=u, a=np.zeros_like(q), events=events))
    return kept


def long_run(scene: Scene, duration: float) -> Long:
    """Run and condense."""
    begun = time.process_time()
    parts = pieces(scene, duration)
    cpu = time.process_time() - begun
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in ("t", "q", "u", "a", "events")
    }
    whole = dataclasses.replace(parts[-1], **joined)
    found, wheel = beats(whole), roles(scene).wheel
    end = np.array([part.simulated for part in parts])
    window = np.searchsorted(end, found.t)
    by_window = [found.amplitude_deg[window == i] for i in range(len(parts))]
    periods = np.array([np.nanmean(found.period_s[window == i]) for i in range(len(parts))])
    return Long(
        title=scene.title,
        end=end,
        amplitude=np.array([one.mean() for one in by_window]),
        spread=np.array([np.ptp(one) for one in by_window]),
        rate=DAY * (found.nominal_period / periods - 1.0),
        residual=np.array([part.energy["residual_J"] for part in parts]),
        supplied=np.array([part.energy["in_J"] for part in parts]),
        half_swings=len(found),
        missed=missed_beats(whole, wheel, found) if wheel else None,
        penetration=whole.worst_penetration,
        complementarity=whole.worst_residual,
        counts=whole.counts,
        cpu=cpu,
        tight=(TIGHTER * scene.tolerance, _share(scene, TIGHTER * scene.tolerance)),
    )


def _share(scene: Scene, tolerance: float) -> float:
    """The residual's share of the work put in, from 5 s to 15 s."""
    early = simulate(scene, 5.0, tolerance, record=EVERYTHING)
    late = simulate(scene, 15.0, tolerance, record=EVERYTHING, start=early)
    residual, supplied = (late.energy[name] - early.energy[name] for name in ("residual_J", "in_J"))
    return abs(residual) / float(supplied)


def locked(scene: Scene) -> Scene:
    """The balance stands still far outside the fork, where its spring is at rest; the wheel presses the locked lever."""
    balance = scene.body("balance")
    return dataclasses.replace(scene, springs=(dataclasses.replace(scene.springs[0], rest=balance.angle),))


def creep(scene: Scene, duration: float) -> tuple[Floats, float]:
    """(largest change of each coordinate after the first second, seconds of processor time)."""
    begun = time.process_time()
    scene = dataclasses.replace(locked(scene), duration=duration)
    run = simulate(scene, duration, record=((0.0, 1.0), (duration - 1.0, duration)))
    if run.stop != Stop.DURATION:
        raise SystemExit(f"{scene.title}, locked: {run.stop_message}")
    return np.abs(run.q[-1] - run.at(1.0)[0]), time.process_time() - begun
