"""In which colours is a picture drawn besides its parts: on light or on dark ground?"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.render.palette import BACKGROUND, CONTACT, FAINT, FORCE, GRID, INK, PHASES, Finish, mixed

PALE = 0.55  # of the ground's colour in what is drawn though it cannot touch


@dataclass(frozen=True)
class Style:
    """Colours of ground, words, rules and marks; `phases` lie behind curves, `shade` is that of shadows (RGBA)."""

    name: str
    background: str
    ink: str
    faint: str
    grid: str
    contact: str
    force: str
    phases: dict[str, str]
    shade: tuple[float, float, float, float]

    def worn(self, look: Finish) -> Finish:
        """What a part wears on this ground: what cannot touch is pale, so that what can stands out."""
        if not look.pale:
            return look
        fill, edge = mixed(look.fill, self.background, PALE), mixed(look.edge, self.background, PALE)
        return Finish(fill, edge, look.line)

    def line(self, look: Finish) -> str:
        """The colour of ground, which has an outline and no face."""
        return look.edge if self.name == "light" else mixed(look.fill, self.ink, 0.4)

    def curve(self, look: Finish) -> str:
        """The colour of a curve that stands for a part."""
        return look.line if self.name == "light" else look.fill


LIGHT = Style("light", BACKGROUND, INK, FAINT, GRID, CONTACT, FORCE, PHASES, (0.13, 0.14, 0.16, 0.13))
DARK = Style(
    "dark",
    background="#15181c",
    ink="#ece8df",
    faint="#a9b0b8",
    grid="#343a42",
    contact="#ff9d5c",
    force="#7cc0ff",
    phases={
        "unlock": "#5f2b30",
        "catch-up": "#56461f",
        "impulse": "#27502f",
        "drop": "#3e3663",
        "run to banking": "#23466a",
        "recoil": "#5f2b30",
    },
    shade=(0.0, 0.0, 0.0, 0.4),
)
