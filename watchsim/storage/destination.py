"""Can what is about to be computed be written where it is to go?

Worth knowing in the first second, not after a night. Everything is tried that can be tried without touching what is there.
"""

from __future__ import annotations

import os
import shutil
import stat
from pathlib import Path

from watchsim.storage.disk import reason, size_text, write_bytes
from watchsim.storage.scratch_folder import scratch_in
from watchsim.storage.write import real, sweep

LEAST_ROOM = 4_000_000  # bytes: a small run with its plots
PROBE = bytes(65536)
DEEPEST = ("plots", "kinematics.png")  # the longest path that a results folder holds


def secure_folder(target: Path, what: str, room: float = LEAST_ROOM) -> list[str]:
    """OSError where `what` cannot be written to the folder `target`, with the cure; says what was cleared up there."""
    place = _looked_up(target, what)
    if place.exists() and not place.is_dir():
        raise FileExistsError(f"{target} is a file; {what} need a folder of their own")
    _check_parent(target, place)
    said = sweep(place.parent)
    if place.is_dir():
        said += sweep(place)
        _check_replaceable(target, place)
    _look(place.joinpath(*DEEPEST), target)
    _try(target, place, what, room)
    return said


def secure_file(target: Path, what: str, room: float = 0.0) -> list[str]:
    """OSError where `what` cannot be written to the file `target`, with the cure; says what was cleared up there."""
    place = _looked_up(target, what)
    if place.is_dir():
        raise IsADirectoryError(f"{target} is a folder; {what} needs the name of a file in it")
    _check_parent(target, place)
    said = sweep(place.parent)
    if place.exists() and not os.access(place, os.W_OK):
        raise PermissionError(f"{target} exists and is write-protected. Choose another name")
    _try(target, place, what, room)
    return said


def _looked_up(target: Path, what: str) -> Path:
    """Where a link leads, else the path itself."""
    _look(target.absolute(), target)
    if not target.is_symlink():
        return real(target)
    try:
        place = real(target)
        exists = place.exists()
    except PermissionError:
        raise
    except (OSError, RuntimeError):  # links in a circle
        exists = False
    if not exists:
        raise FileNotFoundError(f"{target} is a link to {target.readlink()}, which does not exist: {what} would go nowhere")
    return place


def _look(path: Path, target: Path) -> None:
    """OSError where the system cannot even look for such a path: a name too long, a file where a folder should be."""
    try:
        os.lstat(path)
    except FileNotFoundError:
        return
    except OSError as error:
        raise type(error)(f"{target}: cannot be written: {reason(error)}. Choose another place") from error


def _check_parent(target: Path, place: Path) -> None:
    parent = place.parent
    if not parent.is_dir():
        there = "is a file, not a folder" if parent.exists() else "does not exist; create it first"
        raise FileNotFoundError(f"{target}: the folder {parent} {there}")


def _check_replaceable(target: Path, place: Path) -> None:
    """What exists must make room for what is new when that is complete: by renaming."""
    if os.path.ismount(place):
        raise OSError(f"{target} is a mount point, which cannot be replaced. Name a folder in it, such as {target / 'run'}")
    if not hasattr(os, "getuid") or os.getuid() == 0:
        return
    parent, own = place.parent.stat(), os.getuid()
    foreign = own not in (place.stat().st_uid, parent.st_uid) and parent.st_mode & stat.S_ISVTX
    if foreign or not os.access(place, os.W_OK | os.X_OK):
        raise PermissionError(f"{target} belongs to another user, or is write-protected. Choose another folder")


def _try(target: Path, place: Path, what: str, room: float) -> None:
    """Make what will be made, small, and take it away again."""
    try:
        free = shutil.disk_usage(place.parent).free
        with scratch_in(place.parent) as scratch:
            write_bytes(scratch.new, PROBE)
    except OSError as error:
        words = f"{target}: nothing can be written to {place.parent}: {reason(error)}. Choose another place"
        raise type(error)(words) from error
    if free < room:
        raise OSError(
            f"{target}: {what} may need {size_text(room)}, and only {size_text(free)} are free on the disk of {place.parent}. "
            "Make room, or choose another place"
        )
