"""Geneva drive with a locking disc: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import arc_between, around, circle, polar
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line


@dataclass(frozen=True)
class Geneva:
    slots: int = dim(4, "", 3, 16, "slots of the driven wheel", "usual: 4 to 8")
    crank: float = dim(10.0, "mm", 0.2, 200.0, "driver, from its axis to the middle of the pin", CHOSEN)
    pin_radius: float = dim(1.5, "mm", 0.02, 30.0, "of the driving pin", CHOSEN)
    pin_play: float = dim(0.01, "mm", 0.0005, 1.0, "between the pin and either side of a slot", CHOSEN)
    bottom_play: float = dim(0.3, "mm", 0.001, 10.0, "between the pin and the bottom of a slot", CHOSEN)
    lock_radius: float = dim(7.0, "mm", 0.1, 190.0, "of the hollows in the wheel, in which the driver's disc locks it", CHOSEN)
    lock_play: float = dim(0.02, "mm", 0.0005, 1.0, "between the locking disc and a hollow", CHOSEN)
    speed: float = dim(360.0, "°/s", 1.0, 36000.0, "of the driver", CHOSEN)
    wheel_inertia: float = dim(200.0, "g·mm²", 1e-3, 1e9, "driven wheel with what it turns", CHOSEN)
    load: float = dim(0.1, "mN·m", 0.0, 1e6, "dry friction of the driven wheel in its bearing", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction, in all contacts", "steel on oiled steel")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)


# Which lengths follow from the dimensions of a Geneva drive?
#
# The pin enters a slot along the slot: crank and slot are then at right angles, which gives the centre distance
# crank / sin(180° / slots) and the wheel's radius. Millimetres, angles in degrees.


def half_pitch(values: Geneva) -> float:
    """Half of what the wheel turns at a time."""
    return 180.0 / values.slots


def centre_distance(values: Geneva) -> float:
    return values.crank / math.sin(math.radians(half_pitch(values)))


def wheel_radius(values: Geneva) -> float:
    """To the mouths of the slots: where the middle of the pin enters."""
    return values.crank / math.tan(math.radians(half_pitch(values)))


def slot_half(values: Geneva) -> float:
    """Half the width of a slot."""
    return values.pin_radius + values.pin_play


def slot_bottom(values: Geneva) -> float:
    """From the wheel's axis to the middle of the round that ends a slot."""
    return centre_distance(values) - values.crank - values.bottom_play


def disc_radius(values: Geneva) -> float:
    return values.lock_radius - values.lock_play


def hollow_half(values: Geneva) -> float:
    """Half of a locking hollow, seen from the wheel's axis. ValueError where the hollow does not reach the wheel's rim."""
    c, rim, lock = centre_distance(values), wheel_radius(values), values.lock_radius
    return math.degrees(math.acos((c * c + rim * rim - lock * lock) / (2.0 * c * rim)))


def mouth_half(values: Geneva) -> float:
    """Half of a slot's mouth, seen from the wheel's axis. ValueError where the slot is as wide as the wheel."""
    return math.degrees(math.asin(slot_half(values) / wheel_radius(values)))


LEAST_RIM = 0.02  # of the wheel's radius, that must stay between slot and hollow


def conflicts(values: Geneva) -> Iterator[Conflict]:
    half, bottom, rim = slot_half(values), slot_bottom(values), wheel_radius(values)
    if bottom * math.sin(math.radians(half_pitch(values))) <= 1.05 * half or bottom <= 1.1 * half:
        yield Conflict("pin_radius", f"the slots, {2.0 * half:.4g} mm wide, would run into each other near the wheel's axis")
        return
    deepest = centre_distance(values) - rim
    if values.lock_radius <= 1.01 * deepest or disc_radius(values) <= 0.0:
        yield Conflict("lock_radius", f"must be more than {1.01 * deepest:.4g} mm, else the disc does not reach into the wheel")
        return
    if disc_radius(values) >= values.crank - values.pin_radius:
        free = values.crank - values.pin_radius
        yield Conflict("lock_radius", f"must be less than {free:.4g} mm: the pin stands beside the disc")
        return
    left = math.radians(half_pitch(values) - hollow_half(values) - mouth_half(values)) * rim
    if left < LEAST_RIM * rim:
        what = f"leaves {left:.3g} mm of rim between a slot and a hollow; {LEAST_RIM * rim:.3g} mm are needed"
        yield Conflict("lock_radius", what)


# What are the outlines of the driver?
#
# A pin (PIN) on a plate (PLATE, touches nothing) and, in the plane of the wheel, a disc (DISC) that locks the wheel while the
# pin is outside. The disc is hollowed so that its edges pass the line of centres just when the pin enters a slot and leaves it.

PLATE = 1.3  # by which the plate reaches beyond the pin's middle, in radii of the pin
BORE = 0.15  # by the radius of the disc


def driver(values: Geneva) -> list[Loop]:
    """Pin, disc with its bore, plate; the pin on the x axis."""
    bore = circle("DISC", (0.0, 0.0), BORE * disc_radius(values), hole=True)
    plate = circle("PLATE", (0.0, 0.0), values.crank + PLATE * values.pin_radius)
    return [circle("PIN", (values.crank, 0.0), values.pin_radius), disc(values), bore, plate]


def disc(values: Geneva) -> Loop:
    """The locking disc; the hollow is round the wheel's axis as it stands when the pin is deepest."""
    edge = 90.0 - half_pitch(values)
    begin, end = polar(disc_radius(values), edge), polar(disc_radius(values), -edge)
    edges: list[Edge] = [
        arc_between(begin, end, (0.0, 0.0), True),
        arc_between(end, begin, (centre_distance(values), 0.0), False),
    ]
    return Loop(tuple(edges), "DISC")


TURNS = 2.25  # of the driver, which starts square to the line of centres: the pin then stands deepest in the third slot


def scene_text(values: Geneva) -> str:
    """The text of scene.toml: the wheel locked, the pin outside."""
    holds = "holds the wheel back against the driving side of a slot"
    return toml.scene(
        toml.head(values, "A Geneva drive, drawn to these dimensions:", f"Geneva drive, {values.slots} slots"),
        toml.body(
            *("driver", "driver", "PIN DISC", "turns counter-clockwise, evenly"),
            position=toml.at(centre_distance(values), 0),
            angle="90°",
            motion="driven",
            velocity=f"{values.speed!r} °/s",
        ),
        toml.body(
            *("wheel", "wheel", "WHEEL"),
            f"locked at the start; turns clockwise, {2.0 * half_pitch(values):.6g}° at a time",
            position=toml.ORIGIN,
            angle=f"{half_pitch(values)!r}°",
            inertia=f"{values.wheel_inertia:.15g} g·mm²",
        ),
        toml.table("[[damping]]", holds, body="wheel", coulomb=f"{values.load:.15g} mN·m") if values.load > 0.0 else None,
        toml.contacts(values, "driver.PIN wheel.WHEEL", "driver.DISC wheel.WHEEL: the lock"),
        toml.run(f"{TURNS * 360.0 / values.speed:.15g} s"),
    )


BORE_WHEEL = 0.2  # by the distance of the slots' bottoms from the axis


def wheel(values: Geneva) -> list[Loop]:
    """The slotted wheel and its bore."""
    pitch = math.radians(2.0 * half_pitch(values))
    outline = around("WHEEL", sector(values), (i * pitch for i in range(values.slots)))
    bore = BORE_WHEEL * (slot_bottom(values) - slot_half(values))
    return [outline, circle("WHEEL", (0.0, 0.0), bore, hole=True)]


def sector(values: Geneva) -> list[Edge]:
    """From the lower corner of one slot's mouth to that of the next, counter-clockwise."""
    rim, half, bottom = wheel_radius(values), slot_half(values), slot_bottom(values)
    mouth, middle, hollow = mouth_half(values), half_pitch(values), hollow_half(values)
    inner = {side: (bottom, side * half) for side in (-1.0, 1.0)}
    first, last = polar(rim, middle - hollow), polar(rim, middle + hollow)
    return [
        Line(*polar(rim, -mouth), *inner[-1.0]),
        arc_between(inner[-1.0], inner[1.0], (bottom, 0.0), False),
        Line(*inner[1.0], *polar(rim, mouth)),
        arc_between(polar(rim, mouth), first, (0.0, 0.0), True),
        arc_between(first, last, polar(centre_distance(values), middle), False),
        arc_between(last, polar(rim, 2.0 * middle - mouth), (0.0, 0.0), True),
    ]


def draw(values: Geneva) -> dict[str, Sheet]:
    """Driver and wheel."""
    return sheets_of(driver=driver(values), wheel=wheel(values))


DESIGN = Design("geneva", "Geneva drive with a locking disc", Geneva, draw, scene_text, conflicts)
