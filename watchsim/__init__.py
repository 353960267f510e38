"""watchsim: from a designer's drawing to the true motion of a watch mechanism.

The names below are loaded when first used, so that importing the package costs nothing.
"""

TYPE_CHECKING = False  # as in typing: the package is loaded before a command can hear Ctrl-C, so it loads nothing
if TYPE_CHECKING:
    from typing import Any

__version__ = "0.2.0"

_HOMES = {
    "load": "watchsim.scene.load",
    "Scene": "watchsim.scene.scene",
    "SceneError": "watchsim.scene.errors",
    "read": "watchsim.drawing.read",
    "Drawing": "watchsim.drawing.drawing",
    "distance": "watchsim.mechanism.distance",
    "gap": "watchsim.mechanism.distance",
    "kinematics": "watchsim.mechanism.distance",
    "Profile": "watchsim.drawing.drawing",
    "simulate": "watchsim.simulation.simulate",
    "Trajectory": "watchsim.simulation.trajectory",
    "EventKind": "watchsim.simulation.trajectory",
    "Stop": "watchsim.simulation.state",
    "beats": "watchsim.analysis.timing",
    "forces": "watchsim.analysis.forces",
    "summary": "watchsim.analysis.summary",
    "wear": "watchsim.analysis.wear",
    "read_results": "watchsim.results.folder",
    "write_results": "watchsim.results.folder",
    "verdict": "watchsim.analysis.verdict",
    "verify": "watchsim.verification.verify",
    "steady": "watchsim.studies.steady",
    "Cycle": "watchsim.studies.cycle",
    "compare": "watchsim.studies.compare",
    "sweep": "watchsim.studies.sweep",
    "sensitivity": "watchsim.studies.sensitivity",
    "positions": "watchsim.studies.positions",
    "shock": "watchsim.studies.shock",
    "shock_map": "watchsim.studies.shock",
    "tolerance": "watchsim.studies.tolerance",
    "ToleranceStudy": "watchsim.studies.tolerance_result",
    "merge": "watchsim.studies.tolerance",
    "improve": "watchsim.studies.improve",
    "fit": "watchsim.studies.fit",
    "plot_comparison": "watchsim.render.compare_plot",
    "plot_sweep": "watchsim.render.study_plot",
    "plot_kinematics": "watchsim.render.kinematics_plot",
    "movie": "watchsim.render.movie",
    "frame": "watchsim.render.movie",
    "plot_tape": "watchsim.render.timing_plot",
    "plot_timing": "watchsim.render.timing_plot",
    "plot_energy": "watchsim.render.energy_plot",
    "plot_phases": "watchsim.render.phase_plots",
    "plot_timeline": "watchsim.render.phase_plots",
    "plot_phase_portrait": "watchsim.render.kinematics_plot",
    "plot_torque": "watchsim.render.energy_plot",
    "plot_forces": "watchsim.render.force_plot",
    "plot_sound": "watchsim.render.sound_plot",
    "plot_positions": "watchsim.render.positions_plot",
    "plot_shock_map": "watchsim.render.shock_plot",
    "plot_wear": "watchsim.render.wear_plot",
    "plot_fit": "watchsim.render.study_plot",
    "plot_front": "watchsim.render.study_plot",
    "plot_sensitivity": "watchsim.render.study_plot",
    "plot_tolerance": "watchsim.render.tolerance_plot",
    "sound": "watchsim.analysis.sound",
    "listen": "watchsim.analysis.listen",
    "report": "watchsim.pages.report_page",
    "card": "watchsim.render.card",
    "show": "watchsim.pages.notebook",
    "profiles_dir": "watchsim.paths",
}

_PACKAGES = ("designs",)  # whose names are used through them

__all__ = [*_HOMES, *_PACKAGES, "__version__"]  # noqa: PLE0604 - the keys are the public names

if TYPE_CHECKING:
    from watchsim import designs as designs
    from watchsim.analysis.forces import forces as forces
    from watchsim.analysis.listen import listen as listen
    from watchsim.analysis.sound import sound as sound
    from watchsim.analysis.summary import summary as summary
    from watchsim.analysis.timing import beats as beats
    from watchsim.analysis.verdict import verdict as verdict
    from watchsim.analysis.wear import wear as wear
    from watchsim.drawing.drawing import Drawing as Drawing
    from watchsim.drawing.drawing import Profile as Profile
    from watchsim.drawing.read import read as read
    from watchsim.mechanism.distance import distance as distance
    from watchsim.mechanism.distance import gap as gap
    from watchsim.mechanism.distance import kinematics as kinematics
    from watchsim.pages.notebook import show as show
    from watchsim.pages.report_page import report as report
    from watchsim.paths import profiles_dir as profiles_dir
    from watchsim.render.card import card as card
    from watchsim.render.compare_plot import plot_comparison as plot_comparison
    from watchsim.render.energy_plot import plot_energy as plot_energy
    from watchsim.render.energy_plot import plot_torque as plot_torque
    from watchsim.render.force_plot import plot_forces as plot_forces
    from watchsim.render.kinematics_plot import plot_kinematics as plot_kinematics
    from watchsim.render.kinematics_plot import plot_phase_portrait as plot_phase_portrait
    from watchsim.render.movie import frame as frame
    from watchsim.render.movie import movie as movie
    from watchsim.render.phase_plots import plot_phases as plot_phases
    from watchsim.render.phase_plots import plot_timeline as plot_timeline
    from watchsim.render.positions_plot import plot_positions as plot_positions
    from watchsim.render.shock_plot import plot_shock_map as plot_shock_map
    from watchsim.render.sound_plot import plot_sound as plot_sound
    from watchsim.render.study_plot import plot_fit as plot_fit
    from watchsim.render.study_plot import plot_front as plot_front
    from watchsim.render.study_plot import plot_sensitivity as plot_sensitivity
    from watchsim.render.study_plot import plot_sweep as plot_sweep
    from watchsim.render.timing_plot import plot_tape as plot_tape
    from watchsim.render.timing_plot import plot_timing as plot_timing
    from watchsim.render.tolerance_plot import plot_tolerance as plot_tolerance
    from watchsim.render.wear_plot import plot_wear as plot_wear
    from watchsim.results.folder import read_results as read_results
    from watchsim.results.folder import write_results as write_results
    from watchsim.scene.errors import SceneError as SceneError
    from watchsim.scene.load import load as load
    from watchsim.scene.scene import Scene as Scene
    from watchsim.simulation.simulate import simulate as simulate
    from watchsim.simulation.state import EventKind as EventKind
    from watchsim.simulation.state import Stop as Stop
    from watchsim.simulation.trajectory import Trajectory as Trajectory
    from watchsim.studies.compare import compare as compare
    from watchsim.studies.cycle import Cycle as Cycle
    from watchsim.studies.fit import fit as fit
    from watchsim.studies.improve import improve as improve
    from watchsim.studies.positions import positions as positions
    from watchsim.studies.sensitivity import sensitivity as sensitivity
    from watchsim.studies.shock import shock as shock
    from watchsim.studies.shock import shock_map as shock_map
    from watchsim.studies.steady import steady as steady
    from watchsim.studies.sweep import sweep as sweep
    from watchsim.studies.tolerance import merge as merge
    from watchsim.studies.tolerance import tolerance as tolerance
    from watchsim.studies.tolerance_result import ToleranceStudy as ToleranceStudy
    from watchsim.verification.verify import verify as verify


def __getattr__(name: str) -> "Any":
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
