"""What is a body?"""

from __future__ import annotations

from dataclasses import dataclass, field

from watchsim.drawing.profile import Profile
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.scene.gearing import Geared
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.solid import Solid

MOTIONS = ("pivot", "slide", "free", "fixed")


@dataclass(frozen=True)
class Body:
    """A rigid part, SI units. Its outlines are in its own frame, whose origin is the pivot (free bodies: the centre of mass).

    motion          "pivot", "slide", "free" or "fixed"; its coordinates q are the angle itself; the distance travelled along
                    `axis` from `position`; x, y and angle; none
    position, angle  where the frame stands at the start, m and rad
    velocity        at the start, in the order of the coordinates: rad/s; m/s; m/s, m/s, rad/s
    mass, inertia   kg, and kg·m² about the origin (free bodies: about the centre of mass)
    centre_of_mass  in the body's frame, m; it matters only where gravity acts on a pivoted body
    loops           outlines that can touch; `decoration` is drawn only
    solids          where mass and inertia come from, as far as they were not given as numbers
    prescribed      the law by which a driven body moves whatever it meets; mass and inertia then change nothing
    on              the body that carries it; position, angle and velocity are then given in that one's frame, relative to it
    geared          to which body without play: its coordinate then follows from that one's
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
    geared: Geared | None = None

    def __repr__(self) -> str:
        layers = ", ".join(self.layers) or "no outline that can touch"
        return f"<Body {self.name!r}, {'driven' if self.prescribed else self.motion}: {layers}>"

    @property
    def layers(self) -> tuple[str, ...]:
        """The layers of its outlines that can touch, in the order of the drawing."""
        return tuple(dict.fromkeys(loop.layer for loop in self.loops))

    @property
    def profile(self) -> Profile:
        """Everything drawn of it, in its own frame."""
        drawn = (*self.loops, *self.decoration)
        return Profile(tuple(loop for loop in drawn if loop.closed), tuple(loop for loop in drawn if not loop.closed))
