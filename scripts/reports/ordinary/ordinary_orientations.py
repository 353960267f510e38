"""Does the motion depend on how a mechanism lies in the plane?"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "ordinary")]

from mechanisms import MECHANISMS, TOLERANCE, mechanism  # noqa: E402
from orientations import apart, random_pose, seen  # noqa: E402

SEED = 11
POSES = 1000
LIMIT = 1e-9
TEXT = """{count} mechanisms, each in three quarter turns and in random poses (seed {seed}): the world is turned by a random
angle, with gravity and axes, and the outlines of each body are turned within its frame by another one. Compared with the
original mechanism: all coordinates at the end and all turning points of what swings on a spring, since the
start, relative to the largest of them; tolerance {tolerance:g}. Wrong is a difference above {limit:g}, a missing turning point,
an early end, or an energy residual above 1e-6.

| mechanism | impacts | turning points | poses | largest difference | wrong |
|---|---:|---:|---:|---:|---:|
"""


def section(quick: bool) -> tuple[str, int]:
    """The section of the page and how many runs were wrong."""
    poses, lines, total = (20 if quick else POSES), [], 0
    for name in MECHANISMS:
        line, wrong = compare(name, poses)
        lines.append(line)
        total += wrong
        print(line, flush=True)
    return TEXT.format(count=len(MECHANISMS), seed=SEED, tolerance=TOLERANCE, limit=LIMIT) + "\n".join(lines), total


def compare(name: str, poses: int) -> tuple[str, int]:
    """A line of the table, and how many poses of the mechanism were wrong."""
    scene, rng = mechanism(name), np.random.default_rng(SEED)
    truth = seen(scene, 0.0, (0.0,) * len(scene.bodies))
    wrong, worst = int(bool(truth.bad)), 0.0
    still = (0.0,) * len(scene.bodies)
    quarters = [(0.5 * math.pi * k, still) for k in (1, 2, 3)]  # where zeros become rounding
    for pose in [*quarters, *(random_pose(scene, rng) for _ in range(poses - len(quarters)))]:
        found = seen(scene, *pose)
        off = apart(truth, found)
        worst = max(worst, off)
        if off > LIMIT or found.bad:
            wrong += 1
            print("   wrong:", name, pose, off, found.bad, flush=True)
    return f"| {name} | {truth.impacts} | {len(truth.turns)} | {poses} | {worst:.1e} | {wrong} |", wrong
