"""How does a file that is made without a name get one?

The system takes it away should the process end before. Linux can give it a name as it is; elsewhere it is copied.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path
from typing import IO

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
