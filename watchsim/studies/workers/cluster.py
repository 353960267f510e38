"""How do the machines of a cluster share the points of a study?

Through dask.distributed, the extra `cluster`: a scheduler that somebody has started, and workers on which this package is
installed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from watchsim.studies.point import Question, Row, answer
from watchsim.studies.workers.executor import LOOK, Points, WorkersLost

TIMEOUT = 10.0  # s to reach the scheduler


class Cluster:
    """The workers of the scheduler at an address such as "tcp://127.0.0.1:8786"."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise ValueError(
                "--scheduler needs dask.distributed, which is not installed here: pip install 'watchsim[cluster]'"
            ) from None
        self._distributed = distributed
        try:
            self._client = distributed.Client(address, timeout=TIMEOUT, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ValueError(f"--scheduler {address}: no scheduler answers there ({error})") from error

    def answers(self, question: Question, points: Points, interrupted: Callable[[], bool]) -> Iterator[tuple[int, Row]]:
        client = self._client
        try:
            shared = client.scatter(question, broadcast=True)
            futures = [client.submit(_work, number, shared, dict(changes), pure=False) for number, changes in points]
            ready = self._distributed.as_completed(futures, loop=client.loop, with_results=True)
            while ready.count() and not interrupted():
                if not ready.has_ready():
                    time.sleep(LOOK)
                    continue
                for _, made in ready.next_batch(block=False):
                    yield made
            client.cancel(futures)
        except self._distributed.KilledWorker as error:
            raise WorkersLost(f"workers of the cluster were ended from outside: {error}") from error
        finally:
            client.close()


def _work(number: int, question: Question, changes: dict[str, float | str]) -> tuple[int, Row]:
    """What a worker of the cluster does."""
    return number, answer(question, changes)
