"""What does a run leave on disk? summary.json, trajectory.npz, events.csv and the rest.

A results folder is built beside its destination and moved there when it is complete: it exists whole or not at all, and
one that is replaced stays untouched until then.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import IO, Any

from watchsim.results.archive import write_trajectory
from watchsim.results.scene_copy import LOCK, locked_drawings, travelling
from watchsim.results.state_file import write_state
from watchsim.results.tables import json_text, write_events
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.nameless import give_name, nameless
from watchsim.storage.scratch_folder import PREFIX
from watchsim.storage.write import real, write_folder

SUMMARY, TRAJECTORY, EVENTS = "summary.json", "trajectory.npz", "events.csv"
STATE = "state.npz"
FAILURE = "lcp_failure.json"  # only where the solver gave up on a complementarity problem
PICTURES = ("movie.mp4", "movie.gif", "tick.wav", "report.html", "import.png")
LATER = ("beats.csv", "phases.csv", "report.txt", *PICTURES)
OURS = frozenset((SUMMARY, LOCK, TRAJECTORY, EVENTS, STATE, FAILURE, *LATER))
PLOTS = re.compile(r"(plots|drawings|plots/(kinematics|last_beats|tape)\.(png|svg|pdf))")

Extra = Mapping[str, str | bytes | Callable[[Path], object]]


def check_folder(folder: str | os.PathLike[str], force: bool = False) -> Path:
    """The folder as an absolute path, if results may be written there; worth asking before a long simulation.

    FileExistsError where it exists and `force` is not set, or where it holds something else than results (never replaced).
    """
    target = Path(folder).absolute()
    if not target.exists():
        return target
    if not target.is_dir():
        raise FileExistsError(f"{folder} is a file; results need a folder of their own")
    empty = all(item.name.startswith(PREFIX) for item in target.iterdir())
    if not (empty or (target / SUMMARY).is_file() or (target / TRAJECTORY).is_file()):
        raise FileExistsError(f"{folder} exists and holds no results of a run; it is left alone. Choose another folder")
    if not (empty or force):
        raise FileExistsError(f"{folder} exists already and is left alone. Choose another folder, or replace it with --force")
    return target


def is_ours(name: str) -> bool:
    """Whether a path in a results folder is one that the package writes, so that new results replace it."""
    return name in OURS or PLOTS.fullmatch(name) is not None


def pictures_in(folder: Path) -> Iterator[str]:
    """What was made of the results in a folder for people to see or hear: movies, plots, pages, sound."""
    plots = (f"plots/{path.name}" for path in sorted((folder / "plots").glob("*")))
    yield from (name for name in (*PICTURES, *plots) if PLOTS.fullmatch(name) or (folder / name).is_file())


def ours_in(folder: Path) -> Callable[[str], bool]:
    """`is_ours` for a folder as it stands: the drawings that its locked scene names are ours, too; others are somebody's."""
    drawings = locked_drawings(folder)
    return lambda name: name in drawings or is_ours(name)


def write_results(
    run: Trajectory,
    folder: str | os.PathLike[str],
    summary: Mapping[str, Any] | None = None,
    scene_lock: str | None = None,
    *,
    extra: Extra | None = None,
    force: bool = False,
    keep: Collection[str] = (),
) -> Path:
    """Write a results folder and return its path.

    summary     numbers for summary.json (numpy values welcome; not-a-number becomes null)
    scene_lock  text of scene.lock.toml; by default made of the run's scene, whose drawings go into the folder with it
    extra       more files: relative path -> text, bytes, or a function that writes the file it is given; so for
                trajectory.npz and events.csv where they were begun before (`Packed`, `tables.EventLines`)
    force       replace an existing results folder; files in it that are not ours are kept
    keep        files of the existing folder that are ours, and are kept nevertheless where they are not written anew

    FileExistsError as from `check_folder`; OSError where the disk is full or the place not writable: what was there before
    is then still there, and nothing else.
    """
    target = check_folder(folder, force)
    files: dict[str, Any] = {**(travelling(run.scene) if scene_lock is None else {LOCK: scene_lock}), **(extra or {})}
    real(target).parent.mkdir(parents=True, exist_ok=True)
    ours = ours_in(real(target))
    write_folder(target, filler(run, summary or {}, files), lambda name: name not in keep and ours(name), "the results")
    return target


class Packed:
    """trajectory.npz in the making: packed in a thread, which needs another core and no Python, into a file without a name.

    `write` puts it where it belongs, as `extra` of `write_results` asks for; where the thread could not, it is packed anew.
    """

    def __init__(self, run: Trajectory, folder: Path) -> None:
        self._run, self._threads = run, ThreadPoolExecutor(1)
        self._made = self._threads.submit(self._pack, folder)

    def _pack(self, folder: Path) -> IO[bytes]:
        file = nameless(folder)
        write_trajectory(self._run, file)
        file.flush()
        os.fsync(file.fileno())  # as it must be in the end: waiting for the disk is work for a thread
        return file

    def write(self, path: Path) -> None:
        """Write `path`."""
        try:
            made = self._made.result()
        except OSError:
            write_trajectory(self._run, path)
            return
        give_name(made, path)


def filler(run: Trajectory, summary: Mapping[str, Any], files: Extra) -> Callable[[Path], None]:
    """What writes a results folder into the folder it is given; `files` holds the locked scene, its drawings and extras."""
    return lambda place: _fill(place, run, summary, files)


def bare_filler(run: Trajectory, files: Extra) -> Callable[[Path], None]:
    """The same with the motion, the state and the given files only, such as the scene and its drawings."""
    return lambda place: _fill_bare(place, run, files)


def _fill(place: Path, run: Trajectory, summary: Mapping[str, Any], files: Extra) -> None:
    packed = None if TRAJECTORY in files else Packed(run, place)
    if EVENTS not in files:
        write_events(run, place / EVENTS)
    (place / SUMMARY).write_text(json_text(summary), encoding="utf-8")
    if run.failure is not None:
        (place / FAILURE).write_text(json_text(run.failure), encoding="utf-8")
    _fill_rest(place, run, files)
    if packed is not None:
        packed.write(place / TRAJECTORY)


def _fill_bare(place: Path, run: Trajectory, files: Extra) -> None:
    write_trajectory(run, place / TRAJECTORY)
    _fill_rest(place, run, files)


def _fill_rest(place: Path, run: Trajectory, files: Extra) -> None:
    if run.end_state is not None:
        write_state(run.end_state, place / STATE)
    for name, content in files.items():
        path = place / name
        if not path.resolve().is_relative_to(place.resolve()):
            raise ValueError(f"extra file {name!r} would lie outside the results folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, str):
            path.write_text(content, encoding="utf-8")
        elif isinstance(content, bytes):
            path.write_bytes(content)
        else:
            content(path)
