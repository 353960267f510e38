"""How is a file or a folder written whole or not at all?

It is made in a scratch folder beside its destination, seen onto the disk, and renamed. What stood there before stays untouched
until then. Replacing a folder takes two renames; if the process dies between them, the next command finishes what was begun.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import IO

from watchsim import stopping

# What must be on the disk before the next step may be taken?
#
# A rename may reach the disk before the bytes of what was renamed: after a power cut there would be an empty file under the
# final name. So everything is synchronised first.

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


# Where is something made before it gets its name, and who clears up after a process that was killed?
#
# In a folder beside the destination with a name that nobody else has. Its maker holds a lock in it, which the system lets go
# when the process ends, however it ends: a scratch folder whose lock is free belongs to nobody. Process numbers would not do:
# in containers they repeat.

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


Ours = Callable[[str], bool]  # of a path in the folder, with slashes: is it a file of ours, which may be replaced?


MARKS = (
    "summary.json",
    "trajectory.npz",
    "rows.jsonl",
    "sweep.json",
    "export.json",
    "bench.json",
    "incline.png",
)  # of our folders


def real(path: Path) -> Path:
    """Where to write: what a link points to, so that it stays a link.

    PermissionError for a file that is a link out of its folder, and for any link out of a folder of results: the folder may
    come from somebody else, who could have put the link there to have another file overwritten.
    """
    path = _without_dots(path.absolute())
    file = path.is_symlink() and not path.is_dir()
    for folder in path.parents:
        received = any(os.path.lexists(folder / name) for name in MARKS)
        if (received or (file and folder == path.parent)) and not _ends_in(folder, path):
            link = next(one for one in (path, *path.parents) if one.is_symlink())
            raise PermissionError(
                f"{link} is a link out of the {'results ' if received else ''}folder {folder}, which nothing is written "
                "through. Remove the link, or choose another place"
            )
    return path.resolve() if path.is_symlink() else path


def _without_dots(path: Path) -> Path:
    """The path with everything before its last `..` looked up: that way one named on purpose leads out of a folder."""
    kept = len(path.parts) - path.parts[::-1].index("..") if ".." in path.parts else 0
    return Path(os.path.realpath(Path(*path.parts[:kept])), *path.parts[kept:]) if kept else path


def _ends_in(folder: Path, path: Path) -> bool:
    """Whether a path in a folder is in it, too, when links are followed."""
    try:
        return folder.resolve() in path.resolve().parents
    except (OSError, RuntimeError):  # links in a circle
        return False


def write_file(target: Path, fill: Callable[[Path], object], what: str) -> None:
    """Let `fill` write a file whose name ends like that of `target`, and put it in the place of `target`.

    Missing folders are made.

    OSError where that fails, with `what` could not be written: what was there before is then still there, and nothing else.
    """
    place = real(target)
    with _explained(what, target):
        place.parent.mkdir(parents=True, exist_ok=True)
    with _explained(what, target), scratch_in(place.parent) as scratch:
        scratch.new.mkdir()
        made = scratch.new / f"file{place.suffix.lower()}"
        fill(made)
        sync_tree(scratch.new)
        made.replace(place)
    sync_name(place)


def write_folder(target: Path, fill: Callable[[Path], object], ours: Ours, what: str) -> None:
    """Let `fill` write into a new folder and put it in the place of `target`; files of an old one that are not `ours` are kept.

    OSError where the disk is full or the place not writable, with `what` could not be written: what was there before is then
    still there, and nothing else.
    """
    place = real(target)
    with _explained(what, target), scratch_in(place.parent) as scratch:
        scratch.new.mkdir()
        fill(scratch.new)
        sync_tree(scratch.new)
        if place.is_dir():
            _take_along(place, scratch.new, ours)
            sync_tree(scratch.new, files=False)
            shutil.copymode(place, scratch.new)
        _note(scratch, place)
        _exchange(scratch, place, ours)
    sync_name(place)


@contextlib.contextmanager
def _explained(what: str, target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        words = f"could not write {what} to {target}: {reason(error)}; nothing was changed"
        raise type(error)(error.errno, words) from error


def _take_along(old: Path, new: Path, ours: Ours) -> None:
    """Put into `new` what `old` holds that is not ours and not there yet, without copying where links will do."""
    for place, folders, names in os.walk(old):
        here = Path(place)
        links = [name for name in folders if (here / name).is_symlink()]
        for name in (*names, *links):
            path = (here / name).relative_to(old)
            other = new / path
            if not ours(path.as_posix()) and not os.path.lexists(other):
                other.parent.mkdir(parents=True, exist_ok=True)
                _same_file(here / name, other)
        if not folders and not names and not ours(here.relative_to(old).as_posix()):
            (new / here.relative_to(old)).mkdir(parents=True, exist_ok=True)


def _same_file(item: Path, other: Path) -> None:
    try:
        os.link(item, other, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(item, other, follow_symlinks=False)
        if not other.is_symlink():
            sync_file(other)


def _note(scratch: Scratch, place: Path) -> None:
    """Write down that `new` is complete and what for: from here on it outlives the process."""
    known = place.stat().st_ino if place.exists() else None
    begun = scratch.journal.with_suffix(".begun")
    write_bytes(begun, json.dumps({"target": place.name, "replaces": known}).encode())
    begun.replace(scratch.journal)
    sync_folder(scratch.place)


def _exchange(scratch: Scratch, place: Path, ours: Ours) -> None:
    """Put the new folder in the place of the old one, which comes back where that fails half way."""
    with guard:
        if not place.exists():
            scratch.new.rename(place)
            return
        place.rename(scratch.old)
        scratch.recoverable = True  # if this process should be stopped before it is through
        try:
            scratch.new.rename(place)
        except BaseException:
            scratch.old.rename(place)
            scratch.recoverable = False
            raise
        sync_name(place)
        with contextlib.suppress(OSError):  # what somebody has put into the old folder since
            _take_along(scratch.old, place, ours)
        scratch.recoverable = False


def sweep(parent: Path) -> list[str]:
    """Clear up in `parent` what killed processes have left, and finish what they had begun; says what was brought back."""
    said = []
    for scratch in leftovers(parent):
        try:
            said += _recovered(scratch)
        except (OSError, ValueError, KeyError, TypeError) as error:
            if scratch.journal.exists() and (scratch.new.exists() or scratch.old.exists()):
                scratch.recoverable = True
                said.append(f"{scratch.place} holds what a killed process left, and it could not be brought back: {error}")
    return said


def _recovered(scratch: Scratch) -> list[str]:
    """Finish an exchange of folders that was begun; without a journal nothing in the scratch folder is complete."""
    if not scratch.journal.exists():
        return []
    journal = json.loads(scratch.journal.read_bytes())
    place = scratch.place.parent / Path(str(journal["target"])).name
    if not os.path.lexists(place):
        # Between the two renames: what is new is complete, and holds what was not ours of the old.
        (scratch.new if scratch.new.is_dir() else scratch.old).rename(place)
        return [f"{place}: brought back after a process was killed while it replaced this folder."]
    if scratch.new.is_dir() and not scratch.old.exists() and place.is_dir() and place.stat().st_ino == journal["replaces"]:
        place.rename(scratch.old)
        try:
            scratch.new.rename(place)
        except OSError:
            scratch.old.rename(place)
            raise
        return [f"{place}: replaced, as a killed process was about to do."]
    return []
