"""Anchors, stars and ratchets as strangers draw them: either hand, other teeth, other units, layers in other languages."""

import math
from dataclasses import dataclass
from pathlib import Path

import ezdxf

Point = tuple[float, float]
GERMAN = ("Steigrad Zähne", "Welle Steigrad", "Hemmstück Klauen", "Bohrung Hemmstück", "Hemmstück Arme")
UNITS = {1.0: ezdxf.units.MM, 1.0 / 25.4: ezdxf.units.IN, 1e-3: ezdxf.units.M, 0.1: ezdxf.units.CM}


def polar(r: float, degrees: float, at: Point = (0.0, 0.0)) -> Point:
    return at[0] + r * math.cos(math.radians(degrees)), at[1] + r * math.sin(math.radians(degrees))


@dataclass(frozen=True)
class Anchor:
    """A dead-beat escapement by its rules: `teeth` within a radius (mm), pallets over `span` pitches; angles in degrees.

    layers  of teeth, the wheel's pivot, pallets, the anchor's pivot, its arms
    """

    teeth: int = 24
    span: float = 6.5
    radius: float = 10.0
    mirrored: bool = False
    layers: tuple[str, str, str, str, str] = GERMAN
    lift: float = 2.0
    lock: float = 0.5
    drop: float = 1.2
    turned: float = 3.0
    unit: float = 1.0  # drawing units in a millimetre
    at: Point = (0.0, 0.0)

    def draw(self, path: Path) -> Path:
        pitch, half, r = 360.0 / self.teeth, 180.0 * self.span / self.teeth, self.radius
        centre, reach = (0.0, r / math.cos(math.radians(half))), r * math.tan(math.radians(half))
        thick = 0.5 * math.radians(0.5 * pitch - self.drop) * r
        document = ezdxf.new("R2010", units=UNITS[self.unit])
        teeth = [
            (*polar(rho * r, self.turned + (k + a) * pitch), math.tan(math.radians(turn * pitch) / 4.0))
            for k in range(self.teeth)
            for rho, a, turn in ((0.78, 0.2, 0.0), (1.0, 0.0, 0.04), (1.0, 0.04, 0.0), (0.78, 1.0, 0.2))
        ]
        self._outline(document, self.layers[0], teeth)
        for exit_ in (False, True):
            self._outline(document, self.layers[2], self._pallet(centre, reach, thick, half, exit_))
        angles = (270.0, 180.0 + half - 16.0, 90.0, -half + 16.0)
        arms = [polar(rho, angle, centre) for rho, angle in zip((0.16 * r, reach) * 2, angles, strict=True)]
        self._outline(document, self.layers[4], [(*place, 0.0) for place in arms])
        for layer, at, size in ((self.layers[1], (0.0, 0.0), 0.08 * r), (self.layers[3], centre, 0.06 * r)):
            document.modelspace().add_circle(self._placed(at), self.unit * size, dxfattribs={"layer": layer})
        document.saveas(path)
        return path

    def _pallet(self, centre: Point, reach: float, thick: float, half: float, exit_: bool) -> list[tuple[float, float, float]]:
        middle = 180.0 + half
        lock, let_go, back = middle - 0.5 * self.lift + self.lock, middle + 0.5 * self.lift, middle - 16.0
        locking, other = (reach - thick, reach + thick) if exit_ else (reach + thick, reach - thick)
        sweep = (lock - back, let_go - back)
        corners = [(locking, back, sweep[0]), (locking, lock, 0.0), (other, let_go, -sweep[1]), (other, back, 0.0)]
        side = -1.0 if exit_ else 1.0
        points = [(polar(r, a if side > 0.0 else 540.0 - a, centre), turn) for r, a, turn in corners]
        return [(*place, side * math.tan(math.radians(turn) / 4.0)) for place, turn in points]

    def _outline(self, document: ezdxf.document.Drawing, layer: str, points: list[tuple[float, float, float]]) -> None:
        side = -1.0 if self.mirrored else 1.0
        placed = [(*self._placed((x, y)), side * bulge) for x, y, bulge in points]
        document.modelspace().add_lwpolyline(placed, format="xyb", close=True, dxfattribs={"layer": layer})

    def _placed(self, at: Point) -> Point:
        x, y = (-at[0] if self.mirrored else at[0]), at[1]
        return self.unit * (x + self.at[0]), self.unit * (y + self.at[1])


def star_and_jumper(
    path: Path, points: int = 8, mirrored: bool = False, names: tuple[str, str] = ("star", "jumper"), pivot: str = "{}-pivot"
) -> Path:
    """An SVG of a star of symmetric points and a jumper in one of its gaps, as a newcomer drew it."""
    side = -1.0 if mirrored else 1.0
    star = [polar(r, 360.0 * (k + half) / points + 22.5) for k in range(points) for r, half in ((5.0, 0.0), (3.5, 0.5))]
    jumper = [(5.6, -7.0), (0.9, -4.1), (-0.1, -4.0), (0.0, -5.1), (5.4, -8.2)]
    shapes = [(names[0], star, (0.0, 0.0), 0.5), (names[1], jumper, (5.0, -7.5), 0.2)]
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" width="30mm" height="30mm" viewBox="0 0 30 30">']
    for name, outline, (px, py), radius in shapes:
        way = " L ".join(f"{15.0 + side * x:.5f} {15.0 + y:.5f}" for x, y in outline)
        lines.append(f'<g id="{name}"><path d="M {way} Z"/></g>')
        lines.append(f'<circle id="{pivot.format(name)}" cx="{15.0 + side * px}" cy="{15.0 + py}" r="{radius}"/>')
    path.write_text("\n".join([*lines, "</svg>"]), encoding="utf-8")
    return path
