"""Which tests reach which functions, and how long does each take?

Every test is run once while the functions of the package that it calls are written down. With a fault in one of them only these
tests need be run, the quickest first (see run_in_a_copy.py).
"""

import ast
import hashlib
import json
import math
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import accumulate
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest
from run_in_a_copy import PACKAGE, ROOT, in_a_copy, run_tests


@dataclass
class Reached:
    """For each test: the seconds it took, and (file, name) of the functions it called."""

    seconds: dict[str, float] = field(default_factory=dict)
    called: dict[str, set[tuple[str, str]]] = field(default_factory=dict)

    def tests(self, file: str, function: str) -> list[str]:
        """The tests that reach a function, quickest first; of what is done at import, those that reach anything of the file.

        Or of files that import from it: nothing of a table of constants is called. So they are for a function that no test
        reaches: it may be called while tests are collected. Tests that import the file themselves come before these: they may
        look at its constants and call nothing.
        """
        whole = function == MODULE
        own, users = (_importers(file), _users(file)) if whole else (frozenset(), frozenset())
        hit = [
            name for name, called in self.called.items()
            if (file, function) in called
            or (whole and (name.split("::")[0] in own or any(one == file or one in users for one, _ in called)))
        ]  # fmt: skip
        if not hit and not whole:
            return self.tests(file, MODULE)
        return sorted(hit, key=lambda name: (name.split("::")[0] not in own, self.seconds[name]))

    def within(self, tests: Sequence[str], seconds: float) -> list[str]:
        """As many of the tests as take no longer together, the first in any case."""
        ends = accumulate(self.seconds[name] for name in tests)
        return [name for place, (name, end) in enumerate(zip(tests, ends, strict=True)) if not place or end <= seconds]

    def with_neighbours(self, tests: Sequence[str]) -> list[str]:
        """The tests, and then the others of their files, quickest first: what all use may be recorded for one only."""
        files, known = {name.split("::")[0] for name in tests}, set(tests)
        others = [name for name in self.seconds if name.split("::")[0] in files and name not in known]
        return [*tests, *sorted(others, key=self.seconds.__getitem__)]

    def text(self) -> str:
        """As JSON."""
        return json.dumps({"seconds": self.seconds, "called": {name: sorted(hits) for name, hits in self.called.items()}})

    @classmethod
    def of(cls, text: str) -> "Reached":
        """What `text` has written."""
        loaded = json.loads(text)
        return cls(
            loaded["seconds"], {name: {(file, function) for file, function in hits} for name, hits in loaded["called"].items()}
        )


@cache
def _importers(file: str) -> frozenset[str]:
    """The test files that name the module of a file."""
    return _naming(file, ROOT / "tests", "test_*.py", ROOT)


@cache
def _users(file: str) -> frozenset[str]:
    """The files of the package that import from a file."""
    return _naming(file, Path(PACKAGE), "*.py", Path(PACKAGE))


def _naming(file: str, folder: Path, pattern: str, base: Path) -> frozenset[str]:
    module = f"watchsim.{file.removesuffix('.py').replace('/', '.')} import"
    found = (path for path in folder.rglob(pattern) if module in path.read_text(encoding="utf-8"))
    return frozenset(path.relative_to(base).as_posix() for path in found)


class _Recorder:
    """A plugin of pytest that writes down what each test calls. Tests that fail, or take longer, are left out."""

    def __init__(self, longest: float) -> None:
        self.reached = Reached()
        self._codes: set[CodeType] = set()
        self._longest = longest if math.isfinite(longest) else 0.0  # 0: no alarm
        self._left_out = False

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        self._codes, self._left_out = set(), False
        begun = time.process_time()
        sys.setprofile(self._note)
        yield
        sys.setprofile(None)
        if self._left_out:
            return
        self.reached.seconds[item.nodeid] = time.process_time() - begun
        codes = [code for code in self._codes if code.co_filename.startswith(PACKAGE)]
        self.reached.called[item.nodeid] = {
            (code.co_filename.removeprefix(PACKAGE), function)
            for code in codes
            for function in names_at(code.co_filename).get(code.co_firstlineno, ())
        }

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_setup(self) -> Iterator[None]:
        yield from self._within_the_time()

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_call(self) -> Iterator[None]:
        yield from self._within_the_time()

    def pytest_runtest_logreport(self, report: Any) -> None:
        self._left_out |= bool(report.failed)

    def _within_the_time(self) -> Iterator[None]:
        signal.signal(signal.SIGPROF, self._too_long)
        signal.setitimer(signal.ITIMER_PROF, self._longest)
        yield
        signal.setitimer(signal.ITIMER_PROF, 0.0)

    def _too_long(self, *_: object) -> None:
        self._left_out = True
        pytest.skip("takes too long to be run for every fault")

    def _note(self, frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            self._codes.add(frame.f_code)


def recorded(tests: Sequence[str], longest: float = math.inf) -> Reached:
    """Run the tests once; SystemExit where one fails without any fault.

    With `longest` (s of processor time) only those count that take no longer and pass: as plain Python some need the compiler.
    """
    recorder = _Recorder(longest)

    def work() -> tuple[int, str]:
        status = run_tests(list(tests), [recorder])
        passed = status == 0 or (math.isfinite(longest) and status == pytest.ExitCode.TESTS_FAILED)
        return 0 if passed else status, recorder.reached.text()

    status, said = in_a_copy(work, None)
    if status != 0:
        raise SystemExit(f"the tests fail without any fault: {said[-2000:]}")
    return Reached.of(said)


def kept(path: Path, tests: Sequence[str], longest: float = math.inf) -> Reached:
    """What was recorded in a file, and the test files that have changed since recorded again."""
    files = sorted(
        {file for one in tests for file in ([ROOT / one] if one.endswith(".py") else (ROOT / one).rglob("test_*.py"))}
    )
    digests = {file.relative_to(ROOT).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
    before = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {"digests": {}, "seconds": {}, "called": {}}
    changed = [file for file, digest in digests.items() if before["digests"].get(file) != digest]
    old = Reached.of(json.dumps(before))
    new = recorded(tests if len(changed) == len(digests) else changed, longest) if changed else Reached()
    for name in [name for name in old.seconds if name.split("::")[0] in digests and name.split("::")[0] not in changed]:
        new.seconds[name], new.called[name] = old.seconds[name], old.called[name]
    if changed:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(json.loads(new.text()) | {"digests": digests}), encoding="utf-8")
    return new


# What are the functions of a source called, and in which of them is a line?

MODULE = ""  # the "function" of what is done while a file is imported


class Function(NamedTuple):
    """Where a function stands: its first line with decorators, that of its body, and its last one."""

    first: int
    body: int
    last: int
    name: str


def functions(source: str) -> list[Function]:
    """Every function, inner ones after what they stand in. Those of one name are told apart by their order."""
    found: list[Function] = []
    seen: Counter[str] = Counter()

    def look(node: ast.AST, prefix: str) -> None:
        for child in ast.iter_child_nodes(node):
            inner = prefix
            if isinstance(child, (ast.FunctionDef, ast.ClassDef, ast.Lambda)):
                name = prefix + getattr(child, "name", "lambda")
                inner = name + "."
            if isinstance(child, (ast.FunctionDef, ast.Lambda)):
                seen[name] += 1
                first = min([child.lineno, *(one.lineno for one in getattr(child, "decorator_list", []))])
                body = child.body[0].lineno if isinstance(child, ast.FunctionDef) else child.lineno
                own = name if seen[name] == 1 else f"{name} {seen[name]}"
                found.append(Function(first, body, child.end_lineno or child.lineno, own))
            look(child, inner)

    look(ast.parse(source), "")
    return found


def function_of(source: str, line: int) -> str:
    """The name of the innermost function in whose body a line is; MODULE where it is in none (defaults, constants)."""
    holding = [one for one in functions(source) if one.body <= line <= one.last]
    return max(holding, default=Function(0, 0, 0, MODULE)).name


@cache
def names_at(path: str) -> dict[int, list[str]]:
    """The names of the functions that begin in a line of a file."""
    found: dict[int, list[str]] = {}
    for one in functions(Path(path).read_text(encoding="utf-8")):
        found.setdefault(one.first, []).append(one.name)
    return found
