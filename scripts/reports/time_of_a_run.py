"""Where does the time of a whole `watchsim run` go? Prints JSON: what -> seconds of processor time.

    python scripts/reports/time_of_a_run.py profiles/swiss_lever "180 s" FOLDER

Runs the command in this process with clocks around its parts. Some go on beside others, in threads and in a copy of the
process: they cost time of the processor, but little on the clock where there is a second core.
"""

from __future__ import annotations

import argparse
import builtins
import functools
import importlib
import json
import os
import sys
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any, NoReturn

PARTS = (  # module, name, what
    ("watchsim.simulation.runner", "Run.warm_up", "loading the machine code"),
    ("watchsim.simulation.runner", "Run.to_the_end", "stepping"),
    ("watchsim.analysis.summary", "summary", "summary.json"),
    ("watchsim.analysis.summary", "tables", "beats.csv, phases.csv"),
    ("watchsim.results.tables", "EventLines.add", "events.csv"),
    ("watchsim.commands.common.run_pictures", "empty_panels", "panels of the plots"),
    ("watchsim.render.figures.kinematics_plot", "Kinematics.show", "plots"),
    ("watchsim.render.figures.kinematics_plot", "write_png", "plots"),
    ("watchsim.results.archive", "write_trajectory", "trajectory.npz, written beside the rest"),
    ("watchsim.commands.common.write_run", "_timeline", "the timeline in report.txt"),
)
WHOSE = ("", "a copy: ")  # by how often it was copied

spent: defaultdict[str, float] = defaultdict(float)  # s
_import = builtins.__import__


class Own(threading.local):
    """Of one thread: whether it is importing, and what its imports have taken, s."""

    depth = 0
    importing = 0.0


own = Own()


class Imports:
    """A clock around every import that no other import asked for."""

    def __call__(self, *args: Any, **options: Any) -> Any:
        if own.depth:
            return _import(*args, **options)
        own.depth, begun = 1, time.thread_time()
        try:
            module = _import(*args, **options)
        finally:
            own.depth = 0
        taken = time.thread_time() - begun
        own.importing += taken
        spent["importing"] += taken
        for name, attribute, what in PARTS:
            if name in sys.modules and (name, attribute) not in _clocked:
                _clocked.add((name, attribute))
                _clock(name, attribute, what)
        return module


_clocked: set[tuple[str, str]] = set()


def _clock(module: str, attribute: str, what: str) -> None:
    holder: Any = importlib.import_module(module)
    *path, name = attribute.split(".")
    for part in path:
        holder = getattr(holder, part)
    function: Callable[..., Any] = getattr(holder, name)

    @functools.wraps(function)
    def clocked(*args: Any, **options: Any) -> Any:
        begun, before = time.thread_time(), own.importing
        try:
            return function(*args, **options)
        finally:
            spent[what] += time.thread_time() - begun - (own.importing - before)

    setattr(holder, name, clocked)
    for other in list(sys.modules.values()):  # who has imported it by name already
        if getattr(other, "__name__", "").startswith("watchsim") and getattr(other, name, None) is function:
            setattr(other, name, clocked)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("duration", help='with its unit: "180 s"')
    parser.add_argument("folder", help="for the results; it is written anew")
    asked = parser.parse_args()
    scene, duration, folder = asked.scene, asked.duration, asked.folder
    sys.argv = ["watchsim", "run", scene, "--duration", duration, "-o", folder, "--force"]
    leave, copied = os._exit, os.fork
    beside = tempfile.TemporaryFile("a+")  # noqa: SIM115 - what other processes have spent, a line each
    whose = 0

    def fork() -> int:
        nonlocal whose
        child = copied()
        if child == 0:
            whose += 1
            spent.clear()
        return child

    def told(status: int) -> NoReturn:
        spent["the rest"] = time.process_time() - sum(spent.values())
        if whose:
            beside.write(json.dumps({WHOSE[whose] + what: seconds for what, seconds in spent.items()}) + "\n")
            beside.flush()
            leave(status)
        beside.seek(0)
        for line in sorted(beside, reverse=True):
            spent.update(json.loads(line))
        sys.stderr.write(json.dumps({**spent, "together": sum(spent.values())}))
        sys.stderr.flush()
        leave(status)

    os.fork, os._exit = fork, told
    builtins.__import__ = Imports()
    from watchsim.process import process

    process()


if __name__ == "__main__":
    main()
