"""Is a place that cannot be written refused before anything is computed, with a word and without a trace?"""

import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from watchsim.storage import destination
from watchsim.storage.destination import give_name, nameless, secure_file, secure_folder

NOBODY = 65534
needs_linux = pytest.mark.skipif(sys.platform != "linux", reason="the customs of Linux")


def refusal(secure: Callable[[Path, str], object], target: Path) -> str:
    """What it says; it must have left nothing behind."""
    before = sorted(path for path in target.parent.rglob("*")) if target.parent.is_dir() else None
    with pytest.raises(OSError) as caught:
        secure(target, "results")
    after = sorted(path for path in target.parent.rglob("*")) if target.parent.is_dir() else None
    assert before == after
    words = str(caught.value)
    assert "Errno" not in words
    return words


@pytest.mark.parametrize("secure", [secure_folder, secure_file])
def test_what_cannot_be_written_is_refused(secure: Callable[[Path, str], object], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "nowhere").symlink_to(tmp_path / "gone")
    (tmp_path / "circle").symlink_to(tmp_path / "circle")
    assert "Not a directory" in refusal(secure, tmp_path / "file" / "out")
    assert "File name too long" in refusal(secure, tmp_path / ("x" * 256))
    assert f"is a link to {tmp_path / 'gone'}, which does not exist" in refusal(secure, tmp_path / "nowhere")
    assert f"is a link to {tmp_path / 'circle'}, which leads back to it" in refusal(secure, tmp_path / "circle")
    assert secure(tmp_path / ("x" * 255), "results") == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["circle", "file", "nowhere"]


@pytest.mark.parametrize("secure", [secure_folder, secure_file])
def test_missing_folders_above_are_made(secure: Callable[[Path, str], object], tmp_path: Path) -> None:
    assert secure(tmp_path / "a" / "b" / "out", "results") == []
    assert (tmp_path / "a" / "b").is_dir() and not any((tmp_path / "a" / "b").iterdir())


def test_a_file_is_no_folder_and_a_folder_no_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "folder").mkdir()
    assert "is a file" in refusal(secure_folder, tmp_path / "file")
    assert "is a folder" in refusal(secure_file, tmp_path / "folder")


def test_a_path_too_long_for_what_lies_below(tmp_path: Path) -> None:
    deep = tmp_path
    while len(str(deep)) < 4000:
        deep = deep / ("d" * 50)
    try:
        deep.mkdir(parents=True)
        target = deep / ("x" * (4096 - len(str(deep)) - 6))
        assert "File name too long" in refusal(secure_folder, target)
    finally:
        shutil.rmtree(tmp_path / ("d" * 50))


def test_a_disk_without_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Nearly:
        free = 3_999_999

    monkeypatch.setattr(destination.shutil, "disk_usage", lambda _: Nearly)
    assert "may need 4 MB, and only 4 MB are free" in refusal(secure_folder, tmp_path / "out")
    Nearly.free = 12_000
    assert "only 12 kB are free" in refusal(secure_folder, tmp_path / "out")


def test_a_mount_point_cannot_be_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "disk").mkdir()
    monkeypatch.setattr(os.path, "ismount", lambda path: str(path) == str(tmp_path / "disk"))
    assert f"such as {tmp_path / 'disk' / 'run'}" in refusal(secure_folder, tmp_path / "disk")


@pytest.fixture
def shared() -> Iterator[Path]:
    """A folder that everybody can get to."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder)


def as_nobody(work: Callable[[], object]) -> str:
    """What `work` is refused with in a process without rights; "" if it is not."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        words = ""
        try:
            os.setuid(NOBODY)
            work()
        except OSError as error:
            words = str(error)
        finally:
            os.write(writing, words.encode())
            os._exit(0)
    os.close(writing)
    os.waitpid(child, 0)
    with os.fdopen(reading) as pipe:
        return pipe.read()


@needs_linux
@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="only root can become somebody else")
def test_foreign_folders(shared: Path) -> None:
    assert "nothing can be written to" in as_nobody(lambda: secure_folder(shared / "out", "results"))
    (shared / "theirs").mkdir()
    shared.chmod(0o1777)
    assert "belongs to another user" in as_nobody(lambda: secure_folder(shared / "theirs", "results"))
    assert as_nobody(lambda: secure_folder(shared / "mine", "results")) == ""
    (shared / "picture.png").write_text("theirs")
    assert "write-protected" in as_nobody(lambda: secure_file(shared / "picture.png", "the picture"))
    (shared / "closed").mkdir(mode=0o700)
    assert "Permission denied" in as_nobody(lambda: secure_folder(shared / "closed" / "out", "results"))


# Does a file made without a name appear whole under the name it is given, and not before?

CONTENT = bytes(range(256)) * 10_000


@pytest.mark.parametrize("linked", [True, False])
def test_it_appears_with_its_name(linked: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not linked:  # a file system without such files
        flag, opened = getattr(os, "O_TMPFILE", 0), os.open

        def refusing(path: object, flags: int, *rest: int, **named: int) -> int:
            if flag and flags & flag == flag:
                raise OSError
            return opened(path, flags, *rest, **named)  # type: ignore[call-overload, no-any-return]

        monkeypatch.setattr(os, "open", refusing)
    (tmp_path / "below").mkdir()
    target = tmp_path / "below" / "content.bin"
    with nameless(tmp_path) as file:
        file.write(CONTENT)
        assert [path.name for path in tmp_path.rglob("*")] == ["below"] or os.name == "nt"
        give_name(file, target)
    assert target.read_bytes() == CONTENT
    plain = tmp_path / "plain"
    plain.write_bytes(b"")
    assert target.stat().st_mode == plain.stat().st_mode


def test_where_links_fail_it_is_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object, **__: object) -> None:
        raise OSError

    with nameless(tmp_path) as file:
        file.write(CONTENT)
        monkeypatch.setattr(os, "link", fails)
        give_name(file, tmp_path / "content.bin")
    assert (tmp_path / "content.bin").read_bytes() == CONTENT


def test_what_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with nameless(tmp_path) as file, pytest.raises(OSError):
        file.write(CONTENT)
        give_name(file, tmp_path / "missing" / "content.bin")
