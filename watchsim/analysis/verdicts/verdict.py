"""Does the watch tick, and if not, what does it do instead?

From recorded events, contacts and roles alone, so that it holds for any names, orientation and direction of rotation.

backwards   the wheel turns against its drive, or its drive turns it against its teeth
overbanks   the lever went over while the impulse pin was away; the pin now strikes the fork from outside
stops       the wheel stands: set on lock, on impulse, or the swing is too small to unlock
trips       the wheel passed more teeth than the lever let go, or teeth come to rest on an impulse face
knocks      the impulse pin strikes the outside of the fork near the turning point (rebanking)
unsettled   it ticks, but its amplitude has yet to settle, or the run is too short to tell
ticks       none of these
"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.analysis.timing.beats import Beats, beats
from watchsim.analysis.timing.escape_wheel import missed_beats
from watchsim.analysis.verdicts.backwards import backwards
from watchsim.analysis.verdicts.knocking import knocking, knocks
from watchsim.analysis.verdicts.overbanking import overbanking
from watchsim.analysis.verdicts.settling import unsettled
from watchsim.analysis.verdicts.standing import standing
from watchsim.analysis.verdicts.tripping import tripping
from watchsim.analysis.verdicts.verdict_kinds import NOTHING, TICKS, Verdict, when
from watchsim.analysis.verdicts.watch import Watch, watch_of
from watchsim.scene.roles import swings
from watchsim.simulation.record.trajectory import Trajectory

# In this order: what comes first is the cause of what comes after it.
QUESTIONS = (backwards, overbanking, standing, tripping, knocking, unsettled)


def verdict(run: Trajectory, found: Beats | None = None) -> Verdict:
    """What the watch of a run does at its end; `found` are its beats, where already at hand.

    Its name is None where nothing keeps time: no oscillator, or no driven wheel that keeps it going. A run whose rows were
    not kept is judged by its events alone, as far as these go.
    """
    if not swings(run.scene):
        return NOTHING
    watch = watch_of(run, beats(run) if found is None else found)
    return NOTHING if watch is None else _judged(watch)


def _judged(watch: Watch) -> Verdict:
    for question in QUESTIONS:
        answer = question(watch)
        if answer is not None:
            return answer
    return Verdict(TICKS, "the watch ticks" + "".join(f", {one}" for one in _but(watch)))


def _but(watch: Watch) -> Iterator[str]:
    """What did not go well before."""
    blows = knocks(watch)
    if len(blows):
        yield f"after it knocked until {when(float(blows['t'][-1]))}"
    missed = missed_beats(watch.run, watch.wheel, watch.found)
    if missed:
        yield f"but missed {missed} {'beat' if missed == 1 else 'beats'}"
