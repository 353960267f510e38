"""What does the solver do on hard cases, and does the bench lever run for every restitution and friction from 0 to 1?

    python scripts/reports/stability.py grid GRID.csv
    python scripts/reports/stability.py page GRID.csv [--slow | --redraw]

`grid` runs the bench lever 400 times and writes the table; the exit status is 1 where a run is unsound: it gave up, lost track
of its energy or gained some. `page` writes docs/reports/stability.md with its pictures from that table and `watchsim verify`.
"""

import argparse
import csv
import dataclasses
import datetime
import re
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from measured import REDRAW, keep, kept

import watchsim as ws
from watchsim.render.palette import FAINT
from watchsim.render.style import MAP, SERIES, SMALL, dress, figure, save
from watchsim.render.style import title as named
from watchsim.verification.verify import verify

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


def measured_row(scene: ws.Scene, restitution: float, friction: float) -> dict[str, object]:
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


def run_grid(path: Path) -> None:
    scene = ws.load(ROOT / "profiles" / "bench_lever" / "scene.toml")
    values = np.linspace(0.0, 1.0, STEPS)
    rows: list[dict[str, object]] = []
    with path.open("w", newline="", encoding="utf-8") as file:
        for eps in values:
            for mu in values:
                rows.append(measured_row(scene, float(eps), float(mu)))
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


DOCS = Path(__file__).resolve().parents[2] / "docs"
BLUE, RED, GREY = SERIES[0], SERIES[1], FAINT
MARKS = {BLUE: "o", RED: "X", GREY: "s"}


def table(rows: list[dict[str, Any]]) -> list[str]:
    """A line for each group of cases: how many numbers, the largest share of what is allowed, the source."""
    lines = ["| cases | numbers | error over allowed, worst | source |", "|---|---:|---:|---|"]
    for (name, source), group in groupby(rows, key=lambda row: (re.split(r",| on \d", row["name"])[0], row["source"])):
        found = list(group)
        worst = max(row["error"] / row["tolerance"] if row["tolerance"] > 0.0 else 0.0 for row in found)
        wrong = "" if all(row["ok"] for row in found) else " **wrong**"
        lines.append(f"| {name} | {len(found)} | {worst:.1e}{wrong} | {source} |")
    return lines


def margins(rows: list[dict[str, Any]], path: Path) -> None:
    """Error of every number as a share of what it may be, by case."""
    names = list(dict.fromkeys(row["name"] for row in rows))
    made = figure(height=3.1 * len(names) + 14.0, layout="constrained")
    axis = made.subplots()
    exact, worst = 1e-11, 10.0
    for row in rows:
        share = row["error"] / row["tolerance"] if row["tolerance"] > 0.0 else (0.0 if row["ok"] else worst)
        colour = RED if not row["ok"] else GREY if share == 0.0 else BLUE
        place = min(max(share, exact), worst)
        axis.plot(place, names.index(row["name"]), MARKS[colour], color=colour, markersize=2.6, alpha=0.7)
    axis.axvline(1.0, color=RED, linewidth=1.0)
    axis.set_xscale("log")
    dress(axis, grid="x")
    axis.set_yticks(range(len(names)), names, fontsize=SMALL)
    axis.set_ylim(len(names) - 0.4, -0.6)
    axis.set_xlabel("error over the error allowed; grey squares: exact")
    save(made, path)


def grid_picture(grid: list[dict[str, str]], path: Path) -> None:
    """Amplitude and impacts over restitution and friction."""
    from matplotlib.colors import LogNorm

    eps = sorted({float(row["restitution"]) for row in grid})
    mus = sorted({float(row["friction"]) for row in grid})
    amplitude, impacts = np.full((len(eps), len(mus)), np.nan), np.full((len(eps), len(mus)), np.nan)
    for row in grid:
        i, j = eps.index(float(row["restitution"])), mus.index(float(row["friction"]))
        amplitude[i, j] = float(row["amplitude_deg"] or np.nan)
        impacts[i, j] = float(row["impacts"])
    made = figure(height=75.0, layout="constrained")
    axes = made.subplots(1, 2)
    step = 0.5 * (mus[1] - mus[0])
    edges = (mus[0] - step, mus[-1] + step, eps[0] - step, eps[-1] + step)
    for axis, values, title, norm in (
        (axes[0], amplitude, "amplitude in the first second, °", None),
        (axes[1], np.maximum(impacts, 1.0), "impacts in the first second", LogNorm()),
    ):
        image = axis.imshow(values, origin="lower", extent=edges, aspect="equal", cmap=MAP, norm=norm)
        bar = made.colorbar(image, ax=axis, shrink=0.85)
        bar.ax.tick_params(labelsize=SMALL)
        axis.set(xlabel="friction", ylabel="restitution")
        named(axis, title)
        dress(axis, grid="none")
    for row in grid:
        if row["sound"] != "1":
            for axis in axes:
                axis.plot(float(row["friction"]), float(row["restitution"]), "x", color=RED)
    save(made, path)


def grid_text(grid: list[dict[str, str]]) -> list[str]:
    """What the runs of the grid came to."""
    ends = {end: sum(row["end"] == end for row in grid) for end in sorted({row["end"] for row in grid})}
    unsound = [row for row in grid if row["sound"] != "1"]
    rungs = ("lcp_lemke", "lcp_copositive", "lcp_detours", "lcp_enumerated", "lcp_inexact", "lcp_failures")
    counts = ("impacts", *rungs, "energy_rescues", "jams", "accumulations")
    total = {key: sum(int(row[key]) for row in grid) for key in counts}
    lines = [
        f"{len(grid)} runs of `profiles/bench_lever` for a second each, every contact with the same restitution and friction",
        "from 0 to 1 (`scripts/reports/stability.py grid`). A cross would mark a run that gave up, lost track of its energy, or",
        "gained any. White: without any loss in its contacts the train only rattles, and there is no beat with an amplitude.",
        "",
        "![amplitude and impacts over restitution and friction](../images/stability_grid.png)",
        "",
        "| | |",
        "|---|---|",
        *(f"| runs ended by {end} | {count} |" for end, count in ends.items()),
        f"| unsound runs | {len(unsound)} |",
        f"| worst energy residual over the energy put in | {max(float(row['ledger']) for row in grid):.1e} |",
        f"| largest gain of an impact, J | {max(float(row['largest_gain_J']) for row in grid):.1e} |",
        *(f"| {key.replace('_', ' ')} | {value:,} |" for key, value in total.items()),
        "",
    ]
    if unsound:
        lines += ["| restitution | friction | end | simulated, s | ledger | gain, J |", "|---|---|---|---|---|---|"]
        columns = ("restitution", "friction", "end", "simulated_s", "ledger", "largest_gain_J")
        lines += ["| " + " | ".join(row[column] for column in columns) + " |" for row in unsound]
        lines.append("")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("grid", "page"))
    parser.add_argument("grid", type=Path, help="table of the grid: written by `grid`, read by `page`")
    parser.add_argument("--slow", action="store_true", help="the large numbers of random problems too")
    parser.add_argument("--redraw", action="store_true", help=REDRAW)
    args = parser.parse_args()
    if args.what == "grid":
        run_grid(args.grid)
    with args.grid.open(encoding="utf-8") as file:
        grid = list(csv.DictReader(file))
    images = DOCS / "images"
    if args.redraw:
        margins(kept("stability"), images / "stability_margins.png")
        grid_picture(grid, images / "stability_grid.png")
        return
    rows = verify(args.slow)
    columns = ("name", "quantity", "expected", "got", "error", "tolerance", "ok")
    keep("stability", ({name: int(row[name]) if name == "ok" else row[name] for name in columns} for row in rows))
    margins(rows, images / "stability_margins.png")
    grid_picture(grid, images / "stability_grid.png")
    wrong = sum(not row["ok"] for row in rows)
    lines = [
        "# Stability on hard cases",
        "",
        f"Made by `scripts/reports/stability.py` on {datetime.date.today():%Y-%m-%d}; not edited by hand.",
        f"{len(rows)} numbers of `watchsim verify`, each against an answer found another way: a closed form, a law of",
        f"conservation, another algorithm, a published run. {'All agree.' if not wrong else f'{wrong} of them are wrong.'}",
        "",
        "![errors of all numbers](../images/stability_margins.png)",
        "",
        "[Laws](../theory/laws.md) and [method](../theory/method.md) define the laws of contact and the rules of the",
        "solver. How fast Moreau's time stepping comes to the same answers: [convergence](convergence.md). All numbers:",
        "[stability.csv](stability.csv), or `watchsim verify --slow`.",
        "",
        "## The bench lever over restitution and friction",
        "",
        *grid_text(grid),
        "## Case by case",
        "",
        *table(rows),
    ]
    (DOCS / "reports" / "stability.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()
