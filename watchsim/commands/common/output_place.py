"""Where does a command write, and can it?"""

from __future__ import annotations

from pathlib import Path

from watchsim.commands.common.console import say
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


def swept_run(folder: str) -> None:
    """Clear up what killed processes have left beside a results folder and in it."""
    place = Path(folder).absolute()
    for parent in (place.parent, place, place / "plots"):
        for line in sweep(parent):
            say(line)
