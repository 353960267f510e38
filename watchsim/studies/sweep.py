"""How do amplitude, rate and beat error depend on parameters of the scene?"""

from __future__ import annotations

import contextlib
import itertools
import os
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.displays import notebook_html
from watchsim.scene.errors import SceneError
from watchsim.scene.keys import DESIGN
from watchsim.scene.load import changed
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.scene import Scene
from watchsim.simulation.runner import held_interrupts
from watchsim.studies.axes import Axis, Value, axes_from_values
from watchsim.studies.journal import Journal, study_of
from watchsim.studies.point import USUAL, Output, Question, Row, outputs_named
from watchsim.studies.workers import Executor, chosen

Progress = Callable[[float, float], None]  # points done, of so many


@dataclass(frozen=True)
class Sweep:
    """The finished rows of a study, in the order of its points: the last key runs fastest.

    Each row holds every key (SI), every output with its error, `verdict` and `message`; `whole` is False where points are
    missing because it was interrupted.
    """

    title: str
    axes: tuple[Axis, ...]
    outputs: tuple[Output, ...]
    rows: tuple[Row, ...]
    whole: bool
    wall_s: float

    def __repr__(self) -> str:
        keys = ", ".join(axis.key for axis in self.axes)
        columns = ", ".join(one.column for one in self.outputs)
        return (
            f"<Sweep of {self.title!r}: {len(self.rows)} points over {keys}; {columns}{'' if self.whole else '; interrupted'}>"
        )

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def column(self, name: str) -> NDArray[Any]:
        """(n,): a key, an output ("amplitude") or a column ("amplitude_deg_error") in all rows, `table[name]` for short.

        Numbers are floats, nan where a row has none; of texts an array of objects. KeyError for any other name.
        """
        names = {one.name: one.column for one in self.outputs}
        values = [row[names.get(name, name)] for row in self.rows]
        if any(isinstance(value, (str, Mapping)) for value in values):
            return np.array(values, dtype=object)
        return np.array([np.nan if value is None else value for value in values], dtype=float)

    __getitem__ = column

    def to_pandas(self) -> Any:
        """A DataFrame with a column for each key and each entry of the rows; ImportError where pandas is not installed."""
        try:
            import pandas  # type: ignore[import-untyped, unused-ignore]
        except ImportError as error:
            raise ImportError("to_pandas needs pandas, which is not installed: pip install pandas") from error
        return pandas.DataFrame({name: self.column(name) for name in (self.rows[0] if self.rows else ())})

    def numbers(self) -> dict[str, Any]:
        """What `sweep --json` prints: keys (values in SI), outputs (columns), rows, wall_s."""
        return {
            "keys": {axis.key: list(axis.values) for axis in self.axes},
            "outputs": [one.column for one in self.outputs],
            "rows": [dict(row) for row in self.rows],
            "wall_s": self.wall_s,
        }


def sweep(  # noqa: PLR0913 - options, by name
    scene: Scene | str | Path,
    values: Mapping[str, Sequence[Any]],
    outputs: Iterable[str] = USUAL,
    *,
    steady: bool = True,
    duration: float | str | None = None,
    tolerance: float | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Sweep:
    """Every combination of the values: the limit cycle of each, or with `steady` off the end of a run of `duration`.

    values     dotted path of the scene -> SI numbers, or texts with units: {"contacts.0.friction": [0.1, 0.12, 0.15]}
    outputs    of amplitude, rate, beat_error, period, multiplier
    duration   seconds, or a text with its unit (default the scene's)
    workers    processes (more than one only where this is called under `if __name__ == "__main__":`); `scheduler` the
               address of a dask.distributed scheduler instead
    folder     where finished rows are kept one by one (rows.jsonl); with `resume` those that are there already are taken up
    progress   called as progress(points done, points)

    Every point begins from the scene's own start, so that rows do not depend on their order or on who computed them. A point
    that fails has its reason in `message`. KeyboardInterrupt ends the sweep and keeps the finished rows. SceneError for keys or
    values that do not fit, ValueError for other arguments.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    axes, asked = axes_from_values(scene, values), outputs_named(outputs)
    question = Question(scene, steady, seconds(duration), tolerance, function=measured(asked))
    return swept(question, axes, asked, chosen(workers, scheduler), folder=folder, resume=resume, progress=progress)


def swept(
    question: Question,
    axes: Sequence[Axis],
    outputs: tuple[Output, ...],
    executor: Executor,
    *,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Sweep:
    """The same for what has been checked."""
    begun = time.perf_counter()
    points = [dict(zip((axis.key for axis in axes), values, strict=True)) for values in _grid(axes)]
    if not axes:
        raise ValueError("a sweep needs at least one key with its values")
    question = replace(question, units={axis.key: axis.usual for axis in axes})
    rows = _rows(question, axes, points, executor, folder, resume, progress)
    columns = [name for one in outputs for name in ((one.column, f"{one.column}_error") if one.has_error else (one.column,))]
    outcomes = tuple(
        {**points[number], **{name: rows[number].get(name) for name in (*columns, "verdict", "message")}}
        for number in sorted(rows)
    )
    return Sweep(
        _title(question.scene, axes), tuple(axes), outputs, outcomes, len(rows) == len(points), time.perf_counter() - begun
    )


def _title(scene: Scene, axes: Sequence[Axis]) -> str:
    """That of the scene without what the axes change in it, as a number of teeth."""
    titles = [scene.title]
    for axis in axes:
        for value in (axis.values[0], axis.values[-1]) if axis.key.startswith(f"{DESIGN}.") else ():
            with contextlib.suppress(SceneError):  # the row of the point says why
                titles.append(changed(scene, {axis.key: value}).title)
    kept = [part for part in scene.title.split(", ") if all(part in one.split(", ") for one in titles)]
    return ", ".join(kept) or scene.title


def measured(outputs: Iterable[Output]) -> int | None:
    """For `Question.function`: every tooth where an output needs the geometry of function."""
    return 0 if any(one.name in FUNCTION for one in outputs) else None


def _grid(axes: Sequence[Axis]) -> Iterable[tuple[Value, ...]]:
    return itertools.product(*(axis.values for axis in axes))


def _rows(
    question: Question,
    axes: Sequence[Axis],
    points: list[dict[str, Value]],
    executor: Executor,
    folder: str | Path | None,
    resume: bool,
    progress: Progress | None,
) -> dict[int, Row]:
    if folder is None:
        rows: dict[int, Row] = {}
        computed(question, list(enumerate(points)), executor, rows.__setitem__, progress)
        return rows
    keys = {axis.key: axis.values for axis in axes}
    study = study_of(question.scene, keys, question.by_shooting, question.duration, question.tolerance)
    with Journal(Path(folder), study, resume) as journal:
        left = [(number, point) for number, point in enumerate(points) if number not in journal.rows]
        computed(question, left, executor, journal.add, progress)
        return journal.rows


def computed(
    question: Question,
    points: Sequence[tuple[int, Mapping[str, Value]]],
    executor: Executor,
    keep: Callable[[int, Row], None],
    progress: Progress | None = None,
) -> None:
    """Have the points answered, and keep every row as it comes."""
    if not points:
        return
    with held_interrupts() as interrupted:
        for done, (number, row) in enumerate(executor.answers(question, points, interrupted), start=1):
            keep(number, row)
            if progress is not None:
                progress(float(done), float(len(points)))


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def seconds(duration: float | str | None) -> float | None:
    """A duration in s, of a number or a text with its unit; ValueError for another."""
    if not isinstance(duration, str):
        return duration
    from watchsim.units import TIME, UnitError, parse

    try:
        return parse(duration, TIME)
    except UnitError as error:
        raise ValueError(f"duration: {error}") from error
