"""What is different about these scenes or runs, and what comes of it?

Scenes are compared as they are completed, with every default written out and every design drawn, so that a scene and the run
made from it hold the same keys. A scene that keeps time is answered by its limit cycle, any other by a run of its own duration.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from watchsim.analysis.flows import energy_shares
from watchsim.analysis.summary import summary
from watchsim.escapement.measure import with_lift, with_measured_lift
from watchsim.results.folder import TRAJECTORY, lock_text, read_results, read_summary
from watchsim.scene.assign import dimension_of
from watchsim.scene.keys import DESIGN
from watchsim.scene.load import load
from watchsim.scene.read_bodies import AS_DRAWN
from watchsim.scene.read_tolerances import nominal_at
from watchsim.scene.roles import is_driven, keeps_time, only_presses
from watchsim.scene.scene import Scene
from watchsim.scene.toml import digest, parsed
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory
from watchsim.studies.steady import steady
from watchsim.units import UnitError, known_unit, parse, show, split, true_minus

SAME = 1e-12  # of a value: what writing it in another unit may change
TIMED = {"amplitude_deg": "°", "rate_s_per_d": "s/d", "beat_error_ms": "ms", "period_s": "s"}
SHARES = ("friction", "damping", "impacts")
UNITS = {**TIMED, "power_in_W": "W", **{f"{name}_W": "W" for name in SHARES}, "_deg": "°", "_mm": "mm"}
SHORT = 8  # letters of a digest
MICRO = 1e6  # powers are shown in µW

Number = tuple[float, float | None]  # with its error or scatter, where that is known


@dataclass(frozen=True)
class Side:
    """One of those that are compared.

    outputs  name with unit -> value and error: for a limit cycle that of the computation, for a run the scatter of its beats
    run      None for a scene that its limit cycle answers for, unless it was simulated only to be drawn
    cycle    its limit cycle answers for it
    """

    name: str
    scene: Scene
    outputs: Mapping[str, Number]
    verdict: str | None
    message: str
    run: Trajectory | None
    cycle: bool = False


@dataclass(frozen=True)
class Outcome:
    """An output of every side; None where a side does not have it.

    difference  the last one less the first, with its error: the root of the sum of squares of theirs
    """

    values: tuple[float | str | None, ...]
    errors: tuple[float | None, ...]

    @property
    def difference(self) -> float | None:
        """None where one of both is missing, or no number."""
        first, last = self.values[0], self.values[-1]
        return last - first if isinstance(first, float) and isinstance(last, float) else None

    @property
    def error(self) -> float | None:
        """Of the difference; None where that of a value is not known."""
        first, last = self.errors[0], self.errors[-1]
        return None if first is None or last is None or self.difference is None else math.hypot(first, last)


@dataclass(frozen=True)
class Comparison:
    """What differs between scenes or runs.

    changed  dotted key of the scene -> its value on every side as written, None where a side does not have the key
    outputs  name with unit -> `Outcome`, and "verdict"
    """

    sides: tuple[Side, ...]
    changed: Mapping[str, tuple[Any, ...]]
    outputs: Mapping[str, Outcome]

    @property
    def off(self) -> str:
        """What the error of a difference is: that of the computation (±), or for runs how much their beats scatter."""
        return "±" if self.sides[0].cycle and self.sides[-1].cycle else "scatter"

    def numbers(self) -> dict[str, Any]:
        """As `watchsim compare --json` prints it."""
        outputs = {
            name: {"values": list(one.values), "errors": list(one.errors), "difference": one.difference, "error": one.error}
            for name, one in self.outputs.items()
        }
        changed = {key: list(values) for key, values in self.changed.items()}
        return {"sides": [side.name for side in self.sides], "changed": changed, "outputs": outputs}


def compare(*sources: Scene | Trajectory | Side | str | Path) -> Comparison:
    """What was changed between those scenes or runs, and what came of it.

    Each source is a scene, a run, or the path of a scene or a results folder. ValueError for fewer than two, SceneError for a
    scene with faults, OSError for a results folder that cannot be read.
    """
    if len(sources) < 2:
        raise ValueError(f"compare needs two scenes or runs at least, not {len(sources)}")
    sides = tuple(side_of(source) for source in sources)
    names = dict.fromkeys(name for side in sides for name in side.outputs)
    nothing = (None, None)
    outputs = {name: Outcome(*zip(*(side.outputs.get(name, nothing) for side in sides), strict=True)) for name in names}
    outputs["verdict"] = Outcome(tuple(side.verdict for side in sides), (None,) * len(sides))
    changed = _changed([side.scene for side in sides])
    lengths = tuple(f"{side.run.simulated:.9g} s" for side in sides if side.run is not None)
    if len(lengths) == len(sides):  # of runs those count that were simulated
        changed.pop("run.duration", None)
        changed |= {"run.duration": lengths} if len(set(lengths)) > 1 else {}
    return Comparison(sides, changed, outputs)


def side_of(source: Scene | Trajectory | Side | str | Path) -> Side:
    """What a scene or run does; a scene that keeps time is answered by `steady`."""
    if isinstance(source, Side):
        return source
    if isinstance(source, Trajectory):
        return _of_run(source, source.scene.title, None)
    if isinstance(source, Scene):
        return _of_scene(source, source.title)
    name, folder = str(source), Path(source)
    if (folder / TRAJECTORY).is_file():
        return _of_run(read_results(folder), name, read_summary(folder))
    return _of_scene(load(folder), name)


def with_run(side: Side) -> Side:
    """The same with a motion that can be drawn: a scene is simulated for its own duration."""
    return side if side.run is not None else replace(side, run=simulate(side.scene))


def _of_scene(scene: Scene, name: str) -> Side:
    if not (keeps_time(with_lift(scene)) and is_driven(scene)):
        return _of_run(simulate(scene), name, None)
    cycle = steady(scene)
    found = {**cycle.numbers(), **dict(zip(("multiplier", "multiplier_error"), cycle.left_after_one(), strict=True))}
    return Side(name, scene, _numbers(found, (*TIMED, "multiplier")), cycle.verdict, cycle.message, None, cycle=True)


def _of_run(run: Trajectory, name: str, numbers: dict[str, Any] | None) -> Side:
    run = with_measured_lift(run)
    known = numbers or summary(run)
    outputs = _numbers(known, (*TIMED, "efficiency"))
    if run.simulated > 0.0:
        energy = known["energy"]
        powers = {"power_in_W": energy_shares(run).supplied, **{f"{one}_W": energy["dissipated"].get(one) for one in SHARES}}
        outputs |= {key: (value / run.simulated, None) for key, value in powers.items() if value is not None}
    if not keeps_time(run.scene) or only_presses(run.scene):
        outputs |= {key: (value, None) for key, value in _places(run.scene, known["bodies"])}
    return Side(name, run.scene, outputs, known["verdict"], known["verdict_message"] or known["stop_message"], run)


def _numbers(known: Mapping[str, Any], names: Sequence[str]) -> dict[str, Number]:
    return {name: (known[name], known.get(f"{name}_error")) for name in names if known.get(name) is not None}


def _places(scene: Scene, bodies: Mapping[str, Mapping[str, float]]) -> Iterator[tuple[str, float]]:
    """Where the moving bodies are at the end."""
    for body in scene.bodies:
        if body.motion == "fixed" or body.name not in bodies:
            continue
        end = bodies[body.name]
        if body.motion != "slide":
            yield f"{body.name}_deg", math.degrees(end["angle_rad"])
        if body.motion != "pivot":
            yield from ((f"{body.name}_{axis}_mm", 1e3 * end[f"{axis}_m"]) for axis in ("x", "y"))


# What was changed in the scene?


BESIDE = ("expect", "tolerances")  # tables of a scene that change no motion


def _changed(scenes: Sequence[Scene]) -> dict[str, tuple[Any, ...]]:
    """Key -> its values, of those keys that are not the same everywhere; dimensions of a design first.

    Of scenes that do not all follow from one design, the drawings and numbers are compared that they come to. What changes no
    motion is left out where only some of them say it.
    """
    whole = [_completed(scene) for scene in scenes]
    beside = [name for name in BESIDE if not all(one.get(name) for one in whole)]
    flat = [dict(_flat({name: value for name, value in one.items() if name not in beside})) for one in whole]
    designs = {one.get(f"{DESIGN}.of") for one in flat}
    if len(designs) > 1:
        flat = [{key: value for key, value in one.items() if not key.startswith(f"{DESIGN}.")} for one in flat]
    keys = sorted(dict.fromkeys(key for one in flat for key in one), key=lambda key: not key.startswith(f"{DESIGN}."))
    found = {}
    for key in keys:
        values = tuple(one.get(key) for one in flat)
        if any(not _same(scenes[0], key, values[0], value) for value in values[1:]):
            found[key] = values
    return found


def _completed(scene: Scene) -> dict[str, Any]:
    """The scene's mapping with all defaults in it, each drawing as its name and the digest of what is in it."""
    mapping = parsed(lock_text(scene))
    mapping.pop("lock", None)
    design = scene.source.get("lock", {}).get(DESIGN)  # of a run: what its drawings were made from
    if design is not None:
        mapping.setdefault(DESIGN, design)
    for name, entry in scene.source.get("bodies", {}).items():
        if drawing := entry.get("drawing"):
            mapping["bodies"][name]["drawing"] = f"{Path(drawing).name}, {digest(scene.drawings[drawing])[:SHORT]}"
            mapping["bodies"][name].setdefault("layers", list(scene.body(name).layers))
        if mapping["bodies"][name].get("position") == AS_DRAWN:
            places = (nominal_at(scene, f"bodies.{name}.position.{i}") for i in range(2))
            mapping["bodies"][name]["position"] = [show(float(place), "mm", 12) for place in places]
    return mapping


def _flat(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """(dotted key, value) of everything in a mapping."""
    if isinstance(value, (dict, list)):
        for name, one in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _flat(one, f"{key}.{name}" if key else str(name))
    else:
        yield key, value


def _same(scene: Scene, key: str, one: Any, other: Any) -> bool:
    """Equal, or the same quantity in another unit."""
    dimension = dimension_of(scene, key)
    if one == other or dimension is None:
        return bool(one == other)
    try:
        first, second = parse(one, dimension), parse(other, dimension)
    except UnitError:
        return False
    return abs(first - second) <= SAME * max(abs(first), abs(second))


# How is a difference put for people?

LABELS = {"amplitude_deg": "amplitude", "rate_s_per_d": "rate", "beat_error_ms": "beat error", "period_s": "period"}
LABELS |= {"power_in_W": "power put in", "friction_W": "lost to friction", "damping_W": "lost to damping"}
LABELS |= {"impacts_W": "lost in impacts"}
DIGITS, LONGEST = 6, 40  # of a number whose error is not known; letters of a value


def changed_rows(found: Comparison) -> list[list[str]]:
    """Key and its value on every side, to read; the sides in one unit."""
    return [[key, *map(_value, _alike(values))] for key, values in found.changed.items()]


def _alike(values: Sequence[Any]) -> Sequence[Any]:
    """Quantities of several units in the first that is not of the SI, in which scenes are completed; else as they are."""
    try:
        units = [known_unit(split(value)[1]) for value in values]
        written = next(split(value)[1] for value, unit in zip(values, units, strict=True) if unit.factor != 1.0)
        if len(set(units)) == 1 or len({unit.powers for unit in units}) > 1:
            return values
        numbers = (float(split(value)[0]) * unit.factor for value, unit in zip(values, units, strict=True))
        return [show(number, written, 12) for number in numbers]
    except (UnitError, StopIteration):
        return values


def result_rows(found: Comparison, finest: float = 0.0) -> list[list[str]]:
    """Label with unit, the value of every side to the digits that its error leaves, the difference and its error, to read.

    No error counts as less than `finest` of its value.
    """
    return [_outcome(name, one, finest) for name, one in found.outputs.items()]


def _outcome(name: str, outcome: Outcome, finest: float) -> list[str]:
    values, difference, error = outcome.values, outcome.difference, outcome.error
    sizes = [abs(value) for value in values if isinstance(value, float)]
    least = finest * max(sizes, default=0.0)
    errors = [None if one is None else max(one, least) for one in outcome.errors]
    unit, factor = _unit(name)
    label = LABELS.get(name, name.removesuffix("_deg").removesuffix("_mm").replace("_", " "))
    shown = [_number(value, one, factor) for value, one in zip(values, errors, strict=True)]
    whole = "" if difference is None else _number(difference, error and max(error, least), factor, sign=True)
    return [f"{label} ({unit})" if unit else label, *shown, whole, "" if error is None else f"{factor * error:.1g}"]


def _unit(name: str) -> tuple[str, float]:
    """The unit that an output is shown in, and what to multiply it by."""
    unit = next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "")
    return ("µW", MICRO) if unit == "W" else (unit, 1.0)


def _number(value: Any, error: float | None, factor: float, sign: bool = False) -> str:
    if value is None or isinstance(value, str):
        return value or "none"
    plus = "+" if sign else ""
    if error is None or not 0.0 < factor * error < math.inf:
        return f"{factor * value:{plus}.{DIGITS}g}".replace("-", "−")
    decimals = min(max(0, 1 - math.floor(math.log10(factor * error))), 9)
    return f"{round(factor * value, decimals) + 0.0:{plus}.{decimals}f}".replace("-", "−")  # no negative zero


def _value(value: Any) -> str:
    """As the scene has it, without digits that only rounding explains; "none" where it has no such key."""
    shown = "none" if value is None else str(value)
    try:
        number, unit = split(value)
        shown = f"{float(number.replace('−', '-')):.9g}{shown[len(number) :]}" if unit else shown
    except (UnitError, ValueError, TypeError):
        pass
    return true_minus(shown if len(shown) <= LONGEST else f"{shown[:LONGEST]}…")
