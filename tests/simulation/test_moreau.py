"""Does Moreau's time stepping, an algorithm of its own, come to the same motion, by the same laws?"""

import dataclasses
import functools
import math
from types import SimpleNamespace

import numpy as np
import pytest
import short_runs
from every_time import few
from moving_scenes import box, circle, ground, on_slope, profile, touching
from naive.impact_oracle import compressed, expanded
from plain_kernels import in_python
from reference import incline_closed_form as closed_form
from sparse_contacts import Sparse
from test_dry_bearings import driven, rotor

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.jit import callable_kernel
from watchsim.model import COULOMB, PG1996, SHIFTED
from watchsim.scene.forces import Contact, Damping, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import moreau_percussions as mobility
from watchsim.simulation import moreau_percussions as percussions
from watchsim.simulation.moreau_percussions import Laws, cone, laws, relax, residual
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# Does Moreau's time stepping, an algorithm of its own, come to the same motion at its order?

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


def test_as_exact_between_rows_as_at_them() -> None:
    """The verge recoils, slides back and drops: without rows at the kinks of its motion it was 0.13 rad off between them."""
    scene = profile("verge")
    truth, done = simulate(scene, 1.0), simulate(scene, 1.0, method="moreau", step=1e-5)
    times = np.linspace(0.0, 1.0, 1001)
    at_rows = np.abs(done.q - truth.sample(done.t)[0]).max()
    assert np.abs(done.sample(times)[0] - truth.sample(times)[0]).max() < 1.5 * at_rows < 1e-4


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


# Does Moreau's time stepping know every law of a scene: dry bearings, tangential restitution, no gain of energy?


def stepped(scene: Scene, duration: float, step: float) -> Trajectory:
    run = simulate(scene, duration, method="moreau", step=step)
    assert run.stop == Stop.DURATION
    assert run.counts["lcp_failures"] == 0
    return run


@pytest.mark.parametrize(
    "scene, duration, worst",
    [
        pytest.param(rotor(angle=2.0, viscous=1.5), 2.0, 0.4, id="sprung rotor"),
        pytest.param(rotor(stiffness=0.0, rate=4.0), 4.0, 0.1, id="running out"),
        pytest.param(driven(0.05), 1.0, 0.05, id="arm that holds"),
        pytest.param(driven(5.0), 0.3, 0.05, id="arm that yields"),
    ],
)
def test_dry_bearings_at_first_order(scene: Scene, duration: float, worst: float) -> None:
    """As by events, which is checked against closed forms, to a share of the step; what holds stands still."""
    exact = simulate(scene, duration)
    for step in (1e-3, 1e-4):
        run = stepped(scene, duration, step)
        assert np.abs(run.q[-1] - exact.q[-1]).max() < worst * step
        assert run.energy["dissipated"]["damping"] == pytest.approx(exact.energy["dissipated"]["damping"], rel=20.0 * step)
        assert run.energy["residual_relative"] < 1e-10
    still = exact.u[-1] == 0.0
    assert np.all(np.abs(run.u[-1][still]) < 1e-14)


def test_a_held_rotor_does_not_creep() -> None:
    """Inside its dead zone: not a bit in 10^5 steps, in the event-driven run neither."""
    scene = rotor(angle=0.05)
    for run in (stepped(scene, 10.0, 1e-4), simulate(scene, 10.0)):
        assert np.all(run.q == 0.05)


def test_a_watch_with_dry_bearings() -> None:
    scene = profile("bench_lever")
    dry = tuple(Damping(body.name, coulomb=2e-9) for body in scene.bodies if body.motion == "pivot")
    scene = dataclasses.replace(scene, damping=(*scene.damping, *dry))
    exact = simulate(scene, 0.3)
    errors = [np.abs(stepped(scene, 0.3, step).q[-1] - exact.q[-1]).max() for step in (4e-5, 1e-5)]
    assert errors[1] < 5e-4
    assert errors[1] < 0.6 * errors[0]


LAWS = [("coulomb", 0.0, 0.0), ("shifted", 0.4, 0.0), ("pg1996", 0.7, 0.0), ("pg1996", 1.0, 0.5)]


def thrown(rng: np.random.Generator, law: str, tangential: float, nu: float) -> Scene:
    """A block that lands flat: its corners meet two planes with friction of their own. No gravity, so nothing follows.

    One plane gives way along itself: else both would hold the block in one line, and how they share that would be open.
    """
    width, height, friction = rng.uniform(0.02, 0.1), rng.uniform(0.02, 0.1), rng.uniform(0.0, 1.0, 2)
    block = Body(
        "block",
        "free",
        position=(0.0, 0.5 * height),
        velocity=(float(rng.normal()), -1.0, 0.0),
        mass=1.0,
        inertia=float(10.0 ** rng.uniform(-4.5, -2.5)),
        loops=(box(width, height),),
    )
    left = Body("left", "fixed", loops=(Loop((Line(0.0, 0.0, -1.0, 0.0),), closed=False),))
    mass = float(rng.uniform(0.1, 3.0))
    right = Body("right", "slide", (0.0, 0.0), mass=mass, loops=(Loop((Line(1.0, 0.0, 0.0, 0.0),), closed=False),))
    back = rng.uniform(tangential if law == "shifted" else 0.0, 1.0, 2)
    contacts = tuple(
        Contact((Side("block"), Side(name)), float(mu), float(share), tangential)
        for name, mu, share in zip(("left", "right"), friction, back, strict=True)
    )
    return Scene("thrown", (block, left, right), contacts=contacts, tangential_law=law, nu=nu)


@pytest.mark.parametrize("law, tangential, nu", few(LAWS, 1, several=True))
def test_impacts_with_two_contacts_are_those_of_the_complementarity_problems(law: str, tangential: float, nu: float) -> None:
    """Two algorithms without a common line: relaxation and pivoting give the same velocities."""
    rng = np.random.default_rng(11)
    for _ in range(40):
        scene = thrown(rng, law, tangential, nu)
        exact, run = simulate(scene, 1e-4), stepped(scene, 1e-4, 1e-5)
        scale = np.abs(exact.u).max()
        assert np.abs(run.u[-1] - exact.u[-1]).max() < 1e-8 * scale
        assert run.counts["energy_rescues"] == exact.counts["energy_rescues"]


@pytest.mark.parametrize("law", ["pg1996", "shifted"])
def test_a_superball_reverses_slip_and_spin(law: str) -> None:
    ball = Body("ball", "free", (0.0, 0.0101), velocity=(0.3, -1.0, 5.0), mass=1.0, inertia=4e-5, loops=(circle(0.01),))
    contacts = tuple(
        dataclasses.replace(one, tangential_restitution=1.0)
        for one in touching("ball", "ground", friction=1.0, restitution=1.0)
    )
    run = stepped(Scene("superball", (ball, ground()), contacts=contacts, tangential_law=law), 1e-3, 1e-5)
    u = run.u[-1]
    assert u[1] == pytest.approx(1.0, rel=1e-12)
    assert u[0] + 0.01 * u[2] == pytest.approx(-(0.3 + 0.01 * 5.0), rel=1e-9)
    assert run.energy["dissipated"]["impacts"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "friction, size, inertia, mass, speeds",
    [
        pytest.param((0.4236, 2.6724), (0.042427, 0.140554), 1.0421e-5, 0.10798, (0.37467, -0.38049), id="once"),
        pytest.param((2.6338, 1.9834), (0.052707, 0.190510), 3.2068e-4, 0.012141, (0.52649, 2.72817), id="strong friction"),
    ],
)
def test_what_would_gain_energy_is_thrown_back_less(
    friction: tuple[float, float], size: tuple[float, float], inertia: float, mass: float, speeds: tuple[float, float]
) -> None:
    """Poisson's law with unequal restitution at two contacts with friction: the gain is noticed and counted, as by events."""
    plain = thrown(np.random.default_rng(0), "coulomb", 0.0, 0.0)
    block, left, right = plain.bodies
    position, velocity = (0.0, 0.5 * size[1]), (speeds[0], -1.0, 0.0)
    block = dataclasses.replace(block, position=position, velocity=velocity, inertia=inertia, loops=(box(*size),))
    right = dataclasses.replace(right, mass=mass, velocity=(speeds[1],))
    pairs = zip(plain.contacts, friction, (0.0, 1.0), strict=True)
    contacts = tuple(dataclasses.replace(one, friction=mu, restitution=back) for one, mu, back in pairs)
    scene = dataclasses.replace(plain, bodies=(block, left, right), contacts=contacts)
    exact, run = simulate(scene, 1e-5), stepped(scene, 1e-5, 1e-6)
    assert run.counts["energy_rescues"] == exact.counts["energy_rescues"] == 1
    assert run.energy["dissipated"]["impacts"] > 0.0
    assert run.u[-1] == pytest.approx(exact.u[-1], rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("name", ["superball", "Painlevé 1", "Painlevé 2", "pin on roller 1", "wedge 1", "cradle", "groove"])
def test_hard_cases_at_first_order(name: str) -> None:
    """Impacts of several contacts, accumulating ones, jams: the mean difference is below five steps' share of the way."""
    scene, duration, _ = short_runs.short_runs()[name]
    times = np.linspace(0.0, duration, 1001)
    exact = simulate(scene, duration).sample(times)[0]
    way = np.abs(exact - exact[0]).max()
    for count in (500, 5000):
        run = simulate(scene, duration, method="moreau", step=duration / count)
        assert run.counts["lcp_failures"] == 0
        assert np.abs(run.sample(times)[0] - exact).mean() < 5.0 * way / count


# Is it told rightly how far percussions are from their laws, in any units?

_cone, _residual, _relax_percussion_laws = (callable_kernel(kernel) for kernel in (cone, residual, relax))


def random_laws(seed: int, mass: float, speed: float) -> Laws:
    """Two contacts and a bearing, inverse masses and rates of order 1 / mass and speed; percussions that nobody solved for."""
    rng = np.random.default_rng(seed)
    made, jacobian = laws(2, 1), rng.normal(size=(5, 6))
    made.G[:] = jacobian @ jacobian.T / mass
    made.b[:] = speed * rng.normal(size=5)
    made.P[:] = mass * speed * rng.normal(size=5)
    for i, friction in enumerate((0.2, 0.0)):
        _cone(made.ends, i, friction)
    made.ends[2] = -0.1 * mass * speed, 0.0, 0.1 * mass * speed, 0.0
    return made


def naive(made: Laws) -> float:
    """The distance from the projection row by row, each times the root of G's diagonal, over the largest of what there is."""
    rates, diagonal = made.b + made.G @ made.P, np.diag(made.G)
    wanted = made.P - rates / diagonal
    for i in range(2):
        wanted[2 * i] = max(wanted[2 * i], made.low[i])
        reach = made.ends[i, 3] * made.P[2 * i]
        wanted[2 * i + 1] = min(reach, max(-reach, wanted[2 * i + 1]))
    wanted[4] = np.clip(wanted[4], made.ends[2, 0], made.ends[2, 2])
    roots = np.sqrt(diagonal)
    return float((np.abs(wanted - made.P) * roots).max() / max((np.abs(made.P) * roots).max(), (np.abs(made.b) / roots).max()))


@pytest.mark.parametrize("seed", range(6))
def test_the_share_is_the_naive_one_whatever_the_units(seed: int) -> None:
    for mass, speed in ((1.0, 1.0), (1e-9, 1e-3), (1e6, 30.0)):
        made = random_laws(seed, mass, speed)
        assert _residual(made, 2, 5) == pytest.approx(naive(made), rel=1e-12)
    assert naive(random_laws(seed, 1.0, 1.0)) == pytest.approx(naive(made), rel=1e-12, abs=0.0)


def test_of_nothing_there_is_no_share() -> None:
    assert _residual(laws(2, 1), 2, 5) == 0.0


@pytest.mark.parametrize("seed", range(3))
def test_sweeps_settle_after_as_many_in_any_units(seed: int) -> None:
    """Powers of two, so that every rounding is the same; where they settle, the laws are obeyed."""
    counts = []
    for mass, speed in ((1.0, 1.0), (2.0**-30, 2.0**-10), (2.0**20, 2.0**5)):
        made = random_laws(seed, mass, speed)
        counts.append(_relax_percussion_laws(made, 2, 1))
        assert counts[-1][1] and naive(made) < 1e-9
    assert counts[0] == counts[1] == counts[2]


# Do relaxation and Newton's method find the percussions that trying all bases finds, and impacts those of the other solver?

M, N, K = 2, 7, 3


def room_of(case: Sparse, dry: list[int]) -> SimpleNamespace:
    """Room of a step for these contacts and bearings."""
    rows = 2 * case.m + len(dry)
    made = laws(case.m, len(dry))
    for values in made[:-1]:
        values[:] = np.nan
    arrays = {name: np.full(case.n, np.nan) for name in ("u", "inverse", "change")}
    more = {name: np.full(rows, np.nan) for name in ("rates", "more")}
    work = SimpleNamespace(closed=case.closed, laws=made, dry=dry, restitution=np.full(case.m, np.nan), **arrays, **more)
    work.kept = SimpleNamespace(sweeps=0, violation=0.0)
    return work


@pytest.mark.parametrize("dry", [[], [4], [5, 1, 0]])
def test_percussions_move_by_whole_matrices_bearings_behind_contacts(dry: list[int]) -> None:
    rng = np.random.default_rng(len(dry))
    case, count = Sparse(rng, M, N), len(dry)
    work, rows = room_of(case, dry), 4 + count
    both = np.vstack([case.W, np.eye(N)[dry]])
    work.inverse[:] = case.work.system.inverse
    in_python(mobility.fill_mobility)(work, M, count)
    np.testing.assert_allclose(work.laws.G, both * work.inverse @ both.T, atol=1e-14)
    u, P, rates = rng.normal(size=N), rng.normal(size=rows), np.full(rows, np.nan)
    in_python(mobility.rates_of)(work, M, count, u, rates)
    assert rates == pytest.approx(both @ u)
    after = u.copy()
    in_python(mobility.push)(work, M, count, P, after)
    assert after == pytest.approx(u + work.inverse * (both.T @ P))


def stopped(case: Sparse, u: np.ndarray, slowest: float) -> tuple[bool, SimpleNamespace, SimpleNamespace, np.ndarray]:
    """(is any written down?, room, state, events) of the impacts at the start of a step."""
    work, sums = room_of(case, []), SimpleNamespace(drive=0.5, impacts=0.25, damping=0.0)
    counts = SimpleNamespace(lcp=0, lcp_sizes=[0] * 6, lcp_failures=0, energy_rescues=0, impacts=0, events=0)
    state = SimpleNamespace(u=u, sums=sums, counts=counts, clock=SimpleNamespace(time=3.5))
    record = SimpleNamespace(events=np.zeros(4, EVENT_DTYPE).view(np.recarray), used=SimpleNamespace(events=0))
    options = SimpleNamespace(accumulation_speed=slowest)
    written = in_python(percussions.stop_approaches)(case.model, state, options, case.m, work, record)
    return bool(written), work, state, record.events[: record.used.events]


@pytest.mark.parametrize("kind", [COULOMB, SHIFTED, PG1996])
@pytest.mark.parametrize("seed", range(6))
def test_impacts_are_those_of_the_complementarity_problems(seed: int, kind: int) -> None:
    """With a driven coordinate, whose drive works against the percussions; the books close."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, N, friction=0.25, slots=(5, 7))
    given = case.model.laws
    given.kind, given.tangential, given.nu = kind, rng.uniform(0.1, 0.9, 2 * M), rng.uniform(0.1, 0.9, 2 * M)
    given.restitution = rng.uniform(0.3, 0.9)
    case.model.coordinates.driven[2], case.work.system.inverse[2] = 1, 0.0
    eps, u, mass = case.laws.restitution, rng.normal(size=N), case.model.coordinates.mass
    u -= (case.W * case.work.system.inverse).T @ np.linalg.solve(case.G, case.W @ u + [1.2, 0.3, 0.4, -0.5])
    rates, G = case.W @ u, case.G
    first = compressed(G, rates, case.friction)
    total = first + expanded(G, rates, first, eps, case.laws)
    after = u + (case.W * case.work.system.inverse).T @ total
    written, work, state, events = stopped(case, u.copy(), 0.8)
    if state.counts.energy_rescues == 0:
        assert work.u == pytest.approx(after, abs=1e-9)
        np.testing.assert_allclose(work.laws.P, total, atol=1e-9)
    P, mean = work.laws.P, 0.5 * (rates + case.W @ work.u)
    lost = [-float(P[2 * i : 2 * i + 2] @ mean[2 * i : 2 * i + 2]) for i in range(M)]
    free = np.arange(N) != 2
    gained = 0.5 * float((mass * (work.u**2 - u**2))[free].sum())
    assert state.sums.impacts == pytest.approx(0.25 + sum(lost))
    assert state.sums.drive - 0.5 - (state.sums.impacts - 0.25) == pytest.approx(gained)
    assert written and events["kind"].tolist() == [EventKind.IMPACT]  # the slower one is not written down
    assert (events["contact"][0], events["t"][0], events["body"][0]) == (case.closed.ids[0], 3.5, -1)
    assert events["value"][0] == pytest.approx(rates[0]) and events["energy_lost"][0] == pytest.approx(lost[0])
    assert [events["impulse_normal"][0], events["impulse_tangential"][0]] == pytest.approx(P[:2])
    tries = 2 + state.counts.energy_rescues
    assert (state.counts.lcp, state.counts.lcp_sizes, state.counts.impacts) == (tries, [0, 0, tries, 0, 0, 0], 1)
    assert work.kept.sweeps > tries and state.counts.lcp_failures == 0 and 0.0 < work.kept.violation < 1e-12


def test_where_nothing_approaches_nothing_happens() -> None:
    case = Sparse(np.random.default_rng(1), M, N, slots=(5, 7))
    u = (case.W * case.work.system.inverse).T @ np.linalg.solve(case.G, [0.3, 1.0, 0.0, -2.0])
    for name, lift in (("leaves", 1e-9), ("approaches", -1e-9)):
        v = u + (case.W * case.work.system.inverse).T @ np.linalg.solve(case.G, [0.0, 0.0, lift, 0.0])
        written, work, state, events = stopped(case, v.copy(), 0.8)
        assert not written and len(events) == 0
        assert (state.counts.lcp == 0) == (name == "leaves")
        assert work.u == pytest.approx(v, abs=1e-8)
