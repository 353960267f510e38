"""Does the judge find nothing wrong any more with what the hunt once found?

Each scene of tests/data/hunt was made by `scripts/hunt/hunt_mechanisms.py --keep --shrink` where the solver was wrong.
"""

from __future__ import annotations

import hunt_path
import pytest
from hunt.hunt_mechanisms import judged_file

SCENES = sorted((hunt_path.ROOT / "tests" / "data" / "hunt").glob("*.toml"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_mended(path):
    verdict = judged_file(path)
    assert verdict.reasons == []


def test_there_are_scenes():
    assert SCENES
