"""Which mechanism has number k of a seed?"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from hunt.generator import pivots, sliders
from hunt.generator.material import apart
from hunt.generator.parts import Dice
from watchsim.scene.scene import Scene

FAMILIES: dict[str, tuple[Callable[[Dice], Scene], int]] = {  # with their weights
    "blade": (pivots.blade, 10),
    "cam": (pivots.cam, 9),
    "gears": (pivots.gears, 4),
    "ratchet": (pivots.ratchet, 6),
    "geneva": (pivots.geneva, 5),
    "anchor": (pivots.anchor, 6),
    "pendulums": (pivots.pendulums, 9),
    "levers": (pivots.levers, 10),
    "kink": (sliders.kink, 10),
    "wave": (sliders.wave, 7),
    "row": (sliders.row, 9),
    "blocks": (sliders.blocks, 8),
    "boxed": (sliders.boxed, 5),
    "wedge": (sliders.wedge, 6),
    "pressed": (sliders.pressed, 6),
    "crowd": (sliders.crowd, 0),  # only by name: a run takes longer than all of another mechanism
}
ATTEMPTS = 200
TURNS = 30.0  # of what nothing stops: a body that misses what it should meet turns ever faster


def mechanism(seed: int, number: int, family: str | None = None) -> Scene:
    """Begins with all bodies apart or just touching; what overlaps at the start is thrown again."""
    dice = Dice(seed, number)
    names = [family] if family else [name for name, (_, weight) in FAMILIES.items() for _ in range(weight)]
    for _ in range(ATTEMPTS):
        scene = FAMILIES[dice.pick(names)][0](dice)
        if apart(scene):
            return replace(scene, duration=min(scene.duration, *_runaway(scene)))
    raise RuntimeError(f"no start without overlap in {ATTEMPTS} attempts for number {number} of seed {seed}")


def _runaway(scene: Scene) -> list[float]:
    """The times (s) in which constant torques give their bodies so many turns from rest if nothing stops them."""
    found = [math.inf]
    for torque in scene.torques:
        body = scene.body(torque.body)
        if body.motion == "pivot" and torque.value != 0.0:
            found.append(math.sqrt(2.0 * TURNS * 2.0 * math.pi * body.inertia / abs(torque.value)))
    return found
