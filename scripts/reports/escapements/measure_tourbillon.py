"""What is the rate of a tourbillon over a turn, and in which positions is it with the carriage left out?

Prints the numbers of docs/guide/mechanisms.md; takes some minutes.

    python scripts/reports/escapements/measure_tourbillon.py
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

import watchsim as ws

CARRIAGE = 37.0544949e-10  # kg·m², what `watchsim check` shows as felt there with all that is geared to it
TURN, SETTLED = 60.0, 120.0  # s


def tourbillon(off: float) -> ws.Scene:
    """With the balance's centre of mass `off` (m) beside its axis."""
    return ws.load(ws.profiles_dir() / "tourbillon").set("design.poise_error", off)


def upright(position: float, off: float) -> ws.Scene:
    """The same watch without a carriage, turned by `position` (rad)."""
    scene = ws.designs.swiss_lever().scene().set("bodies.wheel.inertia", CARRIAGE / 16**2)
    scene = scene.set("bodies.balance.mass", 50e-6).set("bodies.balance.centre_of_mass", [f"{off!r} m", "0 m"])
    g = (9.81 * math.sin(position), -9.81 * math.cos(position))
    return scene.set("scene.gravity", [f"{part!r} m/s²" for part in g])


def rate(scene: ws.Scene) -> float:
    """Mean over a turn once settled, s/d."""
    run = ws.simulate(scene, duration=SETTLED + TURN + 0.2, record="events")
    return float(np.array(ws.beats(run).rate_s_per_d)[-round(8 * TURN) - 1 : -1].mean())


def main() -> None:
    for off in (0.0, 5e-6):
        positions = [rate(upright(k * math.pi / 4.0, off)) for k in range(8 if off else 1)]
        turned, mean, spread = rate(tourbillon(off)), float(np.mean(positions)), max(positions) - min(positions)
        print(f"{1e6 * off:g} µm: positions {min(positions):.3f} to {max(positions):.3f} s/d, mean {mean:.4f}, ", end="")
        print(f"over a turn {turned:.4f}", f"({100 * abs(turned - mean) / spread:.2f} % of the spread)" if spread else "")


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    arguments(__doc__)
    main()
