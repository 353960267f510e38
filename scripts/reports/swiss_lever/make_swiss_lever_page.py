"""What does a Swiss lever do when torque, inertia, friction, position or temperature change? Writes docs/guide/swiss_lever.md.

    python scripts/reports/swiss_lever/make_swiss_lever_page.py [page]

Every number of the page comes from the limit cycles found here; the pictures go to docs/images/swiss_study_*.png.
"""

from __future__ import annotations

import sys
from pathlib import Path

import swiss_clock
import swiss_drive
import swiss_positions
import swiss_run_down
from swiss_studies import over_torque, watch

PAGE = Path(__file__).resolve().parents[3] / "docs" / "guide" / "swiss_lever.md"
HEAD = [
    "# Studies of a Swiss lever",
    "",
    "What changes in a watch when one number of it does? The scene is `profiles/swiss_lever`: 4 Hz, 15"
    " teeth, 1 µN·m at the escape wheel.",
    "Every point is a limit cycle found by shooting ([studies](studies.md)), with its error; error"
    " bars are drawn, and are mostly smaller",
    "than the marks. Spring and damping count by stiffness and coefficient. Written by"
    " `scripts/reports/swiss_lever/make_swiss_lever_page.py`.",
    "",
    "A single study on the command line:",
    "",
    "```",
    'watchsim sweep profiles/swiss_lever "torques.0.value=-0.4:-1.6:25 µN·m" -o torque',
    'watchsim sweep profiles/swiss_lever "contacts.0.friction=0:0.2:11" -o friction',
    "watchsim sweep profiles/swiss_lever --sensitivity -o what_matters",
    "```",
    "",
]
TAIL = [
    "## Declared pairs and computing time",
    "",
    "How the time of a run grows with what is declared is measured on a page of its own:"
    " [complexity](../reports/complexity.md).",
    "",
]


def page() -> str:
    """The text of the page; draws the pictures."""
    scene = watch()
    driven = over_torque(scene, swiss_drive.TORQUES)
    chapters = [
        *swiss_drive.torque(scene, driven),
        *swiss_clock.period(scene),
        *swiss_drive.isochronism(scene, driven),
        *swiss_drive.friction(scene),
        *swiss_drive.best(scene, driven),
        *swiss_positions.positions(scene),
        *swiss_clock.temperature(scene),
        *swiss_run_down.run_down(),
        *swiss_clock.what_matters(scene),
    ]
    return minus("\n".join([*HEAD, *chapters, *TAIL]))


def minus(text: str) -> str:
    """The typographic minus before numbers, but for those in code."""
    lines, code = [], False
    for line in text.split("\n"):
        code ^= line.startswith("```")
        lines.append(line if code or "`watchsim" in line else line.replace(" -", " −"))
    return "\n".join(lines)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    asked = arguments(__doc__, page=(PAGE, "the page"))
    Path(asked.page).write_text(page(), encoding="utf-8")
