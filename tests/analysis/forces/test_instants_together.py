"""Are forces the same whichever instants are asked about together?"""

from __future__ import annotations

import numpy as np
import pytest

from watchsim.analysis.contact_forces import forces
from watchsim.profiles_path import profiles_dir
from watchsim.simulation.record.trajectory import Array, Trajectory
from watchsim.simulation.simulate import simulate


def told(run: Trajectory, times: Array) -> Array:
    """Normal and tangential forces of all contacts, then forces on bearings (times, all of these)."""
    found = forces(run, times)
    contacts = np.zeros((len(times), 2, len(run.pairs)))
    contacts[:, 0, found.pairs], contacts[:, 1, found.pairs] = found.normal, found.tangential
    return np.hstack((contacts.reshape(len(times), -1), *found.pivots.values()))


@pytest.mark.parametrize(("name", "duration"), [("swiss_lever", 0.2), ("detent", 0.2)])
def test_one_by_one_all_together_and_shuffled(name: str, duration: float) -> None:
    """Of a lever, and of a detent that rests on its spring, with redundant contacts at most instants."""
    run = simulate(profiles_dir() / name, duration, record="all")
    rng = np.random.default_rng(3)
    times = np.sort(rng.choice(np.unique(run.t), 60, replace=False))
    expected, order = told(run, times), rng.permutation(60)
    for parts in (np.arange(60)[:, None], [order], [order[k::7] for k in range(7)]):
        for part in parts:
            assert np.abs(told(run, times[part]) - expected[part]).max() <= 1e-9 * np.abs(expected).max()
