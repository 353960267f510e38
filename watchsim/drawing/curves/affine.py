"""Where does a block or a tilted entity put its points?

Affine maps of space. The drawing's plane is the world's xy plane; entities may be drawn in a plane of their own (object
coordinates) and blocks may be turned, mirrored and scaled unequally.
"""

from __future__ import annotations

import math
from typing import NamedTuple

Vector = tuple[float, float, float]
NEARLY_Z = 1.0 / 64.0  # the format's own limit between its two rules for the x axis


class Affine(NamedTuple):
    """Maps (x, y, z) to x·`ax` + y·`ay` + z·`az` + `origin`."""

    ax: Vector = (1.0, 0.0, 0.0)
    ay: Vector = (0.0, 1.0, 0.0)
    az: Vector = (0.0, 0.0, 1.0)
    origin: Vector = (0.0, 0.0, 0.0)

    def direction(self, v: Vector) -> Vector:
        """The image of a difference of points."""
        (x, y, z), a, b, c = v, self.ax, self.ay, self.az
        return (
            x * a[0] + y * b[0] + z * c[0],
            x * a[1] + y * b[1] + z * c[1],
            x * a[2] + y * b[2] + z * c[2],
        )

    def point(self, p: Vector) -> Vector:
        x, y, z = self.direction(p)
        return (x + self.origin[0], y + self.origin[1], z + self.origin[2])

    def after(self, inner: Affine) -> Affine:
        """The map that applies `inner` first, then this one."""
        ax, ay, az = (self.direction(axis) for axis in (inner.ax, inner.ay, inner.az))
        return Affine(ax, ay, az, self.point(inner.origin))


IDENTITY = Affine()


def object_plane(normal: Vector) -> Affine:
    """Object to world coordinates for an extrusion vector, by the arbitrary-axis rule of the DXF reference."""
    if normal == (0.0, 0.0, 1.0):
        return IDENTITY
    az = unit(normal)
    near_z = abs(az[0]) < NEARLY_Z and abs(az[1]) < NEARLY_Z
    ax = unit(cross((0.0, 1.0, 0.0) if near_z else (0.0, 0.0, 1.0), az))
    return Affine(ax, cross(az, ax), az)


def shifted(offset: Vector) -> Affine:
    return Affine(origin=offset)


def turned_scaled(angle: float, scale: Vector) -> Affine:
    """Scales along the axes first, then turns by `angle` (radians) about z."""
    c, s = cosine_sine(angle)
    sx, sy, sz = scale
    return Affine((c * sx, s * sx, 0.0), (-s * sy, c * sy, 0.0), (0.0, 0.0, sz))


def cosine_sine(angle: float) -> tuple[float, float]:
    """Cosine and sine, exact for whole quarter turns (a block turned by 90° keeps its lines straight up)."""
    quarters = angle / (0.5 * math.pi)
    whole = round(quarters)
    if abs(quarters - whole) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[whole % 4]
    return math.cos(angle), math.sin(angle)


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v: Vector) -> Vector:
    """The unit vector; (0, 0, 1) for a vector of length zero, as CAD programs read it."""
    length = math.hypot(*v)
    return (v[0] / length, v[1] / length, v[2] / length) if length > 0.0 else (0.0, 0.0, 1.0)
