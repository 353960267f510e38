"""Which simulations do several tests look at?"""

import pytest

from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory


@pytest.fixture(scope="session")
def bench_lever() -> Trajectory:
    """Three seconds of the bench lever, from its start; a few hundred milliseconds once the solver is compiled."""
    return simulate(load(profiles_dir() / "bench_lever" / "scene.toml"), duration=3.0)
