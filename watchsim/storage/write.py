"""How is a file or a folder written whole or not at all?

It is made in a scratch folder beside its destination, seen onto the disk, and renamed. What stood there before stays untouched
until then. Replacing a folder takes two renames; if the process dies between them, the next command finishes what was begun.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

from watchsim.storage.disk import reason, sync_file, sync_folder, sync_name, sync_tree, write_bytes
from watchsim.storage.scratch_folder import Scratch, guard, leftovers, scratch_in

Ours = Callable[[str], bool]  # of a path in the folder, with slashes: is it a file of ours, which may be replaced?


MARKS = ("summary.json", "trajectory.npz", "rows.jsonl", "sweep.json")  # one of them is in every folder of results


def real(path: Path) -> Path:
    """Where to write: what a link points to, so that it stays a link.

    PermissionError for a link that leads out of a folder of results: that may come from somebody else, who could have put it
    there to have another file overwritten.
    """
    path = path.absolute()
    for folder in (path.parent, path.parent.parent):
        if any(os.path.lexists(folder / name) for name in MARKS) and not _ends_in(folder, path):
            link = path if path.is_symlink() else path.parent
            raise PermissionError(
                f"{link} is a link out of the results folder {folder}, which nothing is written through. "
                "Remove the link, or choose another place"
            )
    return path.resolve() if path.is_symlink() else path


def _ends_in(folder: Path, path: Path) -> bool:
    """Whether a path in a folder is in it, too, when links are followed."""
    try:
        return folder.resolve() in path.resolve().parents
    except (OSError, RuntimeError):  # links in a circle
        return False


def write_file(target: Path, fill: Callable[[Path], object], what: str) -> None:
    """Let `fill` write a file whose name ends like that of `target`, and put it in the place of `target`.

    OSError where that fails, with `what` could not be written: what was there before is then still there, and nothing else.
    """
    place = real(target)
    with _told(what, target), scratch_in(place.parent) as scratch:
        scratch.new.mkdir()
        made = scratch.new / f"file{place.suffix.lower()}"
        fill(made)
        sync_tree(scratch.new)
        made.replace(place)
    sync_name(place)


def write_folder(target: Path, fill: Callable[[Path], object], ours: Ours, what: str) -> None:
    """Let `fill` write into a new folder and put it in the place of `target`; files of an old one that are not `ours` are kept.

    OSError where the disk is full or the place not writable, with `what` could not be written: what was there before is then
    still there, and nothing else.
    """
    place = real(target)
    with _told(what, target), scratch_in(place.parent) as scratch:
        scratch.new.mkdir()
        fill(scratch.new)
        sync_tree(scratch.new)
        if place.is_dir():
            _take_along(place, scratch.new, ours)
            sync_tree(scratch.new, files=False)
            shutil.copymode(place, scratch.new)
        _note(scratch, place)
        _exchange(scratch, place, ours)
    sync_name(place)


@contextlib.contextmanager
def _told(what: str, target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        words = f"could not write {what} to {target}: {reason(error)}; nothing was changed"
        raise type(error)(error.errno, words) from error


def _take_along(old: Path, new: Path, ours: Ours) -> None:
    """Put into `new` what `old` holds that is not ours and not there yet, without copying where links will do."""
    for place, folders, names in os.walk(old):
        here = Path(place)
        links = [name for name in folders if (here / name).is_symlink()]
        for name in (*names, *links):
            path = (here / name).relative_to(old)
            other = new / path
            if not ours(path.as_posix()) and not os.path.lexists(other):
                other.parent.mkdir(parents=True, exist_ok=True)
                _same_file(here / name, other)
        if not folders and not names and not ours(here.relative_to(old).as_posix()):
            (new / here.relative_to(old)).mkdir(parents=True, exist_ok=True)


def _same_file(item: Path, other: Path) -> None:
    try:
        os.link(item, other, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(item, other, follow_symlinks=False)
        if not other.is_symlink():
            sync_file(other)


def _note(scratch: Scratch, place: Path) -> None:
    """Write down that `new` is complete and what for: from here on it outlives the process."""
    known = place.stat().st_ino if place.exists() else None
    begun = scratch.journal.with_suffix(".begun")
    write_bytes(begun, json.dumps({"target": place.name, "replaces": known}).encode())
    begun.replace(scratch.journal)
    sync_folder(scratch.place)


def _exchange(scratch: Scratch, place: Path, ours: Ours) -> None:
    """Put the new folder in the place of the old one, which comes back where that fails half way."""
    with guard:
        if not place.exists():
            scratch.new.rename(place)
            return
        place.rename(scratch.old)
        scratch.recoverable = True  # if this process should be stopped before it is through
        try:
            scratch.new.rename(place)
        except BaseException:
            scratch.old.rename(place)
            scratch.recoverable = False
            raise
        sync_name(place)
        with contextlib.suppress(OSError):  # what somebody has put into the old folder since
            _take_along(scratch.old, place, ours)
        scratch.recoverable = False


def sweep(parent: Path) -> list[str]:
    """Clear up in `parent` what killed processes have left, and finish what they had begun; says what was brought back."""
    said = []
    for scratch in leftovers(parent):
        try:
            said += _recovered(scratch)
        except (OSError, ValueError, KeyError, TypeError) as error:
            if scratch.journal.exists() and (scratch.new.exists() or scratch.old.exists()):
                scratch.recoverable = True
                said.append(f"{scratch.place} holds what a killed process left, and it could not be brought back: {error}")
    return said


def _recovered(scratch: Scratch) -> list[str]:
    """Finish an exchange of folders that was begun; without a journal nothing in the scratch folder is complete."""
    if not scratch.journal.exists():
        return []
    journal = json.loads(scratch.journal.read_bytes())
    place = scratch.place.parent / Path(str(journal["target"])).name
    if not os.path.lexists(place):
        # Between the two renames: what is new is complete, and holds what was not ours of the old.
        (scratch.new if scratch.new.is_dir() else scratch.old).rename(place)
        return [f"{place}: brought back after a process was killed while it replaced this folder."]
    if scratch.new.is_dir() and not scratch.old.exists() and place.is_dir() and place.stat().st_ino == journal["replaces"]:
        place.rename(scratch.old)
        try:
            scratch.new.rename(place)
        except OSError:
            scratch.old.rename(place)
            raise
        return [f"{place}: replaced, as a killed process was about to do."]
    return []
