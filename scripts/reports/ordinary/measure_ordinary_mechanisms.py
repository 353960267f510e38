"""Is the motion right at kinks, in every orientation, and on curves of many arcs? Writes docs/reports/ordinary-mechanisms.md.

    python scripts/reports/ordinary/measure_ordinary_mechanisms.py [--quick] [--only PART ...] [--page FILE]

Parts: kinks, orientations, gears, cams, pin_lever. With --only the other parts of the page stay as they are.
The exit status is 1 where a run was wrong.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT))

import ordinary_cams as cams  # noqa: E402
import ordinary_gears as gears  # noqa: E402
import ordinary_kinks as kinks  # noqa: E402
import ordinary_orientations as orientations  # noqa: E402
import ordinary_pin_lever as pin_lever  # noqa: E402

PAGE = ROOT / "docs" / "reports" / "ordinary-mechanisms.md"
HEAD = """# Ordinary mechanisms

What no lever escapement shows: kinks between edges from 1e-10 rad to 90°, mechanisms in any orientation, curves of many arcs.
Made by `scripts/reports/ordinary/measure_ordinary_mechanisms.py`, which the nightly script runs; the tests in `tests/ordinary`
hold a part.
"""
PARTS: dict[str, tuple[str, Callable[[bool], tuple[str, int]]]] = {
    "kinks": ("Kinks", kinks.section),
    "orientations": ("Orientations", orientations.section),
    "gears": ("Gears of arcs", gears.section),
    "cams": ("Cams of arcs and chords", cams.section),
    "pin_lever": ("The impulse pin of a real lever", pin_lever.section),
}


def read(page: Path) -> dict[str, str]:
    """The parts of a page that is there, by title."""
    if not page.exists():
        return {}
    blocks = page.read_text(encoding="utf-8").split("\n## ")[1:]
    return {title: text.strip() for title, _, text in (block.partition("\n") for block in blocks)}


def write(page: Path, found: dict[str, str]) -> None:
    titles = [title for title, _ in PARTS.values() if title in found]
    page.write_text(HEAD + "".join(f"\n## {title}\n\n{found[title]}\n" for title in titles), encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer runs of each")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), metavar="PART", help="measure these parts")
    parser.add_argument("--page", type=Path, default=PAGE, help="file to write")
    wanted = parser.parse_args()
    found, wrong = read(wanted.page), 0
    for part in wanted.only:
        title, section = PARTS[part]
        print(f"== {title}", flush=True)
        found[title], bad = section(wanted.quick)
        print(f"{bad} wrong", flush=True)
        wrong += bad
        write(wanted.page, found)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
