"""How do a cam and a flat follower on a spring move, when the cam's support function is known?

The face of the follower stands at the height h(theta), so there is one coordinate: (J + m h'^2) theta'' + m h' h'' theta'^2 =
tau - k (h - rest) h'. Nothing of the package is used.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Oval:
    """h(phi) = sqrt(a² cos² + b² sin²): an ellipse with half axes a, b (metres)."""

    a: float = 2e-3
    b: float = 1.6e-3

    def support(self, phi: float) -> tuple[float, float, float]:
        """h and its first two derivatives."""
        c, s = math.cos(phi), math.sin(phi)
        h, mixed = math.sqrt((self.a * c) ** 2 + (self.b * s) ** 2), (self.b**2 - self.a**2)
        first = mixed * s * c / h
        return h, first, mixed * (c * c - s * s) / h - first**2 / h


@dataclass(frozen=True)
class Harmonic:
    """h(phi) = r + e cos(phi) + f cos(2 phi) (metres)."""

    r: float = 1.8e-3
    e: float = 0.3e-3
    f: float = 0.1e-3

    def support(self, phi: float) -> tuple[float, float, float]:
        c, s, c2, s2 = math.cos(phi), math.sin(phi), math.cos(2.0 * phi), math.sin(2.0 * phi)
        return (self.r + self.e * c + self.f * c2, -self.e * s - 2.0 * self.f * s2, -self.e * c - 4.0 * self.f * c2)


Curve = Oval | Harmonic


@dataclass(frozen=True)
class FlatCam:
    """SI units. The face looks down on the cam; `rest` is the height of the face where the spring has no force."""

    curve: Curve
    inertia: float = 2e-8
    mass: float = 1e-4
    stiffness: float = 20.0
    rest: float = -1e-3
    torque: float = 2e-5
    speed: float = 25.0
    angle: float = 0.4

    def height(self, angle: float) -> tuple[float, float, float]:
        """Of the face, with derivatives by the cam's angle: the normal +y is at pi/2 - angle of the cam."""
        h, first, second = self.curve.support(0.5 * math.pi - angle)
        return h, -first, second


def point(curve: Curve, phi: float) -> tuple[float, float]:
    """The point of the outline whose outward normal is at `phi`."""
    h, first, _ = curve.support(phi)
    c, s = math.cos(phi), math.sin(phi)
    return h * c - first * s, h * s + first * c


def end_state(cam: FlatCam, duration: float) -> NDArray[np.float64]:
    """Angle and speed of the cam at the end; ValueError where the follower would leave it."""

    def rates(_: float, y: NDArray[np.float64]) -> list[float]:
        h, first, second = cam.height(y[0])
        pull = cam.stiffness * (h - cam.rest)
        turn = (cam.torque - pull * first - cam.mass * first * second * y[1] ** 2) / (cam.inertia + cam.mass * first**2)
        if cam.mass * (second * y[1] ** 2 + first * turn) + pull < 0.0:
            raise ValueError("the follower leaves the cam")
        return [y[1], turn]

    made = solve_ivp(rates, (0.0, duration), [cam.angle, cam.speed], method="DOP853", rtol=1e-12, atol=1e-14)
    return np.asarray(made.y[:, -1])


# How does a roller on a slide follow a cam made of tangent arcs, and with what force?
#
# The cam turns about the origin with inertia J under a constant torque; the roller's centre is at (0, y), pressed on the cam by
# a spring. While it stays in contact there is one coordinate, the cam's angle; scipy integrates it from joint to joint. Shares
# nothing with the package. SI units.


class Piece(NamedTuple):
    """An arc of the cam, in its own frame: centre, radius, and the angles at which the roller's line of centres leaves it."""

    x: float
    y: float
    radius: float
    first: float  # directions of the outward normals it has, rad
    last: float


class Drive(NamedTuple):
    """Everything but the outline."""

    inertia: float
    torque: float
    roller: float  # radius
    mass: float  # of the slide
    stiffness: float
    rest: float  # of the roller's centre


class Motion(NamedTuple):
    """Cam angle and rate; height, speed and acceleration of the roller; force; the normal's angle in the cam's frame."""

    angle: float
    rate: float
    height: float
    speed: float
    acceleration: float
    force: float
    normal: float


def oval(near: float, flank: float, offset: float) -> tuple[Piece, ...]:
    """Four tangent arcs: two of radius `near` with centres `offset` from the middle, two of radius `flank` between them."""
    depth = math.sqrt((flank - near) ** 2 - offset**2)
    turn = math.atan2(depth, offset)
    return (
        Piece(offset, 0.0, near, -turn, turn),
        Piece(0.0, -depth, flank, turn, math.pi - turn),
        Piece(-offset, 0.0, near, math.pi - turn, math.pi + turn),
        Piece(0.0, depth, flank, math.pi + turn, 2.0 * math.pi - turn),
    )


def follow(pieces: tuple[Piece, ...], drive: Drive, angle: float, rate: float, times: np.ndarray) -> list[Motion]:
    """The motion at ascending `times` from angle and rate at time 0, and the force there."""
    at, now = np.array([angle, rate]), 0.0
    here = _piece_under(pieces, drive, angle)
    out: list[Motion] = []
    while len(out) < len(times):
        piece = pieces[here]

        def leaves(_: float, y: np.ndarray, piece: Piece = piece) -> float:
            return _beyond(piece, drive, y[0])

        leaves.terminal, leaves.direction = True, 1.0  # type: ignore[attr-defined]
        done = solve_ivp(
            lambda _, y, piece=piece: (y[1], _state(piece, drive, y[0], y[1])[2]),
            (now, float(times[-1])),
            at,
            method="DOP853",
            rtol=1e-13,
            atol=1e-13,
            events=leaves,
            dense_output=True,
        )
        while len(out) < len(times) and times[len(out)] <= done.t[-1]:
            q, u = done.sol(times[len(out)])
            height, slope, _, lift, force, normal = _state(piece, drive, q, u)
            out.append(Motion(float(q), float(u), height, slope * u, lift, force, normal))
        at, now = done.y[:, -1], float(done.t[-1])
        # The cam turns forward, so the normal in its frame runs backward.
        here = (here - 1) % len(pieces)
    return out


def start(pieces: tuple[Piece, ...], drive: Drive, angle: float, rate: float) -> tuple[float, float]:
    """Height and speed of the roller that stands on the cam."""
    height, slope, *_ = _state(pieces[_piece_under(pieces, drive, angle)], drive, angle, rate)
    return height, slope * rate


def _piece_under(pieces: tuple[Piece, ...], drive: Drive, angle: float) -> int:
    return next(i for i, piece in enumerate(pieces) if _within(piece, _centre_and_normal(piece, drive, angle)[2]))


def _within(piece: Piece, normal: float) -> bool:
    return (normal - piece.first) % (2.0 * math.pi) <= piece.last - piece.first


def _beyond(piece: Piece, drive: Drive, angle: float) -> float:
    """Angle by which the normal has passed the piece's first end; the whole turn is one piece without ends."""
    if piece.last - piece.first >= 2.0 * math.pi:
        return -1.0
    normal = _centre_and_normal(piece, drive, angle)[2]
    return -math.remainder(normal - piece.first, 2.0 * math.pi)


def _centre_and_normal(piece: Piece, drive: Drive, angle: float) -> tuple[float, float, float]:
    """Centre of the arc in the world, and the normal's direction in the cam's frame."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = c * piece.x - s * piece.y, s * piece.x + c * piece.y
    reach = piece.radius + drive.roller
    return x, y, math.acos(-x / reach) - angle


def _state(piece: Piece, drive: Drive, angle: float, rate: float) -> tuple[float, float, float, float, float, float]:
    """(height, its slope over the angle, cam's acceleration, roller's acceleration, force, normal's angle)."""
    x, y, normal = _centre_and_normal(piece, drive, angle)
    reach = piece.radius + drive.roller
    root = math.sqrt(reach * reach - x * x)
    height = y + root
    # x' = -y, y' = x (by angle).
    slope = x + x * y / root
    bend = -y + (x * x - y * y) / root - (x * y) ** 2 / root**3
    press = drive.stiffness * (height - drive.rest)
    acceleration = drive.torque - slope * (press + drive.mass * bend * rate * rate)
    acceleration /= drive.inertia + drive.mass * slope * slope
    lift = slope * acceleration + bend * rate * rate
    force = (drive.mass * lift + press) / (root / reach)
    return height, slope, acceleration, lift, force, normal
