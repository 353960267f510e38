"""Which places follow from the dimensions of a ratchet wheel and its click?

The wheel is wound counter-clockwise. At rest the click's nose lies in the root at 0°, between a locking face, which looks
clockwise and leans over it by the undercut, and the back of the tooth before. Millimetres, angles in degrees.
"""

from __future__ import annotations

import math

from watchsim.construction.outline import along, angle_of, polar
from watchsim.construction.ratchet.ratchet_dimensions import Ratchet
from watchsim.geometry.primitives import Point


def pitch(values: Ratchet) -> float:
    return 360.0 / values.teeth


def root(values: Ratchet) -> Point:
    return (values.tip_radius - values.depth, 0.0)


def tip(values: Ratchet) -> Point:
    """Of the tooth whose locking face rises from the root at 0°."""
    start, lean = root(values)[0], math.radians(values.undercut)
    length = -start * math.cos(lean) + math.sqrt(values.tip_radius**2 - (start * math.sin(lean)) ** 2)
    return along(root(values), -values.undercut, length)


def back(values: Ratchet) -> float:
    """Direction in which the back of the tooth before rises from the root at 0°."""
    return angle_of(polar(values.tip_radius, angle_of(tip(values)) - pitch(values)), root(values))


def opening(values: Ratchet) -> float:
    """Between that back and the locking face."""
    return -values.undercut - back(values)


def nose(values: Ratchet) -> Point:
    """Middle of the click's nose that touches both."""
    half = 0.5 * opening(values)
    return along(root(values), -values.undercut - half, values.nose_radius / math.sin(math.radians(half)))


def pivot(values: Ratchet) -> Point:
    """Of the click."""
    return along(nose(values), -values.click_angle, values.click_length)
