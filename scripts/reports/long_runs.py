"""Does a watch still beat evenly, and does its account still close, after an hour? Does a locked lever creep in a day?

    python scripts/reports/long_runs.py [--duration SECONDS] [--locked SECONDS] [--day SECONDS] [--page FILE]

Every hour is run in pieces of a minute, each taken up from the saved state of the one before; the day of the Swiss lever in
one piece, of which only statistics are kept. Writes docs/reports/long-runs.md and docs/images/long_runs.png.
"""

import argparse
import dataclasses
import os
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from measured import REDRAW, keep, kept
from numpy.typing import NDArray

from watchsim.analysis.escape_wheel import missed_beats
from watchsim.analysis.timing import DAY, beats
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import EVERYTHING, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

ROOT = Path(__file__).resolve().parents[2]

PIECE = 60.0  # s
TIGHTER = 0.01  # of the tolerance, for comparison
STEADY = 1e-6  # °, what the amplitude should be steady to
Floats = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Long:
    """A long run: one entry per window of a minute, and what is said of the whole."""

    title: str
    end: Floats  # s
    amplitude: Floats  # °, mean of the half swings
    spread: Floats  # °, between the smallest and the largest of them
    rate: Floats  # s/d
    residual: Floats  # J, of the ledger since the start
    supplied: Floats  # J, work of the drive since the start
    half_swings: int
    missed: int | None
    penetration: float
    complementarity: float
    counts: dict[str, int]
    cpu: float
    tight: tuple[float, float]  # a tighter tolerance, and the residual's share of the work put in there

    @property
    def settled(self) -> int:
        """First window from which on the mean amplitude stays within `STEADY` of its mean."""
        for first in range(len(self.amplitude)):
            rest = self.amplitude[first:]
            if np.abs(rest - rest.mean()).max() <= 0.5 * STEADY:
                return first
        return len(self.amplitude)

    @property
    def growth(self) -> tuple[float, float]:
        """J a minute that the residual grows by, least squares over the settled half, and the error of that slope."""
        half = len(self.end) // 2
        t, r = self.end[half:] / PIECE, self.residual[half:]
        (slope, _), covariance = np.polyfit(t, r, 1, cov=True)
        return float(slope), float(np.sqrt(covariance[0, 0]))


def pieces(scene: Scene, duration: float) -> list[Trajectory]:
    """The run minute by minute, of each what analysis needs: turning points, passages, and where all bodies are then."""
    kept: list[Trajectory] = []
    start, reached = None, 0.0
    while reached < duration:
        reached = min(duration, reached + PIECE)
        run = simulate(scene, reached, record=EVERYTHING, start=start)
        if run.stop != Stop.DURATION or run.end_state is None:
            raise SystemExit(f"{scene.title}: {run.stop_message}")
        start = run.end_state
        # What lies beyond the saved state is told again by the next piece.
        events = run.events[: start.events] if reached < duration else run.events
        turns = events[events["kind"] == EventKind.TURN]
        q, u = run.sample(turns["t"])
        events = events[np.isin(events["kind"], (EventKind.TURN, EventKind.CROSS))]
        kept.append(dataclasses.replace(run, t=turns["t"], q=q, u=u, a=np.zeros_like(q), events=events))
    return kept


def long_run(scene: Scene, duration: float) -> Long:
    """Run and condense."""
    begun = time.process_time()
    parts = pieces(scene, duration)
    cpu = time.process_time() - begun
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in ("t", "q", "u", "a", "events")
    }
    whole = dataclasses.replace(parts[-1], **joined)
    found = beats(whole)
    end = np.array([part.simulated for part in parts])
    window = np.searchsorted(end, found.t)
    by_window = [found.amplitude_deg[window == i] for i in range(len(parts))]
    periods = np.array([np.nanmean(found.period_s[window == i]) for i in range(len(parts))])
    return Long(
        title=scene.title,
        end=end,
        amplitude=np.array([one.mean() for one in by_window]),
        spread=np.array([np.ptp(one) for one in by_window]),
        rate=DAY * (found.nominal_period / periods - 1.0),
        residual=np.array([part.energy["residual_J"] for part in parts]),
        supplied=np.array([part.energy["in_J"] for part in parts]),
        half_swings=len(found),
        missed=missed_beats(whole),
        penetration=whole.worst_penetration,
        complementarity=whole.worst_residual,
        counts=whole.counts,
        cpu=cpu,
        tight=(TIGHTER * scene.tolerance, _share(scene, TIGHTER * scene.tolerance)),
    )


def _share(scene: Scene, tolerance: float) -> float:
    """The residual's share of the work put in, from 5 s to 15 s."""
    early = simulate(scene, 5.0, tolerance, record=EVERYTHING)
    late = simulate(scene, 15.0, tolerance, record=EVERYTHING, start=early)
    residual, supplied = (late.energy[name] - early.energy[name] for name in ("residual_J", "in_J"))
    return abs(residual) / float(supplied)


def locked(scene: Scene) -> Scene:
    """The balance stands still far outside the fork, where its spring is at rest; the wheel presses the locked lever."""
    balance = scene.body("balance")
    return dataclasses.replace(scene, springs=(dataclasses.replace(scene.springs[0], rest=balance.angle),))


def creep(scene: Scene, duration: float) -> tuple[Floats, float]:
    """(largest change of each coordinate after the first second, seconds of processor time)."""
    begun = time.process_time()
    scene = dataclasses.replace(locked(scene), duration=duration)
    run = simulate(scene, duration, record=((0.0, 1.0), (duration - 1.0, duration)))
    if run.stop != Stop.DURATION:
        raise SystemExit(f"{scene.title}, locked: {run.stop_message}")
    return np.abs(run.q[-1] - run.at(1.0)[0]), time.process_time() - begun


MEMORY_AT = (0.01, 0.1, 0.25, 0.5, 0.75, 0.99)  # shares of the day
WHOLE = """
## Swiss lever, {hours:g} h in one piece, statistics only

- {half_swings:,} half swings, {ticks:,} with a tick; {cpu:.0f} s of processor time.
- Amplitude {mean:.7f}° on average, from {least:.7f}° to {largest:.7f}°; energy residual {share:.0e} of the work put in.
- {counts}.
- Memory of the process after {points} of the time: {memory} MB."""


def whole_day(scene: Scene, duration: float, counted: Iterable[str]) -> str:
    """What is said of one run of that many seconds, of which only statistics are kept, with these of its counts."""
    memory: list[float] = []

    def watch(now: float, end: float) -> None:
        if now >= MEMORY_AT[min(len(memory), len(MEMORY_AT) - 1)] * end and len(memory) < len(MEMORY_AT):
            memory.append(resident())

    begun = time.process_time()
    run = simulate(scene, duration, record="statistics", progress=watch)
    cpu = time.process_time() - begun
    if run.stop != Stop.DURATION:
        raise SystemExit(f"{scene.title}: {run.stop_message}")
    swings = run.sums["amplitude"]
    return WHOLE.format(
        hours=duration / 3600.0,
        half_swings=run.sums["half_swings"],
        ticks=run.sums["ticks"],
        cpu=cpu,
        share=run.energy["residual_relative"],
        counts=", ".join(f"{run.counts[name]:,} {name}" for name in counted),
        points=", ".join(f"{part:.0%}" for part in MEMORY_AT),
        memory=", ".join(f"{megabytes:.1f}" for megabytes in memory),
        **{name: np.degrees(swings[name]) for name in ("mean", "least", "largest")},
    )


def resident() -> float:
    """MB that this process occupies now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return 1e-6 * pages * os.sysconf("SC_PAGE_SIZE")


PAGE = ROOT / "docs" / "reports" / "long-runs.md"
IMAGES = ROOT / "docs" / "images"
TOLD = (1, 2, 10, 60)  # minutes that have a line in the table
COUNTED = (
    *("impacts", "lcp", "lcp_failures", "lcp_copositive", "lcp_detours", "lcp_enumerated", "lcp_inexact"),
    *("energy_rescues", "accumulations", "jams"),
)
HEAD = """# Long runs

Does a simulated watch beat evenly for an hour, and does its energy account stay closed? Does a locked lever creep?
Written by `scripts/reports/long_runs.py`; the hours are run minute by minute, each minute from the saved state of the
one before.

![amplitude and residual over an hour](../images/long_runs.png)

The residual of the account is the sum of the errors of all steps. Each step is exact to a share of about `tolerance`, 10⁻⁹
here, and every beat of a settled watch makes the same errors, so the residual grows with the work put in; its share of that
work does not (right picture).
"""
STANDS = """
## Locked, balance stopped, {hours:g} h

Largest change of any coordinate after the first second.

| scene | wheel, lever, balance: rad | processor time, s |
|---|---|---:|"""
TABLE = """
| minute | amplitude, ° | half swings differ by, ° | rate, s/d | residual, J | of the work put in |
|---:|---:|---:|---:|---:|---:|"""


def page(runs: list[Long], stands: dict[str, tuple[Floats, float]], asked: float, day: str) -> str:
    """The whole page."""
    lines = [HEAD.rstrip(), *(line for run in runs for line in _one(run)), STANDS.format(hours=asked / 3600.0)]
    for name, (moved, cpu) in stands.items():
        lines.append(f"| {name} | {', '.join(f'{v:.0e}' if v else '0' for v in moved)} | {cpu:.1f} |")
    return "\n".join([*lines, *([day] if day else [])]) + "\n"


def _one(run: Long) -> list[str]:
    """What is said of one watch."""
    slope, error = run.growth
    last, settled = len(run.end) - 1, run.settled
    steady = "not within the run"
    if settled < last:
        steady = f"from minute {settled + 1} on, where the means lie within {np.ptp(run.amplitude[settled:]):.1e}°"
    share = abs(slope) / (run.supplied[-1] * PIECE / run.end[-1])
    counts = ", ".join(f"{run.counts[name]:,} {name}" for name in COUNTED)
    return [
        f"\n## {run.title}\n",
        f"- {run.half_swings:,} half swings, {run.missed} missed; {run.cpu:.0f} s of processor time.",
        f"- Amplitude of a minute steady to {STEADY:.0e}°: {steady}. "
        f"Half swings of the last minute lie within {run.spread[-1]:.1e}°.",
        f"- Energy residual at the end {run.residual[-1]:.1e} J of {run.supplied[-1]:.1e} J put in. Over the second half it "
        f"changes by {slope:.1e} ± {error:.0e} J a minute, {share:.0e} of the work put in meanwhile "
        f"({run.tight[1]:.0e} at the tolerance {run.tight[0]:.0e}).",
        f"- Worst penetration {run.penetration:.1e} m, worst residual of complementarity {run.complementarity:.1e}; {counts}.",
        TABLE,
        *(_line(run, i) for i in sorted({min(minute - 1, last) for minute in TOLD})),
    ]


def _line(run: Long, i: int) -> str:
    """Window i in the table."""
    share = abs(run.residual[i]) / run.supplied[i]
    means = f"{run.amplitude[i]:.8f} | {run.spread[i]:.1e} | {run.rate[i]:.6f}"
    return f"| {i + 1} | {means} | {run.residual[i]:.1e} | {share:.0e} |"


@dataclasses.dataclass(frozen=True)
class Course:
    """What the picture shows of a long run: one entry per window of a minute."""

    title: str
    end: Floats  # s
    amplitude: Floats  # °
    residual: Floats  # J
    supplied: Floats  # J


def _keep(runs: list[Long]) -> None:
    """One row for each minute in docs/reports/long-runs.csv."""
    rows = ((run.title, *row) for run in runs for row in zip(run.end, run.amplitude, run.residual, run.supplied, strict=True))
    columns = ("watch", "end_s", "amplitude_deg", "residual_J", "supplied_J")
    keep("long-runs", (dict(zip(columns, row, strict=True)) for row in rows))


def _kept() -> list[Course]:
    rows = kept("long-runs")
    columns = ("end_s", "amplitude_deg", "residual_J", "supplied_J")
    return [
        Course(title, *(np.array([row[name] for row in rows if row["watch"] == title]) for name in columns))
        for title in dict.fromkeys(row["watch"] for row in rows)
    ]


def picture(runs: Sequence[Course | Long], path: Path) -> None:
    """Amplitude from its last value, the residual of the account, and its share of the work put in, over time."""
    from watchsim.render.palette import FAINT
    from watchsim.render.style import CURVE, SERIES, dress, figure, key, save
    from watchsim.render.style import title as named

    made = figure(height=62.0, layout="constrained")
    axes = made.subplots(1, 3)
    for run, colour, dashes in zip(runs, SERIES, ("-", "--"), strict=False):
        look = {"color": colour, "linestyle": dashes, "linewidth": CURVE, "label": run.title}
        minutes = run.end / PIECE
        axes[0].semilogy(minutes[:-1], np.maximum(np.abs(run.amplitude - run.amplitude[-1])[:-1], 1e-13), **look)
        axes[1].plot(minutes, 1e12 * run.residual, **look)
        axes[2].semilogy(minutes, np.abs(run.residual) / run.supplied, **look)
    axes[0].axhline(STEADY, color=FAINT, linestyle=":", linewidth=CURVE)
    axes[0].set(ylabel="difference, °")
    axes[1].set(ylabel="residual, pJ")
    axes[2].set(ylabel="share", ylim=(1e-13, 1e-7))
    titles = ("Amplitude, from its last value", "Residual of the account", "Share of the work put in")
    for axis, words in zip(axes, titles, strict=True):
        axis.set_xlabel("minute")
        named(axis, words)
        dress(axis)
    key(axes[2], [(line, str(line.get_label())) for line in axes[2].lines], loc="upper right")
    save(made, path)


def failures(runs: list[Long], stands: dict[str, tuple[Floats, float]]) -> list[str]:
    """What falls short of: no missed beat, an amplitude that settles, an account that closes, no creep."""
    short = [f"{run.title}: {run.missed} missed beats" for run in runs if run.missed]
    short += [f"{run.title}: the amplitude is not steady" for run in runs if run.settled > len(run.end) // 2]
    short += [f"{run.title}: the account is open" for run in runs if abs(run.residual[-1]) > 1e-8 * run.supplied[-1]]
    return short + [f"{name}: creeps when locked" for name, (moved, _) in stands.items() if np.any(moved > 0.0)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=3600.0, help="s, of the running watches; eight minutes or more")
    parser.add_argument("--locked", type=float, default=86400.0, help="s, of the locked ones")
    parser.add_argument("--day", type=float, default=86400.0, help="s, of the run of which only statistics are kept; 0: none")
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--redraw", action="store_true", help=REDRAW)
    args = parser.parse_args()
    if args.redraw:
        picture(_kept(), IMAGES / "long_runs.png")
        return
    if args.duration < 8.0 * PIECE:
        parser.error(f"--duration {args.duration:g}: at least eight minutes, for the slopes")
    scenes = {name: load(profiles_dir() / name / "scene.toml") for name in ("bench_lever", "swiss_lever")}
    simulate(scenes["bench_lever"], 0.01)  # compiles: that is no part of the times
    stands = {scene.title: creep(scene, args.locked) for scene in scenes.values()}
    runs = [long_run(scene, args.duration) for scene in scenes.values()]
    day = whole_day(scenes["swiss_lever"], args.day, COUNTED) if args.day else ""
    args.page.write_text(page(runs, stands, args.locked, day), encoding="utf-8")
    if args.page == PAGE:
        _keep(runs)
    picture(runs, args.page.parent.parent / "images" / "long_runs.png")
    if short := failures(runs, stands):
        raise SystemExit("\n".join(short))


if __name__ == "__main__":
    main()
