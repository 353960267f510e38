"""What is a better watch: which numbers may be changed, which result should be as large, as small or as near as possible, and
which limits must be kept?
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from watchsim.displays import notebook_html
from watchsim.scene.assign import full_key
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.keys import DESIGN, nearest, words_of
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.read_tolerances import nominal_at
from watchsim.scene.scene import Scene
from watchsim.studies.axes import dimension_of
from watchsim.studies.point import OUTPUTS, Output
from watchsim.studies.sensitivity import quantity_at, unit_of
from watchsim.units import ANGLE, NUMBER, RATE, TIME, Dimension, UnitError, parse, show, to

MOST, LEAST, EQUAL, ABOVE, BELOW = "max", "min", "=", ">=", "<="
UNITS = {"°": ANGLE, "s/d": RATE, "ms": TIME, "s": TIME, "": NUMBER, "%": NUMBER}  # of outputs
YIELD = Output("yield", "yield_percent", "yield", "%", has_error=False)  # of watches made to the scene's tolerances
KNOWN = {**OUTPUTS, YIELD.name: YIELD}
FAR = 10.0  # times the value a number without limits may become, or a tenth of it
SIGNED = {"position", "centre_of_mass", "angle", "velocity", "rest"}  # may as well have the other sign
PLACE = "improve"
METHODS = ("auto", "slsqp", "nelder-mead", "differential-evolution")


@dataclass(frozen=True)
class Knob:
    """A number of the scene that may be changed: SI, with its value, and limits that may not be left."""

    key: str
    value: float
    low: float
    high: float
    dimension: Dimension
    unit: str  # in which people read it
    given: bool = True  # the limits were given, and are no mere bounds of what makes sense

    @property
    def output(self) -> Output:
        """The number itself as something to aim at."""
        return Output(self.key, self.key, self.key, self.unit, has_error=False)

    def shown(self, value: float, digits: int = 6) -> str:
        return show(value, self.unit, digits)


@dataclass(frozen=True)
class Aim:
    """`way`: an output as large (max) or as small (min) as possible, at (=), above (>=) or below (<=) `value`, in its unit."""

    output: Output
    way: str
    value: float = math.nan

    @property
    def is_goal(self) -> bool:
        return self.way in (MOST, LEAST)

    def __str__(self) -> str:
        return (
            f"{self.output.name} {self.way}"
            if self.is_goal
            else f"{self.output.name} {self.way} {shown(self.output, self.value)}"
        )


def shown(output: Output, value: float, digits: int = 6) -> str:
    """The value of an output with its unit and a true minus sign."""
    gap = "" if output.unit in ("", "°", "%") else " "
    return f"{value:.{digits}g}{gap}{output.unit}".replace("-", "−")


def knobs_from(
    scene: Scene, limits: Mapping[str, tuple[Any, Any] | None], faults: list[Fault], place: str = PLACE
) -> tuple[Knob, ...]:
    """The numbers at those keys; with limits, SI numbers or texts, or None. Faults are added to those found, under `place`."""
    found: list[Knob] = []
    for name, pair in limits.items():
        key = full_key(scene.source, name)
        if any(one.key == key for one in found):
            faults.append(Fault(name, "is given twice; name each key once", place=place))
            continue
        knob = _knob(scene, key, pair, faults, place)
        if knob is not None:
            found.append(knob)
    return tuple(found)


def _knob(scene: Scene, key: str, pair: tuple[Any, Any] | None, faults: list[Fault], place: str) -> Knob | None:
    before, dimension = len(faults), dimension_of(scene, key)
    held = value_at(scene, key)
    written, owner = held, words_of(key)[:2]
    implied = nominal_at(scene, key) if owner[0] == "bodies" and owner[-1] in scene.source.get("bodies", {}) else None
    if held is None and isinstance(implied, float):  # a place that the drawing has
        held = f"{implied!r} {dimension.si}" if dimension is not None else None
    quantity = None if held is None or dimension is None else quantity_at(scene, key, held)
    if dimension is None or (held is None and pair is None):
        faults.append(Fault(key, _advice(scene, key), place=place))
        return None
    low, high, value = math.nan, math.nan, math.nan
    try:
        if held is not None:
            value = parse(held, dimension)
        if pair is not None:
            low, high = (parse(one, dimension) if isinstance(one, str) else float(one) for one in pair)
    except (UnitError, TypeError) as error:
        faults.append(Fault(key, str(error), f" = {pair[0]}:{pair[1]}" if pair else "", place=place))
        return None
    unit = unit_of(written if written is not None else pair[0] if pair else 0.0, dimension)
    if pair is not None:
        low, high = sorted((low, high))  # a torque that drives clockwise is read as -0.4 to -1.6
    if pair is not None and not low < high:
        faults.append(Fault(key, "the limits must differ", f" = {pair[0]}:{pair[1]}", place=place))
    least, most = (None, None) if quantity is None else (quantity.low, quantity.high)
    if pair is None:
        wide = sorted((value / FAR, value * FAR)) if value else [-1.0, 1.0]
        if value and SIGNED.intersection(key.split(".")):
            wide = [-FAR * abs(value), FAR * abs(value)]
        low, high = wide[0] if least is None else max(least, wide[0]), wide[1] if most is None else min(most, wide[1])
    for limit, bad, word in ((least, low, "least"), (most, high, "most")):
        if pair is not None and limit is not None and (bad < limit if word == "least" else bad > limit) and low < high:
            faults.append(Fault(key, f"it can be {show(limit, unit)} at {word}", f" = {pair[0]}:{pair[1]}", place=place))
    if len(faults) > before:
        return None
    value = 0.5 * (low + high) if math.isnan(value) else value
    return Knob(key, value, low, high, dimension, unit, pair is not None)


def value_at(scene: Scene, key: str) -> Any:
    """What the scene has at a dotted path; None where it has nothing there."""
    held: Any = scene.source
    for step in words_of(key):
        if isinstance(held, dict):
            held = held.get(step)
        elif isinstance(held, (list, tuple)) and step.isdigit() and int(step) < len(held):
            held = held[int(step)]
        else:
            return None
    return held if isinstance(held, (str, int, float)) and not isinstance(held, bool) else None


def _advice(scene: Scene, key: str) -> str:
    if "." not in key and DESIGN not in scene.source:
        why = "this scene has no [design], whose dimensions have such names"
        return f"{why}: watchsim new swiss_lever makes one that has, or name a path such as torques.0.value"
    try:
        scene.set(key, "0")
    except SceneError as error:
        found = [fault.message for fault in error.faults if fault.key == key and "unknown" in fault.message]
        if found:
            return found[0]
    table = scene.source.get(DESIGN)
    known = [name for name in table if name != "of"] if isinstance(table, dict) else []
    return f"holds no number that can be varied. {nearest(key, known)}".rstrip()


def aims_from(texts: Iterable[str], knobs: Sequence[Knob], option: str, faults: list[Fault]) -> tuple[Aim, ...]:
    """Goals such as "amplitude max" and "rate = 0 s/d" (`option` --goal), limits such as "lock >= 1.2°" (--keep)."""
    found = []
    ways = f"{MOST}|{LEAST}" if option == "--goal" else f"{ABOVE}|{BELOW}|≥|≤"
    example = '"amplitude max" or "amplitude = 290°"' if option == "--goal" else '"total_lock >= 1.2°"'
    for text in texts:
        match = re.fullmatch(rf"\s*([\w.]+)\s*({ways}|=)\s*(.*?)\s*", text)
        if match is None or (match[2] in (MOST, LEAST)) != (not match[3]):
            faults.append(Fault(option, f"write {example}", f' "{text}"', place=PLACE))
            continue
        name, way = match[1], {"≥": ABOVE, "≤": BELOW}.get(match[2], match[2])
        output = KNOWN.get(name) or next((one.output for one in knobs if name in (one.key, one.key.rpartition(".")[2])), None)
        if output is None:
            known = [*KNOWN, *(one.key for one in knobs)]
            faults.append(
                Fault(option, f'"{name}" is neither an output nor varied. {nearest(name, known)}', f' "{text}"', place=PLACE)
            )
            continue
        try:
            value = _number(match[3], output, knobs) if match[3] else math.nan
        except UnitError as error:
            faults.append(Fault(option, str(error), f' "{text}"', place=PLACE))
            continue
        found.append(Aim(output, way, value))
    return tuple(found)


def _number(text: str, output: Output, knobs: Sequence[Knob]) -> float:
    """In the unit of the output."""
    knob = next((one for one in knobs if one.key == output.name), None)
    value = parse(text, knob.dimension if knob else UNITS[output.unit])
    return to(value, output.unit) if output.unit else value


def arguments(
    scene: Scene,
    knobs: Mapping[str, tuple[Any, Any] | None],
    goal: str | Iterable[str],
    keep: Iterable[str],
    method: str,
    starts: int,
    points: int,
) -> tuple[tuple[Knob, ...], tuple[Aim, ...], tuple[Aim, ...]]:
    """What is varied, the goals, and the limits to keep; SceneError with all that is wrong with these arguments."""
    faults: list[Fault] = []
    varied = knobs_from(scene, knobs, faults)
    goals = aims_from([goal] if isinstance(goal, str) else goal, varied, "--goal", faults)
    keeps = aims_from(keep, varied, "--keep", faults)
    for name, value, least in (("method", method, None), ("starts", starts, 1), ("points", points, 2)):
        if (least is None and value not in METHODS) or (least is not None and not least <= int(value) <= 1000):
            faults.append(
                Fault(name, f"choose {', '.join(METHODS)}" if least is None else f"from {least} to 1000", f" = {value}", PLACE)
            )
    if any(one.output == YIELD for one in (*goals, *keeps)) and not scene.tolerances:
        faults.append(Fault("yield", "this scene has no [tolerances], so every sample is the nominal one", place=PLACE))
    check(varied, goals, keeps, faults)
    return varied, goals, keeps


def check(knobs: Sequence[Knob], goals: Sequence[Aim], keeps: Sequence[Aim], faults: list[Fault]) -> None:
    """What does not fit together; SceneError with all faults."""
    if not knobs and not faults:
        faults.append(Fault("KEY=FROM:TO", 'name what may be changed, such as "lock=1°:3°", or --vary KEY', place=PLACE))
    if not goals and not faults:
        faults.append(Fault("--goal", 'name a goal, such as "amplitude max" or "amplitude = 290°"', place=PLACE))
    limits: dict[str, tuple[float, float]] = {}
    for one in (*goals, *keeps):
        if one.is_goal:
            continue
        low, high = limits.get(one.output.name, (-math.inf, math.inf))
        low = max(low, one.value) if one.way in (ABOVE, EQUAL) else low
        high = min(high, one.value) if one.way in (BELOW, EQUAL) else high
        limits[one.output.name] = low, high
        if low > high:
            faults.append(
                Fault("--keep", f"nothing can be above {low:g} and below {high:g}", f" {one.output.name}", place=PLACE)
            )
    names = [one.output.name for one in goals]
    for name in {name for name in names if names.count(name) > 1}:
        faults.append(Fault("--goal", "is given twice", f" {name}", place=PLACE))
    if faults:
        raise SceneError(faults)


def needs(aims: Iterable[Aim]) -> tuple[bool, bool]:
    """Is the motion needed for these, and the geometry of function?"""
    names = {one.output.name for one in aims}
    return bool(names & (set(OUTPUTS) - set(FUNCTION))), bool(names & set(FUNCTION))


@dataclass(frozen=True)
class Better:
    """A better scene, or the reason why there is none.

    value   of the (first) goal; `values` of all goals and limits, as they were (old, None where it did not tick) and are
    keys    path -> (old, new), SI
    active  sentences on what holds it back, with what a little more room would give
    front   of several goals: designs of which none is better in all, as {path: SI, output: value}
    starts  how many searches there were, and how many ended in this design
    """

    title: str
    goals: tuple[Aim, ...]
    keeps: tuple[Aim, ...]
    knobs: tuple[Knob, ...]
    found: bool
    message: str
    value: float | None
    values: Mapping[str, tuple[float | None, float | None]]
    keys: Mapping[str, tuple[float, float]]
    active: tuple[str, ...]
    front: tuple[Mapping[str, float], ...]
    starts: tuple[int, int]
    evaluations: int
    without: int
    wall_s: float
    scene: Scene = field(repr=False)
    nominal: float | None = None

    def __repr__(self) -> str:
        if not self.found:
            return f"<No better {self.title!r}: {self.message}>"
        goals = ", ".join(str(one) for one in self.goals)
        return f"<Better {self.title!r}: {goals}: {self.value:.6g}, {len(self.active)} limits hold it back>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    @property
    def changes(self) -> dict[str, str]:
        """The new values as texts for a scene file, and the frequency that a rate is against where the scene did not say it."""
        new = {one.key: show(self.keys[one.key][1], one.unit, 12) for one in self.knobs if one.key in self.keys}
        return new | ({} if self.nominal is None else {"timegrapher.frequency": f"{self.nominal!r} Hz"})

    def numbers(self) -> dict[str, Any]:
        """What `improve --json` prints."""
        return {
            "found": self.found,
            "goal": [str(one) for one in self.goals] if len(self.goals) > 1 else str(self.goals[0]),
            "value": self.value,
            "keys": {key: {"old": old, "new": new} for key, (old, new) in self.keys.items()},
            "outputs": {name: {"old": old, "new": new} for name, (old, new) in self.values.items()},
            "active": list(self.active),
            "front": [dict(one) for one in self.front],
            "message": self.message,
            "starts": {"searches": self.starts[0], "same": self.starts[1]},
            "evaluations": self.evaluations,
            "without_number": self.without,
            "wall_s": self.wall_s,
        }
