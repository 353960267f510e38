"""Does the bench lever run, or stop with its reason, for every restitution and friction from 0 to 1?

Simulates profiles/bench_lever with each pair from a grid of 20 by 20 and writes one row for each: why it ended, how far it
came, amplitude, impacts, what each rung of the ladder solved, energy rescues, jams, the energy ledger, and the largest gain of
kinetic energy in any impact. Fails if a run ends for no good reason, gains energy, or loses track of it.

    python scripts/checks/measure_grid.py docs/reports/bench_lever_grid.csv
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
from pathlib import Path

import numpy as np

import watchsim as ws

ROOT = Path(__file__).resolve().parents[2]
STEPS = 20
DURATION = 1.0  # s: eight beats
LEDGER = 1e-6  # largest residual over the energy put in
GAIN = 1e-10  # largest gain of an impact over the energy stored in the balance
COUNTS = (
    *("impacts", "lcp_lemke", "lcp_copositive", "lcp_detours", "lcp_enumerated", "lcp_inexact", "lcp_failures"),
    *("energy_rescues", "jams", "accumulations"),
)


def largest_gain(run: ws.Trajectory) -> float:
    """The most that the contacts of one impact together gave, J; negative where all took some."""
    impacts = run.events[run.events["kind"] == ws.EventKind.IMPACT]
    if len(impacts) == 0:
        return 0.0
    # Impacts of one instant may be several in a row; their sum must not gain either.
    _, first = np.unique(impacts["t"], return_inverse=True)
    return float(-np.bincount(first, weights=impacts["energy_lost"]).min())


def measure(scene: ws.Scene, restitution: float, friction: float) -> dict[str, object]:
    contacts = tuple(dataclasses.replace(one, restitution=restitution, friction=friction) for one in scene.contacts)
    run = ws.simulate(dataclasses.replace(scene, contacts=contacts), DURATION)
    numbers = ws.summary(run)
    gain, stored = largest_gain(run), 0.5 * scene.springs[0].stiffness * float(np.abs(run.q).max()) ** 2
    sound = not run.stop.gave_up and run.energy["residual_relative"] < LEDGER and gain <= GAIN * stored
    return {
        "restitution": f"{restitution:.4f}",
        "friction": f"{friction:.4f}",
        "end": run.stop.name,
        "simulated_s": f"{run.simulated:.6g}",
        "amplitude_deg": "" if numbers["amplitude_deg"] is None else f"{numbers['amplitude_deg']:.4f}",
        "missed_beats": numbers["missed_beats"],
        **{name: run.counts[name] for name in COUNTS},
        "ledger": f"{run.energy['residual_relative']:.1e}",
        "largest_gain_J": f"{gain:.1e}",
        "sound": int(sound),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", type=Path, help="CSV file to write")
    args = parser.parse_args()
    scene = ws.load(ROOT / "profiles" / "bench_lever" / "scene.toml")
    values = np.linspace(0.0, 1.0, STEPS)
    rows: list[dict[str, object]] = []
    with args.table.open("w", newline="", encoding="utf-8") as file:
        for eps in values:
            for mu in values:
                rows.append(measure(scene, float(eps), float(mu)))
                if len(rows) == 1:
                    table = csv.DictWriter(file, rows[0], lineterminator="\n")
                    table.writeheader()
                table.writerow(rows[-1])
                file.flush()
    bad = [row for row in rows if not row["sound"]]
    print(f"{len(rows)} runs, {len(bad)} unsound")
    for row in bad:
        print(row)
    raise SystemExit(bool(bad))


if __name__ == "__main__":
    main()
