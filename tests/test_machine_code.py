"""Are kernels compiled once and then found, is damaged machine code compiled again, and does each change give new code?"""

import os
import runpy
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from interpreter import ROOT, python

from watchsim import jit
from watchsim import jit_cache as machine_code

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# Does the machine code follow the sources, and does it stay where the user wants it?

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
    code = "from watchsim.jit_cache import cache_folder; print(cache_folder())"
    folder = Path(python(code, WATCHSIM_CACHE=str(tmp_path / "file" / "below"), TMPDIR=str(tmp_path)))
    assert folder.is_dir()
    assert tmp_path in folder.parents


@pytest.mark.skipif(sys.platform != "linux", reason="the custom of Linux")
def test_the_users_cache_folder(tmp_path: Path) -> None:
    code = "from watchsim.jit_cache import cache_folder; print(cache_folder())"
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
    python("from watchsim.jit_cache import cache_folder; cache_folder()", WATCHSIM_CACHE=str(tmp_path))
    kept = {folder.name for folder in (tmp_path / "kernels").iterdir()}
    assert {"recent", "digest0"} <= kept
    assert kept.isdisjoint({"digest1", "digest2", "digest3", "digest4", "digest5"})
    assert len(kept) == 3


# Are kernels compiled once and then found, and can they be left plain Python?


def test_machine_code_is_kept_and_found(tmp_path: Path) -> None:
    (tmp_path / "tiny.py").write_text("from watchsim.jit import entry\n@entry\ndef twice(x):\n    return 2 * x\n")
    ask = "from watchsim import jit; print(jit.is_cached(), jit.is_cached('tiny.twice'), jit.is_cached('tiny.thrice'))"
    use = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {ask}; import tiny; print(tiny.twice(4)); {ask}"
    cache = {"WATCHSIM_CACHE": str(tmp_path / "new"), "NUMBA_DISABLE_JIT": "0"}
    assert python(use, **cache) == "False False False\n8\nTrue True False"
    assert python(ask, **cache) == "True True False"


def test_kept_code_is_loaded_without_the_compiler_which_still_works_afterwards(tmp_path: Path) -> None:
    kernels = "@entry\ndef total(x):\n    s = x[0]\n    for y in x[1:]:\n        s += y\n    return s\n"
    kernels += "@entry\ndef square(x):\n    return np.dot(x, x)\n@entry\ndef both(x):\n    return total(x) + square(x)\n"
    (tmp_path / "tiny.py").write_text(f"import numpy as np\nfrom watchsim.jit import entry\n{kernels}")
    head = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import numpy, tiny; x = numpy.arange(4.0); "
    cache = {"WATCHSIM_CACHE": str(tmp_path / "new"), "NUMBA_DISABLE_JIT": "0"}
    assert python(f"{head}print(tiny.total(x))", **cache) == "6.0"
    ask = "print(tiny.total(x), sum(tiny.total.stats.cache_hits.values()), 'numba.np.arraymath' in sys.modules)"
    unread = "; print(next(iter(tiny.total.overloads.values())).library._shared_module)"
    assert python(head + ask + unread, **cache) == "6.0 1 False\nNone"
    compiled = "print(tiny.total(x), tiny.both(x), tiny.square(x), tiny.total(x.astype(int)), tiny.total(x))"
    assert python(head + compiled, **cache) == "6.0 20.0 14.0 6 6.0"


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
    (tmp_path / "tiny.py").write_text("from watchsim.jit import kernel\n@kernel\ndef twice(x):\n    return 2 * x\n")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import tiny; "
    code += "from watchsim.jit import callable_kernel; print(callable_kernel(tiny.twice)(6.5))"
    assert python(code, WATCHSIM_CACHE=str(tmp_path / "new"), NUMBA_DISABLE_JIT="0") == "13.0"


def test_other_numba_users_keep_their_cache_folder(tmp_path: Path) -> None:
    (tmp_path / "tiny.py").write_text("from watchsim.jit import entry\n@entry\ndef twice(x):\n    return 2 * x\n")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import numba, tiny; tiny.twice(4); print(numba.config.CACHE_DIR)"
    )
    cache = {"WATCHSIM_CACHE": str(tmp_path / "new"), "NUMBA_CACHE_DIR": "theirs", "NUMBA_DISABLE_JIT": "0"}
    assert python(code, **cache) == "theirs"


# Does machine code that was damaged get compiled again, and is nothing loaded that somebody else could have put there?

Printed = Callable[[Path, Path], tuple[str, str]]  # from a cache and a script to what both streams say

CODE = """
import numpy as np
from watchsim.jit import entry
@entry
def twice(x):
    return 2.0 * x
print(twice(21.0), end=" ")
print(twice.stats.cache_hits.total() if hasattr(twice.stats.cache_hits, "total") else sum(twice.stats.cache_hits.values()))
"""


def printed(cache: Path, script: Path, **more: str) -> tuple[str, str]:
    """Standard output and error of a process that compiles one small function, or finds it."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WATCHSIM_CACHE": str(cache), **more}
    done = subprocess.run([sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True)
    return done.stdout.strip(), done.stderr


@pytest.fixture
def script(tmp_path: Path) -> Path:
    return written(tmp_path)


def written(folder: Path) -> Path:
    path = folder / "twice.py"
    path.write_text(CODE)
    return path


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A script, and a cache with its machine code, which a second process has found."""
    folder = tmp_path_factory.mktemp("kept")
    script, cache = written(folder), folder / "cache"
    assert printed(cache, script) == ("42.0 0", "")
    assert printed(cache, script) == ("42.0 1", "")
    return script, cache


@pytest.fixture
def printed_here(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Iterator[Printed]:
    """The same as `printed` in this process, which has loaded the compiler."""

    def run(cache: Path, script: Path) -> tuple[str, str]:
        monkeypatch.setenv("WATCHSIM_CACHE", str(cache))
        forget()
        runpy.run_path(str(script))
        told = capsys.readouterr()
        return told.out.strip(), told.err

    yield run
    forget()


def forget() -> None:
    """Which folder holds the cache, and what was complained of."""
    machine_code.cache_folder.cache_clear()
    machine_code.complain.cache_clear()


@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", ["empty", "cut", "foreign", "one bit"])
def test_damaged_files_are_compiled_again(
    ending: str, damage: str, kept: tuple[Path, Path], printed_here: Printed, tmp_path: Path
) -> None:
    script, cache = kept[0], tmp_path / "cache"
    shutil.copytree(kept[1], cache)
    assert printed_here(cache, script) == ("42.0 1", "")
    (path,) = cache.rglob(f"*.{ending}")
    whole = path.read_bytes()
    flipped = whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:]
    path.write_bytes(
        {"empty": b"", "cut": whole[:200], "foreign": b"cos\nsystem\n(S'false'\ntR." * 9, "one bit": flipped}[damage]
    )
    told, said = printed_here(cache, script)
    assert told == "42.0 0" and str(path) in said and "WATCHSIM_CACHE" in said and "Traceback" not in said
    assert printed_here(cache, script) == ("42.0 1", ""), "what was compiled again is found again"


def test_a_full_disk_is_named_and_costs_only_time(script: Path, tmp_path: Path) -> None:
    full = script.with_name("full.py")
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (99, 99))"  # Python ignores the signal
    full.write_text(f"{limit}\n{CODE}")
    told, said = printed(tmp_path / "cache", full)
    assert told == "42.0 0" and str(tmp_path / "cache") in said and "WATCHSIM_CACHE" in said and "File too large" in said


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="users of Unix")
def test_nothing_is_kept_where_others_can_write(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir()
    shared.chmod(0o777)
    assert "where others can write" in machine_code._refusal(shared / "mine" / "kernels", others_may_write=False)
    shared.chmod(0o1777)
    assert machine_code._refusal(shared / "mine" / "kernels", others_may_write=False) == ""
    (shared / "mine").chmod(0o775)
    assert "where others can write" in machine_code._refusal(shared / "mine" / "kernels", others_may_write=False)


def test_without_any_folder_it_still_runs(script: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    told, said = printed(tmp_path / "file" / "cache", script, TMPDIR=str(tmp_path / "open"))
    assert told == "42.0 0" and "compiled each time" in said and "WATCHSIM_CACHE" in said


# Parts that call parts, a hot one, one that is inlined, and a struct by reference, as the kernels of a run have them.
LIKE_A_RUN = """
from typing import NamedTuple
import numpy as np
from watchsim.jit import by_reference, entry, hot_kernel, inlined, kernel
class Room(NamedTuple):
    values: np.ndarray
    inverse: np.ndarray
RoomRef = by_reference(Room, __name__)
@hot_kernel
def least(a, b):
    return a if a < b else b
@kernel
def filled(room):
    for i in range(room.values.size):
        room.inverse[i] = least(1.0 / room.values[i], 5.0)
@kernel
def total(room):
    filled(room)
    return room.inverse.sum()
@inlined
def wrapped(room):
    return RoomRef(room.values, room.inverse)
@entry
def run(room):
    return total(wrapped(room))
def answer():
    room = Room(np.array([0.0, 0.25, 0.5, -3.0]), np.zeros(4))
    return run(room), room.inverse.tolist(), sum(run.stats.cache_hits.values())
"""


@pytest.mark.parametrize("release", ["0.60.0", "0.59.1", "0.69.0", "1.0.0rc1"])
def test_with_a_release_that_was_not_tried_plain_njit_gives_the_same(release: str, tmp_path: Path) -> None:
    """Compiled, and found by a second process; with one that was tried, parts have a compiler of their own."""
    (tmp_path / "like_a_run.py").write_text(LIKE_A_RUN)
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import numba; numba.__version__ = {release!r}; "
    code += "import watchsim.jit; import like_a_run as r; print(watchsim.jit.as_tried(), *r.answer()); "
    code += "print(r.total.dispatcher._compiler.pipeline_class.__name__)"
    cache = {"WATCHSIM_CACHE": str(tmp_path / "new"), "NUMBA_DISABLE_JIT": "0"}
    tried = release == "0.60.0"
    for found in (0, 1):
        assert python(code, **cache).splitlines() == [
            f"{tried} {5.0 + 4.0 + 2.0 - 1 / 3!r} [5.0, 4.0, 2.0, {-1 / 3!r}] {found}",
            "PartCompiler" if tried else "Compiler",
        ]


def test_pyproject_bounds_numba_to_the_releases_that_were_tried() -> None:
    (needed,) = (
        one
        for one in tomllib.loads((Path(__file__).resolve().parents[1] / "pyproject.toml").read_text())["project"][
            "dependencies"
        ]
        if one.startswith("numba")
    )
    (first, last) = jit.TRIED
    assert needed == f"numba>={first[0]}.{first[1]},<{last[0]}.{last[1] + 1}" and jit.as_tried()


def test_one_compiles_and_nobody_waits_for_the_dead(script: Path, tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl", reason="locks of files")
    cache = tmp_path / "cache"
    assert printed(cache, script) == ("42.0 0", "")
    (lock,) = cache.rglob("*.lock")
    for path in cache.rglob("*.nb?"):
        path.unlink()
    held = "import fcntl, sys, time; f = open(sys.argv[1]); fcntl.flock(f, fcntl.LOCK_EX); print(flush=True); time.sleep(600)"
    holder = subprocess.Popen([sys.executable, "-c", held, str(lock)], stdout=subprocess.PIPE)
    assert holder.stdout is not None and holder.stdout.readline()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WATCHSIM_CACHE": str(cache)}
    pipe = subprocess.PIPE
    waiting = subprocess.Popen([sys.executable, str(script)], env=environment, stdout=pipe, stderr=pipe, text=True)
    assert waiting.stderr is not None and "waiting for it" in waiting.stderr.readline()
    assert waiting.poll() is None and not list(cache.rglob("*.nbi"))
    holder.kill()
    assert waiting.communicate(timeout=60)[0].strip() == "42.0 0"
    holder.wait()
    with lock.open() as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # let go
        assert printed(cache, script) == ("42.0 1", ""), "what is there needs no lock"
