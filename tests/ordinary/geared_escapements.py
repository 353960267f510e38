"""Escapements driven through real gears: pairs of involute teeth in front of the escape wheel, as in a movement."""

import math
from dataclasses import replace

from ordinary.gear_scenes import DISTANCE, TEETH, Gear, outline

from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene

LEAVES, RATIO = TEETH[0], TEETH[1] / TEETH[0]
INERTIA = 2e-12  # kg·m², of each wheel of the train with its pinion
ARCS = 4  # a flank


def with_train(scene: Scene, pairs: int, driven: str = "wheel", friction: float = 0.0, toward: float = math.pi) -> Scene:
    """The scene with so many pairs of 30 and 8 teeth between its torque and body `driven`; they stand in a row `toward` (rad).

    The torque, taken over by the first wheel, is the larger by the ratio: without friction the escape wheel feels the same.
    """
    leaves = replace(outline(Gear(LEAVES, 0.4, ARCS)), layer="LEAVES")
    teeth = replace(outline(Gear(TEETH[1], -0.4, ARCS)), layer="GEAR")
    gap = math.pi / LEAVES  # from the middle of a leaf to that of the gap beside it
    wheel, contacts = scene.body(driven), list(scene.contacts)
    chain = [replace(wheel, loops=(*wheel.loops, leaves.moved(toward - wheel.angle - gap, (0.0, 0.0))))]
    for k in range(1, pairs + 1):
        before = chain[-1]
        x, y = (before.position[0] + DISTANCE * math.cos(toward), before.position[1] + DISTANCE * math.sin(toward))
        loops = (teeth,) if k == pairs else (teeth, leaves.moved(gap, (0.0, 0.0)))
        # A tooth points back at the pinion before it, a gap of its own pinion at the wheel after it.
        chain.append(Body(f"gear {k}", "pivot", (x, y), angle=toward + math.pi, inertia=INERTIA, loops=loops))
        contacts.append(Contact((Side(chain[-1].name, "GEAR"), Side(before.name, "LEAVES")), friction, 0.2))
    added = chain[:0:-1]  # the driven one first
    bodies = (*added, *(chain[0] if body.name == driven else body for body in scene.bodies))
    torques = tuple(
        replace(one, body=chain[-1].name, value=one.value * (-RATIO) ** pairs) if one.body == driven else one
        for one in scene.torques
    )
    return replace(scene, bodies=bodies, torques=torques, contacts=tuple(contacts))
