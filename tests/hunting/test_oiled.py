"""Do mechanisms with loaded or loose pivots that the hunt found wrong come to their end now?"""

from __future__ import annotations

import sys

import hunt_path
import pytest
from hunt.generator.generate import mechanism
from hunt.generator.parts import Dice

sys.path.insert(0, str(hunt_path.ROOT / "scripts" / "fuzz"))

from oiled import missed, oiled

from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop


@pytest.mark.parametrize("number", [416, 433, 472, 489])
def test_what_the_hunt_found(number: int) -> None:
    """416: dry friction held the shaft of a loose body in flight, and drove it. The others: contacts and a bearing at the limit
    of its friction hold the same body, and their loads were shared anew without end."""
    run = simulate(oiled(mechanism(23, number), Dice(1023, number)), tolerance=1e-9)
    assert run.stop == Stop.DURATION
    assert missed(run) < 1e-9
