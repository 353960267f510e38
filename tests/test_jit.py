"""Are kernels compiled once and then found, and can they be left plain Python?"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from interpreter import ROOT, python

from watchsim import jit

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


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
        for one in tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
        if one.startswith("numba")
    )
    (first, last) = jit.TRIED
    assert needed == f"numba>={first[0]}.{first[1]},<{last[0]}.{last[1] + 1}" and jit.as_tried()


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
    code = "from watchsim.jit import callable_kernel; from watchsim.dynamics.lcp.scaling import _power_of_two as f; "
    code += "print(callable_kernel(f)(6.5))"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_DISABLE_JIT="0") == "8.0"


def test_other_numba_users_keep_their_cache_folder(tmp_path: Path) -> None:
    code = "import numba, watchsim.dynamics.lcp.lemke_pivoting; print(numba.config.CACHE_DIR)"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_CACHE_DIR="theirs") == "theirs"
