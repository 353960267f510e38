"""How is a run played inside a notebook?

The page of `report` without its sheet and its files, in a frame of its own that may run its scripts and nothing else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from watchsim.pages.html import element
from watchsim.pages.report_page import player_text
from watchsim.simulation.record.trajectory import Trajectory

HEIGHT = 640  # dots: picture, buttons, and the first plot


@dataclass(frozen=True)
class Player:
    """A page that plays, as text, and how high it is shown (dots)."""

    title: str
    page: str = field(repr=False)
    height: int = HEIGHT

    def __repr__(self) -> str:
        return f"<Player of {self.title!r}: {len(self.page.encode()) / 1e3:.0f} kB>"

    def _repr_html_(self) -> str:
        return element(
            "iframe",
            srcdoc=self.page,
            sandbox="allow-scripts allow-downloads",
            title=f"Player of {self.title}",
            loading="lazy",
            style=f"width:100%;height:{self.height}px;border:0",
        )


def show(run: Trajectory, window: Sequence[float] | None = None, *, height: int = HEIGHT) -> Player:
    """A player that a notebook shows under its cell: the last beats, or a window (s) of the run.

    ValueError for a window that was not recorded, or that holds too much motion for a page.
    """
    return Player(run.scene.title, player_text(run, window), height)
