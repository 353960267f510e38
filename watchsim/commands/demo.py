"""watchsim demo: the incline check and the Swiss lever, from drawings to a movie."""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from watchsim import stopping
from watchsim.commands.console import FINE, MISSED, announce_compile

HELP = "the incline check and a ticking Swiss lever: numbers, plots, MP4, GIF and a page"
DURATION = 10.0
DEFAULT, PICTURE = "results/demo", "incline.png"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-o", "--output", metavar="DIR", default=DEFAULT, help="results folder (default %(default)s)")
    parser.add_argument("--details", action="store_true", help="print every number, not only the verdicts")
    parser.add_argument("--force", action="store_true", help="replace a results folder that exists")


def run(args: argparse.Namespace) -> int:
    from watchsim.analysis.summary import summary_text
    from watchsim.commands.inputs import load_scene, secured_file, secured_folder
    from watchsim.commands.run import simulate_with_progress, status
    from watchsim.commands.write import Extras, goal_of, write
    from watchsim.paths import profiles_dir
    from watchsim.results.folder import check_folder
    from watchsim.verification.verify import incline_rows, verify_text

    start = time.monotonic()
    parent = Path(args.output)
    if not parent.is_dir():
        secured_folder(parent, "results", default=args.output == DEFAULT)
        parent.mkdir()
    secured_file(parent / PICTURE, "the plot")
    folder = secured_folder(parent / "swiss_lever", "results")
    check_folder(folder, args.force)
    announce_compile()
    print("1. A disc bounces and rolls down an incline: against the closed form", flush=True)
    rows = incline_rows()
    picture = _incline_picture(parent)
    print(f"   {_agreement(rows)}", flush=True)
    print(f"   Plot: {picture}", flush=True)
    if args.details:
        print(verify_text(rows), flush=True)
    print(f"\n2. A Swiss lever, read from DXF drawings, ticks for {DURATION:g} s", flush=True)
    scene = load_scene(str(profiles_dir() / "swiss_lever"))
    goal = goal_of(scene, folder, args.force)
    with stopping.keeping():
        trajectory, lines, panels = simulate_with_progress(scene, DURATION, None, folder, plotted=True)
        summary = write(trajectory, goal, Extras(movie=True, gif=True, report=True), ["--duration"], lines, panels)
    print(f"   {_ticking(summary)}")
    print(f"   Open {folder / 'report.html'}: motion, plots and numbers on one page.")
    print(f"   Beside it: plots, movie.mp4, movie.gif, and all numbers (report.txt) in {folder}")
    if args.details:
        print(summary_text(trajectory, {**summary, "expect": []}), flush=True)
    print(f"Done in {time.monotonic() - start:.0f} s.")
    code = status(trajectory, summary)
    return code if code != FINE else FINE if all(row["ok"] for row in rows) else MISSED


def _agreement(rows: Sequence[Mapping[str, Any]]) -> str:
    """The verdict on the incline in a line."""
    wrong = [row for row in rows if not row["ok"]]
    if wrong:
        return f"WRONG: {len(wrong)} of {len(rows)} numbers, the first {wrong[0]['name']}, {wrong[0]['quantity']}."
    return f"All {len(rows)} numbers agree, with errors below {max(row['error'] for row in rows):.0e}."


def _ticking(summary: Mapping[str, Any]) -> str:
    """The verdict on the watch in a line."""
    about = summary["verdict_details"]
    works = about is not None and about["works"]
    if not works or summary["amplitude_deg"] is None or summary["rate_s_per_d"] is None:
        why = None if works else summary["verdict_message"]
        return f"It does NOT work: {why or summary['timing_message'] or summary['stop_message']}."
    missed = f"{summary['missed_beats'] or 'none'} missed in {summary['beats']} half swings"
    rate = f"{summary['rate_s_per_d']:+.1f} s/d".replace("-", "−")
    close = f"the energy account closes to {summary['energy']['residual_relative']:.0e}"
    yet = " (not settled yet)" if summary["verdict"] == "unsettled" else ""
    return f"It ticks{yet}: amplitude {summary['amplitude_deg']:.1f}°, rate {rate}, {missed}; {close}."


def _incline_picture(folder: Path) -> Path:
    """The kinematic plot of the bouncing disc, the first picture a newcomer sees."""
    from watchsim.commands.inputs import load_scene
    from watchsim.paths import profiles_dir
    from watchsim.render.kinematics_plot import plot_kinematics
    from watchsim.simulation.simulate import simulate
    from watchsim.simulation.state import Stop
    from watchsim.storage.write import write_file

    run = simulate(load_scene(str(profiles_dir() / "incline")))
    if run.stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt
    path = folder / PICTURE
    write_file(path, plot_kinematics(run).savefig, "the plot")
    return path
