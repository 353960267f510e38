"""Where is the machine code of the kernels kept?

A cached kernel does not notice when a function it calls in another file changes, so the folder carries a digest of every
source a kernel can reach: after an edit there the kernels are compiled anew. `WATCHSIM_CACHE` names another folder. What lies
there is executed, so nobody else may be able to put something there.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import platform
import re
import stat
import sys
import time
from collections.abc import Iterable
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
VARIABLE = "WATCHSIM_CACHE"
MOVE = f"The environment variable {VARIABLE} names another folder."
DIGESTS_KEPT = 3
IN_USE_SECONDS = 3600.0  # another process may be compiling into a folder it has just made
# Packages in which kernels are defined: to look for them in all files would take longer than loading their machine code.
WITH_KERNELS = ("candidates", "contact", "dynamics", "escapement", "simulation", "verification")
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
    if asked := os.environ.get(VARIABLE):
        return Path(asked).expanduser().absolute()
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
