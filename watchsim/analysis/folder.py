"""How is a folder written whole or not at all?

It is filled beside its destination and moved there when it is complete; one that is replaced stays untouched until then.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Collection
from pathlib import Path


def write_folder(target: Path, fill: Callable[[Path], object], ours: Collection[str], what: str) -> None:
    """Let `fill` write into a new folder and put it in the place of `target`.

    Files of an old folder whose names are not `ours` are kept. OSError where the disk is full or the place not writable, with
    `what` could not be written: what was there before is then still there, and nothing else.
    """
    scratch = _beside(target, "new")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        scratch.mkdir()
        fill(scratch)
        _put(scratch, target, ours)
    except OSError as error:
        reason = error.strerror or str(error)
        raise type(error)(error.errno, f"could not write {what} to {target}: {reason}; nothing was changed") from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _put(scratch: Path, target: Path, ours: Collection[str]) -> None:
    """Exchange the new folder for the old one; the old one comes back if that fails half way."""
    if not target.exists():
        scratch.rename(target)
        return
    old = _beside(target, "old")
    target.rename(old)
    try:
        scratch.rename(target)
    except BaseException:
        old.rename(target)
        raise
    for item in old.iterdir():
        if item.name not in ours and not (target / item.name).exists():
            item.rename(target / item.name)
    shutil.rmtree(old, ignore_errors=True)


def _beside(target: Path, word: str) -> Path:
    return target.with_name(f".{target.name}.{word}-{os.getpid()}")
