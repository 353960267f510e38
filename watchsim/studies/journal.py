"""What of a study is kept if the machine is switched off now?

A folder's `rows.jsonl`: first what the study is, then every finished row on a line of its own, on the disk before the next
one. Whoever goes on reads it; a last line that was cut off is left out. A row that cannot be written, as on a full disk, is
written with the next one, and the study goes on.
"""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from watchsim.results.tables import plain
from watchsim.scene.scene import Scene
from watchsim.storage.write import real, reason, write_file

if TYPE_CHECKING:  # what computes takes as long to import as another study to be refused
    from watchsim.studies.axes import Value
    from watchsim.studies.point import Row

NAME = "rows.jsonl"
FIGURES = (".png", ".svg", ".pdf")
STUDIES = ("sweep", "tolerance", "positions", "shock")  # the names of what is made of the rows
FILES = tuple(f"{name}{ending}" for name in STUDIES for ending in (".json", ".csv", ".parquet", ".html", *FIGURES))

Study = dict[str, Any]


def scene_digest(scene: Scene) -> str:
    """Of everything the scene says and of its drawings."""
    digest = hashlib.sha256(json.dumps(plain(scene.source), sort_keys=True, default=str).encode())
    for name in sorted(scene.drawings):
        digest.update(name.encode() + hashlib.sha256(scene.drawings[name]).digest())
    return digest.hexdigest()[:16]


def study_of(
    scene: Scene, keys: Mapping[str, Sequence[Value]], by_shooting: bool, duration: float | None, tolerance: float | None
) -> Study:
    """What decides the rows, as a resumed study must find it again."""
    how = "by shooting" if by_shooting else f"by runs of {duration or scene.duration:g} s"
    return {
        "scene": scene_digest(scene),
        "keys": {key: list(values) for key, values in keys.items()},
        "computed": how,
        "tolerance": tolerance or scene.tolerance,
    }


def study_of_tolerances(scene: Scene, duration: float | None, tolerance: float | None, seed: int, importance: bool) -> Study:
    """The same of a study of tolerances, each sample by its limit cycle, or by a run of that `duration`."""
    keys: dict[str, list[float | str]] = {one.key: [one.nominal, one.words] for one in scene.tolerances}
    return {
        **study_of(scene, keys, duration is None, duration, tolerance),
        "seed": seed,
        "importance": importance,
        "duration": duration,
        "changes": dict(scene.written.changes) if scene.written else {},
    }


class Journal:
    """Rows by their number. Use it in a `with` statement."""

    def __init__(self, folder: Path, study: Study, resume: bool) -> None:
        """`study` says what is computed; ValueError where `resume` finds another one in the folder, with the difference.

        OSError where it cannot be written; an earlier journal is then still there.
        """
        self.path = real(folder / NAME)
        self.rows: dict[int, Row] = {}
        self._owed = b""  # lines that are not on the disk yet
        self._whole = self._read(study) if resume else 0  # bytes of the file that are whole lines
        if not self._whole:
            first = _line(study)
            write_file(self.path, lambda place: place.write_bytes(first), "the rows")
            self._whole = len(first)
            for name in FILES:  # of the earlier study; what cannot be removed now is replaced or named at the end
                with contextlib.suppress(OSError):
                    (folder / name).unlink()
        try:
            self._file: IO[bytes] = self.path.open("r+b", buffering=0)
        except OSError as error:
            raise type(error)(error.errno, f"could not write the rows to {self.path}: {reason(error)}") from error

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self._write()
        self._file.close()

    def add(self, number: int, row: Row) -> None:
        """Keep one finished row: on the disk when this returns, where that can be written."""
        self.add_all({number: row})

    def add_all(self, rows: Mapping[int, Row]) -> None:
        """The same for several, which takes as long as for one."""
        self.rows.update(rows)
        self._owed += b"".join(_line({"point": number, **row}) for number, row in rows.items())
        self._write()

    def _write(self) -> None:
        try:
            self._file.seek(self._whole)
            self._file.truncate()
            left = memoryview(self._owed)
            while left:
                left = left[self._file.write(left) or 0 :]
            os.fsync(self._file.fileno())
        except OSError:
            return
        self._whole, self._owed = self._whole + len(self._owed), b""

    def _read(self, study: Study) -> int:
        """Take up the rows that are there; how many bytes of the file are whole lines."""
        if not self.path.is_file():
            return 0
        whole = 0
        for i, (record, size) in enumerate(_records(self.path)):
            if i == 0:
                _compare(record, plain(study), self.path.parent)
            else:
                self.rows[int(record.pop("point"))] = record
            whole += size
        return whole


def same_study(folder: Path, study: Study) -> None:
    """ValueError where a journal in the folder is of another study than this, with the difference."""
    for record, _ in itertools.islice(_records(folder / NAME) if (folder / NAME).is_file() else (), 1):
        _compare(record, plain(study), folder)


def read_rows(path: Path) -> tuple[Study, dict[int, Row]]:
    """What the study of a journal is, and its rows by their numbers; an empty study where nothing whole is in it."""
    records = [record for record, _ in _records(path)]
    return (records[0] if records else {}), {int(record.pop("point")): record for record in records[1:]}


def _records(path: Path) -> Iterator[tuple[dict[str, Any], int]]:
    """What its whole lines hold, and how many bytes each has."""
    for line in path.read_bytes().splitlines(keepends=True):
        try:
            record = json.loads(line)
        except ValueError:
            return
        if not line.endswith(b"\n"):
            return
        yield record, len(line)


def _line(record: Mapping[str, Any]) -> bytes:
    return json.dumps(plain(record), ensure_ascii=False, allow_nan=False).encode() + b"\n"


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
    if any(isinstance(value, str) for value in (*before, *now)):  # a tolerance: nominal value, limits and distribution
        was, are = (" with ".join(value if isinstance(value, str) else f"{value:g}" for value in one) for one in (before, now))
        return f"was {was}, now {are}"
    return f"were {len(before)} values from {before[0]} to {before[-1]}, now {len(now)} from {now[0]} to {now[-1]}"
