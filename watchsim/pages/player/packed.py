"""How do arrays travel in a page?

As little-endian binary in base64: a fourth of the size of digits, and read back bit by bit.
"""

from __future__ import annotations

import base64

import numpy as np
from numpy.typing import ArrayLike


def doubles(values: ArrayLike) -> str:
    """Times: differences of nanoseconds must survive beside hours."""
    return _text(np.asarray(values, "<f8"))


def floats(values: ArrayLike) -> str:
    """Everything else, of which 7 digits are enough."""
    return _text(np.asarray(values, "<f4"))


def small(values: ArrayLike) -> str:
    """Codes from 0 to 255."""
    return _text(np.asarray(values, "u1"))


def _text(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
