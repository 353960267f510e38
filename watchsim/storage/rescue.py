"""Where do results go that cannot be written where they were to go?"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from watchsim.storage.write import write_folder


def write_elsewhere(name: str, fill: Callable[[Path], object], what: str) -> Path:
    """Write to the first place that can be written: here, at home, or among temporary files; OSError where none can."""
    refusals: list[str] = []
    for parent in second_places():
        target = parent / f"{name[:100]}-rescued-{time.strftime('%Y%m%d-%H%M%S')}-{os.urandom(2).hex()}"
        try:
            write_folder(target, fill, lambda _: False, what)
        except OSError as error:
            refusals.append(str(error))
        else:
            return target
    raise OSError("; ".join(refusals))


def second_places() -> Iterator[Path]:
    """Folders that may be writable, the nearest first."""
    found: dict[Path, None] = {}
    for find in (Path.cwd, Path.home, lambda: Path(tempfile.gettempdir())):
        try:
            found[find().resolve()] = None
        except (OSError, RuntimeError):
            continue
    yield from found
