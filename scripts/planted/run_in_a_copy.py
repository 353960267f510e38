"""How are tests run with a fault in the code?

In a copy of a process that has loaded everything but the package; the faulty text stands in for the file as it is imported.
"""

import contextlib
import importlib.machinery
import importlib.util
import io
import os
import resource
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = str(ROOT / "watchsim") + os.sep
MEMORY = 8 * 2**30  # B, that a process with a fault may take
OPTIONS = ["-q", "-p", "no:cacheprovider", "--no-header", "-W", "ignore"]
LIBRARIES = ("numba", "scipy.spatial", "scipy.interpolate", "scipy.optimize", "shapely", "ezdxf", "hypothesis", "mpmath")


def load() -> None:
    """Load what the tests need, but not the package."""
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    sys.path[:0] = [str(ROOT), str(ROOT / "tests")]


def fails(tests: Sequence[str], file: str, source: str, limit: float) -> bool:
    """Does one of the tests fail, or take more than so many seconds of processor time, with that text in place of the file?"""

    def work() -> tuple[int, str]:
        faulty: Any = _Faulty(f"watchsim.{file.removesuffix('.py').replace('/', '.')}", PACKAGE + file, source)
        sys.meta_path.insert(0, faulty)
        return run_tests(["-x", *tests], []), ""

    return in_a_copy(work, limit)[0] != 0


class _Faulty(importlib.machinery.SourceFileLoader):
    """Imports one module from another text than that of its file."""

    def __init__(self, name: str, path: str, source: str) -> None:
        super().__init__(name, path)
        self._text = source

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> Any:
        return importlib.util.spec_from_file_location(fullname, self.path, loader=self) if fullname == self.name else None

    def get_code(self, fullname: str) -> CodeType:
        return compile(self._text, self.path, "exec")


def run_tests(tests: list[str], plugins: list[object]) -> int:
    """The exit status of pytest in this process."""
    os.chdir(ROOT)
    return int(pytest.main([*OPTIONS, *tests], plugins=plugins))


def in_a_copy(work: Callable[[], tuple[int, str]], limit: float | None) -> tuple[int, str]:
    """(status, text) that `work` gives in a copy of this process, which ends after so many seconds of processor time."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        status = 70
        try:
            os.setpgid(0, 0)
            nowhere = os.open(os.devnull, os.O_RDWR)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            if limit is not None:
                resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 1))
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
                signal.alarm(int(60.0 * limit))  # on the clock: something waits for ever
            with contextlib.redirect_stdout(io.StringIO()) as said:
                status, text = work()
            with os.fdopen(writing, "w") as pipe:
                pipe.write(text if status == 0 else said.getvalue())
        finally:
            os._exit(status)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        text = pipe.read()
    status = os.waitpid(child, 0)[1]
    with contextlib.suppress(OSError):
        os.killpg(child, signal.SIGKILL)  # what a test has started
    return status, text
