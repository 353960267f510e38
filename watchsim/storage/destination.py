"""How does a file that is made without a name get one?

The system takes it away should the process end before. Linux can give it a name as it is; elsewhere it is copied.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO

from watchsim.storage.write import real, reason, scratch_in, size_text, sweep, write_bytes, write_folder

# Can what is about to be computed be written where it is to go?
#
# Worth knowing in the first second, not after a night. Everything is tried that can be tried without touching what is there.

LEAST_ROOM = 4_000_000  # bytes: a small run with its plots
PROBE = bytes(65536)
DEEPEST = ("plots", "kinematics.png")  # the longest path that a results folder holds


def secure_folder(target: Path, what: str, room: float = LEAST_ROOM) -> list[str]:
    """OSError where `what` cannot be written to the folder `target`, with the cure; says what was cleared up there."""
    place = _looked_up(target, what)
    if place.exists() and not place.is_dir():
        raise FileExistsError(f"{target} is a file; {what} need a folder of their own")
    _make_parent(target, place)
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
    _make_parent(target, place)
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
        target.stat()
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise OSError(
                f"{target} is a link to {target.readlink()}, which leads back to it: {what} would go nowhere"
            ) from error
    place = real(target)
    if not place.exists():
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


def _make_parent(target: Path, place: Path) -> None:
    """The folders above the place; OSError where one of them cannot be made."""
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise FileNotFoundError(f"{target}: the folder {place.parent} is a file, not a folder") from error
    except OSError as error:
        raise type(error)(
            f"{target}: the folder {place.parent} cannot be made: {reason(error)}. Choose another place"
        ) from error


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


# Where do results go that cannot be written where they were to go?


def write_elsewhere(name: str, fill: Callable[[Path], object], what: str) -> Path:
    """Write to the first place that can be written: here, at home, or among temporary files; OSError where none can."""
    refusals: list[str] = []
    for parent in second_places():
        target = parent / f"{name[:100]}-rescued-{time.strftime('%Y%m%d-%H%M%S')}-{os.urandom(2).hex()}"
        try:
            write_folder(target, fill, lambda _: False, what)
        except OSError as error:
            refusals.append(str(error))
        else:
            return target
    raise OSError("; ".join(refusals))


def second_places() -> Iterator[Path]:
    """Folders that may be writable, the nearest first."""
    found: dict[Path, None] = {}
    for find in (Path.cwd, Path.home, lambda: Path(tempfile.gettempdir())):
        try:
            found[find().resolve()] = None
        except (OSError, RuntimeError):
            continue
    yield from found


PIECE = 1 << 20  # bytes that are copied at a time


def nameless(folder: Path) -> IO[bytes]:
    """A new file in the file system of `folder`, for writing and reading."""
    if hasattr(os, "O_TMPFILE"):
        try:
            return os.fdopen(os.open(folder, os.O_TMPFILE | os.O_RDWR, 0o666), "w+b")
        except OSError:  # not every file system can do that
            pass
    return tempfile.TemporaryFile(dir=folder)


def give_name(file: IO[bytes], path: Path) -> None:
    """Have the content of the file in `path`, which must not exist yet. OSError where that fails."""
    file.flush()
    if not _linked(file, path):
        file.seek(0)
        with path.open("wb") as copy:
            shutil.copyfileobj(file, copy, PIECE)


def _linked(file: IO[bytes], path: Path) -> bool:
    """Give it the name itself; False where that cannot be done."""
    if not hasattr(os, "O_TMPFILE"):
        return False
    try:
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            # With a folder given, the system follows the link in /proc to the file.
            os.link(f"/proc/self/fd/{file.fileno()}", path.name, dst_dir_fd=folder, follow_symlinks=True)
        finally:
            os.close(folder)
    except (OSError, NotImplementedError):
        return False
    return True
