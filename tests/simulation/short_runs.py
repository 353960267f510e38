"""Which short runs reach every part of the solver? Run as a program, it writes what they come to:

python short_runs.py FILE.npz NAME ...
"""

import dataclasses
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from moving_scenes import profile

from watchsim.scene.forces import Damping
from watchsim.scene.scene import EVERYTHING, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import COUNT_NAMES
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.benchmarks import Benchmark
from watchsim.verification.hard_cases import dry_balance, painleve_rods, pins_on_rollers, superball, wedges
from watchsim.verification.repeated_impacts import cradle, groove, pulled_block, rocking_block

Short = tuple[Scene, float, dict[str, Any]]  # the scene, how long, how
WORK = ("steps", "rejected_steps", "evaluations", "gap_evaluations", "flights", "cells_looked_up")


def _of(case: Callable[[], Benchmark] | Benchmark, duration: float) -> Short:
    scene = (case if isinstance(case, Benchmark) else case()).scene
    return dataclasses.replace(scene, record=EVERYTHING), min(duration, scene.duration), {}


def dry_lever() -> Scene:
    """The bench lever with a little dry friction in every bearing."""
    scene = profile("bench_lever")
    dry = tuple(Damping(body.name, coulomb=2e-9) for body in scene.bodies if body.motion == "pivot")
    return dataclasses.replace(scene, damping=(*scene.damping, *dry))


def short_runs() -> dict[str, Short]:
    """By name: one or two seconds of plain Python each."""
    runs: dict[str, Short] = {
        "incline": (profile("incline"), 0.6, {}),
        "bench_lever": (profile("bench_lever"), 0.05, {}),
        "bench_lever, two beats": (profile("bench_lever"), 0.3, {}),
        "swiss_lever, two beats": (profile("swiss_lever"), 0.3, {}),
        "dry bench_lever, two beats": (dry_lever(), 0.3, {}),
        "bench_lever by Moreau": (profile("bench_lever"), 0.08, {"method": "moreau", "step": 1e-4}),
        "dry bench_lever by Moreau": (dry_lever(), 0.08, {"method": "moreau", "step": 1e-4}),
        "superball": _of(superball, 1.2),
        "dry balance": _of(dry_balance, 3.0),
        "stick-slip": _of(pulled_block, 3.0),
        "rocking block": _of(rocking_block, 0.5),
        "cradle": _of(cradle(0.0), 1.0),
        "groove": _of(groove, 0.5),
    }
    for name, cases in (("Painlevé", painleve_rods()), ("pin on roller", pins_on_rollers()), ("wedge", wedges())):
        runs |= {f"{name} {i}": _of(case, 0.3) for i, case in enumerate(cases)}
    return runs


def told(run: Trajectory) -> dict[str, np.ndarray]:
    """End state, events, sums and counts as arrays; how much work it was (steps, rows) may hang on the last bit of a power."""
    energy = [run.energy["in_J"], run.energy["stored_J"], *run.energy["dissipated"].values()]
    met = [run.counts[name] for name in COUNT_NAMES if name not in WORK]
    out = {"q": run.end_q, "u": run.end_u, "events": run.events}
    return out | {"energy": np.array(energy), "counts": np.array(met)}


def write(path: Path, names: list[str]) -> None:
    """What the named runs tell, as NAME/WHAT."""
    runs = short_runs()
    done = {name: told(simulate(runs[name][0], runs[name][1], **runs[name][2])) for name in names}
    np.savez(path, **{f"{name}/{what}": value for name, values in done.items() for what, value in values.items()})


if __name__ == "__main__":
    write(Path(sys.argv[1]), sys.argv[2:])
