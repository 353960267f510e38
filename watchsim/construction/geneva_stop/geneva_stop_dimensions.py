"""Which numbers does the designer of a Geneva stop-work choose?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.construction.dimension import dim
from watchsim.construction.geneva.geneva_dimensions import Geneva

CHOSEN, USUAL = "chosen for this design", "usual in watches"


@dataclass(frozen=True)
class GenevaStop:
    """The dimensions with their defaults, each in the unit that its declaration names."""

    turns: int = dim(4, "", 3, 7, "of the barrel arbor between both stops; the Maltese cross has an arm more", USUAL)
    crank: float = dim(1.5, "mm", 0.2, 20.0, "finger, from the arbor's axis to the middle of its pin", CHOSEN)
    pin_radius: float = dim(0.2, "mm", 0.02, 3.0, "of the finger's pin", CHOSEN)
    pin_play: float = dim(0.01, "mm", 0.0005, 0.1, "between the pin and either side of a slot", CHOSEN)
    bottom_play: float = dim(0.05, "mm", 0.001, 1.0, "between the pin and the bottom of a slot", CHOSEN)
    lock_radius: float = dim(1.15, "mm", 0.1, 19.0, "of the hollows in the cross, in which the arbor's disc turns", CHOSEN)
    lock_play: float = dim(0.01, "mm", 0.0005, 0.1, "between the disc and a hollow", CHOSEN)
    hand: float = dim(8.0, "mN·m", 0.01, 1e3, "torque of the hand on the arbor", CHOSEN)
    mainspring: float = dim(5.0, "mN·m", 1e-3, 1e3, "torque of the mainspring on the arbor, fully wound", CHOSEN)
    speed: float = dim(720.0, "°/s", 10.0, 3600.0, "at which the hand would turn an arbor without mainspring", CHOSEN)
    arbor_inertia: float = dim(2000.0, "g·mm²", 300.0, 1e6, "arbor with winding wheels and hand as felt there", CHOSEN)
    cross_inertia: float = dim(0.05, "g·mm²", 1e-4, 1e4, "Maltese cross", CHOSEN)
    load: float = dim(0.02, "mN·m", 0.0, 10.0, "dry friction of the cross below its shouldered screw", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction, in all contacts", "steel on oiled steel")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)

    @property
    def drive(self) -> Geneva:
        """The Geneva drive that it is but for one arm."""
        return Geneva(
            slots=self.turns + 1,
            crank=self.crank,
            pin_radius=self.pin_radius,
            pin_play=self.pin_play,
            bottom_play=self.bottom_play,
            lock_radius=self.lock_radius,
            lock_play=self.lock_play,
        )
