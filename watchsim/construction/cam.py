"""Eccentric cam with its follower: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import circle, polygon
from watchsim.drawing.write import Sheet


@dataclass(frozen=True)
class Cam:
    radius: float = dim(5.0, "mm", 0.2, 200.0, "of the cam, a disc", CHOSEN)
    eccentricity: float = dim(1.5, "mm", 0.0, 150.0, "of the disc's middle from the axis: half of the lift", CHOSEN)
    roller_radius: float = dim(1.0, "mm", 0.05, 50.0, "of the round end of the follower", CHOSEN)
    mass: float = dim(2.0, "g", 1e-3, 1e4, "of the follower", CHOSEN)
    preload: float = dim(0.2, "N", 1e-4, 1e4, "of the spring when the follower is lowest", CHOSEN)
    rate: float = dim(0.1, "N/mm", 1e-4, 1e4, "by which that force grows as the follower is lifted", CHOSEN)
    speed: float = dim(1200.0, "°/s", 0.1, 1e6, "of the cam", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of cam and follower", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)


# How does the follower of an eccentric cam rise, and when does it leave the cam?
#
# The middle of the round end keeps the distance radius + roller_radius from the disc's middle, which goes round the axis:
#
#     y = e sin φ + √((R + r)² − e² cos² φ)
#
# At the top the spring must press at least with m e ω² (1 + e/(R + r)), or the follower flies on.


def lowest(values: Cam) -> float:
    """mm from the cam's axis to the middle of the follower's end."""
    return values.radius + values.roller_radius - values.eccentricity


def leaves_at(values: Cam) -> float:
    """°/s: the least speed at which the follower leaves the cam at the top."""
    e, reach = 1e-3 * values.eccentricity, values.radius + values.roller_radius
    if e == 0.0:
        return math.inf
    press = values.preload + values.rate * 2.0 * values.eccentricity
    return math.degrees(math.sqrt(press / (1e-3 * values.mass * e * (1.0 + values.eccentricity / reach))))


TURNS = 3.0


def scene_text(values: Cam) -> str:
    """The text of scene.toml: the follower on the lowest point of the cam."""
    leaves = f"Without friction the follower leaves the cam from {leaves_at(values):.6g} °/s on."
    below = "turns counter-clockwise, evenly; its middle is below the axis at the start"
    return toml.scene(
        toml.head(
            values, "An eccentric cam with its follower, drawn to these dimensions:", "Eccentric cam with its follower", leaves
        ),
        toml.body("cam", "cam", "CAM", below, pivot=toml.ORIGIN, motion="driven", velocity=f"{values.speed!r} °/s"),
        toml.body(
            *("follower", "follower", "END"),
            pivot=toml.ORIGIN,
            position=("0 mm", f"{lowest(values)!r} mm"),
            motion="slide",
            axis=(0.0, 1.0),
            mass=f"{values.mass:.15g} g",
        ),
        toml.table(
            *("[[springs]]", "presses from the start: its rest lies inside the cam"),
            body="follower",
            stiffness=f"{values.rate:.15g} N/mm",
            rest=f"{-values.preload / values.rate!r} mm",
        ),
        toml.contacts(values, "follower.END cam.CAM"),
        toml.run(f"{round(TURNS * 360.0 / values.speed, 9):.15g} s"),
    )


BORE = 0.12  # by the radius of the cam
SHAFT = 6.0  # length of the follower in radii of its end


def draw(values: Cam) -> dict[str, Sheet]:
    """The disc about its bore, its middle below the axis; the follower with its round end at the origin."""
    bore = circle("CAM", (0.0, 0.0), BORE * (values.radius - values.eccentricity), hole=True)
    cam = [circle("CAM", (0.0, -values.eccentricity), values.radius), bore]
    half, top = 0.6 * values.roller_radius, SHAFT * values.roller_radius
    shaft = polygon("SHAFT", [(half, 0.0), (half, top), (-half, top), (-half, 0.0)])
    follower = [circle("END", (0.0, 0.0), values.roller_radius), shaft]
    return sheets_of(cam=cam, follower=follower)


def conflicts(values: Cam) -> Iterator[Conflict]:
    if values.eccentricity >= 0.8 * values.radius:
        yield Conflict("eccentricity", f"must be below {0.8 * values.radius:.4g} mm, else the axis has no room in the disc")
    elif values.speed >= leaves_at(values):
        what = f"the follower leaves the cam at the top from {leaves_at(values):.6g} °/s on: more preload, less mass or speed"
        yield Conflict("speed", what)


DESIGN = Design("cam", "Eccentric cam with its follower", Cam, draw, scene_text, conflicts)
