"""Is the limit cycle the one that a long run comes to rest on?"""

import math
from dataclasses import replace

import numpy as np
import pytest
from dead_beat_scenes import one_wheel, two_wheels, with_catch
from every_time import few
from hypothesis import given
from hypothesis import strategies as st
from ordinary.geared_escapements import with_train
from scipy.optimize import brentq

import watchsim as ws
from watchsim.analysis.timing import mean_over
from watchsim.bench.growth import side_by_side
from watchsim.commands.steady import text
from watchsim.scene.scene import Scene
from watchsim.simulation.recording import unevenness
from watchsim.studies.all_cycles import Survey, judged, run_from
from watchsim.studies.return_map import Fixed, Lost, Return, fixed_point
from watchsim.studies.section import Loop, first_section, parts_of
from watchsim.studies.steady import steady


@pytest.fixture(scope="module")
def bench():
    return ws.load(ws.profiles_dir() / "bench_lever")


@pytest.fixture(scope="module")
def swiss():
    return ws.load(ws.profiles_dir() / "swiss_lever")


def changed(profile: str, torque: float, friction: float, restitution: float) -> Scene:
    """Another torque (N·m), and one law for all contacts."""
    scene = ws.load(ws.profiles_dir() / profile)
    contacts = tuple(replace(one, friction=friction, restitution=restitution) for one in scene.contacts)
    drive = next(one for one in scene.torques if one.over == "constant" and one.value)
    torques = tuple(replace(one, value=torque) if one is drive else one for one in scene.torques)
    return replace(scene, torques=torques, contacts=contacts)


def end_of_run(scene: Scene, duration: float, half_swings: int) -> float:
    return float(ws.beats(ws.simulate(scene, duration, record="events", tolerance=1e-11)).amplitude_deg[-half_swings:].mean())


@pytest.mark.slow
def test_a_swing_that_wanders_where_the_map_jumps_is_not_taken_for_the_cycle_beyond() -> None:
    """Of two attractors the run from here comes to the nearer one: 268.05° to 268.07°; 267.51° is beyond a jump of the map."""
    scene = changed("set_a", -5.170956697715495e-07, 0.1375044434273026, 0.8)
    cycle = steady(scene, all_cycles=True)
    assert cycle.found
    assert "does not repeat itself" in cycle.message
    assert [one.amplitudes_deg for one in cycle.cycles] == [pytest.approx((267.510038,), abs=1e-5)]
    below, above = cycle.starts[1:3]  # runs from 268.02° come to the one, from 268.03° to the other
    assert (below.cycle, above.cycle) == (0, None)
    assert 268.02 < below.to_deg < 268.03
    assert cycle.amplitude_deg == pytest.approx(end_of_run(scene, 300.0, 600), abs=2.0 * cycle.amplitude_deg_error)
    assert steady(scene, amplitude=math.radians(267.0)).amplitude_deg == pytest.approx(267.510038, abs=1e-5)


@pytest.mark.slow
def test_blows_of_the_wheel_are_no_knocks() -> None:
    scene = changed("detent", -6.549248804592556e-05, 0.06107153198010555, 0.5)
    cycle = steady(scene)
    assert (cycle.found, cycle.verdict) == (True, "ticks")
    assert abs(cycle.amplitude_deg - end_of_run(scene, 600.0, 60)) <= cycle.amplitude_deg_error


@pytest.mark.slow
def test_what_is_wound_once_in_several_oscillations_comes_back_too() -> None:
    scene = ws.load(ws.profiles_dir() / "remontoir")
    cycle = steady(scene)
    assert cycle.oscillations == 15
    assert abs(cycle.amplitude_deg - end_of_run(scene, 300.0, 60)) <= cycle.amplitude_deg_error < 1e-5


@pytest.mark.parametrize("pairs", few([1, 2], 1))
def test_behind_a_train_of_real_gears(swiss: Scene, pairs: int) -> None:
    """After a turn of the wheel the same leaf of its pinion is in mesh; of the pinion before it after 15."""
    scene = with_train(swiss, pairs)
    cycle = steady(scene)
    assert cycle.found
    assert abs(cycle.amplitude_deg - end_of_run(scene, 225.0, 450)) <= cycle.amplitude_deg_error


def compared(scene, duration):
    """The cycle agrees with the end of a run that has come to rest, by far more closely than is asked."""
    cycle, rest = steady(scene), mean_over(ws.simulate(scene, duration, record="statistics"))
    assert cycle.found
    assert cycle.verdict == "ticks"
    assert rest.amplitude_deg_error < 1e-7
    assert cycle.amplitude_deg == pytest.approx(rest.amplitude_deg, abs=1e-6)
    assert cycle.rate_s_per_d == pytest.approx(rest.rate_s_per_d, abs=1e-4)
    assert cycle.beat_error_ms == pytest.approx(rest.beat_error_ms, abs=1e-6)
    assert cycle.simulated_s < 20.0
    return cycle


def test_against_a_run_to_rest(bench):
    cycle = compared(bench, 50.0)
    assert cycle.oscillations == 1
    assert cycle.amplitude_deg_error < 1e-6
    assert cycle.rate_s_per_d_error < 1e-4
    # What is left of a disturbance after one oscillation, as the run shows it.
    amplitude = ws.beats(ws.simulate(bench, 6.0)).amplitude_deg
    away = amplitude[20:40:2] - cycle.amplitude_deg
    assert away[1:] / away[:-1] == pytest.approx(cycle.multipliers[0], abs=0.002)


def test_out_of_beat(bench):
    """(T1 - T2)/2 = 2 asin(β/A)/ω, but for what the escapement adds."""
    cycle = compared(bench.set("springs.0.rest", "1.5°"), 50.0)
    expected = 2e3 * math.asin(1.5 / cycle.amplitude_deg) / (2.0 * math.pi * 4.0)
    assert cycle.beat_error_ms == pytest.approx(expected, rel=0.1)
    mirrored = steady(bench.set("springs.0.rest", "-1.5°"))
    assert cycle.uneven_ms * mirrored.uneven_ms < 0.0


@pytest.mark.slow
def test_a_watch_that_settles_slowly(swiss):
    compared(swiss, 320.0)


def test_unequal_teeth(bench):
    """An eccentric wheel: the cycle is one turn of it, fifteen oscillations of different amplitudes."""
    scene = bench.set("bodies.wheel.pivot", ["0.004 mm", "0 mm"])
    cycle = steady(scene)
    assert cycle.oscillations == 15
    assert cycle.tooth_spread_deg > 0.4
    run = ws.simulate(scene, 50.0, record="events")
    found = ws.beats(run)
    assert found.amplitude_deg[-30:].mean() == pytest.approx(cycle.amplitude_deg, abs=1e-6)
    assert found.period_s[-30:].mean() == pytest.approx(cycle.period_s, abs=1e-11)
    uneven = 500.0 * unevenness(found.mark) * np.sign(found.end_at - found.start_at)
    assert abs(uneven[-30:].mean()) == pytest.approx(cycle.beat_error_ms, abs=1e-6)
    assert "they differ: the amplitude varies by" in text("Teeth", cycle)
    assert "they differ" not in text("Teeth", replace(cycle, tooth_spread_deg=0.9 * cycle.amplitude_deg_error))
    alike = steady(bench)
    assert cycle.multipliers[0] == pytest.approx(alike.multipliers[0] ** 15, rel=0.1)
    assert cycle.left_after_one()[0] == pytest.approx(alike.left_after_one()[0], rel=0.01)
    assert alike.left_after_one() == (alike.multipliers[0], alike.multipliers_error[0])


@pytest.mark.parametrize("start", ["-200°", "-330°", "-60°"])
def test_the_start_does_not_matter(bench, start):
    usual, other = steady(bench), steady(bench.set("bodies.balance.angle", start))
    assert other.found
    assert other.amplitude_deg == pytest.approx(usual.amplitude_deg, abs=1e-6)
    assert other.rate_s_per_d == pytest.approx(usual.rate_s_per_d, abs=1e-4)


@pytest.mark.parametrize(
    "profile, torque, verdict",
    [("swiss_lever", "-1.5 µN·m", "knocks"), ("swiss_lever", "1 µN·m", "backwards"), ("bench_lever", "-0.01 µN·m", "stops")],
)
def test_where_there_is_no_cycle(profile, torque, verdict):
    scene = ws.load(ws.profiles_dir() / profile).set("run.duration", "8 s")
    cycle = steady(scene.set("torques.0.value", torque))
    assert not cycle.found
    assert cycle.verdict == verdict
    assert cycle.message
    assert cycle.amplitude_deg is None


@pytest.mark.parametrize("share", [1e-5, -1e-5])
def test_a_spring_that_stiffens_with_the_angle_makes_the_rate_depend_on_the_swing(swiss: Scene, share: float) -> None:
    """By 86400 · 3 c A² / (8 k) s/d, Duffing's backbone to first order; with an energy ledger that closes."""
    curved = swiss.set("springs.0.cubic", share * swiss.springs[0].stiffness)
    plain, cycle = ws.steady(swiss), ws.steady(curved)
    swing = math.radians(cycle.amplitude_deg)
    assert cycle.rate_s_per_d - plain.rate_s_per_d == pytest.approx(86400 * 3 * share * swing**2 / 8, rel=2e-3)
    assert abs(ws.simulate(curved, 2.0, 1e-11).energy["residual_relative"]) < 1e-9


def test_a_balance_alone(bench):
    """Its swing dies away by exp(-π / √(Q² - 1/4)) in an oscillation."""
    cycle = steady(ws.load(ws.profiles_dir() / "balance"))
    assert (cycle.found, cycle.verdict) == (False, None)
    assert cycle.multipliers[0] == pytest.approx(math.exp(-math.pi / math.sqrt(250.0**2 - 0.25)), rel=1e-9)
    assert "dies" in cycle.message or "comes to rest" in cycle.message


@pytest.mark.parametrize(
    ("name", "key", "seen"),
    [
        ("incline", "springs", "no body swings on a spring or by gravity"),
        ("jumper", "springs", "jumper is sprung, finger moves as the scene says, and no torque acts"),
        ("cam", "springs", "follower is sprung"),
        ("ratchet", "torques", "wheel is driven, click is sprung and rests on it, and did not swing"),
        ("winding_click", "torques", "wheel is driven, click is sprung"),  # its spring has a stop
    ],
)
def test_what_is_no_watch_has_no_cycle_to_ask_for(name, key, seen):
    with pytest.raises(ws.SceneError, match="nothing keeps an oscillator going") as refused:
        steady(ws.load(ws.profiles_dir() / name))
    (fault,) = refused.value.faults
    assert fault.key == key
    assert seen in fault.message
    assert "scene.toml" in fault.place


def test_on_a_carriage():
    """Where there is no section an ordinary run stands in, and says so."""
    cycle = steady(ws.load(ws.profiles_dir() / "carriage"))
    assert cycle.found
    assert "run of 20 s" in cycle.message
    assert abs(cycle.amplitude_deg - 290.73) < 0.05


def test_what_has_no_section_is_followed_until_it_settles():
    """The hooks of a grasshopper never rest; a run of 60 s, which the scene gives, is too short."""
    scene = ws.load(ws.profiles_dir() / "grasshopper")
    cycle = steady(scene)
    assert cycle.found
    assert abs(cycle.amplitude_deg - end_of_run(scene, 1500.0, 240)) <= cycle.amplitude_deg_error < 1e-4


def test_a_watch_beside_another_has_the_cycle_that_it_has_alone(bench):
    """The two cannot influence each other, and never stand still at one instant."""
    alone, both = steady(bench), steady(side_by_side(bench, 2))
    assert both.found
    assert both.amplitude_deg == pytest.approx(alone.amplitude_deg, abs=1e-6)


def test_a_shifted_pivot_takes_the_start_back(bench):
    """A wheel half a micrometre nearer overlaps the stones at the start; the cycle hardly changes."""
    moved = steady(bench.set("bodies.lever.position.1", "2.886251346 mm"))
    assert moved.found
    assert 0.0 < abs(moved.amplitude_deg - steady(bench).amplitude_deg) < 0.2


def test_a_run_instead_of_a_cycle_gives_way_as_the_search_does():
    """The same where too small a torque leaves no cycle, so that an ordinary run says what happens."""
    scene = ws.load(ws.profiles_dir() / "swiss_lever").set("bodies.wheel.position.1", "0.5 µm")
    assert steady(scene.set("torques.0.value", "0 N·m")).verdict == "trips"


def test_a_racing_wheel_is_seen_at_once():
    """Out of mesh it makes more than a thousand turns in a second, each of them slow to follow."""
    cycle = steady(ws.load(ws.profiles_dir() / "swiss_lever").set("bodies.wheel.position.1", "-0.3 mm"))
    assert (cycle.found, cycle.verdict) == (False, "trips")
    assert cycle.simulated_s < 3.0


def test_a_start_deep_in_each_other_is_refused(bench):
    with pytest.raises(ws.SceneError, match="overlap"):
        steady(bench.set("bodies.lever.angle", "0°"))


def test_the_error_bar_holds(bench):
    """The amplitude of a much finer solver lies within a few errors."""
    coarse = steady(bench, tolerance=1e-6)
    fine = steady(bench, tolerance=1e-11)
    assert 0.0 < abs(coarse.amplitude_deg - fine.amplitude_deg) < 3.0 * coarse.amplitude_deg_error
    assert coarse.amplitude_deg_error < 0.1


def test_brief(bench):
    whole, brief = steady(bench), steady(bench, brief=True)
    assert brief.amplitude_deg == pytest.approx(whole.amplitude_deg, abs=1e-6)
    assert brief.multipliers == ()
    assert brief.simulated_s < whole.simulated_s


def test_the_slope_of_a_scene_like_this_one_shortens_the_search_and_changes_nothing(bench):
    whole = steady(bench)
    begin = {"amplitude": math.radians(1.03 * whole.amplitude_deg), "brief": True}
    plain, led = steady(bench, **begin), steady(bench, **begin, slope=whole.multipliers[0])
    assert led.amplitude_deg == pytest.approx(plain.amplitude_deg, abs=1e-10)
    assert led.simulated_s < 0.8 * plain.simulated_s


@pytest.mark.parametrize("argument", [{"tolerance": 1.0}, {"amplitude": -1.0}, {"amplitude": math.nan}])
def test_bad_arguments(bench, argument):
    with pytest.raises(ValueError, match="must"):
        steady(bench, **argument)


def surveyed(function, known, good=lambda a: True):
    """Of a map in closed form; an oscillation takes 0.25 s."""

    def oscillate(amplitude):
        return Return(function(amplitude), 0.25, "" if good(amplitude) else "knocks", None, np.zeros(0))

    return Survey(oscillate, known)


def test_cubic_map_with_two_stable_cycles():
    """a' = a - 0.1 (a-1)(a-2)(a-3): 1 and 3 attract, 2 repels; slopes 1 - 0.2, 1 + 0.1, 1 - 0.2."""
    found = surveyed(lambda a: a - 0.1 * (a - 1.0) * (a - 2.0) * (a - 3.0), 2.7, lambda a: 0.3 < a < 5.0)
    assert [one.amplitudes[0] for one in found.cycles] == pytest.approx([1.0, 2.0, 3.0], abs=1e-10)
    assert [one.multiplier for one in found.cycles] == pytest.approx([0.8, 1.1, 0.8], abs=1e-8)
    assert [one.stable for one in found.cycles] == [True, False, True]
    low, high = (next(span for span in found.spans if span.cycle == number) for number in (0, 2))
    assert (low.low, low.high, high.low, high.high) == pytest.approx((0.3, 2.0, 2.0, 5.0), rel=1e-4)
    assert {span.verdict for span in found.spans if span.cycle is None} == {"knocks"}


@pytest.mark.parametrize("past", [1e-4, 0.01, 0.6])
def test_period_doubling(past):
    """x' = -(1 + p) x + p x³ about 3: multiplier -(1 + p), and the pair x = ±1 with the multiplier (2p - 1)²."""
    found = surveyed(lambda a: 3.0 - (1.0 + past) * (a - 3.0) + past * (a - 3.0) ** 3, 3.0, lambda a: 1.8 < a < 4.2)
    single = next(one for one in found.cycles if len(one.amplitudes) == 1)
    pair = next(one for one in found.cycles if len(one.amplitudes) == 2)
    assert single.amplitudes[0] == pytest.approx(3.0, abs=1e-10)
    assert (single.multiplier, single.stable) == (pytest.approx(-1.0 - past, abs=1e-8), False)
    assert sorted(pair.amplitudes) == pytest.approx([2.0, 4.0], abs=1e-7)
    assert (pair.multiplier, pair.stable) == (pytest.approx((2.0 * past - 1.0) ** 2, abs=1e-6), True)


@pytest.mark.parametrize("r, stable", [(2.8, False), (3.2, True), (3.5, False)])
def test_logistic_map(r, stable):
    """a' = r a (1 - a): fixed point 1 - 1/r with slope 2 - r; the pair from r > 3 on, with the multiplier 4 + 2r - r²."""
    found = surveyed(lambda a: r * a * (1.0 - a), 0.6, lambda a: 0.0 < a < 1.0)
    pairs = [one for one in found.cycles if len(one.amplitudes) == 2]
    single = max(one.amplitudes[0] for one in found.cycles if len(one.amplitudes) == 1)
    assert single == pytest.approx(1.0 - 1.0 / r, abs=1e-10)
    assert len(pairs) == (1 if r > 3.0 else 0)
    for pair in pairs:
        half = math.sqrt((r - 3.0) * (r + 1.0))
        assert sorted(pair.amplitudes) == pytest.approx([(r + 1.0 - half) / (2 * r), (r + 1.0 + half) / (2 * r)], abs=1e-9)
        assert pair.multiplier == pytest.approx(4.0 + 2.0 * r - r * r, abs=1e-6)
        assert pair.stable is stable


def test_swiss_lever_has_one_cycle_and_a_swing_that_is_too_small():
    """An ordinary run from just below the border stops, from just above it ticks."""
    scene = ws.load(ws.profiles_dir() / "bench_lever")
    cycle = steady(scene, all_cycles=True)
    assert len(cycle.cycles) == 1
    assert cycle.cycles[0].amplitudes_deg[0] == pytest.approx(cycle.amplitude_deg, abs=1e-6)
    assert cycle.cycles[0].multiplier == pytest.approx(cycle.multipliers[0], abs=1e-5)
    assert [one.verdict for one in cycle.starts] == ["stops", "ticks", "overbanks"]
    assert cycle.starts[1].cycle == 0
    loop = Loop(scene, scene.tolerance)
    parts = parts_of(scene, loop.compiled)
    section = first_section(loop, parts, loop.begin())
    assert section.side == cycle.starts[1].side
    for factor, verdict in ((0.99, "stops"), (1.01, "ticks")):
        state = section.at(loop, parts, math.radians(factor * cycle.starts[1].from_deg))
        assert judged(run_from(loop, state, 30.0)).name == verdict
    shown = text(scene.title, cycle)
    assert "cycle 1" in shown
    assert "overbanks" in shown


@pytest.mark.slow
def test_two_wheels_on_one_pendulum_have_two_stable_cycles(tmp_path):
    """E = w Q / (2π) of the wheels that are let off: 2 mN·m alone, or 2 + 4 mN·m."""
    scene = two_wheels(tmp_path, 2.3)
    cycle = steady(scene, all_cycles=True)
    low, high = cycle.cycles
    assert (low.stable, high.stable) == (True, True)
    assert high.amplitudes_deg[0] ** 2 / low.amplitudes_deg[0] ** 2 == pytest.approx(3.0, rel=2e-3)
    assert low.amplitudes_deg[0] == pytest.approx(cycle.amplitude_deg, abs=1e-5)
    assert [one.cycle for one in cycle.starts] == [0, 1]
    border = cycle.starts[0].to_deg
    for start, orbit in ((0.9 * border, low), (1.15 * border, high)):
        other = steady(two_wheels(tmp_path, start))
        assert other.amplitude_deg == pytest.approx(orbit.amplitudes_deg[0], abs=1e-5)


@pytest.mark.slow
def test_a_swing_that_repeats_itself_after_two_oscillations(tmp_path):
    """A catch takes the same work d from each half swing that throws it over; without it x = A² becomes κ x + w."""
    scene = with_catch(tmp_path, 33.0)
    cycle = steady(scene)
    assert cycle.found
    assert cycle.oscillations == 2
    assert "after 2 oscillations" in cycle.message
    found = ws.beats(ws.simulate(scene, 40.0, record="statistics"))
    swings = found.amplitude_deg[-4:]
    pairs = [sorted((swings[i % 4] + swings[(i + 1) % 4]) / 2 for i in (j, j + 2)) for j in (0, 1)]
    assert sorted(cycle.amplitudes_deg) in [pytest.approx(pair, abs=1e-4) for pair in pairs]
    kept = math.exp(-math.pi / math.sqrt(20.0**2 - 0.25))  # of the energy, in a half swing
    free = steady(one_wheel(tmp_path, quality=20, torque=33.0, start=4.5)).amplitude_deg
    squares = np.degrees(found.end_at[-5:]) ** 2
    taken = np.sort(kept * squares[:-1] + (1.0 - kept) * free**2 - squares[1:])
    assert taken[0] < 0.0  # once it is only held against its torque, and gives the work back
    assert taken[1:] == pytest.approx(taken[1], rel=1e-3)
    stiffness = scene.springs[0].stiffness
    through = np.degrees(1.0) * taken[1] * math.radians(1.0) ** 2 * stiffness / 2.0 / 10e-3  # ° of the catch, at 10 mN·m
    assert 5.0 < through < 6.03  # it is thrown from one stop, at 6.03°, to the middle
    assert cycle.multipliers[0] == pytest.approx(kept**4, rel=0.01)


TIP, DROP, LIFT, LOCK = 0.1, 1.5, 0.5, 0.4  # degrees, as drawn in dead_beat_scenes.py
HALF_SPAN, PITCH = 45.0, 12.0


@pytest.mark.parametrize("profile", few(["recoil_anchor", "graham"], 1))
def test_against_a_long_run(profile):
    scene = ws.load(ws.profiles_dir() / profile)
    cycle, rest = steady(scene), mean_over(ws.simulate(scene, 800.0, record="statistics"))
    assert cycle.found
    assert cycle.verdict == "ticks"
    assert cycle.amplitude_deg == pytest.approx(rest.amplitude_deg, abs=1e-8)
    assert cycle.rate_s_per_d == pytest.approx(rest.rate_s_per_d, abs=1e-6)
    assert cycle.beat_error_ms == pytest.approx(rest.beat_error_ms, abs=1e-6)
    assert cycle.simulated_s < 150.0


def test_a_swing_that_a_pallet_ends_in_the_teeth():
    """Heard at the turning point itself, by rounding before or after it: no first noise of the half swing that begins there."""
    scene = ws.designs.recoil_anchor(torque="3.168 mN·m", drop="0.2°").scene()
    cycle, rest = steady(scene), mean_over(ws.simulate(scene, 200.0, record="statistics"))
    assert abs(cycle.multipliers[0]) < 1e-6
    assert cycle.beat_error_ms == pytest.approx(rest.beat_error_ms, abs=1e-3)


def test_too_little_torque_stops_it():
    cycle = steady(ws.load(ws.profiles_dir() / "graham").set("torques.0.value", "-1 µN·m"))
    assert (cycle.found, cycle.verdict) == (False, "stops")


def impulse_angles(lock):
    """Angles (rad) of the oscillator after the middle while a tooth drives it, at equal steps of the wheel; both pallets.

    A tip on a circle slides down a straight face that turns about a point. Geometry by itself: no part of watchsim.
    """
    width = PITCH / 2.0 - DROP - TIP
    pivot = np.array([0.0, 1.0 / math.cos(math.radians(HALF_SPAN))])
    begin, end = math.radians(lock - LIFT) / 2.0, math.radians(lock + LIFT) / 2.0

    def tip(bearing):
        return np.array([math.cos(bearing), math.sin(bearing)])

    def turned(point, angle):
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s], [s, c]]) @ (point - pivot)

    found = []
    for side in (1, -1):  # the entry pallet goes out clockwise, the exit pallet the other way
        middle = 90.0 + side * HALF_SPAN
        bearings = np.radians(np.linspace(middle + width / 2.0, middle - width / 2.0, 201))
        first, last = turned(tip(bearings[0]), side * begin), turned(tip(bearings[-1]), side * end)
        normal = np.array([first[1] - last[1], last[0] - first[0]])

        def off(angle, bearing, side=side, first=first, normal=normal):
            return float(np.dot(turned(tip(bearing), side * angle) - first, normal))

        found += [brentq(off, begin - 1e-3, end + 1e-3, args=(bearing,)) for bearing in bearings]
    return np.array(found)


@pytest.mark.parametrize(
    "lock, quality", few([(0.1, 1000), (0.4, 1000), (0.4, 250)], lambda one: sum(one) < 1000.4, several=True)
)
def test_rate_of_a_short_impulse_that_comes_late(tmp_path, lock, quality):
    """-86400 θ̄/(2QA), with θ̄ the centre of the impulse, in s/d; beside it damping costs 86400/(8Q²)."""
    scene = one_wheel(tmp_path, lock=lock, quality=quality, torque=500.0 / quality, start=6.0, tolerance=1e-12)
    cycle = steady(scene)
    assert cycle.found
    amplitude, angles = math.radians(cycle.amplitude_deg), impulse_angles(lock)
    late = cycle.rate_s_per_d + 86400.0 / (8.0 * quality**2)
    assert late == pytest.approx(-86400.0 * angles.mean() / (2.0 * quality * amplitude), rel=0.01)
    # Airy's integral over the whole impulse; what is left is of second order in 1/Q.
    airy = -86400.0 / (2.0 * quality) * np.tan(np.arcsin(angles / amplitude)).mean()
    assert late == pytest.approx(airy, rel=1.5 / quality)


@pytest.mark.slow
def test_the_same_rate_by_a_run(tmp_path):
    """0.15° of more delay, from 0.3° of more lock, in two runs of 150 s."""
    rates, amplitude = [], 0.0
    for lock in (0.1, 0.4):
        run = ws.simulate(one_wheel(tmp_path, lock=lock, quality=250, torque=2.0, start=4.0), 150.0, record="statistics")
        found = mean_over(run)
        rates.append(found.rate_s_per_d)
        amplitude = found.amplitude_deg
    assert rates[1] - rates[0] == pytest.approx(-86400.0 * 0.15 / (2.0 * 250.0 * amplitude), rel=0.01)


def test_parts_that_rest_on_the_oscillator_follow_it():
    """A recoiling tooth: other amplitudes from the same section are those of a run that begins there."""
    scene = ws.load(ws.profiles_dir() / "recoil_anchor")
    usual = steady(scene)
    for amplitude in (1.7, 2.8):
        assert steady(scene, amplitude=math.radians(amplitude)).amplitude_deg == pytest.approx(usual.amplitude_deg, abs=1e-8)


@pytest.mark.parametrize("friction", few(["3.06 nN·m", "2 nN·m"], 1))
def test_the_cycle_is_that_of_a_run(friction: str) -> None:
    scene = ws.load(ws.profiles_dir() / "swiss_lever" / "scene.toml").set("damping.0.coulomb", friction)
    cycle = ws.steady(scene)
    beats = ws.beats(ws.simulate(scene.set("bodies.balance.angle", f"-{cycle.amplitude_deg + 2.0} °"), 25.0))
    a, b, c = (float(np.mean(beats.amplitude_deg[k : k + 40])) for k in (60, 100, 140))
    assert c - (c - b) ** 2 / ((c - b) - (b - a)) == pytest.approx(cycle.amplitude_deg, abs=2e-3)
    assert abs(c - cycle.amplitude_deg) < abs(b - cycle.amplitude_deg) < abs(a - cycle.amplitude_deg)


OUTSIDE = math.radians(35.0)  # the jewel is out of the fork: the lift angle is 51°


def work_per_beat(scene, run):
    column = run.slices["balance"].start
    angle, velocity = run.q[:, column], run.u[:, column]
    energy = 0.5 * scene.body("balance").inertia * velocity**2 + 0.5 * scene.springs[0].stiffness * angle**2
    inside = np.abs(angle) <= OUTSIDE
    starts = np.flatnonzero(~inside[:-1] & inside[1:])[-11:-1]
    works = []
    for start in starts:
        end = start + 1 + int(np.flatnonzero(~inside[start + 1 :])[0])
        middle = 0.5 * (velocity[start + 1 : end + 1] + velocity[start:end])
        air = scene.damping[0].viscous * np.sum(middle * np.diff(angle[start : end + 1]))
        works.append(energy[end] - energy[start] + air)
    assert len(works) == 10
    return np.mean(works)


@pytest.mark.parametrize("torque", few([-1.3e-6, -0.3e-6, -1.0e-6], 1))
def test_amplitude_is_the_root_of_the_measured_work(swiss, torque):
    scene = swiss.set("torques.0.value", torque)
    cycle = ws.steady(scene)
    run = ws.simulate(scene.set("bodies.balance.angle", f"-{cycle.amplitude_deg}°"), 20.0)
    lost = math.pi * scene.damping[0].viscous * 2.0 * math.pi / cycle.period_s
    assert math.degrees(math.sqrt(2.0 * work_per_beat(scene, run) / lost)) == pytest.approx(cycle.amplitude_deg, rel=3e-4)


def test_the_work_grows_with_the_torque(swiss):
    """The escapement passes on the same share of the wheel's work: the amplitude is the root of the torque, to 1e-3."""
    few, many = (ws.steady(swiss.set("torques.0.value", torque)).amplitude_deg for torque in (-0.4e-6, -1.2e-6))
    assert many / few == pytest.approx(math.sqrt(3.0), rel=1e-3)


def returning(function, good=lambda a: True):
    """A return map of that function, with trouble where `good` is false."""

    def oscillate(amplitude):
        trouble = "" if good(amplitude) else "knocks"
        return Return(function(amplitude), 0.25, trouble, None, np.zeros(0))

    return oscillate


@given(st.floats(0.5, 9.0), st.floats(20.0, 1e4), st.floats(0.3, 9.0), st.none() | st.floats(-2.0, 2.0))
def test_constant_work_per_beat(rest, quality, start, slope):
    """E' = E e^(-4π/Q) + w in one oscillation: A* = √(w / (1 - e^(-4π/Q))), whatever slope the search begins with."""
    kept = math.exp(-2.0 * math.pi / quality)
    found = fixed_point(returning(lambda a: math.sqrt(a * a * kept + rest * rest * (1.0 - kept))), start, slope)
    assert isinstance(found, Fixed)
    # What the search leaves of one return, a share of where it began, over as many returns as a disturbance lives.
    assert found.amplitude == pytest.approx(rest, rel=1e-14 * quality * max(1.0, start / rest) + 1e-12, abs=0.0)
    if abs(start - rest) > 1e-3:
        assert found.slope == pytest.approx(kept, abs=0.05)


def test_the_nearest_stable_one_on_the_way_is_found():
    """a' = a - 0.1 (a-1)(a-2)(a-3): 1 and 3 attract, 2 repels."""

    def cubic(a):
        return a - 0.1 * (a - 1.0) * (a - 2.0) * (a - 3.0)

    assert fixed_point(returning(cubic), 1.9).amplitude == pytest.approx(1.0, abs=1e-12)
    assert fixed_point(returning(cubic), 2.1).amplitude == pytest.approx(3.0, abs=1e-12)


def test_an_oscillating_approach():
    """A multiplier below 0, and one below -1: the fixed point is found all the same, to be called unstable afterwards."""
    for slope in (-0.7, -1.6):
        found = fixed_point(returning(lambda a, m=slope: 3.0 + m * (a - 3.0) - 0.02 * (a - 3.0) ** 3), 3.3)
        assert isinstance(found, Fixed)
        assert found.amplitude == pytest.approx(3.0, abs=1e-12)
        assert found.slope == pytest.approx(slope, abs=0.05)


@pytest.mark.parametrize("edge, start, rising", [(5.0, 4.0, True), (2.0, 2.9, False)])
def test_the_edge_of_regular_work_is_told(edge, start, rising):
    """The orbit leaves the region before it comes to a fixed point: at 6 above the edge 5, at 1 below the edge 2."""
    target = 6.0 if rising else 1.0
    inside = (lambda a: a < edge) if rising else (lambda a: a > edge)
    found = fixed_point(returning(lambda a: target + 0.97 * (a - target), inside), start)
    assert isinstance(found, Lost)
    assert found.rising is rising
    assert found.trouble == "knocks"
    assert found.amplitude == pytest.approx(edge, rel=0.01)


def test_a_newton_step_past_the_edge_comes_back():
    """Newton's first step overshoots into trouble; the fixed point lies short of it."""
    found = fixed_point(returning(lambda a: a + 0.05 * math.tanh(40.0 * (3.0 - a)), lambda a: a < 3.1), 2.0)
    assert isinstance(found, Fixed)
    assert found.amplitude == pytest.approx(3.0, abs=1e-11)


def test_a_swing_that_dies_away():
    found = fixed_point(returning(lambda a: 0.9 * a), 1.0)
    assert isinstance(found, Lost)
    assert not found.rising


def test_trouble_from_the_first_oscillation():
    found = fixed_point(returning(lambda a: a, lambda a: False), 1.0)
    assert isinstance(found, Lost)
    assert found.amplitude == 1.0
