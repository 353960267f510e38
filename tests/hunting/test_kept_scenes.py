"""Does the judge find nothing wrong any more with what the hunt once found?

Each scene of tests/data/hunt was made by `scripts/hunt/hunt_mechanisms.py --keep --shrink` where the solver was wrong.
"""

from __future__ import annotations

import hunt_path
import pytest
from every_time import few
from hunt.hunt_mechanisms import judged_file

KNOWN = sorted((hunt_path.ROOT / "tests" / "data" / "hunt").glob("*.toml"))
LONG = (  # half a second of processor time to ten each
    *("gears-3-7", "levers-2001-15091", "blocks-801-12218", "levers-801-17734", "wave-801-16576", "kink-801-11924"),
    *("blocks-2001-16485", "levers-801-2838", "row-801-10639", "pendulums-801-2071", "cam-20261124-500"),
)
SHORT = [path for path in KNOWN if path.stem not in LONG]


@pytest.mark.parametrize("path", few(KNOWN, lambda path: path in SHORT[::2]), ids=lambda path: path.stem)
def test_mended(path):
    verdict = judged_file(path)
    assert verdict.reasons == []


def test_there_are_scenes():
    assert len(SHORT) > len(LONG)
