"""How are the parts of a scene laid out as polygons that can be turned and held against one another?

Reads the drawings with ezdxf and places them with shapely, sharing nothing with the simulation: arcs become chords whose
sagitta is below ten nanometres. Millimetres and degrees.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SAGITTA_MM = 1e-5
JOINT_MM = 1e-6
FINE = 1e-9
ELLIPSE_CHORDS = 2000
TO_MM = {"mm": 1.0, "µm": 1e-3, "m": 1e3}
TO_DEGREES = {"°": 1.0, "deg": 1.0, "rad": math.degrees(1.0)}


@dataclass(frozen=True)
class Part:
    """The layers of a body in its own frame (pivot at the origin), where it stands and how it is turned at the start."""

    layers: dict[str, BaseGeometry]
    position: tuple[float, float]
    angle: float


@dataclass(frozen=True)
class Layout:
    """All bodies of a scene, and its declared contacts as ((body, layer), (body, layer))."""

    parts: dict[str, Part]
    contacts: list[tuple[tuple[str, str], tuple[str, str]]]

    def shape(self, body: str, layers: list[str]) -> BaseGeometry:
        """Some layers of a body, in its own frame."""
        return shapely.union_all([self.parts[body].layers[name] for name in layers])

    def pairs(self, body: str, other: str) -> list[tuple[str, str]]:
        """The declared (layer of `body`, layer of `other`), in the order of the scene."""
        both = [pair for first in self.contacts for pair in (first, first[::-1])]
        return [(mine[1], yours[1]) for mine, yours in both if (mine[0], yours[0]) == (body, other)]

    def layers_between(self, body: str, other: str) -> list[str]:
        """The layers of `body` that may touch `other`."""
        return list(dict.fromkeys(mine for mine, _ in self.pairs(body, other)))


def placed(shape: BaseGeometry, degrees: float, position: tuple[float, float]) -> BaseGeometry:
    """The shape turned about its origin, then put at `position`."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn, shift = np.array(((c, s), (-s, c))), np.array(position)
    return shapely.transform(shape, lambda points: points @ turn + shift)


def first(condition: Callable[[float], bool], start: float, end: float, step: float) -> float | None:
    """The first place from `start` on, to FINE degrees, where the condition holds; None if it does not up to `end`."""
    low = high = start
    while not condition(high):
        if high >= end:
            return None
        low, high = high, min(high + step, end)
    while high - low > FINE:
        middle = (low + high) / 2.0
        low, high = (low, middle) if condition(middle) else (middle, high)
    return high


def read_layout(scene: Path) -> Layout:
    """Read a scene file and its drawings."""
    data = tomllib.loads(scene.read_text(encoding="utf-8"))
    parts = {name: _part(scene.parent, body) for name, body in data["bodies"].items()}
    contacts = []
    for contact in data["contacts"]:
        first, second = (side.split(".", 1) for side in contact["between"])
        contacts.append(((first[0], first[1]), (second[0], second[1])))
    return Layout(parts, contacts)


def _part(folder: Path, body: dict[str, Any]) -> Part:
    sheet = ezdxf.readfile(folder / body["drawing"])
    x, y = _pivot(sheet, body["pivot"])
    layers = {name: placed(_layer(sheet, name), 0.0, (-x, -y)) for name in body["layers"]}
    position = tuple(_number(value, TO_MM) for value in body["position"])
    return Part(layers, (position[0], position[1]), _number(body.get("angle", "0°"), TO_DEGREES))


def _pivot(sheet: Any, pivot: str | list[str]) -> tuple[float, float]:
    if isinstance(pivot, str):
        (point,) = sheet.modelspace().query(f'POINT[layer=="{pivot}"]')
        return (point.dxf.location.x, point.dxf.location.y)
    return (_number(pivot[0], TO_MM), _number(pivot[1], TO_MM))


def _number(text: str, units: dict[str, float]) -> float:
    value, unit = re.fullmatch(r"\s*([-+0-9.eE]+)\s*(\S+)\s*", text).groups()  # type: ignore[union-attr]
    return float(value) * units[unit]


def _layer(sheet: Any, name: str) -> BaseGeometry:
    """The closed outlines of a layer; an outline inside another one is a hole."""
    rings = _rings([_points(entity) for entity in sheet.modelspace() if entity.dxf.layer == name])
    shape: BaseGeometry = Polygon()
    for ring in sorted((Polygon(ring) for ring in rings), key=lambda polygon: -polygon.area):
        shape = shape.symmetric_difference(ring)
    return shape


def _points(entity: Any) -> np.ndarray[Any, Any]:
    """The vertices of one entity, (n, 2)."""
    if entity.dxftype() == "LWPOLYLINE":
        corners = [(x, y) for x, y, *_ in entity.get_points()]
        return np.array([*corners, corners[0]] if entity.closed else corners)
    if entity.dxftype() == "LINE":
        return np.array([(p.x, p.y) for p in (entity.dxf.start, entity.dxf.end)])
    if entity.dxftype() == "ELLIPSE":  # a full one that does not start at 0 comes out of `flattening` empty
        span = np.linspace(0.0, entity.construction_tool().param_span, ELLIPSE_CHORDS + 1)
        return np.array([(p.x, p.y) for p in entity.vertices(entity.dxf.start_param + span)])
    return np.array([(p.x, p.y) for p in entity.flattening(SAGITTA_MM)])


def _rings(strokes: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """Join strokes end to end into closed rings."""
    rings, waiting = [], list(strokes)
    while waiting:
        ring = waiting.pop()
        while math.dist(ring[0], ring[-1]) > JOINT_MM:
            i, stroke = _next(ring[-1], waiting)
            waiting.pop(i)
            ring = np.vstack([ring, stroke[1:]])
        rings.append(ring[:-1])
    return rings


def _next(end: np.ndarray[Any, Any], waiting: list[np.ndarray[Any, Any]]) -> tuple[int, np.ndarray[Any, Any]]:
    for i, stroke in enumerate(waiting):
        for candidate in (stroke, stroke[::-1]):
            if math.dist(candidate[0], end) <= JOINT_MM:
                return i, candidate
    raise ValueError(f"the outline is open at ({end[0]:.6f}, {end[1]:.6f}) mm")
