"""Is the motion between rows that of its polynomials, and are frames and pairs those of the scene?"""

import functools
import math
from pathlib import Path

import numpy as np
import pytest
from moving_scenes import profile
from pair_scenes import ARRANGEMENTS, carried_scene, outline, places
from scipy.interpolate import BPoly

from watchsim.geometry.loops import Loop
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.recording import Pair, pairs_of
from watchsim.simulation.state import EVENT_DTYPE, Stop
from watchsim.simulation.trajectory import Trajectory, between, frames, place_between, speeds
from watchsim.storage.columns import Columns, is_mapped

# Is the motion between rows interpolated with the promised order, and right at both sides of an impact?

BODIES = (
    Body("rotor", "pivot", (1.0, 2.0)),
    Body("post", "fixed", (3.0, 4.0), 0.5),
    Body("slider", "slide", (5.0, 6.0), 0.25, axis=(0.6, 0.8)),
    Body("puck", "free"),
)
SLICES = {"rotor": slice(0, 1), "slider": slice(1, 2), "puck": slice(2, 5)}


def made(t: np.ndarray, q: np.ndarray, u: np.ndarray, a: np.ndarray) -> Trajectory:
    """Rows that are exact to rounding, as the tolerance says."""
    return Trajectory(Scene("made", BODIES), t, q, u, a, SLICES, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, tolerance=1e-16)


def wave(spacing: float) -> Trajectory:
    t = np.arange(0.0, 1.0 + 1e-9, spacing)
    phase = 3.0 * t[:, None] + np.arange(5.0)
    return made(t, np.sin(phase), 3.0 * np.cos(phase), -9.0 * np.sin(phase))


def errors(spacing: float) -> tuple[float, float]:
    times = np.linspace(0.0, 0.999, 400)
    phase = 3.0 * times[:, None] + np.arange(5.0)
    q, u = wave(spacing).sample(times)
    return float(np.abs(q - np.sin(phase)).max()), float(np.abs(u - 3.0 * np.cos(phase)).max())


def test_orders_of_interpolation() -> None:
    """Coordinates of order 6, velocities of order 5, from both sides."""
    coarse, fine = errors(0.1), errors(0.05)
    assert 5.7 < math.log2(coarse[0] / fine[0]) < 6.3
    assert 4.7 < math.log2(coarse[1] / fine[1]) < 5.3
    assert fine[0] < 1e-9


def test_an_impact_in_the_last_row() -> None:
    done = made(np.array([0.0, 1.0, 1.0]), np.ones((3, 5)), np.array([0.0, 0.0, 7.0])[:, None] * np.ones(5), np.zeros((3, 5)))
    assert done.at(1.0)[1] == pytest.approx(7.0 * np.ones(5))
    assert done.at(0.5)[1] == pytest.approx(np.zeros(5))


def test_poses() -> None:
    done = wave(0.1)
    q = done.q[3]
    assert done.pose("rotor", 0.3) == pytest.approx((1.0, 2.0, q[0]))
    assert done.pose("post", 0.3) == (3.0, 4.0, 0.5)
    assert done.pose("slider", 0.3) == pytest.approx((5.0 + 0.6 * q[1], 6.0 + 0.8 * q[1], 0.25))
    assert done.pose("puck", 0.3) == pytest.approx(tuple(q[2:]))


# Are places, velocities and accelerations between rows those of the polynomials that the manual names? Against scipy's.

BODIES_SAMPLING = (Body("one", "pivot"), Body("two", "pivot"))
SLICES_SAMPLING = {"one": slice(0, 1), "two": slice(1, 2)}
NONE = np.zeros((0, 2))


def made_sampling(t: np.ndarray, q: np.ndarray, u: np.ndarray, a: np.ndarray, **more: object) -> Trajectory:
    return Trajectory(
        Scene("made", BODIES_SAMPLING), t, q, u, a, SLICES_SAMPLING, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, **more
    )


def random_run(count: int, seed: int = 1) -> Trajectory:
    """Rows that fit no motion, unevenly spaced."""
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.1, 2.0, count))
    return made_sampling(t, *rng.normal(size=(3, count, 2)), tolerance=1e-15)


@pytest.mark.parametrize("seed", range(5))
def test_between_two_rows_places_are_quintics_and_velocities_their_slopes(seed: int) -> None:
    """Through q, u and a at both ends; where the way says no more than its noise, velocities are the cubic through u and a."""
    rng = np.random.default_rng(seed)
    h, left, right = rng.uniform(0.1, 3.0), *(tuple(rng.normal(size=3)) for _ in range(2))
    quintic = BPoly.from_derivatives([0.0, h], [left, right])
    cubic = BPoly.from_derivatives([0.0, h], [left[1:], right[1:]])
    s, length = np.linspace(0.0, 1.0, 7)[:, None], np.array([h])
    ends = tuple(np.array([x]) for x in left), tuple(np.array([x]) for x in right)
    assert place_between(s, length, *ends) == pytest.approx(quintic(h * s), abs=1e-12)
    missed = abs(right[0] - left[0] - float(cubic.integrate(0.0, h)))
    for share, velocity in ((0.99, quintic.derivative()), (1.01, cubic)):
        q, u = between(s, length, *ends, np.array([share * missed]))
        assert q == pytest.approx(quintic(h * s), abs=1e-12)
        assert u == pytest.approx(velocity(h * s), rel=1e-11, abs=1e-11)


def test_samples_are_of_the_two_rows_beside_each_time() -> None:
    run = random_run(6)
    times = np.concatenate([np.random.default_rng(2).uniform(run.t[0], run.t[-1], 40), run.t])
    q, u = run.sample(times)
    accelerations = run.acceleration(times)
    for time, place, velocity, bend in zip(times, q, u, accelerations, strict=True):
        k = min(int((run.t <= time).sum()) - 1, len(run.t) - 2)
        for column in range(2):
            ends = [[run.q[i, column], run.u[i, column], run.a[i, column]] for i in (k, k + 1)]
            quintic = BPoly.from_derivatives(run.t[k : k + 2], ends)
            cubic = BPoly.from_derivatives(run.t[k : k + 2], [end[1:] for end in ends])
            assert place[column] == pytest.approx(float(quintic(time)), abs=1e-9)
            assert velocity[column] == pytest.approx(float(quintic.derivative()(time)), abs=1e-9)
            assert bend[column] == pytest.approx(float(cubic.derivative()(time)), abs=1e-9)


@pytest.mark.parametrize("columns", [[0], [1], [1, 0], []])
def test_positions_of_some_coordinates(columns: list[int]) -> None:
    """Beyond the rows, at the last of two of one instant, and in between."""
    run = random_run(6)
    ends = np.append(run.t, run.t[-1])
    run = made_sampling(ends, *(np.vstack((array, 2.0 * array[-1:])) for array in (run.q, run.u, run.a)))
    times = np.concatenate([np.linspace(run.t[0] - 1.0, run.t[-1] + 1.0, 50), run.t])
    found = run.positions(times, columns)
    assert found.shape == (len(times), len(columns)) and np.array_equal(found, run.sample(times)[0][:, columns])


def test_beyond_the_rows_everything_is_as_in_the_nearest() -> None:
    run = random_run(4)
    for time, row in ((run.t[0] - 1.0, 0), (run.t[-1] + 1.0, -1)):
        q, u = run.at(time)
        assert (q, u) == (pytest.approx(run.q[row]), pytest.approx(run.u[row]))
        assert run.acceleration(np.array([time]))[0] == pytest.approx(run.a[row])


def test_of_one_row_or_of_two_at_one_instant_the_last_one_counts() -> None:
    single = random_run(1)
    for run in (
        single,
        made_sampling(np.repeat(single.t, 2), *(np.stack([x[0] - 7.0, x[0]]) for x in (single.q, single.u, single.a))),
    ):
        for time in (run.t[0] - 1.0, run.t[0], run.t[0] + 1.0):
            q, u = run.at(time)
            assert np.array_equal(q, run.q[-1]) and np.array_equal(u, run.u[-1])
            assert np.array_equal(run.acceleration(np.array([time]))[0], run.a[-1])


def test_at_a_jump_the_row_after_it_counts() -> None:
    rng = np.random.default_rng(4)
    run = made_sampling(np.array([0.0, 1.0, 1.0, 3.0]), *rng.normal(size=(3, 4, 2)), tolerance=1e-15)
    assert run.at(1.0) == (pytest.approx(run.q[2]), pytest.approx(run.u[2]))
    assert run.acceleration(np.array([1.0]))[0] == pytest.approx(run.a[2])
    assert run.at(np.nextafter(1.0, 0.0))[1] == pytest.approx(run.u[1])


def test_without_rows_nothing_is_known_of_the_motion() -> None:
    run = made_sampling(np.zeros(0), NONE, NONE, NONE)
    assert run.end is None
    for ask in (run.sample, run.acceleration):
        with pytest.raises(ValueError, match="no row of this run was kept"):
            ask(np.zeros(1))


def test_the_end_is_told_by_itself_or_is_the_last_row() -> None:
    run = random_run(3)
    assert run.end is not None and [x.tolist() for x in run.end] == [run.q[-1].tolist(), run.u[-1].tolist()]
    told = made_sampling(run.t, run.q, run.u, run.a, end_q=np.ones(2), end_u=np.zeros(2))
    assert told.end is not None and [x.tolist() for x in told.end] == [[1.0, 1.0], [0.0, 0.0]]


@pytest.mark.parametrize("column", [0, 1])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_way_shorter_than_half_a_tolerance_of_the_largest_value_makes_no_velocity(column: int, sign: float) -> None:
    """Of each coordinate by itself, over all its rows and either way; above it 30/16 of it over the time, at the middle."""
    largest = np.array([4.0, 100.0])
    for share in (0.9, 1.1):
        q = np.zeros((3, 2))
        q[2] = -largest
        q[1, column] = sign * share * 0.5e-6 * largest[column]
        run = made_sampling(np.array([0.0, 0.5, 9.0]), q, np.zeros((3, 2)), np.zeros((3, 2)), tolerance=1e-6)
        expected = np.zeros(2)
        expected[column] = 30.0 / 16.0 * q[1, column] / 0.5 if share > 1.0 else 0.0
        assert run.at(0.25)[1] == pytest.approx(expected, rel=1e-12)


def test_rows_in_files_say_the_same(tmp_path: Path) -> None:
    run, columns = random_run(2500), Columns()
    columns.folder, columns.most = tmp_path, 1
    columns.append((run.t, run.q, run.u, run.a))
    filed = made_sampling(*columns.all(), tolerance=1e-15)
    assert is_mapped(filed.q) and not is_mapped(run.q)
    for count in (1, 999, 1000, 1001, 2345):
        times = np.sort(np.random.default_rng(count).uniform(run.t[0], run.t[-1], count))
        for one, other in zip(filed.sample(times), run.sample(times), strict=True):
            assert np.array_equal(one, other)
        assert np.array_equal(filed.positions(times, [1]), run.positions(times, [1]))


def test_nothing_in_a_run_can_be_written_over() -> None:
    run = random_run(3)
    for array in (run.t, run.q, run.u, run.a, run.events, run.end_q, run.end_u):
        assert not array.flags.writeable


@pytest.mark.parametrize(("overlap", "worst"), [({}, 0.0), ({"worst_m": 2e-6}, 2e-6)])
def test_the_worst_overlap(overlap: dict[str, float], worst: float) -> None:
    run = random_run(3)
    assert made_sampling(run.t, run.q, run.u, run.a, overlap=overlap).worst_overlap == worst


def test_a_body_stands_where_it_is_though_nothing_moves() -> None:
    still = Scene("still", (Body("post", "fixed", (3.0, 4.0), 0.5),))
    run = Trajectory(still, np.zeros(1), *(np.zeros((1, 0)),) * 3, {}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION)
    assert run.pose("post", 7.0) == (3.0, 4.0, 0.5)


# Do frames stand where the manual of the scene file puts them, and move as their places change?

STEP = 1e-5


def block(_: str) -> tuple[Loop, ...]:
    return (outline(0.35),)


@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=str)
def test_carried_bodies(arrangement: tuple[str, str, bool]) -> None:
    scene, compiled = carried_scene(*arrangement, block, (0.25, 0.1))
    rng, n = np.random.default_rng(3), len(compiled.q)
    q, u = rng.uniform(-2.0, 2.0, (4, n)), rng.uniform(-1.0, 1.0, (4, n))
    told, rates = compiled.relative(q), compiled.relative(u, rates=True)
    here = frames(scene, compiled.slices, told)
    for row, one in enumerate(q):
        for name, place in places(scene, compiled, one).items():
            assert here[name][row] == pytest.approx(place, abs=1e-14)
    before, after = (frames(scene, compiled.slices, told + way * STEP * rates) for way in (-1.0, 1.0))
    for name, speed in speeds(scene, compiled.slices, told, rates).items():
        assert speed == pytest.approx((after[name] - before[name]) / (2.0 * STEP), abs=1e-8)


# Do the pairs of a run read like a tuple of all of them?

WORDS = ("corner", "line", "arc")


@functools.cache
def lever() -> Compiled:
    return compile_scene(profile("swiss_lever"))


@functools.cache
def in_words() -> tuple[Pair, ...]:
    """One object for each contact of the lever, made one by one."""
    compiled = lever()

    def side(row: int) -> tuple[str, str, int, str]:
        owner = compiled.owners[row]
        return owner, WORDS[compiled.model.primitives[row].kind], row - compiled.owners.index(owner), compiled.layers[row]

    return tuple(Pair(int(one.group), *side(int(one.a)), *side(int(one.b))) for one in compiled.model.contacts)


def test_all_of_a_lever() -> None:
    pairs, expected = pairs_of(lever()), in_words()
    assert len(pairs) == len(expected) > 1000
    assert tuple(pairs) == expected and list(reversed(pairs)) == list(reversed(expected))
    assert [pairs[k] for k in range(len(pairs))] == list(expected)
    assert pairs == expected and expected == pairs and pairs == pairs_of(lever()) and hash(pairs) == hash(expected)
    assert str(pairs[7]) == str(expected[7]) and pairs[np.int32(7)] == expected[7]


@pytest.mark.parametrize("name", ["wheel", "lever", "balance", "banking", "nothing"])
def test_those_of_a_body(name: str) -> None:
    expected = [name in (pair.body_a, pair.body_b) for pair in in_words()]
    assert pairs_of(lever()).of_body(name).tolist() == expected
    assert any(expected) == (name != "nothing")
