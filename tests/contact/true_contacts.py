"""Where do two bodies really touch? Every pair of primitives at any pose, with none of the package's kernels.

A pair is a contact where the circle's surface lies on the other primitive, inside both: opposite each other on their lengths
and within the fans of their normals.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pair_scenes import body_pose, places

from watchsim.mechanism.compile import Compiled
from watchsim.model import FULL, LINE
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]
STEPS = 40  # of the search for a pose that touches


class Looks(NamedTuple):
    """Contacts of a compiled scene at one pose."""

    gap: Array  # m
    inside: Array  # rad or m: how far inside both primitives, negative outside


def looks(scene: Scene, compiled: Compiled, q: Array, those: slice = slice(None)) -> Looks:
    """Gaps and margins of those contacts at q."""
    poses, contacts = _poses(scene, compiled, q), compiled.model.contacts[those]
    a, b = compiled.model.primitives[contacts.a], compiled.model.primitives[contacts.b]
    centre, start = _world(poses[a.body], a.x, a.y), _world(poses[b.body], b.x, b.y)
    turn_a, turn_b = poses[a.body, 2], poses[b.body, 2]
    offset = centre - start
    line = b.kind == LINE
    heading = turn_b + np.arctan2(b.ty, b.tx)
    along = offset * np.exp(-1j * heading)
    distance = np.abs(offset)
    # Left of a line is its material; of an arc, side tells.
    gap = np.where(line, -along.imag, b.side * (distance - b.radius)) - a.radius
    normal = np.where(
        line, np.exp(1j * (turn_b + np.arctan2(b.ty, b.tx) - 0.5 * np.pi)), b.side * np.exp(1j * np.angle(offset))
    )
    on_b = np.where(line, np.minimum(along.real, b.length - along.real), _within(b, normal, turn_b))
    return Looks(gap, np.minimum(_within(a, -normal, turn_a), on_b))


def _poses(scene: Scene, compiled: Compiled, q: Array) -> Array:
    """x, y, angle of every body."""
    if any(body.on is not None for body in scene.bodies):
        where = places(scene, compiled, q)
        return np.array([where[body.name] for body in scene.bodies])
    return np.array([body_pose(scene, body.name, q) for body in scene.bodies])


def touches(scene: Scene, compiled: Compiled, rng: np.random.Generator, poses: Iterator[Array]) -> Iterator[tuple[int, Array]]:
    """(contact, pose) near `poses`, to rounding in contact: one coordinate is changed until the gap is closed."""
    for q in poses:
        now = looks(scene, compiled, q)
        near = np.flatnonzero((now.inside > 0.0) & (np.abs(now.gap) < 0.5))
        for k in rng.permutation(near)[:4]:
            there = _closed(scene, compiled, int(k), q, int(rng.integers(len(q))))
            if there is not None:
                yield int(k), there


def _closed(scene: Scene, compiled: Compiled, k: int, q: Array, i: int) -> Array | None:
    """The pose at which contact k touches when coordinate i alone is changed; None where the secant method finds none."""
    q, alone = q.copy(), slice(k, k + 1)

    def gap_at(q: Array) -> float:
        return float(looks(scene, compiled, q, alone).gap[0])

    change, before = 1e-6, gap_at(q)
    for _ in range(STEPS):
        q[i] += change
        gap = gap_at(q)
        slope = (gap - before) / change
        if abs(gap) < 1e-12:
            break
        if abs(slope) < 1e-3:
            return None
        change, before = -float(np.clip(gap / slope, -0.3, 0.3)), gap
    last = looks(scene, compiled, q, alone)
    return q if abs(last.gap[0]) < 1e-9 and last.inside[0] >= 0.0 else None


def _world(pose: Array, x: Array, y: Array) -> NDArray[np.complex128]:
    return pose[:, 0] + 1j * pose[:, 1] + np.exp(1j * pose[:, 2]) * (x + 1j * y)


def _within(p: np.recarray, normal: NDArray[np.complex128], turn: Array) -> Array:
    """How far a normal (world) lies within the fans of some arcs or corners, rad."""
    middle = np.exp(1j * turn) * (p.nx + 1j * p.ny)
    half = np.where(p.extent == FULL, 4.0, np.arctan2(p.half_sin, p.half_cos))
    return half - np.abs(np.angle(normal / middle))
