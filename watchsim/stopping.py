"""What happens at Ctrl-C, at SIGTERM, and when the terminal is closed?

Nothing in the middle of anything: an exception thrown between any two instructions would be lost in a destructor, or leave
half of something. A thread hears the signal. Where nothing is to be kept (loading, compiling, drawing) it ends the process at
once; where something is, it only notes the wish, and whoever keeps looks at `requested` where stopping is safe. A second signal
ends the process in any case.

Used by the command line only; in other people's processes signals are theirs.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from typing import NoReturn, TypeVar

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
MARK = 0  # among the numbers of signals: all that came before has been heard
PATIENCE = 1.0  # s that a thread may take to hear
WORDS = {"SIGINT": "Interrupted.", "SIGTERM": "Terminated.", "SIGHUP": "Hung up."}

Hook = TypeVar("Hook", bound=Callable[[], None])


class _Listener:
    """What has come so far, and whether anything is to be kept."""

    def __init__(self) -> None:
        self.number = 0  # of the signal that came
        self.holds = 0
        self.sticky = False
        self.installed = False
        self.lock = threading.Lock()
        self.hooks: list[Callable[[], None]] = []
        self.wakeup: int | None = None  # where the numbers of signals are written to
        self.up_to_date = threading.Event()  # all that came before the mark has been heard


_listener = _Listener()


def install() -> None:
    """Hear the signals from now on, but for those that whoever started the process has switched off (nohup, &)."""
    read, wakeup = _ends()
    _listener.installed, _listener.wakeup = True, wakeup
    signal.set_wakeup_fd(wakeup, warn_on_full_buffer=False)
    for number in _numbers():
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _leave_it_to_the_thread)
    threading.Thread(target=_listen, args=(read,), daemon=True, name="signals").start()


def _write(number: int, content: bytes) -> None:
    """Write to what `_ends` gave."""
    if os.name != "nt":
        os.write(number, content)
        return
    import socket

    with contextlib.closing(socket.socket(fileno=number)) as sender:
        sender.send(content)
        sender.detach()


def _ends() -> tuple[Callable[[], bytes], int]:
    """What waits for the numbers of signals, and the number of the file that Python is to write them to."""
    if os.name != "nt":
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        return lambda: os.read(reading, 64), writing
    import socket

    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    number = sender.detach()
    return lambda: receiver.recv(64), number


def installed() -> bool:
    """True in a process of the command line."""
    return _listener.installed


def requested() -> int:
    """The number of the signal that asks this process to stop; 0 for none."""
    return _listener.number


def last_word() -> int:
    """The number of the signal that came until now, for a process that is done: one on its way to the thread counts, too."""
    if _listener.wakeup is None:
        return _listener.number
    heard = [number for number in _numbers() if signal.getsignal(number) is not signal.SIG_IGN]
    blocks = hasattr(signal, "pthread_sigmask")
    if blocks:
        signal.pthread_sigmask(signal.SIG_BLOCK, heard)
    with contextlib.suppress(OSError):
        _write(_listener.wakeup, bytes([MARK]))
        _listener.up_to_date.wait(PATIENCE)
    late = signal.sigpending() if blocks else set()
    return _listener.number or next((number for number in heard if number in late), 0)


def status() -> int:
    """The exit status that the signal that came asks for: 130 after Ctrl-C, 143 after SIGTERM."""
    return 128 + (_listener.number or signal.SIGINT)


@contextlib.contextmanager
def held() -> Iterator[Callable[[], int]]:
    """Within, something is being made that is to be kept: the first signal is only noted; the function says whether it came."""
    with _listener.lock:
        _listener.holds += 1
    try:
        yield requested
    finally:
        if not _listener.sticky:
            with _listener.lock:
                _listener.holds -= 1


@contextlib.contextmanager
def keeping() -> Iterator[None]:
    """Within, what was once held stays held to the end: it has still to be written."""
    before, _listener.sticky = (_listener.holds, _listener.sticky), True
    try:
        yield
    finally:
        with _listener.lock:
            _listener.holds, _listener.sticky = before


def before_leaving(hook: Hook) -> Hook:
    """Have `hook` called before the process is ended at once."""
    _listener.hooks.append(hook)
    return hook


def may_fork() -> bool:
    """Whether a copy of this process is safe: of the command line, whose threads are known, on Linux (macOS forbids it)."""
    return installed() and sys.platform == "linux"


def leave_to_first() -> None:
    """In a copy of the process: signals are those of the first one, which ends its copies itself."""
    signal.set_wakeup_fd(-1)
    _listener.installed = False
    for number in _numbers():
        signal.signal(number, signal.SIG_IGN if number == signal.SIGINT else signal.SIG_DFL)


def _numbers() -> list[signal.Signals]:
    """Of the signals that there are on this system."""
    return [getattr(signal, name) for name in SIGNALS if hasattr(signal, name)]


def _leave_it_to_the_thread(*_: object) -> None:
    """Python writes the signal's number to the socket only where there is a handler."""


def _listen(read: Callable[[], bytes]) -> None:
    if hasattr(signal, "pthread_sigmask"):  # they are for the main thread, which can then hold them back
        signal.pthread_sigmask(signal.SIG_BLOCK, _numbers())
    while True:
        for number in read():
            if number == MARK:
                _listener.up_to_date.set()
            elif number in _numbers():
                _hear(number)


def _hear(number: int) -> None:
    with _listener.lock:
        if _listener.holds == 0 or _listener.number:
            _leave(number)
        _listener.number = number


def _leave(number: int) -> NoReturn:
    with contextlib.suppress(OSError):
        os.write(2, f"\n{WORDS[signal.Signals(number).name]}\n".encode())
    for hook in _listener.hooks:
        with contextlib.suppress(Exception):
            hook()
    os._exit(128 + number)
