"""What makes the eccentric cam with its follower a design?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.cam.cam_dimensions import Cam
from watchsim.construction.cam.cam_proportions import leaves_at
from watchsim.construction.cam.cam_scene import scene_text
from watchsim.construction.design import Conflict, Design
from watchsim.construction.outline import circle, rounded
from watchsim.drawing.sheet import Sheet
from watchsim.geometry.loop import Loop

BORE = 0.12  # by the radius of the cam
SHAFT = 6.0  # length of the follower in radii of its end


def draw(values: Cam) -> dict[str, Sheet]:
    """The disc about its bore, its middle below the axis; the follower with its round end at the origin."""
    bore = circle("CAM", (0.0, 0.0), BORE * (values.radius - values.eccentricity), hole=True)
    cam = [circle("CAM", (0.0, -values.eccentricity), values.radius), bore]
    half, top = 0.6 * values.roller_radius, SHAFT * values.roller_radius
    shaft = rounded([(half, 0.0, 0.0), (half, top, 0.0), (-half, top, 0.0), (-half, 0.0, 0.0)])
    follower = [circle("END", (0.0, 0.0), values.roller_radius), Loop(tuple(shaft), "SHAFT")]
    return {"cam": Sheet(tuple(cam)), "follower": Sheet(tuple(follower))}


def conflicts(values: Cam) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    if values.eccentricity >= 0.8 * values.radius:
        yield Conflict("eccentricity", f"must be below {0.8 * values.radius:.4g} mm, else the axis has no room in the disc")
    elif values.speed >= leaves_at(values):
        what = f"the follower leaves the cam at the top from {leaves_at(values):.6g} °/s on: more preload, less mass or speed"
        yield Conflict("speed", what)


DESIGN = Design("cam", "Eccentric cam with its follower", Cam, draw, scene_text, conflicts)
