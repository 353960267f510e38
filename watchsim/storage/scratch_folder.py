"""Where is something made before it gets its name, and who clears up after a process that was killed?

In a folder beside the destination with a name that nobody else has. Its maker holds a lock in it, which the system lets go
when the process ends, however it ends: a scratch folder whose lock is free belongs to nobody. Process numbers would not do:
in containers they repeat.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from watchsim import stopping

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

PREFIX = ".watchsim-"
LOCK, NEW, OLD, JOURNAL = "lock", "new", "old", "journal.json"
ABANDONED = 86400.0  # s after which a scratch folder belongs to nobody, where the system knows no locks
ATTEMPTS = 100

PATIENCE = 5.0  # s that an exchange of folders may take before a process that is to end at once leaves it as it is

_live: dict[Path, Scratch] = {}
# Held by whoever puts one folder in the place of another, or makes a scratch folder, and for good by a process that leaves.
guard = threading.Lock()


class Scratch:
    """A folder of one's own in `parent`; `new` is where to write."""

    def __init__(self, place: Path, lock: IO[bytes] | None) -> None:
        self.place, self._lock = place, lock
        self.new, self.old, self.journal = place / NEW, place / OLD, place / JOURNAL
        self.recoverable = False  # what it holds is complete and must outlive the process

    def close(self) -> None:
        """Take it away, the lock last: nobody else looks into it before."""
        self.clear()
        _live.pop(self.place, None)
        if self._lock is not None:
            self._lock.close()

    def clear(self) -> None:
        """Remove all it holds, and itself."""
        shutil.rmtree(self.new, ignore_errors=True)
        shutil.rmtree(self.old, ignore_errors=True)
        for path in (self.journal, self.place / LOCK):
            with contextlib.suppress(OSError):
                path.unlink()
        shutil.rmtree(self.place, ignore_errors=True)

    def leave(self) -> None:
        """Let go of it as it is, for somebody later."""
        _live.pop(self.place, None)
        if self._lock is not None:
            self._lock.close()


def make(parent: Path) -> Scratch:
    """A new scratch folder in `parent`; OSError where there can be none."""
    for _ in range(ATTEMPTS):
        with guard:
            place = Path(tempfile.mkdtemp(prefix=PREFIX, dir=parent))
            try:
                lock = _taken(place / LOCK)
            except OSError as error:
                shutil.rmtree(place, ignore_errors=True)
                if isinstance(error, FileNotFoundError):
                    continue  # somebody who was clearing up took it for a leftover before it was locked
                raise
            scratch = Scratch(place, lock)
            _live[place] = scratch
            return scratch
    raise OSError(f"no scratch folder could be made in {parent}")


@contextlib.contextmanager
def scratch_in(parent: Path) -> Iterator[Scratch]:
    """A scratch folder for as long as it is needed."""
    scratch = make(parent)
    try:
        yield scratch
    finally:
        if scratch.recoverable:
            scratch.leave()
        else:
            scratch.close()


def leftovers(parent: Path) -> Iterator[Scratch]:
    """The scratch folders in `parent` whose makers are gone; each is taken away afterwards unless marked as recoverable."""
    try:
        with os.scandir(parent) as entries:
            places = [Path(entry.path) for entry in entries if entry.name.startswith(PREFIX) and _is_own(entry)]
    except OSError:
        return
    for place in places:
        scratch = None if place in _live else _claimed(place)
        if scratch is not None:
            yield scratch
            if scratch.recoverable:
                scratch.leave()
            else:
                scratch.close()


def _claimed(place: Path) -> Scratch | None:
    """The scratch folder, if its maker is gone."""
    try:
        lock = _taken(place / LOCK, existing=True)
    except FileNotFoundError:
        # Its maker was killed before there was a lock, or is about to make one, and tries again where the folder is gone.
        with contextlib.suppress(OSError):
            place.rmdir()
            return None
        lock = None
    except OSError:  # its maker is alive
        return None
    if lock is None and not _is_abandoned(place):
        return None
    return Scratch(place, lock)


def _is_own(entry: os.DirEntry[str]) -> bool:
    """True for a folder of this user: another one's journal could name any target."""
    if not entry.is_dir(follow_symlinks=False):
        return False
    return not hasattr(os, "getuid") or entry.stat(follow_symlinks=False).st_uid == os.getuid()


def _taken(path: Path, existing: bool = False) -> IO[bytes] | None:
    """The lock, held until it is closed; None where the system knows none. BlockingIOError where somebody holds it."""
    file = path.open("rb+" if existing else "xb+")
    if fcntl is None:
        file.close()
        return None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        if isinstance(error, BlockingIOError):
            raise
        return None  # a file system without locks
    if not path.exists():
        file.close()
        raise FileNotFoundError(path)
    return file


def _is_abandoned(place: Path) -> bool:
    with contextlib.suppress(OSError):
        return time.time() - place.stat().st_mtime > ABANDONED
    return False


@stopping.before_leaving
def abandon() -> None:
    """Take away the scratch folders of this process, as it leaves at once; what is complete stays for the next command."""
    if not guard.acquire(timeout=PATIENCE):
        return
    for scratch in list(_live.values()):
        for _ in range(ATTEMPTS):  # the main thread may still be writing into it
            if scratch.recoverable or not scratch.place.exists():
                break
            scratch.clear()
