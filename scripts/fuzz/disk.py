"""Is anything lost when the disk fails once, at any one of the things a command does to it?

For each of COMMANDS: the first opening for writing, write, synchronisation, rename or removal fails with "No space left on
device", then only the second, and so on to the last one. After each: what was there before is whole, and what was computed lies
where it was to go, or where the message says.
`--stride N` takes every N-th.
"""

import argparse
import contextlib
import io
import os
import re
import shutil
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
LEVER = str(ROOT / "profiles" / "bench_lever")
SWEEP = ["sweep", LEVER, "contacts.0.friction=0.1,0.12", "--duration", "1.5 s", "--workers", "1"]
NAMES = ("old", "new", "study", "begun", "new.png")
COMMANDS = {
    "run": ["run", LEVER, "--duration", "0.1 s", "-o", "new"],
    "run --force": ["run", LEVER, "--duration", "0.1 s", "-o", "old", "--force"],
    "run --resume": ["run", LEVER, "--duration", "0.25 s", "--resume", "old"],
    "movie": ["movie", "old", "--window", "0.1 s:0.11 s", "--size", "64x64"],
    "plot": ["plot", "old", "--bodies", "lever", "--format", "png,svg,pdf"],
    "report": ["report", "old"],
    "export": ["export", LEVER, "-o", "new", "--format", "dxf"],
    "new": ["new", "geneva", "-o", "new"],
    "sound": ["sound", "old"],
    "check --png": ["check", LEVER, "--png", "new.png"],
    "inspect --png": ["inspect", str(ROOT / "profiles" / "bench_lever" / "wheel.dxf"), "--png", "new.png"],
    "sweep": [*SWEEP, "-o", "new"],
    "sweep --force": [*SWEEP, "-o", "study", "--force"],
    "sweep --resume": [*SWEEP, "-o", "begun", "--resume"],
    "new drawing": ["new", str(ROOT / "profiles" / "bench_lever" / "wheel.dxf"), "-o", "new"],
}


def judge(name: str, place: Path, second: Path, status: int, said: str) -> list[str]:
    """What is wrong after a command that met a fault."""
    from watchsim.results.folder import read_results
    from watchsim.storage.write import sweep

    wrong = [] if status in (0, 2) else [f"exit status {status}: {said}"]
    if "Traceback" in said or (place / "old" / "mine.txt").read_text() != "mine":
        wrong.append("traceback, or the user's file is gone")
    for folder in (
        place,
        *(place / name for name in ("old", "old/plots", "new", "study", "begun")),
    ):  # what the next command does first
        sweep(folder)
    if list(place.rglob(".watchsim-*")):
        wrong.append("leftover")
    old = read_results(place / "old").simulated
    if name.startswith("sweep"):
        return wrong + _judged_study(place / arguments_of(name)["-o"], status, said)
    reached = {"run": 0.1, "run --force": 0.1, "run --resume": 0.25}.get(name)
    if reached is None:
        if status == 2 and (place / "new").exists():
            wrong.append("half a folder")
        return wrong + ([] if old == 0.2 else ["the run was changed"])
    target = place / ("new" if name == "run" else "old")
    saved = re.search(r"saved, without pictures, in (\S+)", said)
    if status == 0 and read_results(target).simulated != reached:
        wrong.append("said to be written, and is not")
    elif saved and read_results(saved[1]).simulated != reached:
        wrong.append("not where the message says")
    elif status == 2 and not saved and "nothing can be written" not in said and "cannot be written" not in said:
        wrong.append(f"computed and lost: {said}")
    if status == 2 and name != "run" and old not in (0.2, reached):
        wrong.append("the old run is gone")
    return wrong


def arguments_of(name: str) -> dict[str, str]:
    """The options of a command with what follows them."""
    return dict(pairwise(COMMANDS[name]))


def _judged_study(target: Path, status: int, said: str) -> list[str]:
    """What is wrong with a study that met a fault: every finished row is in a table, or nothing was computed."""
    saved = re.search(r"saved, without plots, in (\S+)", said)
    table = (Path(saved[1]) if saved else target) / "sweep.csv"
    lines = table.read_text(encoding="utf-8").splitlines() if table.is_file() else []
    if status == 0 or saved or "could not write the plot" in said or "The table is the new one" in said:
        return [] if len(lines) == 3 else [f"rows lost: {lines} {said}"]
    if target.name == "study" and len(lines) != 3:
        return ["the earlier study is gone"]
    early = (
        "could not write the rows" in said
        or "can be written to" in said
        or "cannot be written" in said
        or str(target / "rows.jsonl") in said
    )
    return [] if early or not target.exists() else [f"computed and lost: {said}"]


def _make(made: Path) -> None:
    """What lies there before: a run, a study, and one of which only the first point was computed; a file of the user's own."""
    from watchsim.cli import main as watchsim

    os.chdir(made)
    with contextlib.redirect_stdout(io.StringIO()):
        watchsim(["run", LEVER, "--duration", "0.2 s", "--no-plots", "-o", "old"])
        watchsim([*SWEEP, "--no-plots", "-o", "study"])
    (made / "old" / "mine.txt").write_text("mine")
    (made / "begun").mkdir()
    lines = (made / "study" / "rows.jsonl").read_bytes().splitlines(keepends=True)
    (made / "begun" / "rows.jsonl").write_bytes(b"".join(lines[:2]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stride", type=int, default=1)
    parser.add_argument("--command", choices=list(COMMANDS), action="append")
    args = parser.parse_args()
    from storage.disk_faults import Disk, watched

    from watchsim.cli import main as watchsim

    failed = 0
    with tempfile.TemporaryDirectory() as parent:
        made, place, second = (Path(parent) / name for name in ("made", "place", "elsewhere"))
        for folder in (made, second):
            folder.mkdir()
        _make(made)
        for name in args.command or COMMANDS:
            begun, number, rounds = time.perf_counter(), 1, 0
            command, *words = COMMANDS[name]
            arguments = [command, *(str(place / word) if word in NAMES else word for word in words)]
            while True:
                shutil.rmtree(place, ignore_errors=True)
                shutil.copytree(made, place)
                os.chdir(second)
                said = io.StringIO()
                with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), watched(Disk(place, number)) as disk:
                    status = watchsim(arguments)
                wrong = judge(name, place, second, status, said.getvalue())
                rounds += 1
                if wrong:
                    failed += 1
                    print(f"{name}, fault {number} ({disk.log[number - 1] if disk.failed else 'none'}): {wrong}", flush=True)
                if not disk.failed:
                    break
                number += args.stride
            print(
                f"{name}: {rounds - 1} of {len(disk.log)} actions failed once; {time.perf_counter() - begun:.0f} s", flush=True
            )
    print(f"{failed} wrong")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
