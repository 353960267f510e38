"""What does a run leave on disk? summary.json, trajectory.npz, events.csv and the rest.

A results folder is built beside its destination and moved there when it is complete: it exists whole or not at all, and
one that is replaced stays untouched until then.
"""

from __future__ import annotations

import contextlib
import copy
import dataclasses
import functools
import json
import os
import platform
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from importlib import metadata
from pathlib import Path, PurePath
from typing import IO, Any

from watchsim.results.archive import read_state, read_trajectory, write_state, write_trajectory
from watchsim.results.tables import json_text, write_events
from watchsim.scene.keys import DESIGN, SCHEMA
from watchsim.scene.load import SCENE_FILES, load
from watchsim.scene.scene import Body, Scene
from watchsim.scene.toml import digest, file_digest, parsed, toml_text
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.destination import give_name, nameless
from watchsim.storage.write import PREFIX, real, write_folder

# What exactly was simulated?
#
# The completed scene as TOML: every default written out, what was derived from drawings stated, versions of the programs and
# digests of the drawings. It loads again to an equal scene.

PACKAGES = ("watchsim", "numpy", "scipy", "numba", "shapely", "ezdxf", "trimesh")
HEADER = "# Completed by watchsim: all defaults written out. Loads again to the scene that was simulated.\n\n"


def lock_text(scene: Scene, folder: Path | None = None, kept: Mapping[str, str] | None = None) -> str:
    """TOML of the completed scene. Drawings are named relative to `folder`, where the text will be kept; else absolute.

    Those in `kept` travel with the text: name in the scene file -> name beside the text (see results/scene_copy.py).
    """
    source = {key: value for key, value in copy.deepcopy(scene.source).items() if key not in ("lock", DESIGN)}
    here = scene.path.parent if scene.path else Path()
    made = scene.written.made - set(kept or {}) if scene.written else frozenset[str]()
    ordered = {"scene": _heading(source, scene)}
    if made:  # they have no files: the design makes them again
        ordered[DESIGN] = scene.source[DESIGN]
        source["bodies"] = {
            name: {key: value for key, value in entry.items() if key != "drawing" or value not in made}
            for name, entry in source["bodies"].items()
        }
    ordered["bodies"] = {body.name: _completed(source["bodies"][body.name], body, here, folder) for body in scene.bodies}
    for name, entry in ordered["bodies"].items():
        if (drawing := source["bodies"][name].get("drawing")) in (kept or {}):  # named by where it will be
            entry["drawing"] = (kept or {})[drawing]
    ordered.update((key, value) for key, value in source.items() if key not in ordered)
    shocks: list[dict[str, Any]] = source.get("shocks", [])
    for shock in shocks:
        if shock.get("file") in (kept or {}):
            shock["file"] = (kept or {})[shock["file"]]
    _complete_forces(ordered, scene)
    ordered["run"] = {"duration": _si(scene.duration, "s"), "tolerance": scene.tolerance, **source.get("run", {})}
    ordered["lock"] = {
        "versions": versions(),
        **({DESIGN: scene.source[DESIGN]} if DESIGN in scene.source and not made else {}),
        "drawings": _digests(
            [*ordered["bodies"].values(), *shocks],
            folder or Path(),
            {there: scene.drawings[name] for name, there in (kept or {}).items()},
        ),
    }
    return HEADER + toml_text(ordered)


def versions() -> dict[str, str]:
    """Python and the packages that decide the numbers, as far as they are installed."""
    return dict(_installed())


@functools.cache
def _installed() -> Mapping[str, str]:
    """Looked up once: it means reading what every package says of itself."""
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        with contextlib.suppress(metadata.PackageNotFoundError):
            found[package] = metadata.version(package)
    return found


def _heading(source: dict[str, Any], scene: Scene) -> dict[str, Any]:
    defaults: dict[str, Any] = {"title": scene.title, "schema": SCHEMA, "gravity": _pair(scene.gravity, "m/s²")}
    defaults["tangential_law"] = scene.tangential_law
    return {**defaults, **source.get("scene", {})}


def _completed(entry: dict[str, Any], body: Body, here: Path, folder: Path | None) -> dict[str, Any]:
    """The table of one body with what it left out."""
    full = dict(entry)
    if "drawing" in full:
        full["drawing"] = _drawing_path(here / full["drawing"], folder)
        full.setdefault("layers", list(body.layers))
    full.setdefault("motion", body.motion)
    full.setdefault("position", _pair(body.position, "m"))
    full.setdefault("angle", _si(body.angle, "rad"))
    if body.motion == "free":
        full.setdefault("velocity", _pair(body.velocity[:2], "m/s"))
        full.setdefault("spin", _si(body.velocity[2], "rad/s"))
    elif body.motion != "fixed" and body.prescribed is None:
        full.setdefault("velocity", _si(body.velocity[0], "rad/s" if body.motion == "pivot" else "m/s"))
    if "solids" not in full and body.motion != "fixed" and body.prescribed is None:
        full.setdefault("inertia", _si(body.inertia, "kg·m²"))
    return full


def _complete_forces(source: dict[str, Any], scene: Scene) -> None:
    for entry, spring in zip(source.get("springs", []), scene.springs, strict=True):
        unit = "rad" if scene.body(spring.body).motion == "pivot" else "m"
        if "preload" not in entry:
            entry.setdefault("rest", _si(spring.rest, unit))
    for entry in source.get("contacts", []):
        for key in ("friction", "restitution", "tangential_restitution"):
            entry.setdefault(key, 0.0)


def _drawing_path(path: Path, folder: Path | None) -> str:
    return Path(os.path.relpath(path, folder) if folder else path.resolve()).as_posix()


def _digests(entries: Iterable[Mapping[str, Any]], folder: Path, known: Mapping[str, bytes]) -> dict[str, str]:
    names = dict.fromkeys(entry[key] for entry in entries for key in ("drawing", "file") if key in entry)
    # The folder may not exist yet: `..` after it cannot be followed, only resolved in words.
    return {
        name: digest(known[name]) if name in known else file_digest(Path(os.path.normpath(folder / name))) for name in names
    }


def _si(value: float, unit: str) -> str:
    return f"{value!r} {unit}"


def _pair(values: tuple[float, ...], unit: str) -> list[str]:
    return [_si(value, unit) for value in values]


# What must travel with results, so that they can be read anywhere and at any time?
#
# The completed scene and its drawings as they were read, byte by byte: a results folder that is moved, mailed, or older than
# the drawing it was made from still holds what was simulated.

LOCK, FOLDER = "scene.lock.toml", "drawings"


def travelling(scene: Scene) -> dict[str, str | bytes]:
    """Name in the results folder -> content: the completed scene and the drawings that it names there.

    The scene is empty where it was not made from a mapping, as of hand-made bodies: nothing can be said of them in TOML.
    """
    if not scene.source:
        return {LOCK: ""}
    kept = kept_names(scene)
    files: dict[str, str | bytes] = {LOCK: lock_text(scene, kept=kept)}
    files.update((there, scene.drawings[name]) for name, there in kept.items())
    return files


def locked_drawings(folder: Path) -> frozenset[str]:
    """The drawings in a results folder that its locked scene names; none where that cannot be read."""
    try:
        lock = parsed((folder / LOCK).read_text(encoding="utf-8"))
        return frozenset(name for name in lock["lock"]["drawings"] if name.startswith(f"{FOLDER}/"))
    except (OSError, ValueError, KeyError, TypeError):
        return frozenset()


def kept_names(scene: Scene) -> dict[str, str]:
    """Name of each drawing in the scene file -> its name in the results folder; different drawings get different names."""
    taken: dict[str, bytes] = {}
    names: dict[str, str] = {}
    for name, data in scene.drawings.items():
        plain = PurePath(name.replace("\\", "/"))
        there, k = plain.name, 1
        while taken.get(there.casefold(), data) != data:
            k += 1
            there = f"{plain.stem}_{k}{plain.suffix}"
        taken[there.casefold()] = data
        names[name] = f"{FOLDER}/{there}"
    return names


SUMMARY, TRAJECTORY, EVENTS = "summary.json", "trajectory.npz", "events.csv"
STATE = "state.npz"
FAILURE = "lcp_failure.json"  # only where the solver gave up on a complementarity problem
PICTURES = ("movie.mp4", "movie.gif", "tick.wav", "report.html", "import.png")
LATER = ("beats.csv", "phases.csv", "report.txt", *PICTURES)
OURS = frozenset((SUMMARY, LOCK, TRAJECTORY, EVENTS, STATE, FAILURE, *LATER))
PLOTS = re.compile(r"(plots|drawings|plots/(kinematics|last_beats|last_stretch|tape)\.(png|svg|pdf))")

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
        raise FileExistsError(f"{folder} exists and holds no results of a run; it was not changed. Choose another folder")
    if not (empty or force):
        raise FileExistsError(f"{folder} already exists and was not changed. Choose another folder, or replace it with --force")
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
    keep        files of the existing folder that are ours, and are kept nevertheless where they are not rewritten

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

    `write` puts it where it belongs, as `extra` of `write_results` asks for; where the thread could not, it is packed again.
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


def filler(run: Trajectory, summary: Mapping[str, Any] | None, files: Extra) -> Callable[[Path], None]:
    """What writes a results folder into the folder it is given; `files` holds the locked scene, its drawings and extras.

    Without a summary nothing but the motion, the state and these files.
    """
    return lambda place: _fill(place, run, summary, files)


def _fill(place: Path, run: Trajectory, summary: Mapping[str, Any] | None, files: Extra) -> None:
    packed = None if TRAJECTORY in files else Packed(run, place)
    if summary is not None:
        if EVENTS not in files:
            write_events(run, place / EVENTS)
        (place / SUMMARY).write_text(json_text(summary), encoding="utf-8")
        if run.failure is not None:
            (place / FAILURE).write_text(json_text(run.failure), encoding="utf-8")
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
    if packed is not None:
        packed.write(place / TRAJECTORY)


# Which trajectory does a results folder hold?


def read_results(folder: str | os.PathLike[str]) -> Trajectory:
    """The trajectory of a results folder, with its scene.

    FileNotFoundError where the folder or a file of it is missing, ValueError where one is damaged or does not belong to the
    others, SceneError where the scene can no longer be loaded.
    """
    place = Path(folder)
    if not place.is_dir():
        raise FileNotFoundError(f"{folder}: there is no such results folder")
    missing = [name for name in (LOCK, TRAJECTORY) if not (place / name).is_file()]
    if missing:
        cure = f". It holds a scene: watchsim run {folder} makes results of it" if (place / SCENE_FILES[0]).is_file() else ""
        raise FileNotFoundError(f"{folder} is not a results folder of watchsim: {' and '.join(missing)} missing{cure}")
    run = read_trajectory(place / TRAJECTORY, load(place / LOCK))
    if (place / STATE).is_file():
        run = dataclasses.replace(run, end_state=read_state(place / STATE))
    return run


def read_summary(folder: str | os.PathLike[str]) -> dict[str, Any] | None:
    """The summary as the run wrote it, which knows its error bars and promises; None where it cannot be read."""
    try:
        found = json.loads((Path(folder) / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and "energy" in found else None
