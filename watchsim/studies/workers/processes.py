"""How do processes of this machine share the points of a study?

They are forked from a server that has done nothing but import the package (where the system has one), never from a process with
threads; elsewhere they are started anew.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from watchsim.studies.point import Question, Row
from watchsim.studies.workers.executor import AHEAD, LOOK, Points, WorkersLost, finished
from watchsim.studies.workers.worker import SERVER, begin, work

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
        context.set_forkserver_preload(["watchsim.studies.workers.worker"])
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
