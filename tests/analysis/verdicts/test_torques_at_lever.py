"""With what torque does one part work on the lever? By the power that goes in, and what friction takes of it."""

from __future__ import annotations

import math
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts.equilibrium.statics import at_lever


def told(
    lever: tuple[float, float], other: tuple[float, float], load: float, way: float, mu: float, dry: float
) -> float | None:
    """Lever arms (m) of normal and tangential force on lever and other part; the contact is the second of two."""
    arms = {(1, "lever"): lever, (1, "wheel"): other}
    found: Any = SimpleNamespace(
        **{"of": lambda row, body: arms[row, body], "friction": np.array([9.0, mu]), "columns": {"lever": 1, "wheel": 2}},
        **{"loads": np.array([7.0, 8.0, load]), "dry": np.array([5.0, 6.0, dry])},
    )
    return at_lever(found, 1, "wheel", "lever", way)


LEVER = ((0.7e-3, 0.4e-3), (-0.9e-3, 0.3e-3), (0.5e-3, -0.6e-3))
OTHER = ((1.1e-3, 2.3e-3), (-1.7e-3, 0.8e-3), (0.6e-3, -2.1e-3))


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("load", [3e-6, -3e-6])
@pytest.mark.parametrize(("mu", "dry"), [(0.0, 0.0), (0.13, 0.0), (0.0, 1e-6), (0.13, 1e-6), (0.1, 7e-6)])
def test_the_power_that_goes_in_comes_out_but_for_friction(way: float, load: float, mu: float, dry: float) -> None:
    """The lever turns by 1 rad/s, the other part so that the gap stays; both have their torques, and the contact slips."""
    known = 0
    for lever, other in product(LEVER, OTHER):
        got = told(lever, other, load, way, mu, dry)
        turn = -lever[0] * way / other[0]
        slip = lever[1] * way + other[1] * turn
        rub = -mu * math.copysign(1.0, slip)
        # Equilibrium of the other part: its load, less what its bearing rubs against the turn, and the contact.
        force = -(load - math.copysign(dry, turn)) / (other[0] + rub * other[1])
        jams = (other[0] + rub * other[1]) / other[0] <= 0.0
        if force < 0.0 or jams:
            assert got is None
            continue
        known += 1
        # What the load puts in, less dry friction of the bearing and of the contact, works on the lever.
        assert got == pytest.approx(load * turn - dry * abs(turn) - mu * force * abs(slip), rel=1e-9, abs=0.0)
    assert known >= 3


def test_a_contact_without_an_arm_on_the_other_part_gives_nothing() -> None:
    assert told((1e-3, 2e-3), (0.0, 3e-3), -3e-6, 1.0, 0.1, 0.0) is None
    assert told((1e-3, 2e-3), (1e-4, 3e-3), -3e-6, 1.0, 0.01, 0.0) is not None


@pytest.mark.parametrize(("mu", "jams"), [(0.45, False), (0.55, True), (0.5, True)])
def test_friction_jams_where_it_alone_holds(mu: float, jams: bool) -> None:
    """Across it has twice the arm that it has along the normal: a push of the wheel cannot get it away at µ = 1/2."""
    got = told((-1e-3, 0.0), (2.0**-10, 2.0**-9), -3e-6, 1.0, mu, 0.0)
    assert (got is None) is jams


def test_without_slip_nothing_rubs() -> None:
    """Arms in the same proportion: both go alike along the contact, too."""
    got = told((2.0**-10, 2.0**-11), (2.0**-9, 2.0**-10), -3e-6, -1.0, 0.3, 0.0)
    assert got == pytest.approx(-1.5e-6, rel=1e-12, abs=0.0)


def test_a_contact_without_a_load_carries_nothing() -> None:
    """It is not one that pulls."""
    got = told((1e-3, 0.0), (2e-3, 0.0), 0.0, 1.0, 0.3, 0.0)
    assert got is not None and abs(got) == 0.0
    assert told((1e-3, 0.0), (2e-3, 0.0), 1e-7, 1.0, 0.3, 0.0) is None
