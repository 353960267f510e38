"""What does a blow do to the watch: does it go on, how long until it ticks as before, and how much time is lost?

The watch begins with the swing of its limit cycle, where its oscillator begins at a turning point. The case is struck in the
first oscillation after `SETTLING`, at a phase from a passage through rest on, and the run is held against one of the same watch
that is not struck. The blow is that of ISO 1413, whose hammer of 4.43 m/s comes to half a sine of
3100 g over 0.35 ms; other speeds scale its height.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from watchsim import stopping
from watchsim.analysis.timing import Beats, beats, contact_events, involves
from watchsim.analysis.verdict import verdict
from watchsim.analysis.verdict_kinds import OVERBANKS, TICKS, UNSETTLED
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.forces import G, Shock
from watchsim.scene.roles import Roles, loads, roles
from watchsim.scene.scene import EVERYTHING, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.studies.steady import steady

HAMMER, HEIGHT, LASTS = 4.43, 3100.0 * G, 0.35e-3  # m/s, m/s², s: ISO 1413
SETTLING = 1.0  # s before the blow
AFTER = 5.0  # s that are looked at after it
AS_BEFORE = 0.01  # of the amplitude
WORKS = (None, TICKS, UNSETTLED)
FELT_BY_NOTHING = (
    "no body feels a blow: each has its centre of mass on its pivot, and no bearing goes with its load. "
    "Give the lever mass and centre_of_mass (or solids), or bodies [[bearings]]"
)
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True)
class Blow:
    """What one blow does.

    direction_deg  of the acceleration of the case in the movement
    speed_m_s      of the hammer; `phase` of an oscillation, from 0 to 1
    at_s           when it struck
    verdict, message  of the watch at the end of the run (`watchsim.verdict`)
    jewel_ok       False if the lever went over while the impulse pin was out of the fork, for however short a time
    guard_blows    impacts between lever and oscillator away from the lift: guard pin and horns at work
    amplitude_change_deg  the largest difference of an amplitude from that without the blow
    recovery_s     from the blow until all amplitudes are within 1 % of those without it; None if they are not by the end
    lost_s         by how much the watch is late at the end; None where it does not tick as often as without the blow
    rate_s_per_d, rate_without_s_per_d  over the second half of what is looked at, with and without the blow
    """

    direction_deg: float
    speed_m_s: float
    phase: float
    at_s: float
    verdict: str | None
    message: str
    jewel_ok: bool | None
    guard_blows: int
    amplitude_change_deg: float | None
    recovery_s: float | None
    lost_s: float | None
    rate_s_per_d: float | None
    rate_without_s_per_d: float | None

    @property
    def harmless(self) -> bool:
        """True for a watch that goes on, and whose lever never went over."""
        return self.verdict in WORKS and self.jewel_ok is not False


@dataclass(frozen=True, slots=True)
class Unstruck:
    """The run without a blow, and what is asked of all others.

    after    s that are looked at after a blow
    outside  rad or m: how far from rest the oscillator is beyond the lift
    """

    scene: Scene
    run: Trajectory
    found: Beats
    parts: Roles
    after: float
    outside: float

    @property
    def start(self) -> tuple[float, float]:
        """(the first passage after the settling, in the direction of growing coordinates; the period from there), s."""
        up = self.found.end_at > self.found.start_at
        passed = self.found.t[up & (self.found.t >= SETTLING)]
        return float(passed[0]), float(passed[1] - passed[0])


def unstruck(scene: Scene, after: float = AFTER) -> Unstruck:
    """The run that blows are held against; SceneError where no oscillator swings, and where nothing would feel a blow."""
    parts = roles(scene)
    moments = [one.moment for one in loads(scene.bodies)[1]]
    moving = [
        body.motion != "fixed" and (body.motion != "pivot" or any(m)) for body, m in zip(scene.bodies, moments, strict=True)
    ]
    if not any(moving) and not scene.bearings:
        raise SceneError([Fault("bodies", FELT_BY_NOTHING, place="shock")])
    if scene.shocks:
        raise SceneError([Fault("shocks", "the scene has blows of its own: leave them out", place="shock")])
    scene = _on_its_cycle(scene, parts)
    run = simulate(replace(scene, record=EVERYTHING), SETTLING + after + 1.0)
    found = beats(run) if parts.oscillator is not None else None
    if found is None or np.count_nonzero(found.t >= SETTLING) < 4:
        why = "nothing swings after the first second: a blow is compared with a run that goes on"
        raise SceneError([Fault("bodies", why, place="shock")])
    return Unstruck(scene, run, found, parts, after, _outside(scene))


def _outside(scene: Scene) -> float:
    return 0.5 * (scene.lift_angle or math.radians(60.0))


def _on_its_cycle(scene: Scene, parts: Roles) -> Scene:
    """The scene; an oscillator that begins at a turning point beyond the lift is let go where the limit cycle turns."""
    if parts.oscillator is None or parts.lever is None:
        return scene
    body, rest = scene.body(parts.oscillator), _rest(scene, parts)
    if body.motion != "pivot" or any(body.velocity) or not abs(body.angle - rest) > _outside(scene):
        return scene
    try:
        cycle = steady(scene, brief=True)
    except SceneError:  # nothing keeps it going
        return scene
    if cycle.amplitude_deg is None:
        return scene
    turned = replace(body, angle=rest + math.copysign(math.radians(cycle.amplitude_deg), body.angle - rest))
    return replace(scene, bodies=tuple(turned if one is body else one for one in scene.bodies))


def struck(beside: Unstruck, direction: float, speed: float, phase: float) -> tuple[Blow, Trajectory]:
    """One blow (rad, m/s, share of an oscillation), and its run."""
    start, period = beside.start
    at, peak = start + phase * period, HEIGHT * speed / HAMMER
    shock = Shock(at, LASTS, (peak * math.cos(direction), peak * math.sin(direction)))
    run = simulate(replace(beside.scene, shocks=(shock,), record=EVERYTHING), at + beside.after)
    judged, found = verdict(run), beats(run)
    count = min(len(found), int(np.count_nonzero(beside.found.end <= run.simulated)))
    change = np.degrees(found.amplitude[:count] - beside.found.amplitude[:count])
    off = np.flatnonzero(np.abs(change) > AS_BEFORE * beside.found.amplitude_deg[:count])
    if run.stop.gave_up:
        judged = replace(judged, name="gave up", message=run.stop.sentence)
    goes = judged.name in WORKS and count > 0
    recovered = 0.0 if not len(off) else float(found.end[off[-1]]) - at if off[-1] + 2 < count else None
    jewel = _stays_on_its_side(beside, run, at)
    return Blow(
        math.degrees(direction) % 360.0,
        speed,
        phase,
        at,
        judged.name,
        judged.message or "",
        False if judged.name == OVERBANKS else jewel,
        _guarded(beside, run, at),
        float(change[np.argmax(np.abs(change))]) if count else None,
        max(recovered, 0.0) if goes and recovered is not None else None,
        float(found.t[count - 1] - beside.found.t[count - 1]) if goes else None,
        _rate(found, at + 0.5 * beside.after, at + beside.after) if goes else None,
        _rate(beside.found, at + 0.5 * beside.after, at + beside.after),
    ), run


def _rate(found: Beats, since: float, until: float) -> float | None:
    """Of the whole oscillations between those times, s/d."""
    t = found.t[(found.t >= since) & (found.t <= until)]
    whole = (len(t) - 1) // 2
    return 86400.0 * (found.nominal_period * whole / float(t[2 * whole] - t[0]) - 1.0) if whole > 0 else None


def _beyond(beside: Unstruck, run: Trajectory, t: Array) -> tuple[Array, Array]:
    """(on which side of the lift the oscillator is at these times, 0 within; the coordinate of the lever)."""
    assert beside.parts.oscillator is not None and beside.parts.lever is not None
    q = run.sample(t)[0]
    away = q[:, run.slices[beside.parts.oscillator].start] - _rest(beside.scene, beside.parts)
    return np.where(np.abs(away) > beside.outside, np.sign(away), 0.0), q[:, run.slices[beside.parts.lever].start]


def _rest(scene: Scene, parts: Roles) -> float:
    return next((spring.rest for spring in scene.springs if spring.body == parts.oscillator), 0.0)


def _stays_on_its_side(beside: Unstruck, run: Trajectory, at: float) -> bool | None:
    """True if the lever is on the side on which it is without a blow whenever the oscillator is beyond the lift; None without
    a lever."""
    if beside.parts.lever is None:
        return None
    side, lever = _beyond(beside, beside.run, beside.run.t)
    left, right = (float(np.median(lever[side == way])) for way in (-1.0, 1.0))
    if left == right:
        return None
    side, lever = _beyond(beside, run, run.t[run.t >= at])
    over = (lever - 0.5 * (left + right)) / (0.5 * (right - left))  # +1 where it belongs on the right
    return not bool(np.any(side * over < 0.0))


def _guarded(beside: Unstruck, run: Trajectory, at: float) -> int:
    """Impacts of lever and oscillator beyond the lift."""
    if beside.parts.lever is None or beside.parts.oscillator is None:
        return 0
    one, other = involves(beside.parts.lever), involves(beside.parts.oscillator)
    hit = contact_events(run, lambda pair: one(pair) and other(pair), EventKind.IMPACT)
    t = np.unique(hit["t"][hit["t"] >= at])
    return int(np.count_nonzero(_beyond(beside, run, t)[0])) if len(t) else 0


@dataclass(frozen=True)
class ShockMap:
    """Blows of one speed in all directions and phases: row by row, all phases of each direction.

    directions_deg, phases  as requested; `whole` is False after Ctrl-C, with the blows so far
    """

    title: str
    speed_m_s: float
    directions_deg: tuple[float, ...]
    phases: tuple[float, ...]
    blows: tuple[Blow, ...]
    whole: bool
    wall_s: float

    @property
    def harmless(self) -> int:
        """How many of the blows the watch survives with its lever on its side."""
        return sum(one.harmless for one in self.blows)

    def numbers(self) -> dict[str, Any]:
        """What `shock --json` prints."""
        shared = {name: getattr(self, name) for name in ("title", "speed_m_s", "directions_deg", "phases", "whole", "wall_s")}
        return {**shared, "harmless": self.harmless, "blows": [asdict(one) for one in self.blows]}


def shock(
    scene: Scene | str | Path, direction: float = 0.0, speed: float = HAMMER, phase: float = 0.0, *, after: float = AFTER
) -> Blow:
    """What a blow does that accelerates the case in a `direction` (rad), as of a hammer of that `speed` (m/s, ISO 1413).

    phase  of the oscillation, from 0 to 1, from a passage through rest with a growing angle on
    after  how long (s) the watch is looked at

    SceneError where nothing swings, and where no body would feel the blow.
    """
    return struck(unstruck(_loaded(scene), after), direction, speed, phase)[0]


def shock_map(
    scene: Scene | str | Path,
    speed: float = HAMMER,
    *,
    directions: int = 24,
    phases: int = 24,
    after: float = AFTER,
    progress: Progress | None = None,
) -> ShockMap:
    """The same in so many directions and at so many phases; Ctrl-C keeps what there is."""
    begun, scene = time.perf_counter(), _loaded(scene)
    beside = unstruck(scene, after)
    ways, shares = (tuple(k / count for k in range(count)) for count in (directions, phases))
    found: list[Blow] = []
    for way, share in itertools.product(ways, shares):
        blow, run = struck(beside, math.tau * way, speed, share)
        if run.stop == Stop.INTERRUPTED or stopping.requested():
            break
        found.append(blow)
        if progress is not None:
            progress(len(found), directions * phases)
    whole, wall = len(found) == directions * phases, time.perf_counter() - begun
    return ShockMap(scene.title, speed, tuple(360.0 * way for way in ways), shares, tuple(found), whole, wall)


def _loaded(scene: Scene | str | Path) -> Scene:
    if isinstance(scene, Scene):
        return scene
    from watchsim.scene.load import load

    return load(scene)


def shock_lines(blows: Sequence[Blow]) -> list[str]:
    """A blow in words, one line for each thing that a watchmaker asks."""
    lines = []
    for one in blows:
        lines.append(
            f"Struck at {one.at_s:.4f} s, phase {one.phase:.3g}, {one.speed_m_s:.3g} m/s, direction {one.direction_deg:.4g}°"
        )
        jewel = {True: "stays on its side of the fork", False: "gets on the wrong side of the fork", None: "no lever"}[
            one.jewel_ok
        ]
        lines.append(f"  roller jewel      {jewel}")
        blows_of = f"{one.guard_blows} impacts of lever and oscillator beyond the lift" if one.guard_blows else "not needed"
        lines.append(f"  guard pin         {blows_of}")
        if one.amplitude_change_deg is not None:
            lines.append(f"  amplitude         changes by {one.amplitude_change_deg:+.2f}° at the most")
        ticks = "not within the run" if one.recovery_s is None else f"{one.recovery_s:.3f} s after the blow"
        lines.append(f"  ticks as before   {ticks}")
        if one.lost_s is not None:
            lines.append(f"  time              {1e3 * abs(one.lost_s):.3f} ms {'lost' if one.lost_s >= 0.0 else 'gained'}")
        if one.rate_s_per_d is not None and one.rate_without_s_per_d is not None:
            lines.append(
                f"  rate              {one.rate_s_per_d:+.2f} s/d, {one.rate_without_s_per_d:+.2f} s/d without the blow"
            )
        lines.append(f"  verdict           {one.message or one.verdict or 'nothing keeps time'}")
    return lines
