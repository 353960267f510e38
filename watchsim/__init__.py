"""watchsim: from a designer's drawing to the true motion of a watch mechanism.

The names below are loaded when first used, so that importing the package costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "load": "watchsim.mechanism.load",
    "Scene": "watchsim.mechanism.scene",
    "SceneError": "watchsim.mechanism.errors",
    "read": "watchsim.drawing.read",
    "Drawing": "watchsim.drawing.drawing",
    "distance": "watchsim.contact.outlines",
    "gap": "watchsim.contact.outlines",
    "kinematics": "watchsim.contact.outlines",
    "Profile": "watchsim.drawing.profile",
    "simulate": "watchsim.simulation.simulate",
    "Trajectory": "watchsim.simulation.trajectory",
    "EventKind": "watchsim.simulation.trajectory",
    "Stop": "watchsim.simulation.stops",
    "beats": "watchsim.analysis.beats",
    "forces": "watchsim.analysis.forces",
    "summary": "watchsim.analysis.summary",
    "read_results": "watchsim.analysis.results",
    "write_results": "watchsim.analysis.results",
    "verify": "watchsim.analysis.verify",
    "plot_kinematics": "watchsim.render.plots",
    "movie": "watchsim.render.movie",
    "frame": "watchsim.render.movie",
    "profiles_dir": "watchsim.profiles_path",
}

_PACKAGES = ("designs",)  # whose names are used through them

__all__ = [*_HOMES, *_PACKAGES, "__version__"]  # noqa: PLE0604 - the keys are the public names

if TYPE_CHECKING:
    from watchsim import designs as designs
    from watchsim.analysis.beats import beats as beats
    from watchsim.analysis.forces import forces as forces
    from watchsim.analysis.results import read_results as read_results
    from watchsim.analysis.results import write_results as write_results
    from watchsim.analysis.summary import summary as summary
    from watchsim.analysis.verify import verify as verify
    from watchsim.contact.outlines import distance as distance
    from watchsim.contact.outlines import gap as gap
    from watchsim.contact.outlines import kinematics as kinematics
    from watchsim.drawing.drawing import Drawing as Drawing
    from watchsim.drawing.profile import Profile as Profile
    from watchsim.drawing.read import read as read
    from watchsim.mechanism.errors import SceneError as SceneError
    from watchsim.mechanism.load import load as load
    from watchsim.mechanism.scene import Scene as Scene
    from watchsim.profiles_path import profiles_dir as profiles_dir
    from watchsim.render.movie import frame as frame
    from watchsim.render.movie import movie as movie
    from watchsim.render.plots import plot_kinematics as plot_kinematics
    from watchsim.simulation.simulate import simulate as simulate
    from watchsim.simulation.stops import Stop as Stop
    from watchsim.simulation.trajectory import EventKind as EventKind
    from watchsim.simulation.trajectory import Trajectory as Trajectory


def __getattr__(name: str) -> Any:
    if name in _PACKAGES:
        return importlib.import_module(f"watchsim.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'watchsim' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
