"""Did the lever go over while the impulse pin was away?"""

from __future__ import annotations

import numpy as np

from watchsim.analysis.verdicts.equilibrium.in_force import in_force
from watchsim.analysis.verdicts.equilibrium.lever_arms import Arms, arms
from watchsim.analysis.verdicts.verdict_kinds import OVERBANKS, Verdict, degrees, torque_text, when
from watchsim.analysis.verdicts.watch import Watch
from watchsim.simulation.event_kinds import EventKind
from watchsim.storage.columns import rows_where


def overbanking(watch: Watch) -> Verdict | None:
    """The oscillator no longer passes its rest position, since it presses the lever onto the banking it stands at."""
    run = watch.run
    if watch.lever is None or not watch.has_banking:
        return None
    own = [body.name for body in run.scene.bodies].index(watch.oscillator)
    passed = rows_where(run.events, lambda part: (part["body"] == own) & (part["kind"] == EventKind.CROSS))["t"]
    since = float(passed[-1]) if len(passed) else 0.0
    if run.simulated - since < watch.found.nominal_period:
        return None
    met = watch.events(watch.lever, {watch.oscillator}, EventKind.IMPACT, EventKind.CLOSE, EventKind.HANDOVER)
    met = met[met["t"] > since]
    if not len(met) or not watch.recorded(met["t"][-1:])[0]:
        return None
    t, contact = float(met["t"][-1]), int(met["contact"][-1])
    bankings = watch.contacts(watch.lever, watch.fixed)
    banked = [number for number in in_force(run, [t])[0] if number in bankings]
    if not banked or not watch.has_shapes or not _pressed_on(arms(run, watch.compiled, t, [contact, *banked]), watch.lever):
        return None
    over, pair = _went_over(watch), str(run.pairs[contact])
    drive = watch.drive(over)
    angle = degrees(float(watch.angle(watch.oscillator, np.array([t]))[0]) - watch.rest)
    words = (
        f"{when(over)}  the watch overbanks: {watch.lever} went over while {watch.oscillator} was away, which now strikes "
        f"it from outside at {angle} ({pair}); {watch.wheel}, under {torque_text(drive)}, is not unlocked. "
        f"No guard pin or horn kept {watch.lever} at its banking"
    )
    return Verdict(OVERBANKS, words, over, watch.lever, pair, drive)


def _pressed_on(found: Arms, lever: str) -> bool:
    """Does the first contact turn the lever against all others?"""
    turned, *held = (found.of(row, lever)[0] for row in range(len(found.pairs)))
    return all(turned * arm < 0.0 for arm in held)


def _went_over(watch: Watch) -> float:
    """When the lever last left the other half of its way, s; 0 where it never was there."""
    assert watch.lever is not None
    angles = watch.run.q[:, watch.run.slices[watch.lever].start]
    away = np.flatnonzero(np.abs(angles - angles[-1]) > 0.5 * np.ptp(angles))
    return float(watch.run.t[away[-1]]) if len(away) and np.ptp(angles) > 0.0 else 0.0
