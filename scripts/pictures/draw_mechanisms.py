"""How do the pictures of docs/guide/mechanisms.md come about?

Simulates each profile and draws it at an instant at which its parts work on each other; of the clocks the wheel is shown close.

    python scripts/pictures/draw_mechanisms.py [profile]
"""

from __future__ import annotations

import sys
from pathlib import Path

import imageio.v3 as imageio

import watchsim as ws

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
SIZE = (960, 540)
SHOWN = {  # profile: simulated (s), instant (s), bodies to show close (None: all)
    "geneva": (1.0, 0.2, None),
    "geneva_stop": (4.0, 4.0, None),
    "graham": (2.0, 1.76, ["wheel"]),
    "recoil_anchor": (2.0, 1.76, ["wheel"]),
    "detent": (2.5, 2.1275, None),
    "pin_pallet": (2.2, 2.101, None),
    "pin_wheel": (4.0, 3.52, ["wheel"]),
    "cylinder": (2.2, 2.1, None),
    "duplex": (2.2, 2.1055, None),
    "involute_pair": (0.2, 0.2, None),
    "cycloidal_pair": (0.2, 0.2, ["pinion"]),
    "jumper": (0.6, 0.49, None),
    "cam": (0.2, 0.1, None),
    "ratchet": (0.2, 0.15, None),
    "verge": (4.5, 4.42, ["verge"]),
    "winding_click": (0.5, 0.2, None),
    "snail": (3.4, 3.3, None),
    "grasshopper": (1.5, 1.35, ["wheel", "entry", "exit"]),
    "remontoir": (1.0, 0.942, ["stop_wheel", "stop_lever", "wheel"]),
    "tourbillon": (5.1, 5.0, None),
    "governor": (1.1, 1.0, None),
}


def main(only: str) -> None:
    for name in [only] if only else SHOWN:
        duration, instant, close = SHOWN[name]
        run = ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=duration)
        imageio.imwrite(IMAGES / f"{name}.png", ws.frame(run, instant, size=SIZE, zoom=close))


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    main(arguments(__doc__, only=("", "one of the profiles")).only)
