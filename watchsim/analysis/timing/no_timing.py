"""Why does a run give no amplitude, or no rate?"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from watchsim.analysis.timing.beats import Beats
from watchsim.scene.oscillation import oscillators
from watchsim.scene.roles import only_presses
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.half_swings import FEWEST_TURNS, Events
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.storage.columns import rows_where


def why_no_timing(run: Trajectory, found: Beats | None, numbers: Mapping[str, Any], start: float = 0.0) -> str | None:
    """A sentence for people; None where amplitude and rate are known, or where nothing could keep time anyway.

    The averages were taken from `start` (s) on.
    """
    if numbers["amplitude_deg"] is not None and numbers["rate_s_per_d"] is not None:
        return None
    if found is None:
        return _nothing_swings(run)
    if only_presses(run.scene) and not _passages(run, found):
        return None
    what = "rate" if numbers["amplitude_deg"] is not None or not found.angular else "amplitude and rate"
    if numbers["rate_s_per_d"] is not None:
        return f"no amplitude in degrees: {found.body} slides"
    return f"no {what}: {_missing(run, found, start)}"


def _nothing_swings(run: Trajectory) -> str | None:
    scene = run.scene
    if not any(body.motion == "pivot" for body in scene.bodies):
        return None
    hanging = "and there is no gravity" if not any(scene.gravity) else "and none that is not driven hangs beside its pivot"
    return f"no amplitude and rate: no body has a spring, {hanging}"


def _passages(run: Trajectory, found: Beats) -> int:
    """Through the rest position, in the whole run."""
    return int((_own_events(run, found)["kind"] == EventKind.CROSS).sum())


def _own_events(run: Trajectory, found: Beats) -> Events:
    own = [body.name for body in run.scene.bodies].index(found.body)
    return rows_where(run.events, lambda part: part["body"] == own)


def _missing(run: Trajectory, found: Beats, start: float) -> str:
    """What is too little for a period: two passages in one direction and three turning points make one."""
    one = next((one for one in oscillators(run.scene) if one.body == found.body), None)
    if one is not None and one.hertz is None:
        return f"gravity topples {found.body} from its rest position"
    passages, turns = _passages(run, found), int((_own_events(run, found)["kind"] == EventKind.TURN).sum())
    if found.angular and not turns and _went(run, found.body) > math.tau:
        return f"{found.body} goes round instead of swinging"
    if not passages and run.simulated > found.nominal_period:
        return f"{found.body} never passed its rest position"
    if turns < FEWEST_TURNS and run.simulated > 2.0 * found.nominal_period:
        return f"{found.body} turned back {_times(turns)} in {run.simulated:.4g} s"
    if not len(found) and passages and turns >= FEWEST_TURNS:
        return f"{found.body} stays in its rest position"
    need = 2.0 * found.nominal_period
    if run.simulated < need:
        return f"the run of {run.simulated:.4g} s is too short: {found.body} needs {need:.4g} s for two oscillations"
    return f"the last {run.simulated - start:.4g} s hold too few whole swings of {found.body}"


def _went(run: Trajectory, body: str) -> float:
    """How far it has turned from the start to the end, rad."""
    return 0.0 if run.end is None else abs(float(run.end[0][run.slices[body]][0]) - run.scene.body(body).angle)


def _times(count: int) -> str:
    return {0: "not once", 1: "only once", 2: "only twice"}.get(count, f"only {count} times")
