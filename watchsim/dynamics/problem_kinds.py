"""What is a contact problem about, and what solved it?"""

from __future__ import annotations

from enum import IntEnum


class Level(IntEnum):
    """What is sought: forces, or the impulses of one phase of an impact."""

    NONE = 0
    ACCELERATION = 1
    COMPRESSION = 2
    EXPANSION = 3


class Rung(IntEnum):
    """Of the ladder in solver_fallbacks.py; places in `ContactWork.rungs`."""

    LEMKE = 0
    COPOSITIVE = 1
    DETOUR = 2
    ENUMERATED = 3
    INEXACT = 4
    FAILED = 5  # nothing solved it
