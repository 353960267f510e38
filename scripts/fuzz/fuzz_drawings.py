"""Does any damaged drawing bring the reader down, make it slow or large, or get lost in silence?

Damages small files at random, reads each in a process with 1 GB of memory and 10 s, and keeps every file that fails. Files are
numbered: number k of a format is the same damage on every machine, so `--only K` repeats it. The last line of a run is what
docs/reports/broken-drawings.md states.
"""

import argparse
import importlib
import os
import random
import sys
import tempfile
from pathlib import Path
from typing import Any

from rounds import add_numbers, campaign, in_a_process

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "drawing")]
MEMORY = 1 << 30  # bytes
SECONDS = 10  # of processor time
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the stacks of threads count as memory


def damaged(mutator: Any, number: int) -> tuple[int, bytes]:
    """Which sample, and the file."""
    rng = random.Random(f"{mutator.ENDING} {number}")
    samples = mutator.samples()
    choice = rng.randrange(len(samples))
    return choice, mutator.mutate(rng, samples[choice])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--format", default="dxf", help="dxf or svg: the module mutate_FORMAT of tests/drawing")
    add_numbers(parser, 20_000)
    parser.add_argument("-o", "--output", type=Path, default=Path("results/fuzz"), help="where files that fail are kept")
    args = parser.parse_args()
    mutator, judge, reader = (
        importlib.import_module(name) for name in (f"mutate_{args.format}", "judge_mutation", "watchsim.drawing.read")
    )
    with tempfile.TemporaryDirectory() as folder:
        path, whole = Path(folder) / f"drawing.{args.format}", []
        for sample in mutator.samples():
            path.write_bytes(sample)
            whole.append(reader.read(path))
            judge.fault(path, whole[-1], mutator)  # loads what the copies need

        def round_of(number: int) -> tuple[str, str, float]:
            choice, data = damaged(mutator, number)
            path.write_bytes(data)
            words, took = in_a_process(
                path.parent, lambda: judge.fault(path, whole[choice], mutator) or "fine", SECONDS, MEMORY
            )
            if words != "fine" or args.only is not None:
                args.output.mkdir(parents=True, exist_ok=True)
                (args.output / f"{number}.{args.format}").write_bytes(data)
            return args.format, words, took

        what = f"{args.format} files"
        sys.exit(campaign(args, round_of, what))


if __name__ == "__main__":
    main()
