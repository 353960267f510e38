"""Is the first verdict that applies told, in the units and words of watchmakers?"""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import Events, balance_only, lever_scene

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.verdicts import verdict as module
from watchsim.analysis.verdicts.knocking import _angles
from watchsim.analysis.verdicts.verdict import verdict
from watchsim.analysis.verdicts.verdict_kinds import VERDICTS, Verdict, degrees, times, torque_text, when
from watchsim.analysis.verdicts.watch import Watch
from watchsim.scene.gearing import Geared
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU


@pytest.mark.parametrize(
    ("torque", "text"),
    [
        (1.6049e-6, "1.6 µN·m"),
        (-1.6151e-6, "1.62 µN·m"),
        (1e-9, "0.001 µN·m"),
        (1.1e-9, "0.0011 µN·m"),
        (0.99e-9, "990 pN·m"),
        (0.99e-3, "990 µN·m"),
        (1e-3, "1 mN·m"),
        (1.2e-3, "1.2 mN·m"),
        (-0.25, "250 mN·m"),
    ],
)
def test_torques_of_watches_are_in_micronewton_metres_others_are_not(torque: float, text: str) -> None:
    assert torque_text(torque) == text


def test_torques_have_three_digits_unless_more_are_asked_for() -> None:
    assert torque_text(1.23456e-6) == "1.23 µN·m"
    assert torque_text(1.23456e-6, 5) == "1.2346 µN·m" and torque_text(1.23456, 2) == "1.2 N·m"


def test_times_angles_and_counts() -> None:
    assert when(0.83124) == "t = 0.8312 s"
    assert degrees(-math.pi / 8.0) == "−22.5°" and degrees(3.0) == "172°"
    assert [times(count) for count in (1, 2, 3, 4, 27)] == ["once", "twice", "3 times", "4 times", "27 times"]


def test_a_watch_that_has_yet_to_settle_is_not_out_of_order() -> None:
    assert [name for name in VERDICTS if Verdict(name).works] == ["ticks", "unsettled"] and Verdict(None).works


def asked(
    monkeypatch: pytest.MonkeyPatch, found: dict[int, Verdict], blows: tuple[float, ...] = (), missed: int = 0
) -> Verdict:
    """With verdicts of some of the six questions, by place."""
    monkeypatch.setattr(module, "QUESTIONS", tuple(lambda watch, k=k: found.get(k) for k in range(6)))
    monkeypatch.setattr(module, "knocks", lambda watch: np.array([(t,) for t in blows], [("t", float)]))
    monkeypatch.setattr(module, "missed_beats", lambda run, wheel, beats: missed)
    monkeypatch.setattr(module, "watch_of", lambda run, beats: SimpleNamespace(run=run, wheel="wheel", found=beats))
    run: Any = SimpleNamespace(scene=lever_scene())
    return verdict(run, SimpleNamespace())  # type: ignore[arg-type]


def test_the_first_that_applies_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    stops, knocks = Verdict("stops"), Verdict("knocks")
    assert asked(monkeypatch, {2: stops, 4: knocks}) is stops and asked(monkeypatch, {5: knocks}) is knocks
    assert asked(monkeypatch, {}) == Verdict("ticks", "the watch ticks")


@pytest.mark.parametrize(
    ("blows", "missed", "words"),
    [
        ((1.5, 2.25), 0, ", after it knocked until t = 2.2500 s"),
        ((1.75,), 1, ", after it knocked until t = 1.7500 s, but missed 1 beat"),
        ((), 2, ", but missed 2 beats"),
        ((), 3, ", but missed 3 beats"),
    ],
)
def test_what_did_not_go_well_before_is_mentioned(
    monkeypatch: pytest.MonkeyPatch, blows: tuple[float, ...], missed: int, words: str
) -> None:
    assert asked(monkeypatch, {}, blows, missed).message == "the watch ticks" + words


def test_nothing_is_told_of_what_does_not_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "beats", lambda run: pytest.fail("there are none"))
    still = balance_only(Events(), 1.0, replace(lever_scene(), springs=()))
    assert verdict(still).name is None
    monkeypatch.setattr(module, "watch_of", lambda run, found: None)
    assert verdict(balance_only(Events(), 1.0), SimpleNamespace()).name is None  # type: ignore[arg-type]


def watch(**changed: Any) -> Watch:
    run = balance_only(Events(), 10.0, replace(lever_scene(), **changed))
    return Watch(run, beats(run), "balance", "wheel", "lever")


def test_a_drive_at_another_wheel_counts_as_its_gears_pass_it_on() -> None:
    """The lever turns three times as fast as the escape wheel: a third of the wheel's torque would do there what it does."""
    bodies = tuple(replace(one, geared=Geared("wheel", -3.0)) if one.name == "lever" else one for one in lever_scene().bodies)
    (torque,) = lever_scene().torques
    here = watch(bodies=bodies, torques=(torque, replace(torque, body="lever", value=0.2e-6)))
    assert here.drive(1.0) == pytest.approx(-1e-6 - 3.0 * 0.2e-6, rel=1e-12, abs=0.0)


def test_contacts_are_in_force_where_events_are_kept_one_by_one() -> None:
    here = watch()
    for method, keep, known in ((EVENT_DRIVEN, "all", True), (EVENT_DRIVEN, "statistics", False), (MOREAU, "all", False)):
        assert replace(here, run=replace(here.run, method=method, keep=keep)).has_modes is known
    assert replace(here, run=replace(here.run, pairs=())).has_shapes is (len(here.compiled.model.contacts) == 0)


def test_events_and_contacts_of_a_body_with_some_others() -> None:
    """Rows of the made lever: 0 and 1 wheel and lever, 2 balance and lever, 3 banking and lever."""
    happened = Events()
    for t, pair in ((0.1, 2), (0.2, 0), (0.3, 3), (0.4, 2)):
        happened.touch(t, EventKind.IMPACT, pair)
    happened.touch(0.5, EventKind.CLOSE, 1)
    run = balance_only(happened, 1.0)
    here = Watch(run, beats(run), "balance", "wheel", "lever")
    assert here.events("lever", {"balance"}, EventKind.IMPACT)["t"].tolist() == [0.1, 0.4]
    assert here.events("balance", {"lever", "wheel"}, EventKind.IMPACT)["t"].tolist() == [0.1, 0.4]
    assert here.events("wheel", {"lever"}, EventKind.CLOSE, EventKind.OPEN)["t"].tolist() == [0.5]
    assert here.contacts("lever", {"wheel"}) == {0, 1} and here.contacts("lever", {"banking", "wheel"}) == {0, 1, 3}


def test_half_swings_of_different_lengths_are_halves_of_sines() -> None:
    """From 0.9 rad below rest to 1.3 above, 0.4 s before and 0.7 s after the passage; a later one of no length."""
    found: Any = SimpleNamespace(t=np.array([1.4, 3.0]), start=np.array([1.0, 2.5]), end=np.array([2.1, 3.0]))
    found.start_at, found.end_at = 0.25 + np.array([-0.9, 1.7]), 0.25 + np.array([1.3, -0.6])
    watch: Any = SimpleNamespace(found=found, rest=0.25)
    got = _angles(watch, np.array([1.0, 1.3, 1.4, 1.6, 2.1, 2.3, 2.5, 2.9, 3.0]))
    first = [-0.9, -0.9 * math.sin(0.125 * math.pi), 0.0, 1.3 * math.sin(math.pi / 7.0), 1.3]
    assert got == pytest.approx([*first, 1.7, 1.7, 1.7 * math.sin(0.1 * math.pi), 0.0], rel=1e-12, abs=0.0)
