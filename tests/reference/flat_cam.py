"""How do a cam and a flat follower on a spring move, when the cam's support function is known?

The face of the follower stands at the height h(theta), so there is one coordinate: (J + m h'^2) theta'' + m h' h'' theta'^2 =
tau - k (h - rest) h'. Nothing of the package is used.
"""

import math
from dataclasses import dataclass

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
