"""Do the tests notice small faults in the code?

Faults are planted one at a time at random places (a seed says which), and the tests that reach the place are run until one
fails (see reached.py). In the area "plain" kernels run as the plain Python that they are, by those tests that are quick even
so: nothing need be compiled. In the area "kernels" what these miss goes into a copy of the project, which compiles what depends
on it: the recorded runs first, then all tests of that part, the cheapest files first. What none of the tests notices is listed;
what was judged harmless stands in scripts/planted/faults_judged.csv with the reason.
Ends with 1 where fewer than 95 % of all others were noticed.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from compiled_copy import CompiledCopy
from faults import Fault, faults
from reached import Reached, fails, function_of, load, recorded

ROOT = Path(__file__).resolve().parents[2]
JUDGED = ROOT / "scripts" / "planted" / "faults_judged.csv"
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
    parser.add_argument("--seconds", type=float, default=LONGEST, help="of tests for one fault (default %(default)s)")
    parser.add_argument("--longest", type=float, default=LONGEST_PLAIN, help="s, of one test in plain Python (%(default)s)")
    parser.add_argument("--reached", type=Path, help="folder in which is kept which tests reach what, for the next sample")
    given = parser.parse_args()
    begun, known = time.monotonic(), judged()
    tally: Counter[tuple[str, str]] = Counter()
    with tempfile.TemporaryDirectory(prefix="faults-") as scratch:
        for area in given.areas:
            try_out = tiered(Path(scratch), given) if area == COMPILED else interpreted(area, given)
            for planted in chosen(area, given.count, given.seed):
                if time.monotonic() - begun > 60.0 * given.minutes:
                    break
                verdict = "judged" if planted.is_judged(known) else ""
                if not verdict:
                    verdict = "noticed" if try_out(planted) else "missed"
                tally[area, verdict] += 1
                tell(planted, verdict, given.output)
    return report(tally, given.areas)


def tiered(scratch: Path, given: argparse.Namespace) -> Callable[[Planted], bool]:
    """What tells whether a fault of the kernels is noticed, by quick tests in plain Python or else by compiled ones."""
    plain = interpreted(PLAIN, given)
    copy = CompiledCopy(scratch / "project")
    tests, seconds = copy.cheapest_first(AREAS[COMPILED][1])
    print(f"{COMPILED}: {seconds:.0f} s without a fault", flush=True)
    limit = max(LEAST, PATIENCE * seconds)
    return lambda planted: plain(planted) or copy.notices(planted.file, planted.fault.source, tests, limit)


def interpreted(area: str, given: argparse.Namespace) -> Callable[[Planted], bool]:
    """What tells whether a fault of what Python runs is noticed."""
    os.environ["NUMBA_DISABLE_JIT"] = str(int(area == PLAIN))
    load()
    reached = _reached(area, given)
    whole = sum(reached.seconds.values())
    print(f"{area}: {len(reached.seconds)} tests, {whole:.0f} s without a fault", flush=True)

    def notices(planted: Planted) -> bool:
        source = (ROOT / "watchsim" / planted.file).read_text(encoding="utf-8")
        tests: list[str] = []
        seconds = 0.0
        for name in reached.tests(planted.file, function_of(source, planted.fault.line)):
            seconds += reached.seconds[name]
            if tests and seconds > given.seconds:
                break
            tests.append(name)
        return bool(tests) and fails(tests, planted.file, planted.fault.source, max(LEAST, PATIENCE * given.seconds))

    return notices


def _reached(area: str, given: argparse.Namespace) -> Reached:
    """Which tests reach what, from the last time or by running them all."""
    path = given.reached / f"{area}.json" if given.reached else None
    if path is not None and path.is_file():
        return Reached.of(path.read_text(encoding="utf-8"))
    reached = recorded(AREAS[area][1], given.longest if area == PLAIN else math.inf)
    if path is not None:
        path.write_text(reached.text(), encoding="utf-8")
    return reached


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
