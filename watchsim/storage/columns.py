"""How is a long array read from an archive without memory for all of it?

Unpacked piece by piece into a file without a name, and looked at there (see storage/columns.py).
"""

from __future__ import annotations

import contextlib
import math
import mmap
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

# Where do rows go that are more than memory should hold?
#
# Into files without a name: the system takes them away when the process ends, however it ends. They are read through the page
# cache, as arrays that are mapped; what was read can be let go again, so that it does not count as memory of the process.

IN_MEMORY = 32e6  # bytes of columns in memory before they are written out: minutes of a watch
NEXT = 4e6  # bytes that are written out together from then on
BLOCK = 1 << 16  # rows that are worked on at a time, where a column need not lie in memory

Arrays = Sequence[NDArray[Any]]


class Columns:
    """Columns that grow together, in memory; once there is a `folder`, no more than `most` bytes of them."""

    def __init__(self) -> None:
        self.folder: Path | None = None
        self.most = IN_MEMORY
        self.rows = 0
        self._parts: list[Arrays] = []  # in memory, behind what is in the files
        self._held = 0
        self._files: list[IO[bytes]] = []
        self._filed = 0  # rows in the files

    def append(self, arrays: Arrays) -> None:
        """Put copies of the arrays, one per column and of one length, behind what is there."""
        copies = [np.array(array, order="C") for array in arrays]
        self._parts.append(copies)
        self.rows += len(copies[0])
        self._held += sum(array.nbytes for array in copies)
        if self.folder is not None and self._held > self.most and self._written(self._parts):
            self._filed, self._parts, self._held = self.rows, [], 0
            self.most = min(self.most, NEXT)

    def all(self, behind: Sequence[Arrays] = ()) -> list[NDArray[Any]]:
        """Every column as one array, with what is given behind it; mapped where there are files."""
        parts = [*self._parts, *behind]
        count = self._filed + sum(len(part[0]) for part in parts)
        if self._filed and self._written(parts):
            return [mapped(file, count, like) for file, like in zip(self._files, self._likes, strict=True)]
        if self._filed:  # the disk is full: what is not in the files must be in memory
            before = [mapped(file, self._filed, like) for file, like in zip(self._files, self._likes, strict=True)]
            parts = [before, *parts]
        return [np.concatenate([part[k] for part in parts]) for k in range(len(parts[0]))] if parts else []

    def _written(self, parts: Sequence[Arrays]) -> bool:
        """Write the parts behind what is in the files; False where that fails: from then on all is held in memory."""
        try:
            if not self._files:
                self._files = [tempfile.TemporaryFile(dir=self.folder) for _ in parts[0]]  # noqa: SIM115 - as long as this is
                self._likes = [array[:0] for array in parts[0]]
            for k, (file, like) in enumerate(zip(self._files, self._likes, strict=True)):
                file.seek(self._filed * like.dtype.itemsize * math.prod(like.shape[1:]))
                for part in parts:
                    file.write(np.ascontiguousarray(part[k]).reshape(-1).view(np.uint8).data)
                file.flush()
        except OSError:
            self.most = math.inf
            return False
        return True


def one_behind_the_other(first: Arrays, second: Arrays, folder: Path | None) -> Arrays:
    """Of each column the second behind the first; in files in `folder`, where there is one and they are long."""
    columns = Columns()
    columns.folder = folder
    for arrays in (first, second):
        for part in blocks(*arrays):
            columns.append(part)
    return columns.all() or first


def mapped(file: IO[bytes], rows: int, like: NDArray[Any]) -> NDArray[Any]:
    """The first rows of a file as an array; `like` has its type and width."""
    shape = (rows, *like.shape[1:])
    length = math.prod(shape) * like.dtype.itemsize
    if not length:
        return np.zeros(shape, like.dtype)
    return np.frombuffer(Mapping.of(file, length), like.dtype).reshape(shape)


class Mapping(mmap.mmap):
    """The first bytes of a file, to be read."""

    file: IO[bytes]

    @classmethod
    def of(cls, file: IO[bytes], length: int) -> Mapping:
        """Of a file that is open as long as it is looked into."""
        made = cls(file.fileno(), length, access=mmap.ACCESS_READ)
        made.file = file
        return made

    def begins(self, array: NDArray[Any]) -> bool:
        """True for an array that is the beginning of the file, row by row."""
        start = np.frombuffer(self, np.uint8).__array_interface__["data"][0]
        return bool(array.flags.c_contiguous and array.__array_interface__["data"][0] == start and array.nbytes <= len(self))


def mapping(array: NDArray[Any]) -> mmap.mmap | None:
    """The mapping that an array looks into, however often it was sliced; None for one in memory."""
    base: Any = array
    while base is not None and not isinstance(base, mmap.mmap):
        base = base.obj if isinstance(base, memoryview) else getattr(base, "base", None)
    return base


def is_mapped(array: NDArray[Any]) -> bool:
    """True for an array that lies in a file."""
    return mapping(array) is not None


def blocks(*arrays: NDArray[Any], length: int = BLOCK) -> Iterator[tuple[NDArray[Any], ...]]:
    """The arrays piece by piece, in step; each piece is let go when the next one is requested."""
    for first in range(0, len(arrays[0]), length):
        yield tuple(array[first : first + length] for array in arrays)
        let_go(*arrays)


def rows_where(array: NDArray[Any], is_wanted: Callable[[NDArray[Any]], NDArray[np.bool_]]) -> NDArray[Any]:
    """The rows for which `is_wanted` is true: of a mapped array a piece at a time is in memory."""
    found = [part[is_wanted(part)] for (part,) in blocks(array)]
    return np.concatenate(found) if found else array[:0]


def let_go(*arrays: NDArray[Any]) -> None:
    """Have what was read of mapped arrays count no longer as memory of this process; it is read again where it is needed."""
    for each in arrays:
        content = mapping(each)
        if content is not None and hasattr(content, "madvise") and hasattr(mmap, "MADV_DONTNEED"):
            with contextlib.suppress(OSError, ValueError):
                content.madvise(mmap.MADV_DONTNEED)


# Where does a text go that is longer than memory should hold?
#
# Into a file without a name, once it is long (see storage/columns.py).

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


def unpacked(archive: np.lib.npyio.NpzFile, name: str, folder: Path) -> NDArray[Any]:
    """Member `name` of an open npz archive; where it is long, mapped from a file without a name.

    The file lies in `folder`, where it can be written and has the room, else among the temporary ones, else there is none.
    ValueError, zipfile.BadZipFile and the like for a damaged member.
    """
    member, file = f"{name}.npy", archive.zip
    if file is None or member not in file.namelist() or file.getinfo(member).file_size <= IN_MEMORY:
        return np.asarray(archive[name])
    for place in (folder, None):
        with contextlib.suppress(OSError), file.open(member) as packed:
            read = npy.read_array_header_1_0 if npy.read_magic(packed) == (1, 0) else npy.read_array_header_2_0
            shape, by_columns, kind = read(packed)  # type: ignore[no-untyped-call, unused-ignore]
            size = packed.tell() + math.prod(shape) * kind.itemsize
            if by_columns or kind.hasobject or file.getinfo(member).file_size != size:
                break  # not written here: for numpy to read or to refuse
            with tempfile.TemporaryFile(dir=place) as unnamed:  # the mapping holds it open
                shutil.copyfileobj(packed, unnamed, PIECE)
                unnamed.flush()
                return mapped(unnamed, shape[0], np.zeros((0, *shape[1:]), kind))
    return np.asarray(archive[name])
