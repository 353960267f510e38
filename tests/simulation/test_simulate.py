"""Does `simulate` keep what was asked for, whatever happens, and give the same numbers however the scene is looked at?"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from moving_scenes import box, circle, ground, mirrored, of_kind, profile, touching, turned

from watchsim.candidates.pair_cache import forget
from watchsim.scene.body import Body
from watchsim.scene.force import Spring, Torque
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import runner, slice_pace
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

NAMES = ("kind", "contact", "body")
# s: a contact without gap or speed that begins to close is noticed after sqrt(2 gap_zero / acceleration).
ONSET = 1e-9


def told(done: Trajectory):
    """All events but the notes on accumulation: whether a rebound of 1e-15 m/s counts as one is a matter of rounding."""
    return done.events[done.events["kind"] != EventKind.ACCUMULATION]


def balance(w: float = 25.0) -> Scene:
    body = Body("balance", "pivot", angle=1.0, inertia=1e-9)
    return Scene("balance", (body,), springs=(Spring("balance", 1e-9 * w * w),), duration=2.0)


def test_record_windows() -> None:
    windows = ((0.2, 0.3), (1.0, 1.5))
    done = simulate(balance(), record=windows)
    inside = [(low <= done.t) & (done.t <= high) for low, high in windows]
    assert np.sum(~inside[0] & ~inside[1]) == 4  # the row before and the row after each
    assert all(part.sum() > 10 for part in inside)
    everything = simulate(balance())
    assert np.array_equal(done.events, everything.events)
    kept = [any(low <= t <= high for low, high in windows) for t in everything.t]
    rows = np.array(kept) | np.append(kept[1:], False) | np.append(False, kept[:-1])
    assert np.array_equal(done.q, everything.q[rows])
    assert done.simulated == everything.simulated == 2.0


def test_scene_says_duration_window_and_tolerance() -> None:
    scene = Scene("balance", balance().bodies, balance().springs, duration=0.5, record=Recording(((0.4, 0.5),)), tolerance=1e-6)
    done = simulate(scene)
    assert (done.simulated, done.tolerance) == (0.5, 1e-6)
    assert done.t[0] < 0.4 <= done.t[1]
    assert simulate(scene, 0.25, 1e-8).simulated == 0.25


def test_interrupt_keeps_what_was_simulated() -> None:
    seen = []

    def progress(now: float, duration: float) -> None:
        seen.append((now, duration))
        if now > 5.0:
            raise KeyboardInterrupt

    done = simulate(balance(), 1e4, progress=progress)
    assert done.stop == Stop.INTERRUPTED
    assert done.simulated == seen[-1][0] > 5.0
    assert seen[-1][1] == 1e4
    assert done.t[-1] == done.simulated
    assert done.q[-1][0] == pytest.approx(math.cos(25.0 * done.simulated), abs=1e-9 * done.simulated)
    assert "interrupted" in done.stop_message


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
def test_bad_duration(bad: float) -> None:
    with pytest.raises(ValueError, match="duration must be a positive number of seconds"):
        simulate(balance(), bad)


@pytest.mark.parametrize("bad", [0.0, -1e-9, 1.0, math.nan, 1e-16])
def test_bad_tolerance(bad: float) -> None:
    with pytest.raises(ValueError, match="tolerance must lie between"):
        simulate(balance(), 1.0, bad)


def test_small_buffers_lose_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = simulate(profile("incline"), 0.6)
    monkeypatch.setattr(runner, "ROWS", 3)
    monkeypatch.setattr(runner, "EVENTS", 3)
    pieces = simulate(profile("incline"), 0.6)
    assert np.array_equal(whole.t, pieces.t)
    assert np.array_equal(whole.q, pieces.q)
    assert np.array_equal(whole.events, pieces.events)


def test_rows_and_events_are_in_order() -> None:
    done = simulate(profile("bench_lever"), 0.3)
    assert np.all(np.diff(done.t) >= 0.0)
    assert np.all(np.diff(done.events["t"]) >= 0.0)
    assert done.t[0] == 0.0
    assert done.t[-1] == 0.3
    assert done.counts["lcp_failures"] == 0
    assert done.q.shape == done.u.shape == done.a.shape == (len(done.t), 3)


def test_two_runs_are_identical() -> None:
    first, second = (simulate(profile("bench_lever"), 0.3) for _ in range(2))
    for name in ("t", "q", "u", "a", "events"):
        assert np.array_equal(getattr(first, name), getattr(second, name))


def test_slices_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """How often the loop looks at the clock must not change a bit of the answer."""
    first = simulate(profile("bench_lever"), 0.3)
    monkeypatch.setattr(slice_pace, "SLICE_WALL", 1e-4)
    second = simulate(profile("bench_lever"), 0.3)
    assert np.array_equal(first.q[-1], second.q[-1])
    assert np.array_equal(first.events, second.events)


@pytest.mark.parametrize("name", ["bench_lever", "swiss_lever"])
def test_the_prefilter_changes_no_bit(name: str) -> None:
    """Every declared pair looked at in every step instead: the same events, to the last bit."""
    fast = simulate(profile(name), 0.3)
    slow = simulate(profile(name), 0.3, prefilter=False)
    assert slow.counts["cells"] == 0 < fast.counts["cells"]
    assert slow.counts["gap_evaluations"] > 5 * fast.counts["gap_evaluations"]
    for field in ("t", "q", "u", "a", "events"):
        assert np.array_equal(getattr(fast, field), getattr(slow, field))


def test_runs_of_one_geometry_share_what_was_asked() -> None:
    """A second run asks nothing anew, whatever its torque, and is the same as if it had asked for itself."""
    forget()
    scene = profile("bench_lever")
    stronger = dataclasses.replace(scene, torques=tuple(dataclasses.replace(t, value=1.1 * t.value) for t in scene.torques))
    alone = simulate(stronger, 0.3)
    forget()
    first = simulate(scene, 0.5)
    after = simulate(stronger, 0.3)
    assert first.counts["cells_asked"] > 0 == after.counts["cells_asked"]
    assert np.array_equal(alone.events, after.events) and len(alone.events) > 100


@pytest.mark.parametrize("angle", [0.7, 2.5])
def test_turned_scene(angle: float) -> None:
    plain, other = simulate(profile("bench_lever"), 0.5), simulate(turned(profile("bench_lever"), angle), 0.5)
    for name in NAMES:
        assert np.array_equal(told(plain)[name], told(other)[name])
    assert told(other)["t"] == pytest.approx(told(plain)["t"], abs=ONSET)
    assert other.q[-1] - angle == pytest.approx(plain.q[-1], abs=1e-11)
    assert other.u[-1] == pytest.approx(plain.u[-1], abs=1e-9)


def test_mirrored_scene() -> None:
    """Contacts have other numbers there, so that events of one instant may come in another order."""
    plain, other = simulate(profile("bench_lever"), 0.5), simulate(mirrored(profile("bench_lever")), 0.5)
    assert np.array_equal(np.sort(told(plain)["kind"]), np.sort(told(other)["kind"]))
    assert told(other)["t"] == pytest.approx(told(plain)["t"], abs=ONSET)
    assert -other.q[-1] == pytest.approx(plain.q[-1], abs=1e-11)
    assert -other.u[-1] == pytest.approx(plain.u[-1], abs=1e-9)


def test_a_sliding_body_between_two_walls() -> None:
    """It flies to and fro; every impact takes the share 0.2 of its speed."""
    walls = tuple(Body(name, "fixed", (x, 0.0), loops=(box(0.2, 1.0),)) for name, x in (("left", -1.1), ("right", 1.1)))
    body = Body("puck", "slide", (0.0, 0.0), velocity=(2.0,), mass=0.3, loops=(box(0.2, 0.2),))
    contacts = touching("puck", "left", restitution=0.8) + touching("puck", "right", restitution=0.8)
    done = simulate(Scene("walls", (body, *walls), contacts=contacts), 5.0)
    times, t, speed = [], 0.0, 2.0
    t += 0.9 / speed
    while t < 5.0:
        times.append(t)
        speed *= 0.8
        t += 1.8 / speed
    impacts = of_kind(done, EventKind.IMPACT)
    first = sorted({round(event["t"], 12) for event in impacts})
    assert first == pytest.approx(times, rel=1e-11)
    assert abs(done.u[-1][0]) == pytest.approx(speed, rel=1e-12, abs=0.0)
    assert done.energy["dissipated"]["impacts"] == pytest.approx(0.15 * (4.0 - speed**2), rel=1e-12, abs=0.0)


def test_a_free_body_thrown() -> None:
    """A parabola, with constant spin, and one bounce without friction."""
    ball = Body("ball", "free", (0.0, 1.0), 0.2, (3.0, 4.0, 5.0), mass=0.4, inertia=0.01, loops=(circle(0.1),))
    scene = Scene("throw", (ball, ground()), contacts=touching("ball", "ground", restitution=0.7), gravity=(0.0, -9.81))
    done = simulate(scene, 1.5)
    speed = math.sqrt(16.0 + 2.0 * 9.81 * 0.9)
    hit = (4.0 + speed) / 9.81
    after = 1.5 - hit
    assert of_kind(done, EventKind.IMPACT)[0]["t"] == pytest.approx(hit, rel=1e-13)
    expected = [4.5, 0.1 + 0.7 * speed * after - 0.5 * 9.81 * after**2, 7.7]
    assert done.q[-1] == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert done.at(0.5)[0] == pytest.approx([1.5, 1.0 + 2.0 - 0.5 * 9.81 * 0.25, 2.7], rel=1e-12)


def test_a_scene_without_contacts_or_forces() -> None:
    done = simulate(Scene("drift", (Body("rotor", "pivot", velocity=(2.0,), inertia=1.0),)), 1.0)
    assert (done.stop, done.q[-1][0]) == (Stop.DURATION, 2.0)
    assert len(done.events) == 0
    assert done.energy["residual_relative"] == 0.0


@pytest.mark.parametrize("torque", [0.0, 3.0])
def test_the_account_of_a_lossless_swing_closes_to_rounding(torque: float) -> None:
    """At the end of whole periods nothing has come in and nothing more is stored: what swings is the measure."""
    bodies = (Body("balance", "pivot", angle=1.0 if torque == 0.0 else 0.0, inertia=1.0),)
    scene = Scene("swing", bodies, (Spring("balance", math.tau**2),), (Torque("balance", torque),))
    for end in (1.0, 3.0, 2.7):
        energy = simulate(scene, end).energy
        assert energy["residual_relative"] < 1e-13, energy
    assert abs(simulate(scene, 3.0).energy["in_J"]) < 1e-12


def test_nothing_of_a_trajectory_can_be_written_over() -> None:
    done = simulate(Scene("drift", (Body("rotor", "pivot", velocity=(2.0,), inertia=1.0),)), 1.0)
    for name in ("t", "q", "u", "a", "events", "end_q", "end_u"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(done, name)[...] = 0
    with pytest.raises(ValueError, match="read-only"):
        done.events["t"][0:] = 0.0


def test_times_may_carry_their_units() -> None:
    scene = profile("incline")
    one = simulate(scene, "50 ms", method="moreau", step="1 ms")
    assert (one.simulated, one.step) == (0.05, 1e-3)
    assert np.array_equal(one.q, simulate(scene, 0.05, method="moreau", step=1e-3).q)
    for wrong, words in (("1", "duration: a bare number needs a unit"), ("1 mm", "is a length; here a time is needed")):
        with pytest.raises(ValueError, match=words):
            simulate(scene, wrong)
