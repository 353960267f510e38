"""What must travel with results, so that they can be read anywhere and at any time?

The completed scene and its drawings as they were read, byte by byte: a results folder that is moved, mailed, or older than
the drawing it was made from still holds what was simulated.
"""

from __future__ import annotations

from pathlib import Path, PurePath

from watchsim.mechanism.lock import lock_text
from watchsim.mechanism.parsed import parsed
from watchsim.mechanism.scene import Scene

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
