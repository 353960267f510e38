"""Does every expectation of a scene name a number that its runs give, in a unit of its kind?

Worth asking before a long run: the names are those of the summary of a run that has not begun.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from watchsim.analysis.expectations import WATCH_KEYS, mistakes
from watchsim.scene.errors import Fault, Faults
from watchsim.scene.roles import keeps_time, partners, roles
from watchsim.scene.scene import Expectation, Scene
from watchsim.scene.toml import key_lines

if TYPE_CHECKING:
    from watchsim.simulation.trajectory import Trajectory

COUNTS = ("cells", "cells_asked", "declared_pairs", "sweeps")
LOOKED = ("worst_m", "resolution_m", "allowed_m", "looks", "t_s", "x_mm", "y_mm")
TIMED = (
    "amplitude_deg",
    "amplitude_deg_error",
    "period_s",
    "rate_s_per_d",
    "beat_error_ms",
    "frequency_hz",
    "vph",
    "timegrapher",
)
BY_WHEEL = ("missed_beats", "efficiency")
USUAL = {  # what is promised most often, and in every summary
    **dict.fromkeys(("amplitude_deg", "rate_s_per_d", "period_s", "beat_error_ms", "frequency_hz"), 0.0),
    **{"missed_beats": 0.0, "worst_penetration_m": 0.0, "energy": {"residual_relative": 0.0}},
}
CAUSES = ("friction", "damping", "impacts", "stepping")


def expectation_faults(scene: Scene) -> list[Fault]:
    """A fault for each expectation that no run of the scene can answer."""
    if not scene.expect:
        return []
    wrong = mistakes(scene.expect, USUAL)
    if any(wrong):
        from watchsim.analysis.summary import summary  # late: half a second to load

        # All names that a summary of this scene has.
        wrong = mistakes(
            scene.expect, summary(dataclasses.replace(not_begun(scene), scene=dataclasses.replace(scene, expect=())))
        )
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if scene.path and scene.path.is_file() else {}
    faults = Faults(str(scene.path or "scene"), lines)
    for expectation, mistake in zip(scene.expect, wrong, strict=True):
        if message := mistake or impossible(expectation, scene):
            faults.add(f"expect.{expectation.key}", message)
    return faults.found


def impossible(expectation: Expectation, scene: Scene) -> str:
    """Why no run of this scene gives the number, whatever happens in it; "" where one can."""
    name = WATCH_KEYS.get(expectation.key, expectation.key)
    whole = name.split(".")[0]
    if whole not in (*TIMED, *BY_WHEEL):
        return ""
    parts = roles(scene)
    if parts.oscillator is None:
        why = "nothing in it swings on a spring or by gravity"
    elif "amplitude_deg" in name and scene.body(parts.oscillator).motion == "slide":
        why = f"{parts.oscillator} slides, so it has no amplitude in degrees"
    elif whole in BY_WHEEL and (parts.wheel is None or not keeps_time(scene)):
        why = "no driven wheel keeps the oscillator going"
    elif name == "timegrapher.amplitude_deg" and scene.lift_angle is None:
        why = "it names no lift_angle under [timegrapher]"
    elif whole == "timegrapher" and not partners(scene, parts.oscillator):
        why = f"nothing may touch {parts.oscillator}, so no beat is heard"
    else:
        return ""
    return f'no run of this scene gives "{expectation.key}": {why}. Leave it out'


def not_begun(scene: Scene) -> Trajectory:
    """A run of the scene with nothing in it but where its bodies stand."""
    import numpy as np

    from watchsim.mechanism.compile import compile_scene
    from watchsim.simulation.state import COUNT_NAMES, EVENT_DTYPE, Stop
    from watchsim.simulation.trajectory import Trajectory

    compiled = compile_scene(scene)
    q = compiled.relative(compiled.q[None])
    rest = np.zeros_like(q)
    no_events = np.zeros(0, EVENT_DTYPE)
    return Trajectory(
        *(scene, np.zeros(1), q, rest, rest, compiled.slices, no_events, (), Stop.DURATION),
        energy={"dissipated": dict.fromkeys(CAUSES, 0.0)},
        counts=dict.fromkeys((*COUNT_NAMES, *COUNTS), 0),
        overlap={**dict.fromkeys(LOOKED, 0.0), "between": None},
    )
