"""watchsim: from a designer's drawing to the true motion of a watch mechanism.

The names below are loaded when first used, so that importing the package costs nothing.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as in typing: the package is loaded before a command can hear Ctrl-C, so it loads nothing
if TYPE_CHECKING:
    from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "load": "watchsim.scene.file.load",
    "Scene": "watchsim.scene.scene",
    "SceneError": "watchsim.scene.errors",
    "read": "watchsim.drawing.read",
    "Drawing": "watchsim.drawing.drawing",
    "distance": "watchsim.contact.distance",
    "gap": "watchsim.contact.distance",
    "kinematics": "watchsim.contact.distance",
    "Profile": "watchsim.drawing.profile",
    "simulate": "watchsim.simulation.simulate",
    "Trajectory": "watchsim.simulation.record.trajectory",
    "EventKind": "watchsim.simulation.record.trajectory",
    "Stop": "watchsim.simulation.stops",
    "beats": "watchsim.analysis.timing.beats",
    "forces": "watchsim.analysis.contact_forces",
    "summary": "watchsim.analysis.summary",
    "read_results": "watchsim.results.read_results",
    "write_results": "watchsim.results.write_results",
    "verdict": "watchsim.analysis.verdicts.verdict",
    "verify": "watchsim.verification.all_checks",
    "steady": "watchsim.studies.limit_cycle.find_cycle",
    "Cycle": "watchsim.studies.limit_cycle.cycle",
    "sweep": "watchsim.studies.parameter_sweep",
    "sensitivity": "watchsim.studies.sensitivity",
    "plot_sweep": "watchsim.render.figures.study_plot",
    "plot_kinematics": "watchsim.render.figures.kinematics_plot",
    "movie": "watchsim.render.movies.run_movie",
    "frame": "watchsim.render.movies.run_movie",
    "plot_tape": "watchsim.render.figures.tape_plot",
    "plot_timing": "watchsim.render.figures.timing_plot",
    "plot_energy": "watchsim.render.figures.energy_plot",
    "plot_phases": "watchsim.render.figures.phase_plot",
    "plot_timeline": "watchsim.render.figures.beat.key_instants",
    "plot_phase_portrait": "watchsim.render.figures.beat.phase_portrait",
    "plot_torque": "watchsim.render.figures.beat.torque_plot",
    "plot_forces": "watchsim.render.figures.beat.force_plot",
    "plot_sensitivity": "watchsim.render.figures.effects_plot",
    "sound": "watchsim.analysis.sound.wav",
    "report": "watchsim.pages.report_page",
    "show": "watchsim.pages.inline",
    "profiles_dir": "watchsim.profiles_path",
}

_PACKAGES = ("designs",)  # whose names are used through them

__all__ = [*_HOMES, *_PACKAGES, "__version__"]  # noqa: PLE0604 - the keys are the public names

if TYPE_CHECKING:
    from watchsim import designs as designs
    from watchsim.analysis.contact_forces import forces as forces
    from watchsim.analysis.sound.wav import sound as sound
    from watchsim.analysis.summary import summary as summary
    from watchsim.analysis.timing.beats import beats as beats
    from watchsim.analysis.verdicts.verdict import verdict as verdict
    from watchsim.contact.distance import distance as distance
    from watchsim.contact.distance import gap as gap
    from watchsim.contact.distance import kinematics as kinematics
    from watchsim.drawing.drawing import Drawing as Drawing
    from watchsim.drawing.profile import Profile as Profile
    from watchsim.drawing.read import read as read
    from watchsim.pages.inline import show as show
    from watchsim.pages.report_page import report as report
    from watchsim.profiles_path import profiles_dir as profiles_dir
    from watchsim.render.figures.beat.force_plot import plot_forces as plot_forces
    from watchsim.render.figures.beat.key_instants import plot_timeline as plot_timeline
    from watchsim.render.figures.beat.phase_portrait import plot_phase_portrait as plot_phase_portrait
    from watchsim.render.figures.beat.torque_plot import plot_torque as plot_torque
    from watchsim.render.figures.effects_plot import plot_sensitivity as plot_sensitivity
    from watchsim.render.figures.energy_plot import plot_energy as plot_energy
    from watchsim.render.figures.kinematics_plot import plot_kinematics as plot_kinematics
    from watchsim.render.figures.phase_plot import plot_phases as plot_phases
    from watchsim.render.figures.study_plot import plot_sweep as plot_sweep
    from watchsim.render.figures.tape_plot import plot_tape as plot_tape
    from watchsim.render.figures.timing_plot import plot_timing as plot_timing
    from watchsim.render.movies.run_movie import frame as frame
    from watchsim.render.movies.run_movie import movie as movie
    from watchsim.results.read_results import read_results as read_results
    from watchsim.results.write_results import write_results as write_results
    from watchsim.scene.errors import SceneError as SceneError
    from watchsim.scene.file.load import load as load
    from watchsim.scene.scene import Scene as Scene
    from watchsim.simulation.record.trajectory import EventKind as EventKind
    from watchsim.simulation.record.trajectory import Trajectory as Trajectory
    from watchsim.simulation.simulate import simulate as simulate
    from watchsim.simulation.stops import Stop as Stop
    from watchsim.studies.limit_cycle.cycle import Cycle as Cycle
    from watchsim.studies.limit_cycle.find_cycle import steady as steady
    from watchsim.studies.parameter_sweep import sweep as sweep
    from watchsim.studies.sensitivity import sensitivity as sensitivity
    from watchsim.verification.all_checks import verify as verify


def __getattr__(name: str) -> Any:
    import importlib

    if name in _PACKAGES:
        return importlib.import_module(f"watchsim.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'watchsim' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
