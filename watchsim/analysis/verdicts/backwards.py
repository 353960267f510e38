"""Does the wheel run the wrong way?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.timing.averages import last_window
from watchsim.analysis.verdicts.running_free import running_free
from watchsim.analysis.verdicts.unlocked import unlocked
from watchsim.analysis.verdicts.verdict_kinds import BACKWARDS, Verdict, torque_text, when
from watchsim.analysis.verdicts.watch import Watch


def backwards(watch: Watch) -> Verdict | None:
    """The wheel went back against its drive in the last window; or it goes the way its teeth do not lean, and nothing locks."""
    return _against_drive(watch) or _against_teeth(watch)


def _against_drive(watch: Watch) -> Verdict | None:
    start, end = last_window(watch.run, watch.found.nominal_period)
    ends = np.array([start, end])
    if not watch.recorded(ends).all():
        return None
    first, last = watch.progress(ends)
    if first - last < 2.0 * watch.least_advance:
        return None
    drive = watch.drive(end)
    words = f"{when(start)}  the watch runs backwards: since then {watch.wheel} has turned by {np.degrees(first - last):.3g}° "
    words += f"against its drive of {torque_text(drive)}"
    return Verdict(BACKWARDS, words, start, watch.wheel, torque=drive)


def _against_teeth(watch: Watch) -> Verdict | None:
    if watch.teeth is None or watch.teeth.direction * watch.direction >= 0.0:
        return None
    free, found = running_free(watch), unlocked(watch)
    if free is not None:
        (t, how), pair = free, None
    elif found:
        t, pair, _ = found[0]
        how = f"they do not lock but push {watch.lever} off its banking ({pair})"
    else:
        return None
    drive = watch.drive(t)
    words = (
        f"{when(t)}  the watch runs backwards: its drive of {torque_text(drive)} turns {watch.wheel} against the lean of its "
        f"teeth; {how}. Change the sign of the torque"
    )
    return Verdict(BACKWARDS, words, t, watch.wheel, pair, drive, len(found) or None)
