"""Do incline and bench lever move as a closed form and other engines say?"""

import functools
import math

import numpy as np
import pytest
import shapely
from moving_scenes import of_kind, profile
from naive.distance_oracle import chords
from reference import incline_closed_form as closed_form

from watchsim.scene.forces import Side
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# Does the disc bounce, slide and roll down its incline as the closed form says?

FILES = {"0.3": "scene.toml", "0.13": "scene_mu013.toml", "0.10": "scene_mu010.toml"}
TIMES = ("0.1", "0.3", "0.5", "1", "2", "3")


@functools.cache
def run(mu: str) -> Trajectory:
    return simulate(profile("incline", FILES[mu]), 3.0)


@pytest.mark.parametrize("mu", FILES)
@pytest.mark.parametrize("t", TIMES)
def test_motion(mu: str, t: str) -> None:
    """Position, angle, speed and spin to 1e-9 of themselves; the disc rolls towards +x, so its angle runs negative."""
    truth = closed_form.reference(t, mu)
    q, u = run(mu).at(float(t))
    found = [q[0], -q[2], u[0], -u[2]]
    wanted = [float(value) for value in (truth.x, truth.theta, truth.v, truth.spin)]
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("mu", FILES)
def test_the_bouncing_ends_when_it_should(mu: str) -> None:
    found = of_kind(run(mu), EventKind.ACCUMULATION)
    assert len(found) == 1
    assert found[0]["value"] == pytest.approx(float(closed_form.accumulation()), rel=1e-9)
    first = of_kind(run(mu), EventKind.IMPACT)[0]
    assert first["t"] == pytest.approx(float(closed_form.first_impact()), rel=1e-13, abs=0.0)


@pytest.mark.parametrize("mu", FILES)
def test_the_disc_rests_on_the_plane_afterwards(mu: str) -> None:
    done = run(mu)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-9
    assert abs(done.at(3.0)[0][1] - 0.05) < 1e-15
    assert done.energy["residual_relative"] < 1e-10


def test_sliding_turns_into_rolling_when_it_should() -> None:
    """With friction 0.13 the disc slides on after the bouncing and rolls from 1.2507... s on."""
    sticks = of_kind(run("0.13"), EventKind.STICK)
    assert [event["t"] for event in sticks] == pytest.approx([float(rolling_begins())], rel=1e-9)


def rolling_begins():
    return closed_form.rolling_begins(closed_form.settled(closed_form.mpf("0.13")), closed_form.mpf("0.13"))


def test_it_never_rolls_with_friction_010() -> None:
    assert not of_kind(run("0.10"), EventKind.STICK)


# Does the bench lever tick as three other engines say: every beat, amplitude, period, energy?

HALF_PITCH = math.pi / 15.0
AMPLITUDE_DEG, PERIOD = 290.73, 0.25006568  # window 13 s to 15 s, an independent Moreau stepping to 5e-7 s


def column(done: Trajectory, body: str, times) -> np.ndarray:
    return done.sample(np.asarray(times))[0][:, done.slices[body]][:, 0]


def turns(done: Trajectory, start: float, end: float):
    """Times and angles of the balance's turning points."""
    found = done.events[(done.events["kind"] == EventKind.TURN) & (done.events["t"] >= start) & (done.events["t"] <= end)]
    return found["t"], found["value"]


def amplitude_and_period(done: Trajectory, start: float, end: float) -> tuple[float, float]:
    """Mean amplitude in degrees; mean period from the rising passages of the rest position."""
    angles = np.degrees(np.abs(turns(done, start, end)[1]))
    crossings = done.events[(done.events["kind"] == EventKind.CROSS) & (done.events["value"] > 0.0)]["t"]
    crossings = crossings[(crossings >= start) & (crossings <= end)]
    return float(angles.mean()), float((crossings[-1] - crossings[0]) / (len(crossings) - 1))


def half_pitches(done: Trajectory) -> np.ndarray:
    """Half pitches the wheel has advanced between successive turning points of the balance."""
    times = turns(done, 0.0, done.simulated)[0]
    return -np.diff(column(done, "wheel", times)) / HALF_PITCH


@pytest.mark.parametrize(
    ("duration", "tolerance", "beats"),
    [
        (1.0, 1e-9, 6),
        *((0.5, one, 2) for one in (1e-6, 1e-7, 1e-8, 1e-10, 1e-12)),
        pytest.param(60.0, 1e-9, 478, marks=pytest.mark.slow),
    ],
)
def test_every_beat_is_half_a_pitch_at_any_tolerance(duration: float, tolerance: float, beats: int) -> None:
    """A slip that reverses in one of them must not stop the clock."""
    done = simulate(profile("bench_lever"), duration, tolerance)
    assert done.stop == Stop.DURATION
    advance = half_pitches(done)
    assert len(advance) >= beats
    assert advance == pytest.approx(np.ones(len(advance)), abs=0.01)
    if tolerance == 1e-9:
        assert done.worst_penetration < 1e-9
        assert done.energy["residual_relative"] < 1e-8
        assert done.counts["lcp_failures"] == done.counts["energy_rescues"] == 0


def test_energy_ledger() -> None:
    """Work of the motor = stored + lost in friction, damping and impacts, to 1e-8 of it; nothing is ever gained."""
    ledger = simulate(profile("bench_lever"), 1.0).energy
    assert ledger["residual_relative"] < 1e-8
    total = ledger["stored_J"] + sum(ledger["dissipated"].values())
    assert abs(ledger["in_J"] - total) < 1e-8 * ledger["in_J"]
    assert min(ledger["dissipated"].values()) > 0.0


def test_no_impact_gains_energy() -> None:
    done = simulate(profile("bench_lever"), 1.0)
    impacts = done.events[done.events["kind"] == EventKind.IMPACT]
    together = [impacts["energy_lost"][impacts["t"] == t].sum() for t in np.unique(impacts["t"])]
    assert min(together) >= -1e-20
    assert np.all(impacts["impulse_normal"] > 0.0)
    # Impulses of 1e-16 N·s come from rates that are rounding themselves: their cones are judged by the largest impulse.
    rounding = 1e-12 * impacts["impulse_normal"].max()
    cone = 0.15 * impacts["impulse_normal"] * (1.0 + 1e-9) + rounding
    assert np.all(np.abs(impacts["impulse_tangential"]) <= cone)
    assert np.all(impacts["value"] <= 1e-9)


def material(side: Side, pose: tuple[float, float, float]) -> shapely.Geometry:
    """The outlines of one side of a contact, arcs as inscribed chords of 5 µm."""
    loops = [loop for loop in profile("bench_lever").body(side.body).loops if side.layer in (None, loop.layer)]
    return shapely.union_all([shapely.Polygon(chords((loop,), pose, 5e-6)[:, :2]) for loop in loops])


@pytest.mark.parametrize(("tolerance", "instants"), [(1e-7, 501), pytest.param(1e-9, 2001, marks=pytest.mark.slow)])
def test_nothing_runs_through_anything(tolerance: float, instants: int) -> None:
    """Bodies as polygons at many instants: no overlap beyond a nanometre of depth, whatever the solver reports."""
    done = simulate(profile("bench_lever"), 0.5, tolerance)
    for contact in profile("bench_lever").contacts:
        placed = [material(side, (0.0, 0.0, 0.0)) for side in contact.sides]
        for t in np.linspace(0.0, 0.5, instants):
            now = []
            for side, shape in zip(contact.sides, placed, strict=True):
                x, y, angle = done.pose(side.body, t)
                c, s = math.cos(angle), math.sin(angle)
                now.append(shapely.transform(shape, lambda p, a=(x, y, c, s): p @ [[a[2], a[3]], [-a[3], a[2]]] + [a[0], a[1]]))
            # A nanometre deep, and as wide as the larger part of a face.
            assert shapely.intersection(*now).area < 1e-9 * 5e-4, (contact, t)


@pytest.mark.slow
def test_amplitude_and_period() -> None:
    amplitude, period = amplitude_and_period(simulate(profile("bench_lever"), 15.0, 1e-9), 13.0, 15.0)
    assert amplitude == pytest.approx(AMPLITUDE_DEG, abs=0.05)
    assert period == pytest.approx(PERIOD, abs=1e-6)


@pytest.mark.slow
def test_tolerance_does_not_matter() -> None:
    """From 1e-8 to 1e-11: less than 1e-3 degrees and 1 ns."""
    runs = [simulate(profile("bench_lever"), 15.0, tolerance) for tolerance in (1e-8, 1e-11)]
    assert [run.stop for run in runs] == [Stop.DURATION, Stop.DURATION]
    loose, tight = (amplitude_and_period(run, 13.0, 15.0) for run in runs)
    assert abs(loose[0] - tight[0]) < 1e-3
    assert abs(loose[1] - tight[1]) < 1e-9


@pytest.mark.slow
def test_speed(minute: Trajectory) -> None:
    """At least twenty times real time on one core."""
    assert minute.simulated / minute.wall > 20.0
