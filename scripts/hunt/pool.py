"""How are many mechanisms judged on all processors, none of them able to stop the hunt?

Compiled code cannot be interrupted from within; a worker that does not answer is killed, its mechanism counts as hanging.
"""

import multiprocessing
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from typing import Any

PATIENCE = 60.0  # s of processor time, for all runs of one mechanism
ASLEEP = 20.0  # times as long on the clock: a busy machine hangs nothing, but what waits for ever uses no processor
Work = Callable[[int], Any]


class _Worker:
    def __init__(self, work: Work) -> None:
        context = multiprocessing.get_context("fork")
        self.line, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, work), daemon=True)
        self.process.start()
        theirs.close()
        self.number, self.since, self.given = -1, 0.0, 0.0

    def give(self, number: int) -> None:
        self.number, self.since, self.given = number, self._processor_time(), time.perf_counter()
        self.line.send(number)

    def hangs(self) -> bool:
        """Has it had its number for too long?"""
        waited = time.perf_counter() - self.given
        return self._processor_time() - self.since > PATIENCE or waited > ASLEEP * PATIENCE

    def _processor_time(self) -> float:
        if self.process.pid is None or not hasattr(time, "clock_gettime"):
            return time.perf_counter()
        return time.clock_gettime((~self.process.pid << 3) | 2)  # clock_getcpuclockid(3) of Linux

    def end(self) -> None:
        self.process.kill()
        self.process.join()


def _serve(line: Connection, work: Work) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # who ends the hunt ends its workers
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        try:
            line.send(work(line.recv()))
        except EOFError:
            return


def answers(numbers: Iterable[int], work: Work, jobs: int) -> Iterator[tuple[int, Any]]:
    """(number, what `work` says of it) in the order in which they come; None where its worker hung or died."""
    waiting = iter(numbers)
    workers: list[_Worker] = []
    for number in _first(waiting, jobs):
        workers.append(_Worker(work))
        workers[-1].give(number)
    while workers:
        ready = wait([worker.line for worker in workers], timeout=1.0)
        for worker in list(workers):
            if worker.line not in ready and not worker.hangs():
                continue
            answer = _answer(worker) if worker.line in ready else None
            yield worker.number, answer
            following = next(waiting, None)
            if answer is None or following is None:
                worker.end()
                workers.remove(worker)
            if following is None:
                continue
            if answer is None:
                workers.append(_Worker(work))
            (workers[-1] if answer is None else worker).give(following)


def _answer(worker: _Worker) -> Any:
    """None where the process died."""
    try:
        return worker.line.recv()
    except EOFError:
        return None


def _first(numbers: Iterator[int], count: int) -> list[int]:
    return [number for _, number in zip(range(count), numbers, strict=False)]
