"""What of a study is kept if the machine is switched off now?

A folder's `rows.jsonl`: first what the study is, then every finished row on a line of its own, on the disk before the next one.
Whoever goes on reads it; a last line that was cut off is left out.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

from watchsim.results.tables import plain
from watchsim.scene.scene import Scene
from watchsim.studies.point import Row

NAME = "rows.jsonl"

Study = dict[str, Any]


def scene_digest(scene: Scene) -> str:
    """Of everything the scene says and of its drawings."""
    digest = hashlib.sha256(json.dumps(plain(scene.source), sort_keys=True, default=str).encode())
    for name in sorted(scene.drawings):
        digest.update(name.encode() + hashlib.sha256(scene.drawings[name]).digest())
    return digest.hexdigest()[:16]


class Journal:
    """Rows by their number. Use it in a `with` statement."""

    def __init__(self, folder: Path, study: Study, resume: bool) -> None:
        """`study` says what is computed; ValueError where `resume` finds another one in the folder, with the difference."""
        self.path = folder / NAME
        self.rows: dict[int, Row] = {}
        whole = 0
        if resume:
            whole = self._read(study)
        self._file: IO[bytes] = self.path.open("r+b" if whole else "wb")
        self._file.truncate(whole)
        self._file.seek(whole)
        if not whole:
            self._write(study)

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def add(self, number: int, row: Row) -> None:
        """Keep one finished row, for good when this returns."""
        self.rows[number] = row
        self._write({"point": number, **row})

    def _write(self, record: Mapping[str, Any]) -> None:
        self._file.write(json.dumps(plain(record), ensure_ascii=False, allow_nan=False).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def _read(self, study: Study) -> int:
        """Take up the rows that are there; how many bytes of the file are whole lines."""
        if not self.path.is_file():
            return 0
        whole = 0
        for i, line in enumerate(self.path.read_bytes().splitlines(keepends=True)):
            try:
                record = json.loads(line)
            except ValueError:
                break
            if not line.endswith(b"\n"):
                break
            if i == 0:
                _compare(record, plain(study), self.path.parent)
            else:
                self.rows[int(record.pop("point"))] = record
            whole += len(line)
        return whole


def _compare(earlier: Study, now: Study, folder: Path) -> None:
    """ValueError with every difference between two studies."""
    differences = [
        f"{name} {_difference(earlier.get(name), now.get(name))}" for name in now if earlier.get(name) != now.get(name)
    ]
    if differences:
        raise ValueError(
            f"--resume {folder}: this folder holds another study: {'; '.join(differences)}. Go on with what it was made with, "
            "or choose another folder."
        )


def _difference(before: Any, now: Any) -> str:
    if isinstance(before, dict) and isinstance(now, dict):
        if list(before) != list(now):
            return f"were {', '.join(before)}, now {', '.join(now)}"
        return "; ".join(f"of {key} {_values(before[key], now[key])}" for key in now if before[key] != now[key])
    if isinstance(now, str) and len(now) == 16:
        return "has changed since"
    return f"was {before}, now {now}"


def _values(before: list[Any], now: list[Any]) -> str:
    return f"were {len(before)} values from {before[0]} to {before[-1]}, now {len(now)} from {now[0]} to {now[-1]}"
