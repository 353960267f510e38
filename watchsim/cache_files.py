"""Are the files of machine code those that were written?

Numba loads what it finds. A file that was cut short by a full disk or a power cut, or that something else has written, would
bring the process down, or be executed. So each file begins with the digest of the rest; where it does not fit, the file counts
as missing, and the function is compiled and written again.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

from watchsim.machine_code import MOVE

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
