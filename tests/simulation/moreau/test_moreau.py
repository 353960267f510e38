"""Does Moreau's time stepping, an algorithm of its own, come to the same motion at its order?"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from moving_scenes import box, ground, on_slope, profile, touching
from reference import incline_closed_form as closed_form

from watchsim.jit import callable_kernel
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.moreau.percussion_laws import laws
from watchsim.simulation.moreau.prox_relaxation import relax
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

FILES = {"0.3": "scene.toml", "0.13": "scene_mu013.toml", "0.10": "scene_mu010.toml"}
_relax = callable_kernel(relax)


@functools.cache
def incline(mu: str, step: float) -> Trajectory:
    return simulate(profile("incline", FILES[mu]), 1.0, method="moreau", step=step)


@pytest.mark.parametrize("mu", FILES)
def test_incline_at_first_order(mu: str) -> None:
    """The place after a second is wrong by less than half a millimetre per millisecond of step, at every step."""
    truth = closed_form.reference("1", mu)
    for step in (1e-3, 1e-4, 1e-5):
        done = incline(mu, step)
        assert done.stop == Stop.DURATION
        assert abs(done.q[-1, 0] - float(truth.x)) < 0.5 * step
        assert abs(done.q[-1, 2] + float(truth.theta)) < 10.0 * step
        assert abs(done.q[-1, 1] - 0.05) < 1e-9


def test_energy_ledger_closes_to_rounding() -> None:
    """What the contacts do to the energy by being stepped is a term of its own, and goes with the step."""
    coarse, fine = incline("0.3", 1e-3).energy, incline("0.3", 1e-5).energy
    assert max(coarse["residual_relative"], fine["residual_relative"]) < 1e-9
    assert abs(fine["dissipated"]["stepping"]) < 0.02 * abs(coarse["dissipated"]["stepping"])


def test_impacts_above_creeping_are_written_down() -> None:
    """Falling from 100 mm and rebounding with half the speed: the first impacts one by one."""
    impacts = incline("0.3", 1e-4).events
    impacts = impacts[impacts["kind"] == EventKind.IMPACT]
    first = float(closed_form.first_impact())
    wanted = [first * (1.0 + 2.0 * (1.0 - 0.5**k)) for k in range(5)]
    assert impacts["t"][:5] == pytest.approx(wanted, abs=2e-4)
    assert np.all(impacts["impulse_normal"] > 0.0)


def test_bench_lever_as_the_event_driven_solver_says() -> None:
    """Half a second of beats with restitution 0.2: all bodies, to the order of the step."""
    scene = profile("bench_lever")
    truth = simulate(scene, 0.5)
    errors = {}
    for step in (4e-5, 1e-5):
        done = simulate(scene, 0.5, method="moreau", step=step)
        assert done.stop == Stop.DURATION
        assert done.counts["lcp_failures"] == 0
        errors[step] = np.abs(done.q[-1] - truth.q[-1]).max()
    assert errors[1e-5] < 1e-3
    assert errors[1e-5] < 0.6 * errors[4e-5]


def block(angle: float, friction: float) -> Scene:
    body = Body("block", "free", position=(0.0, 0.01), mass=0.5, inertia=1e-4, loops=(box(0.04, 0.02),))
    return Scene("block", (body, ground()), contacts=touching("block", "ground", friction=friction), gravity=on_slope(angle))


@pytest.mark.parametrize("friction, slides", [(0.3, False), (0.2, True)])
def test_block_on_an_incline(friction: float, slides: bool) -> None:
    """Two contacts at once: sticks below the friction angle (14°), slides with the exact acceleration above it."""
    angle = math.radians(14.0)
    done = simulate(block(angle, friction), 0.5, method="moreau", step=1e-4)
    wanted = 0.5 * 9.81 * (math.sin(angle) - friction * math.cos(angle)) * 0.25 if slides else 0.0
    # The creep of 3e-9 m is what an hour of sticking would be judged by in a time-stepping code: position correction.
    assert done.q[-1, 0] == pytest.approx(wanted, abs=1e-4 * wanted + 1e-8)
    assert abs(done.q[-1, 2]) < 1e-6


def obeys(G: np.ndarray, b: np.ndarray, low: np.ndarray, most: np.ndarray, P: np.ndarray, zero: float) -> None:
    """Normal percussions complementary to the rates, friction within its bounds `most` and against slip."""
    rate, m = b + G @ P, len(low)
    normal = P[0 : 2 * m : 2]
    assert np.abs(np.minimum(normal - low, rate[0 : 2 * m : 2])).max() < zero
    held = np.concatenate([P[1 : 2 * m : 2], P[2 * m :]])
    slip = np.concatenate([rate[1 : 2 * m : 2], rate[2 * m :]])
    assert np.all(np.abs(held) <= most + zero)
    assert np.abs(slip * (most - np.abs(held))).max() < zero
    assert np.all(slip * held <= zero)


def test_relaxation_solves_the_laws() -> None:
    """Random contacts and bearings."""
    rng = np.random.default_rng(5)
    for _ in range(300):
        m, bearings = int(rng.integers(1, 4)), int(rng.integers(0, 3))
        rows = 2 * m + bearings
        W, obeyed = rng.normal(size=(8, rows)), laws(m, bearings)
        G, b, low, ends, P = obeyed.G, obeyed.b, obeyed.low, obeyed.ends, obeyed.P
        G[:], b[:], low[:] = W.T @ W, rng.normal(size=rows), np.maximum(0.0, rng.normal(size=m))
        ends[:m, 1], ends[:m, 3], ends[m:, 0], ends[m:, 2] = -0.3, 0.3, -0.2, 0.2
        _, settled = _relax(obeyed, m, bearings)
        assert settled
        obeys(G, b, low, np.concatenate([0.3 * P[0 : 2 * m : 2], np.full(bearings, 0.2)]), P, 1e-9)


@pytest.mark.parametrize("friction", [0.15, 1.0])
def test_redundant_contacts_settle(friction: float) -> None:
    """Up to six contacts with friction on one to three coordinates: a jam, whose percussions are not unique."""
    rng = np.random.default_rng(6)
    for _ in range(500):
        m, n = int(rng.integers(1, 7)), int(rng.integers(1, 4))
        W, obeyed = rng.normal(size=(n, 2 * m)), laws(m, 0)
        obeyed.G[:], obeyed.b[:] = W.T @ W, W.T @ rng.normal(size=n)
        obeyed.ends[:, 1], obeyed.ends[:, 3] = -friction, friction
        sweeps, settled = _relax(obeyed, m, 0)
        assert settled
        assert sweeps < 1000
        scale = max(1.0, float(np.abs(obeyed.P).max()))
        obeys(obeyed.G, obeyed.b, obeyed.low, friction * obeyed.P[::2], obeyed.P, 1e-9 * scale**2)


@pytest.mark.parametrize("step", [1e-3, *(pytest.param(step, marks=pytest.mark.slow) for step in (2e-4, 1e-4))])
def test_steps_too_coarse_for_a_lever_still_end(step: float) -> None:
    """It jams, with overlaps that no motion takes back and contacts that share one force: wrong, but solved in every step."""
    run = simulate(profile("bench_lever"), 5.0, method="moreau", step=step)
    assert run.stop == Stop.DURATION
    assert run.counts["lcp_failures"] == 0
    assert run.counts["sweeps"] < 300 * run.counts["steps"]


def test_bad_arguments_are_refused() -> None:
    scene = profile("incline")
    with pytest.raises(ValueError, match="no method"):
        simulate(scene, 0.1, method="euler")
    with pytest.raises(ValueError, match="fixed step belongs to"):
        simulate(scene, 0.1, step=1e-4)
    with pytest.raises(ValueError, match="step must be a positive"):
        simulate(scene, 0.1, method="moreau", step=-1.0)
