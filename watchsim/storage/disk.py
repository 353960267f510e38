"""What must be on the disk before the next step may be taken?

A rename may reach the disk before the bytes of what was renamed: after a power cut there would be an empty file under the final
name. So everything is synchronised first.
"""

from __future__ import annotations

import contextlib
import errno
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

AT_ONCE = 8  # files
CANNOT = (errno.EINVAL, errno.ENOTSUP, errno.EACCES, errno.EPERM, errno.EBADF, errno.EISDIR)


def write_bytes(path: Path, content: bytes) -> None:
    """Write one small file and see it onto the disk."""
    with path.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def sync_tree(folder: Path, files: bool = True) -> None:
    """See every file below `folder`, and the folders that name them, onto the disk; OSError where that fails."""
    places = [(Path(place), names) for place, _, names in os.walk(folder, topdown=False)]
    found = [place / name for place, names in places for name in (names if files else ())]
    with ThreadPoolExecutor(AT_ONCE) as threads:  # a disk takes many at once in the time of a few
        list(threads.map(sync_file, (path for path in found if not path.is_symlink())))
    for place, _ in places:
        sync_folder(place)


def sync_file(path: Path) -> None:
    """See the bytes of a file onto the disk."""
    # Windows synchronises only what is open for writing.
    number = os.open(path, os.O_RDWR if os.name == "nt" else os.O_RDONLY)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def sync_folder(folder: Path) -> None:
    """See the names in `folder` onto the disk, where the system can do that with a folder."""
    if os.name == "nt":
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(number)
    except OSError as error:
        if error.errno not in CANNOT:
            raise
    finally:
        os.close(number)


def sync_name(path: Path) -> None:
    """See a name that has just been given onto the disk; what was renamed is there in any case, so a failure counts nothing."""
    with contextlib.suppress(OSError):
        sync_folder(path.parent)


def reason(error: OSError) -> str:
    """Why, in the system's words, without its number."""
    return error.strerror or str(error) or type(error).__name__


def size_text(count: float) -> str:
    """Bytes for people: "12 MB"."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000.0:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} TB"
