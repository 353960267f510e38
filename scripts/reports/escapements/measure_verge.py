"""How does the period of a verge depend on its drive? Prints the numbers of docs/guide/mechanisms.md.

python scripts/reports/escapements/measure_verge.py
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

import watchsim as ws

# Flags close together, long, and let go after a small turn: the torque on the verge is then nearly constant.
NARROW = {"flag_angle": "20°", "lift": "2°", "drop": "0.02 mm", "friction": 0.0, "wheel_inertia": "1 g·cm²", "length": 200}
STRONG, WEAK = (1.0, (1.0, 2.0, 4.0)), (100.0, (0.5, 1.0, 2.0))  # damping (mN·m·s/rad), torques (mN·m)


def period(run: ws.Trajectory) -> tuple[float, float]:
    """Mean time (s) between passages of the middle in the last half of the run, and the amplitude (degrees)."""
    t = np.linspace(0.5 * run.simulated, run.simulated, 400001)
    q = run.sample(t)[0][:, run.slices["verge"].start]
    up = np.flatnonzero((q[:-1] < 0.0) & (q[1:] >= 0.0))
    zeros = t[up] - q[up] * (t[up + 1] - t[up]) / (q[up + 1] - q[up])
    return float(np.diff(zeros).mean()), float(np.degrees(np.abs(q).max()))


def main() -> None:
    for name, (viscous, torques) in {"strong": STRONG, "weak": WEAK}.items():
        print(f"{name} drive: torque on the wheel, period, amplitude, exponent")
        before = None
        for torque in torques:
            scene = ws.designs.verge(**NARROW, torque=f"{torque} mN·m", viscous=f"{viscous} mN·m·s/rad").scene()
            seconds, amplitude = period(ws.simulate(scene, duration=60.0))
            exponent = "" if before is None else f"{math.log(seconds / before) / math.log(2.0):8.4f}"
            print(f"  {torque:5g} mN·m  {seconds:9.5f} s  {amplitude:6.2f}° {exponent}")
            before = seconds
    run = ws.simulate(ws.designs.verge().scene(), duration=300.0)
    seconds, amplitude = period(run)
    print(f"by default: {seconds:.4f} s, {amplitude:.1f}°, 300 s in {run.wall - run.compile:.2g} s, ", end="")
    print(f"energy to {run.energy['residual_relative']:.1g}")


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    arguments(__doc__)
    main()
