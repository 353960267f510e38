"""Which number of a summary follows from which of a run? From made-up runs, one thing changed at a time."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from analysis.made_beats import lever_run
from render.fake_runs import disc_run

from watchsim.analysis import summary as module
from watchsim.analysis.summary import _about, _bodies, _counts, _judgement, _missed, _timing, _timing_of
from watchsim.analysis.timing.averages import Averages
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.verdicts.verdict_kinds import NOTHING, Verdict
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory

RUN = lever_run(4)


@pytest.mark.parametrize(("wall", "factor"), [(0.2, 2.5), (5e-4, 1000.0), (0.0, None)])
def test_how_fast_it_was(wall: float, factor: float | None) -> None:
    assert _about(replace(RUN, wall=wall))["realtime_factor"] == (None if factor is None else pytest.approx(factor, rel=1e-12))


def test_what_was_counted_while_it_ran_counts() -> None:
    """Events may not have been kept; where nothing was counted, the kept ones are."""
    kinds = RUN.events["kind"].tolist()
    plain = _counts(replace(RUN, counts={}, sums={}))
    assert plain["events"] == len(kinds) > 40 and plain["impacts"] == kinds.count(EventKind.IMPACT) > 20
    assert plain["events_by_kind"] == {kind.name.lower(): kinds.count(kind) for kind in EventKind}
    assert plain["lcp_failures"] == 0 and plain["forces_unique"] is True and plain["counts"] == {}
    counts = {"impacts": 777, "events": 888, "lcp_failures": 3, "redundant_sets": 1}
    told = _counts(replace(RUN, counts=counts, sums={"events_by_kind": {"impact": 5, "turn": 6}}))
    assert (told["impacts"], told["events"], told["lcp_failures"], told["forces_unique"]) == (777, 888, 3, False)
    assert told["events_by_kind"] == {"impact": 5, "turn": 6} and told["counts"] == counts
    assert _counts(replace(RUN, counts={"redundant_sets": 0}))["forces_unique"] is True
    assert _counts(replace(RUN, counts={}, sums={"events_by_kind": {"impact": 5}}))["impacts"] == 5


def test_depths_and_energies_are_those_of_the_run() -> None:
    sizes: dict[str, Any] = {"worst_penetration": 3e-9, "worst_residual": 5e-11, "overlap": {"worst_m": 7e-9}}
    told = _counts(replace(RUN, energy={"in_J": 2.5e-6}, **sizes))
    assert (told["worst_penetration_m"], told["worst_complementarity_residual"]) == (3e-9, 5e-11)
    assert told["overlap"] == {"worst_m": 7e-9} and told["energy"]["in_J"] == 2.5e-6 and told["energy"]["stored_J"] == 0.0


def test_frequencies_follow_from_the_period() -> None:
    means = Averages(1.5, 4.5, 12, amplitude_deg=270.5, amplitude_deg_error=0.25, period_s=0.4, rate_s_per_d=-3.5)
    told = _timing_of(means)
    assert told["frequency_hz"] == pytest.approx(2.5, rel=1e-12) and told["vph"] == pytest.approx(18000.0, rel=1e-12)
    assert told["window_s"] == [1.5, 4.5] and told["period_s"] == 0.4 and told["period_s_error"] is None
    assert (told["amplitude_deg"], told["amplitude_deg_error"], told["rate_s_per_d"]) == (270.5, 0.25, -3.5)
    for few in (Averages(1.5, 4.5, 0), None):
        assert _timing_of(few)["vph"] is None and _timing_of(few)["frequency_hz"] is None
    assert _timing_of(None)["window_s"] is None and set(_timing_of(None)) == set(told)


def test_only_what_keeps_time_misses_beats(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "missed_beats", lambda run, wheel, found: (wheel, 3))
    found: Any = None
    assert _missed(RUN, found) == ("wheel", 3)
    for wheel, keeps in ((None, True), ("wheel", False), (None, False)):
        monkeypatch.setattr(module, "roles", lambda scene, wheel=wheel: SimpleNamespace(wheel=wheel))
        monkeypatch.setattr(module, "keeps_time", lambda scene, keeps=keeps: keeps)
        assert _missed(RUN, found) is None


@pytest.mark.parametrize("stands", [None, SimpleNamespace(message="the wheel stands")])
def test_what_an_oscillator_does(monkeypatch: pytest.MonkeyPatch, stands: Any) -> None:
    """Averaged over the last window, of all half swings, kept or not."""
    asked: list[Any] = []

    def why(run: Trajectory, found: Any, values: Any, start: float) -> str:
        asked.append(start)
        return "because"

    monkeypatch.setattr(module, "last_window", lambda run, period: (0.25, 0.5) if period == 0.25 else None)
    monkeypatch.setattr(module, "standstill", lambda run, found: stands)
    monkeypatch.setattr(module, "why_no_timing", why)
    monkeypatch.setattr(module, "timegrapher", lambda run, found, window: window)
    found = beats(RUN)
    monkeypatch.setattr(module, "beats", lambda run: replace(found, before=7))
    told = _timing(RUN)
    assert told["beats"] == 7 + len(found) == 10 and told["timegrapher"] == (0.25, 0.5) and asked == [0.25]
    assert told["stopped"] is (stands is not None) and told["timing_message"] == "because"
    assert told["stopped_message"] == (stands.message if stands else None)


def test_without_an_oscillator_there_is_nothing_to_time() -> None:
    told = _timing(disc_run())
    assert told["beats"] == 0 and told["stopped"] is False
    empty = set(told) - {"beats", "stopped", "timing_message"}
    assert {told[name] for name in empty} == {None} and set(told) == set(_timing(RUN))


def test_a_verdict_and_its_details() -> None:
    told = _judgement(Verdict("knocks", "it knocks", 1.5, "balance", "pin on fork", 2e-6, 4))
    assert told["verdict"] == "knocks" and told["verdict_message"] == "it knocks"
    details = {"t_s": 1.5, "body": "balance", "pair": "pin on fork", "torque_Nm": 2e-6, "count": 4, "works": False}
    assert told["verdict_details"] == details
    assert _judgement(NOTHING) == {"verdict": None, "verdict_message": None, "verdict_details": None}


def test_where_bodies_are_at_the_end() -> None:
    """A turning one by its angle about its pivot, and how fast; nothing before the first row."""
    (q, u), at = RUN.at(RUN.simulated), RUN.slices["wheel"].start
    state = _bodies(RUN)["wheel"]
    assert (state["angle_rad"], state["angle_rad_per_s"]) == (q[at], u[at])
    scene: Scene = RUN.scene
    assert set(_bodies(RUN)) == {body.name for body in scene.bodies}
    none: Any = SimpleNamespace(end=None)
    assert _bodies(none) == {}
