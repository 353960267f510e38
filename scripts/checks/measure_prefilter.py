"""Does the prefilter change a bit of the Swiss lever, and what share of a run goes into shapely?

    python scripts/checks/measure_prefilter.py [SCENE] [SECONDS]

Runs the scene with the cells and by brute force (every declared pair in every step) and compares all events and the end states
byte by byte. The share of shapely is given for the first turn of the escape wheel and for what follows.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from watchsim.candidates.pair_cache import forget  # noqa: E402
from watchsim.mechanism.compile import compile_scene  # noqa: E402
from watchsim.scene.file.load import load  # noqa: E402
from watchsim.scene.recording import EVERYTHING  # noqa: E402
from watchsim.scene.scene import Scene  # noqa: E402
from watchsim.simulation.frozen_run import trajectory_of  # noqa: E402
from watchsim.simulation.loop_state.state_arrays import arrays_of  # noqa: E402
from watchsim.simulation.runner import Run  # noqa: E402
from watchsim.simulation.stops import Stop  # noqa: E402


@dataclass
class Watch:
    """Time spent, in all and in shapely, when the wheel has turned once and at the end, s."""

    run: Run
    wheel: int
    begin: float = field(default_factory=time.perf_counter)
    turned: tuple[float, float] | None = None

    def look(self, *_: float) -> None:
        """Called between slices of the run."""
        start = self.run.compiled.q[self.wheel]
        if self.turned is None and abs(self.run.state.q[self.wheel] - start) >= 2.0 * math.pi:
            self.turned = self.spent()

    def spent(self) -> tuple[float, float]:
        return time.perf_counter() - self.begin, self.run.finder.seconds


def simulated(scene: Scene, seconds: float, prefilter: bool) -> Watch:
    """A run to its end."""
    forget()
    run = Run(scene, compile_scene(scene, prefilter), scene.tolerance, EVERYTHING)
    run.warm_up()
    watch = Watch(run, run.compiled.slices["wheel"].start)
    run.to_the_end(seconds, watch.look)
    return watch


def told(name: str, part: float, whole: float) -> None:
    print(f"{name:34} {whole:8.3f} s, shapely {part:.4f} s = {100.0 * part / whole:.2f} %")


def main() -> int:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    default = ROOT / "profiles" / "swiss_lever" / "scene.toml"
    given = arguments(__doc__, scene=(default, "the scene to measure"), seconds=(20.0, "how long to simulate"))
    scene, seconds = load(given.scene), given.seconds
    watch = simulated(scene, seconds, True)
    total, shapely = watch.spent()
    first, first_shapely = watch.turned or (total, shapely)
    print(f"{scene.title}, {seconds:g} s")
    told("first turn of the wheel", first_shapely, first)
    share = 0.0
    if watch.turned:
        share = (shapely - first_shapely) / (total - first)
        told("what follows", shapely - first_shapely, total - first)
    brute = simulated(scene, seconds, False)
    told("brute force", 0.0, brute.spent()[0])
    events = [trajectory_of(run, Stop.DURATION, 0.0, 0.0).events for run in (watch.run, brute.run)]
    same = events[0].tobytes() == events[1].tobytes()
    ends = [arrays_of(run.state) for run in (watch.run, brute.run)]
    same &= all(np.array_equal(getattr(ends[0], name), getattr(ends[1], name)) for name in ("clock", "q", "u", "a"))
    gaps = [int(run.state.counts.gap_evaluations) for run in (watch.run, brute.run)]
    print(f"{len(events[0])} events, {gaps[0]} gaps evaluated with cells, {gaps[1]} without; bit-identical: {same}")
    return 0 if same and share <= 0.05 else 1


if __name__ == "__main__":
    sys.exit(main())
