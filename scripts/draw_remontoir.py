"""How are the stop wheel and the stop lever of profiles/remontoir drawn?

Six pointed teeth lock by turns on two pallets. Both locking faces are arcs about the lever's pivot, so that a tooth at rest
does not turn the lever; the centres are as far apart as makes the tooth's motion point at that pivot, or away from it. The
fork at the other end holds the eccentric disc on the escape wheel.

    python scripts/draw_remontoir.py
"""

from __future__ import annotations

import math
from pathlib import Path

from watchsim.construction.outline import arc_between, circle, polar
from watchsim.drawing.sheet import Sheet
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

TEETH, TIP, CORE = 6, 1.5, 0.8  # mm; tips lock 45° to either side of the line of centres
LEAN, BACK = 20.0, 45.0  # degrees: of the front from the radius; foot of the back behind the tip
LOCK, REACH, THICK = 0.3, 25.0, 0.2  # pallet beyond its let-off, its length (degrees) and its thickness (mm)
DISC, ARM, HALF_SLOT = 0.4, 4.5, 0.402  # mm: radius of the disc, from its axis to the lever's pivot, half of the fork's slot


def polygon(layer: str, corners: list[Point]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)), layer)


def stop_wheel() -> Sheet:
    """Pointed teeth that turn counter-clockwise."""
    lean = math.radians(LEAN)
    along = TIP * math.cos(lean) - math.sqrt(CORE**2 - (TIP * math.sin(lean)) ** 2)  # length of the front, down to the core
    front = math.degrees(math.atan2(-along * math.sin(lean), TIP - along * math.cos(lean)))
    edges: list[Edge] = []
    for tip in (360.0 * i / TEETH for i in range(TEETH)):
        foot, head, heel = polar(CORE, tip - BACK), polar(TIP, tip), polar(CORE, tip + front)
        next_foot = polar(CORE, tip + 360.0 / TEETH - BACK)
        if front > 360.0 / TEETH - BACK:
            raise ValueError("the teeth overlap at their feet")
        edges += [Line(*foot, *head), Line(*head, *heel), arc_between(heel, next_foot, (0.0, 0.0), True)]
    return Sheet((Loop(tuple(edges), "TEETH"), circle("TEETH", (0.0, 0.0), 0.15, hole=True)))


def pallet(inner: float, outer: float, first: float, last: float) -> Loop:
    """A sector of a ring about the pivot, mm and degrees."""
    a, b, c, d = polar(inner, first), polar(outer, first), polar(outer, last), polar(inner, last)
    edges = (Line(*a, *b), arc_between(b, c, (0.0, 0.0), True), Line(*c, *d), arc_between(d, a, (0.0, 0.0), False))
    return Loop(edges, "PALLETS")


def stop_lever() -> Sheet:
    """Pallets to the left of the pivot, fork to the right."""
    exit_ = pallet(TIP, TIP + THICK, 135.0 + LOCK - REACH, 135.0 + LOCK)
    entry = pallet(TIP - THICK, TIP, 225.0 - LOCK, 225.0 - LOCK + REACH)
    prongs = [
        polygon(
            "FORK",
            [(ARM - 0.7, side * HALF_SLOT), (ARM + 0.7, side * HALF_SLOT), (ARM + 0.7, side * 0.62), (ARM - 0.7, side * 0.62)][
                ::side
            ],
        )
        for side in (1, -1)
    ]
    return Sheet((exit_, entry, *prongs, *arms()))


def arms() -> tuple[Loop, ...]:
    """What holds pallets and fork together; touches nothing."""
    beam = polygon(
        "ARM", [(-0.3, -0.15), (ARM - 1.0, -0.15), (ARM - 0.7, -0.62), (ARM - 0.7, 0.62), (ARM - 1.0, 0.15), (-0.3, 0.15)]
    )
    upper = polygon("UPPER", [polar(TIP - 0.1, 112.0), polar(0.15, 60.0), polar(0.15, 180.0), polar(TIP + 0.1, 120.0)])
    lower = polygon("LOWER", [polar(TIP - 0.1, 240.0), polar(0.15, 180.0), polar(0.15, 300.0), polar(TIP - 0.1, 248.0)])
    return beam, upper, lower


def draw(folder: Path) -> None:
    """Write both drawings into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, sheet in (("stop_wheel", stop_wheel()), ("stop_lever", stop_lever())):
        (folder / f"{name}.dxf").write_bytes(sheet.dxf())


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "remontoir"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
