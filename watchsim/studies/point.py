"""What does the watch do at one point of a study?

A question is a scene and how it is answered; an answer is a row of plain numbers. A point that cannot be computed has its
reason in the row and stops nobody.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from watchsim.analysis.timing import mean_over
from watchsim.analysis.verdict_kinds import TICKS
from watchsim.scene.errors import SceneError
from watchsim.scene.load import changed
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.studies.all_cycles import judged
from watchsim.studies.axes import Value
from watchsim.studies.steady import steady


@dataclass(frozen=True)
class Output:
    """`name` is what is asked for, `column` the name with its unit, `label` and `unit` for people."""

    name: str
    column: str
    label: str
    unit: str
    has_error: bool = True


OUTPUTS = {
    one.name: one
    for one in (
        Output("amplitude", "amplitude_deg", "amplitude", "°"),
        Output("rate", "rate_s_per_d", "rate", "s/d"),
        Output("beat_error", "beat_error_ms", "beat error", "ms"),
        Output("period", "period_s", "period", "s"),
        Output("multiplier", "multiplier", "multiplier", "", has_error=False),
    )
}
USUAL = ("amplitude", "rate", "beat_error")


def outputs_named(names: Iterable[str]) -> tuple[Output, ...]:
    """The outputs of those names, each once; ValueError for one that there is not."""
    found = []
    for name in dict.fromkeys(names):
        if name not in OUTPUTS:
            near = difflib.get_close_matches(name, OUTPUTS, n=1)
            advice = f'Did you mean "{near[0]}"?' if near else f"There are {', '.join(OUTPUTS)}."
            raise ValueError(f'outputs: "{name}" is not an output. {advice}')
        found.append(OUTPUTS[name])
    if not found:
        raise ValueError(f"outputs: name at least one of {', '.join(OUTPUTS)}")
    return tuple(found)


Row = dict[str, Any]


@dataclass(frozen=True)
class Question:
    """`by_shooting`: the limit cycle, else a run of `duration` s (None: the scene's). `amplitude` (rad, m): where to begin."""

    scene: Scene
    by_shooting: bool = True
    duration: float | None = None
    tolerance: float | None = None
    amplitude: float | None = None
    brief: bool = False  # one oscillation on the cycle, without errors


def answer(question: Question, changes: Mapping[str, Value], interrupted: Callable[[], bool] = lambda: False) -> Row:
    """The row of one point: every output with its error (None where there is none), `verdict` and `message`.

    KeyboardInterrupt where it was cut short by `interrupted`.
    """
    row: Row = {name: None for one in OUTPUTS.values() for name in ((one.column, f"{one.column}_error"))}
    row.update(verdict=None, message="")
    try:
        scene = changed(question.scene, changes) if changes else question.scene
        row.update(_by_shooting(question, scene) if question.by_shooting else _by_run(question, scene, interrupted))
    except SceneError as error:
        row["message"] = " ".join(str(error).split())
    return row


def _by_shooting(question: Question, scene: Scene) -> Row:
    cycle = steady(scene, tolerance=question.tolerance, amplitude=question.amplitude, brief=question.brief)
    numbers = cycle.numbers()
    row: Row = {"verdict": cycle.verdict, "message": cycle.message}
    for one in OUTPUTS.values():
        if one.column in numbers and cycle.found:
            row[one.column], row[f"{one.column}_error"] = numbers[one.column], numbers[f"{one.column}_error"]
    row["uneven_ms"] = cycle.uneven_ms if cycle.found else None
    row["multiplier"] = max(cycle.multipliers, key=abs, default=None)
    row["multiplier_error"] = max(cycle.multipliers_error, default=None)
    return row


def _by_run(question: Question, scene: Scene, interrupted: Callable[[], bool]) -> Row:
    def look(_done: float, _whole: float) -> None:
        if interrupted():
            raise KeyboardInterrupt

    run = simulate(scene, question.duration, question.tolerance, record="statistics", progress=look)
    if run.stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt
    if run.stop.gave_up:
        return {"verdict": None, "message": run.stop_message}
    if roles(scene).oscillator is None:
        return {"message": "nothing in this scene swings on a spring or by gravity"}
    means = mean_over(run)
    row: Row = {
        name: getattr(means, name)
        for one in OUTPUTS.values()
        for name in (one.column, f"{one.column}_error")
        if hasattr(means, name)
    }
    seen = judged(run, since_start=True)
    row.update(verdict=seen.name, message="" if seen.name in (TICKS, None) else seen.message)
    return row
