"""What was measured on a real movement: a decay, readings of a timing machine, or a recording?

A CSV file has names of columns in its first line, with the unit in the name: t_s with angle_deg (or amplitude_deg) is one
decay; rate_s_per_d, amplitude_deg, beat_error_ms are readings, each beside the state of the movement in which it was taken:
position, wound_h, or any path of the scene. A column NAME_error holds standard errors.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.listen import NothingHeard, listen
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.keys import nearest
from watchsim.scene.roles import nominal_frequency
from watchsim.scene.scene import Scene
from watchsim.studies.axes import dimension_of
from watchsim.units import UnitError, parse

Array = NDArray[np.float64]
TIME, ANGLE, SWING = "t_s", "angle_deg", "amplitude_deg"
READ = {"rate_s_per_d": 1.0, "amplitude_deg": 1.0, "beat_error_ms": 0.05}  # what a timing machine shows, and about how exactly
ROUGH = {ANGLE: 0.1, SWING: 0.5} | READ
STATES = {"position": "watch.position", "wound_h": "watch.since_wound"}  # columns that need not be written as paths


@dataclass(frozen=True)
class Measured:
    """`columns` name -> values (n,), nan where nothing was read, `errors` likewise; `states` what each reading was taken in, as
    changes of the scene; `times` (s) of a decay, else None."""

    name: str
    columns: Mapping[str, Array]
    errors: Mapping[str, Array]
    states: tuple[Mapping[str, Any], ...]
    times: Array | None = None

    @property
    def count(self) -> int:
        return int(sum(np.isfinite(values).sum() for values in self.columns.values()))


def read_measured(path: str | Path, scene: Scene, faults: list[Fault]) -> Measured | None:
    """Of a CSV or WAV file; None where faults are added to those found. OSError where it cannot be read."""
    path = Path(path)
    if path.suffix.lower() == ".wav":
        return _recorded(path, scene, faults)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        faults.append(Fault("", "neither a CSV file (UTF-8) nor a WAV file", place=str(path)))
        return None
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        faults.append(Fault("", "is empty: a line with names of columns and lines with numbers are needed", place=str(path)))
        return None
    mark = next((one for one in ("\t", ";") if one in lines[0]), ",")
    head, *body = ([cell.strip() for cell in row] for row in csv.reader(lines, delimiter=mark))
    return _table(path, head, list(body), scene, mark, faults)


def _table(path: Path, head: list[str], body: list[list[str]], scene: Scene, mark: str, faults: list[Fault]) -> Measured | None:
    before, place = len(faults), str(path)
    decay = TIME in head
    values = [name for name in ((ANGLE, SWING) if decay else READ) if name in head]
    errors = [f"{name}_error" for name in values if f"{name}_error" in head]
    if not values:
        what = f"{TIME} needs {ANGLE} or {SWING} beside it" if decay else f"none of {', '.join(READ)}, nor {TIME} with {ANGLE}"
        faults.append(Fault("columns", f"{what}. There are {', '.join(head)}", place=place))
    states = [] if decay else [name for name in head if name not in (*values, *errors)]
    for name in head:
        if name in (TIME, *values, *errors) or (name in states and _is_state(scene, name)):
            continue
        known = [TIME, ANGLE, *READ, *(f"{one}_error" for one in READ), *STATES]
        faults.append(Fault(name, f"this column is not known. {nearest(name, known)}", place=place))
    numbers = {name: np.full(len(body), math.nan) for name in (*values, *errors, *([TIME] if decay else []))}
    changes: list[dict[str, Any]] = [{} for _ in body]
    for i, row in enumerate(body):
        if len(row) != len(head):
            faults.append(Fault("", f"has {len(row)} entries, the first line has {len(head)}", place=f"{place}, row {i + 2}"))
            continue
        for name, cell in zip(head, row, strict=True):
            try:
                if name in numbers and cell:
                    numbers[name][i] = float(cell.replace(",", ".") if mark != "," else cell)
                elif name in states and cell and len(faults) == before:
                    changes[i] |= _state(scene, name, cell)
            except (ValueError, UnitError) as error:
                words = f'"{cell}" is no number' if name in numbers else str(error)
                faults.append(Fault(name, words, place=f"{place}, row {i + 2}"))
            except SceneError as error:
                faults += (Fault(name, one.message, place=f"{place}, row {i + 2}") for one in error.faults)
    if decay and len(faults) == before:
        times = numbers[TIME]
        if not (np.isfinite(times).all() and times[0] >= 0.0 and (np.diff(times) > 0.0).all()):
            faults.append(Fault(TIME, "times must begin at 0 or later and grow from row to row", place=place))
    for name in errors:
        if (numbers[name][np.isfinite(numbers[name])] <= 0.0).any():
            faults.append(Fault(name, "standard errors must be above zero", place=place))
    if len(faults) > before:
        return None
    columns = {name: numbers[name] for name in values}
    each = {name: numbers.get(f"{name}_error", np.full(len(body), math.nan)) for name in values}
    return Measured(path.name, columns, each, tuple(changes), numbers.get(TIME))


def _is_state(scene: Scene, name: str) -> bool:
    return name in STATES or dimension_of(scene, name) is not None


def _state(scene: Scene, name: str, cell: str) -> dict[str, Any]:
    """What a cell changes of the scene; ValueError, UnitError where it cannot be read, SceneError where it does not fit."""
    key = STATES.get(name, name)
    if name == "wound_h":
        value: float | str = 3600.0 * float(cell)
    elif (dimension := dimension_of(scene, key)) is None:
        value = cell
    else:
        try:
            value = float(cell)
        except ValueError:
            value = parse(cell, dimension)
    scene.set(key, value)
    return {key: value}


def _recorded(path: Path, scene: Scene, faults: list[Fault]) -> Measured | None:
    """Rate, beat error, and the amplitude by the scene's lift angle, of a recording."""
    lift, hertz = scene.lift_angle, nominal_frequency(scene)
    try:
        heard = listen(
            path, lift_angle=None if lift is None else math.degrees(lift), vph=None if hertz is None else 7200.0 * hertz
        )
    except NothingHeard as error:
        faults.append(Fault("", str(error).partition(": ")[2], place=str(path)))
        return None
    columns = {"rate_s_per_d": heard.rate_s_per_d, "beat_error_ms": heard.beat_error_ms, "amplitude_deg": heard.amplitude_deg}
    known = {name: np.array([value]) for name, value in columns.items() if value is not None}
    errors = {"rate_s_per_d": heard.rate_s_per_d_error or math.nan, "beat_error_ms": heard.beat_error_ms_error}
    sigma = {name: np.array([max(errors.get(name, 0.0), READ[name])]) for name in known}
    return Measured(path.name, known, sigma, ({},))


def raise_any(faults: Sequence[Fault]) -> None:
    if faults:
        raise SceneError(list(faults))
