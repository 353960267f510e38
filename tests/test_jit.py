"""Does the machine code follow the sources, and does it stay where the user wants it?"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from watchsim import jit

ROOT = Path(jit.__file__).resolve().parents[1]  # of the copy under test
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
    (folder / "__init__.py").write_text("")
    (folder / "jit.py").write_text("")
    (folder / "outer.py").write_text(KERNEL)
    (folder / "inner.py").write_text("from watchsim.deep.names import K\n")
    (folder / "deep" / "names.py").write_text("K = 1\n")
    (folder / "plots.py").write_text("K = 2\n")
    (folder / "whole.py").write_text("K = 3\n")
    return folder


@pytest.mark.parametrize(
    ("name", "matters"),
    [
        ("outer.py", True),
        ("inner.py", True),
        ("deep/names.py", True),
        ("whole.py", True),
        ("__init__.py", False),
        ("plots.py", False),
    ],
)
def test_digest_follows_what_kernels_reach(package: Path, name: str, matters: bool) -> None:
    before = jit.source_digest(package)
    assert jit.source_digest(package) == before
    (package / name).write_text((package / name).read_text() + "# edited\n")
    assert (jit.source_digest(package) != before) is matters


def test_two_copies_of_the_package_do_not_share_machine_code(package: Path, tmp_path: Path) -> None:
    before = jit.source_digest(package)
    package.rename(tmp_path / "moved")
    assert jit.source_digest(tmp_path / "moved") != before


def python(code: str, **environment: str) -> str:
    """What a fresh interpreter prints."""
    everything = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    done = subprocess.run([sys.executable, "-c", code], env=everything, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_machine_code_is_kept_and_found(tmp_path: Path) -> None:
    (tmp_path / "tiny.py").write_text("from watchsim.jit import entry\n@entry\ndef twice(x):\n    return 2 * x\n")
    use = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import tiny; print(tiny.twice(4))"
    ask = "from watchsim import jit; print(jit.is_cached(), jit.is_cached('tiny.twice'), jit.is_cached('tiny.thrice'))"
    cache = {"WATCHSIM_CACHE": str(tmp_path / "new"), "NUMBA_DISABLE_JIT": "0"}
    assert python(ask, **cache) == "False False False"
    assert python(use, **cache) == "8"
    assert python(ask, **cache) == "True True False"


def test_plain_python_when_asked(tmp_path: Path) -> None:
    code = (
        "import sys; from watchsim.jit import callable_kernel, entry, is_cached, kernel\n"
        "def f(x): return 2 * x\n"
        "print(kernel(f) is f, entry(f) is f, callable_kernel(f) is f, is_cached(), 'numba' in sys.modules)"
    )
    assert python(code, NUMBA_DISABLE_JIT="1", WATCHSIM_CACHE=str(tmp_path / "none")) == "True True True True False"
    assert not (tmp_path / "none").exists()


def test_importing_costs_no_numba() -> None:
    assert python("import sys, watchsim.jit; print('numba' in sys.modules, 'numpy' in sys.modules)") == "False False"


def test_a_kernel_can_be_made_callable(tmp_path: Path) -> None:
    code = "from watchsim.jit import callable_kernel; from watchsim.dynamics.lcp_scaling import _power_of_two as f; "
    code += "print(callable_kernel(f)(6.5))"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_DISABLE_JIT="0") == "8.0"


def test_other_numba_users_keep_their_cache_folder(tmp_path: Path) -> None:
    code = "import numba, watchsim.dynamics.lcp; print(numba.config.CACHE_DIR)"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_CACHE_DIR="theirs") == "theirs"


def test_falls_back_when_the_folder_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    code = "from watchsim.jit import cache_folder; print(cache_folder())"
    folder = Path(python(code, WATCHSIM_CACHE=str(tmp_path / "file" / "below"), TMPDIR=str(tmp_path)))
    assert folder.is_dir()
    assert tmp_path in folder.parents


@pytest.mark.skipif(sys.platform != "linux", reason="the custom of Linux")
def test_the_users_cache_folder(tmp_path: Path) -> None:
    code = "from watchsim.jit import cache_folder; print(cache_folder())"
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
    python("from watchsim.jit import cache_folder; cache_folder()", WATCHSIM_CACHE=str(tmp_path))
    kept = {folder.name for folder in (tmp_path / "kernels").iterdir()}
    assert {"recent", "digest0"} <= kept
    assert kept.isdisjoint({"digest1", "digest2", "digest3", "digest4", "digest5"})
    assert len(kept) == 3
