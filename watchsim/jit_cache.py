"""Are the files of machine code those that were written?

Numba loads what it finds. A file that was cut short by a full disk or a power cut, or that something else has written, would
bring the process down, or be executed. So each file begins with the digest of the rest; where it does not fit, the file counts
as missing, and the function is compiled and written again.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import pickle
import platform
import re
import stat
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import IO, Any

# Where is the machine code of the kernels kept?
#
# A cached kernel does not notice when a function it calls in another file changes, so the folder carries a digest of every
# source a kernel can reach: after an edit there the kernels are recompiled. `WATCHSIM_CACHE` names another folder. What
# lies there is executed, so nobody else may be able to put something there.

PACKAGE = Path(__file__).resolve().parent
VARIABLE = "WATCHSIM_CACHE"
MOVE = f"The environment variable {VARIABLE} names another folder."
DIGESTS_KEPT = 3
IN_USE_SECONDS = 3600.0  # another process may be compiling into a folder it has just made
# Packages in which kernels are defined: to look for them in all files would take longer than loading their machine code.
WITH_KERNELS = ("contact", "dynamics", "escapement", "simulation", "verification")
_JIT = b"from watchsim.jit import "  # quicker to look for
_KERNELS = re.compile(r"^from watchsim\.jit import .*\b(?:kernel|hot_kernel|entry)\b", re.MULTILINE)
# At the top of a file: what a function imports for itself, no kernel reaches.
_IMPORT = re.compile(r"^from (watchsim(?:\.\w+)*) import \(?([\w, ]*)", re.MULTILINE)


@functools.lru_cache(maxsize=1)
def cache_folder() -> Path | None:
    """The writable folder that holds the machine code of exactly these sources; made if need be. None where there is none."""
    key = source_digest(PACKAGE)
    refusals: list[str] = []
    for base, others_may_write in ((_user_folder(), True), (_temporary_folder(), False)):
        folder = base / "kernels" / key
        if not (refusal := _refusal(folder, others_may_write)):
            if refusals:
                complain(f"The machine code is kept in {folder}, because {refusals[0]}. {MOVE}")
            _forget_old(folder)
            return folder
        refusals.append(f"{folder} {refusal}")
    complain(f"The machine code is compiled each time, about a minute, because {' and '.join(refusals)}. {MOVE}")
    return None


@functools.lru_cache(maxsize=64)
def complain(words: str) -> None:
    """Say something about the cache on stderr, once."""
    with contextlib.suppress(OSError, ValueError):
        print(words, file=sys.stderr, flush=True)


def source_digest(package: Path) -> str:
    """Digest of where `package` is, of every source a kernel in it can reach, and of the versions that compile it."""
    from importlib.metadata import version

    versions = (platform.python_version(), platform.machine(), version("numba"), version("numpy"))
    digest = hashlib.sha256(" ".join((str(package), *versions)).encode())
    for path, source in _reachable_sources(package).items():
        digest.update(os.path.relpath(path, package).encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def _reachable_sources(package: Path) -> dict[str, bytes]:
    """The files that define kernels and all they import from the package, sorted, with what they hold."""
    # Paths as text: objects of `pathlib` would take most of the time.
    waiting = [path for name in WITH_KERNELS for path in _files(os.path.join(package, name)) if _defines_kernels(path)]  # noqa: PTH118
    reached: dict[str, bytes] = {}
    while waiting:
        path = waiting.pop()
        if path not in reached:
            reached[path] = _content(path)
            waiting.extend(found for found in _imported(package, reached[path].decode()) if os.path.isfile(found))  # noqa: PTH113
    return dict(sorted(reached.items()))


def _files(folder: str) -> Iterable[str]:
    """The sources in a folder and below."""
    for place, _, names in os.walk(folder):
        yield from (os.path.join(place, name) for name in names if name.endswith(".py"))  # noqa: PTH118


def _content(path: str) -> bytes:
    with open(path, "rb") as file:  # noqa: PTH123
        return file.read()


def _defines_kernels(path: str) -> bool:
    source = _content(path)
    return _JIT in source and _KERNELS.search(source.decode()) is not None


def _imported(package: Path, text: str) -> Iterable[str]:
    """The files that `from watchsim.x import y` may mean: x.py or x/__init__.py; of the package itself, y.py."""
    for name, wanted in _IMPORT.findall(text):
        stem = str(package) + name.removeprefix("watchsim").replace(".", os.sep)
        if stem == str(package):
            yield from (f"{stem}{os.sep}{each.strip()}.py" for each in wanted.split(","))
        else:
            yield f"{stem}.py"
            yield f"{stem}{os.sep}__init__.py"


def _user_folder() -> Path:
    """Where this user's caches live: WATCHSIM_CACHE, or the platform's custom."""
    if named := os.environ.get(VARIABLE):
        return Path(named).expanduser().absolute()
    home = Path(os.path.expanduser("~"))  # noqa: PTH111 - Path.home() raises where there is no home
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "watchsim"


def _temporary_folder() -> Path:
    """One per user, so that the machine code outlives the process even without a writable home."""
    import tempfile

    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    return Path(tempfile.gettempdir()) / f"watchsim-{user}"


def _refusal(folder: Path, others_may_write: bool) -> str:
    """Make the folder; why it cannot be used, "" if it can: it must be writable, and nobody else may put code there.

    Whether others could write to the folders above is left to the user where it is the user's own choice.
    """
    import tempfile

    try:
        _make(folder)
        tempfile.TemporaryFile(dir=folder).close()
        os.utime(folder)
        if hasattr(os, "getuid"):
            if folder.stat().st_uid != os.getuid() or folder.stat().st_mode & stat.S_IWOTH:
                return "belongs to another user"
            if not others_may_write and (open_to := _open_to_others(folder)):
                return f"lies in {open_to}, where others can write"
    except OSError as error:
        return f"cannot be written ({error.strerror or error})"
    return ""


def _make(folder: Path) -> None:
    """The folder and those above it that are missing, for this user alone."""
    if not folder.is_dir():
        if not folder.parent.is_dir():
            _make(folder.parent)
        folder.mkdir(exist_ok=True, mode=0o700)


def _open_to_others(folder: Path) -> Path | None:
    """The folder, or one above it, in which somebody else could exchange what is there; None where there is none.

    In a folder with the sticky bit, such as /tmp, everybody may only exchange his own.
    """
    for place in (folder, *folder.parents):
        about = place.stat(follow_symlinks=False)
        shared = about.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not about.st_mode & stat.S_ISVTX
        if shared or about.st_uid not in (0, os.getuid()):
            return place
    return None


def _forget_old(current: Path) -> None:
    """Delete the folders of earlier sources, except the newest and those some process may still be using."""
    import shutil

    try:
        folders = sorted(current.parent.iterdir(), key=lambda folder: folder.stat().st_mtime, reverse=True)
        stale = [folder for folder in folders[DIGESTS_KEPT:] if folder.stat().st_mtime < time.time() - IN_USE_SECONDS]
    except OSError:  # another process is tidying up at the same time
        return
    for folder in stale:
        shutil.rmtree(folder, ignore_errors=True)


try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

LOOK, UNMENTIONED = 0.1, 1.0  # s between looks at a lock; s that one waits without a word
SEAL = hashlib.sha256().digest_size


def checked_files(compiled: Any, complain: Callable[[str], None]) -> None:
    """Have the cache of a compiled function seal its files and check them."""
    cache = compiled._cache
    cache._cache_file.__class__ = _checked_class(type(cache._cache_file), complain)
    save = cache.save_overload

    def save_overload(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        except OSError as error:
            reason = error.strerror or error
            complain(f"The machine code cannot be kept in {cache.cache_path} ({reason}): compiled again next time. {MOVE}")

    cache.save_overload = save_overload


def one_compiles(compiled: Any, complain: Callable[[str], None]) -> None:
    """Have one process compile the function while others that need it wait for its machine code.

    The lock lasts no longer than whoever holds it. Where there are no locks each compiles for itself.
    """
    cache: Any = getattr(compiled, "_cache", None)
    if fcntl is None or not hasattr(getattr(cache, "_cache_file", None), "_index_path"):
        return
    load, save = cache.load_overload, cache.save_overload
    place = Path(cache._cache_file._index_path).with_suffix(".lock")
    held: list[IO[bytes]] = []

    def load_overload(signature: Any, target: Any) -> Any:
        found = load(signature, target)
        if found is not None or held:
            return found
        lock = _locked(place, complain)
        if lock is None:
            return None
        found = load(signature, target)  # whoever held the lock may have written it
        if found is None:
            held.append(lock)
        else:
            lock.close()
        return found

    def save_overload(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        finally:
            while held:
                held.pop().close()

    cache.load_overload, cache.save_overload = load_overload, save_overload


def _locked(place: Path, complain: Callable[[str], None]) -> IO[bytes] | None:
    """The lock, once it is free; None where there can be none."""
    try:
        file = place.open("ab")
    except OSError:
        return None
    waited = 0.0
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if waited > UNMENTIONED:
                complain("Another process is compiling the same part of the solver: waiting for it ...")
            time.sleep(LOOK)
            waited += LOOK
        except OSError:  # a file system without locks
            file.close()
            return None
        else:
            return file


def _checked_class(base: Any, complain: Callable[[str], None]) -> Any:
    class Checked(base):
        """Files of numba's cache with a seal."""

        def _load_index(self) -> Any:
            try:
                version, stamp, overloads = self._opened(self._index_path)
            except (OSError, TypeError, ValueError):
                return {}
            return overloads if (version, stamp) == (self._version, self._source_stamp) else {}

        def _save_index(self, overloads: Any) -> None:
            self._sealed(self._index_path, self._dump((self._version, self._source_stamp, overloads)))

        def _load_data(self, name: str) -> Any:
            return self._opened(self._data_path(name))

        def _save_data(self, name: str, data: Any) -> None:
            self._sealed(self._data_path(name), self._dump(data))

        def _opened(self, path: str) -> Any:
            content = Path(path).read_bytes()
            if hashlib.sha256(content[SEAL:]).digest() != content[:SEAL]:
                complain(f"{path} is damaged: compiled again. {MOVE}")
                raise FileNotFoundError(path)
            return pickle.loads(content[SEAL:])

        def _sealed(self, path: str, content: bytes) -> None:
            with self._open_for_write(path) as file:
                file.write(hashlib.sha256(content).digest() + content)

    return Checked
