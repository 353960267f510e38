"""Geneva stop-work on the barrel of a watch, wound by hand: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import geneva as of_drive
from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.geneva import (
    BORE_WHEEL,
    Geneva,
    centre_distance,
    driver,
    half_pitch,
    mouth_half,
    sector,
    slot_bottom,
    slot_half,
    wheel_radius,
)
from watchsim.construction.outline import arc_between, circle, polar
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop

USUAL = "usual in watches"


@dataclass(frozen=True)
class GenevaStop:
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


SPARE = 1.1


def conflicts(values: GenevaStop) -> Iterator[Conflict]:
    """What cannot be drawn as a Geneva drive, and a hand that is too weak to wind."""
    for one in of_drive.conflicts(values.drive):
        yield Conflict("turns" if one.dimension == "slots" else one.dimension, one.message)
    if values.hand < SPARE * values.mainspring:
        yield Conflict("hand", f"must be at least {SPARE * values.mainspring:.4g} mN·m, or it does not wind the mainspring up")


# What is the outline of the Maltese cross?
#
# That of a Geneva drive's wheel, but one of the arms has no hollow: its end is round about the cross's own axis, and the disc
# on the arbor cannot pass.


def cross(drive: Geneva) -> list[Loop]:
    """The cross and its bore; the arm without a hollow ends at its last slot but one."""
    pitch = math.radians(2.0 * half_pitch(drive))
    slot_and_hollow = sector(drive)
    rim, mouth, middle = wheel_radius(drive), mouth_half(drive), half_pitch(drive)
    blunt = arc_between(polar(rim, mouth), polar(rim, 2.0 * middle - mouth), (0.0, 0.0), True)
    parts = [
        Loop((*slot_and_hollow[:3], blunt) if i == drive.slots - 2 else tuple(slot_and_hollow), "CROSS")
        for i in range(drive.slots)
    ]
    edges = [edge for i, part in enumerate(parts) for edge in part.moved(i * pitch, (0.0, 0.0)).edges]
    bore = BORE_WHEEL * (slot_bottom(drive) - slot_half(drive))
    return [Loop(tuple(edges), "CROSS"), circle("CROSS", (0.0, 0.0), bore, hole=True)]


LONGER = 1.4  # times the time that the turns would take at the speed without impacts
OUTSIDE = 90.0  # degrees of the arbor from where its pin is deepest, at the start

WORDS = """\
A Geneva stop-work: each turn of the barrel arbor takes the Maltese cross on by an arm; the arm without a hollow stops the
arbor. Drawn to these dimensions:"""


def scene_text(values: GenevaStop) -> str:
    """The text of scene.toml: let down, the arbor a quarter of a turn past the lower stop."""
    drive, wound, start = values.drive, math.tau * values.turns, f"{180.0 - 360.0 + OUTSIDE!r}°"
    fastest = math.radians(values.speed)
    slowest = fastest * (1.0 - values.mainspring / values.hand)
    duration = LONGER * wound * math.log(fastest / slowest) / (fastest - slowest)
    return toml.scene(
        toml.head(values, WORDS, f"Geneva stop-work, {values.turns} turns"),
        toml.body(
            *("arbor", "arbor", "PIN DISC", "wound counter-clockwise by hand"),
            position=toml.at(centre_distance(drive), 0),
            angle=start,
            inertia=f"{values.arbor_inertia:.15g} g·mm²",
        ),
        toml.body(
            *("cross", "cross", "CROSS", f"turns clockwise, {2.0 * half_pitch(drive):.6g}° at a time"),
            position=toml.ORIGIN,
            angle=f"{half_pitch(drive)!r}°",
            inertia=f"{values.cross_inertia:.15g} g·mm²",
        ),
        toml.torque("arbor", f"{values.hand:.15g} mN·m", "the hand"),
        toml.table(
            *("[[springs]]", "the mainspring, slack at the start, pulls back"),
            body="arbor",
            stiffness=f"{values.mainspring / wound!r} mN·m/rad",
            rest=start,
        ),
        toml.table(
            *("[[damping]]", "the hand does not turn faster"),
            body="arbor",
            viscous=f"{values.hand / math.radians(values.speed)!r} mN·m·s/rad",
        ),
        toml.table("[[damping]]", body="cross", coulomb=f"{values.load:.15g} mN·m") if values.load > 0.0 else None,
        toml.contacts(values, "arbor.PIN cross.CROSS", "arbor.DISC cross.CROSS: the lock, and the stop"),
        toml.run(f"{duration:.6g} s"),
    )


def draw(values: GenevaStop) -> dict[str, Sheet]:
    """Arbor with finger and disc, and the cross."""
    return sheets_of(arbor=driver(values.drive), cross=cross(values.drive))


DESIGN = Design(
    "geneva_stop", "Geneva stop-work on the barrel of a watch, wound by hand", GenevaStop, draw, scene_text, conflicts
)
