"""Do the tests notice small faults in the code?

Faults are planted one at a time, at random places (a seed says which) or with --every in turn, and the tests that reach the
place are run until one fails (see reached.py). First the tests of the same part of the project are asked, the quickest first;
what these miss is asked of the rest: all other tests of the usual suite that reach the place, then those in the same files.
Any test that fails counts; the output says whether one of the first did ("at once") or only one of the rest.

In the area "plain" kernels run as the plain Python that they are, by those tests that are quick even so: nothing need be
compiled. In the area "kernels" what these miss goes into a copy of the project, which compiles what depends on it: the recorded
runs first, then all tests of that part, the cheapest files first.

Which tests reach what takes minutes to record. With --reached it is kept: test files that have changed since are recorded
anew, and functions are known by their names; where a change of the package lets tests reach others, delete the folder. Where a
test starts watchsim in another process, that process runs without the fault, and what it calls is not recorded: such a test
notices only what it calls itself.

What no test notices is listed; what was judged harmless stands in docs/reports/planted-faults.csv with the reason.
Ends with 1 where fewer than 95 % of all others were noticed.
"""

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
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from compiled_copy import CompiledCopy
from faults import Fault, faults
from reached import Reached, function_of, kept, recorded
from run_in_a_copy import fails, load

ROOT = Path(__file__).resolve().parents[2]
JUDGED = ROOT / "docs" / "reports" / "planted-faults.csv"
ENOUGH = 0.95
PATIENCE = 5.0  # times what the tests take without a fault; an endless loop is noticed, too
LEAST = 120.0  # s, where something is compiled
LEAST_PLAIN = 60.0  # s, where nothing is
LONGEST = 40.0  # s of tests of the area for one fault, the quickest of those that reach it
LONGEST_PLAIN = 3.0  # s for one test of kernels in plain Python, a hundred times slower than compiled
REST = 300.0  # s of all other tests, for one fault that these miss
AT_ONCE, BY_THE_REST, MISSED, HARMLESS = "at once", "rest", "missed", "judged"  # what became of a fault
Harmless = dict[tuple[str, str, str], set[str]]  # (file, before, after) -> lines of code in which that is so; "": in all
RECORDS = "tests/records"
QUOTED = "tests/docs/test_quoted_constants.py"
COMPILED = "kernels"
PLAIN = "plain"
KERNELS = (
    ("dynamics/**/*.py", "contact/*.py", "simulation/**/*.py", "tolerances.py"),
    ("tests/dynamics", "tests/candidates", "tests/contact", "tests/simulation", QUOTED),
)
AREAS = {  # name -> (files, tests)
    "reader": (("drawing/**/*.py",), ("tests/drawing", "tests/construction", RECORDS)),
    "geometry": (
        ("geometry/**/*.py",),
        (
            *("tests/geometry", RECORDS, "tests/drawing/test_chaining.py", "tests/drawing/test_ellipses_and_splines.py"),
            *("tests/drawing/test_profile.py", "tests/render/test_solids_for_others.py"),
        ),
    ),
    "scene": (
        ("scene/**/*.py", "mechanism/*.py", "units.py"),
        (
            *("tests/scene", "tests/mechanism", "tests/designs", "tests/test_units.py"),
            *("tests/simulation/test_bound_bodies.py", RECORDS),
        ),
    ),
    "analysis": (
        ("analysis/**/*.py", "results/*.py", "verification/**/*.py"),
        ("tests/analysis", "tests/results", "tests/verification", "tests/render/test_curves_and_colours.py", RECORDS),
    ),
    "pictures": (
        (
            *("render/movie.py", "render/view.py", "render/phase_plots.py", "render/marks.py", "render/encoder.py"),
            *("render/keyframes.py", "render/rows.py"),
        ),
        ("tests/render", RECORDS),
    ),
    "studies": (
        ("studies/*.py", "escapement/*.py", "construction/*.py"),
        ("tests/studies", "tests/escapement", "tests/construction", "tests/turning", "tests/proposal", RECORDS),
    ),
    **dict.fromkeys((PLAIN, COMPILED), KERNELS),
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


def chosen(area: str, count: int, seed: int, patterns: Sequence[str] = ("**/*.py",), every: int = 1) -> list[Planted]:
    """A random sample of the faults of an area, every file with the chance of its size; 0: all, or every so many."""
    package = ROOT / "watchsim"
    wanted = {path for pattern in patterns for path in package.glob(pattern)}
    found = []
    for pattern in AREAS[area][0]:
        for path in sorted(wanted.intersection(package.glob(pattern))):
            name = path.relative_to(package).as_posix()
            found += [Planted(area, name, fault) for fault in faults(path.read_text(encoding="utf-8"))]
    if count:
        return random.Random(f"{seed} {area}").sample(found, min(count, len(found)))
    return sorted(found, key=lambda one: (one.file, one.fault.line, one.fault.column))[::every]


def judged() -> Harmless:
    """What changes nothing that matters, for the reasons given in the list."""
    known: Harmless = {}
    if JUDGED.is_file():
        with JUDGED.open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                known.setdefault((row["file"], row["before"], row["after"]), set()).add(row["code"])
    return known


def main() -> int:
    given = _arguments()
    begun, known = time.monotonic(), judged()
    tally: Counter[tuple[str, str]] = Counter()
    with tempfile.TemporaryDirectory(prefix="faults-") as scratch:
        for area in given.areas:
            drawn = chosen(area, given.count, given.seed, given.files, given.every)
            if not drawn:
                continue
            try_out = tiered(Path(scratch), given) if area == COMPILED else interpreted(area, given)
            for planted in drawn:
                if time.monotonic() - begun > 60.0 * given.minutes:
                    break
                verdict = HARMLESS if planted.is_judged(known) else try_out(planted)
                tally[area, verdict] += 1
                tell(planted, verdict, given.output)
    return report(tally, given.areas)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--areas", nargs="+", choices=AREAS, default=list(AREAS))
    parser.add_argument(
        "--files", nargs="+", default=["**/*.py"], help="only in these below watchsim/, such as 'drawing/svg/*.py'"
    )
    parser.add_argument("--count", type=int, help="faults in each area; 0: all (default 60, or all with --every)")
    parser.add_argument("--every", type=int, default=0, help="of all faults in their order, every so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=600.0, help="begin no fault after that time (default %(default)s)")
    parser.add_argument("--output", type=Path, help="where to write all faults as JSON lines")
    parser.add_argument(
        "--seconds", type=float, default=LONGEST, help="of tests of the area for one fault (default %(default)s)"
    )
    parser.add_argument(
        "--rest", type=float, default=REST, help="s, of all other tests for what these miss (default %(default)s)"
    )
    parser.add_argument("--longest", type=float, default=LONGEST_PLAIN, help="s, of one test in plain Python (%(default)s)")
    parser.add_argument("--reached", type=Path, help="folder in which is kept which tests reach what, for the next sample")
    given = parser.parse_args()
    if given.count is None:
        given.count = 0 if given.every else 60
    given.every = max(1, given.every)
    return given


def tiered(scratch: Path, given: argparse.Namespace) -> Callable[[Planted], str]:
    """What tells whether a fault of the kernels is noticed, by quick tests in plain Python or else by compiled ones."""
    plain = interpreted(PLAIN, given)
    copy = CompiledCopy(scratch / "project")
    tests, seconds = copy.cheapest_first(AREAS[COMPILED][1])
    print(f"{COMPILED}: {seconds:.0f} s without a fault", flush=True)
    limit = max(LEAST, PATIENCE * seconds)

    def notices(planted: Planted) -> str:
        if plain(planted) == AT_ONCE:
            return AT_ONCE
        return BY_THE_REST if copy.notices(planted.file, planted.fault.source, tests, limit) else MISSED

    return notices


def interpreted(area: str, given: argparse.Namespace) -> Callable[[Planted], str]:
    """What tells whether a fault of what Python runs is noticed, by tests of the area or else by any others."""
    os.environ["NUMBA_DISABLE_JIT"] = str(int(area == PLAIN))
    load()
    first = _reached(area, AREAS[area][1], given.reached, given.longest if area == PLAIN else math.inf)
    print(f"{area}: {len(first.seconds)} tests, {sum(first.seconds.values()):.0f} s without a fault", flush=True)

    def fail(names: list[str], reached: Reached, planted: Planted) -> bool:
        seconds = sum(reached.seconds[name] for name in names)
        return bool(names) and fails(names, planted.file, planted.fault.source, max(LEAST_PLAIN, PATIENCE * seconds))

    def notices(planted: Planted) -> str:
        source = (ROOT / "watchsim" / planted.file).read_text(encoding="utf-8")
        function = function_of(source, planted.fault.line)
        asked = first.within(first.tests(planted.file, function), given.seconds)
        if fail(asked, first, planted):
            return AT_ONCE
        if area == PLAIN or given.rest <= 0.0:
            return MISSED
        whole = _whole(given.reached)
        names = whole.with_neighbours(whole.tests(planted.file, function))
        others = [name for name in names if name not in asked]
        return BY_THE_REST if fail(whole.within(others, given.rest), whole, planted) else MISSED

    return notices


@cache
def _whole(folder: Path | None) -> Reached:
    """What all tests of the usual suite reach; those that fail here are left out."""
    return _reached("whole", ("tests",), folder, REST)


def _reached(name: str, tests: Sequence[str], folder: Path | None, longest: float = math.inf) -> Reached:
    """Which tests reach what, from the last time or by running them."""
    return kept(folder / f"{name}.json", tests, longest) if folder else recorded(tests, longest)


def tell(planted: Planted, verdict: str, output: Path | None) -> None:
    fault = planted.fault
    if verdict in (MISSED, BY_THE_REST):
        print(f"  {verdict:7} {planted.file}:{fault.line}:{fault.column}  {fault.before}  ->  {fault.after}", flush=True)
    if output is not None:
        noticed = verdict in (AT_ONCE, BY_THE_REST)
        row = {"file": planted.file, "line": fault.line, "before": fault.before, "after": fault.after}
        row |= {"verdict": "noticed", "when": verdict} if noticed else {"verdict": verdict}
        with output.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"area": planted.area, **row}, ensure_ascii=False) + "\n")


def report(tally: Counter[tuple[str, str]], areas: list[str]) -> int:
    """A line for each area, and the verdict on all."""
    total: Counter[str] = Counter()
    for area in [area for area in areas if any(one == area for one, _ in tally)]:
        here = Counter({verdict: tally[area, verdict] for verdict in (AT_ONCE, BY_THE_REST, MISSED, HARMLESS)})
        print(f"{area:10} {_line(here)}, {here[HARMLESS]} judged harmless")
        total += here
    noticed = total[AT_ONCE] + total[BY_THE_REST]
    share = noticed / max(1, noticed + total[MISSED])
    print(f"all        {_line(total)}: {share:.1%}")
    return 0 if share >= ENOUGH else 1


def _line(found: Counter[str]) -> str:
    noticed = found[AT_ONCE] + found[BY_THE_REST]
    return f"{noticed} of {noticed + found[MISSED]} noticed ({found[AT_ONCE]} at once)"


if __name__ == "__main__":
    sys.exit(main())
