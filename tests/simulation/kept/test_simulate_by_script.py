"""What does `simulate` hand over to a run, and what times does it tell? With a made-up run and clock."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.scene.body import Body
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import simulate as module
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.moreau import time_stepping
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

OWN = Recording(((1.0, 2.0),))
SCENE = Scene("one", (Body("one", "pivot", inertia=1.0),), duration=7.0, tolerance=1e-7, record=OWN)


class MadeUp:
    """A run that says how it was made and what it was asked."""

    def __init__(self, *given: Any) -> None:
        self.given, self.asked = given, []
        self.kept: Any = SimpleNamespace(stream=lambda folder: self.asked.append(("stream", folder)), follow=None)
        self.pairs = "pairs"

    def warm_up(self) -> None:
        self.asked.append("warm up")

    def begin(self) -> None:
        self.asked.append("begin")

    def begin_from(self, saved: SavedState) -> None:
        self.asked.append(("from", saved))

    def to_the_end(self, duration: float, progress: Any) -> Stop:
        self.asked.append((duration, progress))
        return Stop.DURATION


@pytest.fixture(autouse=True)
def made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """The clock is read at 100 s, and then 1, 2, 4, ... s later each time."""
    clock = iter(100.0 + 2.0**k for k in range(-1, 20))
    monkeypatch.setattr(module.time, "perf_counter", lambda: next(clock))
    monkeypatch.setattr(module, "compile_scene", lambda scene, prefilter: ("compiled", scene, prefilter))
    monkeypatch.setattr(module, "load_for", lambda compiled: None)
    monkeypatch.setattr(module, "Run", lambda *given: MadeUp("events", *given))
    monkeypatch.setattr(time_stepping, "MoreauRun", lambda *given: MadeUp("steps", *given))
    monkeypatch.setattr(module, "trajectory_of", lambda run, stop, wall, compile_time: (run, stop, wall, compile_time))
    monkeypatch.setattr(module, "joined", lambda first, rest, folder: ("joined", first, rest, folder))


def test_a_run_is_by_events_with_what_the_scene_says() -> None:
    made: Any = simulate(SCENE)
    run, stop, _, _ = made
    assert stop == Stop.DURATION and run.given == ("events", SCENE, ("compiled", SCENE, True), 1e-7, OWN)
    assert run.asked == ["warm up", "begin", (7.0, None)] and run.kept.follow is None


def test_what_is_asked_goes_before_what_the_scene_says() -> None:
    made: Any = simulate(SCENE, "2.5 s", 1e-6, "events", print, False, stream="here", follow=lambda *given: given)
    run = made[0]
    assert run.given[2:4] == (("compiled", SCENE, False), 1e-6) and run.given[4].keep == "events"
    assert run.asked == [("stream", Path("here")), "warm up", "begin", (2.5, print)]
    assert run.kept.follow("events", "rows") == ("pairs", "events", "rows")


def test_in_fixed_steps_of_ten_microseconds_or_as_asked() -> None:
    for step, seconds in ((None, 1e-5), ("2 ms", 2e-3), (3e-4, 3e-4)):
        made: Any = simulate(SCENE, method="moreau", step=step)
        assert made[0].given == ("steps", SCENE, ("compiled", SCENE, True), 1e-7, OWN, seconds)


def test_loading_and_the_rest_are_told_apart() -> None:
    """At 100.5 begun, from 101 to 102 and from 104 to 108 loading, at 116 over."""
    made: Any = simulate(SCENE)
    assert made[2:] == (116.0 - 100.5 - 5.0, 5.0)


@pytest.mark.parametrize("stream", [None, "there"])
def test_a_run_goes_on_from_a_state_or_from_a_trajectory_that_it_is_joined_to(stream: str | None) -> None:
    state = SavedState({"clock": np.array([1.5, 0.0, 0.0])}, "", {}, 0.0)
    made: Any = simulate(SCENE, start=state)
    assert made[0].asked == [("from", state), "warm up", (7.0, None)]
    none = np.zeros((0, 1))
    first = Trajectory(
        SCENE, np.zeros(0), none, none, none, {}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, simulated=6.5, end_state=state
    )
    made = simulate(SCENE, start=first, stream=stream)
    assert made[:2] == ("joined", first) and made[3] == (None if stream is None else Path("there"))
    assert ("from", state) in made[2][0].asked
    with pytest.raises(ValueError, match=r"has reached 6.5 s already"):
        simulate(SCENE, 6.5, start=first)
