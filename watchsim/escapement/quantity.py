"""One measured number: its mean over the teeth, the tooth that is furthest from it, and how exact it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Quantity:
    """`value` (rad, or m) with its `error`; `worst` is the value of the tooth `tooth` that differs most.

    Teeth are counted anticlockwise from 1, the one nearest to the wheel's own x axis, as in verdicts; None for what has nothing
    to do with a tooth. A drop is that of the tooth let off. The error covers what the outlines leave open at their joints and
    the width to which changes were halved; the drawing's own decimals come on top.
    """

    value: float
    error: float
    worst: float
    tooth: int | None = None

    @property
    def spread(self) -> float:
        """How far the worst tooth is from the mean."""
        return abs(self.worst - self.value)


def single(value: float, error: float) -> Quantity:
    return Quantity(value, error, value)


def over_teeth(values: Sequence[float], errors: Sequence[float], teeth: Sequence[int]) -> Quantity:
    """The mean over the teeth; nan where there is none."""
    if not values:
        return Quantity(math.nan, math.nan, math.nan)
    mean = float(np.mean(values))
    worst = int(np.argmax(np.abs(np.asarray(values) - mean)))
    return Quantity(mean, float(max(errors)), float(values[worst]), teeth[worst])
