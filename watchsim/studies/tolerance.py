"""How many of the watches that are made to these tolerances work, and which dimension decides it?

Every sample is a watch with all dimensions drawn within their tolerances, and its limit cycle (or a run). It is good if it
ticks and gives what [expect] promises. What a sample is depends on its number and the seed alone: samples may be computed
anywhere, in any order, by many machines, and are one study.
"""

from __future__ import annotations

import dataclasses
import functools
import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from watchsim.results.folder import kept_names
from watchsim.scene.load import changed, load
from watchsim.scene.read_tolerances import SEQUENCES, checked_samples, half_width
from watchsim.scene.scene import Scene
from watchsim.scene.toml import toml_text
from watchsim.storage.write import write_file
from watchsim.studies.journal import NAME, Journal, read_rows
from watchsim.studies.point import Row
from watchsim.studies.section import Loop
from watchsim.studies.sweep import Progress, computed, seconds
from watchsim.studies.tolerance_plan import Plan, plan_of
from watchsim.studies.tolerance_result import Linear, Samples, ToleranceStudy, analysed
from watchsim.studies.workers import Executor, chosen
from watchsim.studies.yields import share_of, towards_failures, weighted

SAMPLES = 1024
BATCH = 16 * SEQUENCES  # samples between two looks at the interval
SPARSE = 8  # every so many points of a sequence has its geometry measured, where no promise needs it
SCENE = "scene.toml"
NOMINAL = -1  # the number of the nominal watch in the rows; those below are of the linear prediction


def tolerance(  # noqa: PLR0913 - options, by name
    scene: Scene | str | Path,
    samples: int = SAMPLES,
    *,
    until: float | str | None = None,
    duration: float | str | None = None,
    tolerance: float | None = None,
    importance: bool = False,
    seed: int = 0,
    workers: int = 1,
    scheduler: str | None = None,
    shard: tuple[int, int] | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> ToleranceStudy:
    """The yield of a scene with [tolerances], what limits it, and which dimension contributes how much.

    samples     how many watches, at most where there is `until`: half the width of the yield's interval at which to stop, such
                as "±0.5 %"
    duration    seconds, or a text with its unit: each sample by a run of that length instead of its limit cycle
    importance  most samples near the most probable failures, for yields above 99.9 %
    shard       (3, 64): only the third of 64 shares of the samples, for `merge`
    seed, workers, scheduler, folder, resume, progress, tolerance  as of `sweep`; another seed draws other watches

    SceneError for a scene without tolerances or that cannot be made in their middle, ValueError for other arguments.
    KeyboardInterrupt ends the study and keeps the finished samples.
    """
    if not isinstance(scene, Scene):
        scene = load(scene)
    count, width = checked_samples(samples), half_width(until)
    if shard is not None and not 1 <= shard[0] <= shard[1]:
        raise ValueError(f"shard: write (3, 64) for the third of 64, not {shard}")
    resumed = Path(folder) if resume and folder is not None else None
    plan = plan_of(scene, duration=seconds(duration), tolerance=tolerance, seed=seed, importance=importance, resumed=resumed)
    executor = chosen(workers, scheduler)
    return made(plan, count, executor, until=width, shard=shard, folder=folder, resume=resume, progress=progress)


def made(
    plan: Plan,
    samples: int,
    executor: Executor,
    *,
    until: float | None = None,
    shard: tuple[int, int] | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> ToleranceStudy:
    """The same for what has been checked."""
    begun = time.perf_counter()
    if folder is None:
        return _made(plan, samples, executor, {}, None, until, shard, progress, begun)
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    with Journal(place, plan.header(), resume) as journal:
        if not (resume and (place / SCENE).is_file()):
            keep_scene(plan.scene, place)
        return _made(plan, samples, executor, journal.rows, journal, until, shard, progress, begun)


def _made(
    plan: Plan,
    samples: int,
    executor: Executor,
    rows: dict[int, Row],
    journal: Journal | None,
    until: float | None,
    shard: tuple[int, int] | None,
    progress: Progress | None,
    begun: float,
) -> ToleranceStudy:
    keep = rows.__setitem__ if journal is None else journal.add
    share = (lambda number: True) if shard is None else (lambda number: number % shard[1] == shard[0] - 1)
    points: dict[int, Any] = {NOMINAL: {}, **{number: plan.space.changes(at) for number, at in plan.nudged().items()}}
    first = points if plan.importance else {number: change for number, change in points.items() if share(number)}
    total = len(first) + sum(map(share, range(samples)))

    def compute(numbers: Mapping[int, Any]) -> bool:
        """Have those computed that are missing; False where it was interrupted."""
        for measured in (True, False):
            question = plan.question if measured else dataclasses.replace(plan.question, function=None)
            mine = [(n, c) for n, c in numbers.items() if n not in rows and is_measured(plan, n) == measured]
            computed(question, mine, executor, keep, progress and (lambda *_: progress(float(len(rows)), float(total))))
        return all(number in rows for number in numbers)

    whole = compute(first)
    if whole and plan.importance:
        margins = Linear(plan, rows).margins()
        shifted = towards_failures(plan.space, margins) if margins is not None else None
        if shifted is None:
            raise ValueError("importance: the linear prediction reaches no limit of [expect]; leave it out")
        plan = dataclasses.replace(plan, shifted=shifted)
    done = 0
    while whole and done < samples:
        upto = samples if until is None else min(samples, max(BATCH, 2 * done))
        numbers = [number for number in range(done, upto) if share(number)]
        missing = [number for number in numbers if number not in rows]
        whole, done = compute(dict(zip(missing, plan.changes(missing), strict=True)) if missing else {}), upto
        if until is not None and whole and _is_known(plan, rows, done, until):
            break
    taken = {number: row for number, row in rows.items() if number < done}
    return analysed(plan, taken, whole, time.perf_counter() - begun)


def is_measured(plan: Plan, number: int) -> bool:
    """Whether the geometry of function is measured of that sample."""
    needed = any(one.is_function for one in plan.limits)
    return number < 0 or needed or number // SEQUENCES % SPARSE == 0


def _is_known(plan: Plan, rows: Mapping[int, Row], done: int, until: float) -> bool:
    """Whether the yield is known closely enough."""
    numbers = np.array([number for number in sorted(rows) if 0 <= number < done])
    found = Samples(plan, tuple(rows[int(number)] for number in numbers), numbers)
    if plan.shifted is not None:
        share = weighted(found.good, found.points[1], found.sequence)
    else:
        share = share_of(found.good, found.sequence)
    return 0.5 * (share.high - share.low) <= until


# A study's folder holds its scene, so that it can be read, gone on with and replayed anywhere.


def keep_scene(scene: Scene, folder: Path) -> None:
    """Write the scene as it was read, and the drawings and measured values it names, into the folder."""
    mapping = json.loads(json.dumps(scene.written.mapping if scene.written else scene.source, default=str))
    mapping.pop("lock", None)
    kept = kept_names(scene)
    files = {there: scene.drawings[name] for name, there in kept.items()}
    for entry in mapping.get("bodies", {}).values():
        if entry.get("drawing") in kept:
            entry["drawing"] = kept[entry["drawing"]]
    for shock in mapping.get("shocks", ()):
        shock.update({key: kept.get(name, name) for key, name in shock.items() if key == "file"})
    here = scene.path.parent if scene.path else Path()
    for i, entry in enumerate(one for one in mapping["tolerances"].values() if "file" in one):
        there = f"measured_{i}_{PurePath(entry['file']).name}"
        files[there], entry["file"] = (here / entry["file"]).read_bytes(), there
    for there, data in {**files, SCENE: toml_text(mapping).encode()}.items():
        (folder / there).parent.mkdir(parents=True, exist_ok=True)
        write_file(folder / there, functools.partial(Path.write_bytes, data=data), "the scene of the study")


def read_study(folder: str | Path) -> tuple[Plan, dict[int, Row], dict[str, Any]]:
    """The plan of a study, its rows by their numbers, and its header; ValueError where the folder holds none."""
    place = Path(folder)
    if not (place / NAME).is_file() or not (place / SCENE).is_file():
        raise ValueError(f"{place} holds no study of tolerances: {NAME} and {SCENE} are not both in it")
    header, rows = read_rows(place / NAME)
    if "seed" not in header:
        raise ValueError(f"{place} holds a study of another kind")
    scene = load(place / SCENE)
    scene = changed(scene, header["changes"]) if header["changes"] else scene
    options = {name: header[name] for name in ("seed", "importance", "duration", "tolerance")}
    plan = plan_of(scene, **options, is_computed=True)
    if plan.importance:
        margins = Linear(plan, rows).margins()
        plan = dataclasses.replace(plan, shifted=towards_failures(plan.space, margins) if margins else None)
    return plan, rows, header


def finished(folder: str | Path) -> ToleranceStudy:
    """A study as its folder holds it."""
    plan, rows, _ = read_study(folder)
    return analysed(plan, rows, _is_whole(rows), 0.0)


def sample_scene(folder: str | Path, number: int) -> Scene:
    """The watch that a sample of a study is; ValueError for a number that is none."""
    plan, rows, _ = read_study(folder)
    if number not in rows or number < 0:
        most = max(rows, default=0)
        raise ValueError(f"{folder} holds no sample {number}: its samples are numbered from 0 to {most}")
    scene = changed(plan.question.scene, plan.changes([number])[0])
    loop = Loop(scene, scene.tolerance)
    free = loop.begin().q  # a part that was moved a little may overlap where it starts
    turning = [body.name for body in scene.bodies if body.motion == "pivot" and body.prescribed is None and body.on is None]
    scene = changed(scene, {f"bodies.{name}.angle": float(free[loop.compiled.slices[name].start]) for name in turning})
    return dataclasses.replace(scene, title=f"{scene.title}, sample {number}", path=None)


def merge(folders: Sequence[str | Path], folder: str | Path | None = None) -> ToleranceStudy:
    """One study of the shards in these folders, kept in `folder` where one is given.

    ValueError where they are of different studies, or where two of them have the same sample with different results.
    """
    plan, rows, header = read_study(folders[0])
    for other in folders[1:]:
        if not (Path(other) / NAME).is_file():
            raise ValueError(f"{other} holds no study of tolerances: {NAME} is not in it")
        its, more = read_rows(Path(other) / NAME)
        if its != header:
            names = ", ".join(name for name in {**its, **header} if its.get(name) != header.get(name))
            raise ValueError(f"{folders[0]} and {other} are shards of different studies: {names} differ")
        for number, row in more.items():
            if number in rows and _result(rows[number]) != _result(row):
                what = f"sample {number}" if number >= 0 else "the linear prediction"
                raise ValueError(
                    f"{what} of {other} differs from that of an earlier folder: have other versions of watchsim, numpy "
                    "or shapely computed it? Compute those shards anew with one of them"
                )
            rows.setdefault(number, row)
    if folder is not None:
        Path(folder).mkdir(parents=True, exist_ok=True)
        with Journal(Path(folder), header, False) as journal:
            keep_scene(plan.scene, Path(folder))
            journal.add_all({number: rows[number] for number in sorted(rows)})
    return analysed(plan, rows, _is_whole(rows), 0.0)


def _is_whole(rows: Mapping[int, Row]) -> bool:
    """Whether no sample is missing up to the last one."""
    numbers = [number for number in rows if number >= 0]
    return len(numbers) == max(numbers, default=-1) + 1


def _result(row: Row) -> Row:
    return {name: value for name, value in row.items() if name != "seconds"}
