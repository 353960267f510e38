"""Does `simulate` keep what was asked for, whatever happens, and say how a run ended?"""

import dataclasses
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from interpreter import ROOT
from moving_scenes import box, circle, ground, mirrored, of_kind, profile, touching, turned

import watchsim as ws
from watchsim.contact.cells import forget
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.forces import Spring, Torque
from watchsim.scene.scene import Body, Recording, Scene
from watchsim.simulation.run_end import ledger, ledger_fails, turned_over, usual_energy
from watchsim.simulation.runner import Pace
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory
from watchsim.tolerances import FLIGHT_SIZES, FURTHEST_SIZES

# Does `simulate` keep what was asked for, whatever happens, and give the same numbers however the scene is looked at?

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


@pytest.mark.parametrize("name", ["bench_lever", "swiss_lever"])
def test_the_prefilter_changes_no_bit(name: str) -> None:
    """Every declared pair looked at in every step instead: the same events, to the last bit."""
    fast = simulate(profile(name), 0.3)
    slow = simulate(profile(name), 0.3, prefilter=False)
    assert slow.counts["cells"] == 0 < fast.counts["cells"]
    assert slow.counts["gap_evaluations"] > fast.counts["gap_evaluations"]
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


# What does a user get when no method solves a complementarity problem?

SCRIPT = """
from watchsim.dynamics import acceleration, impact
from watchsim.dynamics.lcp import LcpOutcome, Solver

def unsolvable(m, elements, bearings, level, problem):
    last = problem.last
    last.contacts, last.elements, last.bearings, last.level, last.lemke = m, elements, bearings, level, LcpOutcome.RAY
    problem.solvers[Solver.FAILED] += 1
    return Solver.FAILED

impact.solve_contacts = acceleration.solve_contacts = unsolvable
from watchsim.cli import main
import sys
sys.exit(main(["run", sys.argv[1], "-o", sys.argv[2]]))
"""
SCENE = """
[scene]
gravity = ["0 m/s²", "-9.81 m/s²"]
[bodies.disc]
circle = "10 mm"
motion = "free"
mass = "1 g"
inertia = "50 g·mm²"
position = ["0 mm", "20 mm"]
velocity = ["0.1 m/s", "0 m/s"]
[bodies.ground]
line = [["1 m", "0 mm"], ["-1 m", "0 mm"]]
motion = "fixed"
[[contacts]]
between = ["disc", "ground"]
friction = 0.3
[run]
duration = "1 s"
"""


def test_the_run_is_kept_with_the_problem_and_what_to_try(tmp_path) -> None:
    scene, folder = tmp_path / "scene.toml", tmp_path / "results"
    scene.write_text(SCENE, encoding="utf-8")
    command = [sys.executable, "-c", SCRIPT, str(scene), str(folder)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, env=environment, cwd=ROOT, check=False, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 3, done.stderr
    assert "lcp_failure.json" in done.stderr
    failure = json.loads((folder / "lcp_failure.json").read_text(encoding="utf-8"))
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    fall = np.sqrt(2.0 * 0.01 / 9.81)
    assert failure["level"] == "compression"
    assert failure["lemke_ended_with"] == "ray"
    assert failure["t"] == float(np.float64(summary["simulated_s"]))
    assert abs(failure["t"] - fall) < 1e-9
    (contact,) = failure["contacts"]
    assert abs(contact["gap_rate_m_per_s"] + 9.81 * fall) < 1e-8
    assert "disc.circle" in contact["between"]
    # The disc's own numbers: 1/m for both directions and the radius squared over the inertia for the tangential one.
    np.testing.assert_allclose(failure["G"], [[1e3, 0.0], [0.0, 1e3 + 0.01**2 / 5e-8]], rtol=1e-12, atol=1e-9)
    # In the directions of the contact, whichever way round the problem has them.
    np.testing.assert_allclose(failure["b"], [contact["gap_rate_m_per_s"], contact["slip_m_per_s"]], rtol=1e-12)
    sign = np.where(np.isin(np.arange(2), failure["reversed"]), -1.0, 1.0)
    np.testing.assert_allclose(failure["rhs"][1] / failure["rhs"][0], (sign * failure["b"])[1] / failure["b"][0], rtol=1e-12)
    assert abs(abs(contact["slip_m_per_s"]) - 0.1) < 1e-12
    assert len(failure["A"]) == len(failure["rhs"]) == 3
    assert failure["what_to_try"]
    assert (folder / "trajectory.npz").is_file()
    assert summary["lcp_failures"] == 1
    assert summary["stop"] == "LCP_FAILED"


# Does a run end where a body goes so far that its contacts are lost in rounding, and say which one?

SCENE_FAR_AWAY = Path(__file__).parents[1] / "data" / "fuzz" / "endless-step.toml"
WHEEL = """
[scene]
title  = "A wheel without a load"
schema = 1

[bodies.wheel]
circle  = "5 mm"
motion  = "pivot"
mass    = "1 g"
inertia = "1e-9 kg·m²"

[[torques]]
body  = "wheel"
value = "1e20 N·m"

[run]
duration = "1 s"
"""


def test_what_flies_off_ends_the_run_at_the_distance_of_the_closed_form() -> None:
    scene = ws.load(SCENE_FAR_AWAY)
    run = ws.simulate(scene)
    start, far = 0.15, FURTHEST_SIZES * compile_scene(scene).size
    # Looked at after each flight, which is no longer than FLIGHT_SIZES.
    assert math.isclose(run.simulated, math.sqrt(2.0 * (far - start) / 1e30), rel_tol=FLIGHT_SIZES / FURTHEST_SIZES)
    assert run.stop == Stop.FAR_AWAY and run.stop.gave_up and not run.stop.is_wrong
    assert "disc is at 5e+08 m, rounded to 6e-08 m" in run.stop_message


def test_what_spins_up_without_end_is_named_with_its_angle(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(WHEEL)
    run = ws.simulate(tmp_path / "scene.toml")
    # From rest under a constant torque M: angle = M t² / 2 J.
    assert math.isclose(run.simulated, math.sqrt(2.0 * FURTHEST_SIZES * 1e-9 / 1e20), rel_tol=FLIGHT_SIZES / FURTHEST_SIZES)
    assert run.stop == Stop.FAR_AWAY and "wheel is at 1e+10 rad, rounded to 2e-06 rad" in run.stop_message


# Does the ledger of a run close, and by how much may it miss? Worked by hand.

FIELDS = ("force", "stiffness", "mass", "scale", "rate", "driven")


def model(*rows: tuple[float, ...]) -> Any:
    """Coordinates with these fields."""
    table = np.array(rows).reshape(-1, len(FIELDS))
    return SimpleNamespace(coordinates=np.rec.fromarrays(table.T, names=",".join(FIELDS)))


NOTHING = model((0.0, 0.0, 1.0, 1.0, 1.0, 0.0))


def test_what_comes_in_is_stored_or_lost_but_for_the_residual() -> None:
    made = ledger(10.0, {"friction": 1.5, "damping": 2.5}, (3.0, 8.5), 0.0)
    assert (made["in_J"], made["stored_J"], made["dissipated"]) == (10.0, 5.5, {"friction": 1.5, "damping": 2.5})
    assert made["residual_J"] == pytest.approx(0.5)
    assert made["residual_relative"] == pytest.approx(0.5 / 10.0)


@pytest.mark.parametrize(("drive", "lost", "stored", "scale"), [
    (-20.0, 3.0, (3.0, 8.5), 20.0),  # what comes in
    (2.0, 13.0, (3.0, 8.5), 13.0),  # what is lost
    (2.0, 3.0, (-30.0, 8.5), 38.5),  # what more is stored
    (2.0, 3.0, (8.0, -12.0), 20.0),  # or less
    (2.0, 3.0, (7.0, 8.5), 8.5),  # what is held at the end
    (2.0, 3.0, (9.5, 8.5), 9.5),  # or at the start
])  # fmt: skip
def test_the_residual_is_seen_against_the_largest_of_all(
    drive: float, lost: float, stored: tuple[float, float], scale: float
) -> None:
    made = ledger(drive, {"friction": lost}, stored, 0.0)
    residual = drive - (stored[1] - stored[0]) - lost
    assert made["residual_J"] == pytest.approx(residual) and made["residual_relative"] == pytest.approx(abs(residual) / scale)


def test_a_swing_under_a_constant_force_turns_over_its_energy() -> None:
    """From rest at rest of the spring it goes to 2 f/k and back: 2 f²/k; without a spring or driven it counts nothing."""
    swinging = model(
        (0.6, 4.0, 1.0, 1.0, 1.0, 0.0), (0.3, 0.2, 1.0, 1.0, 1.0, 0.0),
        (90.0, 0.0, 1.0, 1.0, 1.0, 0.0), (90.0, 2.0, 1.0, 1.0, 1.0, 1.0),
    )  # fmt: skip
    assert turned_over(swinging) == pytest.approx(2.0 * 0.09 / 0.2)
    assert turned_over(NOTHING) == turned_over(model()) == 0.0
    made = ledger(1e-3, {"friction": 0.0}, (0.0, 0.0), turned_over(swinging))
    assert made["residual_relative"] == pytest.approx(1e-3 / (2.0 * 0.09 / 0.2))
    assert ledger(0.0, {"friction": 0.0}, (0.0, 0.0), 0.0)["residual_relative"] == 0.0
    assert ledger(1e-12, {}, (0.0, 0.0), 0.0)["residual_relative"] == 1.0


def test_the_usual_energy_is_that_of_usual_speeds() -> None:
    """Of what is not driven."""
    moving = model((0.0, 0.0, 3.0, 0.5, 4.0, 0.0), (0.0, 0.0, 0.25, 2.0, 5.0, 0.0), (0.0, 0.0, 9.0, 9.0, 9.0, 1.0))
    assert usual_energy(moving) == pytest.approx(0.5 * (3.0 * 4.0 + 0.25 * 100.0))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize(("tolerance", "allowed"), [(1e-9, 1e-6), (1e-10, 1e-6), (1e-8, 1e-5)])
def test_a_ledger_fails_by_more_than_a_millionth_of_what_is_turned_over(
    tolerance: float, allowed: float, share: float, sign: float
) -> None:
    """Or a thousand tolerances: of what was ever in motion, came in, is stored and lost."""
    turned = 5.0 + 7.0 + 3.0 + 1.5 + 2.5
    energy = {
        "in_J": sign * 7.0, "stored_J": -sign * 3.0, "dissipated": {"friction": 1.5, "damping": 2.5},
        "residual_J": sign * share * allowed * turned,
    }  # fmt: skip
    assert ledger_fails(energy, 5.0, tolerance) == (share > 1.0)


# Do slices grow and shrink towards a tenth of a second on the clock?


@pytest.mark.parametrize(
    ("wall", "simulated", "left", "length", "steps"),
    [
        (0.05, 0.4, 16.0, 0.8, 96.0),  # twice as long
        (0.2, 0.4, 16.0, 0.2, 24.0),  # half as long
        (0.001, 1.0, 1.0, 10.0, 256.0),  # ten times and four times at most
        (0.0, 1.0, 1.0, 10.0, 256.0),  # quicker than the clock can tell
        (1000.0, 1e-4, 1.0, 1e-7, 1.0),  # never nothing
        (0.05, 0.4, 0.0, 1.0, 128.0),  # ended by its steps: says nothing about the time
    ],
)
def test_the_next_slice(
    monkeypatch: pytest.MonkeyPatch, wall: float, simulated: float, left: float, length: float, steps: float
) -> None:
    pace, until = Pace(100.0), SimpleNamespace(slice_end=math.nan, steps=math.nan)
    monkeypatch.setattr(time, "perf_counter", iter((100.0, 100.0 + wall)).__next__)
    pace.begin(5.0, until, math.inf)
    until.steps = left
    pace.end(5.0 + simulated, until)
    assert (pace.length, pace.steps) == pytest.approx((length, steps), rel=1e-6, abs=0.0)
