"""How many digits do distances and gaps have? 10^5 random and nasty pairs against fifty-digit arithmetic.

    python scripts/checks/measure_distances.py [PAIRS]

Prints the largest error by kind of pair, as a share of the pair's size, and how long one call of `distance` takes.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import defaultdict
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "contact")]

from naive.exact_distance import exact_distance, exact_gap, nasty_pairs  # noqa: E402
from test_exact_gaps import chain, contact_row, round_side  # noqa: E402

from watchsim.contact.distance import distance, gap  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, nargs="?", default=100_000, help="pairs of primitives")
    count = parser.parse_args().count
    distances: dict[str, list[float]] = defaultdict(list)
    gaps: dict[str, list[float]] = defaultdict(list)
    spent = 0.0
    for pair in nasty_pairs(np.random.default_rng(1), count):
        ends = chain(pair.a), pair.pose_a, chain(pair.b), pair.pose_b
        start = time.perf_counter()
        found = distance(*ends)
        spent += time.perf_counter() - start
        distances[pair.name].append(float(abs(found.value - exact_distance(pair))) / pair.size)
        if (outline := round_side(pair)) is not None:
            row = contact_row(gap(outline, *ends[1:]), pair)
            gaps[pair.name].append(float(abs(float(row["g"]) - exact_gap(pair))) / max(pair.size, -float(row["margin"])))
    print(f"{'kind':10} {'pairs':>7} {'distance':>10} {'gap':>10}   largest error over size")
    for name, errors in distances.items():
        print(f"{name:10} {len(errors):7d} {max(errors):10.1e} {max(gaps[name]):10.1e}")
    print(f"one call of distance: {1e6 * spent / count:.0f} µs with its Python part")
    worst = max(max(errors) for errors in (*distances.values(), *gaps.values()))
    return 0 if worst <= 1e-14 else 1


if __name__ == "__main__":
    sys.exit(main())
