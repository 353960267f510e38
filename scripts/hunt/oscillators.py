"""Which mechanisms with an oscillator are drawn at random?

Number k of a seed is the same on every machine: a profile that swings with other torques, friction, restitution, places and
starts; perhaps behind pairs of real gears, perhaps with a second one beside it.
"""

import math
from dataclasses import replace

import numpy as np
from ordinary.geared_escapements import with_train

import watchsim as ws
from watchsim.mechanism.overlap import overlaps
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene

TEETH = {  # of the escape wheel, counted in the drawings
    **dict.fromkeys(("bench_lever", "carriage", "cylinder", "detent", "duplex", "pin_pallet"), 15),
    **dict.fromkeys(("remontoir", "set_a", "set_b", "swiss_lever", "tourbillon"), 15),
    **dict.fromkeys(("graham", "pin_wheel", "recoil_anchor"), 30),
    **{"coaxial": 8, "grasshopper": 60},
}
GEARED = ("swiss_lever", "detent", "coaxial", "cylinder", "duplex")
BESIDE = ("swiss_lever", "cylinder", "graham", "coaxial")
FAR = 0.5  # m, between two mechanisms of one scene
MOST_DRAWS = 20  # until parts stand apart
Rng = np.random.Generator


def mechanism(seed: int, number: int) -> Scene:
    """The title says what was made of which profile."""
    rng = np.random.default_rng((seed, number))
    for _ in range(MOST_DRAWS):
        name = str(rng.choice(sorted(TEETH)))
        scene = varied(ws.load(ws.profiles_dir() / name), rng)
        kind = str(rng.choice(["alone", "geared", "two"], p=[0.8, 0.1, 0.1]))
        if kind == "geared" and name in GEARED:
            scene = with_train(scene, int(rng.integers(1, 4)))
        elif kind == "two":
            other = str(rng.choice(BESIDE))
            scene, name = beside(scene, varied(ws.load(ws.profiles_dir() / other), rng)), f"{name} beside {other}"
        else:
            kind = "alone"
        scene = replace(scene, title=f"{name} {kind}", expect=(), tolerances=())
        try:
            if not overlaps(scene):
                return scene
        except SceneError:
            continue
    raise ValueError(f"mechanism {number} of seed {seed}: all draws overlap")


def varied(scene: Scene, rng: Rng) -> Scene:
    """With other numbers: most of them change little, some of them much."""
    torque = math.exp(rng.uniform(-0.7, 0.5)) if rng.random() < 0.8 else 1.0
    start = rng.uniform(0.5, 1.3) if rng.random() < 0.5 else 1.0
    contacts = scene.contacts
    if rng.random() < 0.7:
        friction, restitution = float(rng.uniform(0.0, 0.22)), float(rng.choice([0.0, rng.uniform(0.0, 0.8)]))
        contacts = tuple(replace(one, friction=friction, restitution=restitution) for one in contacts)
    moved = float(10.0 ** rng.uniform(-4.0, -2.3)) if rng.random() < 0.5 else 0.0  # of the distance between two pivots
    drawn = {one.body for one in scene.torques}
    size = max(math.dist(a.position, b.position) for a in scene.bodies for b in scene.bodies)
    bodies = []
    for body in scene.bodies:
        x, y = body.position
        if body.name in drawn and body.on is None:
            x, y = x + moved * size * float(rng.uniform(-1.0, 1.0)), y + moved * size * float(rng.uniform(-1.0, 1.0))
        bodies.append(replace(body, position=(x, y), velocity=tuple(start * one for one in body.velocity)))
    torques = tuple(replace(one, value=torque * one.value) for one in scene.torques)
    return replace(scene, bodies=tuple(bodies), torques=torques, contacts=contacts)


def beside(scene: Scene, other: Scene) -> Scene:
    """Both in one scene, the second far away, its bodies under names of their own."""
    names = {body.name: f"{body.name} 2" for body in other.bodies}
    bodies = tuple(
        replace(body, name=names[body.name], position=(body.position[0] + FAR, body.position[1]), on=names.get(body.on or ""))
        for body in other.bodies
    )
    contacts = []
    for one in other.contacts:
        first, second = (replace(side, body=names[side.body]) for side in one.sides)
        contacts.append(replace(one, sides=(first, second)))
    gravity = scene.gravity if any(scene.gravity) else other.gravity
    return replace(
        scene,
        bodies=(*scene.bodies, *bodies),
        contacts=(*scene.contacts, *contacts),
        springs=(*scene.springs, *(replace(one, body=names[one.body]) for one in other.springs)),
        torques=(*scene.torques, *(replace(one, body=names[one.body]) for one in other.torques)),
        damping=(*scene.damping, *(replace(one, body=names[one.body]) for one in other.damping)),
        gravity=gravity,
    )
