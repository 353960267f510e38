"""What do other engines need to know of a scene?

Only what they all can do: bodies that turn, are free or fixed, one set of contact parameters for each outline, constant
torques, linear springs and dampers. Anything else is refused rather than left out in silence.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.bench.engines.convex import Piece, convex_pieces
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene

MOTIONS = ("pivot", "free", "fixed")


@dataclass(frozen=True, slots=True)
class Surface:
    """One convex piece of a body's outline, in its frame, m. Two meet where one's `own` bit is in the other's `meets`."""

    body: str
    piece: Piece
    own: int
    meets: int
    friction: float
    restitution: float


@dataclass(frozen=True, slots=True)
class Drive:
    """torque - stiffness (q - rest) - viscous u on a pivoted body, SI."""

    body: str
    torque: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0
    viscous: float = 0.0


def bodies(scene: Scene) -> tuple[Body, ...]:
    """The bodies; ValueError where one moves in a way other engines do not know here."""
    for body in scene.bodies:
        if body.motion not in MOTIONS:
            raise ValueError(f'body "{body.name}" can {body.motion}: not compared with other engines')
    return scene.bodies


def drives(scene: Scene) -> list[Drive]:
    """The forces on every pivoted body that has any; ValueError for forces other engines do not know here."""
    if any(torque.over != "constant" for torque in scene.torques):
        raise ValueError("a tabled torque: not compared with other engines")
    if any(damping.quadratic or damping.coulomb for damping in scene.damping):
        raise ValueError("damping other than viscous: not compared with other engines")
    found = []
    for body in scene.bodies:
        springs = [spring for spring in scene.springs if spring.body == body.name]
        if len(springs) > 1:
            raise ValueError(f'several springs on "{body.name}": not compared with other engines')
        drive = Drive(
            body.name,
            sum(torque.value for torque in scene.torques if torque.body == body.name),
            springs[0].stiffness if springs else 0.0,
            springs[0].rest if springs else 0.0,
            sum(damping.viscous for damping in scene.damping if damping.body == body.name),
        )
        if drive != Drive(body.name):
            found.append(drive)
    return found


def surfaces(scene: Scene, deviation: float) -> list[Surface]:
    """The convex pieces of all outlines that can touch; arcs become chords that stray by at most `deviation` metres."""
    return list(_surfaces(scene, deviation))


def _surfaces(scene: Scene, deviation: float) -> Iterator[Surface]:
    for body in scene.bodies:
        for loop in body.loops:
            own, meets, laws = 0, 0, set()
            for number, contact in enumerate(scene.contacts):
                for k, side in enumerate(contact.sides):
                    if side.body == body.name and side.layer in (None, loop.layer):
                        own |= 1 << (2 * number + k)
                        meets |= 1 << (2 * number + 1 - k)
                        laws.add((contact.friction, contact.restitution))
            if not own or loop.hole:
                continue
            if len(laws) > 1:
                raise ValueError(f'"{body.name}.{loop.layer}" has different contact laws: not compared with other engines')
            friction, restitution = laws.pop()
            for piece in convex_pieces(loop, deviation):
                yield Surface(body.name, piece, own, meets, friction, restitution)
