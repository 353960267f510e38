"""Are columns in files those in memory, also where the disk fails half way?"""

from __future__ import annotations

import errno
import sys
from pathlib import Path

import numpy as np
import pytest
from storage.disk_faults import Disk, watched

from watchsim.storage.columns import Columns, blocks, is_mapped, let_go, mapping, one_behind_the_other

KIND = np.dtype([("t", "f8"), ("kind", "i4")])


def parts(seed: int = 1, count: int = 50) -> list[tuple[np.ndarray, ...]]:
    """Columns of several widths and types, some parts empty."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        n = int(rng.integers(0, 40))
        kinds = np.zeros(n, KIND)
        kinds["t"], kinds["kind"] = rng.random(n), rng.integers(0, 9, n)
        made.append((rng.random(n), rng.random((n, 3)), kinds))
    return made


def filled(folder: Path | None, most: float) -> Columns:
    columns = Columns()
    columns.folder, columns.most = folder, most
    for part in parts():
        columns.append(part)
    return columns


def same(one: list[np.ndarray], other: list[np.ndarray]) -> bool:
    return all(
        a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes() for a, b in zip(one, other, strict=True)
    )


@pytest.mark.parametrize("most", [0.0, 1e3, 5e3])
def test_files_hold_what_memory_holds(tmp_path: Path, most: float) -> None:
    memory, files = filled(None, most), filled(tmp_path, most)
    behind = parts(2, 3)
    assert memory.rows == files.rows == sum(len(part[0]) for part in parts())
    for _ in range(2):  # what is put behind is not kept
        assert same(memory.all(behind), files.all(behind))
    assert same(memory.all(), files.all())
    assert all(is_mapped(array) for array in files.all()) and not any(is_mapped(array) for array in memory.all())
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_full_disk_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = filled(None, 0.0).all()
    import tempfile

    made = tempfile.TemporaryFile

    class Full:
        """A file on a disk that is full after so many writes."""

        def __init__(self, dir: Path) -> None:
            self.file = made(dir=dir)

        def write(self, content: object) -> int:
            nonlocal left
            left -= 1
            if left < 0:
                raise OSError(errno.ENOSPC, "No space left on device")
            return self.file.write(content)  # type: ignore[arg-type]

        def __getattr__(self, name: str) -> object:
            return getattr(self.file, name)

    monkeypatch.setattr(tempfile, "TemporaryFile", Full)
    for room in range(0, 200, 7):
        left = room
        assert same(whole, filled(tmp_path, 500.0).all()), room
    with watched(Disk(tmp_path, 1)):
        assert same(whole, filled(tmp_path / "not there", 500.0).all())


def test_pieces_are_the_whole(tmp_path: Path) -> None:
    t, q, _ = filled(tmp_path, 0.0).all()
    seen = [(a.copy(), b.copy()) for a, b in blocks(t, q, length=100)]
    assert len(seen) == -(-len(t) // 100)
    assert np.concatenate([a for a, _ in seen]).tobytes() == t.tobytes()
    assert np.concatenate([b for _, b in seen]).tobytes() == q.tobytes()
    view = q[3:50, 1]
    assert mapping(view) is mapping(q) is not None
    before = view.copy()
    let_go(view, np.zeros(3))
    assert view.tobytes() == before.tobytes()


def test_the_second_goes_behind_the_first(tmp_path: Path) -> None:
    first, second = filled(None, 0.0).all(), parts(3, 1)[0]
    for folder in (None, tmp_path):
        both = one_behind_the_other(first, second, folder)
        assert same(list(both), [np.concatenate(pair) for pair in zip(first, second, strict=True)])
    nothing = [array[:0] for array in first]
    assert same(list(one_behind_the_other(nothing, nothing, None)), nothing)
