"""Are the phases of an anchor, and of a detent, those that its drawing and its banks allow?"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from every_time import few

from watchsim.analysis.timeline.shown_beats import shown_beats
from watchsim.analysis.timeline.timeline_table import timeline_text
from watchsim.analysis.timing.beats import beats
from watchsim.analysis.timing.body_contacts import held
from watchsim.analysis.timing.marks.anchor_phases import _next_ones
from watchsim.analysis.timing.phases import phases
from watchsim.pages.timing_sheet.phase_tables import phase_tables
from watchsim.profiles_path import profiles_dir
from watchsim.render.figures.passing_phases import passing
from watchsim.scene.file.load import load
from watchsim.scene.force import Spring
from watchsim.scene.roles import roles
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.simulate import simulate

HALF_PITCH = math.radians(6.0)  # of 30 teeth


def run_of(name: str, duration: float, **asked: object) -> Trajectory:
    return simulate(load(profiles_dir() / name / "scene.toml"), duration, **asked)


@pytest.fixture(scope="module")
def graham() -> Trajectory:
    return run_of("graham", 6.0)


def test_a_dead_beat_anchor_is_pushed_over_its_lift_and_then_stands_locked(graham):
    """Impulse faces of 2° end 0.4° further behind the middle than they begin before it; the wheel goes on by half a pitch."""
    found = phases(graham)[6:]
    assert [one.name for one in found[:6]] == ["impulse", "drop", "locked"] * 2
    for one in found:
        if one.name == "impulse":
            assert abs(math.degrees(one.angles[2])) == pytest.approx(0.8, abs=1e-5)
            assert abs(math.degrees(one.turns[2])) == pytest.approx(2.0, abs=1e-5)
        if one.name == "locked":
            assert abs(one.turns[0]) < 1e-9
    for impulse, drop in zip(found[0::3], found[1::3], strict=False):
        assert impulse.turns[0] + drop.turns[0] == pytest.approx(-HALF_PITCH, abs=1e-9)
        assert impulse.end == drop.start


def test_phases_of_an_anchor_lie_end_to_end(graham):
    found = phases(graham)
    assert [one.start for one in found[1:]] == [one.end for one in found[:-1]]
    assert {one.beat for one in found} == set(range(1, len(beats(graham)) + 1))
    (names,) = {tuple(one.name for one in beat) for beat in passing(graham, (3.0, 5.0))[1:-1]}
    assert names == ("impulse", "drop", "locked")


def test_a_recoil_anchor_turns_its_wheel_back_until_it_returns():
    run = run_of("recoil_anchor", 6.0)
    back = [one for one in phases(run)[6:] if one.name == "recoil"]
    turns = beats(run).end
    assert len(back) > 5
    for one in back:
        assert 0.1 < math.degrees(one.turns[0]) < 0.5  # against the drive
        assert np.abs(turns - one.end).min() < 1e-9  # tooth and pallet stay in touch: they turn together


def test_the_books_of_an_anchors_beat_close(graham):
    """What friction took, worked out from forces, is what the other flows leave: a weight that swings supplies nothing."""
    for beat in shown_beats(graham):
        supplied = sum(stage.energy.supplied for stage in beat.stages)
        torque = abs(graham.scene.torques[0].value)
        assert supplied == pytest.approx(torque * HALF_PITCH, rel=1e-6)
        assert abs(beat.residual) < 1e-8 * supplied
    assert "recoil" not in timeline_text(graham) and timeline_text(graham).count("pendulum ") < 12


def test_a_record_that_begins_while_the_wheel_rests_tells_the_same_phases():
    whole, late = run_of("detent", 2.2, record="all"), run_of("detent", 2.2, record=((1.2, 2.2),))
    told = phases(late)
    same = [one for one in phases(whole) if one.start >= told[0].start - 1e-9]
    assert [(one.name, one.on) for one in told] == [(one.name, one.on) for one in same] and len(told) >= 6
    assert "impulse" in {one.name for one in told}
    assert [one.start for one in told] == pytest.approx([one.start for one in same], abs=1e-9)


def test_contacts_that_hold_before_the_first_event_are_counted():
    close, out = EventKind.CLOSE, EventKind.OPEN
    kinds = np.array([out, close, out, close, out, close])
    assert held(np.arange(6.0), kinds).tolist() == [0, 1, 0, 1, 0, 1]
    kinds = np.array([close, out, out, close, out])  # the second record begins with one that holds
    assert held(np.arange(5.0), kinds, ((0.0, 1.5), (1.9, 4.0))).tolist() == [1, 0, 0, 1, 0]


def test_the_table_of_an_anchor_names_no_lever(graham):
    (made,) = phase_tables(phases(graham))
    assert "balance turns" in made and "lever turns" not in made and "locked" not in made


@pytest.mark.parametrize("sprung", [False, True])
def test_the_pallets_of_an_anchor_take_turns(sprung):
    """Also where a pendulum hangs on a spring."""
    scene = load(profiles_dir() / "graham" / "scene.toml")
    name = roles(scene).oscillator
    spring = (Spring(name, 1e-6 * scene.body(name).inertia),) if sprung else ()
    told = [beat.stages[0].pallet for beat in shown_beats(simulate(replace(scene, springs=spring), 6.0))]
    assert set(told[:2]) == {"entry", "exit"} and told[2:] == told[:-2]


@pytest.mark.parametrize(("name", "duration"), few([("cylinder", 2.0), ("pin_wheel", 6.0), ("duplex", 2.0)], 2, several=True))
def test_without_stones_on_either_side_none_is_named(name, duration):
    told = [beat.stages[0].pallet for beat in shown_beats(run_of(name, duration))]
    assert len(told) > 1 and not any(told)


@pytest.mark.parametrize("told", list(itertools.product((False, True), repeat=4)))
def test_a_wheel_that_goes_on_every_second_beat_is_followed_to_the_end(told):
    """As in a duplex escapement; a beat that is not told has no second."""
    marks = ["a", None, "c", None]
    wanted = [marks[i + 1] or (marks[i + 2] if told[i + 1] and i < 2 else None) for i in range(3)]
    assert list(_next_ones(marks, np.array(told))) == wanted
