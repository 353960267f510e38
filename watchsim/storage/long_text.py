"""Where does a text go that is longer than memory should hold?

Into a file without a name, once it is long (see storage/columns.py).
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from watchsim.storage.columns import Columns, blocks

PIECE = 1 << 20  # bytes that are copied at a time


class LongText:
    """A text made of pieces, in UTF-8; what is long lies in a file in `folder`, in memory where there is none."""

    def __init__(self, pieces: Iterable[str], folder: Path | None = None) -> None:
        columns = Columns()
        columns.folder = folder
        for piece in pieces:
            columns.append((np.frombuffer(piece.encode("utf-8", "replace"), np.uint8),))
        (self._bytes,) = columns.all() or [np.zeros(0, np.uint8)]

    @property
    def size(self) -> int:
        """Bytes."""
        return len(self._bytes)

    def __str__(self) -> str:
        return self._bytes.tobytes().decode()

    def write(self, path: Path) -> None:
        """Copy it to the file `path`."""
        with path.open("wb") as file:
            for (part,) in blocks(self._bytes, length=PIECE):
                file.write(part.tobytes())
