"""How do the short movies of docs/guide/mechanisms.md come about?

By two commands for each, `watchsim run` on the profile and `watchsim movie`; the table holds what they are given.

    python scripts/pictures/make_mechanism_movies.py [ONLY]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images" / "movies"
LOOK = ("--size", "480x320", "--fps", "12")
MOVIES = {  # profile: simulated, window, speed, further options
    "geneva": ("1.5 s", "0 s:1.5 s", "1/2", ""),
    "geneva_stop": ("4 s", "0 s:4 s", "1", ""),
    "graham": ("5 s", "4 s:5 s", "1/4", "--zoom wheel"),
    "recoil_anchor": ("5 s", "4 s:5 s", "1/4", "--zoom wheel"),
    "grasshopper": ("5 s", "4 s:5 s", "1/4", "--zoom wheel,entry,exit"),
    "detent": ("2.6 s", "2 s:2.5 s", "adaptive", "--length 4s"),
    "pin_pallet": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s --zoom wheel,lever"),
    "pin_wheel": ("6 s", "4 s:6 s", "1/2", "--zoom wheel"),
    "cylinder": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "duplex": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "involute_pair": ("0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "cycloidal_pair": ("0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "jumper": ("1 s", "0 s:1 s", "1/4", ""),
    "cam": ("0.3 s", "0 s:0.3 s", "1/10", ""),
    "snail": ("7.3 s", "4.95 s:7.25 s", "1/2", ""),
    "governor": ("1.2 s", "0 s:1.2 s", "1/4", ""),
    "ratchet": ("0.5 s", "0 s:0.5 s", "1/8", ""),
    "winding_click": ("0.5 s", "0 s:0.5 s", "1/8", ""),
    "remontoir": ("1 s", "0.93 s:0.96 s", "1/120", "--zoom stop_wheel,stop_lever,wheel"),
}


def main(names: list[str]) -> None:
    from watchsim.cli import main as watchsim

    IMAGES.mkdir(exist_ok=True)
    profiles = Path(__file__).resolve().parents[2] / "profiles"
    with tempfile.TemporaryDirectory() as folder:
        for name in names or MOVIES:
            duration, window, speed, options = MOVIES[name]
            run, movie = f"{folder}/{name}", str(IMAGES / f"{name}.gif")
            assert watchsim(["run", str(profiles / name), "--duration", duration, "--no-plots", "-o", run]) == 0
            shown = ["--window", window, "--speed", speed, *LOOK, *options.split()]
            assert watchsim(["movie", run, *shown, "-o", movie]) == 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    only = arguments(__doc__, only=("", "names of profiles, with commas between them; all")).only
    main([name for name in only.split(",") if name])
