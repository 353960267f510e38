"""Do the kernels do the same as plain Python?"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import short_runs

from watchsim import jit
from watchsim.simulation.simulate import simulate

ROOT = Path(jit.__file__).resolve().parents[1]  # of the copy under test
TESTS = Path(__file__).resolve().parents[1]
ROUNDING = 1e-9  # share of the largest number of a column
FEW = ("incline", "bench_lever", "superball", "Painlevé 1", "wedge 0")


def uncompiled(names: tuple[str, ...], path: Path) -> dict[str, np.ndarray]:
    """What the named runs tell in a fresh interpreter without the compiler."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(TESTS)]), "NUMBA_DISABLE_JIT": "1"}
    subprocess.run(
        [sys.executable, str(TESTS / "simulation" / "short_runs.py"), str(path), *names], env=environment, check=True
    )
    with np.load(path) as archive:
        return {name: archive[name] for name in archive.files}


@pytest.mark.skipif(not jit.is_compiled(), reason="compares with compiled kernels")
@pytest.mark.parametrize(
    "names", [FEW, pytest.param(tuple(short_runs.short_runs()), marks=pytest.mark.slow)], ids=["few", "all"]
)
def test_the_same_within_rounding_without_the_compiler(names: tuple[str, ...], tmp_path: Path) -> None:
    """End, events, energies and counts of runs that reach every part of the solver: the same decisions, the same numbers."""
    plain = uncompiled(names, tmp_path / "plain.npz")
    runs = short_runs.short_runs()
    for name in names:
        scene, duration, how = runs[name]
        for what, value in short_runs.told(simulate(scene, duration, **how)).items():
            assert_alike(value, plain[f"{name}/{what}"], f"{name}, {what}")


def assert_alike(value: np.ndarray, other: np.ndarray, which: str) -> None:
    """Whole numbers the same, others to rounding of the largest in the column."""
    assert value.shape == other.shape, which
    for column in value.dtype.names or ("",):
        one, two = (array[column] if column else array for array in (value, other))
        if one.dtype.kind != "f":
            assert np.array_equal(one, two), (which, column)
        elif one.size:
            assert np.all(np.abs(one - two) <= ROUNDING * np.abs(one).max(axis=0)), (which, column)
