"""What matters in this watch?

The derivatives of amplitude, rate and beat error by every number of the scene, by differences between limit cycles. Each is
taken with two steps; where they disagree the row says so.
"""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.construction import registry
from watchsim.construction.design import Dimension as DesignDimension
from watchsim.displays import notebook_html
from watchsim.scene.assign import dimension_of
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.keys import DESIGN, words_of
from watchsim.scene.roles import nominal_frequency, timekeeper
from watchsim.scene.scene import Body, Scene
from watchsim.studies.axes import Value
from watchsim.studies.cycle import Cycle
from watchsim.studies.journal import Journal, study_of
from watchsim.studies.point import USUAL, Output, Question, Row, outputs_named
from watchsim.studies.steady import steady
from watchsim.studies.sweep import Progress, computed
from watchsim.studies.workers import Executor, chosen
from watchsim.units import ANGLE, LENGTH, NUMBER, Dimension, UnitError, known_unit, metric, parse, split

SECTIONS = ("scene", "bodies", "springs", "torques", "damping", "contacts", DESIGN)
# What is no dimension of the mechanism: how a drawing is read, how a body starts, vertices, what must stay a whole number.
LEFT_OUT = {"schema", "snap", "material", "axis", "polygon", "line", "count", "turns", "velocity", "spin", "table", "pivot"}
OF_DESIGN = {"embraced", "start"}  # a whole number and a half; where the balance is let go
RELATIVE = 1e-3  # of a value: the larger of the two steps
SHORT, SLIGHT, SMALL = 5e-7, 2e-4, 1e-4  # steps of lengths (m), angles (rad) and of numbers that are zero
PERCENT, USUAL_LENGTH, USUAL_ANGLE = 0.01, 1e-5, 0.1  # what is compared: 1 %, 10 µm, 0.1°
BOUNDED: dict[str, tuple[float | None, float | None]] = dict.fromkeys(("friction", "static", "sliding", "coulomb"), (0.0, None))
BOUNDED |= dict.fromkeys(("restitution", "tangential_restitution"), (0.0, 1.0))


@dataclass(frozen=True)
class Quantity:
    """One number of a scene: its dotted path, its SI value, and what it is.

    `unit` is that of the scene; `step` is the larger of the two by which it is varied; `low` and `high` bound it; `change` is
    what a maker may get wrong: 1 % more, 10 µm or 0.1°, in SI, worded by `change_words`.
    """

    key: str
    value: float
    dimension: Dimension
    unit: str
    step: float
    change: float
    change_words: str
    low: float | None = None
    high: float | None = None


def fixed_nominal(scene: Scene, leave: Collection[str] = ()) -> Scene:
    """The same scene with springs by their stiffness, damping by its coefficient, and the rate against a frequency that stays.

    With a frequency instead, a heavier balance would be given a stiffer spring, and nothing would go wrong. What is varied
    itself, "frequency" or "q_factor", is to `leave` as it is.
    """
    nominal = nominal_frequency(scene)
    if nominal is not None:
        scene = scene.set("timegrapher.frequency", nominal)
    for i, (spring, entry) in enumerate(zip(scene.springs, scene.source.get("springs", []), strict=True)):
        if "frequency" in entry and "frequency" not in leave:
            scene = scene.set(f"springs.{i}.stiffness", spring.stiffness)
    for i, (damping, entry) in enumerate(zip(scene.damping, scene.source.get("damping", []), strict=True)):
        if "q_factor" in entry and "q_factor" not in leave:
            scene = scene.set(f"damping.{i}.viscous", damping.viscous)
    return scene


def _given_by(scene: Scene, key: str, value: float) -> dict[str, Value]:
    """All that `fixed_nominal` fixes, as a design has it whose dimension `key` is there to give some of it; else nothing."""
    if not key.startswith(f"{DESIGN}."):
        return {}
    try:
        moved = scene.set(key, value)
    except SceneError:  # the row of the point says why
        return {}
    before, after = _by_ratio(scene), _by_ratio(moved)
    return after if before != after else {}


def _by_ratio(scene: Scene) -> dict[str, Value]:
    """Frequencies of springs and Qs of damping, as they are written."""
    return {
        f"{section}.{i}.{name}": entry[name]
        for section, name in (("springs", "frequency"), ("damping", "q_factor"))
        for i, entry in enumerate(scene.source.get(section, []))
        if name in entry
    }


def quantities(scene: Scene) -> tuple[Quantity, ...]:
    """All that can be varied, in the order of the file."""
    found = []
    for section in SECTIONS:
        for key, value in _leaves(scene.source.get(section, {}), section):
            quantity = quantity_at(scene, key, value)
            if quantity is not None:
                found.append(quantity)
    return tuple(found)


def quantity_at(scene: Scene, key: str, value: Any) -> Quantity | None:
    """The quantity at a path that holds that value; None where it is none, or no dimension of the mechanism."""
    path, dimension = words_of(key), dimension_of(scene, key)
    if dimension is None or LEFT_OUT & set(path) or _is_start(scene, path) or (path[0] == "springs" and "draw" in path):
        return None
    if path[0] == DESIGN and (path[-1] in OF_DESIGN or _of_design(scene, path[-1]).count):
        return None
    try:
        number = parse(value, dimension)
    except UnitError:
        return None
    change, words = change_of(number, dimension)
    return Quantity(
        key, number, dimension, unit_of(value, dimension), _step(number, dimension), change, words, *_bounds(scene, path)
    )


def unit_of(held: object, dimension: Dimension) -> str:
    """The unit in which the scene has the value, else one in which people read it."""
    written = split(held)[1] if isinstance(held, str) else ""
    if held != "" and dimension.si.startswith("N") and written in ("", dimension.si):  # `Scene.set` writes numbers in SI
        return metric(parse(held, dimension), dimension.si).split()[1]
    return written or (dimension.usual[1] if dimension is not NUMBER else "")


def _bounds(scene: Scene, path: Sequence[str]) -> tuple[float | None, float | None]:
    if path[0] != DESIGN:
        return BOUNDED.get(path[-1], (None, None))
    one = _of_design(scene, path[-1])
    factor = known_unit(one.unit).factor
    return factor * one.low, factor * one.high


def _of_design(scene: Scene, name: str) -> DesignDimension:
    return registry.design(scene.source[DESIGN]["of"]).dimension(name)


def _leaves(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Dotted paths of everything that is no table and no list."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _leaves(item, f"{path}.{key}")
    elif isinstance(value, (list, tuple)):
        for i, item in enumerate(value):
            yield from _leaves(item, f"{path}.{i}")
    elif isinstance(value, (int, float, str)) and not isinstance(value, bool):
        yield path, value


def _is_start(scene: Scene, path: Sequence[str]) -> bool:
    """Where a moving body starts decides nothing about a cycle."""
    if path[0] != "bodies":
        return False
    body: Body = scene.body(path[1])
    return (path[2] == "angle" and body.motion != "fixed") or (path[2] == "position" and body.motion == "free")


def _step(value: float, dimension: Dimension) -> float:
    if dimension is LENGTH:
        return SHORT
    if dimension is ANGLE:
        return SLIGHT
    return RELATIVE * abs(value) if value else SMALL


def change_of(value: float, dimension: Dimension) -> tuple[float, str]:
    """What a maker may get wrong in such a value, SI and in words."""
    if dimension is LENGTH:
        return USUAL_LENGTH, "10 µm"
    if dimension is ANGLE:
        return parse(f"{USUAL_ANGLE}°", ANGLE), "0.1°"
    if value:
        return PERCENT * value, "1 %"
    return (PERCENT, "0.01") if dimension is NUMBER else (1.0, f"1 {dimension.si}")


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
        columns = ", ".join(one.column for one in self.outputs)
        return f"<Sensitivity of {self.title!r}: {len(self.effects)} quantities{first}; {columns}>"

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
        factor = known_unit(quantity.unit).factor
        row: Row = {
            "key": quantity.key,
            "value": quantity.value / factor,
            "unit": quantity.unit,
            "change": quantity.change_words,
        }
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

    Springs count by their stiffness and damping by its coefficient, also where the scene gives frequency and Q (but where a
    dimension of a design gives one of these, as design.q_factor, it is varied with the other kept), and the rate is against the
    nominal frequency of the scene as it is. The derivative of the beat error is that of
    `Cycle.uneven_ms`. ValueError where the scene has no limit cycle.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

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
    drawn, scene = scene, fixed_nominal(scene)
    asked = _asked(scene, keys)
    cycle = steady(scene, tolerance=tolerance)
    if not cycle.found or cycle.amplitude_deg is None:
        raise ValueError(f"this {timekeeper(scene)} has no limit cycle to be varied: {cycle.message or cycle.verdict}")
    # One oscillation is enough where the teeth are alike, but for the multiplier.
    brief = cycle.oscillations == 1 and all(one.name != "multiplier" for one in outputs)
    question = Question(scene, True, None, tolerance, float(np.radians(cycle.amplitude_deg)), brief)
    points = [point for quantity in asked for point in points_of(quantity)]
    changes = [{key: value, **_given_by(drawn, key, value)} for key, value in points]
    rows = _rows(question, changes, executor, folder, resume, progress)
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
    changes: Sequence[Mapping[str, Value]],
    executor: Executor,
    folder: str | Path | None,
    resume: bool,
    progress: Progress | None,
) -> dict[int, Row]:
    points = list(enumerate(changes))
    if folder is None:
        rows: dict[int, Row] = {}
        computed(question, points, executor, rows.__setitem__, progress)
        return rows
    keys = {"sensitivity": sorted({key for change in changes for key in change})}
    study = study_of(question.scene, keys, question.by_shooting, question.duration, question.tolerance)
    with Journal(Path(folder), study, resume) as journal:
        left = [(number, change) for number, change in points if number not in journal.rows]
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
