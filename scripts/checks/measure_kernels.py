"""How long does one gap take, and all candidate gaps of the Swiss lever at one state?

    python scripts/checks/measure_kernels.py [SCENE]

States are taken evenly in time from a run of a beat and more. Each is evaluated many times in compiled code, poses
included; the figures are per state: places of bodies, gaps of all candidates of the cell.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from watchsim.candidates.cell_lookup import UNKNOWN, candidate, candidates  # noqa: E402
from watchsim.candidates.cell_table import CellFinder  # noqa: E402
from watchsim.contact.gaps import extent_margins, normal_gap  # noqa: E402
from watchsim.contact.poses import place, poses  # noqa: E402
from watchsim.jit import entry, kernel  # noqa: E402
from watchsim.mechanism.compile import compile_scene  # noqa: E402
from watchsim.model.records import CellsRef, ModelRef  # noqa: E402
from watchsim.scene.file.load import load  # noqa: E402
from watchsim.simulation.simulate import simulate  # noqa: E402

STATES, REPEATS = 200, 2000


@kernel
def gaps_of_state(model, cells, q, u, pose):
    """(sum of all candidate gaps, how many, body pair whose cell is unknown or -1)."""
    total, count = 0.0, 0
    place(model, q, u, pose)
    for p in range(len(model.pairs)):
        how, start, length = candidates(model, cells, p, q)
        if how == UNKNOWN:
            return total, count, p
        for slot in range(start, start + length):
            gap, rate, _, _ = normal_gap(model, candidate(model, cells, how, slot), pose)
            total += gap + 1e-9 * rate
        count += length
    return total, count, -1


@entry
def gaps_again(model, cells, q, u, pose, repeats):
    """The same many times, at coordinates that differ by less than rounding shows."""
    total, by_model, by_cells = 0.0, ModelRef(*model), CellsRef(*cells)
    for i in range(repeats):
        q[0] += 1e-18 * i
        total += gaps_of_state(by_model, by_cells, q, u, pose)[0]
    _, count, unknown = gaps_of_state(by_model, by_cells, q, u, pose)
    return total, count, unknown


@entry
def one_gap_again(model, k, pose, repeats):
    """One gap with its rate and normal, many times; the pose changes so that nothing is left out."""
    total, by_model = 0.0, ModelRef(*model)
    for i in range(repeats):
        pose[0].x += 1e-18 * i
        gap, rate, nx, _ = normal_gap(by_model, k, pose)
        total += gap + rate + nx
    return total


@entry
def one_margin_again(model, k, pose, repeats):
    """How far inside its primitives a contact lies, many times."""
    total, by_model = 0.0, ModelRef(*model)
    for i in range(repeats):
        pose[0].x += 1e-18 * i
        inside_a, inside_b = extent_margins(by_model, k, pose)
        total += inside_a + inside_b
    return total


def nanoseconds(function: Callable[..., object], *arguments: object) -> float:
    """Processor time of one repeat, the best of ten: what other programs take is not counted."""
    best = float("inf")
    for _ in range(10):
        start = time.process_time()
        function(*arguments)
        best = min(best, time.process_time() - start)
    return 1e9 * best / REPEATS


def main() -> int:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    default = ROOT / "profiles" / "swiss_lever" / "scene.toml"
    scene = load(arguments(__doc__, scene=(default, "the scene to measure")).scene)
    model = compile_scene(scene).model
    run = simulate(scene, 0.35)
    finder, pose = CellFinder(model), poses(len(model.bodies))
    times, counts = [], []
    for t in np.linspace(0.05, 0.35, STATES):
        q, u = (np.array(values) for values in run.at(float(t)))
        while (unknown := gaps_again(model, finder.cells, q, u, pose, 1)[2]) >= 0:
            finder.learn(unknown, q)
        times.append(nanoseconds(gaps_again, model, finder.cells, q, u, pose, REPEATS))
        counts.append(gaps_again(model, finder.cells, q, u, pose, 1)[1])
    single = [nanoseconds(one_gap_again, model, k, pose, REPEATS) for k in range(0, len(model.contacts), 97)]
    margin = [nanoseconds(one_margin_again, model, k, pose, REPEATS) for k in range(0, len(model.contacts), 97)]
    print(f"{scene.title}: {len(model.contacts)} pairs of primitives, {len(model.bodies)} bodies")
    print(f"one gap with rate and normal   {np.median(single):8.1f} ns (largest {max(single):.1f})")
    print(f"how far inside its primitives  {np.median(margin):8.1f} ns (largest {max(margin):.1f})")
    print(f"all candidates at one state    {1e-3 * np.median(times):8.3f} µs (largest {1e-3 * max(times):.3f})")
    print(f"candidates at one state        {np.median(counts):8.0f}    (largest {max(counts)})")
    return 0 if np.median(single) <= 60.0 and max(times) <= 2000.0 else 1


if __name__ == "__main__":
    sys.exit(main())
