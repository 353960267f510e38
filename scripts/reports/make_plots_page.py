"""How does docs/guide/plots.md come about, with its pictures?

    python scripts/reports/make_plots_page.py

Runs the commands that the page shows, as anyone can, in a folder of its own; pictures go to docs/images/plots. Takes half a
minute.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "guide" / "plots.md"
IMAGES = ROOT / "docs" / "images" / "plots"

RUN = 'watchsim run profiles/swiss_lever --duration "20 s" -o swiss --no-plots'


@dataclass(frozen=True)
class Plot:
    """A picture with its command, and what it shows."""

    picture: str
    title: str
    words: str
    command: str


PLOTS = (
    Plot(
        "kinematics.png",
        "Kinematics",
        "Angle and velocity of every body (`--bodies`, `--quantities angle,velocity,acceleration`) over the run or a `--window`. Where the window shows a few beats, their phases are shaded and named. Impacts are jumps. However many rows a run has, every spike is drawn: of each column of dots the curve keeps the first, last, least and largest value.",
        'watchsim plot swiss --window "19.55 s:19.85 s" -o kinematics.png',
    ),
    Plot(
        "phases.png",
        "The phases of a beat",
        "The last oscillation, and its two beats at large. `--phases` prints the tables of motion and energy, too.",
        "watchsim plot swiss --kind phases -o phases.png",
    ),
    Plot(
        "timeline.png",
        "The mechanism amid each phase",
        "The parts around the lever in the middle of every phase, with the contact forces on the lever as arrows of one scale; numbers show when.",
        "watchsim plot swiss --kind timeline -o timeline.png",
    ),
    Plot(
        "torque.png",
        "Torque on the balance",
        "The moment of all contact forces on the balance over its angle, positive with its swing: below zero the balance unlocks, above it is driven. An area is the work of the forces; on it stands what the phase gives in all, with the impacts, the number of `phases.csv`. The table has both parts. They are worked out twice: from contact forces and jumps here, from the books of the balance there.",
        "watchsim plot swiss --kind torque -o torque.png",
    ),
    Plot(
        "forces.png",
        "Forces",
        "What the bodies of each pair press and rub, summed over their contacts, and the loads of the bearings. Impacts have impulses, not forces, and are not shown.",
        "watchsim plot swiss --kind forces -o forces.png",
    ),
    Plot(
        "portrait.png",
        "Phase portrait",
        "Velocity over angle of one oscillation, phases in colour.",
        "watchsim plot swiss --kind phase-portrait -o portrait.png",
    ),
    Plot(
        "energy.png",
        "Energy",
        "What was put in over the whole run, and where it went; below, each phase of the last two beats. The black line is the work of the drive; where bars reach beyond it stores gave the rest, to the left of zero.",
        "watchsim plot swiss --kind energy -o energy.png",
    ),
    Plot(
        "timing.png",
        "Amplitude, rate and beat error",
        "Of every half swing of whatever swings, heard or not.",
        "watchsim plot swiss --kind timing -o timing.png",
    ),
    Plot(
        "tape.png",
        "Paper of a timegrapher",
        "As an instrument would write it that hears the first noise of each beat.",
        "watchsim plot swiss --kind tape -o tape.png",
    ),
)

HEAD = f"""# Plots

`watchsim plot RUN --kind NAME` draws what is shown here, several kinds with commas, `--kind all` every one that the run has. Files are PNG,
SVG or PDF (`--format svg,pdf`, or the ending of `-o`). In Python each is a function that returns a matplotlib figure:
`ws.plot_kinematics`, `plot_phases`, `plot_timeline`, `plot_torque`, `plot_forces`, `plot_phase_portrait`, `plot_energy`, `plot_timing`, `plot_tape`; of studies
`plot_sweep` and `plot_sensitivity` ([studies](studies.md)). A notebook shows a figure that stands on the last line of a cell.

A figure is as wide as it will be printed: 170 mm for a page, `--width "85 mm"` (`width=85`) for a column, letters of 6 pt or more in both. Colours can
be told apart with every kind of colour vision, and no colour stands alone: names, dashes, marks or hatching go with it. `--dark` (`watchsim.render.dark_figure.dark`) gives any of them dark ground. The same style draws all pictures
of these pages (`watchsim.render.figures.figure_style`). `scripts/reports/make_plots_page.py` makes this page from

```
{RUN}
```
"""


def main() -> None:
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "profiles").symlink_to(ROOT / "profiles", target_is_directory=True)
        run(RUN, place)
        for one in PLOTS:
            run(one.command, place)
            shutil.copyfile(place / one.picture, IMAGES / one.picture)
    parts = [HEAD]
    for one in PLOTS:
        parts.append(
            f"## {one.title}\n\n{one.words}\n\n```\n{one.command}\n```\n\n![{one.title}](../images/plots/{one.picture})\n"
        )
    PAGE.write_text("\n".join(parts), encoding="utf-8")


def run(command: str, folder: Path) -> None:
    """One command line of the page, with the watchsim of this folder tree."""
    found = os.environ.get("PYTHONPATH")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(ROOT), found)) if found else str(ROOT)}
    words = [sys.executable, "-m", *shlex.split(command)]
    if subprocess.run(words, cwd=folder, env=environment, check=False).returncode != 0:
        raise SystemExit(f"failed: {command}")


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    main()
