"""How long does a day of a watch take in one piece, and does memory stay flat? A section of docs/reports/long-runs.md."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

MEMORY_AT = (0.01, 0.1, 0.25, 0.5, 0.75, 0.99)  # shares of the day
WHOLE = """
## Swiss lever, {hours:g} h in one piece, statistics only

- {half_swings:,} half swings, {ticks:,} with a tick; {cpu:.0f} s of processor time.
- Amplitude {mean:.7f}° on average, from {least:.7f}° to {largest:.7f}°; energy residual {share:.0e} of the work put in.
- {counts}.
- Memory of the process after {points} of the time: {memory} MB."""


def whole_day(scene: Scene, duration: float, counted: Iterable[str]) -> str:
    """What is said of one run of that many seconds, of which only statistics are kept, with these of its counts."""
    memory: list[float] = []

    def watch(now: float, end: float) -> None:
        if now >= MEMORY_AT[min(len(memory), len(MEMORY_AT) - 1)] * end and len(memory) < len(MEMORY_AT):
            memory.append(resident())

    begun = time.process_time()
    run = simulate(scene, duration, record="statistics", progress=watch)
    cpu = time.process_time() - begun
    if run.stop != Stop.DURATION:
        raise SystemExit(f"{scene.title}: {run.stop_message}")
    swings = run.sums["amplitude"]
    return WHOLE.format(
        hours=duration / 3600.0,
        half_swings=run.sums["half_swings"],
        ticks=run.sums["ticks"],
        cpu=cpu,
        share=run.energy["residual_relative"],
        counts=", ".join(f"{run.counts[name]:,} {name}" for name in counted),
        points=", ".join(f"{part:.0%}" for part in MEMORY_AT),
        memory=", ".join(f"{megabytes:.1f}" for megabytes in memory),
        **{name: np.degrees(swings[name]) for name in ("mean", "least", "largest")},
    )


def resident() -> float:
    """MB that this process occupies now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return 1e-6 * pages * os.sysconf("SC_PAGE_SIZE")
