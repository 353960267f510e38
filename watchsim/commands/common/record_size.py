"""How much would a run keep, and what if that is more than memory should hold?

Kept rows and events lie in memory until the run ends, and some three times over while it is written. A run of an hour would
take more than a gigabyte, for curves that nobody looks at. Where nobody has said what to keep, such a run keeps its last
seconds, and the sums over all of it, which are made in any case.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from watchsim.commands.common.console import say
from watchsim.storage.disk import size_text

if TYPE_CHECKING:
    from watchsim.scene.scene import Scene

MOST = 100e6  # bytes that a run keeps unless it was requested: with the program itself less than 500 MB at any time
ROWS, EVENTS = 500, 160  # of a period of an escapement, measured: 395 and 156 (Swiss lever), 479 and 125 (bench lever)
EVENT_BYTES = 52


def record_size(scene: Scene, duration: float) -> float:
    """About how many bytes of rows and events a run of `duration` (s) makes; 0 where nothing swings."""
    from watchsim.mechanism.static_check import COORDINATES
    from watchsim.scene.oscillation import frequency, oscillators

    hertz = frequency(scene) or 0.0
    width = 1 + 3 * sum(COORDINATES[body.motion] for body in scene.bodies)
    return duration * hertz * len(oscillators(scene)) * (ROWS * width * 8 + EVENTS * EVENT_BYTES)


def bounded_record(scene: Scene, duration: float) -> Scene:
    """The scene, its recording bounded where it says nothing about it and would fill the memory; says so."""
    from watchsim.scene.recording import EVERYTHING

    size = record_size(scene, duration)
    if size <= MOST:
        return scene
    if "record" in scene.source.get("run", {}):
        if scene.record == EVERYTHING:
            say(f"Note: all rows of this run may take {size_text(size)} of memory, and three times that while it is written.")
        return scene
    say(
        f"Note: all rows of this run would take some {size_text(size)} of memory, more than {size_text(MOST)}. Kept are its "
        "last seconds, and sums over all of it; --record all keeps everything, --record FROM:TO a window, --record events all "
        "events."
    )
    return scene.set("run.record", "statistics")
