"""How does a second process work beside the one that steps a run?

It is a copy of that process, made when what both need is loaded. On a core of its own it loads what the first need not wait
for, is given the events and rows of the run as they settle, and gives back what it has made of them (see `made_beside`). A
thread would keep the loop waiting for Python.
"""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import signal
import socket
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NoReturn

from watchsim import stopping
from watchsim.commands.second.settled import Passed

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

    from numpy.typing import NDArray

    from watchsim.commands.common.run_pictures import Draws
    from watchsim.scene.scene import Scene
    from watchsim.simulation.record.trajectory import Pair, Trajectory

QUEUE = 1 << 14  # bytes of the socket, in which some forty messages wait; who is further behind is left behind


class SecondProcess:
    """The other process, as the first one sees it. Whatever goes wrong with it is done by the first instead."""

    def __init__(self, child: int, line: socket.socket) -> None:
        self._child, self._line = child, line
        self._lost, self._knows_pairs = False, False
        self._passed = Passed()
        self._answers: list[Any] = []
        self._thread: ThreadPoolExecutor | None = None

    def prepare(self, scene: Scene, folder: Path, duration: float, method: str, tolerance: float) -> None:
        """What is to be run, until when (s) and how, for results in `folder`."""
        from watchsim.storage.write import real

        self._send(scene, real(folder).parent, duration, method, tolerance)

    def follow(self, pairs: Sequence[Pair], events: NDArray[Any], rows: Sequence[NDArray[Any]]) -> None:
        """The next events and rows of the run, as `simulate` gives them."""
        self._send(None if self._knows_pairs else pairs, events, rows)
        self._knows_pairs = True
        self._passed.add(events, rows)

    def finish(self, run: Trajectory) -> None:
        """The whole run: from now on plots are drawn."""
        import dataclasses

        self._send(self._passed.rest(dataclasses.replace(run, end_state=None, failure=None)))

    def phases(self) -> dict[bytes, str]:
        """The rows of phases.csv that it has made, see `beat_tables.phases_csv`."""
        found: dict[bytes, str] = self._answer(0) or {}
        return found

    def events(self) -> IO[bytes] | None:
        """events.csv, in a file without a name."""
        found: IO[bytes] | None = self._answer(1)
        return found

    def drawn(self, draws: Draws) -> Draws:
        """The same plots as it draws them; by `draws` those that it could not."""

        def written(name: str, target: Path | IO[bytes]) -> None:
            pictures: dict[str, IO[bytes]] = self._answer(2) or {}
            if name not in pictures or not isinstance(target, Path):
                draws[name](target)
                return
            pictures[name].seek(0)
            with target.open("wb") as file:
                shutil.copyfileobj(pictures[name], file)

        return {name: functools.partial(written, name) for name in draws}

    def end(self) -> None:
        """Have it go, done or not."""
        if self._thread is not None:
            self._thread.shutdown(cancel_futures=True)
        self._line.close()
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._child, signal.SIGKILL)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self._child, os.WNOHANG)

    def _send(self, *values: object) -> None:
        """In a thread, since it is mostly writing, for which nobody need wait."""
        from concurrent.futures import ThreadPoolExecutor

        self._thread = self._thread or ThreadPoolExecutor(1, thread_name_prefix="second process")
        self._thread.submit(self._hand_over, values)

    def _hand_over(self, values: object) -> None:
        from watchsim.storage.handed_over import hand_over

        if self._lost:
            return
        try:
            hand_over(self._line, values)
        except Exception:  # it has gone or is far behind, memory or files are used up, or something cannot be pickled
            self._lost = True

    def _answer(self, number: int) -> Any:
        """One of the things that it gives back, in their order; waits for it. None where it has gone."""
        from watchsim.storage.handed_over import take_over

        if self._thread is not None:
            self._thread.shutdown()  # once all was said
            self._thread = None
        while not self._lost and len(self._answers) <= number:
            try:
                self._answers.append(take_over(self._line))
            except Exception:
                self._lost = True
        return self._answers[number] if number < len(self._answers) else None


@contextlib.contextmanager
def second_process(wanted: bool = True) -> Iterator[SecondProcess | None]:
    """Another process, as long as the context lasts; None where it is not `wanted`, not safe, or of no use.

    Only processes of the command line are copied, on Linux (macOS forbids it), and only where there is a second core.
    """
    made = _made() if wanted and stopping.installed() and sys.platform == "linux" and _cores() > 1 else None
    try:
        yield made
    finally:
        if made is not None:
            made.end()


def _cores() -> int:
    """On how many this process may run."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1


def _made() -> SecondProcess | None:
    """The copy; None where there is no room for another process."""
    _load()
    try:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    except OSError:
        return None
    ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, QUEUE)
    held = signal.pthread_sigmask(signal.SIG_BLOCK, set(signal.Signals))
    try:
        child = os.fork()
        if child == 0:
            ours.close()
            _work(theirs)
    except OSError:
        ours.close()
        return None
    finally:
        theirs.close()
        signal.pthread_sigmask(signal.SIG_SETMASK, held)
    return SecondProcess(child, ours)


def _load() -> None:
    """Load what both processes need: twice at a time the same files take each of them half as long again."""
    import watchsim.mechanism.compile
    import watchsim.results.write_results
    import watchsim.scene.file.load  # noqa: F401


def _work(line: socket.socket) -> NoReturn:
    """What the copy does: signals are for the process that it is a copy of, and so is what there is to say."""
    status = 1
    try:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        nowhere = os.open(os.devnull, os.O_RDWR)
        for number in range(3):
            os.dup2(nowhere, number)
        from watchsim.commands.second.made_beside import work

        work(line)
        status = 0
    finally:
        os._exit(status)
