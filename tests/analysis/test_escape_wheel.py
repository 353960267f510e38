"""Are teeth and missed beats counted, and is it said why a run gives no rate?"""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from analysis.made_beats import DEGREE, PERIOD, Events, balance_only, lever_run, lever_scene, polygon, star, steady_swings
from render.fake_runs import disc_run, watch_run

from watchsim.analysis.escape_wheel import missed_beats, progress, standstill, why_no_timing
from watchsim.analysis.summary import summary, summary_text
from watchsim.analysis.timing import beats, is_recorded
from watchsim.commands.pictures import filmed
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.render.opening import last_beats
from watchsim.scene.roles import Roles, drive_direction, keeps_time, partners, pitch, roles
from watchsim.scene.teeth import tooth_count
from watchsim.simulation.state import EventKind

# Are missed beats counted and standing watches noticed?


def test_roles_follow_from_springs_drives_and_contacts():
    scene = lever_scene()
    assert roles(scene) == Roles("balance", "wheel", "lever")
    assert drive_direction(scene, "wheel") == -1.0 and partners(scene, "lever") == {"wheel", "balance", "banking"}
    assert roles(replace(scene, contacts=scene.contacts[1:])) == Roles("balance", "wheel", None)
    assert roles(replace(scene, torques=())) == Roles("balance", None, None)
    assert roles(disc_run().scene) == Roles(None, None, None)


def test_a_drive_given_as_a_table():
    scene = lever_scene()
    table = replace(scene.torques[0], value=0.0, over="angle", table=((-1.0, -2e-6), (0.0, -1e-6)))
    assert drive_direction(replace(scene, torques=(table,)), "wheel") == -1.0


def test_the_wheel_goes_half_a_pitch_per_half_swing():
    run = lever_run(20)
    found = beats(run)
    steps = np.diff(progress(run, "wheel", np.append(found.start[:1], found.end)))
    assert steps == pytest.approx(np.full(19, 12.0 * DEGREE), abs=1e-6)
    assert progress(run, "wheel", np.array([run.t[-1]]))[0] == pytest.approx(20 * 12.0 * DEGREE, rel=1e-9)
    assert missed_beats(run) == 0 and standstill(run, found) is None


@pytest.mark.parametrize("missed", [(5,), (5, 6, 11), tuple(range(3, 9))])
def test_missed_beats(missed):
    run = lever_run(20, missed=missed)
    assert missed_beats(run) == len(missed)


def test_beats_missed_before_the_recorded_window_are_counted():
    for missed in ((), (4, 5, 6, 9)):
        run = lever_run(40, missed=missed, rows_from=4.0)
        found = beats(run)
        assert len(found) == 39 and run.t[0] >= 4.0
        # Which side of the wheel's start the first half swing belongs to is not known: one beat may be forgiven.
        assert len(missed) - 1 <= missed_beats(run) <= len(missed)


def test_what_is_not_recorded_is_said():
    run = lever_run(40, rows_from=4.0)
    assert is_recorded(run, np.array([0.0, 3.99, 4.5, 5.0, 5.1])).tolist() == [False, False, True, True, False]
    gap = (run.t < 4.2) | (run.t > 4.5)
    parts = replace(run, t=run.t[gap], q=run.q[gap], u=run.u[gap], a=run.a[gap])
    assert is_recorded(parts, np.array([4.1, 4.3, 4.6])).tolist() == [True, False, True]
    nothing = replace(run, t=run.t[:0], q=run.q[:0], u=run.u[:0], a=run.a[:0])
    assert not is_recorded(nothing, np.array([1.0])).any() and missed_beats(nothing) is None


def test_a_wheel_without_teeth_misses_nothing_that_is_known():
    run = lever_run(20)
    bare = tuple(replace(body, loops=()) for body in run.scene.bodies)
    assert missed_beats(replace(run, scene=replace(run.scene, bodies=bare))) is None


def test_a_watch_that_stops():
    run = lever_run(20, missed=range(12, 20))
    stands = standstill(run, beats(run))
    # The lock of beat 11 (from 0) is the last that moves the wheel.
    lock = 11.5 * 0.125 + math.asin(22.5 / 270.0) / (8.0 * math.pi)
    assert stands.since == pytest.approx(lock, abs=3e-3)
    assert stands.message.startswith("the escape wheel has stood still since t = 1.4")
    assert (
        "last amplitude 270°" in stands.message and "in contact: wheel.TEETH corner 3 / lever.STONES line 1" in stands.message
    )


def test_two_missed_beats_are_no_standstill():
    run = lever_run(20, missed=(18, 19))
    assert standstill(run, beats(run)) is None


def test_a_watch_that_stops_unseen():
    """Rows are not kept at the end: the passages tell."""
    ticking = lever_run(20)
    early = ticking.t < 1.0
    cut = replace(ticking, t=ticking.t[early], q=ticking.q[early], u=ticking.u[early], a=ticking.a[early])
    assert standstill(cut, beats(cut)) is None
    silent = replace(cut, events=cut.events[cut.events["t"] < 1.0])
    assert standstill(silent, beats(silent)).since == pytest.approx(0.9375)


def test_short_runs_and_other_mechanisms_do_not_stand():
    short = lever_run(2)
    assert standstill(short, beats(short)) is None
    free = replace(lever_run(20), scene=replace(lever_scene(), torques=()))
    assert standstill(free, beats(free)) is None
    assert not watch_run().scene.springs


def test_a_ratchet_that_rests_is_no_watch_that_stopped():
    """A driven wheel held by a sprung body alone: only a lever between them, or a lift angle, makes it an escapement."""
    run = lever_run(20, missed=range(12, 20))
    ratchet = replace(run.scene, contacts=run.scene.contacts[1:], lift_angle=None)
    assert keeps_time(run.scene) and not keeps_time(ratchet) and keeps_time(replace(ratchet, lift_angle=1.0))
    assert keeps_time(replace(ratchet, torques=())) and not keeps_time(replace(ratchet, springs=()))
    held = replace(run, scene=ratchet)
    assert standstill(held, beats(held)) is None and standstill(run, beats(run)) is not None
    told = {numbers["stopped"]: summary_text(one, numbers) for one in (held, run) for numbers in (summary(one),)}
    assert re.search(r"wheel +at −\d+\.\d+° at the end", told[False]) and "missed beats" not in told[False]
    assert "at the end" not in told[True] and "missed beats" in told[True]


def test_the_movie_of_a_run_shows_the_last_swing_or_all_of_a_ratchet():
    run = lever_run(20)
    (start, end), speed = filmed(run, 1 / 20)
    assert end == run.t[-1] and end - start == pytest.approx(1.1 * 0.25) and speed == 1 / 20
    ratchet = replace(run, scene=replace(run.scene, contacts=run.scene.contacts[1:], lift_angle=None))
    assert last_beats(ratchet) == (pytest.approx(0.9 * run.t[-1]), run.t[-1])
    (start, end), speed = filmed(ratchet, 1 / 20)
    assert (start, end) == (run.t[0], run.t[-1]) and (end - start) / speed == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("share", "word"), [(0.45, "balance swinging, now at −90°"), (0.55, "balance held at −90° since t = ")]
)
def test_a_balance_that_has_not_moved_for_half_a_period_is_held(share, word):
    run = lever_run(20, missed=range(12, 20))
    still = run.t > run.simulated - share * 0.25
    q = run.q.copy()
    q[:, 0] = np.where(still, -0.5 * math.pi, 0.0)
    held = replace(run, q=q)
    assert word in standstill(held, beats(held)).message


def test_of_no_instant_there_is_no_progress():
    run = lever_run(4)
    assert progress(run, "wheel", np.zeros(0)).shape == (0,)


@pytest.mark.parametrize("gap", range(4))
def test_wherever_rows_lie_far_apart_nothing_is_recorded_between(gap):
    """Also between the first two of them, and the last two."""
    run = lever_run(4)
    t = np.cumsum([0.0, *(0.9 if k == gap else 0.01 for k in range(4))])
    zeros = np.zeros((5, run.q.shape[1]))
    run = replace(run, t=t, q=zeros, u=zeros, a=zeros)
    middles = 0.5 * (t[:-1] + t[1:])
    assert is_recorded(run, middles).tolist() == [k != gap for k in range(4)] and is_recorded(run, t).all()
    assert not is_recorded(run, np.array([-1e-9, t[-1] + 1e-9])).any()


# Are teeth counted, whatever their shape?


def circle(x: float, y: float, radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(x, y, radius, 0.0, -math.tau if hole else math.tau),), "TEETH", True, hole)


def regular(corners: int) -> Loop:
    return polygon([2e-3 * complex(math.cos(k * math.tau / corners), math.sin(k * math.tau / corners)) for k in range(corners)])


@pytest.mark.parametrize("teeth", [2, 8, 15, 20, 31, 120])
def test_pointed_teeth(teeth):
    assert tooth_count([star(teeth)]) == teeth
    assert tooth_count([star(teeth).moved(0.3, (0.0, 0.0))]) == teeth


def test_arms_and_bore_do_not_count():
    bore, window = circle(0.0, 0.0, 3e-4, hole=True), polygon([1e-3 + 0j, 1.2e-3 + 1e-4j, 1e-3 + 2e-4j], hole=True)
    scene = lever_scene()
    wheel = replace(scene.body("wheel"), loops=(star(15), bore, window))
    bodies = tuple(wheel if body.name == "wheel" else body for body in scene.bodies)
    assert pitch(replace(scene, bodies=bodies), "wheel") == pytest.approx(math.radians(24.0))


def test_layers_that_touch_nothing_do_not_count():
    scene = lever_scene()
    mark = replace(star(1, 1e-3, 9e-4), layer="MARK")
    wheel = replace(scene.body("wheel"), loops=(star(15), mark))
    bodies = tuple(wheel if body.name == "wheel" else body for body in scene.bodies)
    assert math.tau / pitch(replace(scene, bodies=bodies), "wheel") == pytest.approx(15.0)


def test_pins_of_a_lantern_wheel():
    pins = [circle(2e-3 * math.cos(k * math.tau / 12), 2e-3 * math.sin(k * math.tau / 12), 1e-4) for k in range(12)]
    assert tooth_count(pins) == 12


def test_two_wheels_on_one_arbor():
    assert tooth_count([star(8), star(8, 1.0e-3, 8e-4).moved(0.2, (0.0, 0.0))]) == 8
    assert tooth_count([star(12), star(8, 1.0e-3, 8e-4)]) == 4


def test_slightly_inaccurate_drawings():
    """Each corner off by 2 µm in 2.5 mm."""
    points = [edge.start for edge in star(15).edges]
    shaken = [complex(x, y) + 2e-6 * complex(math.cos(7.0 * i * i), math.sin(11.0 * i * i)) for i, (x, y) in enumerate(points)]
    assert tooth_count([polygon(shaken)]) == 15


def test_what_has_no_teeth():
    assert tooth_count([circle(0.0, 0.0, 2e-3)]) == 0
    assert tooth_count([]) == 0
    assert tooth_count([Loop((Line(1e-3, 0.0, 1e-3, 0.0), Line(0.0, 0.0, 0.0, 0.0)), "TEETH", True)]) == 0
    assert tooth_count([regular(3).moved(0.0, (1e-3, 0.0))]) == 1
    scene = lever_scene()
    assert pitch(scene, "lever") is None and pitch(scene, "banking") is None


def test_wheels_that_share_an_outline_have_their_own_teeth() -> None:
    """Asked one after the other, and again: what is known of one is not taken for another."""
    rim, scene = star(12), lever_scene()
    for teeth, known in ((8, 4), (6, 6), (2, 2), (9, 3), (8, 4), (5, None), (6, 6)):
        wheel = replace(scene.body("wheel"), loops=(rim, star(teeth, 1.6e-3, 1.1e-3)))
        found = pitch(replace(scene, bodies=(wheel, *scene.bodies[:2])), "wheel")
        assert found is None if known is None else found == pytest.approx(math.tau / known, rel=1e-12)


def test_wheels_of_other_outlines_have_their_own_teeth() -> None:
    scene = lever_scene()
    for teeth in (12, 8, 9, 12):
        wheel = replace(scene.body("wheel"), loops=(star(teeth),))
        found = pitch(replace(scene, bodies=(wheel, *scene.bodies[:2])), "wheel")
        assert found == pytest.approx(math.tau / teeth, rel=1e-12)


@pytest.mark.parametrize(("share", "count"), [(0.0475, 15), (0.0525, 5)])
def test_inaccuracies_are_less_than_a_twentieth_of_the_largest_moment(share: float, count: int) -> None:
    """Fifteen short pieces, and five at half the radius: moments go with their length and the square of that."""
    turns = [complex(math.cos(k * math.tau / 15), math.sin(k * math.tau / 15)) for k in range(15)]
    pieces = [(1e-3 * z, 1e-6) for z in turns] + [(5e-4 * z, 4e-6 * 3.0 * share / (1.0 - share)) for z in turns[::3]]
    ends = [(z - 0.5j * w * z / abs(z), z + 0.5j * w * z / abs(z)) for z, w in pieces]
    edges = tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in ends)
    assert tooth_count([Loop(edges, "TEETH", True)]) == count


@pytest.mark.parametrize(("teeth", "count"), [(240, 240), (241, 0)])
def test_a_wheel_has_up_to_240_teeth(teeth: int, count: int) -> None:
    assert tooth_count([star(teeth)]) == count


# Is it said why a run gives no amplitude, or no rate?

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
