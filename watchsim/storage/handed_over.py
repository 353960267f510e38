"""How does another process on this machine get an object with long arrays in it?

As a file without a name that holds it pickled, passed over a socket. Open files in it are passed as they are, and so are the
files in which arrays lie.
"""

from __future__ import annotations

import io
import os
import pickle
import socket
from array import array
from typing import IO, Any, NamedTuple

import numpy as np

from watchsim.storage.columns import Mapping, mapped, mapping

MOST_FILES = 64  # that go with one object
GIVEN = b"\0"  # what goes with the files: a socket cannot pass them alone


class Lost(OSError):
    """The other process has gone."""


def hand_over(line: socket.socket, value: object) -> None:
    """Pass `value`, which is pickled, to the process at the other end.

    OSError where there is none, where it has not taken over what waits already, or where memory or files are used up.
    """
    with memory_file() as file:
        files = [file]
        _Packer(file, files).dump(value)
        file.flush()
        numbers = array("i", [one.fileno() for one in files])
        # Not by `socket.send_fds`, which waits whatever it is told.
        line.sendmsg([GIVEN], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, numbers)], socket.MSG_DONTWAIT)


def take_over(line: socket.socket) -> Any:
    """What the other process passes next; waits for it. `Lost` where nothing will come."""
    words, numbers, _, _ = socket.recv_fds(line, len(GIVEN), MOST_FILES)
    files: list[IO[bytes]] = [os.fdopen(number, "r+b") for number in numbers]
    if not words:
        raise Lost("the other process has gone")
    try:
        files[0].seek(0)
        return _Unpacker(files[0], files).load()
    finally:
        for file in files:
            file.close()


def memory_file() -> IO[bytes]:
    """A new file without a name, in memory."""
    return os.fdopen(os.memfd_create("watchsim"), "w+b")


class Filed(NamedTuple):
    """Instead of an array: it is the beginning of a file that is passed, too."""

    number: int  # of the file among those passed
    kind: np.dtype[Any]
    shape: tuple[int, ...]


class _Packer(pickle.Pickler):
    """Leaves out files, and of arrays what lies in files."""

    def __init__(self, file: IO[bytes], files: list[IO[bytes]]) -> None:
        super().__init__(file, protocol=5)
        self._files = files

    def persistent_id(self, value: object) -> Filed | int | None:
        if isinstance(value, io.BufferedRandom):
            return self._passed(value)
        if isinstance(value, np.ndarray):
            content = mapping(value)
            if isinstance(content, Mapping) and content.begins(value):
                return Filed(self._passed(content.file), value.dtype, value.shape)
        return None

    def _passed(self, file: IO[bytes]) -> int:
        self._files.append(file)
        return len(self._files) - 1


class _Unpacker(pickle.Unpickler):
    def __init__(self, file: IO[bytes], files: list[IO[bytes]]) -> None:
        super().__init__(file)
        self._files = files

    def persistent_load(self, known: Filed | int) -> Any:
        number = known if isinstance(known, int) else known.number
        file = os.fdopen(os.dup(self._files[number].fileno()), "r+b")
        return file if isinstance(known, int) else mapped(file, known.shape[0], np.zeros((0, *known.shape[1:]), known.kind))
