"""How do amplitude and rate of the escapements on docs/guide/mechanisms.md depend on the drive, and where does the work go?

    python scripts/reports/escapements/measure_escapements.py [seconds]

Limit cycles (ws.steady) over the drive as Markdown tables, then a run of each profile (default 300 s): beats missed, shares of the
drive's work, the energy account, processor time.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import watchsim as ws

DRIVES: dict[
    str, tuple[str, tuple[float, ...], tuple[dict[str, object], ...]]
] = {  # design: unit, drives, other dimensions of further rows
    "pin_pallet": ("µN·m", (1.0, 1.4, 2.0, 2.8), ({},)),
    "pin_wheel": ("mN·m", (14.0, 18.0, 24.0, 32.0, 40.0), ({},)),
    "cylinder": ("µN·m", (0.2, 0.28, 0.4), ({}, {"friction": 0.15})),
    "duplex": ("µN·m", (2.0, 2.8, 4.0, 5.6, 8.0), ({}, {"letting_go": "-4 °"}, {"letting_go": "8 °"})),
}


def table(name: str) -> None:
    unit, drives, rows = DRIVES[name]
    print(f"\n| {name}, drive ({unit}) | {' | '.join(f'{one:g}' for one in drives)} |\n|{'---|' * (len(drives) + 1)}")
    for others in rows:
        cycles = [ws.steady(getattr(ws.designs, name)(torque=f"{one} {unit}", **others).scene()) for one in drives]
        what = ", ".join(f"{key} {value}" for key, value in others.items()) or "as by default"
        print(f"| amplitude, {what} | {' | '.join(f'{one.amplitude_deg:.5g}°' for one in cycles)} |")
        print(f"| rate (s/d), {what} | {' | '.join(f'{one.rate_s_per_d:+.3f}' for one in cycles)} |")


def run_of(name: str, seconds: float) -> None:
    scene, begun = ws.load(ws.profiles_dir() / name / "scene.toml"), time.process_time()
    run = ws.simulate(scene, duration=seconds)
    spent, found = time.process_time() - begun, ws.summary(run)
    work = run.energy
    print(f"\n{name}: {seconds:g} s in {spent:.1f} s of processor time, {seconds / spent:.0f} × real time;", end=" ")
    print(f"{found['missed_beats']} beats missed; the account closes to {abs(work['residual_relative']):.0e}")
    print("  " + ", ".join(f"{key} {value:.4g}" for key, value in work.items() if isinstance(value, float)))


def main(seconds: float) -> None:
    for name in DRIVES:
        table(name)
    for name in DRIVES:
        run_of(name, seconds)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    main(arguments(__doc__, seconds=(300.0, "simulated time of the runs")).seconds)
