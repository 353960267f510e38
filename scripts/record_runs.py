"""Records what the solver gives for many short runs, for tests/simulation/recorded_runs.txt, and says what has moved.

Of each run five copies are made, every speed, mass, force and law of which is changed by up to 1e-13 of itself: how far they
come apart says how far another machine may be off. Runs that come apart altogether are left out, and those that take long.
A deliberate change of the solver is reviewed by what is printed here; without --write nothing is changed.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TESTS = ROOT / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "simulation")]

from record_file import PLACE, Recorded, moved, read, recorded_of, written  # noqa: E402
from recorded_scenes import all_names, nudged, run_of, scene_of, told  # noqa: E402

SHARE = 1e-13
COPIES = 5
OF_EACH = 10  # families of random mechanisms
MOST_CELLS = 1500  # looked at from Python: most of what a short run takes


def recorded(name: str) -> Recorded | None:
    """A run with how far it may be off; None where it is none for the record."""
    scene, duration, how = scene_of(name)
    result = told(run_of((scene, duration, how)))
    if result.counts["cells_asked"] > MOST_CELLS and not name.startswith("library"):
        return None
    return recorded_of(result, [told(run_of((nudged(scene, SHARE, k), duration, how))) for k in range(1, COPIES + 1)])


def chosen(names: list[str]) -> dict[str, Recorded]:
    """The runs for the record: of each family of mechanisms the first few that are none too long or chaotic."""
    found: dict[str, Recorded] = {}
    family: Counter[str] = Counter()
    for name in names:
        kind = name.rsplit("-", 1)[0] if name.startswith("hunt") else ""
        if family[kind] < OF_EACH and (kept := recorded(name)) is not None:
            found[name] = kept
            family[kind] += bool(kind)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="rewrite the record")
    parser.add_argument("--mechanisms", type=int, default=240, help="of the hunt, from which to choose (default %(default)s)")
    given = parser.parse_args()
    before = read() if PLACE.is_file() else {}
    differ = 0
    for name, kept in before.items():
        words = moved(told(run_of(scene_of(name))), kept)
        differ += bool(words)
        for word in words:
            print(f"{name}: {word}")
    print(f"{differ} of {len(before)} runs have moved")
    if given.write:
        found = chosen(all_names(given.mechanisms))
        PLACE.write_text(written(found), encoding="utf-8")
        print(f"{len(found)} runs recorded; {len(set(found) - set(before))} are new, {len(set(before) - set(found))} gone")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main())
