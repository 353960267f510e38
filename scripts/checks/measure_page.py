"""How many frames a second does the player of a page draw at 1280 × 720, and what share of the time does drawing take?

    python scripts/checks/measure_page.py PAGE.html [--seconds S]

Plays a page of `watchsim report` in a headless Chromium, which draws at most 60 frames a second. Needs 'watchsim[browser]'.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))

from pages.browser import opened
from pages.pace import SIZE, played


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=Path)
    parser.add_argument("--seconds", type=float, default=10.0)
    args = parser.parse_args()
    with opened(args.page, *SIZE) as page:
        found = played(page, args.seconds)
    print(f"{found.frames} frames in {found.seconds:.1f} s: {found.frames / found.seconds:.1f} a second")
    own = 1e3 * found.drawing / found.frames
    print(f"script and drawing commands: {own:.2f} ms of processor time a frame, median {found.median:.2f} ms of wall time")
    print(f"everything the page's main thread does: {1e3 * found.busy / found.frames:.2f} ms of processor time a frame")
    print(f"share of a frame at 60 a second: {60.0 * found.busy / found.frames:.0%}")


if __name__ == "__main__":
    main()
