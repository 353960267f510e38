"""Parts of a scene that cannot influence each other go on by themselves, and together they read as one run."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from watchsim.bench.growth import side_by_side
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.results.archive import read_state, write_state
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Bearing, Contact, LineSpring, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Gear, Recording, Scene
from watchsim.simulation.runner import ROWS, Run
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.systems import run_of, systems_of
from watchsim.simulation.trajectory import Trajectory

DURATION = 0.3  # s
COUNT = 3


@cache
def levers(count: int = COUNT) -> Scene:
    return side_by_side(load(profiles_dir() / "bench_lever"), count)


@cache
def together(keep: str = "all") -> Trajectory:
    return simulate(levers(), DURATION, record=keep)


def own_events(run: Trajectory, names: set[str]) -> list[tuple[object, ...]]:
    """The events at these bodies, with words in place of numbers."""
    found = []
    for event in run.events:
        pair = run.pairs[event["contact"]] if event["contact"] >= 0 else None
        body = run.scene.bodies[event["body"]].name if event["body"] >= 0 else None
        if names & ({pair.body_a, pair.body_b} if pair else {body}):
            numbers = tuple(event[name].item() for name in ("t", "kind", "impulse_normal", "energy_lost", "value"))
            handed_over = event["kind"] == 6
            found.append((body, pair and str(pair), *numbers[: 4 if handed_over else 5]))
    return found


@pytest.mark.parametrize("k", range(COUNT))
def test_each_moves_as_it_does_alone(k: int) -> None:
    part = systems_of(levers())[k]
    alone, whole = simulate(part, DURATION), together()
    last = np.append(np.diff(alone.t) > 0.0, True)  # of two rows of one instant the second
    rows = np.searchsorted(whole.t, alone.t[last], side="right") - 1
    for name in alone.slices:
        for what in ("q", "u", "a"):
            own, found = getattr(alone, what)[last][:, alone.slices[name]], getattr(whole, what)[rows][:, whole.slices[name]]
            assert np.array_equal(found, own)
        assert np.array_equal(whole.end_q[whole.slices[name]], alone.end_q[alone.slices[name]])
    names = {body.name for body in part.bodies if body.motion != "fixed"}
    assert own_events(whole, names) == own_events(alone, names)


def test_between_its_rows_each_stands_where_its_own_rows_say() -> None:
    part = systems_of(levers())[0]
    alone, whole = simulate(part, DURATION), together()
    times = np.linspace(0.0, DURATION, 5001)
    for name in alone.slices:
        ways = whole.sample(times)[0][:, whole.slices[name]] - alone.sample(times)[0][:, alone.slices[name]]
        assert np.abs(ways).max() < whole.tolerance


def test_numbers_of_the_whole_are_sums_over_its_systems() -> None:
    runs, whole = [simulate(part, DURATION) for part in systems_of(levers())], together()
    for name in ("events", "impacts", "steps", "flights", "instants"):
        assert whole.counts[name] == sum(run.counts[name] for run in runs)
    assert whole.energy["in_J"] == pytest.approx(sum(run.energy["in_J"] for run in runs), rel=1e-12)
    assert abs(whole.energy["residual_J"]) < 1e-6 * whole.energy["in_J"]
    assert sum(whole.sums["events_by_kind"].values()) == len(whole.events) == sum(len(run.events) for run in runs)


def test_rows_and_events_are_in_order_and_every_row_of_each_is_there() -> None:
    whole = together()
    assert (np.diff(whole.t) >= 0.0).all() and (np.diff(whole.events["t"]) >= 0.0).all()
    every = np.concatenate([simulate(part, DURATION).t for part in systems_of(levers())])
    assert set(whole.t) == set(every)
    assert (whole.t[0], whole.t[-1]) == (0.0, DURATION)


def test_what_is_counted_does_not_depend_on_what_is_recorded() -> None:
    whole = together()
    for keep in ("events", "statistics"):
        run = together(keep)
        assert run.sums == whole.sums
        assert run.counts | {"cells_asked": 0} == whole.counts | {"cells_asked": 0} and run.energy == whole.energy
        assert np.array_equal(run.end_q, whole.end_q)


def test_a_window_holds_the_rows_of_the_whole_run() -> None:
    start, end = 0.1, 0.1113
    run, whole = simulate(levers(), DURATION, record=[(start, end)]), together()
    inside = (whole.t >= start) & (whole.t <= end)
    first, last = np.flatnonzero(inside)[[0, -1]]
    assert np.array_equal(run.t, whole.t[first - 1 : last + 2])
    assert np.array_equal(run.q, whole.q[first - 1 : last + 2]) and np.array_equal(run.u, whole.u[first - 1 : last + 2])


@pytest.mark.parametrize("keep", ["all", "statistics"])
def test_how_fast_the_machine_is_changes_no_bit(keep: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows are merged whenever a slice of time on the clock on the wall is over."""
    monkeypatch.setattr("watchsim.simulation.runner.SLICE_WALL", 1e-3)
    run, whole = simulate(levers(), DURATION, record=keep), together(keep)
    for name in ("t", "q", "u", "a", "events", "end_q", "end_u"):
        assert np.array_equal(getattr(run, name), getattr(whole, name)), name
    assert (run.sums, run.energy, run.counts) == (whole.sums, whole.energy, whole.counts)


@pytest.mark.parametrize("keep", ["all", "events", "statistics"])
@pytest.mark.parametrize("cut", [0.0101, 0.1, 0.2999])
def test_a_run_goes_on_as_if_it_had_not_been_cut(cut: float, keep: str, tmp_path: Path) -> None:
    first = simulate(levers(), cut, record=keep)
    assert first.end_state is not None
    write_state(first.end_state, tmp_path / "state.npz")
    run = simulate(levers(), DURATION, record=keep, start=replace(first, end_state=read_state(tmp_path / "state.npz")))
    whole = together(keep)
    for name in ("t", "q", "u", "a", "events", "end_q", "end_u"):
        assert np.array_equal(getattr(run, name), getattr(whole, name)), name
    assert run.sums == whole.sums and run.energy == whole.energy


@pytest.mark.parametrize("room", [ROWS, 60])
@pytest.mark.parametrize("first", [False, True])
def test_where_one_cannot_go_on_the_others_end_with_it(first: bool, room: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A rotor speeds up beyond all numbers, in steps much shorter than those of the lever, which has gone ahead by then."""
    lever = levers(1)
    rotor = Body("rotor", "pivot", (1.0, 1.0), 0.0, (1e7,), inertia=1e-12)
    bodies = (rotor, *lever.bodies) if first else (*lever.bodies, rotor)
    scene = replace(lever, bodies=bodies, torques=(*lever.torques, Torque("rotor", 0.5)))
    monkeypatch.setattr("watchsim.simulation.systems.ROWS", room)
    run, alone = simulate(scene, 2.0), simulate(systems_of(scene)[0 if first else 1], 2.0)
    assert (run.stop, run.simulated) == (alone.stop, alone.simulated) == (Stop.FAR_AWAY, run.t[-1])
    own = simulate(lever, 2.0)
    names = {body.name for body in lever.bodies if body.motion != "fixed"}
    assert own_events(run, names) == [event for event in own_events(own, names) if event[2] <= run.simulated]  # type: ignore[operator]
    assert (np.diff(run.t) >= 0.0).all()
    times = np.linspace(0.0, run.simulated, 400)
    for name in names:
        ways = run.sample(times)[0][:, run.slices[name]] - own.sample(times)[0][:, own.slices[name]]
        assert np.abs(ways).max() < run.tolerance


JOINED: dict[str, Callable[[Scene], Scene]] = {
    "contact": lambda scene: replace(scene, contacts=(*scene.contacts, Contact((Side("wheel 0"), Side("wheel 1"))))),
    "spring": lambda scene: replace(scene, springs=(*scene.springs, Spring("balance 0", 1e-9, against="balance 1"))),
    "line spring": lambda scene: replace(
        scene, line_springs=(LineSpring(("balance 0", "balance 1"), ((0.0, 0.0), (0.0, 0.0)), 1e-9, 0.0),)
    ),
    "torque": lambda scene: replace(scene, torques=(*scene.torques, Torque("balance 0", 1e-12, against="balance 1"))),
    "gears": lambda scene: replace(scene, gears=(Gear(("balance 0", "balance 1"), -1.0, 0.1),)),
}


@pytest.mark.parametrize("what", JOINED)
def test_what_one_contact_or_force_joins_is_one_system(what: str) -> None:
    assert len(systems_of(levers(2))) == 2
    scene = JOINED[what](levers(2))
    assert systems_of(scene) == (scene,)
    assert type(run_of(scene, compile_scene(scene), scene.tolerance, Recording())) is Run


def test_a_spring_between_two_levers_carries_motion_from_one_to_the_other() -> None:
    weak, strong = (
        simulate(replace(levers(2), springs=(*levers(2).springs, Spring("balance 0", value, against="balance 1"))), 0.1)
        for value in (1e-15, 1e-8)
    )
    apart = simulate(levers(2), 0.1)
    assert np.abs(weak.end_q - apart.end_q).max() < 1e-6 < np.abs(strong.end_q - apart.end_q).max()


def test_bearings_go_with_their_bodies() -> None:
    heavy = tuple(replace(body, mass=1e-4) if "balance" in body.name else body for body in levers(2).bodies)
    scene = replace(levers(2), bodies=heavy, bearings=tuple(Bearing(f"balance {k}", 1e-4, 0.1, 1e-4) for k in range(2)))
    parts = systems_of(scene)
    assert [part.bearings for part in parts] == [(one,) for one in scene.bearings]
    run, alone = simulate(scene, 0.1), simulate(parts[1], 0.1)
    assert np.array_equal(run.end_q[run.slices["balance 1"]], alone.end_q[alone.slices["balance 1"]])
    assert not np.array_equal(run.end_q, simulate(replace(scene, bearings=()), 0.1).end_q)


def test_a_scene_of_one_system_is_run_as_it_is() -> None:
    scene = levers(1)
    assert systems_of(scene) == (scene,)


def test_overlaps_of_all_systems_are_reported_at_once() -> None:
    scene = levers(2)
    turned = tuple(replace(body, angle=body.angle + 1.0) if "lever" in body.name else body for body in scene.bodies)
    with pytest.raises(SceneError) as raised:
        simulate(replace(scene, bodies=turned), 0.01)
    assert all(f"lever {k}" in str(raised.value) for k in range(2))


def test_an_interrupted_run_goes_on_to_the_same_end() -> None:
    def interrupt(time: float, duration: float) -> None:
        if time > 0.05:
            raise KeyboardInterrupt

    first = simulate(levers(), DURATION, progress=interrupt)
    assert first.stop == Stop.INTERRUPTED and 0.05 < first.simulated < DURATION
    assert first.t[-1] == first.simulated
    run = simulate(levers(), DURATION, start=first)
    assert np.array_equal(run.end_q, together().end_q) and np.array_equal(run.t, together().t)
    assert np.array_equal(run.q, together().q)
