"""Does every signal stop a command where stopping is safe, with its own status, and with what was simulated on the disk?"""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from interpreter import ROOT

from watchsim.paths import profiles_dir
from watchsim.results.folder import read_results

LEVER = profiles_dir() / "bench_lever"
pytestmark = [pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix"), pytest.mark.usefixtures("heard")]

# A process of the command line in which `moment` is a function of the package before whose call the signal comes.
CODE = """
import importlib, os, signal, sys, time
home, name, number, times, pause = {home!r}, {name!r}, {number}, {times}, {pause}
from watchsim.stopping import requested
module = importlib.import_module(home)
owner = module
*path, last = name.split(".")
for step in path:
    owner = getattr(owner, step)
original, seen = getattr(owner, last), []
def watched(*args, **kwargs):
    seen.append(None)
    if len(seen) <= times:
        os.kill(os.getpid(), number)
        begun = time.monotonic()  # the signal is heard while this waits
        while time.monotonic() - begun < pause and (len(seen) > 1 or not requested()):
            time.sleep(0.01)
    return original(*args, **kwargs)
setattr(owner, last, watched)
from watchsim.process import process
process()
"""


def stopped(arguments: list[str], home: str, name: str, number: int, times: int = 1) -> subprocess.CompletedProcess[str]:
    """A command that gets the signal as it comes to a function, the first `times` times."""
    code = CODE.format(home=home, name=name, number=int(number), times=times, pause=1.0)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env=environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )


KEPT = [
    ("watchsim.simulation.runner", "Run._slices"),
    ("watchsim.simulation.simulate", "trajectory_of"),
    ("watchsim.analysis.summary", "tables"),
    ("watchsim.results.folder", "_fill"),
    ("watchsim.storage.write", "sync_tree"),
    ("watchsim.storage.write", "sync_name"),
]


NEIGHBOURS = {KEPT[1], KEPT[2], KEPT[4]}  # stopped as what comes after them is


# All three signals have one handler; that each of them reaches it is tried once in short, at night in the loop and while files
# are renamed.
@pytest.mark.parametrize(
    ("home", "name", "number"),
    [pytest.param(*place, signal.SIGINT, marks=[pytest.mark.slow] if place in NEIGHBOURS else []) for place in KEPT]
    + [(*KEPT[0], signal.SIGTERM), (*KEPT[-1], signal.SIGHUP)]
    + [pytest.param(*case, marks=pytest.mark.slow) for case in ((*KEPT[-1], signal.SIGTERM), (*KEPT[0], signal.SIGHUP))],
)
def test_what_was_simulated_is_kept(home: str, name: str, number: int, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    done = stopped(["run", str(LEVER), "--duration", "0.3 s", "--no-plots", "-o", str(folder)], home, name, number)
    assert done.returncode == 128 + number, done.stderr
    assert "Traceback" not in done.stderr
    run = read_results(folder)
    told = json.loads((folder / "summary.json").read_text())
    assert told["simulated_s"] == run.simulated and (len(run.t) > 1) == (run.simulated > 0.0)
    assert (run.simulated < 0.3) == (name == "Run._slices")
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


NOTHING_MADE = [
    ("watchsim.cli", "main"),
    ("watchsim.commands.inputs", "load_scene"),
    ("watchsim.simulation.runner", "Run.warm_up"),
]


@pytest.mark.parametrize(
    ("home", "name", "number"),
    [(*place, signal.SIGINT) for place in NOTHING_MADE]
    + [(*NOTHING_MADE[1], signal.SIGTERM)]
    + [pytest.param(*place, signal.SIGTERM, marks=pytest.mark.slow) for place in NOTHING_MADE[::2]],
)
def test_where_nothing_was_made_it_ends_at_once(home: str, name: str, number: int, tmp_path: Path) -> None:
    done = stopped(["run", str(LEVER), "--duration", "0.3 s", "-o", str(tmp_path / "out")], home, name, number)
    assert done.returncode == 128 + number
    assert done.stderr.strip() == {signal.SIGINT: "Interrupted.", signal.SIGTERM: "Terminated."}[number]
    assert not list(tmp_path.iterdir())


def test_a_second_one_stops_at_once(tmp_path: Path) -> None:
    """In the middle of writing: what stood there stays, and nothing else does."""
    folder = tmp_path / "out"
    arguments = ["run", str(LEVER), "--duration", "0.3 s", "--no-plots", "-o", str(folder)]
    done = stopped([*arguments], "watchsim.results.folder", "json_text", signal.SIGINT, times=2)
    assert done.returncode == 130 and (folder / "summary.json").is_file(), "json_text is called once"
    before = (folder / "trajectory.npz").read_bytes()
    done = stopped([*arguments, "--force"], "watchsim.storage.write", "sync_file", signal.SIGTERM, times=2)
    assert done.returncode == 143
    assert (folder / "trajectory.npz").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.slow
def test_a_movie_under_way_is_given_up(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    home = ("watchsim.render.stage", "Stage.draw")
    done = stopped(["run", str(LEVER), "--duration", "0.3 s", "--movie", "-o", str(folder)], *home, signal.SIGINT)
    assert done.returncode == 130 and not (folder / "movie.mp4").exists()
    assert (folder / "plots" / "kinematics.png").is_file() and (folder / "summary.json").is_file()
    done = stopped(["movie", str(folder), "--window", "0.1 s:0.2 s"], *home, signal.SIGTERM)
    assert done.returncode == 143 and not (folder / "movie.mp4").exists()
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_what_the_shell_has_switched_off_stays_off(tmp_path: Path) -> None:
    """`nohup watchsim run ... &`"""
    code = "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN); signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
    code += CODE.format(home="watchsim.results.folder", name="write_events", number=int(signal.SIGHUP), times=1, pause=0.5)
    arguments = ["run", str(LEVER), "--duration", "0.1 s", "--no-plots", "-o", str(tmp_path / "out")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", code, *arguments], env=environment, cwd=ROOT, capture_output=True, check=False)
    assert done.returncode == 0 and (tmp_path / "out" / "summary.json").is_file()


def test_a_signal_while_the_start_script_goes_on_waits() -> None:
    """Between its import of the entry point and the call, where scripts of installers shorten sys.argv[0]."""
    code = "from watchsim.process import process; import os, signal; os.kill(os.getpid(), signal.SIGINT); process()"
    done = subprocess.run(
        [sys.executable, "-c", code, "check", str(LEVER)],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert (done.returncode, done.stdout) == (130, "") and "Traceback" not in done.stderr
