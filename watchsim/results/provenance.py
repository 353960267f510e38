"""What exactly was simulated?

The completed scene as TOML: every default written out, what was derived from drawings stated, versions of the programs
and digests of the drawings. It loads again to an equal scene.
"""

from __future__ import annotations

import copy
import functools
import os
import platform
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from watchsim.scene.body import Body
from watchsim.scene.file.digests import digest, file_digest
from watchsim.scene.file.keys.schema import DESIGN, SCHEMA
from watchsim.scene.file.keys.write_toml import toml_text
from watchsim.scene.scene import Scene

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
        source["bodies"] = {name: _undrawn(entry, made) for name, entry in source["bodies"].items()}
    ordered["bodies"] = {body.name: _completed(source["bodies"][body.name], body, here, folder) for body in scene.bodies}
    _travel(ordered["bodies"], source["bodies"], kept or {})
    ordered.update((key, value) for key, value in source.items() if key not in ordered)
    _complete_forces(ordered, scene)
    ordered["run"] = {"duration": _si(scene.duration, "s"), "tolerance": scene.tolerance, **source.get("run", {})}
    ordered["lock"] = {
        "versions": versions(),
        **({DESIGN: scene.source[DESIGN]} if DESIGN in scene.source and not made else {}),
        "drawings": _digests(ordered["bodies"], folder or Path(), _bytes(scene, kept or {})),
    }
    return HEADER + toml_text(ordered)


def _undrawn(entry: dict[str, Any], made: frozenset[str]) -> dict[str, Any]:
    return {key: value for key, value in entry.items() if key != "drawing" or value not in made}


def versions() -> dict[str, str]:
    """Python and the packages that decide the numbers, as far as they are installed."""
    return dict(_installed())


@functools.cache
def _installed() -> Mapping[str, str]:
    """Looked up once: it means reading what every package says of itself."""
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
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
    for key, value in _start(body).items():
        full.setdefault(key, value)
    if "solids" not in full and body.motion != "fixed" and body.prescribed is None:
        full.setdefault("inertia", _si(body.inertia, "kg·m²"))
    return full


def _start(body: Body) -> dict[str, Any]:
    if body.motion == "free":
        return {"velocity": _pair(body.velocity[:2], "m/s"), "spin": _si(body.velocity[2], "rad/s")}
    if body.motion == "fixed" or body.prescribed is not None:
        return {}
    return {"velocity": _si(body.velocity[0], "rad/s" if body.motion == "pivot" else "m/s")}


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


def _travel(bodies: dict[str, Any], source: Mapping[str, Any], kept: Mapping[str, str]) -> None:
    """Names the drawings that travel with the text by where they will be."""
    for name, entry in bodies.items():
        drawing = source[name].get("drawing")
        if drawing is not None and drawing in kept:
            entry["drawing"] = kept[drawing]


def _bytes(scene: Scene, kept: Mapping[str, str]) -> dict[str, bytes]:
    return {there: scene.drawings[name] for name, there in kept.items()}


def _digests(bodies: dict[str, Any], folder: Path, known: Mapping[str, bytes]) -> dict[str, str]:
    names = dict.fromkeys(entry["drawing"] for entry in bodies.values() if "drawing" in entry)
    # The folder may not exist yet: `..` after it cannot be followed, only resolved in words.
    return {
        name: digest(known[name]) if name in known else file_digest(Path(os.path.normpath(folder / name))) for name in names
    }


def _si(value: float, unit: str) -> str:
    return f"{value!r} {unit}"


def _pair(values: tuple[float, ...], unit: str) -> list[str]:
    return [_si(value, unit) for value in values]
