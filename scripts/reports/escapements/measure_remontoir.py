"""How far do amplitude and rate follow the mainspring, with a remontoir and without?

Prints the numbers of docs/guide/mechanisms.md; takes some minutes.

    python scripts/reports/escapements/measure_remontoir.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import watchsim as ws

SETTLED, TURNS = 120.0, 4  # s; turns of the escape wheel, of 30 beats, that are averaged


def amplitude_and_rate(scene: ws.Scene) -> tuple[float, float, float]:
    """Mean amplitude (degrees), its range between windings, and rate (s/d), once settled."""
    beats = ws.beats(ws.simulate(scene, duration=SETTLED + 3.75 * TURNS + 0.5, record="events"))
    last = slice(-30 * TURNS - 1, -1)
    amplitude = np.array(beats.amplitude_deg)[last]
    return float(amplitude.mean()), float(np.ptp(amplitude)), float(np.array(beats.rate_s_per_d)[last].mean())


def main() -> None:
    remontoir, plain = ws.load(ws.profiles_dir() / "remontoir"), ws.designs.swiss_lever().scene()
    for share in (1.0, 0.8, 0.6):
        held = amplitude_and_rate(remontoir.set("design.train", 12e-6 * share))
        free = amplitude_and_rate(plain.set("torques.0.value", -1e-6 * share))
        print(f"{100 * share:3.0f} %: remontoir {held[0]:.3f}° (range {held[1]:.3f}°), {held[2]:+.3f} s/d;", end=" ")
        print(f"without {free[0]:.3f}° (range {free[1]:.3f}°), {free[2]:+.3f} s/d", flush=True)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    arguments(__doc__)
    main()
