"""When does a wheel run backwards, and what do the parts of a watch say of themselves? With made-up surroundings."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import Events, balance_only, lever_scene

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.verdicts import backwards as module
from watchsim.analysis.verdicts import watch as watching
from watchsim.analysis.verdicts.backwards import backwards
from watchsim.analysis.verdicts.watch import Watch
from watchsim.scene.force import Torque

WINDOW, LEAST = (10.0, 20.0), 0.1


def told(monkeypatch: pytest.MonkeyPatch, back: float = 0.0, **changed: Any) -> Any:
    """`back`: how far the wheel goes back in the last window, rad."""
    monkeypatch.setattr(module, "last_window", lambda run, period: WINDOW)
    monkeypatch.setattr(module, "running_free", lambda watch: changed.get("free"))
    monkeypatch.setattr(module, "unlocked", lambda watch: changed.get("pushing", []))
    values: dict[str, Any] = {
        **{"run": None, "found": SimpleNamespace(nominal_period=0.25), "wheel": "wheel", "lever": "lever"},
        **{"least_advance": LEAST, "teeth": SimpleNamespace(direction=changed.get("lean", 1.0)), "direction": 1.0},
        "recorded": lambda ends: np.isin(ends, changed.get("kept", WINDOW)),
        "progress": lambda ends: 3.0 - (ends - 10.0) / 10.0 * back,
        "drive": lambda t: 1e-6 * t,
    }
    return backwards(SimpleNamespace(**(values | changed)))  # type: ignore[arg-type]


@pytest.mark.parametrize(("back", "so"), [(1.99 * LEAST, False), (2.01 * LEAST, True), (-9.0 * LEAST, False)])
def test_against_its_drive(monkeypatch: pytest.MonkeyPatch, back: float, so: bool) -> None:
    verdict = told(monkeypatch, back)
    assert (verdict is not None) is so
    if so:
        assert (verdict.name, verdict.t, verdict.body, verdict.torque) == ("backwards", 10.0, "wheel", pytest.approx(2e-5))
        assert f"has turned by {math.degrees(back):.3g}° against its drive of 20 µN·m" in verdict.message
    assert told(monkeypatch, back, kept=(10.0,)) is None and told(monkeypatch, back, kept=(20.0,)) is None


@pytest.mark.parametrize(("lean", "way", "so"), [(1.0, 1.0, False), (-1.0, 1.0, True), (0.0, 1.0, False), (1.0, -1.0, True)])
def test_against_the_lean_of_its_teeth(monkeypatch: pytest.MonkeyPatch, lean: float, way: float, so: bool) -> None:
    """Where it runs through, or where teeth push the lever off its banking."""
    through = told(monkeypatch, lean=lean, direction=way, free=(12.0, "it runs through"))
    assert (through is not None) is so
    pushed = told(monkeypatch, lean=lean, direction=way, pushing=[(13.0, "tooth on stone", None), (14.0, "x", None)])
    assert (pushed is not None) is so and told(monkeypatch, lean=lean, direction=way) is None
    if so:
        assert (through.t, through.count, through.torque) == (12.0, None, pytest.approx(1.2e-5))
        assert "of its teeth; it runs through. Change" in through.message
        assert (pushed.t, pushed.count) == (13.0, 2) and "push lever off its banking (tooth on stone)" in pushed.message
    assert told(monkeypatch, teeth=None, free=(12.0, "")) is None


def watch(**changed: Any) -> Watch:
    scene = replace(lever_scene(0.4), **changed)
    run = balance_only(Events(), 10.0, scene)
    return Watch(run, beats(run), "balance", "wheel", "lever")


@pytest.mark.parametrize("kept", [True, False])
def test_what_drives_a_wheel(monkeypatch: pytest.MonkeyPatch, kept: bool) -> None:
    """Constant torques, tables over time, and over angle where the body was recorded; those of other bodies do not count."""
    monkeypatch.setattr(Watch, "recorded", lambda self, times: np.full(len(times), kept))
    monkeypatch.setattr(Watch, "angle", lambda self, body, times: 0.5 + 0.0 * times)
    torques = (
        Torque("wheel", -1e-6),
        Torque("wheel", over="time", table=((0.0, 0.0), (10.0, 5e-6))),
        Torque("wheel", over="angle", table=((0.0, 1e-4), (1.0, 3e-4))),
        Torque("balance", 7.0),
    )
    assert watch(torques=torques).drive(4.0) == pytest.approx(-1e-6 + 2e-6 + (2e-4 if kept else 0.0), rel=1e-12, abs=0.0)
    assert watch(torques=torques[1:2]).drive(2.0) == pytest.approx(1e-6, rel=1e-12, abs=0.0)
    assert watch(torques=torques[2:3]).drive(2.0) == (pytest.approx(2e-4, rel=1e-12, abs=0.0) if kept else 0.0)


def test_what_a_watch_knows_of_itself() -> None:
    """A banking is something fixed that the lever may touch."""
    here = watch()
    assert here.has_banking and here.fixed == {"banking"} and here.rest == 0.4 and here.direction == -1.0
    assert not replace(here, lever=None).has_banking and not replace(here, lever="wheel").has_banking
    assert here.pitch == pytest.approx(math.tau / 15) and here.least_advance == pytest.approx(math.tau / 60)
    bare = watch(bodies=tuple(replace(body, loops=()) for body in lever_scene().bodies))
    assert bare.pitch is None and bare.teeth is None and bare.least_advance == pytest.approx(0.01, rel=0.2)
    assert watching.watch_of(here.run, here.found) == here
    other = replace(here.found, body="lever")
    assert (
        watching.watch_of(here.run, other) is None and watching.watch_of(here.run, replace(here.found, angular=False)) is None
    )
    assert watching.watch_of(replace(here.run, scene=replace(here.run.scene, torques=())), here.found) is None
