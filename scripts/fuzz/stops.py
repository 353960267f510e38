"""Is anything lost when a command is killed, interrupted or terminated at a random moment?

Starts commands again and again (those of COMMANDS), sends each one a signal at a random moment of its life, and looks at what
it leaves. Rounds are numbered: number k takes the same command, and the same share of that command's usual time, on every
machine. Each fourth one is a process of its own, with an interpreter that starts and loads; the others are copies of a process
that has loaded everything (`Forked`).

KILL: no half file under a final name, no leftover after the next command's sweep, the user's own file is there; each fifth time
the next command is run as well, and must be fine.
INT and TERM: exit status 130 and 143, or 0 where the command had ended before; results readable where there are any, no
traceback, no leftover.
"""

import argparse
import atexit
import contextlib
import io
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

# How are thousands of commands tried in minutes?
#
# Each one in a forked copy of this process, which has loaded everything and run every command once: a fifth of the time of a
# fresh process, half of whose life is loading. What a copy does from its first instruction on is what `watchsim` does.


ROOT = Path(__file__).resolve().parents[2]
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def load(commands: Mapping[str, Sequence[str]], made: Path, place: Path) -> None:
    """Run every command once in this process, each in a copy `place` of the folder `made`: nothing is left to be loaded."""
    from watchsim.cli import main

    before = Path.cwd()
    try:
        for arguments in commands.values():
            os.chdir(before)
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(made, place)
            os.chdir(place)
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
                status = main(list(arguments))
            if status != 0:
                raise SystemExit(f"{' '.join(arguments)}: {status} {said.getvalue()}")
    finally:
        os.chdir(before)


class Forked:
    """A watchsim command in a copy of this process; what it says goes to the file `said`."""

    def __init__(self, arguments: Sequence[str], place: Path, said: Path) -> None:
        self.said = said
        self.returncode: int | None = None
        sys.stdout.flush()
        # Signals wait until the command hears them, as they do for a process whose interpreter has begun with them held back.
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
        self.pid = os.fork()
        if self.pid == 0:
            self._become(arguments, place)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)

    def _become(self, arguments: Sequence[str], place: Path) -> None:
        try:
            atexit._clear()  # what is to be done at the end of the parent is not to be done here
            os.chdir(place)
            output = os.open(self.said, os.O_CREAT | os.O_WRONLY | os.O_TRUNC)
            os.dup2(output, 1)
            os.dup2(output, 2)
            sys.argv = ["watchsim", *arguments]
            from watchsim.process import process

            process()
        finally:
            os._exit(99)

    def poll(self) -> int | None:
        """The exit status, as of a subprocess; None while it runs."""
        if self.returncode is None:
            number, status = os.waitpid(self.pid, os.WNOHANG)
            self._ended(status if number else None)
        return self.returncode

    def send_signal(self, which: int) -> None:
        if self.poll() is None:
            os.kill(self.pid, which)

    def communicate(self) -> tuple[str, str]:
        """Wait for the end; what was said."""
        if self.returncode is None:
            self._ended(os.waitpid(self.pid, 0)[1])
        return self.said.read_text(errors="replace"), ""

    def _ended(self, status: int | None) -> None:
        if status is not None:
            self.returncode = os.waitstatus_to_exitcode(status)


sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

LEVER = str(ROOT / "profiles" / "bench_lever")
LONG = "2 s"
STATUS = {signal.SIGKILL: -9, signal.SIGINT: 130, signal.SIGTERM: 143}
PF_EXITING = 4  # Linux, include/linux/sched.h
FRESH = 4  # each so many-th round is a process of its own
COMMANDS = {
    "run": ["run", LEVER, "--duration", LONG, "-o", "new"],
    "long": ["run", LEVER, "--duration", "60 s", "--record", "all", "--no-plots", "-o", "new"],
    "steps": ["run", LEVER, "--duration", "0.3 s", "--method=moreau", "--no-plots", "--set", "run.tolerance=1e-6", "-o", "new"],
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
    args = parser.parse_args()
    which = getattr(signal, f"SIG{args.signal}")
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have switched it off for what runs behind
    ended: Counter[str] = Counter()
    wrong_rounds = 0
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as parent:
        made, place = Path(parent) / "made", Path(parent) / "place"
        made.mkdir()
        subprocess.run(
            [sys.executable, "-m", "watchsim", "run", LEVER, "--duration", "0.2 s", "-o", "old"],
            cwd=made, env=environment(), check=True, capture_output=True,
        )  # fmt: skip
        (made / "old" / "mine.txt").write_text("mine")
        names = args.command or list(COMMANDS)
        load({name: COMMANDS[name] for name in names if name not in ALONE}, made, place)
        kinds = [(name, fresh) for name in names for fresh in (True, False) if fresh or name not in ALONE]
        kinds += [(DEMO, False)] * (names == list(COMMANDS))
        usual = {(name, fresh): _usual(COMMANDS_AND_DEMO[name], fresh, made, place) for name, fresh in kinds}
        print({f"{name}{' fresh' * fresh}": round(seconds, 2) for (name, fresh), seconds in usual.items()}, flush=True)
        for number in range(args.first, args.first + args.count):
            name, status, wrong = one(number, which, made, usual, place, names)
            ended[status] += 1
            if wrong:
                wrong_rounds += 1
                print(f"{number} ({name}): {wrong}", flush=True)
    took = time.perf_counter() - begun
    print(
        f"{args.count} rounds of {args.signal} from number {args.first}: {wrong_rounds} wrong; "
        f"ended with {dict(sorted(ended.items()))}; {took:.0f} s"
    )
    sys.exit(bool(wrong_rounds))


if __name__ == "__main__":
    main()
