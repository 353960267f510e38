"""How does a flat hairspring bend as its inner end turns, and where is its centre of gravity then?

A thin strip that cannot be stretched, clamped to the collet and at the stud (Euler's elastica with a curvature of its own).
With torque T on the collet about its axis O, and force F on it, the bending moment at r is

    E I (κ - κ₀) = T - r × F        (r from O)

so that three numbers for each angle, T, F_x and F_y, bring the outer end to the stud with its direction. Without F the moment
is the same everywhere, and what lies before a place r turns about it: the axis would move by ∫ (dθ/L) ẑ × (O - r) ds, that is
dθ ẑ × (O - G), so that it stays only where the centre of gravity G of the strip lies on it (E. Phillips, Annales des mines
20, 1861). Nothing here is expanded in small angles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from watchsim.geometry.hairspring import Coil

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Summed = TypeVar("Summed", Array, Complex)

NODES = 8  # of Gauss's rule in each piece
PIECES_PER_TURN = 6
FURTHEST = 1.25 * math.tau  # rad that a collet turns at most; with few turns, that share of them:
SHARE_OF_TURNS = 0.4
LEAST = 1.0
ANGLES = 64  # at which the strip is bent; between them polynomials of one degree less
ROUNDS, SETTLED = 200, 1e-13  # of the iteration; the share of the radius by which the outer end may miss the stud


class Centreline(NamedTuple):
    """A strip without force, from collet to stud, in the frame of the stud with the axis as origin."""

    weight: Array  # m: of each node in integrals over the length
    curvature: Array  # 1/m at each node
    start: complex  # m
    direction: float  # rad, of the strip there


class Bent(NamedTuple):
    """Of a strip with E I = 1 N·m² whose collet is turned by `angle` (rad); x + i y for what has a direction."""

    angle: Array
    torque: Array  # on the collet about the axis, over E I: 1/m
    force: Complex  # on the collet, over E I: 1/m²
    centre: Complex  # m: of gravity
    energy: Array  # over E I: 1/m


def _rule() -> tuple[Array, Array, Array]:
    """Gauss's nodes and weights on [0, 1], and the matrix that integrates values there from 0 to each node."""
    x, w = np.polynomial.legendre.leggauss(NODES)
    powers = np.vander(x, increasing=True)
    integrals = np.column_stack([(x ** (k + 1) - (-1.0) ** (k + 1)) / (k + 1) for k in range(NODES)])
    return 0.5 * (x + 1.0), 0.5 * w, 0.5 * integrals @ np.linalg.inv(powers)


NODE, WEIGHT, UPTO = _rule()


def spiral_line(coil: Coil) -> Centreline:
    """r = inner + (outer - inner) φ / (2π turns), which ends in the direction `stud`."""
    swept = math.tau * coil.turns
    pieces = math.ceil(PIECES_PER_TURN * coil.turns)
    slope = (coil.outer - coil.inner) / swept
    phi = swept * ((np.arange(pieces)[:, None] + NODE) / pieces).ravel()
    r = coil.inner + slope * phi
    length = np.hypot(r, slope)
    first = coil.stud - swept
    return Centreline(
        weight=np.tile(WEIGHT, pieces) * (swept / pieces) * length,
        curvature=(r * r + 2.0 * slope * slope) / length**3,
        start=coil.inner * complex(math.cos(first), math.sin(first)),
        direction=first + math.atan2(coil.inner, slope),
    )


def _along(line: Centreline, values: Summed) -> tuple[Summed, Summed]:
    """∫ values ds from the collet to each node, and to the stud; values (…, nodes)."""
    density = (values * line.weight).reshape(*values.shape[:-1], -1, NODES)
    pieces = density.sum(axis=-1)
    before = np.cumsum(pieces, axis=-1) - pieces
    within = (density / WEIGHT) @ UPTO.T
    return (before[..., None] + within).reshape(values.shape), pieces.sum(axis=-1)


def _shape(line: Centreline, more: Array, angle: Array) -> tuple[Complex, Complex, Array]:
    """(places of the nodes, of the end, direction at the end) with `more` curvature (angles, nodes), the collet turned."""
    direction, last = _along(line, line.curvature + more)
    first = line.direction + angle
    way, end = _along(line, np.exp(1j * (first[:, None] + direction)))
    start = line.start * np.exp(1j * angle)
    return start[:, None] + way, start + end, first + last


def bend(line: Centreline, angle: Array) -> Bent:
    """The strip in balance at each of these angles (rad) of the collet; ValueError where none is found."""
    none = np.zeros(1)
    nodes, end, last = _shape(line, np.zeros((1, len(line.weight))), none)
    stud, whole = end[0], float(line.weight.sum())
    places = np.repeat(nodes, len(angle), axis=0)
    sought = np.zeros((len(angle), 3))  # T, F_x, F_y over E I
    sought[:, 0] = -angle / whole
    for _ in range(ROUNDS):
        more = sought[:, :1] - places.real * sought[:, 2:] + places.imag * sought[:, 1:2]
        places, end, direction = _shape(line, more, angle)
        wrong = np.column_stack((direction - last[0], (end - stud).real, (end - stud).imag))
        if np.max(np.abs(wrong[:, 1:])) <= SETTLED * abs(stud) and np.max(np.abs(wrong[:, 0])) <= SETTLED:
            break
        # What more curvature at a place does to the end, which turns about it.
        arm = 1j * (end[:, None] - places)
        acts = np.stack((np.ones_like(places.real), places.imag, -places.real), axis=1)
        matrix = np.empty((len(angle), 3, 3))
        matrix[:, 0] = acts @ line.weight
        turned = (acts * arm[:, None, :]) @ line.weight
        matrix[:, 1], matrix[:, 2] = turned.real, turned.imag
        scale = np.array([1.0, abs(stud), abs(stud)])
        sought -= np.linalg.solve(matrix / scale[:, None], (wrong / scale)[..., None])[..., 0]
    else:
        raise ValueError("no balance of the strip is found")
    more = sought[:, :1] - places.real * sought[:, 2:] + places.imag * sought[:, 1:2]
    centre = (places @ line.weight) / whole
    return Bent(angle, sought[:, 0], sought[:, 1] + 1j * sought[:, 2], centre, 0.5 * (more * more) @ line.weight)


@dataclass(frozen=True)
class Bending:
    """Chebyshev series over the collet's angle from `-furthest` to `furthest` (rad), for a stiffness of 1 N·m/rad about rest.

    torque  on the balance, beyond that of a linear spring, N·m
    force   on the balance (2, terms), N, in the frame of the stud
    centre  of gravity (2, terms), m
    length  of the strip, m
    """

    furthest: float
    torque: Array
    force: Array
    centre: Array
    length: float


@lru_cache(maxsize=64)
def bending(coil: Coil) -> Bending:
    """Of a spiral without terminal curves; ValueError where it cannot even be turned by `LEAST`."""
    line, furthest = spiral_line(coil), min(FURTHEST, SHARE_OF_TURNS * math.tau * coil.turns)
    while True:
        try:
            return series(line, furthest)
        except (ValueError, np.linalg.LinAlgError):
            furthest *= 0.75
            if furthest < LEAST:
                raise ValueError("no balanced shape was found for a strip of so few turns") from None


def series(line: Centreline, furthest: float) -> Bending:
    """Of any strip."""
    share = chebyshev.chebpts1(ANGLES)

    def fit(values: Array) -> Array:
        return np.asarray(chebyshev.chebfit(share, values, ANGLES - 1))

    found = bend(line, furthest * share)
    torque = fit(found.torque)
    stiffness = -float(chebyshev.chebval(0.0, chebyshev.chebder(torque))) / furthest
    torque = torque / stiffness
    torque[1] += furthest
    torque[0] -= chebyshev.chebval(0.0, torque)  # without force at rest
    both = [np.stack((fit(part.real), fit(part.imag))) for part in (found.force / stiffness, found.centre)]
    return Bending(furthest, torque, both[0], both[1], float(line.weight.sum()))
