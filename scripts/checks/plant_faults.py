"""Do the tests notice small faults in the code?

Faults are planted one at a time at random places (a seed says which), and the tests that reach the place are run until one
fails (see reached.py). Those of the kernels go into a copy of the project, which compiles them, and all tests of that part
are run; in the area "plain" kernels run as the plain Python that they are, by those tests that are quick even so: nothing
need be compiled. What none of the
tests notices is listed; what was judged harmless stands in scripts/checks/faults_judged.csv with the reason.
Ends with 1 where fewer than 95 % of all others were noticed.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from faults import Fault, faults
from reached import fails, function_of, load, recorded

ROOT = Path(__file__).resolve().parents[2]
JUDGED = ROOT / "scripts" / "checks" / "faults_judged.csv"
COPIED = ("watchsim", "profiles", "tests", "scripts", "pyproject.toml", "README.md")
ENOUGH = 0.95
PATIENCE = 5.0  # times what the tests take without a fault; an endless loop is noticed, too
LEAST = 120.0  # s
LONGEST = 40.0  # s of tests for one fault, the quickest of those that reach it
LONGEST_PLAIN = 3.0  # s for one test of kernels in plain Python, a hundred times slower than compiled
Harmless = dict[tuple[str, str, str], set[str]]  # (file, before, after) -> lines of code in which that is so; "": in all
RECORDS = "tests/records"
COMPILED = "kernels"
PLAIN = "plain"
AREAS = {  # name -> (files, tests)
    "reader": (("drawing/**/*.py",), ("tests/drawing", "tests/construction", RECORDS)),
    "geometry": (
        ("geometry/**/*.py",),
        (
            "tests/geometry",
            RECORDS,
            "tests/drawing/chaining/test_chain.py",
            "tests/drawing/curves/test_splines.py",
            "tests/drawing/test_profile.py",
            "tests/render/test_glb_motion.py",
        ),
    ),
    "scene": (
        ("scene/**/*.py", "mechanism/*.py", "units.py"),
        ("tests/scene", "tests/mechanism", "tests/designs", "tests/test_units.py", "tests/simulation/bound", RECORDS),
    ),
    "analysis": (
        ("analysis/**/*.py", "results/*.py", "verification/**/*.py"),
        ("tests/analysis", "tests/results", "tests/verification", "tests/render/figures/test_tape_plot.py", RECORDS),
    ),
    "pictures": (
        (
            "render/movies/run_movie.py",
            "render/frame/pose_history.py",
            "render/figures/speed_plot.py",
            "render/frame/marks/readouts.py",
            "render/movies/encoder.py",
            "render/movies/busy_stretches.py",
            "render/keyframes.py",
            "render/fewest_rows.py",
        ),
        ("tests/render", RECORDS),
    ),
    "plain": (
        ("dynamics/**/*.py", "candidates/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation"),
    ),
    "kernels": (
        ("dynamics/**/*.py", "candidates/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
        ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation"),
    ),
}


@dataclass(frozen=True)
class Planted:
    """A fault in a file of the package, and what became of it."""

    area: str
    file: str
    fault: Fault

    def is_judged(self, known: Harmless) -> bool:
        """Is it known as harmless, wherever such a thing stands in the file or in that line of code?"""
        codes = known.get((self.file, self.fault.before, self.fault.after), set())
        text = (ROOT / "watchsim" / self.file).read_text(encoding="utf-8").splitlines()[self.fault.line - 1]
        return not codes.isdisjoint(("", text.strip()))


class Copy:
    """A copy of the project in which faults are planted and tests are run."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in COPIED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, folder / name)

    def seconds(self, tests: tuple[str, ...], limit: float | None) -> tuple[bool, float]:
        """Do the tests pass, and how long did they take? Too long is a failure."""
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
        environment = os.environ | {
            **{"PYTHONPATH": str(self.folder), "PYTHONDONTWRITEBYTECODE": "1"},
            "WATCHSIM_CACHE": str(self.folder / "cache"),
        }
        start = time.monotonic()
        try:
            run = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, timeout=limit, check=False)
            passed = run.returncode == 0
        except subprocess.TimeoutExpired:
            passed = False
        return passed, time.monotonic() - start

    def notices(self, planted: Planted, tests: tuple[str, ...], limit: float) -> bool:
        path = self.folder / "watchsim" / planted.file
        whole = path.read_bytes()
        kept = set(self._machine_code())
        try:
            path.write_text(planted.fault.source, encoding="utf-8")
            return not self.seconds(tests, limit)[0]
        finally:
            path.write_bytes(whole)
            for folder in set(self._machine_code()) - kept:
                shutil.rmtree(folder, ignore_errors=True)

    def _machine_code(self) -> list[Path]:
        return list(self.folder.glob("cache/**/kernels/*"))


def chosen(area: str, count: int, seed: int) -> list[Planted]:
    """A random sample of all faults of an area, every file with the chance of its size."""
    found = []
    for pattern in AREAS[area][0]:
        for path in sorted((ROOT / "watchsim").glob(pattern)):
            name = path.relative_to(ROOT / "watchsim").as_posix()
            found += [Planted(area, name, fault) for fault in faults(path.read_text(encoding="utf-8"))]
    return random.Random(f"{seed} {area}").sample(found, min(count, len(found)))


def judged() -> Harmless:
    """What changes nothing that matters, for the reasons given in the list."""
    known: Harmless = {}
    if JUDGED.is_file():
        with JUDGED.open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                known.setdefault((row["file"], row["before"], row["after"]), set()).add(row["code"])
    return known


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--areas", nargs="+", choices=AREAS, default=list(AREAS))
    parser.add_argument("--count", type=int, default=60, help="faults in each area (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=600.0, help="begin no fault after that time (default %(default)s)")
    parser.add_argument("--output", type=Path, help="where to write all faults as JSON lines")
    given = parser.parse_args()
    begun, known = time.monotonic(), judged()
    tally: Counter[tuple[str, str]] = Counter()
    with tempfile.TemporaryDirectory(prefix="faults-") as scratch:
        for area in given.areas:
            try_out = compiled(Path(scratch), area) if area == COMPILED else interpreted(area)
            for planted in chosen(area, given.count, given.seed):
                if time.monotonic() - begun > 60.0 * given.minutes:
                    break
                verdict = "judged" if planted.is_judged(known) else ""
                if not verdict:
                    verdict = "noticed" if try_out(planted) else "missed"
                tally[area, verdict] += 1
                tell(planted, verdict, given.output)
    return report(tally, given.areas)


def compiled(scratch: Path, area: str) -> Callable[[Planted], bool]:
    """What tells whether a fault of the kernels is noticed."""
    copy, tests = Copy(scratch / "project"), AREAS[area][1]
    passed, seconds = copy.seconds(tests, None)
    if not passed:
        raise SystemExit(f"{area}: the tests fail without any fault")
    print(f"{area}: {seconds:.0f} s without a fault", flush=True)
    return lambda planted: copy.notices(planted, tests, max(LEAST, PATIENCE * seconds))


def interpreted(area: str) -> Callable[[Planted], bool]:
    """What tells whether a fault of what Python runs is noticed."""
    os.environ["NUMBA_DISABLE_JIT"] = str(int(area == PLAIN))
    load()
    reached = recorded(AREAS[area][1], LONGEST_PLAIN if area == PLAIN else math.inf)
    whole = sum(reached.seconds.values())
    print(f"{area}: {len(reached.seconds)} tests, {whole:.0f} s without a fault", flush=True)

    def notices(planted: Planted) -> bool:
        source = (ROOT / "watchsim" / planted.file).read_text(encoding="utf-8")
        tests: list[str] = []
        seconds = 0.0
        for name in reached.tests(planted.file, function_of(source, planted.fault.line)):
            seconds += reached.seconds[name]
            if tests and seconds > LONGEST:
                break
            tests.append(name)
        return bool(tests) and fails(tests, planted.file, planted.fault.source, max(LEAST, PATIENCE * LONGEST))

    return notices


def tell(planted: Planted, verdict: str, output: Path | None) -> None:
    fault = planted.fault
    if verdict == "missed":
        print(f"  MISSED  {planted.file}:{fault.line}:{fault.column}  {fault.before}  ->  {fault.after}", flush=True)
    if output is not None:
        row = {"file": planted.file, "line": fault.line, "before": fault.before, "after": fault.after, "verdict": verdict}
        with output.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"area": planted.area, **row}, ensure_ascii=False) + "\n")


def report(tally: Counter[tuple[str, str]], areas: list[str]) -> int:
    """A line for each area, and the verdict on all."""
    for area in areas:
        noticed, missed, harmless = (tally[area, verdict] for verdict in ("noticed", "missed", "judged"))
        print(f"{area:10} {noticed} of {noticed + missed} noticed, {harmless} judged harmless")
    noticed, missed = (sum(tally[area, verdict] for area in areas) for verdict in ("noticed", "missed"))
    share = noticed / max(1, noticed + missed)
    print(f"all        {noticed} of {noticed + missed} noticed: {share:.1%}")
    return 0 if share >= ENOUGH else 1


if __name__ == "__main__":
    sys.exit(main())
