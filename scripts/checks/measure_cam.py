"""Does a roller on a cam of many tangent arcs feel the joints?

    python scripts/checks/measure_cam.py

A round cam beside its pivot and an oval one, of 1 to 1000 tangent arcs each, turn under a roller for a quarter of a second. The
force is compared with that on the smooth cam (tests/reference/cam.py, integrated by scipy), away from joints of curvature.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "simulation")]

from cam_scenes import DRIVE, ECCENTRIC, RATE, cam_scene  # noqa: E402
from reference.cam import Piece, follow, oval  # noqa: E402

from watchsim.simulation.record.trajectory import EventKind  # noqa: E402
from watchsim.simulation.simulate import simulate  # noqa: E402

OVAL = oval(0.6e-3, 1.5e-3, 0.4e-3)
JOINT = 1e-6  # rad: nearer to a step of curvature the force may be that of either side


def force_error(pieces: tuple[Piece, ...], cuts: int) -> tuple[int, int, float]:
    """Impacts, hand-overs, and the largest relative error of the contact force."""
    run = simulate(cam_scene(pieces, cuts, 0.25))
    kinds = [int(np.count_nonzero(run.events["kind"] == kind)) for kind in (EventKind.IMPACT, EventKind.HANDOVER)]
    rows = np.flatnonzero(np.diff(run.t, prepend=-1.0) > 0.0)
    rest, worst = run.scene.springs[0].rest, 0.0
    for i, truth in zip(rows, follow(pieces, DRIVE, 0.3, RATE, run.t[rows]), strict=True):
        if len(pieces) > 1 and min(abs(math.remainder(truth.normal - p.first, 2.0 * math.pi)) for p in pieces) < JOINT:
            continue
        pressed = DRIVE.mass * run.a[i, 1] + DRIVE.stiffness * (run.q[i, 1] - rest)
        worst = max(worst, abs(pressed / math.sin(truth.normal + truth.angle) / truth.force - 1.0))
    return kinds[0], kinds[1], worst


def main() -> int:
    bad = False
    print("cam          arcs  impacts  hand-overs  largest error of the force")
    for name, pieces, cuts in (("eccentric", ECCENTRIC, (1, 10, 100, 1000)), ("oval", OVAL, (1, 25, 250))):
        for count in cuts:
            impacts, handovers, worst = force_error(pieces, count)
            print(f"{name:10} {count * len(pieces):6d} {impacts:8d} {handovers:11d} {worst:12.1e}", flush=True)
            bad |= impacts > 0 or worst > 1e-6
    return int(bad)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    sys.exit(main())
