"""Where is the machine code of the kernels kept?

A cached kernel does not notice when a function it calls in another file changes, so the folder carries a digest of every
source a kernel can reach: after an edit there the kernels are compiled anew. `WATCHSIM_CACHE` names another folder.
"""

from __future__ import annotations

import functools
import hashlib
import os
import platform
import re
import sys
import time
from collections.abc import Iterable
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
DIGESTS_KEPT = 3
IN_USE_SECONDS = 3600.0  # another process may be compiling into a folder it has just made
_KERNELS = re.compile(r"^from watchsim\.jit import .*\b(?:kernel|entry)\b", re.MULTILINE)
# At the top of a file: what a function imports for itself, no kernel reaches.
_IMPORT = re.compile(r"^from (watchsim(?:\.\w+)*) import \(?([\w, ]*)", re.MULTILINE)


@functools.lru_cache(maxsize=1)
def cache_folder() -> Path:
    """The writable folder that holds the machine code of exactly these sources; made if need be."""
    key = source_digest(PACKAGE)
    for base in (_user_folder(), _temporary_folder()):
        folder = base / "kernels" / key
        if _is_usable(folder):
            _forget_old(folder)
            return folder
    import tempfile

    return Path(tempfile.mkdtemp(prefix="watchsim-"))


def source_digest(package: Path) -> str:
    """Digest of where `package` is, of every source a kernel in it can reach, and of the versions that compile it."""
    from importlib.metadata import version

    versions = (platform.python_version(), platform.machine(), version("numba"), version("numpy"))
    digest = hashlib.sha256(" ".join((str(package), *versions)).encode())
    for path in _reachable_sources(package):
        digest.update(str(path.relative_to(package)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _reachable_sources(package: Path) -> list[Path]:
    """The files that define kernels and all they import from the package, sorted."""
    texts = {path: path.read_text(encoding="utf-8") for path in package.rglob("*.py")}
    waiting = [path for path, text in texts.items() if _KERNELS.search(text)]
    reached: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in reached:
            reached.add(path)
            waiting.extend(found for found in _imported(package, texts[path]) if found in texts)
    return sorted(reached)


def _imported(package: Path, text: str) -> Iterable[Path]:
    """The files that `from watchsim.x import y` may mean: x.py or x/__init__.py; of the package itself, y.py."""
    for name, wanted in _IMPORT.findall(text):
        stem = package.joinpath(*name.split(".")[1:])
        if stem == package:
            yield from (package / f"{each.strip()}.py" for each in wanted.split(","))
        else:
            yield stem.with_suffix(".py")
            yield stem / "__init__.py"


def _user_folder() -> Path:
    """Where this user's caches live: WATCHSIM_CACHE, or the platform's custom."""
    if asked := os.environ.get("WATCHSIM_CACHE"):
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


def _is_usable(folder: Path) -> bool:
    """Make the folder; True if it can be written and nobody else could have put code there for us to load."""
    import tempfile

    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        tempfile.TemporaryFile(dir=folder).close()
        os.utime(folder)
    except OSError:
        return False
    return not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()


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
