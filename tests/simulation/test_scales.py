"""Does a mechanism move alike whatever its size and pace, and do its events depend on neither, nor on the tolerance?"""

import functools
import itertools

import numpy as np
import pytest
from every_time import few
from moving_scenes import PROFILES, profile
from scaled_scenes import lying, scaled

from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

NAMES = sorted(path.name for path in PROFILES.iterdir() if (path / "scene.toml").is_file())
SHOWN = ("detent", "swiss_lever")  # every time; all at night
FACTORS = [("time", 1e-7), ("time", 1e7), ("length", 1e-6), ("length", 1e9)]
ROUNDING = 1e-9  # of what is turned or travelled: today 3e-10 (remontoir), else 5e-12


@functools.cache
def usual(name: str) -> Trajectory:
    scene = profile(name)
    return simulate(scene, min(scene.duration, 1.0), record="all")


@pytest.mark.parametrize(
    ("kind", "factor", "name"),
    few([(*one, name) for one in FACTORS for name in NAMES], lambda case: case[2] in SHOWN, several=True),
)
def test_the_same_motion_in_other_units(kind: str, factor: float, name: str) -> None:
    scene, run = profile(name), usual(name)
    time = factor if kind == "time" else 1.0
    other = simulate(scaled(scene, **{kind: factor}), run.simulated * time, record="all")
    assert (other.stop, run.stop) == (Stop.DURATION, Stop.DURATION)
    units = np.ones(run.q.shape[1])
    for body in scene.bodies:
        if kind == "length" and body.name in run.slices and body.motion != "pivot":
            units[run.slices[body.name]] = (factor, factor, 1.0) if body.motion == "free" else factor
    times = np.linspace(0.0, run.simulated, 101)
    seen = run.sample(times)[0]
    assert np.abs(other.sample(times * time)[0] / units - seen).max() < ROUNDING * max(1.0, np.abs(seen).max())
    turns = [one.events["t"][one.events["kind"] == EventKind.TURN] for one in (run, other)]
    assert turns[1] / time == pytest.approx(turns[0], rel=1e-6)


def test_only_what_moves_turns() -> None:
    """Detent and spring rest on their stops most of the time, where rounding was a turning point several times a step."""
    run = usual("detent")
    turns = run.events[run.events["kind"] == EventKind.TURN]
    names = [body.name for body in run.scene.bodies]
    for body in np.unique(turns["body"]):
        times = [0.0, *turns["t"][turns["body"] == body]]
        for since, until in itertools.pairwise(times):
            rows = (run.t >= since) & (run.t <= until)
            assert np.abs(run.u[rows, run.slices[names[body]]]).max() > 1e-6, until  # rad/s; rounding is below 1e-12


def counted(run: Trajectory) -> dict[str, int]:
    """What does not depend on where rebounds are ended: blows outside of series of them, series, closings, turning points.

    Not counted: STICK and SLIDE of contacts at rest, whose friction is undetermined; HANDOVER, which tangent neighbours share.
    """
    blows, waiting = 0, dict[int, int]()
    for kind, contact in run.events[["kind", "contact"]].tolist():
        if kind == EventKind.IMPACT:
            waiting[contact] = waiting.get(contact, 0) + 1
        elif kind == EventKind.ACCUMULATION:
            waiting.pop(contact, None)
        elif kind in (EventKind.OPEN, EventKind.CLOSE):
            blows += waiting.pop(contact, 0)
    kinds = (EventKind.ACCUMULATION, EventKind.OPEN, EventKind.CLOSE, EventKind.TURN)
    found = {kind.name: int((run.events["kind"] == kind).sum()) for kind in kinds}
    return {"blows": blows + sum(waiting.values()), **found}


# Contacts that open for 10 ns to 1 µs beside another event, near the cut-off of rebounds; parts that turn at each of a series.
FINE = {"duplex": 1e-9, "remontoir": 1e-9}  # tolerance from which on the counts are the same
ROUGH = ("remontoir", "tourbillon", "snail", "winding_click")  # but for powers of ten of time
SCALES = (("length", 7.0), ("time", 1e-3), ("time", 3.0))


@pytest.mark.parametrize("name", few(NAMES, lambda name: name in SHOWN))
def test_counts_depend_on_neither_tolerance_nor_scale_nor_orientation(name: str) -> None:
    scene, duration = profile(name), min(profile(name).duration, 1.0)
    known = counted(simulate(scene, duration, 1e-9))
    for tolerance in (1e-8, 1e-10, 1e-11):
        if tolerance <= FINE.get(name, 1.0):
            assert counted(simulate(scene, duration, tolerance)) == known, tolerance
    for kind, factor in SCALES[:2] if name in ROUGH else SCALES:
        time = factor if kind == "time" else 1.0
        other = simulate(scaled(scene, **{kind: factor}), duration * time, 1e-9)
        assert counted(other) == known, (kind, factor)
    for angle in (0.7, 2.9):  # rad
        assert counted(simulate(lying(scene, angle), duration, 1e-9)) == known, angle
