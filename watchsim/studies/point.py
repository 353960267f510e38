"""What does the watch do at one point of a study?

A question is a scene and how it is answered; an answer is a row of plain numbers. A point that cannot be computed has its
reason in the row and stops nobody.
"""

from __future__ import annotations

import difflib
import math
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from watchsim.analysis.timing import mean_over
from watchsim.analysis.verdict_kinds import TICKS
from watchsim.escapement.measure import measure
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.errors import SceneError
from watchsim.scene.load import changed
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.roles import roles
from watchsim.scene.scene import Scene
from watchsim.simulation.options import options_of
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.studies.all_cycles import judged
from watchsim.studies.axes import Value, as_typed
from watchsim.studies.section import freed_start
from watchsim.studies.steady import steady


@dataclass(frozen=True)
class Output:
    """`name` is what is asked for, `column` the name with its unit, `label` and `unit` for people."""

    name: str
    column: str
    label: str
    unit: str
    has_error: bool = True


# A design's dimension of the name draw is that on the bank; towards the corner it falls.
LABELS = {"draw": "least draw from bank to corner"}
OUTPUTS = {
    one.name: one
    for one in (
        Output("amplitude", "amplitude_deg", "amplitude", "°"),
        Output("rate", "rate_s_per_d", "rate", "s/d"),
        Output("beat_error", "beat_error_ms", "beat error", "ms"),
        Output("period", "period_s", "period", "s"),
        Output("multiplier", "multiplier", "multiplier", "", has_error=False),
        *(Output(name, f"{name}_deg", LABELS.get(name, name.replace("_", " ")), "°", has_error=False) for name in FUNCTION),
    )
}
USUAL = ("amplitude", "rate", "beat_error")
PARTS = {**{name: (name,) for name in FUNCTION[:3]}, "draw": ("draw", "draw_end"), "drop": ("drop",)}  # of the stones


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
    """`by_shooting`: the limit cycle, else a run of `duration` s (None: the scene's). `amplitude` (rad, m): where to begin.

    function  the geometry of function is measured, too: of every tooth (0), or of the first so many, where they are alike
    slope     of the return map at that amplitude, where the cycle of a scene like this one is known
    units     key -> the unit that its values were typed in, for what is said of them
    """

    scene: Scene
    by_shooting: bool = True
    duration: float | None = None
    tolerance: float | None = None
    amplitude: float | None = None
    brief: bool = False  # one oscillation on the cycle, without errors
    function: int | None = None
    slope: float | None = None
    units: Mapping[str, str] = field(default_factory=dict)


def answer(question: Question, changes: Mapping[str, Value], interrupted: Callable[[], bool] = lambda: False) -> Row:
    """The row of one point: every output with its error (None where there is none), `verdict` and `message`; `seconds` says
    where the time went.

    KeyboardInterrupt where it was cut short by `interrupted`.
    """
    row: Row = {name: None for one in OUTPUTS.values() for name in ((one.column, f"{one.column}_error"))}
    row.update(verdict=None, message="")
    begun = time.perf_counter()
    try:
        scene = changed(question.scene, changes) if changes else question.scene
        row["seconds"] = {"geometry": time.perf_counter() - begun}
        row.update(function_of(scene, question.function) if question.function is not None else {})
        row["seconds"]["function"] = time.perf_counter() - begun - row["seconds"]["geometry"]
        unmeasured = row["message"]
        row.update(_by_shooting(question, scene) if question.by_shooting else _by_run(question, scene, interrupted))
        if row["verdict"] is not None:
            row["message"] = row["message"] or unmeasured
    except SceneError as error:
        row["message"] = _in_typed_units(question, changes, error).sentence(changes)
    seconds = row.setdefault("seconds", {})
    seconds["cells"] = row.pop("cells_s", 0.0)
    seconds["motion"] = time.perf_counter() - begun - sum(seconds.values())
    return row


def _in_typed_units(question: Question, changes: Mapping[str, Value], error: SceneError) -> SceneError:
    """What is wrong with the point, with its values as they were typed."""
    try:
        changed(question.scene, {key: as_typed(value, question.units.get(key, "")) for key, value in changes.items()})
    except SceneError as again:
        return again
    return error


def function_of(scene: Scene, few: int | None = None) -> Row:
    """The geometry of function of its worst stone and tooth, degrees; None for what the mechanism has not.

    lock, total_lock, run, draw (the less of both ends), drop: the least; freedom of the lever on its bank: the largest.
    """
    found = measure(scene, None, few or None, fork_too=False)
    if found.pallets is None and found.parts is not None:  # a body that was moved a little may overlap where it starts
        compiled = compile_scene(scene)
        freed = freed_start(compiled, options_of(scene, compiled, scene.tolerance))
        found = found if freed is None else measure(scene, replace(compiled, q=freed), few or None, fork_too=False)
    row: Row = {}
    for name, fields in PARTS.items():
        each = [getattr(one, field) for one in found.pallets or () for field in fields]
        row[f"{name}_deg"] = _worst(min, [value for one in each for value in (one.value, one.worst)])
    row["freedom_deg"] = _worst(max, [one.worst.value for one in found.safety or ()])
    row["message"] = (
        "" if found.pallets is not None else "; ".join(f"{what} not measured, {why}" for what, why in found.missing)
    )
    return row


def _worst(of: Callable[..., float], values: Iterable[float]) -> float | None:
    finite = [math.degrees(value) for value in values if math.isfinite(value)]
    return of(finite) if finite else None


def _by_shooting(question: Question, scene: Scene) -> Row:
    cycle = steady(
        scene, tolerance=question.tolerance, amplitude=question.amplitude, brief=question.brief, slope=question.slope
    )
    numbers = cycle.numbers()
    row: Row = {"verdict": cycle.verdict, "message": cycle.message}
    for one in OUTPUTS.values():
        if one.column in numbers and cycle.found:
            row[one.column], row[f"{one.column}_error"] = numbers[one.column], numbers[f"{one.column}_error"]
    row["cells_s"] = cycle.cells_s
    row["uneven_ms"] = cycle.uneven_ms if cycle.found else None
    row["multiplier"], row["multiplier_error"] = cycle.left_after_one()
    return row


def _by_run(question: Question, scene: Scene, interrupted: Callable[[], bool]) -> Row:
    def look(_done: float, _whole: float) -> None:
        if interrupted():
            raise KeyboardInterrupt

    run = simulate(scene, question.duration, question.tolerance, record="statistics", progress=look, to_the_end=False)
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
