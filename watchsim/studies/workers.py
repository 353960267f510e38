"""What does a worker process do?

It is given the question once, answers one point after another, and ends with the process that started it.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import logging
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import connection
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Protocol

from watchsim import stopping
from watchsim.results.tables import plain
from watchsim.scene.scene import Scene
from watchsim.storage.write import real, reason, write_file
from watchsim.studies.axes import Value
from watchsim.studies.point import Question, Row, answer

# Who does the work of a study?
#
# One seam: something that answers numbered points of a question, in whatever order. In this process, in processes of this
# machine
# (concurrent.futures), or on a cluster (dask.distributed, the extra `cluster`).

Points = Sequence[tuple[int, Mapping[str, Value]]]
LOOK = 0.2  # s between looks at whether somebody wants to stop
AHEAD = 3  # points handed out per worker before one is finished


class WorkersLost(RuntimeError):
    """Those who worked were ended from outside."""


class Executor(Protocol):
    """Answers points; ends early, without the rows that are not finished, once `interrupted()` is true."""

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        """(number, row) of every point, as they are finished."""


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


def finished(future: Any) -> tuple[int, Row] | None:
    """What a future of `worker.work` has made; None for a point that was cut short."""
    made: tuple[int, Row] | None = future.result()
    return made


# In this process, in several, or on a cluster?


def chosen(workers: int, scheduler: str | None) -> Executor:
    """The executor for so many processes, or for the cluster with a scheduler at that address."""
    if scheduler is not None:
        return Cluster(scheduler)
    if workers <= 1:
        return Here()

    return Processes(workers)


# How do the machines of a cluster share the points of a study?
#
# Through dask.distributed, the extra `cluster`: a scheduler that somebody has started, and workers on which this package is
# installed. Workers may come and go: a point whose worker has gone is computed again by another one.

TIMEOUT = 10.0  # s to reach the scheduler
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
            for name in ("distributed", "tornado", "asyncio"):
                logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        try:
            self._client = distributed.Client(address, timeout=TIMEOUT, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ValueError(f"--scheduler {address}: no scheduler answers there ({error})") from error

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        waiting = list(reversed(points))
        under_way: dict[Any, Any] = {}  # what was promised -> its point
        try:
            while (waiting or under_way) and not interrupted():
                room = AHEAD * self._threads(interrupted) - len(under_way)
                for _ in range(min(room, len(waiting))):
                    number, changes = waiting.pop()
                    # With the question in each: what lies on a worker for all of them is lost with that worker.
                    future = self._client.submit(_work, number, question, dict(changes), pure=False)
                    under_way[future] = number, changes
                done = [future for future in under_way if future.done()]
                for future in done:
                    if future.status in GONE:
                        waiting.append(under_way.pop(future))
                        continue
                    try:
                        made = future.result(timeout=GATHERED)
                    except (self._distributed.CancelledError, self._distributed.TimeoutError):
                        continue  # its worker has gone since: it is cancelled now, or computed again
                    del under_way[future]
                    yield made
                if not done:
                    time.sleep(LOOK)
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
            time.sleep(LOOK)
        return 0

    def _lost(self) -> WorkersLost:
        return WorkersLost(f"the scheduler at {self._address} was lost and has not come back")


def _work(number: int, question: Question, changes: dict[str, float | str]) -> tuple[int, Row]:
    """What a worker of the cluster does."""
    return number, answer(question, changes)


# What of a study is kept if the machine is switched off now?
#
# A folder's `rows.jsonl`: first what the study is, then every finished row on a line of its own, on the disk before the next
# one.
# Whoever goes on reads it; a last line that was cut off is left out. A row that cannot be written, as on a full disk, is
# written
# with the next one, and the study goes on.

NAME = "rows.jsonl"
FIGURES = (".png", ".svg", ".pdf")
FILES = ("sweep.json", "sweep.csv", "sweep.parquet", *(f"sweep{ending}" for ending in FIGURES))  # made of the rows

Study = dict[str, Any]


def scene_digest(scene: Scene) -> str:
    """Of everything the scene says and of its drawings."""
    digest = hashlib.sha256(json.dumps(plain(scene.source), sort_keys=True, default=str).encode())
    for name in sorted(scene.drawings):
        digest.update(name.encode() + hashlib.sha256(scene.drawings[name]).digest())
    return digest.hexdigest()[:16]


class Journal:
    """Rows by their number. Use it in a `with` statement."""

    def __init__(self, folder: Path, study: Study, resume: bool) -> None:
        """`study` says what is computed; ValueError where `resume` finds another one in the folder, with the difference.

        OSError where it cannot be written; an earlier journal is then still there.
        """
        self.path = real(folder / NAME)
        self.rows: dict[int, Row] = {}
        self._owed = b""  # lines that are not on the disk yet
        self._whole = self._read(study) if resume else 0  # bytes of the file that are whole lines
        if not self._whole:
            first = _line(study)
            write_file(self.path, lambda place: place.write_bytes(first), "the rows")
            self._whole = len(first)
            for name in FILES:  # of the earlier study; what cannot be removed now is replaced or named at the end
                with contextlib.suppress(OSError):
                    (folder / name).unlink()
        try:
            self._file: IO[bytes] = self.path.open("r+b", buffering=0)
        except OSError as error:
            raise type(error)(error.errno, f"could not write the rows to {self.path}: {reason(error)}") from error

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self._write()
        self._file.close()

    def add(self, number: int, row: Row) -> None:
        """Keep one finished row: on the disk when this returns, where that can be written."""
        self.rows[number] = row
        self._owed += _line({"point": number, **row})
        self._write()

    def _write(self) -> None:
        try:
            self._file.seek(self._whole)
            self._file.truncate()
            left = memoryview(self._owed)
            while left:
                left = left[self._file.write(left) or 0 :]
            os.fsync(self._file.fileno())
        except OSError:
            return
        self._whole, self._owed = self._whole + len(self._owed), b""

    def _read(self, study: Study) -> int:
        """Take up the rows that are there; how many bytes of the file are whole lines."""
        if not self.path.is_file():
            return 0
        whole = 0
        for i, line in enumerate(self.path.read_bytes().splitlines(keepends=True)):
            try:
                record = json.loads(line)
            except ValueError:
                break
            if not line.endswith(b"\n"):
                break
            if i == 0:
                _compare(record, plain(study), self.path.parent)
            else:
                self.rows[int(record.pop("point"))] = record
            whole += len(line)
        return whole


def _line(record: Mapping[str, Any]) -> bytes:
    return json.dumps(plain(record), ensure_ascii=False, allow_nan=False).encode() + b"\n"


def _compare(earlier: Study, now: Study, folder: Path) -> None:
    """ValueError with every difference between two studies."""
    differences = [
        f"{name} {_difference(earlier.get(name), now.get(name))}" for name in now if earlier.get(name) != now.get(name)
    ]
    if differences:
        raise ValueError(
            f"--resume {folder}: this folder holds another study: {'; '.join(differences)}. Go on with what it was made with, "
            "or choose another folder."
        )


def _difference(before: Any, now: Any) -> str:
    if isinstance(before, dict) and isinstance(now, dict):
        if list(before) != list(now):
            return f"were {', '.join(before)}, now {', '.join(now)}"
        return "; ".join(f"of {key} {_values(before[key], now[key])}" for key in now if before[key] != now[key])
    if isinstance(now, str) and len(now) == 16:
        return "has changed since"
    return f"was {before}, now {now}"


def _values(before: list[Any], now: list[Any]) -> str:
    return f"were {len(before)} values from {before[0]} to {before[-1]}, now {len(now)} from {now[0]} to {now[-1]}"


# What does a worker process do?

SERVER = "WATCHSIM_SERVER_OF_WORKERS"  # set for the process that workers are forked from
PR_SET_PDEATHSIG = 1  # Linux, include/uapi/linux/prctl.h


class _Work:
    """What this process was given."""

    question: Question
    stop = threading.Event()  # the wish to stop


def begin(question: Question, wish: Any) -> None:
    """Called once in every worker process; `wish` ends when it is to stop. Ctrl-C is heard by the process that started it."""
    _Work.question = question
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        sys.stderr = _WhileHeard(sys.stderr, parent.sentinel)
        threading.Thread(target=_end_with, args=(parent.sentinel, wish), daemon=True).start()
    if sys.platform == "linux":  # also if the server it was forked from is killed
        import ctypes

        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, int(signal.SIGKILL))
        if os.getppid() == 1:
            os._exit(1)


def _end_with(sentinel: Any, wish: Any) -> None:
    """A worker whose starter was killed must not wait for work for ever."""
    if sentinel not in connection.wait([sentinel, wish]):
        _Work.stop.set()
        connection.wait([sentinel])
    os._exit(1)


class _WhileHeard:
    """stderr as long as whoever started this process lives: what fails because it has gone is of no use to anybody."""

    def __init__(self, stream: Any, sentinel: Any) -> None:
        self._stream, self._sentinel = stream, sentinel

    def write(self, words: str) -> int:
        return len(words) if connection.wait([self._sentinel], 0) else int(self._stream.write(words))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def _quiet_when_left(kind: type[BaseException], error: BaseException, place: TracebackType | None) -> None:
    """A worker that is being started while its starter is killed ends without a word."""
    if not issubclass(kind, (EOFError, ConnectionError)):
        sys.__excepthook__(kind, error, place)


if os.environ.pop(SERVER, None):
    sys.excepthook = _quiet_when_left


def work(number: int, changes: Mapping[str, Value]) -> tuple[int, Row] | None:
    """The answer to one point; None where it was cut short."""
    try:
        return number, answer(_Work.question, changes, _Work.stop.is_set)
    except KeyboardInterrupt:
        return None


# How do processes of this machine share the points of a study?
#
# They are forked from a server that has done nothing but import the package (where the system has one), never from a process
# with
# threads; elsewhere they are started anew.

ATTEMPTS = 4  # sets of workers in a row that may be lost without a single row
LOST = "worker processes were ended from outside, perhaps for lack of memory"


class Processes:
    """So many worker processes. Start it under `if __name__ == "__main__":` in scripts, as everything that starts processes."""

    def __init__(self, workers: int) -> None:
        self.workers = workers

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        left, attempts = dict(points), ATTEMPTS
        while left and not interrupted():
            try:
                for number, row in self._by_one_set(question, list(left.items()), interrupted):
                    del left[number]
                    attempts = ATTEMPTS
                    yield number, row
                return
            except (BrokenProcessPool, ConnectionError, EOFError) as error:  # the last two: the server they are forked from
                attempts -= 1
                if not attempts:
                    raise WorkersLost(LOST) from error
                time.sleep(LOOK * (ATTEMPTS - attempts))  # a server that was killed is told from a living one a moment later

    def _by_one_set(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        """The answers of one set of workers; BrokenProcessPool once one of them has been killed."""
        context = start_method()
        # The workers hear the end of a pipe. An event has a lock, which a worker that is killed may take with it.
        hearing, wish = context.Pipe(duplex=False)
        waiting = list(reversed(points))
        count = min(self.workers, len(points))
        pool = ProcessPoolExecutor(count, context, initializer=begin, initargs=(question, hearing))
        under_way: set[Future[Any]] = set()
        try:
            while (waiting or under_way) and not interrupted():
                while waiting and len(under_way) < AHEAD * count:
                    under_way.add(pool.submit(work, *waiting.pop()))
                done, under_way = wait(under_way, LOOK, FIRST_COMPLETED)
                for future in sorted(done, key=lambda future: future.exception() is not None):  # what is finished is kept
                    made = finished(future)
                    if made is not None:
                        yield made
        finally:
            wish.close()
            pool.shutdown(wait=True, cancel_futures=True)
            hearing.close()


def start_method() -> Any:
    """A server to fork from, with the package imported, else new processes."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    if sys.version_info >= (3, 11):  # before, each worker imports the package for itself
        context.set_forkserver_preload(["watchsim.studies.workers"])
        _start_server()
    return context


def _start_server() -> None:
    """With the path of this process: by itself it looks in the current folder first, where another copy may lie."""
    from multiprocessing import forkserver

    path = {
        "PYTHONSAFEPATH": "1",
        "PYTHONPATH": os.pathsep.join(place or os.curdir for place in sys.path),
        "PYTHONWARNINGS": "ignore:resource_tracker:UserWarning",  # after a kill it counts what it clears up
        SERVER: "1",
    }
    before = {name: os.environ.get(name) for name in path}
    os.environ.update(path)
    try:
        forkserver.ensure_running()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
