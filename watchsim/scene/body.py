"""What is a body?"""

from __future__ import annotations

from dataclasses import dataclass, field

from watchsim.drawing.profile import Profile
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.solid import Solid

MOTIONS = ("pivot", "slide", "free", "fixed")


@dataclass(frozen=True)
class Body:
    """A rigid part, SI units. Its outlines are in its own frame, whose origin is the pivot (free bodies: the centre of mass).

    At the start the frame stands at `position`, turned by `angle`. Coordinates q by motion:
    pivot - the angle itself; slide - the distance travelled along `axis` from `position`; free - x, y, angle; fixed - none.
    `velocity` is the start velocity in the same order (pivot: rad/s; slide: m/s; free: m/s, m/s, rad/s).
    `centre_of_mass` is in the body frame; it matters only where gravity acts on a pivoted body. `solids` say where mass and
    inertia come from, as far as they were not given as numbers.
    `prescribed` is the law by which a driven body moves whatever it meets; mass and inertia then change nothing.
    `on` names the body that carries it; position, angle and velocity are then given in that one's frame, relative to it.
    """

    name: str
    motion: str = "pivot"
    position: Point = (0.0, 0.0)
    angle: float = 0.0
    velocity: tuple[float, ...] = ()
    axis: Point = (1.0, 0.0)
    mass: float = 0.0
    inertia: float = 0.0
    centre_of_mass: Point = (0.0, 0.0)
    loops: tuple[Loop, ...] = ()
    decoration: tuple[Loop, ...] = field(default=())
    solids: tuple[Solid, ...] = field(default=())
    on: str | None = None
    prescribed: Prescribed | None = None

    @property
    def layers(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(loop.layer for loop in self.loops))

    @property
    def profile(self) -> Profile:
        """Everything drawn of it, in its own frame."""
        drawn = (*self.loops, *self.decoration)
        return Profile(tuple(loop for loop in drawn if loop.closed), tuple(loop for loop in drawn if not loop.closed))
