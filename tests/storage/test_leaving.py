"""Does a process that ends at once take its scratch folders with it, and nothing else, whatever its main thread is doing?"""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from watchsim.storage import write as scratch
from watchsim.storage.write import write_file, write_folder

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="forks")


def left_by(root: Path, work: Callable[[Path], object], after: float) -> None:
    """Have a process do `work` again and again, and another thread of it leave at once after so many seconds."""
    child = os.fork()
    if child == 0:
        try:
            threading.Timer(after, lambda: (scratch.abandon(), os.kill(os.getpid(), signal.SIGKILL))).start()
            while True:
                work(root)
        finally:
            os._exit(0)
    os.waitpid(child, 0)


def many(place: Path) -> None:
    for number in range(20):
        (place / f"{number}.txt").write_text("new")


@pytest.mark.parametrize(
    "work",
    [
        lambda root: scratch.make(root).close(),
        lambda root: write_file(root / "a.txt", lambda path: path.write_text("new"), "a text"),
        lambda root: write_folder(root / "out", many, lambda _: True, "the results"),
    ],
    ids=["probe", "file", "folder"],
)
@pytest.mark.parametrize("rounds", [9, pytest.param(30, marks=pytest.mark.slow)])
def test_nothing_is_left_and_nothing_lost(tmp_path: Path, work: Callable[[Path], object], rounds: int) -> None:
    for number in range(rounds):
        root = tmp_path / str(number)
        (root / "out").mkdir(parents=True)
        many(root / "out")
        left_by(root, work, 0.002 + 0.021 * number / rounds)
        assert not list(root.glob(f"{scratch.PREFIX}*")), number
        assert len(list((root / "out").iterdir())) == 20


def test_whoever_makes_a_scratch_folder_waits_for_the_end(tmp_path: Path) -> None:
    """Once the process is leaving, its main thread makes no more of them."""
    with scratch.guard:
        thread = threading.Thread(target=lambda: scratch.make(tmp_path).close(), daemon=True)
        thread.start()
        time.sleep(0.05)
        assert not list(tmp_path.iterdir()) and thread.is_alive()
    thread.join(5.0)
    assert not thread.is_alive() and not list(tmp_path.iterdir())
