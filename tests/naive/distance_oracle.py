"""How far apart are two bodies? Outlines sampled densely, every point against every chord, signed by an inside test.

Shares nothing with the package but the data classes of lines, arcs and loops, whose fields alone it reads. Errors are of
the second order in the sample spacing: about spacing² / (8 radius) at arcs, less than spacing² / (2 gap) at corners passed by.
"""

import math
from typing import NamedTuple

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc

Pose = tuple[float, float, float]  # x, y (m), angle (rad)


class Nearest(NamedTuple):
    """Signed gap (m), negative where the bodies overlap, and the two points it was measured between."""

    gap: float
    on_a: np.ndarray
    on_b: np.ndarray


def nearest(a: tuple[Loop, ...], pose_a: Pose, b: tuple[Loop, ...], pose_b: Pose, spacing: float) -> Nearest:
    """The gap between two bodies given by closed loops (material on the left; holes run clockwise).

    Apart: the smallest distance of the outlines. Overlapping: minus the deepest sample of either inside the other.
    """
    chords_a, chords_b = chords(a, pose_a, spacing), chords(b, pose_b, spacing)
    best = _deepest(chords_a, chords_b)
    if best is None:
        found = [_closest(chords_a, chords_b), _swapped(_closest(chords_b, chords_a))]
        best = min(found, key=lambda one: one.gap)
    return best


def gap(a: tuple[Loop, ...], pose_a: Pose, b: tuple[Loop, ...], pose_b: Pose, spacing: float) -> float:
    """The signed gap alone, m."""
    return nearest(a, pose_a, b, pose_b, spacing).gap


def chords(loops: tuple[Loop, ...], pose: Pose, spacing: float) -> np.ndarray:
    """(k, 4) chords x0, y0, x1, y1 of all outlines at `pose`, none longer than about `spacing`."""
    pieces = []
    for loop in loops:
        for edge in loop.edges:
            points = _turned(_sampled(edge, spacing), pose)
            pieces.append(np.hstack([points[:-1], points[1:]]))
    return np.vstack(pieces)


def inside(points: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Which points (k, 2) lie in the material: those the outlines wind around."""
    turns = np.zeros(len(points))
    for x0, y0, x1, y1 in outline:
        ax, ay, bx, by = x0 - points[:, 0], y0 - points[:, 1], x1 - points[:, 0], y1 - points[:, 1]
        turns += np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
    return turns > math.pi


def _sampled(edge: object, spacing: float) -> np.ndarray:
    """Points along an edge, both ends included."""
    if isinstance(edge, Arc):
        count = max(8, math.ceil(edge.radius * abs(edge.sweep) / spacing))
        angle = edge.start_angle + edge.sweep * np.linspace(0.0, 1.0, count + 1)
        return np.column_stack([edge.x + edge.radius * np.cos(angle), edge.y + edge.radius * np.sin(angle)])
    count = max(1, math.ceil(math.hypot(edge.x1 - edge.x0, edge.y1 - edge.y0) / spacing))
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    return (1.0 - share) * np.array([[edge.x0, edge.y0]]) + share * np.array([[edge.x1, edge.y1]])


def _turned(points: np.ndarray, pose: Pose) -> np.ndarray:
    x, y, angle = pose
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + np.array([x, y])


def _closest(chords_a: np.ndarray, chords_b: np.ndarray) -> Nearest:
    """The sample of a that is nearest to a chord of b."""
    distance, foot = _to_chords(chords_a[:, :2], chords_b)
    i = int(np.argmin(distance))
    return Nearest(float(distance[i]), chords_a[i, :2], foot[i])


def _deepest(chords_a: np.ndarray, chords_b: np.ndarray) -> Nearest | None:
    """The deepest sample of either body inside the other; None when there is none."""
    found = []
    for mine, other, order in ((chords_a, chords_b, 1), (chords_b, chords_a, -1)):
        within = mine[inside(mine[:, :2], other), :2]
        if len(within):
            depth, foot = _to_chords(within, other)
            i = int(np.argmax(depth))
            one = Nearest(-float(depth[i]), within[i], foot[i])
            found.append(one if order > 0 else _swapped(one))
    return min(found, key=lambda one: one.gap) if found else None


def _swapped(one: Nearest) -> Nearest:
    return Nearest(one.gap, one.on_b, one.on_a)


def _to_chords(points: np.ndarray, outline: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each point to the nearest chord, and the foot on it."""
    best = np.full(len(points), np.inf)
    foot = np.zeros_like(points)
    for x0, y0, x1, y1 in outline:
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        if square > 0.0:
            share = np.clip(((points[:, 0] - x0) * dx + (points[:, 1] - y0) * dy) / square, 0.0, 1.0)
        else:
            share = np.zeros(len(points))
        fx, fy = x0 + share * dx, y0 + share * dy
        distance = np.hypot(points[:, 0] - fx, points[:, 1] - fy)
        closer = distance < best
        best[closer] = distance[closer]
        foot[closer] = np.column_stack([fx, fy])[closer]
    return best, foot
