"""What does a worker process do?

It is given the question once, answers one point after another, and ends with the process that started it.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Mapping
from multiprocessing import connection
from types import TracebackType
from typing import Any

from watchsim.studies.axes import Value
from watchsim.studies.point import Question, Row, answer

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
