"""Which cams made of many tangent arcs have a motion that is known?"""

import math
from collections.abc import Sequence

from reference.cam import Drive, Piece, start

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene

DRIVE = Drive(inertia=2e-8, torque=1e-8, roller=0.4e-3, mass=1e-5, stiffness=2.0, rest=-2e-3)
RATE = 25.0
ECCENTRIC = (Piece(0.2e-3, 0.05e-3, 1.1e-3, 0.0, 2.0 * math.pi),)


def cam_outline(pieces: Sequence[Piece], cuts: int) -> Loop:
    """Each piece cut into `cuts` tangent arcs."""
    edges = []
    for piece in pieces:
        step = (piece.last - piece.first) / cuts
        edges += [Arc(piece.x, piece.y, piece.radius, piece.first + i * step, step) for i in range(cuts)]
    return Loop(tuple(edges))


def cam_scene(pieces: Sequence[Piece], cuts: int, duration: float, friction: float = 0.0, angle: float = 0.3) -> Scene:
    """The cam turns from `angle` at RATE; the roller stands on it."""
    height, speed = start(tuple(pieces), DRIVE, angle, RATE)
    roller = Loop((Arc(0.0, 0.0, DRIVE.roller, 0.0, 2.0 * math.pi),))
    bodies = (
        Body("cam", "pivot", (0.0, 0.0), angle, velocity=(RATE,), inertia=DRIVE.inertia, loops=(cam_outline(pieces, cuts),)),
        Body("roller", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(speed,), mass=DRIVE.mass, loops=(roller,)),
    )
    return Scene(
        "cam",
        bodies,
        springs=(Spring("roller", DRIVE.stiffness, DRIVE.rest - height),),
        torques=(Torque("cam", DRIVE.torque),),
        contacts=(Contact((Side("roller"), Side("cam")), friction, 0.5),),
        duration=duration,
        tolerance=1e-11,
    )
