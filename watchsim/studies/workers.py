"""Who computes the points of a study?

An executor answers numbered points of a question in whatever order: in this process, in processes of this machine, or on a
cluster (dask.distributed, the extra `cluster`).
"""

from __future__ import annotations

import contextlib
import functools
import logging
import math
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import IO, Any, NoReturn, Protocol

from watchsim import stopping
from watchsim.memory import tidy_seldom
from watchsim.scene.errors import SceneError
from watchsim.studies.axes import Value
from watchsim.studies.point import Question, Row, answer
from watchsim.studies.section import Loop

Points = Sequence[tuple[int, Mapping[str, Value]]]
POLL = 0.2  # s between checks whether the study is to stop


class WorkersLost(RuntimeError):
    """Workers were ended from outside, more often than can be waited for."""


class Executor(Protocol):
    """Answers points; ends early, without the rows that are not finished, once `interrupted()` is true."""

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        """(number, row) of every point, as they are finished."""


def chosen(workers: int, scheduler: str | None) -> Executor:
    """The executor for so many processes, or for the cluster with a scheduler at that address."""
    if scheduler is not None:
        return Cluster(scheduler)
    return Here() if workers <= 1 else Processes(workers)


class Here:
    """One point after another, in this process."""

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        for number, changes in points:
            if interrupted():
                return
            try:
                row = answer(question, changes, interrupted)
            except KeyboardInterrupt:
                if not interrupted():
                    raise
                return
            yield number, row


# Processes of this machine. A thread of each hands it one point after the other through pipes: there is no lock, server or list
# of shared things that could be lost with a process that is killed. Where that is safe they are copies of this process with the
# kernels loaded, made before there are such threads; else, and to replace what was killed, interpreters of their own.

LOSSES = 4  # for each worker: so many may be killed in a row without a single row
MANY = 64  # points that wait: then a process is given one more than it works on
LOST = "worker processes were ended from outside, perhaps for lack of memory"
# With the path of this process: by itself an interpreter looks in the current folder first, where another copy may lie.
BEGIN = "import sys; sys.path[:] = {path!r}; from watchsim.studies.workers import work; work()"


class Processes:
    """So many worker processes."""

    def __init__(self, workers: int) -> None:
        self.workers = workers

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        waiting, made = deque(points), _Made()
        count, left, losses = min(self.workers, len(points)), len(points), 0
        pool = [_served(process, question, waiting, made) for process in _begun(count, question)]
        try:
            while left and not interrupted():
                try:
                    one = made.get(timeout=POLL)
                except queue.Empty:
                    continue
                if isinstance(one, BaseException):
                    raise one
                if one is None:
                    losses += 1
                    if losses == LOSSES * count:
                        raise WorkersLost(LOST)
                    pool.append(_served(_interpreter(), question, waiting, made))
                else:
                    losses, left = 0, left - 1
                    yield one
        finally:
            for process, thread in pool:
                process.kill()
                thread.join()
                process.wait()


_Made = queue.SimpleQueue["tuple[int, Row] | BaseException | None"]  # rows, what went wrong, None: a process was killed


class _Copy:
    """A copy of this process that answers points, with what is used of a `Popen`."""

    def __init__(self, before: Sequence[_Copy]) -> None:
        """`before`: earlier copies, whose pipes this one must not hold open."""
        (read, self_write), (self_read, write) = os.pipe(), os.pipe()
        self.stdin, self.stdout = os.fdopen(self_write, "wb"), os.fdopen(self_read, "rb")
        held = signal.pthread_sigmask(signal.SIG_BLOCK, set(signal.Signals))
        try:
            self._number = os.fork()
            if self._number == 0:
                _be_copy(read, write, [pipe for one in (*before, self) for pipe in (one.stdin, one.stdout)])
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, held)
            os.close(read)
            os.close(write)

    def kill(self) -> None:
        """End it."""
        with contextlib.suppress(OSError):
            os.kill(self._number, signal.SIGKILL)

    def wait(self) -> None:
        """Until it has ended."""
        os.waitpid(self._number, 0)


def _be_copy(read: int, write: int, others: Sequence[IO[bytes]]) -> NoReturn:
    """What the copy does, until this process has gone."""
    with contextlib.suppress(BaseException):
        stopping.leave_to_first()
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        os.setsid()
        for pipe in others:
            os.close(pipe.fileno())
        os.dup2(read, 0)
        os.dup2(write, 1)
        work()
    os._exit(1)


_Process = subprocess.Popen[bytes] | _Copy


def _begun(count: int, question: Question) -> Sequence[_Process]:
    """So many worker processes."""
    if not stopping.may_fork() or count < 2:
        return [_interpreter() for _ in range(count)]
    with contextlib.suppress(SceneError):  # which its points have to say
        Loop(question.scene, question.tolerance or question.scene.tolerance).warm_up()
    copies: list[_Copy] = []
    for _ in range(count):
        copies.append(_Copy(copies))
    return copies


def _interpreter() -> subprocess.Popen[bytes]:
    """A worker process of its own. Ctrl-C is for the process that started it, hence the own session."""
    path = [os.path.abspath(place) for place in sys.path]  # noqa: PTH100 - "" is the current folder
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-c", BEGIN.format(path=path)], stdin=pipe, stdout=pipe, start_new_session=True)


def _served(
    process: _Process, question: Question, waiting: deque[tuple[int, Mapping[str, Value]]], made: _Made
) -> tuple[_Process, threading.Thread]:
    """A worker process and the thread that serves it."""
    thread = threading.Thread(target=_serve, args=(process, question, waiting, made), daemon=True)
    thread.start()
    return process, thread


def _serve(process: _Process, question: Question, waiting: deque[tuple[int, Mapping[str, Value]]], made: _Made) -> None:
    """Have points computed until none waits; those that a killed process had wait again."""
    assert process.stdin and process.stdout
    given: deque[tuple[int, Mapping[str, Value]]] = deque()
    try:
        pickle.dump(question, process.stdin)
        while True:
            # Where many wait the process has the next one already: between two it would stand for a fiftieth of a short one.
            while waiting and len(given) < (2 if len(waiting) > MANY else 1):
                with contextlib.suppress(IndexError):  # another thread took the last one
                    given.append(waiting.popleft())
                    pickle.dump(given[-1], process.stdin)
            if not given:
                break
            process.stdin.flush()
            made.put(pickle.load(process.stdout))
            given.popleft()
    except (OSError, EOFError, pickle.UnpicklingError):
        waiting.extend(given)
        made.put(None)
    with contextlib.suppress(OSError):
        process.stdin.close()
    process.stdout.close()


def work() -> None:
    """What a worker process does: points in, rows out, until the process that started it has gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    tidy_seldom()
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what is printed does not belong among the rows
    given: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(given,), daemon=True).start()
    question = given.get()
    while True:
        number, changes = given.get()
        made: tuple[int, Row] | BaseException
        try:
            made = number, answer(question, changes)
        except Exception as error:
            made = RuntimeError(f"{error!r} in a worker process\n{traceback.format_exc()}")
        try:
            pickle.dump(made, out)
            out.flush()
        except OSError:
            os._exit(1)


def _receive(given: queue.SimpleQueue[Any]) -> None:
    """The end of the pipe, also in the middle of a point, is the end of this process."""
    try:
        with os.fdopen(0, "rb", closefd=False) as points:
            while True:
                given.put(pickle.load(points))
    finally:
        os._exit(1)


# A cluster has a scheduler that somebody has started, and workers on which this package is installed. Workers may come and go:
# a point whose worker has gone is computed again by another one.

AHEAD = 3  # batches handed out per thread of a worker before one is finished
BATCH = 1.0  # s that the points of a batch take: each batch costs the cluster and this process some ms
TIMEOUT = 10.0  # s to reach the scheduler
RECOUNT = 2.0  # s between looks at how many workers there are
PATIENCE = 60.0  # s without any worker
GATHERED = 2.0  # s that a finished row may take to arrive, before it is asked for again
GONE = "cancelled", "lost"  # whoever had the point, or its row, has gone


class Cluster:
    """The workers of the scheduler at an address such as "tcp://127.0.0.1:8786"."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise ValueError(
                "--scheduler needs dask.distributed, which is not installed here: pip install 'watchsim[cluster]'"
            ) from None
        self._distributed, self._address = distributed, address
        if stopping.installed():  # what is lost is said in one sentence
            for name in ("distributed", "distributed.client", "tornado", "asyncio"):  # the client has a level of its own
                logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        try:
            self._client = distributed.Client(address, timeout=TIMEOUT, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ValueError(f"--scheduler {address}: no scheduler answers there ({error})") from error

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        if self._client.status == "closed":  # by the end of an earlier question
            self._client = self._distributed.Client(self._address, timeout=TIMEOUT, set_as_default=False)
        waiting, asked = list(reversed(points)), pickle.dumps(question)
        under_way: dict[Any, list[tuple[int, Mapping[str, Value]]]] = {}  # what was promised -> its points
        threads, counted = 0, -math.inf
        size = 1  # points of a batch
        try:
            while (waiting or under_way) and not interrupted():
                if time.monotonic() - counted > RECOUNT or not under_way:
                    threads, counted = self._threads(interrupted), time.monotonic()
                while waiting and len(under_way) < AHEAD * threads:
                    many = min(size, -(-len(waiting) // (AHEAD * threads)))  # towards the end fewer, so that none is idle
                    batch = [waiting.pop() for _ in range(many)]
                    # With the question in each: what lies on a worker for all of them is lost with that worker.
                    future = self._client.submit(_work, asked, batch, pure=False)
                    under_way[future] = batch
                done = [future for future in under_way if future.done()]
                for future in done:
                    if future.status in GONE:
                        waiting += reversed(under_way.pop(future))
                        continue
                    try:
                        made, seconds = future.result(timeout=GATHERED)
                    except (self._distributed.CancelledError, self._distributed.TimeoutError):
                        continue  # its worker has gone since: it is cancelled now, or computed again
                    del under_way[future]
                    size = max(1, int(BATCH * len(made) / max(seconds, 1e-3)))
                    yield from made
                if not done:
                    time.sleep(POLL)
            self._client.cancel(list(under_way))
        except self._distributed.KilledWorker as error:
            raise WorkersLost(f"workers of the cluster were ended from outside: {error}") from error
        except (OSError, RuntimeError) as error:  # among them a client that has closed itself
            if isinstance(error, WorkersLost) or self._client.status == "running":
                raise
            raise self._lost() from error
        finally:
            with contextlib.suppress(OSError, RuntimeError, TimeoutError):
                self._client.close(timeout=GATHERED)

    def _threads(self, interrupted: Callable[[], bool]) -> int:
        """How many points the cluster can compute at once; waits for a scheduler or workers that may come back."""
        since = time.monotonic()
        while not interrupted():
            if self._client.status == "closed":
                raise self._lost()
            if self._client.status == "running":
                with contextlib.suppress(OSError, TimeoutError):
                    if threads := sum(self._client.ncores().values()):
                        return threads
            if time.monotonic() - since > PATIENCE:
                raise WorkersLost(f"the cluster at {self._address} has had no worker for {PATIENCE:g} s")
            time.sleep(POLL)
        return 0

    def _lost(self) -> WorkersLost:
        return WorkersLost(f"the scheduler at {self._address} was lost and has not come back")


def _work(asked: bytes, batch: Points) -> tuple[list[tuple[int, Row]], float]:
    """What a worker of the cluster does; with the seconds it took."""
    question, begin = _question(asked), time.monotonic()
    return [(number, answer(question, changes)) for number, changes in batch], time.monotonic() - begin


@functools.lru_cache(maxsize=2)
def _question(asked: bytes) -> Question:
    """The same for all its points: what was found of its scene need not be found again."""
    tidy_seldom()
    question: Question = pickle.loads(asked)
    return question
