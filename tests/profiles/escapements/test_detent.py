"""Does the detent escapement tick, one tooth in every other half swing, and does its rate hardly follow the drive?"""

from __future__ import annotations

import math

import numpy as np
import pytest

import watchsim as ws
from watchsim import designs
from watchsim.analysis.phases import phases
from watchsim.analysis.timeline import shown_beats
from watchsim.construction import registry as known
from watchsim.construction.detent import Detent, Points
from watchsim.scene.roles import Roles, roles

DETENT = known.design("detent")
POINTS = Points(Detent())
PROFILE = "detent"


@pytest.fixture(scope="module")
def ticking() -> ws.Trajectory:
    return ws.simulate(designs.detent(start="268 °").scene(), duration=4.0)


def teeth(run: ws.Trajectory) -> float:
    column = run.slices["wheel"].start
    return float(run.scene.body("wheel").angle - run.end_q[column]) / (math.tau / 15.0)


def test_the_detent_is_the_lever_by_its_passing_spring():
    assert roles(designs.detent().scene()) == Roles("balance", "wheel", "detent")


def test_one_tooth_in_each_oscillation(ticking):
    assert teeth(ticking) == pytest.approx(8.0, abs=1e-3)
    assert ws.summary(ticking)["missed_beats"] == 0
    assert abs(ticking.energy["residual_relative"]) < 1e-9 and ticking.worst_penetration < 1e-9


def test_phases_are_where_the_construction_says(ticking):
    """Only half swings one way have phases; the tooth is let go and lets the impulse stone go at the angles of the drawing."""
    found = phases(ticking)
    assert {one.beat % 2 for one in found} == {found[0].beat % 2}
    unlocks = [one for one in found if one.name == "unlock"]
    pushes = [one for one in found if one.name == "impulse"]
    assert len(unlocks) >= 6 and {one.on for one in pushes} == {"balance"}
    for one in unlocks:
        assert math.degrees(one.turns[1]) == pytest.approx(-Detent().lock, abs=1e-3)
        assert math.degrees(one.angles[2] + one.turns[2]) == pytest.approx(Detent().letting_go, abs=2e-3)
    end = Detent().letting_go + 2.0 * POINTS.half_impulse - Detent().inside
    for one in pushes:
        assert math.degrees(one.angles[2] + one.turns[2]) == pytest.approx(end, abs=2e-3)
    for beat in shown_beats(ticking):
        assert abs(beat.residual) < 1e-7 * sum(stage.energy.supplied for stage in beat.stages)


def test_on_the_way_back_the_leaf_gives_way_alone(ticking):
    """The detent lies on its bank while the discharging stone bends the passing spring by some degrees."""
    t = np.linspace(2.0, 4.0, 200001)
    q, u = ticking.sample(t)
    detent, leaf, balance = (ticking.slices[name].start for name in ("detent", "passing", "balance"))
    back = u[:, balance] < 0.0
    assert math.degrees(q[back, leaf].max()) > 5.0
    # The leaf that springs back strikes the horn, and lifts the detent by next to nothing.
    assert np.degrees(np.abs(q[back, detent]).max()) < 0.01
    assert math.degrees(q[~back, detent].min()) == pytest.approx(-Detent().travel, abs=0.1)
    assert math.degrees(q[~back, leaf].max()) < 1.0


@pytest.mark.slow
def test_nearly_isochronous_and_set_by_where_the_tooth_is_let_go():
    """Airy: an impulse whose middle is θ̄ behind the middle of the swing loses 86400 θ̄ / (2 Q A) seconds a day."""
    cycles = [ws.steady(designs.detent(torque=f"{torque} µN·m").scene()) for torque in (20.0, 45.0, 60.0)]
    rates = [cycle.rate_s_per_d for cycle in cycles]
    assert cycles[0].amplitude_deg < 180.0 and cycles[-1].amplitude_deg > 310.0
    assert max(rates) - min(rates) < 0.15
    early = ws.steady(designs.detent(letting_go="-24.5 °").scene())
    airy = 86400.0 * 2.0 / (2.0 * Detent().q_factor * early.amplitude_deg)
    assert early.rate_s_per_d - rates[1] == pytest.approx(airy, rel=0.05)


def test_a_balance_that_swings_too_far_unlocks_twice():
    """Beyond a turn less the angle at which the stone meets the leaf it comes round to it again: the watch trips."""
    run = ws.simulate(designs.detent().scene().set("bodies.balance.angle", "-345°"), duration=4.0)
    assert ws.verdict(run).name == "trips" and ws.summary(run)["missed_beats"] > 0


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"friction": 0.2, "draw": 10.0}, "draw"),
        ({"undercut": 18.0, "draw": 18.0}, "undercut"),
        ({"teeth": 18, "reach": 10.5}, "reach"),
        ({"travel": 2.0, "lock": 1.2, "clearance": 1.0}, "travel"),
        ({"tip_radius": 2.0, "discharge_radius": 0.3}, "discharge_radius"),
        ({"tip_radius": 20.0}, "tip_radius"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    found = DETENT.refusals(chosen)
    assert blamed in [one.dimension for one in found]


@pytest.mark.slow
def test_five_minutes():
    run = ws.simulate(ws.load(ws.profiles_dir() / PROFILE / "scene.toml"), duration=300.0)
    assert ws.summary(run)["missed_beats"] == 0 and teeth(run) == pytest.approx(600.0, abs=1e-2)
    assert abs(run.energy["residual_relative"]) < 1e-9 and run.worst_penetration < 1e-9


@pytest.mark.slow
def test_time_stepping_comes_to_the_same():
    scene = designs.detent().scene()
    true = ws.beats(ws.simulate(scene, duration=2.0, tolerance=1e-11)).amplitude_deg
    off = [
        float(np.abs(ws.beats(ws.simulate(scene, duration=2.0, method="moreau", step=step)).amplitude_deg - true).max())
        for step in (1.6e-5, 4e-6)
    ]
    assert off[1] < 2e-3 and off[1] < off[0]
