"""What matters in this watch?

The derivatives of amplitude, rate and beat error by every number of the scene, by differences between limit cycles. Each is
taken with two steps; where they disagree the row says so.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.displays import notebook_html
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.scene import Scene
from watchsim.studies.limit_cycle.cycle import Cycle
from watchsim.studies.limit_cycle.find_cycle import steady
from watchsim.studies.outputs import USUAL, Output, outputs_named
from watchsim.studies.parameter_sweep import Progress, computed, study_of
from watchsim.studies.point import Question, Row
from watchsim.studies.quantities import Quantity, fixed_nominal, quantities
from watchsim.studies.workers.choose_executor import chosen
from watchsim.studies.workers.executor import Executor
from watchsim.studies.workers.journal import Journal
from watchsim.units import known_unit

AGREED = 0.01  # share of a derivative by which its two steps may differ
NOISE = {"amplitude_deg": 1e-9, "rate_s_per_d": 1e-6, "uneven_ms": 1e-9, "period_s": 1e-13, "multiplier": 1e-7}
SMOOTH = {"beat_error_ms": "uneven_ms"}  # the beat error is a magnitude: what is differentiated keeps its sign
CENTRAL, FORWARD, BACKWARD = (-1.0, 1.0), (1.0, 2.0), (-1.0, -2.0)  # in steps: where a difference looks


@dataclass(frozen=True)
class Derivative:
    """Of one output by one quantity, in the output's unit per SI unit of the quantity; None where it could not be had.

    `check` is the same with a larger step; `agrees` where they differ by no more than 1 %, or by rounding.
    """

    value: float | None
    check: float | None
    agrees: bool
    rounding: float


@dataclass(frozen=True)
class Effect:
    """What one quantity does: a derivative for each output column, and why there is none where there is none."""

    quantity: Quantity
    by: Mapping[str, Derivative]
    message: str = ""

    def of(self, column: str, change: float) -> float | None:
        """The effect of so large a change (SI) on an output, to first order."""
        value = self.by[column].value
        return None if value is None else value * change


@dataclass(frozen=True)
class Sensitivity:
    """All effects, the greatest on the first output first; `whole` is False after an interrupt."""

    title: str
    cycle: Cycle
    outputs: tuple[Output, ...]
    effects: tuple[Effect, ...]
    whole: bool
    wall_s: float

    def __repr__(self) -> str:
        first = f", {self.effects[0].quantity.key} first" if self.effects else ""
        told = ", ".join(one.column for one in self.outputs)
        return f"<Sensitivity of {self.title!r}: {len(self.effects)} quantities{first}; {told}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def rows(self) -> list[Row]:
        """One flat row per quantity: key and value in the unit people read, effects per usual change, per 1 % and per unit."""
        return [self._row(effect) for effect in self.effects]

    def numbers(self) -> dict[str, Any]:
        """What `sweep --sensitivity --json` prints."""
        return {
            "cycle": self.cycle.numbers(),
            "outputs": [one.column for one in self.outputs],
            "rows": self.rows(),
            "wall_s": self.wall_s,
        }

    def _row(self, effect: Effect) -> Row:
        quantity = effect.quantity
        unit = quantity.dimension.usual[1] if quantity.dimension.si else ""
        factor = known_unit(unit).factor
        row: Row = {"key": quantity.key, "value": quantity.value / factor, "unit": unit, "change": quantity.change_words}
        for one in self.outputs:
            row[f"{one.column}_per_change"] = effect.of(one.column, quantity.change)
        for one in self.outputs:
            row[f"{one.column}_per_percent"] = effect.of(one.column, 0.01 * quantity.value) if quantity.value else None
            row[f"{one.column}_per_unit"] = effect.of(one.column, factor)
            row[f"{one.column}_agrees"] = effect.by[one.column].agrees
        row["message"] = effect.message
        return row


def sensitivity(
    scene: Scene | str | Path,
    keys: Iterable[str] | None = None,
    outputs: Iterable[str] = USUAL,
    *,
    tolerance: float | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Sensitivity:
    """Derivatives on the limit cycle by all numbers of the scene, or by those at `keys`; other arguments as of `sweep`.

    Springs count by their stiffness and damping by its coefficient, also where the scene gives frequency and Q, and the rate is
    against the nominal frequency of the scene as it is. The derivative of the beat error is that of
    `Cycle.uneven_ms`. ValueError where the scene has no limit cycle.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.file.load import load

        scene = load(scene)
    return found(scene, keys, outputs_named(outputs), chosen(workers, scheduler), tolerance, folder, resume, progress)


def found(
    scene: Scene,
    keys: Iterable[str] | None,
    outputs: tuple[Output, ...],
    executor: Executor,
    tolerance: float | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Sensitivity:
    """The same for what has been checked."""
    begun = time.perf_counter()
    scene = fixed_nominal(scene)
    asked = _asked(scene, keys)
    cycle = steady(scene, tolerance=tolerance)
    if not cycle.found or cycle.amplitude_deg is None:
        raise ValueError(f"this watch has no limit cycle whose sensitivity could be computed: {cycle.message or cycle.verdict}")
    # One oscillation is enough where the teeth are alike, but for the multiplier.
    brief = cycle.oscillations == 1 and all(one.name != "multiplier" for one in outputs)
    question = Question(scene, True, None, tolerance, float(np.radians(cycle.amplitude_deg)), brief)
    points = [point for quantity in asked for point in points_of(quantity)]
    rows = _rows(question, points, executor, folder, resume, progress)
    level = _level(cycle, outputs)
    by_key: dict[str, dict[float, Row]] = {}
    for number, row in rows.items():
        key, value = points[number]
        by_key.setdefault(key, {})[value] = row
    whole = len(rows) == len(points)
    effects = [effect_of(one, by_key[one.key], level, outputs) for one in asked if len(by_key.get(one.key, {})) == 4]
    effects.sort(key=lambda effect: -_size(effect, outputs[0].column))
    return Sensitivity(scene.title, cycle, outputs, tuple(effects), whole, time.perf_counter() - begun)


def _asked(scene: Scene, keys: Iterable[str] | None) -> tuple[Quantity, ...]:
    """The quantities at those keys; SceneError for a key that holds none."""
    known = {one.key: one for one in quantities(scene)}
    if keys is None:
        return tuple(known.values())
    wanted = list(dict.fromkeys(keys))
    faults = [
        Fault(key, f"holds no number that can be varied here. There are {', '.join(known)}", place="sensitivity")
        for key in wanted
        if key not in known
    ]
    if faults:
        raise SceneError(faults)
    return tuple(known[key] for key in wanted)


def _stencil(quantity: Quantity) -> tuple[float, float]:
    """On both sides of the value, or on one where a bound is near."""
    if quantity.low is not None and quantity.value - quantity.step < quantity.low:
        return FORWARD
    if quantity.high is not None and quantity.value + quantity.step > quantity.high:
        return BACKWARD
    return CENTRAL


def points_of(quantity: Quantity) -> list[tuple[str, float]]:
    """Where the quantity is varied to: two values for each of the two steps."""
    stencil = _stencil(quantity)
    return [(quantity.key, quantity.value + at * step) for step in _steps(quantity) for at in stencil]


def _steps(quantity: Quantity) -> tuple[float, float]:
    return (quantity.step, 0.4 * quantity.step)  # not the half: one-sided, both would look at the same place


def _rows(
    question: Question,
    points: Sequence[tuple[str, float]],
    executor: Executor,
    folder: str | Path | None,
    resume: bool,
    progress: Progress | None,
) -> dict[int, Row]:
    changes = [(number, {key: value}) for number, (key, value) in enumerate(points)]
    if folder is None:
        rows: dict[int, Row] = {}
        computed(question, changes, executor, rows.__setitem__, progress)
        return rows
    keys = {"sensitivity": sorted({key for key, _ in points})}
    with Journal(Path(folder), study_of(question, keys), resume) as journal:  # type: ignore[arg-type]
        left = [(number, change) for number, change in changes if number not in journal.rows]
        computed(question, left, executor, journal.add, progress)
        return journal.rows


def _level(cycle: Cycle, outputs: tuple[Output, ...]) -> dict[str, float | None]:
    numbers = {**cycle.numbers(), "multiplier": max(cycle.multipliers, key=abs, default=None)}
    return {one.column: numbers[SMOOTH.get(one.column, one.column)] for one in outputs}


def effect_of(
    quantity: Quantity, rows: Mapping[float, Row], level: Mapping[str, float | None], outputs: tuple[Output, ...]
) -> Effect:
    messages = [row["message"] or row["verdict"] for row in rows.values() if row[outputs[0].column] is None]
    by = {one.column: _derivative(quantity, rows, SMOOTH.get(one.column, one.column), level[one.column]) for one in outputs}
    message = str(messages[0]) if messages else ""
    if not message and not all(one.agrees for one in by.values()):
        off = ", ".join(one.label for one in outputs if not by[one.column].agrees)
        message = f"two step sizes disagree by more than 1 %: {off}"
    return Effect(quantity, by, message)


def _derivative(quantity: Quantity, rows: Mapping[float, Row], column: str, level: float | None) -> Derivative:
    stencil = _stencil(quantity)
    found: list[float] = []
    for step in _steps(quantity):
        # The row of a refused value holds no numbers.
        first, second = (rows[quantity.value + at * step].get(column) for at in stencil)
        if level is None or first is None or second is None:
            return Derivative(None, None, False, 0.0)
        if stencil == CENTRAL:
            found.append((second - first) / (2.0 * step))
        else:
            found.append(stencil[0] * (4.0 * first - second - 3.0 * level) / (2.0 * step))
    rounding = 4.0 * NOISE[column] / _steps(quantity)[1]
    agrees = abs(found[0] - found[1]) <= max(AGREED * abs(found[1]), rounding)
    return Derivative(found[1], found[0], agrees, rounding)


def _size(effect: Effect, column: str) -> float:
    return abs(effect.of(column, effect.quantity.change) or 0.0)
