"""Within which limits is each dimension made, and how are its values spread there?

[tolerances]
"design.lock" = { limits = "±0.1°", distribution = "normal", cpk = 1.33 }
"wheel.TEETH.offset" = { limits = "+0/-4 µm" }          # of a drawing: bodies.wheel.adjust.TEETH.offset

Limits are deviations from the nominal value, or a fit class of ISO 286. The keys are those of `--set`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.variation import fold, grown
from watchsim.scene.assign import dimension_of
from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.forces import CONSTANT
from watchsim.scene.keys import TEETH, TOLERANCE, dotted, key_at, nearest, words_of
from watchsim.scene.scene import Correlation, Scene, Tolerance
from watchsim.scene.values import Table, shown
from watchsim.units import LENGTH, NUMBER, Dimension, UnitError, parse, split

SHAPES = ("uniform", "normal", "truncated", "triangular", "file")
USUAL_CPK = 1.0  # of a normal distribution that says nothing else: three sigmas to the nearer limit
MOST_MEASURED = 100_000
LEAST_CORRELATED = 1e-9  # the smallest eigenvalue of a matrix of correlations that can be drawn from

# Deviations in µm for nominal sizes up to 3, 6, 10, 18, 30 and 50 mm: ISO 286-1:2010, tables 1 (grades) to 4 (positions). Of a
# shaft the deviation that is nearer to the nominal size; a hole of the same letter has it with the other sign.
SIZES = (3.0, 6.0, 10.0, 18.0, 30.0, 50.0)  # mm
GRADES = {
    4: (3, 4, 4, 5, 6, 7),
    5: (4, 5, 6, 8, 9, 11),
    6: (6, 8, 9, 11, 13, 16),
    7: (10, 12, 15, 18, 21, 25),
    8: (14, 18, 22, 27, 33, 39),
    9: (25, 30, 36, 43, 52, 62),
    10: (40, 48, 58, 70, 84, 100),
    11: (60, 75, 90, 110, 130, 160),
}
BELOW = {  # upper deviation of shafts below the nominal size
    "d": (-20, -30, -40, -50, -65, -80),
    "e": (-14, -20, -25, -32, -40, -50),
    "f": (-6, -10, -13, -16, -20, -25),
    "g": (-2, -4, -5, -6, -7, -9),
    "h": (0, 0, 0, 0, 0, 0),
}
ABOVE = {  # lower deviation of shafts above it; k of the grades 4 to 7
    "k": (0, 1, 1, 1, 2, 2),
    "m": (2, 4, 6, 7, 8, 9),
    "n": (4, 8, 10, 12, 15, 17),
    "p": (6, 12, 15, 18, 22, 26),
}
FIT = re.compile(r"(js|JS|[defghkmnpDEFGH])(\d{1,2})")
EXAMPLE = 'limits = "±5 µm", "+0/-8 µm" or, of a size, "h6"'


def fit(name: str, size: float) -> tuple[float, float]:
    """Lower and upper deviation (m) of a fit class such as "h6" at a nominal size (m); UnitError where there is none."""
    match = FIT.fullmatch(name)
    column = next((i for i, most in enumerate(SIZES) if 1e3 * size <= most), None)
    if match is None or int(match[2]) not in GRADES or (match[1] == "k" and int(match[2]) > 7):
        letters = ", ".join([*BELOW, "js", *ABOVE])
        raise UnitError(f"not a fit class known here: shafts {letters}, holes D to H and JS, grades 4 to 11 (k to 7)")
    if column is None or not size > 0.0:
        raise UnitError("a fit class is for a size above 0 and up to 50 mm")
    letter, width = match[1], GRADES[int(match[2])][column]
    if letter.lower() == "js":
        low, high = -0.5 * width, 0.5 * width
    elif letter.lower() in BELOW:
        low, high = BELOW[letter.lower()][column] - width, float(BELOW[letter.lower()][column])
    else:
        low, high = float(ABOVE[letter][column]), float(ABOVE[letter][column] + width)
    if letter.isupper() and letter != "JS":
        low, high = -high, -low
    return 1e-6 * low, 1e-6 * high


def deviations(text: object, nominal: float, dimension: Dimension) -> tuple[float, float]:
    """Lower and upper deviation (SI) that `limits` says; UnitError where it cannot be read, or excludes the nominal value."""
    if not isinstance(text, str):
        raise UnitError(f"write {EXAMPLE}")
    if FIT.fullmatch(text.strip()):
        if dimension is not LENGTH:
            raise UnitError("a fit class is for lengths")
        return fit(text.strip(), nominal)
    sign, rest = text.strip()[:1], text.strip()[1:]
    if sign == "±":
        half = parse(_as_text(rest, rest), dimension)
        low, high = -half, half
    else:
        parts = text.split("/")
        if len(parts) < 2:
            raise UnitError(f"write {EXAMPLE}")
        first, second = parts[0], "/".join(parts[1:])  # of "+1/-2 mm/s" the second part keeps the unit
        low, high = sorted(parse(_as_text(one, second), dimension) for one in (first, second))
    if low > 0.0 or high < 0.0:
        raise UnitError("these limits exclude the nominal value: one is from 0 down, the other from 0 up")
    if low == high:
        raise UnitError("these limits leave no width: leave the tolerance out")
    return low, high


def _as_text(part: str, source: str) -> object:
    """A number with the unit of `source` where it has none of its own."""
    number, own = split(part)
    unit = own or split(source)[1]
    return f"{number} {unit}" if unit else float(number)


def full_key(name: str, bodies: Mapping[str, Any]) -> str:
    """The dotted path of a tolerance: "wheel.TEETH.offset" is bodies.wheel.adjust.TEETH.offset."""
    body, *rest = words_of(name)
    if body not in bodies or key_at((body, *rest)) is not None or len(rest) < 2:
        return name
    return dotted(("bodies", body, "teeth", *rest[1:]) if rest[0] == "teeth" else ("bodies", body, "adjust", *rest))


def nominal_at(scene: Scene, key: str) -> Any:
    """What the scene holds at a dotted path as in its file: a text, a number; the default where it says nothing."""
    path, value = words_of(key), scene.source
    for i, step in enumerate(path):
        inside: Any = value[int(step)] if isinstance(value, list) and step.isdigit() and int(step) < len(value) else None
        inside = value.get(step) if isinstance(value, dict) else inside
        if inside is None:
            return _implied(scene, path) if i else None
        value = inside
    return value


def _implied(scene: Scene, path: Sequence[str]) -> Any:
    """What the drawing or another key of the same table implies, in SI, else the key's default."""
    owners: dict[str, Any] = {"springs": scene.springs, "damping": scene.damping, "torques": scene.torques}
    owner: Any = None
    if path[0] == "bodies" and any(body.name == path[1] for body in scene.bodies):
        owner = scene.body(path[1])
    elif path[0] in owners and path[1].isdigit() and int(path[1]) < len(owners[path[0]]):
        owner = owners[path[0]][int(path[1])]
    value = getattr(owner, path[2], None) if len(path) > 2 and owner is not None else None
    if len(path) == 4 and isinstance(value, tuple) and path[3].isdigit() and int(path[3]) < len(value):
        value = value[int(path[3])]
    described = key_at(tuple(path))
    return value if isinstance(value, float) else described.default if described else None


def read_tolerances(scene: Scene, faults: Faults) -> tuple[tuple[Tolerance, ...], tuple[Correlation, ...]]:
    """The tolerances of a scene that has been read otherwise, and which of them are correlated."""
    entries = scene.source.get("tolerances", {})
    if not isinstance(entries, dict):
        faults.add("tolerances", 'write e.g. "design.lock" = { limits = "±0.1°" } below [tolerances]', shown(entries))
        return (), ()
    found: dict[str, Tolerance] = {}
    tables = {name: Table(entry, f"tolerances.{name}", TOLERANCE, faults) for name, entry in entries.items()}
    for name, table in tables.items():
        one = _tolerance(scene, name, table)
        if one is not None and any(one.key == other.key for other in found.values()):
            table.fault("", f"{one.key} has a tolerance already: name each dimension once")
        elif one is not None:
            found[name] = one
            others = [other for other in found.values() if one.group and other.group == one.group]
            if any(other.count != one.count for other in others):
                what = "needs as many values: write each = true for all of them (of wheels with as many teeth), or for none"
                table.fault("group", f'what "{one.group}" draws together {what}')
    correlated = tuple(_correlations(scene, tables, found))
    keys = list(dict.fromkeys(key for one in correlated for key in one.between))
    if correlated and matrix(keys, correlated)[1] < LEAST_CORRELATED:
        names = " and ".join(dict.fromkeys(name for one in correlated for name in one.between))
        what = f"the correlations of {names} contradict each other: their matrix is not positive definite. Make some smaller"
        faults.add("tolerances", what)
    return tuple(found.values()), correlated


def _tolerance(scene: Scene, name: str, table: Table) -> Tolerance | None:
    key = full_key(name, scene.source.get("bodies", {}))
    dimension = dimension_of(scene, key)
    if not table.is_table or dimension is None:
        if table.is_table:
            known = [*(f"design.{one}" for one in scene.source.get("design", {}) if one != "of"), *_paths(scene)]
            table.fault("", f"there is no dimension of that name. {_near(name, known)}")
        return None
    shape = table.one_of("distribution", "uniform", SHAPES)
    try:
        value = nominal_at(scene, key)
        if isinstance(value, dict):
            several = ", ".join(f'"{name}.{one}"' for one in value)
            table.fault("", f"the scene gives several numbers there: write {several} in its place")
            return None
        numbers = value if isinstance(value, list) else [value]
        nominal = [
            parse(one if isinstance(one, str) or dimension is NUMBER else f"{one!r} {dimension.si}", dimension)
            for one in numbers
        ]
        if len(set(nominal)) > 1:
            table.fault("", "the scene gives every tooth a value of its own: leave out the tolerance or these values")
            return None
        if shape == "file":
            return _measured(scene, name, key, nominal[0], dimension, table)
        if table.lacks(EXAMPLE, "limits"):
            return None
        low, high = deviations(table.mapping["limits"], nominal[0], dimension)
    except UnitError as error:
        table.fault("limits" if "limits" in table else "", str(error), with_value="limits" in table)
        return None
    sigma = _sigma(table, shape, 0.5 * (high - low), dimension)
    count = _count(scene, key, table)
    return Tolerance(key, nominal[0], low, high, dimension, shape, sigma, table.text("group"), count)


def _paths(scene: Scene) -> list[str]:
    """Some dotted paths of the scene, for suggestions."""
    return [
        *(f"bodies.{body.name}.{what}" for body in scene.bodies for what in ("position.0", "position.1", "inertia", "angle")),
        *(f"{body.name}.{layer}.offset" for body in scene.bodies for layer in body.layers),
        *(f"contacts.{i}.{what}" for i in range(len(scene.contacts)) for what in ("friction", "restitution")),
        *(f"torques.{i}.value" for i in range(len(scene.torques))),
    ]


def _near(name: str, known: Sequence[str]) -> str:
    hint = nearest(name, known)
    return hint if hint.startswith("Did") else "Use a path of --set, design.DIMENSION or BODY.LAYER.offset"


def _sigma(table: Table, shape: str, half: float, dimension: Dimension) -> float:
    """The standard deviation (SI) of a normal distribution about the middle of its limits, 0 for others."""
    given = [key for key in ("cpk", "sigma") if key in table]
    if shape not in ("normal", "truncated"):
        for key in given:
            table.fault(key, f'belongs to distribution = "normal" or "truncated"; here it is {shape}')
        return 0.0
    if len(given) == 2:
        table.fault("sigma", "cpk says the same: leave out one of them")
    if "sigma" in table:
        sigma = table.within("sigma", table.parsed("sigma", table.mapping["sigma"], dimension))
        return half / 3.0 if math.isnan(sigma) else sigma
    cpk = table.quantity("cpk", USUAL_CPK)
    return half / 3.0 if math.isnan(cpk) else half / (3.0 * cpk)


def _count(scene: Scene, key: str, table: Table) -> int:
    """How many values are drawn: one for each tooth, or one."""
    path = words_of(key)
    each = table.mapping.get("each", False)
    if not isinstance(each, bool):
        table.fault("each", "write each = true, or leave it out", with_value=True)
        return 1
    of_teeth = len(path) == 4 and path[0] == "bodies" and path[2] == "teeth" and path[3] in TEETH
    if of_teeth:
        teeth = max((fold(loop) for loop in scene.body(path[1]).loops), default=1)
        if teeth < 2:
            table.fault("", f"{path[1]} has no equal teeth about its pivot")
            return 1
        if not each and path[3] == "pitch":
            table.fault("each", "a pitch error of all teeth alike is no error: write each = true")
        return teeth if each else 1
    if each:
        table.fault("each", "belongs to teeth.pitch, teeth.height and teeth.width of a body: one value for each tooth")
    return 1


def _measured(scene: Scene, name: str, key: str, nominal: float, dimension: Dimension, table: Table) -> Tolerance | None:
    """A distribution of measured values: a text file with a value and its unit on each line."""
    if table.lacks('file = "measured.txt"', "file"):
        return None
    path = (scene.path.parent if scene.path else Path()) / table.text("file")
    try:
        lines = [line.partition("#")[0].strip() for line in path.read_text(encoding="utf-8-sig").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        table.fault("file", f"{path} cannot be read: {getattr(error, 'strerror', None) or error}", with_value=True)
        return None
    values = []
    for number, line in enumerate(lines, 1):
        try:
            values += [parse(line if dimension is not NUMBER else float(split(line)[0]), dimension)] if line else []
        except UnitError as error:
            table.fault("file", f"{path.name}:{number}: {error}", with_value=True)
            return None
    if not 2 <= len(values) <= MOST_MEASURED:
        table.fault(
            "file", f"{len(values)} values are in it; 2 to {MOST_MEASURED} are needed, one on each line", with_value=True
        )
        return None
    off = np.sort(np.array(values)) - nominal
    low, high = float(off[0]), float(off[-1])
    if "limits" in table:
        low, high = deviations(table.mapping["limits"], nominal, dimension)
    return Tolerance(key, nominal, low, high, dimension, "file", 0.0, table.text("group"), 1, tuple(off.tolist()))


def _correlations(scene: Scene, tables: Mapping[str, Table], found: Mapping[str, Tolerance]) -> list[Correlation]:
    """What `correlated = { "design.run" = -0.7 }` says of pairs of tolerances, also of those that are faulty otherwise."""
    pairs: list[Correlation] = []
    for name, table in tables.items():
        value = table.mapping.get("correlated", {})
        if not isinstance(value, dict):
            table.fault("correlated", 'write correlated = { "design.run" = -0.7 }', with_value=True)
            continue
        for other, number in value.items():
            if other not in tables or other == name:
                table.fault("correlated", f'there is no other tolerance "{other}". {nearest(other, tables)}', with_value=True)
            elif isinstance(number, bool) or not isinstance(number, (int, float)) or not -1.0 < number < 1.0:
                table.fault("correlated", "a coefficient lies between -1 and 1, without its ends", with_value=True)
            else:
                known = [found[each] for each in (name, other) if each in found]
                if any(one.group or one.count > 1 for one in known):
                    table.fault("correlated", "a group, or a tolerance of each tooth, cannot have a correlation of its own")
                first, second = (full_key(each, scene.source.get("bodies", {})) for each in (name, other))
                pairs.append(Correlation((first, second), float(number)))
    return pairs


def matrix(keys: Sequence[str], correlated: Sequence[Correlation]) -> tuple[np.ndarray, float]:
    """The correlations of normal scores of the tolerances of those keys (n, n), and the smallest eigenvalue of that matrix."""
    numbers = {key: i for i, key in enumerate(keys)}
    whole = np.eye(len(keys))
    for one in correlated:
        i, j = (numbers[key] for key in one.between)
        whole[i, j] = whole[j, i] = one.coefficient
    return whole, float(np.linalg.eigvalsh(whole)[0]) if len(whole) else 1.0


# Which tolerances are usual in the trade? By kind of dimension, for new scenes.

GRADE_4 = "1.5 µm either side: grade 4 of ISO 286-1 up to 3 mm; escape wheels by lithography keep 1 µm (grand-seiko.com, 9S)"
GRADE_7 = "5 µm either side: grade 7 of ISO 286-1 up to 3 mm"
GUESSED = "estimate: not published"
OUTLINE, HOLE = 1.5e-6, "±5 µm"
FRICTION, SHARE = 0.03, 0.1  # of friction; of torque and quality factor


def usual(scene: Scene) -> str:
    """The text of a [tolerances] table with usual values for what a scene holds, each kind with its source."""
    kinds: list[tuple[str, list[str]]] = [
        (f"outlines grown or shrunk, {GRADE_4}", _outlines(scene)),
        (
            f"places of pivots, {GRADE_7}",
            [_line(f"bodies.{name}.position.{i}", HOLE) for name in _pivoted(scene) for i in (0, 1)],
        ),
        (f"friction, drawn together, {GUESSED}", _frictions(scene)),
        (f"torque, {100 * SHARE:g} % either side, {GUESSED}", _shares(scene, "torques", "value")),
        (f"quality factor, {100 * SHARE:g} % either side, {GUESSED}", _shares(scene, "damping", "q_factor")),
    ]
    lines = [line for words, entries in kinds if entries for line in (f"# {words}", *entries)]
    return (
        "\n".join(["", "[tolerances]                         # watchsim tolerance draws watches within them", *lines, ""])
        if lines
        else ""
    )


def _line(key: str, limits: str, more: str = "") -> str:
    return f'"{key}" = {{ limits = "{limits}"{more} }}'


def _pivoted(scene: Scene) -> list[str]:
    return [body.name for body in scene.bodies if body.motion == "pivot" and body.on is None and body.loops]


def _outlines(scene: Scene) -> list[str]:
    """Of layers that can be touched and are not too finely rounded."""
    touching = {(side.body, side.layer) for one in scene.contacts for side in one.sides}
    found = []
    for body in scene.bodies:
        for layer in body.layers if "drawing" in scene.source["bodies"][body.name] else ():
            mine = [loop for loop in body.loops if loop.layer == layer]
            if touching & {(body.name, layer), (body.name, None)} and all(_can_shrink(loop) for loop in mine):
                found.append(_line(f"{body.name}.{layer}.offset", f"±{1e6 * OUTLINE:g} µm"))
    return found


def _can_shrink(loop: Loop) -> bool:
    try:
        grown(grown(loop, -2.0 * OUTLINE), 4.0 * OUTLINE)
    except ValueError:
        return False
    return True


def _frictions(scene: Scene) -> list[str]:
    numbers = [i for i, one in enumerate(scene.contacts) if one.friction > FRICTION]
    path = {i: "friction.static" if scene.contacts[i].slip != CONSTANT else "friction" for i in numbers}
    return [_line(f"contacts.{i}.{path[i]}", f"±{FRICTION:g}", ', group = "oil"') for i in numbers]


def _shares(scene: Scene, section: str, key: str) -> list[str]:
    """A share of what each entry of a section holds, where it is a number."""
    found = []
    for i, entry in enumerate(scene.source.get(section, [])):
        try:
            number, unit = split(entry[key])
        except (KeyError, UnitError):
            continue
        if float(number):
            found.append(_line(f"{section}.{i}.{key}", f"±{SHARE * abs(float(number)):.4g} {unit}".strip()))
    return found


# What does a study ask of a scene, how many watches are drawn, and how well is the yield to be known?

SEQUENCES = 16  # of Sobol points that a study consists of: see studies/sampling.py


def require_tolerances(scene: Scene) -> None:
    """SceneError where there are none."""
    if not scene.tolerances:
        message = 'this scene has no tolerances. Write e.g. "contacts.0.friction" = { limits = "±0.03" } below [tolerances]'
        raise SceneError([Fault("tolerances", message, place=str(scene.path or "scene"))])


def checked_samples(samples: int) -> int:
    """ValueError where so many cannot be."""
    most = 1_000_000
    if isinstance(samples, bool) or not isinstance(samples, int) or not SEQUENCES <= samples <= most:
        raise ValueError(f"samples: a whole number from {SEQUENCES} to {most} is needed, not {samples}")
    return samples


def half_width(until: float | str | None) -> float | None:
    """The share of "±0.5 %"; ValueError for another text. A text needs its %: 0.5 would be half of all watches."""
    if until is None:
        return None
    try:
        if isinstance(until, str) and "%" not in until:
            raise UnitError(f'"{until}" has no %')
        value = parse(until.strip().removeprefix("±") if isinstance(until, str) else until, NUMBER)
    except UnitError as error:
        raise ValueError(f'until: {error}. Write "±0.5 %"') from error
    if not 0.0 < value < 1.0:
        raise ValueError(
            f'until: half the width of an interval of the yield is above 0 and below 100 %, not {until}. Write "±0.5 %"'
        )
    return value
