"""Is anything lost when a command is killed, interrupted or terminated at a random moment?

Starts commands again and again (those of COMMANDS), sends each one a signal at a random moment of its life, and looks at what
it leaves. Rounds are numbered: number k takes the same command, and the same share of that command's usual time, on every
machine. Each fourth one is a process of its own, with an interpreter that starts and loads; the others are copies of a process
that has loaded everything (see warm.py).

KILL: no half file under a final name, no leftover after the next command's sweep, the user's own file is there; each fifth time
the next command is run as well, and must be fine.
--helpers pool: KILL goes to a worker process of a study instead, each fourth time to the study itself. --helpers cluster: to a
worker of a local dask cluster, which is replaced, or to its scheduler or the study, each fourth time. The study ends with
status 0, or is gone on with; its rows and table are then those of one that nobody disturbed, no traceback, no orphan.
INT and TERM: exit status 130 and 143, or 0 where the command had ended before; results readable where there are any, no
traceback, no leftover.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]
from warm import Forked, load  # noqa: E402

LEVER = str(ROOT / "profiles" / "bench_lever")
LONG = "2 s"
PF_EXITING = 4  # Linux, include/linux/sched.h
STATUS = {signal.SIGKILL: -9, signal.SIGINT: 130, signal.SIGTERM: 143}
FRESH = 4  # each so many-th round is a process of its own
COMMANDS = {
    "run": ["run", LEVER, "--duration", LONG, "-o", "new"],
    "long": ["run", LEVER, "--duration", "60 s", "--record", "all", "--no-plots", "-o", "new"],
    "steps": [
        "run",
        LEVER,
        "--duration",
        "0.3 s",
        "--method",
        "moreau",
        "--no-plots",
        "--set",
        "run.tolerance=1e-6",
        "-o",
        "new",
    ],
    "force": ["run", LEVER, "--duration", LONG, "-o", "old", "--force"],
    "resume": ["run", LEVER, "--duration", "1 s", "--resume", "old"],
    "movie": ["movie", "old", "--window", "0.01 s:0.19 s", "--speed", "1/5", "--size", "320x180"],
    "plot": ["plot", "old", "--format", "png,svg,pdf"],
    "export": ["export", LEVER, "-o", "parts"],
    "picture": ["check", LEVER, "--png", "start.png"],
    "drawing": ["inspect", f"{LEVER}/wheel.dxf", "--png", "start.png"],
    "report": ["report", "old"],
    "sound": ["sound", "old"],
    "design": ["new", "geneva", "-o", "drawn"],
    "proposal": ["new", f"{LEVER}/wheel.dxf", "-o", "drawn"],
    "sweep": ["sweep", LEVER, "contacts.0.friction=0.1,0.12,0.15", "--duration", "1.5 s", "--workers", "1", "-o", "study"],
    "workers": ["sweep", LEVER, "contacts.0.friction=0.1,0.12,0.15", "--duration", "1.5 s", "--workers", "2", "-o", "study"],
    "steady": ["steady", LEVER],
    "turned": ["check", LEVER, "--turn", "--swing", "30°", "--movie", "turn.gif"],
}
ALONE = ("workers",)  # always processes of their own: a copy has no server of worker processes
DEMO, SELDOM = "demo", 50  # which takes as long as all the others
COMMANDS_AND_DEMO = {**COMMANDS, DEMO: ["demo", "-o", "shown"]}
KEEPING = ("run", "long", "steps", "resume", "force")


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def start(arguments: list[str], place: Path, fresh: bool) -> subprocess.Popen[str] | Forked:
    if not fresh:
        return Forked(arguments, place, place.parent / "said.txt")
    command = [sys.executable, "-m", "watchsim", *arguments]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=place, env=environment(), stdout=pipe, stderr=pipe, text=True)


def faults(place: Path) -> list[str]:
    """What is wrong with what lies there."""
    from watchsim.results.folder import read_results
    from watchsim.storage.write import PREFIX

    found = [f"leftover {path.relative_to(place)}: {sorted(map(str, path.rglob('*')))}" for path in place.rglob(f"{PREFIX}*")]
    if not (place / "old" / "mine.txt").is_file():
        found.append("the user's own file is gone")
    for folder in (place / "old", place / "new"):
        if folder.exists():
            try:
                read_results(folder)
            except (OSError, ValueError) as error:
                found.append(f"{folder.name}: {error}")
    for path, ends in (
        (place / "old" / "movie.mp4", b"moov"),
        (place / "start.png", b"IEND"),
        (place / "shown" / "swiss_lever" / "movie.mp4", b"moov"),
        (place / "old" / "report.html", b"</html>"),
        (place / "study" / "sweep.png", b"IEND"),
        (place / "drawn" / "scene.toml", b"[scene]"),
        (place / "turn.gif", b"\x3b"),
        (place / "old/plots/kinematics.pdf", b"%%EOF"),
    ):
        if path.exists() and ends not in path.read_bytes():
            found.append(f"{path.name} is not whole")
    return found


def one(
    number: int, which: int, made: Path, usual: Mapping[tuple[str, bool], float], place: Path, names: Sequence[str]
) -> tuple[str, str, list[str]]:
    """Round `number` with signal `which`: the command, how it ended, what is wrong."""
    from watchsim.storage.write import sweep

    rng = random.Random(f"{number}")
    name, fresh = (names[number % len(names)], names[number % len(names)] in ALONE or number // len(names) % FRESH == 0)
    if number % SELDOM == 1 and names == list(COMMANDS):
        name, fresh = DEMO, False
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(made, place)
    arguments = COMMANDS_AND_DEMO[name]
    process = start(arguments, place, fresh)
    share = rng.random() * 1.1
    if isinstance(process, subprocess.Popen):
        _await_the_first_line(process)
    time.sleep(share * usual[name, fresh])
    process.send_signal(which)
    alive = process.poll() is None and not _is_ending(process.pid)
    said = "".join(process.communicate())
    wrong = [] if process.returncode in (STATUS[signal.Signals(which)], 0) else [f"exit status {process.returncode}"]
    if alive and process.returncode == 0 and which != signal.SIGKILL:
        wrong.append("swallowed")
    if which != signal.SIGKILL and ("Traceback" in said or "Error" in said):  # workers that are orphaned may say so
        wrong.append(said)
    if process.returncode in (130, 143) and "Results:" not in said and name in KEEPING and "writing what was" in said:
        wrong.append("results were announced and not written")
    for folder in (place, place / "old", place / "old" / "plots", place / "shown", place / "study"):
        if which == signal.SIGKILL:  # what the next command does first
            sweep(folder)
    wrong += faults(place)
    if number % 5 == 0 and which == signal.SIGKILL:
        replacing = ["--force"] if "-o" in arguments and "--force" not in arguments else []
        again = start([*arguments, *replacing], place, fresh)
        said = "".join(again.communicate())
        if again.returncode != 0 or list(place.rglob(".watchsim-*")):
            wrong.append(f"the next command: {again.returncode} {said}")
    return name, str(process.returncode), wrong


HELPED = {
    "sweep": ["sweep", LEVER, "contacts.0.friction=0.1:0.2:12", "--duration", "1 s", "--no-plots", "-o", "study"],
    "tolerance": ["tolerance", "desk", "--samples", "16", "--no-plots", "-o", "study"],
}
TOLERANCES = """
"amplitude" = { min = "290°" }
[tolerances]
"torques.0.value" = { limits = "±0.5 µN·m" }
"contacts.0.friction" = { limits = "±0.03" }
"bodies.balance.inertia" = { limits = "±0.05 mg·cm²" }
"bodies.lever.position.1" = { limits = "±1 µm" }
"""


def desk(place: Path) -> None:
    """A scene with tolerances."""
    shutil.copytree(LEVER, place / "desk", ignore=shutil.ignore_patterns("results"))
    scene = place / "desk" / "scene.toml"
    scene.write_text(scene.read_text().partition("[expect]")[0] + "[expect]" + TOLERANCES)


def studied(place: Path, arguments: list[str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "watchsim", *arguments]
    return subprocess.run(command, cwd=place, env=environment(), check=False, capture_output=True, text=True)


def outcome(folder: Path) -> tuple[list[str], list[str]]:
    """The rows of a study, in the order of their numbers, and its table, both without what a point took."""
    rows = [json.loads(line) for line in (folder / "rows.jsonl").read_text().splitlines()]
    lines = list(csv.reader(next(folder.glob("*.csv")).open()))
    timed = lines[0].index("seconds") if "seconds" in lines[0] else len(lines[0])
    table = [",".join(line[:timed] + line[timed + 1 :]) for line in lines]
    return [json.dumps({**row, "seconds": 0}) for row in sorted(rows, key=lambda row: row.get("point", -1000))], table


def helped(
    number: int, kind: str, arguments: list[str], place: Path, usual: float, undisturbed: object
) -> tuple[str, str, list[str]]:
    """One round in which something of a study is killed: who, how the study ended, what is wrong."""
    rng = random.Random(f"{kind} {number}")
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    desk(place)
    cluster: dict[str, subprocess.Popen[bytes]] = {}
    more = ["--workers", "2"]
    if kind == "cluster":
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
        cluster = {"scheduler": _dask("scheduler", "--host", address, "--no-dashboard"), "worker": _dask_worker(address)}
        more = ["--scheduler", address]
        time.sleep(2.0)
    process = start([*arguments, *more], place, fresh=True)
    assert isinstance(process, subprocess.Popen)
    helpers: set[int] = set()
    until = time.monotonic() + rng.random() * usual
    while process.poll() is None and time.monotonic() < until:
        helpers |= _descendants(process.pid)
        time.sleep(0.02)
    alive = sorted(_descendants(process.pid))
    who = (["worker"] * 2 + ["scheduler", "study"] if kind == "cluster" else ["helper"] * 3 + ["study"])[number % 4]
    who = "study" if who == "helper" and not alive else who
    if who in cluster:
        cluster[who].kill()
        if who == "worker":
            cluster["another worker"] = _dask_worker(address)
    else:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process.pid if who == "study" else rng.choice(alive), signal.SIGKILL)
    while process.poll() is None:
        helpers |= _descendants(process.pid)
        time.sleep(0.05)
    said = "".join(process.communicate())
    for one in cluster.values():
        one.kill()
        one.wait()
    fine = {"scheduler": (0, 2, 3), "study": (0, -9)}.get(who, (0,))
    wrong = [] if process.returncode in fine else [f"exit status {process.returncode}: {said}"]
    wrong += [said] if "Traceback" in said or "Error" in said else []
    time.sleep(0.5)
    if left := [pid for pid in helpers if Path(f"/proc/{pid}").exists() and not _is_ending(pid)]:
        wrong.append(f"orphans {left}")
    return who, f"{who} {process.returncode}", wrong + _gone_on_with(place, arguments, process.returncode != 0, undisturbed)


def _gone_on_with(place: Path, arguments: list[str], unfinished: bool, undisturbed: object) -> list[str]:
    """What is wrong with the study when it is done, after --resume where it was not."""
    rows = place / "study" / "rows.jsonl"
    kept = rows.read_bytes().splitlines(keepends=True) if rows.is_file() else []
    again = studied(place, [*arguments, "--workers", "1", "--resume"]) if unfinished else None
    if again and again.returncode != 0:
        return [f"gone on with: {again.returncode} {again.stderr}"]
    now = rows.read_bytes().splitlines(keepends=True)
    whole = [line for line in kept if line.endswith(b"\n")]
    wrong = [] if now[: len(whole)] == whole else [f"{len(whole)} lines were there after the kill, and not all of them stayed"]
    return wrong if outcome(place / "study") == undisturbed else [*wrong, "not what an undisturbed study gives"]


def _dask(*arguments: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "distributed.cli.dask_" + arguments[0], *arguments[1:]]
    return subprocess.Popen(command, env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _dask_worker(address: str) -> subprocess.Popen[bytes]:
    return _dask("worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard")


def _descendants(number: int) -> set[int]:
    """The processes below one, as Linux lists them."""
    found: set[int] = set()
    with contextlib.suppress(OSError):
        for child in map(int, Path(f"/proc/{number}/task/{number}/children").read_text().split()):
            found |= {child} | _descendants(child)
    return found


def _await_the_first_line(process: subprocess.Popen[str]) -> None:
    """Wait until the interpreter has started and the first line of the package has run: from then on SIGTERM is in hand."""
    bit = 1 << (signal.SIGTERM - 1)
    while process.poll() is None:
        with contextlib.suppress(OSError):
            status = Path(f"/proc/{process.pid}/status").read_text()
            if any(int(line.split()[1], 16) & bit for line in status.splitlines() if line.startswith(("SigBlk", "SigCgt"))):
                return
        time.sleep(0.002)


def _is_ending(number: int) -> bool:
    """Whether the process is past its last instruction: the system is taking it apart."""
    with contextlib.suppress(OSError):
        return bool(int(Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[6]) & PF_EXITING)
    return True


def _usual(arguments: list[str], fresh: bool, made: Path, place: Path) -> float:
    """How long the command takes here, s."""
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(made, place)
    since = time.perf_counter()
    process = start(arguments, place, fresh)
    said = "".join(process.communicate())
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(arguments)}: {process.returncode} {said}")
    return time.perf_counter() - since


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--signal", choices=("KILL", "INT", "TERM"), default="KILL")
    parser.add_argument("--count", type=int, default=70)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--command", choices=list(COMMANDS), action="append", help="only this one; may be given several times")
    parser.add_argument("--helpers", choices=("pool", "cluster"), help="kill helpers of a study instead of commands")
    parser.add_argument("--study", choices=tuple(HELPED), default="sweep", help="which study (default %(default)s)")
    args = parser.parse_args()
    which = getattr(signal, f"SIG{args.signal}")
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have switched it off for what runs behind
    ended: Counter[str] = Counter()
    wrong_rounds = 0
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as parent:
        made, place = Path(parent) / "made", Path(parent) / "place"
        made.mkdir()
        if args.helpers:
            desk(place := Path(parent) / "undisturbed")
            for _ in range(2):  # the first one may compile
                started = time.perf_counter()
                done = studied(place, [*HELPED[args.study], "--workers", "2", "--force"])
                if done.returncode != 0:
                    raise SystemExit(done.stderr)
            usual_time, undisturbed = time.perf_counter() - started, outcome(place / "study")
            print(f"usual: {usual_time:.1f} s", flush=True)
            for number in range(args.first, args.first + args.count):
                folder = Path(parent) / "place"
                name, status, wrong = helped(number, args.helpers, HELPED[args.study], folder, usual_time, undisturbed)
                ended[status] += 1
                if wrong:
                    wrong_rounds += 1
                    print(f"{number} ({name}): {wrong}", flush=True)
            _report(args, wrong_rounds, ended, begun)
        subprocess.run(
            [sys.executable, "-m", "watchsim", "run", LEVER, "--duration", "0.2 s", "-o", "old"],
            cwd=made, env=environment(), check=True, capture_output=True,
        )  # fmt: skip
        (made / "old" / "mine.txt").write_text("mine")
        names = args.command or list(COMMANDS)
        load({name: COMMANDS[name] for name in names if name not in ALONE}, made, place)
        kinds = [(name, fresh) for name in names for fresh in (True, False) if fresh or name not in ALONE] + [(DEMO, False)] * (
            names == list(COMMANDS)
        )
        usual = {(name, fresh): _usual(COMMANDS_AND_DEMO[name], fresh, made, place) for name, fresh in kinds}
        print({f"{name}{' fresh' * fresh}": round(seconds, 2) for (name, fresh), seconds in usual.items()}, flush=True)
        for number in range(args.first, args.first + args.count):
            name, status, wrong = one(number, which, made, usual, place, names)
            ended[status] += 1
            if wrong:
                wrong_rounds += 1
                print(f"{number} ({name}): {wrong}", flush=True)
    _report(args, wrong_rounds, ended, begun)


def _report(args: argparse.Namespace, wrong_rounds: int, ended: Counter[str], begun: float) -> NoReturn:
    took = time.perf_counter() - begun
    print(
        f"{args.count} rounds of {args.signal} from number {args.first}: {wrong_rounds} wrong; "
        f"ended with {dict(sorted(ended.items()))}; {took:.0f} s"
    )
    sys.exit(bool(wrong_rounds))


if __name__ == "__main__":
    main()
