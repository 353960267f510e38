"""Does the solver still do what it did when this was recorded?

No oracle: tests elsewhere say what is right. A number that moves here was meant to, and then scripts/record_runs.py
writes the record anew and says what has moved, or is a fault.
"""

from __future__ import annotations

import pytest
from record_file import moved, read
from recorded_scenes import ROOT, run_of, scene_of, told

if not (ROOT / "scripts" / "hunt").is_dir():
    pytest.skip("the mechanisms' generator is not here", allow_module_level=True)

RECORD = read()


@pytest.mark.parametrize("name", RECORD)
def test_as_recorded(name: str) -> None:
    assert moved(told(run_of(scene_of(name))), RECORD[name]) == []
