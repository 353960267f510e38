"""How is a long array read from an archive without memory for all of it?

Unpacked piece by piece into a file without a name, and looked at there (see storage/columns.py).
"""

from __future__ import annotations

import contextlib
import math
import tempfile
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from watchsim.storage import columns

PIECE = 1 << 20  # bytes that are unpacked at a time


def unpacked(archive: np.lib.npyio.NpzFile, name: str, folder: Path) -> NDArray[Any]:
    """Member `name` of an open npz archive; where it is long, mapped from a file without a name.

    The file lies in `folder`, where it can be written and has the room, else among the temporary ones, else there is none.
    ValueError, zipfile.BadZipFile and the like for a damaged member.
    """
    member, file = f"{name}.npy", archive.zip
    if file is None or member not in file.namelist() or file.getinfo(member).file_size <= columns.MOST:
        return np.asarray(archive[name])
    for place in (folder, None):
        with contextlib.suppress(OSError), file.open(member) as packed:
            shape, by_columns, kind = _header(packed)
            if by_columns or kind.hasobject or file.getinfo(member).file_size != packed.tell() + _bytes(shape, kind):
                break  # not written here: for numpy to read or to refuse
            return _moved(packed, place, shape, kind)
    return np.asarray(archive[name])


def _header(packed: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether column by column, and type."""
    version = npy.read_magic(packed)
    read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    return read(packed)  # type: ignore[no-any-return, no-untyped-call, unused-ignore]


def _bytes(shape: tuple[int, ...], kind: np.dtype[Any]) -> int:
    return math.prod(shape) * kind.itemsize


def _moved(packed: IO[bytes], place: Path | None, shape: tuple[int, ...], kind: np.dtype[Any]) -> NDArray[Any]:
    with tempfile.TemporaryFile(dir=place) as file:  # the mapping holds it open
        while piece := packed.read(PIECE):
            file.write(piece)
        file.flush()
        return columns.mapped(file, shape[0], np.zeros((0, *shape[1:]), kind))
