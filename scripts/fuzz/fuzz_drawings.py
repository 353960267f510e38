"""Does any damaged drawing bring the reader down, make it slow or large, or get lost in silence?

Damages small files at random, reads each in a worker process with 1 GB of memory and 10 s, and keeps every file that
fails. Files are numbered: number k of a format is the same damage on every machine, so `--only K` repeats it. `--page LOG ...`
writes docs/reports/broken-drawings.md from what such runs have printed.
"""

from __future__ import annotations

import argparse
import importlib
import random
import re
import resource
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "drawing")]
MEMORY = 1 << 30  # bytes
SECONDS = 10.0  # of processor time: other work on the machine shall not decide
PATIENCE = 20.0  # times that, on the clock, before a worker counts as hanging


def damaged(mutator: Any, number: int) -> tuple[int, bytes]:
    """Which sample, and the file."""
    rng = random.Random(f"{mutator.ENDING} {number}")
    samples = mutator.samples()
    choice = rng.randrange(len(samples))
    return choice, mutator.mutate(rng, samples[choice])


def work(name: str) -> None:
    """Reads numbers from stdin, one a line, and answers each with a line: processor time, tab, what went wrong if anything."""
    mutator = importlib.import_module(name)
    judge = importlib.import_module("judge_mutation")
    reader = importlib.import_module("watchsim.drawing.read")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"drawing.{mutator.ENDING}"
        whole = []
        for sample in mutator.samples():
            path.write_bytes(sample)
            whole.append(reader.read(path))
        for line in sys.stdin:
            choice, data = damaged(mutator, int(line))
            path.write_bytes(data)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)  # ends the process
            before = time.process_time()
            fault = judge.fault(path, whole[choice], mutator).replace("\n", " | ")
            print(f"{time.process_time() - before:.3f}\t{fault}", flush=True)


PAGE = """# Broken drawings

What happens to a drawing that is damaged? `scripts/fuzz/fuzz_drawings.py` damages small whole drawings at random, one to three
accidents a file, and reads each in a process of its own with 1 GB of memory and {seconds:g} s of processor time:

- bytes overwritten, the end cut off, lines lost, swapped or doubled, numbers replaced (`1e308`, `nan`, nothing, `1,5`);
- DXF: group codes changed, other words after code 0, INSERTs that show another block, perhaps the one they stand in;
- SVG: names and letters changed, fragments put in (half comments, `CDATA`, entities, open tags), tags moved to other places.

A file fails if it causes a traceback, takes more time or memory than that, or loses something silently: every entity that
a plain look at the file finds must be drawn or reported, and without any finding nothing may be missing, unless an
independent reader (for DXF ezdxf, for SVG `tests/naive/svg_length.py`) misses it, too.

| Files | Failures | Slowest |
|---|---|---|
{rows}

The slowest file is the one that took longest in that run; its processor time counts reading it twice, its report and the
independent reader. A file is made and judged again by its number: `python scripts/fuzz/fuzz_drawings.py --format dxf --only
2286`.
"""
SUMMARY = re.compile(r"(\d+) (\w+) files from number (\d+): (.*); [\d.]+ s, the slowest ([\d.]+) s \(number (\d+)\)")


class Worker:
    """A process that reads damaged files; restarted when it dies or hangs."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.process = self._start()

    def _start(self) -> subprocess.Popen[str]:
        command = [sys.executable, __file__, "--work", self.name]
        # One thread each: the stacks of threads count as memory.
        environment = {"OPENBLAS_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"}
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def ask(self, number: int) -> tuple[float, str]:
        """Seconds of processor time, and what went wrong, empty if nothing."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(f"{number}\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], PATIENCE * SECONDS)
        answer = self.process.stdout.readline() if ready else ""
        if answer.endswith("\n"):
            used, _, fault = answer.strip().partition("\t")
            return float(used), fault
        if not ready:
            self.process.kill()
        status = self.process.wait()
        self.process = self._start()
        slow = not ready or status == -signal.SIGPROF
        return SECONDS, f"more than {SECONDS:g} s" if slow else f"the process died with status {status}"

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait()


def page(logs: list[Path]) -> str:
    """The page from the last lines of runs, whose slowest files are read once more; ValueError where one is not complete."""
    rows = []
    for log in logs:
        found = SUMMARY.search(log.read_text())
        if found is None:
            raise ValueError(f"{log} holds no complete run")
        count, form, first, failures, _, number = found.groups()
        worker = Worker(f"mutate_{form}")
        worker.ask(int(number))  # the first answer pays for the imports
        used, _ = worker.ask(int(number))
        worker.close()
        numbers = f"{int(first)} to {int(first) + int(count) - 1}"
        rows.append(f"| {count} {form.upper()}, numbers {numbers} | {failures} | {used:.1f} s (number {number}) |")
    return PAGE.format(seconds=SECONDS, rows="\n".join(rows))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--format", default="dxf", help="dxf or svg: the module mutate_FORMAT of tests/drawing")
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", type=int, help="write this one file and judge it")
    parser.add_argument("-o", "--output", type=Path, default=Path("results/fuzz"), help="where files that fail are kept")
    parser.add_argument("--page", type=Path, nargs="+", metavar="LOG", help="write the page from the output of runs")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.page:
        (ROOT / "docs" / "reports" / "broken-drawings.md").write_text(page(args.page))
        return
    if args.work:
        work(args.work)
        return
    name = f"mutate_{args.format}"
    mutator = importlib.import_module(name)
    worker = Worker(name)
    numbers = range(args.first, args.first + args.count) if args.only is None else [args.only]
    kinds: Counter[str] = Counter()
    slowest, start = (0.0, -1), time.perf_counter()
    worker.ask(numbers[0])  # the first answer pays for the imports
    for number in numbers:
        used, answer = worker.ask(number)
        slowest = max(slowest, (used, number))
        if answer or args.only is not None:
            args.output.mkdir(parents=True, exist_ok=True)
            (args.output / f"{number}.{args.format}").write_bytes(damaged(mutator, number)[1])
            kinds[answer.split(":")[0] or "fine"] += 1
            print(f"{number}: {answer or 'fine'}", flush=True)
    worker.close()
    took = time.perf_counter() - start
    print(f"{len(numbers)} {args.format} files from number {numbers[0]}: {dict(kinds) or 'no failure'}; {took:.0f} s, ", end="")
    print(f"the slowest {slowest[0]:.2f} s (number {slowest[1]})")
    sys.exit(bool(kinds) and args.only is None)


if __name__ == "__main__":
    main()
