"""Is a mechanism that is turned, mirrored and drawn otherwise the same one, and does it stop where friction locks it?"""

import math
from dataclasses import replace

import hunt_path
import numpy as np
import pytest
from every_time import few
from hunt.books import masses
from hunt.generate import FAMILIES, mechanism
from hunt.parts import Material, apart, start_pose
from hunt.views import View, perturbed, views
from hunt.write import write_scene

from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

# Is a mechanism that is turned, mirrored and drawn otherwise the same one?

VIEW = View(2.1, True, {"b0": 0.7, "b1": 3.0, "s0": 1.0, "a": 2.0, "p0": 1.1, "bar": 0.4})


@pytest.mark.parametrize("family", [pytest.param(one, marks=[pytest.mark.slow] * (one == "crowd")) for one in sorted(FAMILIES)])
def test_same_start_seen_otherwise(family):
    """Distances between bodies at the start do not depend on the view, and coordinates are the scene's own again."""
    scene = mechanism(7, 3, family)
    seen = VIEW.of(scene)
    depth, distance = Material(scene).at_start()
    other_depth, other_distance = Material(seen).at_start()
    assert other_distance == pytest.approx(distance, abs=1e-12)
    assert other_depth == pytest.approx(depth, abs=1e-12)


@pytest.mark.parametrize("family", ["levers", "row", "boxed", "pendulums", "wedge"])
def test_same_motion_without_contacts(family):
    """Springs, drives, gravity and damping act alike."""
    scene = replace(mechanism(7, 5, family), contacts=())
    run, seen = simulate(scene), simulate(VIEW.of(scene))
    times = np.linspace(0.0, scene.duration, 7)
    back = VIEW.back(scene, seen.slices, seen.sample(times)[0])
    assert back == pytest.approx(run.sample(times)[0], rel=1e-7, abs=1e-10)


def test_twins_part_rather_than_overlap():
    for number in range(10):
        scene = mechanism(7, number, "blocks")
        assert apart(perturbed(scene, 1e-5, number))


def test_twins_are_that_near():
    scene = mechanism(7, 1, "levers")
    twin = perturbed(scene, 1e-5, 1)
    for body, other in zip(scene.bodies, twin.bodies, strict=True):
        assert math.dist(start_pose(body)[:2], start_pose(other)[:2]) < 1e-5
        if body.motion == "pivot":
            assert 0.0 < abs(other.inertia / body.inertia - 1.0) < 1.0001e-5


@pytest.mark.parametrize("family", few(sorted(FAMILIES), lambda family: family != "crowd"))
def test_written_scene_reads_back(family, tmp_path):
    """Number 4 of each family comes out of its file with the same numbers, but for a rounding of what outlines weigh."""
    scene = mechanism(7, 4, family)
    again = load(write_scene(scene, tmp_path / "scene.toml"))
    assert again.springs == scene.springs
    assert again.torques == scene.torques
    assert again.damping == scene.damping
    assert again.contacts == scene.contacts
    for body, other in zip(scene.bodies, again.bodies, strict=True):
        assert other.motion == body.motion
        assert (other.position, other.angle, other.velocity) == (body.position, body.angle, body.velocity)
        assert other.inertia == pytest.approx(body.inertia, rel=1e-12)
        assert other.centre_of_mass == pytest.approx(body.centre_of_mass, abs=1e-15)
        assert corners(other) == pytest.approx(corners(body), abs=1e-15)


def corners(body):
    """In an order that does not hang on rounding."""
    return np.array(
        sorted((e.start for loop in body.loops for e in loop.edges), key=lambda p: (round(p[0], 10), round(p[1], 10)))
    )


def test_number_names_the_mechanism():
    assert mechanism(1, 12) == mechanism(1, 12)
    assert mechanism(1, 12) != mechanism(1, 13)
    assert mechanism(1, 12) != mechanism(2, 12)


# Do levers stop where friction locks them on their line of centres, and stay there?

SCENES = hunt_path.ROOT / "tests" / "data" / "hunt"


@pytest.fixture(scope="module", params=["levers-801-2130", "levers-801-2838"])
def stopped(request):
    """A run, its first jam, and the row before it."""
    run = simulate(load(SCENES / f"{request.param}.toml"))
    jam = run.events[run.events["kind"] == EventKind.JAM][0]
    return run, jam, int(np.flatnonzero(run.t == jam["t"])[0])


def test_they_lose_all_they_had_and_stay(stopped):
    run, jam, row = stopped
    after = np.flatnonzero(run.t == jam["t"])[-1]
    locked = (run.u[row] != 0.0) & (run.u[after] == 0.0)
    assert locked.sum() == 2
    had = 0.5 * masses(run.scene)[locked] @ run.u[row][locked] ** 2
    assert jam["energy_lost"] == pytest.approx(float(had), rel=1e-9)
    touched = run.events[(run.events["t"] > jam["t"]) & (run.events["kind"] == EventKind.IMPACT)]
    until = touched["t"].min() if len(touched) else run.t[-1]
    rows = (run.t > jam["t"]) & (run.t < until)
    assert not run.u[rows][:, locked].any()


def test_forces_that_rounding_allows_do_not_carry_them_over():
    """A disc a hundredth of a micrometre off its centre, and a bar: in one orientation 3e14 N seemed to let them go on."""
    scene = load(SCENES / "kink_twin-801-11924.toml")
    for seen in (scene, *(view.of(scene) for view in views(scene, 11924, 2))):
        run = simulate(seen)
        (jam,) = run.events[run.events["kind"] == EventKind.JAM]
        assert run.simulated == seen.duration
        assert not run.u[run.t > jam["t"]].any()
        assert jam["t"] == pytest.approx(0.0748486, abs=2e-7)


@pytest.mark.parametrize("twin", [0, 4])
def test_what_an_impact_leaves_of_a_slip_is_no_slip(twin):
    """It stops a disc and a bar with 1e6 N s across a face of 2e-6 rad; the rounding of mu times that counted as motion."""
    scene = perturbed(load(SCENES / "kink-801-11924.toml"), 1e-5, 2 * 11924 + 1000 + twin, -1.0)
    run = simulate(scene)
    assert run.simulated == scene.duration
    assert abs(run.u[-1]).max() < 1e-4
