"""Where does a command write, and can it?"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from watchsim.commands.common.console import InputError, say
from watchsim.storage.destination import LEAST_ROOM, secure_file, secure_folder
from watchsim.storage.write import sweep


def secured_folder(folder: Path, what: str, room: float = LEAST_ROOM, default: bool = False) -> Path:
    """The folder, if it can be made or replaced; one that was not named (`default`) gets the folders above it."""
    if default:
        folder.parent.mkdir(parents=True, exist_ok=True)
    for line in secure_folder(folder, what, room):
        say(line)
    return folder


def secured_file(path: Path, what: str) -> Path:
    """The path, if a file can be written there."""
    for line in secure_file(path, what):
        say(line)
    return path


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Keep an existing folder for this command; InputError where another process writes there.

    The folder itself is locked: nothing is left in it, and a lock ends with its holder.
    """
    try:
        import fcntl

        number = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):  # Windows knows no such locks; there may be no folder yet
        yield
        return
    try:
        with contextlib.suppress(OSError):  # a file system without locks
            try:
                fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise InputError(
                    f"{folder}: another process is writing results there. Wait for it, or choose another folder (-o)."
                ) from None
        yield
    finally:
        os.close(number)


def interrupted_place(folder: Path) -> Path:
    """Beside a results folder, for a part of a run that is not to replace it: a name that nobody has yet."""
    number, place = 1, folder.with_name(f"{folder.name}-interrupted")
    while os.path.lexists(place):
        number, place = number + 1, folder.with_name(f"{folder.name}-interrupted-{number + 1}")
    return place


def swept_run(folder: str) -> None:
    """Clear up what killed processes have left beside a results folder and in it."""
    place = Path(folder).absolute()
    for parent in (place.parent, place, place / "plots"):
        for line in sweep(parent):
            say(line)
