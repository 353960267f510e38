"""Which plots are there of a run, and what draws each?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from watchsim.commands.common.console import InputError

if TYPE_CHECKING:
    from watchsim.analysis.timeline.shown_beats import Beat
    from watchsim.render.figures.figure_style import Figure
    from watchsim.simulation.record.trajectory import Trajectory

ALL = "all"


@dataclass(frozen=True)
class Request:
    """What was asked for: bodies (None: all), quantities, window (s; None: the usual one of each kind), width (mm)."""

    run: Trajectory
    bodies: list[str] | None
    quantities: tuple[str, ...]
    window: tuple[float, float] | None
    width: float

    @cached_property
    def beats(self) -> list[Beat]:
        """The beats that the plots of a beat share."""
        from watchsim.analysis.timeline.shown_beats import shown_beats

        return shown_beats(self.run, self.window, rubbed=False)

    @property
    def beats_if_any(self) -> list[Beat]:
        """The same; none where there are none."""
        try:
            return self.beats
        except ValueError:
            return []


def _kinematics(asked: Request) -> Figure:
    from watchsim.render.figures.kinematics_plot import plot_kinematics

    return plot_kinematics(asked.run, asked.bodies, asked.quantities, asked.window, asked.width)


def _phases(asked: Request) -> Figure:
    from watchsim.render.figures.phase_plot import plot_phases

    return plot_phases(asked.run, asked.window, asked.width, asked.beats)


def _portrait(asked: Request) -> Figure:
    from watchsim.render.figures.beat.phase_portrait import plot_phase_portrait

    return plot_phase_portrait(asked.run, asked.bodies, asked.window, asked.width)


def _torque(asked: Request) -> Figure:
    from watchsim.render.figures.beat.torque_plot import plot_torque

    return plot_torque(asked.run, asked.window, asked.width, asked.beats)


def _forces(asked: Request) -> Figure:
    from watchsim.render.figures.beat.force_plot import plot_forces

    return plot_forces(asked.run, asked.window, asked.width)


def _timeline(asked: Request) -> Figure:
    from watchsim.render.figures.beat.key_instants import plot_timeline

    return plot_timeline(asked.run, asked.window, asked.width, asked.beats)


def _energy(asked: Request) -> Figure:
    from watchsim.render.figures.energy_plot import plot_energy

    return plot_energy(asked.run, asked.window, asked.width, asked.beats_if_any)


def _timing(asked: Request) -> Figure:
    from watchsim.render.figures.timing_plot import plot_timing

    return plot_timing(asked.run, asked.window, asked.width)


def _tape(asked: Request) -> Figure:
    from watchsim.render.figures.tape_plot import plot_tape

    return plot_tape(asked.run, asked.window, asked.width)


KINDS: dict[str, Callable[[Request], Figure]] = {
    "kinematics": _kinematics,
    "phases": _phases,
    "timeline": _timeline,
    "phase-portrait": _portrait,
    "torque": _torque,
    "forces": _forces,
    "energy": _energy,
    "timing": _timing,
    "tape": _tape,
}


def chosen(names: Sequence[str]) -> list[str]:
    """The kinds of those names, in order and each once; InputError with the choices."""
    wrong = [name for name in names if name not in (*KINDS, ALL)]
    if wrong or not names:
        raise InputError(f"--kind {','.join(names)}: choose from {', '.join(KINDS)}, or {ALL}.")
    return list(KINDS) if ALL in names else list(dict.fromkeys(names))
