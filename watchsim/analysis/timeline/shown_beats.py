"""Which beats does a table or a plot of the timeline show, and what did their contacts take, pair by pair?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from watchsim.analysis.timeline.friction import friction_by_pair
from watchsim.analysis.timeline.rows import Stage, can_be_told, timeline
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.rows_at_hand import nominal_period
from watchsim.scene.roles import with_anchor
from watchsim.simulation.record.trajectory import Trajectory

BEGINNING = ("unlock", "impulse")  # the first phase of a beat
RESTING = ("locked", "recoil")  # and the last


@dataclass(frozen=True)
class Beat:
    """One beat: its phases in order, and of each what friction took by pair of bodies, J (empty where that was not asked for).

    `residual`: what the books of the beat lack, J, friction as worked out from forces.
    """

    stages: tuple[Stage, ...]
    friction: tuple[dict[str, float], ...]

    @property
    def start(self) -> float:
        return self.stages[0].phase.start

    @property
    def first(self) -> str:
        """What the beat begins with: the unlocking, or the impulse where the tooth slides straight onto the face."""
        return f"beginning of the {'unlocking' if self.stages[0].name == 'unlock' else 'impulse'}"

    @property
    def end(self) -> float:
        return self.stages[-1].phase.end

    @property
    def residual(self) -> float:
        taken = sum(value for one in self.friction for value in one.values())
        return sum(stage.energy.friction for stage in self.stages) - taken


def shown_beats(run: Trajectory, window: Sequence[float] | None = None, rubbed: bool = True) -> list[Beat]:
    """The beats that begin within a window (s), by default those of the last oscillation that was recorded whole.

    Without `rubbed` what friction took is not worked out by pair, which takes most of the time. ValueError in words where there
    are none.
    """
    parts = with_anchor(run.scene)
    name = parts.oscillator
    if name is None:
        raise ValueError("nothing in this scene swings, so it has no beats")
    if parts.wheel is None:
        raise ValueError(f"phases are those of an escapement, and no driven wheel keeps {name} swinging")
    if parts.lever is None:
        raise ValueError(f"phases exist where there is a lever or an anchor; none stands between {parts.wheel} and {name}")
    if not can_be_told(run):
        raise ValueError("a timeline needs a run by events with all of them kept")
    found = beats(run)
    if window is None:
        last = float(found.end[-1]) if len(found) else run.simulated
        window = (last - 3.1 * nominal_period(run, name), last)
        stages = timeline(run, found, window)
        chosen = sorted({one.beat for one in stages})
        whole = [beat for beat in chosen if any(one.beat == beat and one.name in RESTING for one in stages)][-2:]
        stages = [one for one in stages if one.beat in whole]
    else:
        stages = timeline(run, found, window)
    if not stages:
        raise ValueError("no beat of an escapement was recorded whole there")
    beats_shown = ([one for one in stages if one.beat == beat] for beat in sorted({one.beat for one in stages}))
    return [_beat(run, own) if rubbed else Beat(tuple(own), ()) for own in beats_shown]


def _beat(run: Trajectory, stages: list[Stage]) -> Beat:
    ends = [one.phase.start for one in stages] + [stages[-1].phase.end]
    return Beat(tuple(stages), tuple(friction_by_pair(run, ends)))
