"""Which two arcs join two points with given tangents?

A biarc: two arcs that share a tangent where they meet (K. M. Bolton, Biarc curves, Computer-Aided Design 7, 1975). Many at
a time, as arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.fitting.curve import Array
from watchsim.geometry.primitives import Arc, Edge, Line, Point

STRAIGHT = 1e6  # an arc of a radius above this many chords is a line: its rise is below 1.3e-7 of the chord


class ArcChain(NamedTuple):
    """Arcs in travel order: starts, ends (n, 2) in metres; unit tangents there (n, 2); signed curvatures (n,) in 1/m.

    A curvature of 0 marks a line, whose tangents are those of its chord; not finite marks what is no sensible arc.
    """

    starts: Array
    start_tangents: Array
    ends: Array
    end_tangents: Array
    curvatures: Array

    def edges(self) -> list[Edge]:
        """The same as lines and arcs."""
        (px, py), (qx, qy), (tx, ty) = self.starts.T, self.ends.T, self.start_tangents.T
        chord = self.ends - self.starts
        along, across = dots(chord, self.start_tangents), crosses(self.start_tangents, chord)
        flat = _is_flat(chord, across)
        with np.errstate(invalid="ignore", divide="ignore"):
            r = dots(chord, chord) / (2.0 * across)  # positive: the centre lies to the left
            x, y = px - r * ty, py + r * tx
            arcs = np.stack((x, y, np.abs(r), np.arctan2(py - y, px - x), 2.0 * np.arctan2(across, along)))
        rows = np.where(flat, np.stack((px, py, qx, qy, px)), arcs).T.tolist()
        return [Line(*row[:4]) if line else Arc(*row) for row, line in zip(rows, flat.tolist(), strict=True)]


def arcs_from(starts: Array, tangents: Array, ends: Array) -> ArcChain:
    """The arcs that leave the starts (n, 2) along the unit tangents and reach the ends; each below a half circle."""
    chord = ends - starts
    along, across = dots(chord, tangents), crosses(tangents, chord)
    square = dots(chord, chord)
    with np.errstate(invalid="ignore", divide="ignore"):
        curvature = np.where(along > 0.0, 2.0 * across / square, np.nan)
        # The end tangent is the start tangent mirrored in the chord.
        last = 2.0 * (along / square)[:, None] * chord - tangents
        flat = _is_flat(chord, across)
        straight = chord / np.sqrt(square)[:, None]
    first = np.where(flat[:, None], straight, tangents)
    return ArcChain(starts, first, ends, np.where(flat[:, None], straight, last), np.where(flat, 0.0, curvature))


def biarc_joints(p: Array, tangent_p: Array, q: Array, tangent_q: Array, ratio: Array) -> tuple[Array, Array]:
    """Where the two arcs from p to q (n, 2) with these unit tangents meet, and their tangent there; nan where they cannot.

    The end legs of the control polygon p, p + a·tp, q - b·tq, q have the lengths a and b = `ratio`·a, the middle one a + b;
    with v = q - p, t = tp + ratio·tq and u = tp - tq that says ratio·a² u² + 2a v·t - v² = 0, whose positive root is written so
    that nothing cancels.
    """
    r = ratio[:, None]
    v, u = q - p, tangent_p - tangent_q
    vv, vt = dots(v, v), dots(v, tangent_p + r * tangent_q)
    with np.errstate(invalid="ignore", divide="ignore"):
        a = np.where(vt > 0.0, vv / (vt + np.sqrt(vt * vt + ratio * dots(u, u) * vv)), np.nan)[:, None]
        first, last = p + a * tangent_p, q - r * a * tangent_q
        middle = v - a * (tangent_p + r * tangent_q)
        return (r * first + last) / (1.0 + r), middle / np.hypot(middle[:, 0], middle[:, 1])[:, None]


def arc_from(p: Point, tangent: Point, q: Point) -> Edge:
    """The arc from p, leaving along the unit `tangent`, to q; a line where it is straight."""
    return arcs_from(np.array([p]), np.array([tangent]), np.array([q])).edges()[0]


def _is_flat(chord: Array, across: Array) -> NDArray[np.bool_]:
    """Is an arc with these chords (n, 2) and such legs (n,) across it straight?"""
    return 2.0 * np.abs(across) * STRAIGHT <= np.hypot(chord[:, 0], chord[:, 1])


def dots(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def crosses(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
