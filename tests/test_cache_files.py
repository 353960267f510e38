"""Does machine code that was damaged get compiled again, and is nothing loaded that somebody else could have put there?"""

from __future__ import annotations

import os
import runpy
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from interpreter import ROOT

from watchsim import machine_code

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
