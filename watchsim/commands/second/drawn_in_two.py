"""How are plots drawn on two cores?

The process that has all that they need makes a copy of itself, which draws one of them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import IO

from watchsim.commands.common.run_pictures import Draw, Draws
from watchsim.storage.handed_over import memory_file


def drawn(draws: Draws) -> dict[str, IO[bytes]]:
    """The plots, each in a file without a name; the last one is drawn by a copy of this process, if it can."""
    if not draws:
        return {}
    files = {name: memory_file() for name in draws}
    *others, last = draws
    copied = _copy(lambda: _draw(draws[last], files[last])) if others else None
    for name in others:
        _draw(draws[name], files[name])
    if copied is None or os.waitpid(copied, 0)[1] != 0:
        files[last] = memory_file()
        _draw(draws[last], files[last])
    return files


def _draw(draw: Draw, file: IO[bytes]) -> None:
    draw(file)
    file.flush()


def _copy(work: Callable[[], None]) -> int | None:
    """The number of a copy of this process that does `work` and goes; None where there is no room for one."""
    try:
        child = os.fork()
    except OSError:
        return None
    if child == 0:
        status = 1
        try:
            work()
            status = 0
        finally:
            os._exit(status)
    return child
