"""How do the pictures of the README come about?

Simulates profiles/swiss_lever for a second and draws the angles and velocities of all bodies over the beats around the
instant at which the balance passes its rest position. The moving picture is made by scripts/pictures/make_gallery.py.

    python scripts/pictures/make_docs_pictures.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import watchsim as ws

ROOT = Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs" / "images"
DURATION = 1.0  # s
BEATS = 0.2  # s to each side of the instant in the plot


def middle_of_an_impulse(run: ws.Trajectory) -> float:
    """Time of the passage through rest that is nearest to the middle of the run."""
    times = run.events["t"][run.events["kind"] == ws.EventKind.CROSS]
    if len(times) == 0:
        raise SystemExit("the balance never passed its rest position: nothing to draw")
    return float(times[np.argmin(np.abs(times - 0.5 * run.simulated))])


def main() -> None:
    run = ws.simulate(ws.load(ROOT / "profiles" / "swiss_lever" / "scene.toml"), duration=DURATION)
    t = middle_of_an_impulse(run)
    IMAGES.mkdir(parents=True, exist_ok=True)
    ws.plot_kinematics(run, window=(t - BEATS, t + BEATS)).savefig(IMAGES / "swiss_lever_beat.png")


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    main()
