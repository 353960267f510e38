"""Does a step end where it says, when the contact that ended it cannot be found to have closed earlier?"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import late_touch
import pytest

from watchsim import jit

PATHS = (Path(jit.__file__).resolve().parents[1], Path(__file__).resolve().parents[1])


@pytest.mark.slow  # a second: another interpreter
def test_a_touch_found_late_leaves_the_bodies_where_the_step_ends() -> None:
    """Newton's steps from there to when the contact closed are too few; the state was left at the last of them."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, PATHS)), "NUMBA_DISABLE_JIT": "1"}
    told = subprocess.run([sys.executable, late_touch.__file__], env=environment, check=True, capture_output=True, text=True)
    rows = json.loads(told.stdout)
    end, braking = late_touch.LATE, late_touch.FRICTION * late_touch.FALL
    at_end = rows["t"].index(end)
    x, _, _, fallen = rows["q"][at_end]
    assert x == pytest.approx((late_touch.SPEED - 0.5 * braking * end) * end, rel=1e-12)
    assert fallen == pytest.approx(-0.5 * late_touch.FALL * end**2, rel=1e-12)
    assert rows["u"][at_end][0] == pytest.approx(late_touch.SPEED - braking * end, rel=1e-12)
    assert rows["u"][at_end][3] == pytest.approx(-late_touch.FALL * end, rel=1e-12)
