"""What if the disk fails, or the process dies, at the n-th thing it does to a folder?

Counts every opening for writing, write, synchronisation, rename, link and removal below `root`; the n-th one fails, or ends
the process. `log` holds them all.
"""

import builtins
import contextlib
import errno
import io
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

WRITING = os.O_WRONLY | os.O_RDWR
AUDITED = ("os.rename", "os.mkdir", "os.link", "os.remove", "os.rmdir")


class Disk:
    """What happens to the files below `root`; the action numbered `failing` (from 1) fails by `how`."""

    def __init__(self, root: Path, failing: int = 0, how: Callable[[], None] | None = None, count: int = 1) -> None:
        self.root, self.failing, self.count = str(root), failing, count
        self.how = how or self._no_room
        self.log: list[tuple[str, ...]] = []
        self.failed = False

    def step(self, name: str, *paths: object) -> None:
        """One more action; what it fails with is raised here."""
        told = [os.fspath(path) for path in paths if isinstance(path, (str, os.PathLike))]
        if not told or not any(path.startswith(self.root) for path in told):
            return
        self.log.append((name, *told))
        if self.failing <= len(self.log) < self.failing + self.count and self.failing:
            self.failed = True
            self.how()

    @staticmethod
    def _no_room() -> None:
        raise OSError(errno.ENOSPC, "No space left on device")


_disk: Disk | None = None


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if _disk is None:
        return
    if event in AUDITED:
        _disk.step(event, *arguments[: 2 if event in ("os.rename", "os.link") else 1])
    elif event == "open" and isinstance(arguments[2], int) and arguments[2] & WRITING:
        _disk.step("open", arguments[0])


class _Raw(io.FileIO):
    def write(self, content: Any) -> int:
        if _disk is not None:
            _disk.step("write", self.name)
        return super().write(content)


def _opened(file: Any, mode: str = "r", buffering: int = -1, encoding: Any = None, errors: Any = None, newline: Any = None,
            closefd: bool = True, opener: Any = None) -> Any:  # fmt: skip
    if isinstance(file, int) or not set(mode) & set("wxa+"):
        return _open(file, mode, buffering, encoding, errors, newline, closefd, opener)
    raw = _Raw(file, mode.replace("b", "").replace("t", ""), closefd, opener)
    if buffering == 0:
        return raw
    buffer: Any = io.BufferedRandom(raw) if "+" in mode else io.BufferedWriter(raw)
    return buffer if "b" in mode else io.TextIOWrapper(buffer, encoding or "utf-8", errors, newline)


def _synced(number: int) -> None:
    if _disk is not None:
        _disk.step("fsync", Path(f"/proc/self/fd/{number}").readlink())
    _fsync(number)


_open, _fsync = io.open, os.fsync
sys.addaudithook(_audit)


@contextlib.contextmanager
def watched(disk: Disk) -> Iterator[Disk]:
    """Within, what is done below the disk's root counts."""
    global _disk  # noqa: PLW0603 - audit hooks stay for ever, so that one hook looks here
    io.open = builtins.open = _opened  # type: ignore[assignment]
    os.fsync = _synced  # type: ignore[assignment]
    _disk = disk
    try:
        yield disk
    finally:
        _disk = None
        io.open = builtins.open = _open
        os.fsync = _fsync


def killed_at(root: Path, number: int, work: Callable[[], object]) -> bool:
    """Do `work` in a process of its own that is killed at action `number`; True if it came so far."""
    child = os.fork()
    if child == 0:
        try:
            with watched(Disk(root, number, lambda: os.kill(os.getpid(), 9))):
                work()
        finally:
            os._exit(0)
    return os.WIFSIGNALED(os.waitpid(child, 0)[1])


def not_yet_on_disk(log: list[tuple[str, ...]], is_final: Callable[[str], bool]) -> list[str]:
    """What a power cut could leave empty under a final name: renamed before it was synchronised."""
    dirty: set[str] = set()
    found = []
    for name, *paths in log:
        if name == "fsync":
            dirty.discard(paths[0])
        elif name == "write":
            dirty.add(paths[0])
        elif name in ("open", "os.mkdir"):
            dirty |= {paths[0], str(Path(paths[0]).parent)}
        elif name == "os.rename":
            source, target = paths
            below = {path for path in dirty if path == source or path.startswith(source + "/")}
            if is_final(target):
                found += sorted(below)
            dirty = (dirty - below) | {target + path.removeprefix(source) for path in below}
            dirty |= {str(Path(source).parent), str(Path(target).parent)}
    return found
