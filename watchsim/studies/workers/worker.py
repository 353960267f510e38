"""What does a worker process do?

It is given the question once, answers one point after another, and ends with the process that started it.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Mapping
from multiprocessing import connection
from typing import Any

from watchsim.studies.axes import Value
from watchsim.studies.point import Question, Row, answer


class _Work:
    """What this process was given."""

    question: Question
    stop: Any = None  # an event: the wish to stop


def begin(question: Question, stop: Any) -> None:
    """Called once in every worker process. Ctrl-C is heard by the process that started it."""
    _Work.question, _Work.stop = question, stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: Any) -> None:
    """A worker whose starter was killed must not wait for work for ever."""
    connection.wait([sentinel])
    os._exit(1)


def work(number: int, changes: Mapping[str, Value]) -> tuple[int, Row] | None:
    """The answer to one point; None where it was cut short."""
    try:
        return number, answer(_Work.question, changes, _Work.stop.is_set)
    except KeyboardInterrupt:
        return None
