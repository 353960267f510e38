"""Are the phases of a beat those that were put into it, and those of an anchor those of its drawing?"""

import csv
import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import BANKED, CATCH, DEGREE, DROP, ENTRY, LOCK, OMEGA, UNLOCKED, lever_run, lever_scene
from every_time import few
from render.fake_runs import disc_run

from watchsim.analysis.headlines import PHASE_COLUMNS, beats_csv, phases_csv
from watchsim.analysis.phases import Marks, anchor_marks, phases, phases_within
from watchsim.analysis.timeline import shown_beats, timeline_text
from watchsim.analysis.timing import beats, held
from watchsim.pages.timing_sheet import phase_tables
from watchsim.paths import profiles_dir
from watchsim.render.style import passing
from watchsim.scene.forces import Spring
from watchsim.scene.load import load
from watchsim.scene.roles import roles
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

# Are the phases of a beat those that were put into it?

NAMES = ("unlock", "catch-up", "impulse", "drop", "run to banking", "locked")
PLACES = (ENTRY, UNLOCKED, CATCH, DROP, LOCK, BANKED)


def time_of(place: float, middle: float) -> float:
    return middle + math.asin(place / 270.0) / OMEGA


def test_phases_of_the_made_lever():
    run = lever_run(12)
    found = beats(run)
    rows = phases(run, found)
    assert [row.name for row in rows] == [*NAMES * 11][:-1]  # the last beat is not followed by another
    assert [row.beat for row in rows[:7]] == [1] * 6 + [2]
    for first in (0, 6, 30):
        middle = found.t[rows[first].beat - 1]
        starts = [time_of(place, middle) for place in PLACES]
        assert [row.start for row in rows[first : first + 6]] == pytest.approx(starts, abs=1e-12)
        assert [row.end for row in rows[first : first + 6]] == pytest.approx([*starts[1:], starts[0] + 0.125], abs=1e-12)


def test_angles():
    """The wheel turns clockwise: recoil is positive, everything else negative."""
    rows = phases(lever_run(12))
    wheel = [math.degrees(row.turns[0]) for row in rows[:6]]
    assert wheel == pytest.approx([0.25, -0.75, -9.5, -2.0, 0.0, 0.0], abs=1e-6)
    # Beat 1 of the table is the run's second half swing: the balance swings back.
    assert math.degrees(rows[0].angles[2]) == pytest.approx(-ENTRY, abs=1e-6)
    assert math.degrees(rows[0].turns[2]) == pytest.approx(ENTRY - UNLOCKED, abs=1e-6)
    lever = [math.degrees(row.angles[1]) for row in rows[:7]]
    assert lever[0] == pytest.approx(-5.0, abs=1e-6) and lever[5] == pytest.approx(5.0, abs=1e-6)
    assert lever == sorted(lever)
    assert math.degrees(rows[6].angles[0]) == pytest.approx(-24.0, abs=1e-6)


def test_a_dead_beat_wheel_waits_and_does_not_recoil():
    run = lever_run(12)
    start = np.round(run.q[:, 2] / (-12.0 * DEGREE)) * (-12.0 * DEGREE)
    q, u = run.q.copy(), run.u.copy()
    recoiling = (q[:, 2] > start + 1e-9) & (q[:, 2] < start + 0.3 * DEGREE)
    q[recoiling, 2], u[:, 2] = start[recoiling], np.where(recoiling, 0.0, u[:, 2])
    rows = phases(replace(run, q=q, u=u))
    assert [row.name for row in rows[:6]] == list(NAMES)
    assert rows[1].start == pytest.approx(time_of(UNLOCKED, beats(run).t[0]), abs=1e-12)


def test_missed_beats_have_no_phases():
    run = lever_run(12, missed=(4, 7))
    numbers = {row.beat for row in phases(run)}
    assert numbers == set(range(1, 12)) - {4, 7}


def test_only_recorded_beats_have_phases():
    run = lever_run(24, rows_from=2.0)
    rows = phases(run)
    assert rows and min(row.start for row in rows) >= 2.0
    assert {row.beat for row in rows} == set(range(16, 24))


def test_other_mechanisms_have_none():
    assert phases(disc_run()) == []
    run = lever_run(6)
    assert phases(replace(run, scene=replace(lever_scene(), torques=()))) == []
    silent = replace(run, events=run.events[run.events["contact"] < 0])
    assert phases(silent) == []


def test_tables():
    run = lever_run(6)
    found = beats(run)
    rows = list(csv.DictReader("".join(beats_csv(found)).splitlines()))
    assert len(rows) == 5 and rows[0]["beat"] == "1" and rows[0]["period_s"] == "" and rows[0]["beat_error_ms"] == ""
    assert float(rows[3]["amplitude_deg"]) == pytest.approx(270.0) and float(rows[3]["t_s"]) == found.t[3]
    assert float(rows[3]["turn_at_deg"]) == pytest.approx(270.0) and float(rows[4]["rate_s_per_d"]) == pytest.approx(
        0.0, abs=1e-6
    )
    table = list(csv.DictReader("".join(phases_csv(run, found)).splitlines()))
    assert tuple(table[0]) == PHASE_COLUMNS and len(table) == 29
    drop = table[3]
    assert drop["phase"] == "drop" and float(drop["wheel_turn_deg"]) == pytest.approx(-2.0, abs=1e-6)
    assert float(drop["duration_ms"]) == pytest.approx(1e3 * (time_of(LOCK, 0.0) - time_of(DROP, 0.0)), rel=1e-9)


def test_a_table_of_beats_goes_on_from_those_before_and_knows_what_slides() -> None:
    """Metres instead of degrees."""
    found = beats(lever_run(6))
    turning, sliding = (
        list(csv.DictReader("".join(beats_csv(replace(found, angular=angular, before=41))).splitlines()))
        for angular in (True, False)
    )
    assert [row["beat"] for row in turning] == [str(k) for k in range(42, 42 + len(found))]
    for row, other in zip(turning, sliding, strict=True):
        for name in ("turn_at", "amplitude"):
            assert float(row[f"{name}_deg"]) == pytest.approx(math.degrees(float(other[f"{name}_m"])), rel=1e-12)
    assert [float(row["amplitude_m"]) for row in sliding] == found.amplitude.tolist()


# Are the phases of an anchor, and of a detent, those that its drawing and its banks allow?

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
    (made,) = phase_tables(phases(graham), "pendulum")
    assert "pendulum turns" in made and "balance" not in made and "lever turns" not in made and "locked" not in made


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


# Are the marks of an anchor's beat those that loops find, event by event and row by row?

START, END = 2.0, 3.0


def by_loops(times: Any, held: Any, at_events: Any, rows: Any, at_rows: Any, start: float, end: float) -> Marks | None:
    """The definition: the last event before the half swing counts with those in it."""
    earlier_ones = [k for k, t in enumerate(times) if t < start]
    own = earlier_ones[-1:] + [k for k, t in enumerate(times) if start <= t < end]
    runs = {}
    for k, after in pairwise(own):
        free = held[k] == 0 and times[after] > times[k]
        runs[k] = at_events[after] - at_events[k] if free else 0.0
    before, behind = (float(np.interp(t, rows, at_rows)) for t in (start, end))
    if not runs or behind - before <= 0.1 * max(runs.values()):
        return None
    rest = behind - 0.1 * (behind - before)
    ending = {k: run if at_events[k + 1] >= rest else 0.0 for k, run in runs.items()}
    drop = next(k for k in runs if ending[k] == max(ending.values()))
    let_off = times[drop]
    inside = [k for k, t in enumerate(rows) if start <= t < let_off]
    if runs[drop] <= 0.0 or not inside:
        return None
    last = inside[-1] + 1  # a recoil ends at the row of the let-off
    way_back = [(start, before)] + [(rows[k], at_rows[k]) for k in range(inside[0], min(last + 1, len(rows)))]
    lowest = min(angle for _, angle in way_back)
    way = at_events[drop + 1] - lowest
    moved = max(t for t, angle in way_back if angle <= lowest + 1e-6 * way)
    catching = {k: run for k, run in runs.items() if k < drop and times[k] >= moved}
    furthest = max(catching.values(), default=0.0)
    if furthest <= 0.05 * way:
        return Marks(moved, None, None, let_off, times[drop + 1])
    k = next(k for k in catching if catching[k] == furthest)
    return Marks(moved, times[k], times[k + 1], let_off, times[drop + 1])


def made(seed: int) -> tuple[list[float], list[int], list[float], list[float], list[float]]:
    """Random events and rows about the half swing, many at the same instant or place, some steps tiny."""
    rng = np.random.default_rng(seed)
    number = int(rng.integers(0, 14))
    times = np.sort(np.round(rng.uniform(1.6, 3.3, number), int(rng.integers(1, 3))))
    times += np.cumsum(rng.choice([0.0, 4e-4], number))
    rows = np.sort(np.concatenate((times, rng.uniform(1.5, 3.5, int(rng.integers(0, 6))), [1.0, 4.0])))
    ahead = np.cumsum(rng.choice([0.0, 3e-4, 0.02, 0.1, -0.1, 0.4, 1.0], len(rows), p=[0.2, 0.1, 0.2, 0.2, 0.1, 0.1, 0.1]))
    at_events = ahead[np.searchsorted(rows, times)] + rng.choice([0.0, 0.03], number)
    held = rng.choice([0, 0, 1, 2], number)
    return times.tolist(), held.tolist(), at_events.tolist(), rows.tolist(), ahead.tolist()


def found(times: Any, held: Any, at_events: Any, rows: Any, at_rows: Any) -> Marks | None:
    columns = (np.array(one, float) for one in (times, at_events, rows, at_rows))
    t, angle, at, there = columns
    return anchor_marks(t, np.array(held, np.int32), angle, at, there, START, END)


@pytest.mark.parametrize("block", range(10))
def test_random_beats_as_by_loops(block: int) -> None:
    kinds = set()
    for seed in range(200 * block, 200 * (block + 1)):
        case = made(seed)
        wanted = by_loops(*case, START, END)
        assert found(*case) == wanted, seed
        kinds.add("none" if wanted is None else "slides" if wanted.freed is None else "catches up")
    assert kinds == {"none", "slides", "catches up"}


# One beat: the wheel rests at 0, comes off at 2.2 s, catches up by 1 until 2.3 s, is pushed on to 4, drops to 10 and locks.
TIMES, HELD = [1.9, 2.2, 2.3, 2.6, 2.7], [1, 0, 1, 0, 1]
PLACES_ANCHOR_MARKS = [0.0, 0.0, 1.0, 4.0, 10.0]


def beat(**changed: Any) -> Marks | None:
    case = {"times": TIMES, "held": HELD, "at_events": PLACES_ANCHOR_MARKS, "rows": [1.5, 2.0, *TIMES[1:], 3.2]}
    case |= {"at_rows": [0.0, 0.0, *PLACES_ANCHOR_MARKS[1:], 10.0]} | changed
    return found(**case)


def test_one_beat_by_hand() -> None:
    assert beat() == (2.2, 2.2, 2.3, 2.6, 2.7)


@pytest.mark.parametrize("scale", [1.0, 1e-4])
@pytest.mark.parametrize(("catch", "caught"), [(0.049, None), (0.051, 2.3)])
def test_a_twentieth_of_the_way_is_a_catching_up(catch: float, caught: float | None, scale: float) -> None:
    """However small the wheel's steps are."""
    places = [scale * place for place in (0.0, 0.0, 10.0 * catch, 4.0, 10.0)]
    marks = beat(at_events=places, at_rows=[0.0, 0.0, *places[1:], 10.0 * scale])
    assert marks is not None and (marks.caught, marks.freed) == (caught, None if caught is None else 2.2)


@pytest.mark.parametrize(("off", "moved"), [(0.9e-5, 2.2), (1.1e-5, 2.0)])
def test_a_millionth_of_the_way_is_standing(off: float, moved: float) -> None:
    marks = beat(at_rows=[0.0, 0.0, off, *PLACES_ANCHOR_MARKS[2:], 10.0])
    assert marks is not None and marks.moved == moved


@pytest.mark.parametrize(("end", "let_off"), [(8.9, 2.8), (9.1, 2.6)])
def test_a_free_run_that_ends_near_rest_is_the_drop(end: float, let_off: float) -> None:
    """Within a tenth of the beat's advance, of 10; else it is a shorter one later."""
    times, held = [1.9, 2.2, 2.6, 2.7, 2.8, 2.9], [1, 0, 0, 1, 0, 1]
    places = [0.0, 0.0, 0.0, end, 9.95, 10.0]
    marks = found(times, held, places, [1.5, 2.0, 2.1, *times[1:], 3.2], [0.0, 0.0, 0.0, *places[1:], 10.0])
    assert marks is not None and marks.let_off == let_off


@pytest.mark.parametrize(("advance", "goes_on"), [(0.59, False), (0.61, True)])
def test_a_wheel_that_falls_back_does_not_go_on(advance: float, goes_on: bool) -> None:
    """Not by a tenth of its longest free run, of 6."""
    marks = beat(at_rows=[0.0, 0.0, *PLACES_ANCHOR_MARKS[1:], advance + (advance - 10.0) * 0.2 / 0.3])
    assert (marks is not None) is goes_on
    assert math.isclose(np.interp(END, [2.7, 3.2], [10.0, advance + (advance - 10.0) * 0.2 / 0.3]), advance)


@pytest.mark.parametrize("profile", ["swiss_lever", "graham"])
def test_a_beat_that_the_end_of_the_run_cuts_has_the_phases_that_it_has_in_a_longer_run(profile: str) -> None:
    """Pictures shade it: its noises are heard, though its turning point is not reached."""
    longer = simulate(load(profiles_dir() / profile), 5.0, record="all")
    beat = len(beats(longer)) - 2
    known = [one for one in phases(longer) if one.beat == beat and one.name not in ("locked", "recoil")]
    end = known[-1].end + 0.2 * (float(beats(longer).end[beat - 1]) - known[-1].end)
    cut = simulate(load(profiles_dir() / profile), end, record="all")
    assert len(beats(cut)) == beat - 1
    found = [one for one in phases_within(cut, (known[0].start, end)) if one.beat == beat]
    assert [one.name for one in found] == [one.name for one in known] and len(known) >= 2
    assert [one.start for one in found] == pytest.approx([one.start for one in known], abs=1e-9)
    assert [own[0].beat for own in passing(cut, (known[0].start - 1e-3, end))][-1] == beat
