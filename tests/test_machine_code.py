"""Does the machine code follow the sources, and does it stay where the user wants it?"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from interpreter import python

from watchsim import machine_code

KERNEL = """from watchsim import whole
from watchsim.jit import kernel
from watchsim.inner import K
def show():
    from watchsim.plots import K
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package of one kernel file, what it imports, and a file it does not reach."""
    folder = tmp_path / "watchsim"
    (folder / "deep").mkdir(parents=True)
    (folder / "contact").mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "jit.py").write_text("")
    (folder / "contact" / "outer.py").write_text(KERNEL)
    (folder / "inner.py").write_text("from watchsim.deep.names import K\n")
    (folder / "deep" / "names.py").write_text("K = 1\n")
    (folder / "plots.py").write_text("K = 2\n")
    (folder / "whole.py").write_text("K = 3\n")
    return folder


@pytest.mark.parametrize(
    ("name", "matters"),
    [
        ("contact/outer.py", True),
        ("inner.py", True),
        ("deep/names.py", True),
        ("whole.py", True),
        ("__init__.py", False),
        ("plots.py", False),
    ],
)
def test_digest_follows_what_kernels_reach(package: Path, name: str, matters: bool) -> None:
    before = machine_code.source_digest(package)
    assert machine_code.source_digest(package) == before
    (package / name).write_text((package / name).read_text() + "# edited\n")
    assert (machine_code.source_digest(package) != before) is matters


def test_all_kernels_lie_where_they_are_looked_for() -> None:
    package = machine_code.PACKAGE
    defining = [path for path in package.rglob("*.py") if machine_code._defines_kernels(str(path))]
    assert {path.relative_to(package).parts[0] for path in defining} == set(machine_code.WITH_KERNELS)


def test_two_copies_of_the_package_do_not_share_machine_code(package: Path, tmp_path: Path) -> None:
    before = machine_code.source_digest(package)
    package.rename(tmp_path / "moved")
    assert machine_code.source_digest(tmp_path / "moved") != before


def test_falls_back_when_the_folder_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    code = "from watchsim.machine_code import cache_folder; print(cache_folder())"
    folder = Path(python(code, WATCHSIM_CACHE=str(tmp_path / "file" / "below"), TMPDIR=str(tmp_path)))
    assert folder.is_dir()
    assert tmp_path in folder.parents


@pytest.mark.skipif(sys.platform != "linux", reason="the custom of Linux")
def test_the_users_cache_folder(tmp_path: Path) -> None:
    code = "from watchsim.machine_code import cache_folder; print(cache_folder())"
    folder = Path(python(code, WATCHSIM_CACHE="", XDG_CACHE_HOME=str(tmp_path)))
    assert folder.parent == tmp_path / "watchsim" / "kernels"


def test_old_machine_code_is_forgotten(tmp_path: Path) -> None:
    for age in range(6):
        folder = tmp_path / "kernels" / f"digest{age}"
        folder.mkdir(parents=True)
        (folder / "code.nbc").write_text("")
        os.utime(folder, (1e9 - age, 1e9 - age))
    recent = tmp_path / "kernels" / "recent"
    recent.mkdir()
    python("from watchsim.machine_code import cache_folder; cache_folder()", WATCHSIM_CACHE=str(tmp_path))
    kept = {folder.name for folder in (tmp_path / "kernels").iterdir()}
    assert {"recent", "digest0"} <= kept
    assert kept.isdisjoint({"digest1", "digest2", "digest3", "digest4", "digest5"})
    assert len(kept) == 3
