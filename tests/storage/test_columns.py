"""Are columns in files those in memory, also where the disk fails half way?"""

import errno
import sys
from pathlib import Path

import numpy as np
import pytest
from storage.disk_faults import Disk, watched

from watchsim.storage.columns import Columns, blocks, is_mapped, let_go, mapping, one_behind_the_other, unpacked

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


def archive_of(path: Path, seed: int = 3) -> dict[str, np.ndarray]:
    """An npz archive with two columns, as results are written."""
    rng = np.random.default_rng(seed)
    events = np.zeros(500, KIND)
    events["t"] = rng.random(500)
    arrays = {"q": rng.random((1000, 3)), "events": events}
    np.savez_compressed(path, **arrays)
    return arrays


def test_a_long_array_of_an_archive_is_mapped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arrays = archive_of(tmp_path / "run.npz")
    for most, mapped in ((0.0, True), (1e9, False)):
        monkeypatch.setattr("watchsim.storage.columns.IN_MEMORY", most)
        with np.load(tmp_path / "run.npz") as archive:
            back = {name: unpacked(archive, name, tmp_path) for name in arrays}
        assert same(list(back.values()), list(arrays.values()))
        assert [is_mapped(array) for array in back.values()] == [mapped] * 2
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]


@pytest.mark.parametrize("lasting", [False, True])
def test_an_archive_is_read_where_nothing_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lasting: bool
) -> None:
    """A folder that cannot be written, or has no room: the file goes among the temporary ones, else into memory."""
    import tempfile

    arrays = archive_of(tmp_path / "run.npz")
    make = tempfile.TemporaryFile

    def refuse(dir: Path | None = None) -> object:
        if dir is not None or lasting:
            raise OSError(errno.ENOSPC, "No space left on device")
        return make()

    monkeypatch.setattr("watchsim.storage.columns.IN_MEMORY", 0.0)
    monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
    with np.load(tmp_path / "run.npz") as archive:
        back = [unpacked(archive, name, tmp_path) for name in arrays]
    assert same(back, list(arrays.values())) and [is_mapped(array) for array in back] == [not lasting] * 2


def test_a_damaged_archive_is_refused_as_numpy_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every hundredth byte changed in turn: never anything but the right numbers or an exception."""
    monkeypatch.setattr("watchsim.storage.columns.IN_MEMORY", 0.0)
    arrays = archive_of(tmp_path / "run.npz")
    sound = (tmp_path / "run.npz").read_bytes()
    refused = 0
    for at in range(0, len(sound), 100):
        (tmp_path / "run.npz").write_bytes(sound[:at] + bytes([sound[at] ^ 0xFF]) + sound[at + 1 :])
        try:
            with np.load(tmp_path / "run.npz") as archive:
                back = [unpacked(archive, name, tmp_path) for name in arrays]
        except Exception:
            refused += 1
        else:
            assert same(back, list(arrays.values()))
    assert refused > 100
