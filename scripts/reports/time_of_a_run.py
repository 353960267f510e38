"""Where does the time of a whole `watchsim run` go? Prints JSON: what -> seconds of processor time.

    python scripts/reports/time_of_a_run.py profiles/swiss_lever "180 s" FOLDER

Runs the command in this process with clocks around its parts. Packing the motion goes on beside the rest, in a thread of its own.
"""

from __future__ import annotations

import builtins
import functools
import importlib
import json
import os
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any, NoReturn

PARTS = (  # module, name, what
    ("watchsim.simulation.runner", "Run.warm_up", "loading the machine code"),
    ("watchsim.simulation.runner", "Run.to_the_end", "stepping"),
    ("watchsim.analysis.summary", "summary", "summary.json"),
    ("watchsim.analysis.beat_tables", "phases_csv", "phases.csv"),
    ("watchsim.results.tables", "write_events", "events.csv"),
    ("watchsim.results.archive", "write_trajectory", "trajectory.npz, packed beside the rest"),
    ("watchsim.render.figures.kinematics_plot", "Kinematics.__init__", "plots"),
    ("watchsim.render.figures.kinematics_plot", "Kinematics.show", "plots"),
    ("watchsim.render.figures.kinematics_plot", "write_png", "plots"),
)

spent: defaultdict[str, float] = defaultdict(float)  # s
_import = builtins.__import__


class Imports:
    """A clock around every import that no other import asked for."""

    depth = 0

    def __call__(self, *args: Any, **options: Any) -> Any:
        if self.depth:
            return _import(*args, **options)
        self.depth, begun = 1, time.thread_time()
        try:
            module = _import(*args, **options)
        finally:
            self.depth = 0
        spent["importing matplotlib" if "render" in args[0] or "matplotlib" in args[0] else "importing"] += (
            time.thread_time() - begun
        )
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
        begun, before = time.thread_time(), spent["importing"] + spent["importing matplotlib"]
        try:
            return function(*args, **options)
        finally:
            imported = spent["importing"] + spent["importing matplotlib"] - before
            spent[what] += time.thread_time() - begun - imported

    setattr(holder, name, clocked)
    for other in list(sys.modules.values()):  # who has imported it by name already
        if getattr(other, "__name__", "").startswith("watchsim") and getattr(other, name, None) is function:
            setattr(other, name, clocked)


def main() -> None:
    scene, duration, folder = sys.argv[1:4]
    sys.argv = ["watchsim", "run", scene, "--duration", duration, "-o", folder, "--force"]
    leave = os._exit

    def told(status: int) -> NoReturn:
        whole = time.process_time()
        spent["the rest"] = whole - sum(spent.values())
        sys.stderr.write(json.dumps({**spent, "together": whole}))
        sys.stderr.flush()
        leave(status)

    os._exit = told
    builtins.__import__ = Imports()
    from watchsim.process import process

    process()


if __name__ == "__main__":
    main()
