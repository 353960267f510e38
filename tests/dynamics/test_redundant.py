"""Are accelerations right and forces the smallest possible where contacts are redundant?"""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python
from random_contacts import Case

from watchsim.contact.gaps import STICK
from watchsim.dynamics import redundant
from watchsim.simulation.scratch import ContactWork, contact_work
from watchsim.verification.contact_problems import accelerate, decide_modes, solve_mode

# Are accelerations right and forces the smallest possible where contacts are redundant?


def resting(case: Case, h: np.ndarray, sticks: bool = True) -> tuple[bool, np.ndarray, np.ndarray]:
    """Forces unique?, forces, accelerations of the case with all contacts closed, at rest, under the generalized forces h."""
    case.work.system.h[:], case.work.system.inverse[:] = h, 1.0 / case.mass
    case.closed.kin.bar_N[:], case.closed.kin.bar_T[:] = 0.0, 0.0
    unique = solve_mode(case.model, case.closed, case.m, np.full(case.m, STICK if sticks else 1, np.int8), 1.0, case.work)
    a = np.zeros(case.n)
    accelerate(case.model, case.closed, case.m, case.work, a)
    return bool(unique), case.work.system.force[: 2 * case.m].copy(), a


def smallest(case: Case, h: np.ndarray) -> np.ndarray:
    """Of all forces under which no gap accelerates, those with the least sum of squares: numpy's pseudoinverse."""
    W = case.W
    return np.linalg.lstsq(W / case.mass @ W.T, -W @ (h / case.mass), rcond=1e-10)[0]


def test_one_rotor_against_the_frame() -> None:
    """Two forces for one coordinate: both act through their lever arms, the smallest in proportion to these."""
    case = Case(np.array([0.3]), np.array([[1.5], [0.4]]), np.array([0.5]), np.zeros(1))
    unique, force, a = resting(case, np.array([-2.0]))
    assert not unique
    assert a == pytest.approx([0.0], abs=1e-14)
    assert force == pytest.approx(2.0 * np.array([1.5, 0.4]) / (1.5**2 + 0.4**2), rel=1e-13, abs=0.0)


def test_a_table_on_four_legs() -> None:
    """Without friction in the plane: four normals, two coordinates; a symmetric load is shared alike."""
    places = np.array([-1.5, -0.5, 0.5, 1.5])
    W = np.zeros((8, 2))
    W[::2, 0], W[::2, 1] = 1.0, places
    case = Case(np.array([2.0, 0.7]), W, np.zeros(4), np.zeros(4))
    unique, force, a = resting(case, np.array([-8.0, 0.0]))
    assert not unique
    assert a == pytest.approx([0.0, 0.0], abs=1e-14)
    assert force[::2] == pytest.approx(np.full(4, 2.0), rel=1e-13, abs=0.0)
    # Loaded far to one side the smallest forces would pull at the other end: there they must vanish.
    _, force, a = resting(case, np.array([-8.0, -10.0]))
    assert a == pytest.approx([0.0, 0.0], abs=1e-13)
    assert np.all(force[::2] >= -1e-12)
    assert force[::2].sum() == pytest.approx(8.0, rel=1e-12)
    assert force[::2] @ places == pytest.approx(10.0, rel=1e-12)
    # On three legs one would still pull; on two the sum and the moment leave no choice.
    assert force[::2] == pytest.approx([0.0, 0.0, 2.0, 6.0], abs=1e-9)


def test_random_redundant_sets_have_the_smallest_forces() -> None:
    """Three sticking contacts on three coordinates: six forces. Where the smallest obey the laws they are found."""
    rng = np.random.default_rng(111)
    found = 0
    for _ in range(300):
        mass, mu = 10.0 ** rng.uniform(-2.0, 2.0, 3), rng.uniform(0.3, 2.0, 3)
        case = Case(mass, rng.normal(size=(6, 3)), mu, np.zeros(3))
        h = -case.W[::2].T @ rng.uniform(0.5, 1.0, 3)
        unique, force, a = resting(case, h)
        truth = smallest(case, h)
        assert not unique
        assert a == pytest.approx(np.zeros(3), abs=1e-9 * np.abs(h / mass).max())
        if np.all(truth[::2] > 1e-6) and np.all(np.abs(truth[1::2]) < mu * truth[::2]):
            assert force == pytest.approx(truth, rel=1e-7, abs=1e-8)
            found += 1
        elif np.all(force[::2] >= -1e-9) and np.all(np.abs(force[1::2]) <= mu * force[::2] + 1e-9):
            assert np.linalg.norm(force) >= np.linalg.norm(truth) * (1.0 - 1e-9)
    assert found > 20


def test_a_lever_on_its_banking_with_a_tooth_that_sticks() -> None:
    """Wheel presses lever, lever presses the stop: two coordinates, four forces; both stand still, no force pulls."""
    arms = np.array([[3.0, -2.0], [0.5, 1.0], [0.0, 2.5], [0.0, 0.3]])  # tooth N, T; stop N, T
    case = Case(np.array([5e-12, 3e-12]), arms * 1e-3, np.array([0.15, 0.15]), np.zeros(2))
    h = np.array([-1e-6, 0.0])
    unique, force, a = resting(case, h)
    assert not unique
    assert a == pytest.approx([0.0, 0.0], abs=1e-9 * np.abs(h / case.mass).max())
    assert case.W.T @ force == pytest.approx(-h, abs=1e-12 * np.abs(h).max())
    assert np.all(force[::2] > 0.0)
    assert np.all(np.abs(force[1::2]) <= case.friction * force[::2] * (1.0 + 1e-9))
    mode, grip = np.zeros(2, np.int8), np.zeros(2, np.int8)
    assert decide_modes(case.model, case.closed, 2, 0, 1e-9, case.work, grip, mode)
    assert list(mode) == [STICK, STICK]


def test_forces_without_bound_are_not_taken() -> None:
    """A disc in a groove of a right angle, friction 1: it can be squeezed along the edges of both cones without bound.

    That does not help a torque beyond what the weight's friction holds: the smallest forces stay, and leave a cone.
    """
    c, r = np.sqrt(0.5), 0.5
    W = np.array([[c, c, 0.0], [c, -c, r], [-c, c, 0.0], [c, c, r]])
    case = Case(np.array([2.0, 2.0, 0.25]), W, np.ones(2), np.zeros(2))
    squeeze = np.array([1.0, 1.0, 1.0, -1.0])
    assert squeeze @ W == pytest.approx(np.zeros(3), abs=1e-15)
    for torque in (-3.0, 3.0):
        h = np.array([0.0, -2.0, torque])
        unique, force, a = resting(case, h)
        assert not unique
        assert a == pytest.approx(np.zeros(3), abs=1e-13)
        assert force == pytest.approx(smallest(case, h), abs=1e-12)
        assert np.any(np.abs(force[1::2]) > force[::2] * (1.0 + 1e-9))


def test_bodies_a_million_million_times_apart_keep_all_their_forces() -> None:
    """Two contacts that share nothing, one on a body of 1 kg, one on a body of 1e-12 kg: neither is taken for redundant."""
    W = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    case = Case(np.array([1.0, 1e-12]), W, np.zeros(2), np.zeros(2))
    unique, force, a = resting(case, np.array([-9.81, -9.81e-12]))
    assert unique
    assert force[::2] == pytest.approx([9.81, 9.81e-12], rel=1e-13, abs=0.0)
    assert a == pytest.approx([0.0, 0.0], abs=1e-14)


def test_forces_do_not_turn_what_dry_friction_holds() -> None:
    """A lever pressed against another one that its dry bearing holds: of the forces that keep it, only some leave that one.

    Without motion the moment of N and T about the pressed lever's pivot is given, N a + T b = M. The smallest of them turn the
    held one by more than its friction; the nearest that do not end at it, N c + T d = friction.
    """
    (a, b), (c, d), moment, dry = (1.5, 0.4), (1.0, -0.8), 2.0, 0.6
    case = Case(np.array([0.3, 0.5]), np.array([[a, c], [b, d]]), np.array([0.9]), np.zeros(1))
    case.model.coordinates.flags.writeable = True
    case.work.system.dry[1] = dry
    case.model.coordinates.flags.writeable = False  # machine code for arrays that can be written would be another one
    case.work.system.h[:], case.work.system.inverse[:] = [-moment, 0.0], [1.0 / 0.3, 0.0]
    case.closed.kin.bar_N[:], case.closed.kin.bar_T[:] = 0.0, 0.0
    plain = moment * np.array([a, b]) / (a * a + b * b)
    assert plain @ [c, d] > dry
    unique = solve_mode(case.model, case.closed, 1, np.full(1, STICK, np.int8), 1.0, case.work)
    assert not unique
    assert case.work.system.force[:2] == pytest.approx(np.linalg.solve([[a, b], [c, d]], [moment, dry]), rel=1e-9)


def test_laws_that_leave_no_forces_are_missed_by_as_little() -> None:
    """A block on two legs, about to tip: one leg would pull by 1e-12 of the weight. No forces obey the laws, but nearly so."""
    W = np.zeros((4, 3))
    W[0::2, 0], W[1::2, 1] = 1.0, 1.0  # N up, T along; four forces for three coordinates
    W[0::2, 2], W[1::2, 2] = [-1.0, 1.0], 1.0
    for pull, obeyed in ((1e-12, True), (1e-6, False)):
        case = Case(np.ones(3), W, np.full(2, 0.5), np.zeros(2))
        h = np.array([-1.0, -0.3, -1.3 - pull])  # N1 + N2 = 1, T1 + T2 = 0.3, N2 - N1 + 0.3 = 1.3 + pull
        _, force, a = resting(case, h)
        assert a == pytest.approx(np.zeros(3), abs=1e-12)
        assert force[::2] == pytest.approx([-0.5 * pull, 1.0 + 0.5 * pull], abs=1e-13)
        assert bool(abs(force[1]) < 1e-9) == obeyed  # else half of the friction is where nothing presses


# Are forces that no motion decides the smallest ones that obey the laws?

MODEL = SimpleNamespace(coordinates=[])
M = 3
TANGENT = [3, -1, 4]  # contacts 0 and 2 stick, 1 slides with a friction of 0.6
UNKNOWNS = 5
WEIGHTS = np.array([1.0, 1.0 + 0.6**2, 1.0, 1.0, 1.0])


def eliminated(rng: np.random.Generator, rank: int) -> tuple[ContactWork, np.ndarray, np.ndarray]:
    """After `solve_small` on a problem of that rank, in uneven units; its matrix and right-hand side."""
    work = contact_work(M, 4)
    half, units = rng.normal(size=(UNKNOWNS, rank)), 10.0 ** rng.uniform(-1.0, 1.0, UNKNOWNS)
    A = half @ half.T * np.outer(units, units)
    b = A @ (np.array([1.0, 0.7, 1.3, 0.1, -0.2]) / units)
    system, modes = work.system, work.modes
    modes.A[:UNKNOWNS, :UNKNOWNS], modes.rhs[:UNKNOWNS], modes.scale[:UNKNOWNS] = A, b, np.diag(A) ** -0.5
    modes.unknown[:], modes.drag[:], modes.friction[:] = TANGENT, [0.0, 0.6, 0.0], [0.5, 0.0, 0.8]
    system.G[:], system.size[:] = np.eye(len(system.G)), 1.0
    solve = in_python(redundant.solve_small)
    assert solve(modes.A, modes.rhs, UNKNOWNS, modes.scale, modes.order, modes.x, 1e-11) == rank
    assert A @ modes.x[:UNKNOWNS] == pytest.approx(b)
    return work, A, b


def laws(x: np.ndarray) -> np.ndarray:
    """What must not be negative: normal forces, and both sides of the cones of those that stick."""
    return np.array([*x[:3], 0.5 * x[0] - x[3], 0.5 * x[0] + x[3], 0.8 * x[2] - x[4], 0.8 * x[2] + x[4]])


def smallest_smallest_forces(A: np.ndarray, start: np.ndarray, rank: int) -> tuple[np.ndarray, np.ndarray | None]:
    """The smallest of all forces, and the smallest that obey the laws, if any do."""
    free = np.linalg.svd(A)[2][rank:]
    free = np.linalg.solve(np.linalg.cholesky(free * WEIGHTS @ free.T), free)  # of length one in the weights
    plain = start - free.T @ (free * WEIGHTS @ start)
    room = laws(plain)
    gain = np.array([laws(row) for row in free]).T
    changes = [
        np.linalg.pinv(gain[list(edges)]) @ -room[list(edges)] if edges else np.zeros(len(free))
        for count in range(len(free) + 1)
        for edges in itertools.combinations(range(len(room)), count)
    ]
    obeyed = [change for change in changes if (room + gain @ change).min() > -1e-10]
    return plain, plain + free.T @ min(obeyed, key=np.linalg.norm) if obeyed else None


@pytest.mark.parametrize("rank", [2, 3, 4])
@pytest.mark.parametrize("seed", range(8))
def test_the_smallest_forces_that_obey_the_laws_are_taken(seed: int, rank: int) -> None:
    """By the sum of squares of all forces, friction of sliding contacts among them; without such forces the smallest of all."""
    work, A, b = eliminated(np.random.default_rng(seed), rank)
    plain, lawful = smallest_smallest_forces(A, work.modes.x[:UNKNOWNS].copy(), rank)
    in_python(redundant.smallest_forces)(MODEL, None, M, UNKNOWNS, rank, 1.0, work.system, work.modes)
    assert A @ work.modes.x[:UNKNOWNS] == pytest.approx(b, rel=1e-8)
    assert work.modes.x[:UNKNOWNS] == pytest.approx(plain if lawful is None else lawful, abs=1e-8)


def test_of_these_some_obey_the_laws_by_themselves_most_with_a_change_and_some_not_at_all() -> None:
    """So that the test above asks what it is meant to ask."""
    found = []
    for seed, rank in itertools.product(range(8), (2, 3, 4)):
        work, A, _ = eliminated(np.random.default_rng(seed), rank)
        plain, lawful = smallest_smallest_forces(A, work.modes.x[:UNKNOWNS].copy(), rank)
        found.append("none" if lawful is None else "change" if laws(plain).min() < -1e-3 else "plain")
    assert {word: found.count(word) for word in ("plain", "change", "none")} == {"plain": 5, "change": 17, "none": 2}
