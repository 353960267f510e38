"""How are thousands of numbered accidents tried? Each in a copy of this process, with little time and memory of its own."""

import argparse
import contextlib
import io
import os
import resource
import signal
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

SECONDS = 20  # of processor time: other work on the machine shall not decide
PATIENCE = 20  # times that, on the clock, before a process counts as hanging
MEMORY = 4 << 30  # bytes
NOTED = 100  # after so many rounds a line says how far it has come
FINE = frozenset(("0", "1", "2", "3", "fine"))  # exit statuses that are no fault, and what is said where there are none


def in_a_process(place: Path, work: Callable[[], str], seconds: int = SECONDS, memory: int = MEMORY) -> tuple[str, float]:
    """(what `work` answers in the folder `place`, or what became of its process; the processor time that it took, s)."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.chdir(place)
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
            signal.alarm(PATIENCE * seconds)
            os.write(writing, work().encode()[:4000])
        except BaseException as error:
            os.write(writing, f"escaped: {type(error).__name__}: {error}".encode()[:4000])
        finally:
            os._exit(0)
    os.close(writing)
    _, status, used = os.wait4(child, 0)
    with os.fdopen(reading) as pipe:
        words = pipe.read()
    if os.WIFSIGNALED(status):
        slow = os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL, signal.SIGALRM)
        words = f"more than {seconds} s of processor time" if slow else f"died of signal {os.WTERMSIG(status)}"
    return words, used.ru_utime + used.ru_stime


def judged(*commands: list[str]) -> str:
    """The exit status of the last command that is reached, each one where the one before was fine, or a fault's report."""
    from watchsim.cli import main

    said, status = io.StringIO(), 0
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        for arguments in commands:
            status = status or main(arguments)
    reports = list(Path().glob("watchsim-fault-*.txt"))
    if status == 4 or "Traceback" in said.getvalue():
        where = [path.read_text()[-600:] for path in reports]
        return "\n".join(("a fault of the program", said.getvalue()[-1500:], *where))
    return str(status)


def campaign(given: argparse.Namespace, one: Callable[[int], tuple[str, str, float]], what: str) -> int:
    """The exit status after the `given` rounds (`add_numbers`): 1 where one failed, unless it is the only one that was wanted.

    one  the name, the outcome (its first line counts) and the seconds of a round; what failed is printed
    """
    kinds: Counter[str] = Counter()
    slowest, start, first = (0.0, -1), time.perf_counter(), -1
    for number in range(given.first, given.first + given.count) if given.only is None else [given.only]:
        name, words, took = one(number)
        first = number if first < 0 else first
        slowest = max(slowest, (took, number))
        kind = words.splitlines()[0] if words else "nothing said"
        kinds[kind] += 1
        if kinds.total() % NOTED == 0:
            print(f"{kinds.total()} done, to number {number}: {dict(sorted(kinds.items()))}", flush=True)
        if kind not in FINE or given.only is not None:
            print(f"{number} ({name}): {words}", flush=True)
    print(
        f"{kinds.total()} {what} from number {first}: {dict(sorted(kinds.items()))}; {time.perf_counter() - start:.0f} s, "
        f"the slowest {slowest[0]:.1f} s (number {slowest[1]})"
    )
    return int(bool(set(kinds) - FINE) and given.only is None)


def add_numbers(parser: argparse.ArgumentParser, count: int) -> None:
    """The options that say which rounds."""
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", type=int, help="repeat this round and say what becomes of it")
