"""What is the woodpecker toy?

A sleeve with play on a pole, and a bird that a torsion spring holds to it: pecking, sticking and slipping it comes down. Three
coordinates, the height of the sleeve and the tilts of sleeve and bird; three frictional contacts with the pole: the beak, the
sleeve's lower and its upper edge. Linearised for small tilts. Data: Ch. Glocker, Dynamik von Starrkörpersystemen mit Reibung
und Stößen, thesis, Munich 1995, and Ch. Glocker, C. Studer, Multibody System Dynamics 13 (2005) 447.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.verification.bare_contacts import BareContacts

Array = NDArray[np.float64]

BEAK, LOWER, UPPER = 0, 1, 2
PLACES = ("beak", "lower edge", "upper edge")


@dataclass(frozen=True)
class Toy:
    """Constants, SI. `restitution` by contact: the wooden beak springs back, the sleeve does not."""

    sleeve_mass: float = 3e-4
    sleeve_inertia: float = 5e-9
    bird_mass: float = 4.5e-3
    bird_inertia: float = 7e-7
    stiffness: float = 5.6e-3  # N·m/rad
    gravity: float = 9.81
    pole_radius: float = 2.5e-3
    sleeve_radius: float = 3.1e-3
    sleeve_half_height: float = 5.8e-3
    sleeve_to_spring: float = 0.010
    spring_to_bird: float = 0.015
    beak_height: float = 0.020
    beak_length: float = 0.0201
    friction: float = 0.3
    restitution: tuple[float, float, float] = (0.5, 0.0, 0.0)

    @property
    def mass(self) -> Array:
        """(3, 3) mass matrix."""
        m, a, b = self.bird_mass, self.sleeve_to_spring, self.spring_to_bird
        return np.array(
            [
                [m + self.sleeve_mass, m * a, m * b],
                [m * a, self.sleeve_inertia + m * a * a, m * a * b],
                [m * b, m * a * b, self.bird_inertia + m * b * b],
            ]
        )

    @property
    def load(self) -> Array:
        """(3,) weight."""
        m = self.bird_mass
        return -self.gravity * np.array([m + self.sleeve_mass, m * self.sleeve_to_spring, m * self.spring_to_bird])

    @property
    def directions(self) -> Array:
        """(6, 3) rows N, T of beak, lower and upper edge."""
        a, b, h = self.sleeve_to_spring, self.spring_to_bird, self.sleeve_half_height
        return np.array(
            [
                [0.0, 0.0, -self.beak_height],
                [1.0, a, b - self.beak_length],
                [0.0, h, 0.0],
                [1.0, self.sleeve_radius, 0.0],
                [0.0, -h, 0.0],
                [1.0, self.sleeve_radius, 0.0],
            ]
        )

    @property
    def gaps(self) -> Array:
        """(3,) gaps with all coordinates zero; they are linear in the coordinates."""
        play = self.sleeve_radius - self.pole_radius
        return np.array(
            [self.sleeve_to_spring + self.spring_to_bird - self.beak_length - self.pole_radius, play, play],
        )


@dataclass(frozen=True)
class Modal:
    """The toy in coordinates e with unit masses and one spring: q = basis e, gap = gaps + N e, slip = T e'."""

    basis: Array  # (3, 3) by column
    spring: Array  # (3,) stiffness of each modal coordinate, 1/s²; two are free
    load: Array
    contacts: BareContacts
    gaps: Array

    def force(self, e: Array) -> Array:
        """Weight and spring at e."""
        return np.asarray(self.load - self.spring * e, float)

    def into(self, vector: Array) -> Array:
        """Modal coordinates of (y, tilt of the sleeve, tilt of the bird)."""
        return np.asarray(np.linalg.solve(self.basis, vector), np.float64)


def modal(toy: Toy) -> Modal:
    """M and K are diagonal together: the spring feels only the difference of the tilts, so two modes are exactly free."""
    free = np.tri(3)  # its first two columns tilt both alike
    basis = free @ np.linalg.inv(np.linalg.cholesky(free.T @ toy.mass @ free).T)
    twist = basis[1, 2] - basis[2, 2]
    spring = np.array([0.0, 0.0, toy.stiffness * twist * twist])
    contacts = BareContacts(np.ones(3), toy.directions @ basis, np.full(3, toy.friction), np.array(toy.restitution))
    return Modal(basis, spring, basis.T @ toy.load, contacts, toy.gaps)


def start(toy: Toy, model: Modal) -> tuple[Array, Array]:
    """Modal coordinates and velocities of the papers' start, near the cycle: the lower edge slides down the pole."""
    tilt = -(toy.sleeve_radius - toy.pole_radius) / toy.sleeve_half_height  # printed -0.1036, a little inside the pole
    return model.into(np.array([0.0, tilt, -0.2788])), model.into(np.array([-0.3411, 0.0, -7.4583]))
