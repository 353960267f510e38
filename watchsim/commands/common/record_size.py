"""How much will a run record, and where is that held until it is written?

Rows and events lie in memory while they are few. What is more goes to files without a name beside the results, so that a run of
hours takes no more memory than one of minutes, and keeps the same.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.common.console import say
from watchsim.storage.destination import LEAST_ROOM
from watchsim.storage.disk import size_text

if TYPE_CHECKING:
    from watchsim.scene.recording import Recording
    from watchsim.scene.scene import Scene

ROWS, EVENTS = 500, 160  # of a period of an escapement, measured: 395 and 156 (Swiss lever), 479 and 125 (bench lever)
EVENT_BYTES = 52
WORTH_A_NOTE = 64e6  # bytes on the disk that somebody may want to know of before a run
WRITTEN = 2.7  # times what is recorded: the files in which it is held, the archive, and the tables of events and phases


def record_size(scene: Scene, duration: float) -> float:
    """About how many bytes of rows and events are kept of a run of `duration` (s); 0 where nothing swings."""
    from watchsim.mechanism.static_check import COORDINATES
    from watchsim.scene.oscillation import frequency, oscillators

    hertz = frequency(scene) or 0.0
    width = 1 + 3 * sum(COORDINATES[body.motion] for body in scene.bodies)
    rows, events = kept_times(scene.record, duration)
    return hertz * len(oscillators(scene)) * (rows * ROWS * width * 8 + events * EVENTS * EVENT_BYTES)


def kept_times(record: Recording, duration: float) -> tuple[float, float]:
    """For how long (s) rows are kept, but for the last seconds, and for how long events."""
    from watchsim.scene.recording import STATISTICS

    inside = sum(max(0.0, min(stop, duration) - max(start, 0.0)) for start, stop in record.row_windows)
    return min(inside, duration) / record.stride, inside if record.keep == STATISTICS else duration


def room_for(scene: Scene, duration: float, folder: Path) -> float:
    """The bytes that the disk of `folder` should have; says so where they are many."""
    from watchsim.storage.columns import MOST

    size, in_memory = record_size(scene, duration), 2.0 * MOST  # of rows and of events
    if size > WORTH_A_NOTE:
        say(
            f"Note: rows and events of this run take some {size_text(size)}. More than {size_text(in_memory)} are not held in "
            f"memory but in files beside {folder}, until the results are written. --record statistics keeps the last seconds "
            'and sums over the whole run, --record "every 10" every tenth row, --record FROM:TO a window.'
        )
    return max(LEAST_ROOM, WRITTEN * size)
