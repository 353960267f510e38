"""How do the machines of a cluster share the points of a study?

Through dask.distributed, the extra `cluster`: a scheduler that somebody has started, and workers on which this package is
installed. Workers may come and go: a point whose worker has gone is computed again by another one.
"""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Callable, Iterator
from typing import Any

from watchsim import stopping
from watchsim.studies.point import Question, Row, answer
from watchsim.studies.workers.executor import AHEAD, LOOK, Points, WorkersLost

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
