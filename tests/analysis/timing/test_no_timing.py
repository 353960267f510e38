"""Is it said why a run gives no amplitude, or no rate?"""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from analysis.made_beats import DEGREE, PERIOD, Events, balance_only, lever_scene, steady_swings

from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.no_timing import why_no_timing
from watchsim.simulation.event_kinds import EventKind

UNKNOWN = {"amplitude_deg": None, "rate_s_per_d": None}


def turned(count: int, crossed: bool, more: int = 0) -> Events:
    """`more`: passages without a turning point after them."""
    events = Events()
    for k in range(more):
        events.passage(9.0 + 0.1 * k, EventKind.CROSS, 1.0)
    for k in range(count):
        if crossed:
            events.passage((k + 0.5) * 0.5 * PERIOD, EventKind.CROSS, 1.0 - 2.0 * (k % 2))
        events.passage((k + 1) * 0.5 * PERIOD, EventKind.TURN, 100.0 * DEGREE * (1.0 - 2.0 * (k % 2)))
    return events


@pytest.mark.parametrize(
    ("events", "duration", "why"),
    [
        (turned(0, False), 10.0, "balance never passed its rest position"),
        (turned(5, False), 10.0, "balance never passed its rest position"),
        (turned(0, True, 1), 10.0, "balance turned back not once in 10 s"),
        (turned(0, True, 4), 10.0, "balance turned back not once in 10 s"),
        (turned(1, True), 10.0, "balance turned back only once in 10 s"),
        (turned(1, True, 3), 10.0, "balance turned back only once in 10 s"),
        (turned(2, True, 2), 0.51, "balance turned back only twice in 0.51 s"),
        (turned(2, True), 10.0, "balance turned back only twice in 10 s"),
        (turned(2, True), 0.45, "the run of 0.45 s is too short: balance needs 0.5 s for two oscillations"),
        (turned(0, False), 0.2, "the run of 0.2 s is too short: balance needs 0.5 s for two oscillations"),
        (turned(9, True), 10.0, "the last 7.5 s hold too few whole swings of balance"),
    ],
)
def test_what_is_too_little(events: Events, duration: float, why: str) -> None:
    scene = replace(lever_scene(), torques=(), contacts=())
    run = balance_only(events, duration, scene)
    assert why_no_timing(run, beats(run), UNKNOWN, 2.5) == f"no amplitude and rate: {why}"


@pytest.mark.parametrize(("turns", "passages"), [(-0.9, 0), (1.1, 0), (-1.1, 1), (7.5, 1)])
def test_a_pendulum_may_go_round_instead_of_swinging(turns: float, passages: int) -> None:
    """The next time it hangs at rest it has gone a whole turn further."""
    scene = replace(lever_scene(), torques=(), contacts=())
    column = list(balance_only(Events(), 10.0, scene).slices).index("balance")
    end = np.zeros(3)
    end[column] = scene.body("balance").angle + turns * math.tau
    run = replace(balance_only(turned(0, True, passages), 10.0, scene), end_q=end, end_u=np.zeros(3))
    said = "never passed its rest position" if abs(turns) < 1.0 else "goes round instead of swinging"
    assert why_no_timing(run, beats(run), UNKNOWN) == f"no amplitude and rate: balance {said}"


def test_only_what_is_missing_is_named() -> None:
    run = balance_only(steady_swings(8, 200.0 * DEGREE), 10.0)
    found = beats(run)
    assert why_no_timing(run, found, {"amplitude_deg": 200.0, "rate_s_per_d": 0.0}) is None
    said = why_no_timing(run, found, {"amplitude_deg": 200.0, "rate_s_per_d": None})
    assert said is not None and said.startswith("no rate: ")


def test_what_never_swings() -> None:
    still = replace(lever_scene(), springs=())
    run = balance_only(Events(), 1.0, still)
    assert why_no_timing(run, None, UNKNOWN) == "no amplitude and rate: no body has a spring, and there is no gravity"
    heavy = replace(run, scene=replace(still, gravity=(0.0, -9.81)))
    said = why_no_timing(heavy, None, UNKNOWN)
    assert said is not None and said.endswith("and none that is not driven hangs beside its pivot")
    fixed = replace(still, bodies=(still.body("banking"),))
    assert why_no_timing(replace(run, scene=fixed), None, UNKNOWN) is None


@pytest.mark.parametrize("toppling", ["balance", "lever"])
def test_gravity_topples_the_oscillator_or_another_body(toppling: str, monkeypatch: pytest.MonkeyPatch) -> None:
    hertz = {"lever": 3.0, "balance": 4.0} | {toppling: None}
    known = [SimpleNamespace(body=name, hertz=value) for name, value in hertz.items()]
    run = balance_only(turned(1, True), 10.0, replace(lever_scene(), torques=(), contacts=()))
    found = beats(run)
    monkeypatch.setattr("watchsim.analysis.timing.no_timing.oscillators", lambda scene: known)
    topples = "gravity topples balance from its rest position"
    said = topples if toppling == "balance" else "balance turned back only once in 10 s"
    assert why_no_timing(run, found, UNKNOWN) == f"no amplitude and rate: {said}"


def test_a_spring_that_only_presses_is_not_asked_for_a_rate() -> None:
    """A click on its driven wheel; but where it passes its rest position it may be meant to swing."""
    ratchet = replace(lever_scene(), contacts=lever_scene().contacts[1:], lift_angle=None)
    still, passing = (balance_only(turned(count, True), 10.0, ratchet) for count in (0, 1))
    assert why_no_timing(still, beats(still), UNKNOWN) is None
    assert why_no_timing(passing, beats(passing), UNKNOWN) == "no amplitude and rate: balance turned back only once in 10 s"


def test_what_slides_has_a_rate_alone() -> None:
    run = balance_only(steady_swings(8, 1e-3), 10.0)
    slides = replace(beats(run), angular=False)
    said = why_no_timing(run, slides, UNKNOWN)
    assert said is not None and said.startswith("no rate: ")
    known = why_no_timing(run, slides, {"amplitude_deg": None, "rate_s_per_d": 3.0})
    assert known == "no amplitude in degrees: balance slides"
