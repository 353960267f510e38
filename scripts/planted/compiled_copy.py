"""Do compiled tests notice a fault, without recompiling everything?"""

import argparse
import ast
import os
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from watchsim.jit_cache import PACKAGE, cache_folder

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("watchsim", "profiles", "tests", "scripts", "docs", "pyproject.toml", "README.md")
FIRST = "tests/simulation/test_recorded_runs.py"  # many short runs


class CompiledCopy:
    """A copy of the project in which faults are planted and tests are run."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in COPIED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__", "images"))
            else:
                shutil.copy(source, folder / name)

    def seconds(self, tests: Sequence[str], limit: float | None, *options: str) -> tuple[bool, float]:
        """Do the tests pass, and how long did they take? Too long is a failure."""
        start = time.monotonic()
        try:
            command = ["-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *options, *tests]
            passed = self._python(command, limit).returncode == 0
        except subprocess.TimeoutExpired:
            passed = False
        return passed, time.monotonic() - start

    def cheapest_first(self, tests: Sequence[str]) -> tuple[list[str], float]:
        """The files of these tests, the recorded runs first and then by the time they take, which all are asked for once."""
        report = self.folder / "times.xml"
        passed, seconds = self.seconds(tests, None, f"--junitxml={report}")
        cases = list(ET.parse(report).iter("testcase"))
        if not passed:
            failed = [case.get("name") for case in cases if case.find("failure") is not None or case.find("error") is not None]
            raise SystemExit(f"the tests fail without any fault: {', '.join(map(str, failed))}")
        cost: Counter[str] = Counter()
        for case in cases:
            cost[_file_of(self.folder, case.get("classname", ""))] += int(1e6 * float(case.get("time", 0.0)))
        return sorted(cost, key=lambda file: (not file.startswith(FIRST), cost[file])), seconds

    def notices(self, file: str, source: str, tests: Sequence[str], limit: float) -> bool:
        """Does one of the tests fail with that text in place of the file? Machine code that does not depend on it is kept."""
        path = self.folder / "watchsim" / file
        whole, stat, key = path.read_bytes(), path.stat(), self.key()
        kept = set(self._machine_code())
        try:
            path.write_text(source, encoding="utf-8")
            self.key(key, file)
            first, others = ([one for one in tests if one.startswith(FIRST) is so] for so in (True, False))
            return not all(self.seconds(some, limit)[0] for some in (first, others) if some)
        finally:
            path.write_bytes(whole)
            os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))  # numba asks whether a file is as old as its machine code
            for folder in set(self._machine_code()) - kept:
                shutil.rmtree(folder, ignore_errors=True)

    def key(self, before: str = "", changed: str = "") -> str:
        """The key of the machine code of the package as it is, to which is handed on what a change has left as it was."""
        command = [str(self.folder / "scripts" / "planted" / "compiled_copy.py"), *([before, changed] if before else [])]
        return self._python(command, None).stdout.decode().strip()

    def _python(self, command: list[str], limit: float | None) -> subprocess.CompletedProcess[bytes]:
        environment = os.environ | {
            **{"PYTHONPATH": str(self.folder), "PYTHONDONTWRITEBYTECODE": "1", "NUMBA_DISABLE_JIT": "0"},
            "WATCHSIM_CACHE": str(self.folder / "cache"),
        }
        return subprocess.run(
            [sys.executable, *command], cwd=self.folder, env=environment, capture_output=True, timeout=limit, check=False
        )

    def _machine_code(self) -> list[Path]:
        return list(self.folder.glob("cache/**/kernels/*"))


def _file_of(folder: Path, name: str) -> str:
    """The test file of a dotted name, which may end with classes."""
    parts = name.split(".")
    while not (folder / "/".join(parts)).with_suffix(".py").is_file():
        parts.pop()
    return "/".join(parts) + ".py"


# Which machine code still holds when one file has changed?
#
# The cache of kernels is keyed by all their sources together. What was compiled from files that do not import the changed
# one, not even through others, is handed on to the new key: `python compiled_copy.py KEY FILE`, with the key before the
# change and the file's path in the package, writes there and prints the new key; without arguments it only prints the key.
# Tests' own kernels are not handed on.


def dependents(changed: Path) -> set[str]:
    """The names (without .py) of the files that import a file, directly or not, and its own."""
    imported = {path: set(_imported(path)) for path in PACKAGE.rglob("*.py")}
    found = {changed}
    while more := {path for path, uses in imported.items() if uses & found} - found:
        found |= more
    return {path.stem for path in found}


def _imported(path: Path) -> Iterator[Path]:
    """The files that a file may import from, at its top or within a function."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == PACKAGE.name:
            module = PACKAGE.joinpath(*node.module.split(".")[1:])
            yield from (module.with_suffix(".py"), *(module / f"{name.name}.py" for name in node.names))


def hand_on(before: Path, after: Path, changed: Path) -> None:
    """Copy what does not depend on the changed file."""
    known = {path.stem for path in PACKAGE.rglob("*.py")} - dependents(changed)
    for path in before.glob("*/*.nb?"):
        if path.name.split(".", 1)[0] in known and not path.parent.name.startswith("tests"):
            (after / path.parent.name).mkdir(exist_ok=True)
            shutil.copy2(path, after / path.parent.name / path.name)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("key", nargs="?", help="of the sources before the change")
    parser.add_argument("file", nargs="?", type=Path, help="what has changed, its path in the package")
    given = parser.parse_args()
    now = cache_folder()
    assert now is not None
    if given.key and given.file and now.name != given.key:
        hand_on(now.parent / given.key, now, PACKAGE / given.file)
    print(now.name)


if __name__ == "__main__":
    main()
