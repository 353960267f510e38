"""With which arrows does a picture show how hard bodies press on one another?

An arrow begins where two bodies touch and tells the force on that one of them which comes later in the scene and can move:
on the lever from the wheel, on the balance from the lever. All arrows of a movie have one scale.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from watchsim.analysis.contact_forces import forces
from watchsim.mechanism.compile import compile_scene
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]

HEAD, WIDE, SHAFT = 0.28, 0.1, 0.034  # of the longest arrow: length of a head, half widths of head and shaft
AT_ONCE = 2000  # instants
LEAST = 0.02  # of the longest arrow: shorter ones are dots


class ForceArrows:
    """Points (m) and forces (N) at the instants of a movie. ValueError where a run does not tell its forces."""

    def __init__(self, run: Trajectory, times: Array) -> None:
        self._at: list[tuple[Array, Array]] = []
        order = {body.name: k for k, body in enumerate(run.scene.bodies)}
        fixed = {body.name for body in run.scene.bodies if body.motion == "fixed"}
        drawn = _drawn(run)
        for start in range(0, len(times), AT_ONCE):
            told = forces(run, times[start : start + AT_ONCE])
            n, turned = told.direction, np.stack((-told.direction[..., 1], told.direction[..., 0]), axis=-1)
            on_a = told.normal[..., None] * n + told.tangential[..., None] * turned
            pairs = [run.pairs[number] for number in told.pairs.tolist()]
            sign = [1.0 if _rank(one.body_a, order, fixed) > _rank(one.body_b, order, fixed) else -1.0 for one in pairs]
            on_later = on_a * np.array(sign).reshape(1, -1, 1)
            for points, own in zip(told.point, on_later, strict=True):
                held = np.isfinite(points[:, 0]) & drawn[told.pairs]
                self._at.append((points[held], own[held]))
        sizes = [float(np.hypot(*own.T).max()) for _, own in self._at if len(own)]
        self.largest = max(sizes, default=0.0)

    def at(self, k: int) -> tuple[Array, Array]:
        """Points (n, 2), m, and forces (n, 2), N, of the k-th instant."""
        return self._at[k]

    @property
    def round_force(self) -> float:
        """A round force (N) of at most the largest, for the scale; 0 where nothing presses."""
        if self.largest <= 0.0:
            return 0.0
        power = 10.0 ** math.floor(math.log10(self.largest))
        return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= self.largest * (1.0 + 1e-9))


def _drawn(run: Trajectory) -> NDArray[np.bool_]:
    """For each contact: is it between bodies of the scene, and not of gears with play or of a stop, which have no place?"""
    model = compile_scene(run.scene).model
    body, contacts = model.primitives.body, model.contacts
    return np.asarray(np.maximum(body[contacts.a], body[contacts.b]) < len(run.scene.bodies))


def _rank(name: str, order: dict[str, int], fixed: set[str]) -> int:
    return -1 if name in fixed else order[name]


def arrow_path(starts: Array, ways: Array, longest: float) -> Path | None:
    """Filled arrows (pixels) from `starts` (n, 2) by `ways` (n, 2); None where there are none to be seen."""
    made = [
        _arrow(start, way, length, longest)
        for start, way, length in zip(starts, ways, np.hypot(*ways.reshape(-1, 2).T).tolist(), strict=True)
        if length > LEAST * longest
    ]
    return Path.make_compound_path(*made) if made else None


def _arrow(start: Array, way: Array, length: float, longest: float) -> Path:
    along = way / length
    across = np.array([-along[1], along[0]])
    head = min(HEAD * longest, 0.6 * length)
    wide, shaft = WIDE * longest * head / (HEAD * longest), SHAFT * longest * min(1.0, length / (0.5 * longest))
    neck = length - head
    outline = [(0, shaft), (neck, shaft), (neck, wide), (length, 0), (neck, -wide), (neck, -shaft), (0, -shaft), (0, shaft)]
    codes = [Path.MOVETO, *[Path.LINETO] * 6, Path.CLOSEPOLY]
    return Path([start + x * along + y * across for x, y in outline], codes)
