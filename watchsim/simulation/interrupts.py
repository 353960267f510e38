"""How does Ctrl-C end a run between two slices, and never in the middle of keeping what it has made?"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from watchsim import stopping

_USUAL = signal.default_int_handler


@contextmanager
def held_interrupts() -> Iterator[Callable[[], bool]]:
    """Within, the first Ctrl-C is only remembered: the function handed out says whether it came. A second one raises.

    In a process of the command line SIGTERM is heard alike (see stopping.py). Where somebody else listens to the signal, or
    outside the main thread, everything stays as it is.
    """
    if stopping.installed():
        with stopping.held() as requested:
            yield lambda: requested() != 0
        return
    came = threading.Event()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGINT) is not _USUAL:
        yield came.is_set
        return

    def remember(number: int, frame: FrameType | None) -> None:
        if came.is_set():
            _USUAL(number, frame)
        came.set()

    signal.signal(signal.SIGINT, remember)
    try:
        yield came.is_set
    finally:
        signal.signal(signal.SIGINT, _USUAL)
