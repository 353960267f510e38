"""How fast is the solver, how exact, and how does its time grow? Writes docs/reports/speed.md and docs/images/speed.png.

    python scripts/reports/speed.py [--from FOLDER | --command]

Runs `watchsim bench`, whole runs and the studies of growth: about a quarter of an hour on a machine with nothing else to do; the
page says if there was something else. `--from` takes the results of an earlier `watchsim bench`; `--command` renews only what
the whole command takes.
"""

import argparse
import json
import math
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from watchsim.bench.compare import Scenario, scenarios, whole
from watchsim.bench.engines import is_installed
from watchsim.bench.growth import Study, studies
from watchsim.bench.profile import profile_of, profile_text
from watchsim.commands.bench import measured, write
from watchsim.paths import profiles_dir
from watchsim.render.study_plot import plot_speed
from watchsim.scene.load import load
from watchsim.simulation import MOREAU
from watchsim.simulation.simulate import simulate

ROOT = Path(__file__).resolve().parents[2]
OWN = "pfeiffer-glocker"
SETTLED = "bench_lever, settled"
QUIET = 0.5  # processes that wait for the processor when the measuring begins
ALONE = "Nothing else ran on the machine."
BUSY = "Other programs ran on the machine meanwhile: compare within a table, not from one to the next."
PROFILED = {"swiss_lever": 10.0}  # s simulated

PAGE_FILE = ROOT / "docs" / "reports" / "speed.md"
PLOTTED, WHERE = "written and plotted: ", "\n\n## Where the time goes"  # before and behind what `command` says

PAGE = """# Speed against error

How long does a simulated second take, and how large is the error? Written by `scripts/reports/speed.py` from
`watchsim bench`, on one core of one machine ({machine}), all in one run. Times are processor times of the stepping alone
(without reading, compiling and set-up, for all engines): the median of several runs, with the smallest and the largest.
Levers run for 3 s from the start, amplitude and rate are averaged from 1 s to 3 s; the disc's place is compared at 3 s. In this
time the details of the first beats dominate: the settled lever runs for 15 s and is averaged over the last two. {alone}

![Time per simulated second over error](../images/speed.png)

The reference is the closed form, or the event-driven solver at its tightest tolerance; another method confirms it. The levers
of the other engines are polygons. They apply Newton's law of impact, watchsim Poisson's: with restitution above zero they
need not reach the same amplitude. Each engine is set up as well as we know how.

## Compared with other engines

{ratios}

All engines, settings and errors: `watchsim bench`, which writes its tables.

## Whole runs, wall-clock time

From the drawing to the last of {simulated:g} s of the settled lever, with the compiled code already loaded: set-up (reading; for
other engines making polygons) and stepping. The first run of a geometry computes its cells.

{wholes}

The whole command `watchsim run profiles/swiss_lever --duration "180 s"`, from typing it to the prompt, everything recorded,
written and plotted: {command}

## Where the time goes

Each count times the cost of one such piece of work, measured by itself in the middle of the run (`watchsim run --profile`).
No work is counted twice: a step excludes its accelerations and gaps, an instant its impacts and complementarity problems, an
impact its problems. Cells are computed once for a geometry; the last line is a run that knows none.

{profiles}

## How the time grows

{growth}
Declared pairs of primitives cost what is within reach of each other, not their number.
"""


def ratios(rows: list[dict[str, Any]]) -> str:
    """The coarsest event-driven run within 10⁻³ degrees against the most exact run of every other engine."""
    lines = ["| scene | watchsim | error | other engine | error | times faster |", "|---|---:|---:|---|---:|---:|"]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        here = [row for row in rows if row["scene"] == scene and row["error_amplitude_deg"] is not None and not row["note"]]
        exact = [row for row in here if row["method"] == OWN and row["error_amplitude_deg"] <= 1e-3]
        if not exact:
            continue
        own = exact[0]
        for method in dict.fromkeys(row["method"] for row in here if row["method"] != OWN):
            best = min((row for row in here if row["method"] == method), key=lambda row: row["error_amplitude_deg"])
            time, other = own["wall_s_per_simulated_s"], best["wall_s_per_simulated_s"]
            cells = (
                scene,
                f"{time:.4f} s",
                f"{own['error_amplitude_deg']:.0e}°",
                f"{method}, step {1e6 * best['setting']:g} µs",
            )
            lines.append("| " + " | ".join((*cells, f"{best['error_amplitude_deg']:.2g}°", f"{other / time:.0f}")) + " |")
    return "\n".join(lines)


def wholes(scenario: Scenario) -> str:
    """A table of whole runs, each engine at its most exact setting but watchsim at its usual one."""
    lines = ["| engine | first run: set-up | stepping | again: set-up | stepping |", "|---|---:|---:|---:|---:|"]
    settings = {name: values[-1] for name, values in scenario.settings.items() if name in (OWN, MOREAU) or is_installed(name)}
    settings[OWN] = 1e-9
    for method, setting in settings.items():
        one = whole(scenario, method, setting)
        times = (one.first_ready, one.first_stepping, one.again_ready, one.again_stepping)
        how = f"tolerance {setting:g}" if method == OWN else f"step {1e6 * setting:g} µs"
        lines.append(f"| {method}, {how} | " + " | ".join(f"{seconds:.3f} s" for seconds in times) + " |")
    return "\n".join(lines)


def command() -> str:
    """What the whole command takes, the best of five."""
    scene = str(profiles_dir() / "swiss_lever")
    best, stepping = math.inf, 0.0
    with tempfile.TemporaryDirectory() as folder:
        asked = [scene, "--duration", "180 s"]
        for k in range(5):
            begun = time.perf_counter()
            words = [sys.executable, "-m", "watchsim", "run", *asked, "-o", f"{folder}/{k}"]
            subprocess.run(words, check=True, capture_output=True)
            taken = time.perf_counter() - begun
            if taken < best:
                numbers = json.loads(Path(folder, str(k), "summary.json").read_text(encoding="utf-8"))
                best, stepping = taken, numbers["wall_s"]
    return f"{best:.2f} s wall-clock, of which stepping {stepping:.2f} s"


def profiled(name: str, duration: float) -> str:
    """The profile of a run of that many seconds."""
    run = simulate(load(profiles_dir() / name / "scene.toml"), duration, record="statistics")
    return f"`{name}`:\n\n```\n{profile_text(profile_of(run))}\n```"


def growth(found: list[Study]) -> str:
    """A table of each study with its exponent."""
    parts = []
    for study in found:
        parts.append(
            f"**{study.what}**: " + ", ".join(f"{n:g}: {t:.4f} s" for n, t in zip(study.sizes, study.seconds, strict=True))
        )
        if study.exponent is not None:
            parts.append(f"Time grows with the power {study.exponent:.2f} (last three points).")
        if study.stopped:
            parts.append(f"Larger ones do not run: {study.stopped}.")
        parts.append("")
    return "\n".join(parts).rstrip()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--from", dest="folder", metavar="FOLDER", type=Path, help="results of an earlier `watchsim bench`")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "bench", help="where the results go (default bench)")
    parser.add_argument("--command", action="store_true", help="renew only what the whole command takes")
    args = parser.parse_args()
    if args.command:
        before, rest = PAGE_FILE.read_text(encoding="utf-8").split(PLOTTED, 1)
        PAGE_FILE.write_text(before + PLOTTED + command() + WHERE + rest.split(WHERE, 1)[1], encoding="utf-8")
        return 0
    alone = os.getloadavg()[0] < QUIET
    if args.folder:
        kept = json.loads((args.folder / "bench.json").read_text(encoding="utf-8"))
        rows, references = kept["rows"], kept["references"]
    else:
        rows, references = measured(False, None, lambda words: print(words, file=sys.stderr, flush=True))
        write(args.output, rows, references)
    settled = next(one for one in scenarios() if one.name == SETTLED)
    plot_speed(rows, ROOT / "docs" / "images" / "speed.png")
    text = PAGE.format(
        machine=f"{platform.machine()}, Python {platform.python_version()}",
        alone=ALONE if alone else BUSY,
        ratios=ratios(rows),
        simulated=settled.duration,
        wholes=wholes(settled),
        command=command(),
        profiles="\n\n".join(profiled(name, duration) for name, duration in PROFILED.items()),
        growth=growth(studies()),
    )
    PAGE_FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
