"""Is there always one of the two, the old or the new, and never half of anything, whatever fails and whenever?"""

import shutil
import sys
from pathlib import Path

import pytest
from every_time import few
from storage.disk_faults import Disk, killed_at, not_yet_on_disk, watched

from watchsim.storage.write import PREFIX, make, real, sweep, write_file, write_folder

MOST = 200  # actions of one writing
OLD = {"numbers.txt": "old", "only_old.txt": "old", "mine.txt": "mine", "deep/mine.txt": "mine"}
NEW = {"numbers.txt": "new", "plots/a.txt": "new"}
KEPT = {"mine.txt": "mine", "deep/mine.txt": "mine"}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc, forks")


def ours(name: str) -> bool:
    return name in ("numbers.txt", "only_old.txt", "plots", "plots/a.txt")


def fill(place: Path) -> None:
    for name, text in NEW.items():
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).write_text(text)


def contents(folder: Path) -> dict[str, str]:
    return {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*") if path.is_file()}


def begin(root: Path, old: bool) -> Path:
    """A fresh parent folder, with an old folder in it or without."""
    shutil.rmtree(root, ignore_errors=True)
    target = root / "out"
    for name, text in OLD.items() if old else ():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_text(text)
    root.mkdir(exist_ok=True)
    return target


def check(target: Path, old: bool, done: bool) -> None:
    """The new folder, or what was there before; `done` says that it was reported as written."""
    whole = {**NEW, **(KEPT if old else {})}
    if done:
        assert contents(target) == whole
    elif target.exists():
        assert contents(target) in ((OLD, whole) if old else (whole,))
    else:
        assert not old


def nothing_left(root: Path) -> bool:
    return not [name for name in root.iterdir() if name.name.startswith(PREFIX)]


@pytest.mark.parametrize("old", [True, False])
def test_each_action_fails_once(tmp_path: Path, old: bool) -> None:
    """Where it says that nothing was changed, nothing was; where it says nothing, all was written."""
    root = tmp_path / "disk"
    for number in range(1, MOST):
        target, done = begin(root, old), False
        with watched(Disk(root, number)) as disk:
            try:
                write_folder(target, fill, ours, "the results")
                done = True
            except OSError as error:
                assert "No space left on device; nothing was changed" in str(error)
        assert done or contents(target) == OLD if old else done or not target.exists(), disk.log[-1]
        check(target, old, done)
        sweep(root)
        check(target, old, done)
        assert nothing_left(root), disk.log[number - 1]
        if not disk.failed:
            assert done and number > 15
            return
    raise AssertionError("there is no end to it")


@pytest.mark.parametrize("old", few([True, False], 1))
def test_killed_at_each_action(tmp_path: Path, old: bool) -> None:
    """After the next command's sweep there is the old folder or the new one under its name, and no leftover."""
    root = tmp_path / "disk"
    found = set()
    for number in range(1, MOST):
        target = begin(root, old)
        died = killed_at(root, number, lambda target=target: write_folder(target, fill, ours, "the results"))
        sweep(root)
        check(target, old, done=not died)
        found.add(contents(target)["numbers.txt"] if target.exists() else "none")
        assert nothing_left(root), number
        if not died:
            assert number > 20 and found == ({"old", "new"} if old else {"none", "new"})
            return
    raise AssertionError("there is no end to it")


@pytest.mark.parametrize("step", [12, pytest.param(1, marks=pytest.mark.slow)])
def test_killed_at_each_action_of_clearing_up(step: int, tmp_path: Path) -> None:
    """A sweep that dies half way is finished by the next one."""
    root = tmp_path / "disk"
    for first in range(20, 45, step):
        for number in range(1, MOST):
            target = begin(root, True)
            killed_at(root, first, lambda target=target: write_folder(target, fill, ours, "the results"))
            died = killed_at(root, number, lambda: sweep(root))
            sweep(root)
            check(target, True, done=False)
            assert target.exists() and nothing_left(root), (first, number)
            if not died:
                break


def test_a_power_cut_finds_no_empty_file_under_a_final_name(tmp_path: Path) -> None:
    for old in (True, False):
        target = begin(tmp_path / "disk", old)
        with watched(Disk(tmp_path)) as disk:
            write_folder(target, fill, ours, "the results")
            write_file(tmp_path / "disk" / "a.txt", lambda path: path.write_text("a"), "a text")
        final = {str(target), str(tmp_path / "disk" / "a.txt")}
        assert not_yet_on_disk(disk.log, final.__contains__) == []
        bare = [entry for entry in disk.log if entry[0] != "fsync"]
        assert len(not_yet_on_disk(bare, final.__contains__)) >= 4, "the check would have seen it"


def written(target: Path) -> None:
    write_file(target, lambda path: path.write_text("new"), "a text")


@pytest.mark.slow
def test_files_fail_and_die_alike(tmp_path: Path) -> None:
    root = tmp_path / "disk"
    for number in range(1, MOST):
        for old in (True, False):
            shutil.rmtree(root, ignore_errors=True)
            root.mkdir()
            target = root / "a.txt"
            if old:
                target.write_text("old")
            died = killed_at(root, number, lambda target=target: written(target))
            sweep(root)
            assert [path.name for path in root.iterdir()] == (["a.txt"] if old or target.exists() else [])
            assert not target.exists() or target.read_text() in ("old", "new")
            with watched(Disk(root, number)) as disk:
                try:
                    write_file(target, lambda path: path.write_text("newer"), "a text")
                    assert target.read_text() == "newer"
                except OSError as error:
                    assert "nothing was changed" in str(error)
                    assert not target.exists() or target.read_text() in ("old", "new")
        if not died and not disk.failed:
            return
    raise AssertionError("there is no end to it")


def test_the_scratch_folder_of_a_living_process_is_left_alone(tmp_path: Path) -> None:
    """Also of another one, which has the same number in another container."""
    code = f"import sys; from pathlib import Path; from watchsim.storage.write import make; make(Path({str(tmp_path)!r}))"
    import subprocess

    code += "; print('made', flush=True); sys.stdin.read()"
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None and other.stdin is not None
        assert other.stdout.readline() == b"made\n"
        own = make(tmp_path)
        sweep(tmp_path)
        assert len(list(tmp_path.iterdir())) == 2
        other.kill()
    sweep(tmp_path)
    assert list(tmp_path.iterdir()) == [own.place]
    own.close()
    assert not list(tmp_path.iterdir())


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "other disk").mkdir()
    behind = begin(tmp_path / "other disk" / "there", True)
    link = tmp_path / "out"
    link.symlink_to(behind)
    write_folder(link, fill, ours, "the results")
    assert link.is_symlink() and link.resolve() == behind
    assert contents(behind) == {**NEW, **KEPT}
    picture = behind / "picture.png"
    picture.symlink_to(behind / "mine.txt")
    write_file(picture, lambda path: path.write_text("new"), "the picture")
    assert picture.is_symlink() and (behind / "mine.txt").read_text() == "new"


def test_a_path_with_dots_is_no_link(tmp_path: Path) -> None:
    run = tmp_path / "run"
    (run / "plots").mkdir(parents=True)
    (run / "summary.json").write_text("{}")
    assert real(Path(f"{run}/plots/../../other/a.png")) == tmp_path.resolve() / "other" / "a.png"
    (run / "away").symlink_to(tmp_path)
    with pytest.raises(PermissionError, match="is a link out of the results folder"):
        real(Path(f"{run}/../run/away/a.png"))


def test_permissions_of_a_replaced_folder_stay(tmp_path: Path) -> None:
    target = begin(tmp_path / "disk", True)
    target.chmod(0o700)
    write_folder(target, fill, ours, "the results")
    assert target.stat().st_mode & 0o777 == 0o700
