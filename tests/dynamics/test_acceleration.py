"""Does the acceleration-level problem decide roll, slip and detachment as mechanics and trying all modes do?"""

import itertools
import math

import numpy as np
import pytest
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK, closed_contacts, contact_kinematics, place, poses
from watchsim.dynamics import acceleration, delassus, friction
from watchsim.dynamics import forces as bearing_friction
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import LINE
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.scratch import contact_work
from watchsim.verification.contact_problems import accelerate, decide_modes, solve_mode

# Does the acceleration-level problem decide roll, slip and detachment as mechanics does, singular cases included?

R, M, KAPPA, G = 0.05, 2.0, 0.4, 9.81
J = KAPPA * M * R * R
SLOW = 1e-9
ROOM = 6

_place, _kinematics = callable_kernel(place), callable_kernel(contact_kinematics)


class Outcome:
    """Modes, forces (N, T rows) and accelerations of the given contacts at (q, u) under h."""

    def __init__(self, compiled: Compiled, ids: list[int], q, u, h) -> None:
        model, n = compiled.model, len(compiled.q)
        pose, closed, work = poses(len(model.bodies)), closed_contacts(ROOM), contact_work(ROOM, n)
        self.mode, m = np.zeros(len(model.contacts), np.int8), len(ids)
        _place(model, np.array(q, float), np.array(u, float), pose)
        for row, k in enumerate(ids):
            _kinematics(model, k, pose, row, closed)
        work.system.h[:] = h
        self.grip = np.zeros(n, np.int8)
        self.gaps = closed.kin.g[:m].copy()
        self.solved = decide_modes(model, closed, m, 0, SLOW, work, self.grip, self.mode)
        self.force, self.a = work.system.force[: 2 * m].copy(), np.zeros(n)
        accelerate(model, closed, m, work, self.a)
        # The equality system of the decided mode has the same answer as the complementarity problem that chose it.
        self.again = np.zeros(n)
        stay = [row for row, k in enumerate(ids) if self.mode[k] != OPEN]
        for row, kept in enumerate(stay):
            _kinematics(model, ids[kept], pose, row, closed)
        solve_mode(model, closed, len(stay), self.mode, 1.0, work)
        accelerate(model, closed, len(stay), work, self.again)


def disc_on_plane(mu: float) -> tuple[Compiled, int]:
    """A free disc on a plane along x; the contact's number."""
    disc = Body("disc", "free", (0.0, R), mass=M, inertia=J, loops=(Loop((Arc(0.0, 0.0, R, 0.0, 2.0 * math.pi),)),))
    plane = Body("plane", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    scene = Scene("disc", (disc, plane), contacts=(Contact((Side("disc"), Side("plane")), mu, 0.0),))
    compiled = compile_scene(scene)
    kinds = compiled.model.primitives.kind[compiled.model.contacts.b]
    return compiled, int(np.flatnonzero(kinds == LINE)[0])


def on_incline(mu: float, slope: float, v: float, spin: float, push: float = 0.0) -> Outcome:
    """The disc on the incline, downhill is +x; `push` is a force off the plane."""
    compiled, k = disc_on_plane(mu)
    h = [M * G * math.sin(slope), -M * G * math.cos(slope) + push, 0.0]
    out = Outcome(compiled, [k], (0.0, R, 0.3), (v, 0.0, spin), h)
    assert out.solved
    assert out.gaps == pytest.approx([0.0], abs=1e-16)
    assert out.again == pytest.approx(out.a, abs=1e-12 * G)
    out.mode = out.mode[k : k + 1]
    return out


SLOPE = math.radians(20.0)
CRITICAL = math.tan(SLOPE) * KAPPA / (1.0 + KAPPA)  # least friction that makes it roll


@pytest.mark.parametrize("mu", [1.0001 * CRITICAL, 0.3, 1.0])
@pytest.mark.parametrize("v", [0.0, 0.7, -0.7])
def test_rolls(mu: float, v: float) -> None:
    out = on_incline(mu, SLOPE, v, -v / R)
    a = G * math.sin(SLOPE) / (1.0 + KAPPA)
    assert out.mode == [STICK]
    assert out.a == pytest.approx([a, 0.0, -a / R], abs=1e-12 * G / R)
    # t points uphill (n turned by +90 degrees): friction on the disc, body A, is along +t.
    assert out.force == pytest.approx([M * G * math.cos(SLOPE), M * G * math.sin(SLOPE) * KAPPA / (1.0 + KAPPA)], rel=1e-12)


@pytest.mark.parametrize("mu", [0.9999 * CRITICAL, 0.05])
def test_begins_to_slip(mu: float) -> None:
    out = on_incline(mu, SLOPE, 0.7, -0.7 / R)
    press = M * G * math.cos(SLOPE)
    assert abs(out.mode[0]) == 1
    assert out.a == pytest.approx([G * math.sin(SLOPE) - mu * press / M, 0.0, -mu * press * R / J], rel=1e-12, abs=1e-12)


def test_without_friction_it_slides_freely() -> None:
    out = on_incline(0.0, SLOPE, 0.0, 0.0)
    assert out.a == pytest.approx([G * math.sin(SLOPE), 0.0, 0.0], abs=1e-13)
    assert out.force[1] == 0.0


@pytest.mark.parametrize("v", [-0.5, 0.5])
def test_slides_against_its_slip(v: float) -> None:
    """Uphill (v < 0) and downhill without spin: friction opposes the slip, whatever the slope does."""
    mu = 0.2
    out = on_incline(mu, SLOPE, v, 0.0)
    press, side = M * G * math.cos(SLOPE), math.copysign(1.0, v)
    assert out.a == pytest.approx([G * math.sin(SLOPE) - side * mu * press / M, 0.0, -side * mu * press * R / J], rel=1e-12)
    # g_T_dot is the disc's velocity along t, which points uphill.
    assert out.mode == [BACKWARD if v > 0.0 else FORWARD]


@pytest.mark.parametrize(("v", "spin"), [(0.0, 0.0), (0.3, 0.0), (0.3, -0.3 / R)])
def test_detaches_exactly_when_pulled_off(v: float, spin: float) -> None:
    weight = M * G * math.cos(SLOPE)
    stays = on_incline(0.3, SLOPE, v, spin, push=0.999 * weight)
    leaves = on_incline(0.3, SLOPE, v, spin, push=1.001 * weight)
    assert stays.mode != [OPEN]
    assert stays.force[0] == pytest.approx(0.001 * weight, rel=1e-9)
    assert leaves.mode == [OPEN]
    assert np.all(leaves.force == 0.0)
    assert leaves.a == pytest.approx([G * math.sin(SLOPE), 0.001 * weight / M, 0.0], rel=1e-9, abs=1e-12)


def rotor_on_stop(arm: tuple[float, float], mu: float) -> tuple[Compiled, list[int]]:
    """A rotor about the origin whose downward corner, at `arm` from the axis, rests on a fixed horizontal line."""
    x, y = arm
    tip = Loop((Line(x - 0.2, y + 0.3, x, y), Line(x, y, x + 0.2, y + 0.3)), closed=False)
    rotor = Body("rotor", "pivot", (0.0, 0.0), 0.0, inertia=0.7, loops=(tip,))
    stop = Body("stop", "fixed", loops=(Loop((Line(5.0, y, -5.0, y),), closed=False),))
    scene = Scene("rotor", (rotor, stop), contacts=(Contact((Side("rotor"), Side("stop")), mu, 0.0),))
    compiled = compile_scene(scene)
    model = compiled.model
    ids = [
        k
        for k, c in enumerate(model.contacts)
        if model.primitives[c.a].kind == 0 and model.primitives[c.a].body == 0 and model.primitives[c.b].kind == LINE
    ]
    assert len(ids) == 1
    return compiled, ids


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("height", [-0.3, 0.0, 0.3])
def test_one_rotor_on_a_stop(mu: float, height: float) -> None:
    """One coordinate, up to two forces: det G = 0. Pressed on it stays, pulled off it leaves; either acceleration is unique."""
    compiled, ids = rotor_on_stop((1.0, height), mu)
    pressed = Outcome(compiled, ids, [0.0], [0.0], [-2.0])
    assert pressed.solved
    assert pressed.mode[ids[0]] == STICK if mu > 0.0 and height != 0.0 else pressed.mode[ids[0]] != OPEN
    assert pressed.a == pytest.approx([0.0], abs=1e-13)
    assert pressed.again == pytest.approx([0.0], abs=1e-13)
    assert pressed.force[0] > 0.0
    assert abs(pressed.force[1]) <= mu * pressed.force[0] * (1.0 + 1e-12)
    # Moment balance: the forces carry the torque, however they share it.
    assert pressed.force[0] - height * -pressed.force[1] == pytest.approx(2.0, abs=1e-12)
    pulled = Outcome(compiled, ids, [0.0], [0.0], [3.0])
    assert pulled.mode[ids[0]] == OPEN
    assert pulled.a == pytest.approx([3.0 / 0.7], rel=1e-13)


def test_a_block_on_four_redundant_corners_stays() -> None:
    """A square lying flat touches with two corners on the plane; with stick the four forces are not unique, the rest is."""
    s, mu = 0.1, 0.5
    points = [(-s, -s), (s, -s), (s, s), (-s, s)]
    edges = tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True))
    block = Body("block", "free", (0.0, s), mass=M, inertia=0.01, loops=(Loop(edges),))
    plane = Body("plane", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    compiled = compile_scene(Scene("block", (block, plane), contacts=(Contact((Side("block"), Side("plane")), mu, 0.0),)))
    p = compiled.model.primitives
    ids = [k for k, c in enumerate(compiled.model.contacts) if p[c.a].kind == 0 and p[c.a].body == 0 and p[c.a].y < 0.0]
    ids = [k for k in ids if p[compiled.model.contacts[k].b].kind == LINE]
    assert len(ids) == 2
    for slope, stays in ((0.9 * math.atan(mu), True), (1.1 * math.atan(mu), False)):
        h = [M * G * math.sin(slope), -M * G * math.cos(slope), 0.0]
        out = Outcome(compiled, ids, (0.0, s, 0.0), (0.0, 0.0, 0.0), h)
        assert out.solved
        a = 0.0 if stays else G * (math.sin(slope) - mu * math.cos(slope))
        assert out.a == pytest.approx([a, 0.0, 0.0], abs=1e-11 * G)
        assert out.again == pytest.approx([a, 0.0, 0.0], abs=1e-11 * G)
        assert out.force[0] + out.force[2] == pytest.approx(M * G * math.cos(slope), rel=1e-12)


# Does the acceleration problem decide what trying all modes, one by one with numpy, says is the only way?

SIGN = {STICK: 0, FORWARD: 1, BACKWARD: -1}
Way = tuple[tuple[int, ...], tuple[int, ...], np.ndarray, np.ndarray]  # modes, grips, u', forces
SLOWEST = 1e-5  # m/s: contacts that slip less may stick


def accelerations(case: Sparse, dry: list[int], modes: tuple[int, ...], grips: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """(u', contact forces, bearing torques) in these modes, by one linear system."""
    n, m = case.n, case.m
    mass, h = case.model.coordinates.mass, case.work.system.h
    friction, torque = case.friction, np.array([case.model.coordinates[j].coulomb for j in dry])
    size = n + 2 * m + len(dry)
    A, right = np.zeros((size, size)), np.zeros(size)
    A[:n, :n], right[:n] = np.diag(mass), h
    A[:n, n : n + 2 * m] = -case.W.T
    for k, j in enumerate(dry):
        line = n + 2 * m + k
        A[j, line] = -1.0
        if grips[k] == STICK:
            A[line, j] = 1.0
        else:
            A[line, line], right[line] = 1.0, -grips[k] * torque[k]
    for i, mode in enumerate(modes):
        N, T = n + 2 * i, n + 2 * i + 1
        if mode == OPEN:
            A[N, N] = A[T, T] = 1.0
            continue
        A[N, :n], right[N] = case.W[2 * i], -case.bars[2 * i]
        if mode == STICK:
            A[T, :n], right[T] = case.W[2 * i + 1], -case.bars[2 * i + 1]
        else:
            A[T, T], A[T, N] = 1.0, mode * friction[i]
    x = np.linalg.solve(A, right)
    return x[:n], x[n : n + 2 * m], x[n + 2 * m :]


def ways(case: Sparse, dry: list[int], slips: np.ndarray) -> list[Way]:
    """All that no law forbids."""
    found = []
    slides = [(OPEN, FORWARD if s > 0.0 else BACKWARD) for s in slips]
    choices = [(*two, STICK, -two[1]) if abs(s) <= SLOWEST else two for s, two in zip(slips, slides, strict=True)]
    for modes in itertools.product(*choices):
        for grips in itertools.product((STICK, FORWARD, BACKWARD), repeat=len(dry)):
            a, force, torque = accelerations(case, dry, modes, grips)
            gaps = case.W @ a + case.bars
            good = all(force[2 * i] >= 0.0 and gaps[2 * i] >= -1e-9 for i in range(case.m))
            for i, mode in enumerate(modes):
                good &= mode != STICK or abs(force[2 * i + 1]) <= case.friction[i] * force[2 * i]
                good &= abs(slips[i]) > SLOWEST or mode not in (FORWARD, BACKWARD) or mode * gaps[2 * i + 1] > 0.0
            for k, j in enumerate(dry):
                good &= grips[k] != STICK or abs(torque[k]) <= case.model.coordinates[j].coulomb
                good &= grips[k] == STICK or grips[k] * a[j] > 0.0
            if good:
                found.append((modes, grips, a, force))
    return found


@pytest.mark.parametrize("seed", sorted({*range(24)} - {11}))  # there friction grips too much
def test_contacts_and_bearings_move_in_the_only_way_there_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m, n, bearings = 1 + seed % 2, 8, seed % 3
    case = Sparse(rng, m, n, friction=0.3, slots=(5, 7))
    work, dry = case.work, [int(j) for j in rng.permutation(n)[:bearings]]
    case.model.coordinates.coulomb[dry] = rng.uniform(0.1, 1.5, bearings)
    case.work.system.dry[:] = case.model.coordinates.coulomb
    if m == 2:  # without friction, or with next to none
        one = 0.0 if seed % 4 == 1 else 5e-4
        case.model.laws.friction[case.model.contacts[case.closed.ids[1]].group] = case.friction[1] = one
    slips = rng.choice([0.0, 0.9e-5, -0.9e-5, 1.1e-5, -1.1e-5], m)
    case.closed.kin.gT_dot[:m] = slips
    found = ways(case, dry, slips)
    assert len(found) == 1
    modes, grips, a, force = found[0]
    system, problem = work.system, work.problem
    problem.bearing[:bearings], h, inverse = dry, system.h.copy(), system.inverse.copy()
    out_grip, out_mode = np.full(n, STICK, np.int8), np.full(2 * m, 77, np.int8)
    decide = in_python(acceleration.decide_modes)
    assert decide(case.model, case.closed, m, bearings, SLOWEST, system, problem, out_grip, out_mode)
    expected = list(modes)
    for i in range(m):
        if case.friction[i] == 0.0 and modes[i] != OPEN:  # which way it slides makes no difference
            expected[i] = BACKWARD if slips[i] < 0.0 else FORWARD
    assert [out_mode[k] for k in case.closed.ids[:m]] == expected
    assert np.count_nonzero(out_mode == 77) == m
    assert [out_grip[j] for j in dry] == list(grips)
    assert system.force[: 2 * m] == pytest.approx(force, abs=1e-12)
    for j, grip in zip(dry, grips, strict=True):
        inverse[j] *= grip != STICK
        h[j] -= SIGN[grip] * case.model.coordinates[j].coulomb
    assert system.h == pytest.approx(h) and system.inverse == pytest.approx(inverse)
    for values in (system.b, system.size, problem.loaded):
        assert not np.isnan(values[: 2 * m + bearings]).any() and np.isnan(values[2 * m + bearings :]).all()
    speeding = np.zeros(n)
    in_python(acceleration.accelerate)(case.model, case.closed, m, system, speeding)
    assert speeding == pytest.approx(a, abs=1e-12)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("light", [1.0, 1e-12])
def test_forces_in_decided_modes_solve_one_linear_system(seed: int, light: float) -> None:
    """Also where a second mechanism, which shares no coordinate with the first, is a million million times lighter."""
    rng = np.random.default_rng(100 + seed)
    case = Sparse(rng, 3, 8)
    for i, first in ((0, 0), (1, 4), (2, 0)):
        case.moves(i, first + rng.permutation(4), rng)
    modes = tuple(int(mode) for mode in rng.choice([STICK, FORWARD, BACKWARD], 3))
    case.model.laws.friction[case.model.contacts[case.closed.ids[seed % 3]].group] = case.friction[seed % 3] = 5e-4
    _, force, _ = accelerations(case, [], modes, ())
    for values in (case.model.coordinates.mass, case.work.system.h):
        values[4:] *= light
    case.work.system.inverse[:] = 1.0 / case.model.coordinates.mass
    by_number = np.full(6, 55, np.int8)
    by_number[case.closed.ids[:3]] = modes
    assert in_python(acceleration.solve_mode)(case.model, case.closed, 3, by_number, 1.0, case.work.system, case.work.modes)
    force[2:4] *= light
    assert case.work.system.force[:6] == pytest.approx(force, rel=1e-9, abs=0.0)


# Are the sums over the coordinates of each contact those of whole matrices?

SEEDS = pytest.mark.parametrize("seed", range(5))


def made(seed: int) -> tuple[Sparse, np.random.Generator]:
    """One to four contacts on six coordinates, of which the third is driven."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, 1 + seed % 4, 6)
    case.model.coordinates.driven[2] = 1
    case.work.system.inverse[2] = 0.0
    return case, rng


@SEEDS
def test_impulses_change_rates_by_the_matrix_of_delassus(seed: int) -> None:
    case, _ = made(seed)
    system, rows = case.work.system, 2 * case.m
    system.G[:] = np.nan
    in_python(delassus.fill_delassus)(case.closed, case.m, system.inverse, system.G)
    assert system.G[:rows, :rows] == pytest.approx(case.G)
    assert np.isnan(system.G[rows:]).all() and np.isnan(system.G[:, rows:]).all()


@SEEDS
def test_rates_of_contacts_and_what_drives_do_against_their_impulses(seed: int) -> None:
    case, rng = made(seed)
    u, force = rng.normal(size=6), rng.normal(size=2 * case.m)
    rates = np.full(2 * case.m, np.nan)
    in_python(delassus.contact_velocities)(case.closed, case.m, u, rates)
    assert rates == pytest.approx(case.W @ u)
    case.model.coordinates.driven[4] = 1
    spent = in_python(delassus.drive_through_contacts)(case.model, case.closed, case.m, force, u)
    assert spent == pytest.approx(-(case.W.T @ force)[[2, 4]] @ u[[2, 4]])
    change = np.ones(6)
    in_python(delassus.apply)(case.closed, case.m, force, case.work.system.inverse, change)
    assert change == pytest.approx(1.0 + case.work.system.inverse * (case.W.T @ force))


@SEEDS
def test_held_coordinates_carry_what_contacts_do_to_them(seed: int) -> None:
    """And the sum of its terms without sign; the others nothing."""
    case, rng = made(seed)
    force, grips = rng.normal(size=2 * case.m), np.array([STICK, OPEN, STICK, FORWARD, BACKWARD, STICK])
    load, terms = np.ones(6), np.ones(6)
    in_python(bearing_friction.add_loads)(case.closed, case.m, force, grips, load, terms)
    held = grips == STICK
    assert load == pytest.approx(1.0 + held * (case.W.T @ force))
    assert terms == pytest.approx(1.0 + held * (np.abs(case.W.T) @ np.abs(force)))


def test_moving_bearings_drag_and_take_power() -> None:
    case, rng = made(0)
    case.model.coordinates.coulomb[:] = rng.uniform(0.1, 1.0, 6)
    dry = case.model.coordinates.coulomb
    grips, u, h = np.array([STICK, FORWARD, BACKWARD, OPEN, FORWARD, BACKWARD]), rng.normal(size=6), np.full(6, 3.0)
    moving = np.array([0, 1, -1, 0, 1, -1])
    in_python(bearing_friction.add_drag)(dry, grips, h)
    assert h == pytest.approx(3.0 - moving * dry)
    assert in_python(bearing_friction.drag_power)(dry, grips, u) == pytest.approx(moving * dry @ u)


# What does friction leave of how forces part bodies?


@pytest.mark.parametrize("seed", range(20))
def test_the_share_that_friction_leaves_is_a_ratio_of_determinants(seed: int) -> None:
    """For one contact by itself that is 1 - mu G_c / G_N; where friction makes the system singular it vanishes."""
    random, m = np.random.default_rng(seed), 3
    ways = random.normal(size=(2 * m, 2 * m + 2))
    G = ways @ ways.T
    along = np.where(np.arange(m) == 1, 0.0, random.uniform(-0.8, 0.8, m))
    rows = np.array([0, 2, 3, 4])  # the middle one sticks
    bent = G - np.zeros_like(G)
    bent[:, 0::2] -= along * G[:, 1::2]
    share, room = callable_kernel(friction.share_left), np.zeros((8, 8))
    expected = np.linalg.det(bent[np.ix_(rows, rows)]) / np.linalg.det(G[np.ix_(rows, rows)])
    assert share(G, along, rows, 4, room) == pytest.approx(expected, rel=1e-9)
    assert share(G, along, rows[:1], 1, room) == pytest.approx(1.0 - along[0] * G[0, 1] / G[0, 0], rel=1e-12)
    singular = np.array([G[0, 0] / G[0, 1], 0.0, 0.0])
    assert abs(share(G, singular, rows[:1], 1, room)) < 1e-14
