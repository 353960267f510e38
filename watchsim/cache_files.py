"""Are the files of machine code those that were written?

Numba loads what it finds. A file that was cut short by a full disk or a power cut, or that something else has written, would
bring the process down, or be executed. So each file begins with the digest of the rest; where it does not fit, the file counts
as missing, and the function is compiled and written again.
"""

from __future__ import annotations

import hashlib
import pickle
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from watchsim.machine_code import MOVE

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
