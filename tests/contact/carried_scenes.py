"""Which pairs of bodies hang on carriers, and where are they by the rules of the scene file?"""

import functools
import math
from collections.abc import Callable

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene

CARRIERS = ("pivot", "slide", "free")
# Who the pivoted body "a" on the carriage meets: "b" beside it on the carriage, the carriage itself, a part fixed on it, bodies
# in the movement, one on a carriage of its own.
PARTNERS = ("beside", "carrier", "part", "fixed", "pivot", "slide", "free", "other")
ARRANGEMENTS = [(carrier, partner, False) for carrier in CARRIERS for partner in PARTNERS] + [
    ("pivot", "beside", True),
    ("pivot", "fixed", True),
    ("slide", "part", True),
]

Shape = Callable[[str], tuple[Loop, ...]]
AXIS = (math.cos(0.7), math.sin(0.7))


def carried_scene(carrier: str, partner: str, deep: bool, shape: Shape, at: tuple[float, float]) -> tuple[Scene, Compiled]:
    """Body a pivoted at `at` on a carriage that pivots, slides or is free, and what it meets.

    `deep`: a sits on a hub in between, coaxial with the carriage or fixed on it.
    """

    def moving(name: str, motion: str, place: tuple[float, float], outlined: bool, on: str | None = None) -> Body:
        angle = 0.6 if motion in ("slide", "fixed") else 0.0
        loops = shape(name) if outlined else ()
        return Body(name, motion, place, angle, axis=AXIS, mass=0.0 if on else 1.0, inertia=1.0, loops=loops, on=on)

    met = {"beside": "b", "carrier": "carriage", "part": "b"}.get(partner, "b")
    bodies = [moving("carriage", carrier, (0.3, -0.2), met == "carriage")]
    below = "carriage"
    if deep:
        hub = "pivot" if carrier == "pivot" else "fixed"
        bodies.append(moving("hub", hub, (0.0, 0.0) if hub == "pivot" else (0.05, 0.1), False, "carriage"))
        below = "hub"
    # The carried body stands before its carrier, as a scene file may have it.
    bodies.insert(0, moving("a", "pivot", at, True, below))
    if partner in ("beside", "part"):
        bodies.append(moving("b", "pivot" if partner == "beside" else "fixed", (-0.2, 0.15), True, "carriage"))
    elif partner == "other":
        bodies += [moving("second", "pivot", (0.1, 0.5), False), moving("b", "pivot", (0.3, -0.1), True, "second")]
    elif partner != "carrier":
        bodies.append(moving("b", partner, (-0.1, 0.4), True))
    scene = Scene("carried", tuple(bodies), contacts=(Contact((Side("a"), Side(met)), 0.2, 0.5),))
    return scene, compile_scene(scene)


def places(scene: Scene, compiled: Compiled, q: np.ndarray) -> dict[str, tuple[float, float, float]]:
    """x, y, angle of every body in the movement, from coordinates told as in a scene file, by the words of its manual."""
    told = compiled.relative(q[None])[0]
    by_name = {body.name: body for body in scene.bodies}

    @functools.cache
    def place(name: str) -> tuple[float, float, float]:
        body, (x, y), turn = by_name[name], by_name[name].position, by_name[name].angle
        own = told[compiled.slices[name]] if name in compiled.slices else ()
        if body.motion == "pivot":
            turn = own[0]
        elif body.motion == "slide":
            x, y = x + own[0] * body.axis[0], y + own[0] * body.axis[1]
        elif body.motion == "free":
            x, y, turn = own
        if body.on is None:
            return x, y, turn
        cx, cy, angle = place(body.on)
        return cx + math.cos(angle) * x - math.sin(angle) * y, cy + math.sin(angle) * x + math.cos(angle) * y, angle + turn

    return {name: place(name) for name in by_name}
