"""Which outlines of the lever are the entry and the exit stone?

As the geometry of function has it: the stone that a tooth meets first on its way is the entry stone, whatever layers are called
and in whatever order they were drawn.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from watchsim.escapement.measure import Function, measure
from watchsim.geometry.loop import Loop
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.render.frame.filled_parts import loops_of, outline
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.record.body_frames import frames

STONES = ("entry stone", "exit stone")
FINE = 1e-6  # of the scene's size: how closely an outline is followed to find which one a tooth rests on


class PalletStones:
    """The stones of a scene's lever; its geometry of function is measured once, when the first of them is asked for."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def stone(self, name: str) -> tuple[Body, Loop]:
        """The lever and the outline of its "entry stone" or "exit stone". ValueError where there is no such stone."""
        scene, (compiled, found) = self._scene, self._measured
        if found.parts is None or found.passages is None:
            what, why = found.missing[-1]
            raise ValueError(f'"{name}" is not known: {what} not measured, {why}')
        rest = found.passages[STONES.index(name)].start
        lever = scene.body(found.parts.lever)
        q = np.array(compiled.q)
        q[compiled.slices[lever.name].start] = rest.lever
        x, y, angle = frames(scene, compiled.slices, compiled.relative(q[None]))[lever.name][0].tolist()
        c, s = math.cos(angle), math.sin(angle)
        dx, dy = rest.x - x, rest.y - y
        there = np.array([c * dx + s * dy, -s * dx + c * dy])
        return lever, min(loops_of(lever), key=lambda loop: _distance(loop, there, FINE * compiled.size))

    @cached_property
    def _measured(self) -> tuple[Compiled, Function]:
        compiled = compile_scene(self._scene)
        return compiled, measure(self._scene, compiled)


def _distance(loop: Loop, point: np.ndarray, deviation: float) -> float:
    """Of a point from an outline, m."""
    corners = outline([loop], deviation)
    first, way = corners[:-1], np.diff(corners, axis=0)
    share = np.clip(np.sum((point - first) * way, axis=1) / np.maximum(np.sum(way * way, axis=1), 1e-300), 0.0, 1.0)
    return float(np.hypot(*(first + share[:, None] * way - point).T).min())
