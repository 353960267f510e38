"""Scenes for the tests of the mechanism: drawings are made here in memory, so that no reader of CAD files is involved."""

import math
from pathlib import Path

import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene import outlines as body_outlines

GOOD = """\
[scene]
title = "Small lever"

[bodies.wheel]
drawing = "wheel.dxf"
layers = ["TEETH"]
pivot = "PIVOT"
inertia = "0.05 mg·cm²"

[bodies.lever]
polygon = [["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "3 mm"]]
position = ["0 mm", "9 mm"]
angle = "10°"
inertia = "0.03 mg·cm²"

[bodies.balance]
circle = "0.2 mm"
position = ["0 mm", "20 mm"]
angle = "-270°"
velocity = "360 °/s"
inertia = "12 mg·cm²"

[bodies.banking]
circle = "0.1 mm"
position = ["4 mm", "11 mm"]
motion = "fixed"

[[springs]]
body = "balance"
frequency = "28800 vph"

[[torques]]
body = "wheel"
value = "-1.0 µN·m"

[[damping]]
body = "balance"
q_factor = 250

[[contacts]]
between = ["wheel.TEETH", "lever"]
friction = 0.12
restitution = 0.2

[[contacts]]
between = ["lever", "balance"]

[[contacts]]
between = ["lever", "banking.circle"]

[run]
duration = "180 s"
record = ["179 s", "180 s"]
tolerance = 1e-8

[timegrapher]
lift_angle = "52°"

[expect]
"amplitude" = { value = "275°", tolerance = "0.02 rad" }
"impacts" = { value = 500, tolerance = 3 }
"""


def square(side: float, centre=(0.0, 0.0), layer: str = "0", hole: bool = False) -> Loop:
    """A square outline in metres; a hole runs clockwise."""
    x, y, h = *centre, side / 2
    corners = [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)]
    edges = tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    loop = Loop(edges, layer, hole=hole)
    return loop.reversed() if hole else loop


def circle(radius: float, centre=(0.0, 0.0), layer: str = "0") -> Loop:
    return Loop((Arc(*centre, radius, 0.0, 2.0 * math.pi),), layer)


def drawing(name: str, loops=(), **more) -> Drawing:
    layers = more.pop("layers", tuple(dict.fromkeys(loop.layer for loop in loops)))
    return Drawing(path=Path(name), format="dxf", units="mm", units_from="header", loops=tuple(loops), layers=layers, **more)


def wheel_drawing() -> Drawing:
    """A square of 10 mm on TEETH about (3, 4) mm, a bore, and the pivot marked by a point."""
    loops = (square(0.01, (0.003, 0.004), "TEETH"), circle(0.001, (0.003, 0.004), "BORE"))
    notice = Finding("duplicate", "warning", "an edge was drawn twice", "", "TEETH", 3.0, 4.0)
    points = (("PIVOT", 0.003, 0.004),)
    return drawing("wheel.dxf", loops, layers=("TEETH", "BORE", "PIVOT"), points=points, findings=(notice,))


class Desk:
    """A folder with a scene file and drawings that are known without being read."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.drawings: dict[str, Drawing] = {}
        self.asked: list[tuple[str, str | None, float]] = []
        monkeypatch.setattr(body_outlines, "cached_drawing", self._read)
        self.put(wheel_drawing())

    def _read(self, path, units, snap, _section, _stamp):
        self.asked.append((path.name, units, snap))
        return self.drawings[path.name]

    def put(self, made: Drawing) -> None:
        (self.folder / made.path.name).write_text(f"drawing {made.path.name}")
        self.drawings[made.path.name] = made

    def scene(self, text: str = GOOD) -> Path:
        path = self.folder / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return path
