"""Who drew the edges of this outline?"""

from __future__ import annotations

from typing import NamedTuple

from watchsim.geometry.loop import Loop


class Outline(NamedTuple):
    """A loop or an open chain, and the name of the entity that drew each of its edges, as CAD shows it."""

    loop: Loop
    sources: tuple[str, ...]
