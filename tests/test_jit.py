"""Are kernels compiled once and then found, and can they be left plain Python?"""

from __future__ import annotations

from pathlib import Path

from interpreter import python


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
    code = "from watchsim.jit import callable_kernel; from watchsim.dynamics.lcp.scaling import _power_of_two as f; "
    code += "print(callable_kernel(f)(6.5))"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_DISABLE_JIT="0") == "8.0"


def test_other_numba_users_keep_their_cache_folder(tmp_path: Path) -> None:
    code = "import numba, watchsim.dynamics.lcp.lemke_pivoting; print(numba.config.CACHE_DIR)"
    assert python(code, WATCHSIM_CACHE=str(tmp_path), NUMBA_CACHE_DIR="theirs") == "theirs"
