"""Do random impacts and complementarity problems come out, each against an answer found another way?"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import OPEN, Closed, closed_contacts
from watchsim.dynamics.impact import energy_gain
from watchsim.dynamics.lcp import LcpOutcome, lcp_work, solve_lcp
from watchsim.jit import callable_kernel
from watchsim.model import (
    BEARING,
    BODY,
    BODY_PAIR,
    COIL,
    CONTACT,
    COORDINATE,
    JOINT,
    LAW,
    LINE_SPRING,
    PRIMITIVE,
    SHOCK,
    TABLE,
    TANGENTIAL_CODE,
    WEIGHED,
    Model,
    frozen,
    records,
)
from watchsim.simulation.scratch import ContactWork, contact_work
from watchsim.verification.checks import Row, compared
from watchsim.verification.contact_problems import decide_modes, impact, solve_mode

# Which contacts can be given without any geometry? Directions, masses and laws alone.
#
# `impact`, `decide_modes` and `solve_mode` read nothing else, so that random problems and models with their own coordinates
# can be put to them.

Array = NDArray[np.float64]


_energy_gain = callable_kernel(energy_gain)


class BareContacts:
    """m contacts on n coordinates: masses (n,), W (2m, n) with rows N, T, N, T, ..., friction and restitution (m,)."""

    def __init__(self, mass: Array, W: Array, friction: Array, restitution: Array, law: str = "coulomb", **more: Any) -> None:
        """`law` with `tangential` (restitution, by contact) and `nu` as in the scene file."""
        self.law, self.tangential, self.nu = (
            law,
            np.broadcast_to(more.get("tangential", 0.0), len(friction)),
            more.get("nu", 0.0),
        )
        self.mass, self.W, self.friction, self.restitution = mass, W, friction, restitution
        self.m, self.n = len(friction), len(mass)
        self.G = W / mass @ W.T
        self.model = self._model()
        self.closed: Closed = closed_contacts(self.m)
        self.work: ContactWork = contact_work(self.m, self.n)
        self.take(list(range(self.m)))

    def _model(self) -> Model:
        coordinates, laws, contacts = records(COORDINATE, self.n), records(LAW, self.m), records(CONTACT, self.m)
        coordinates.mass, laws.friction, contacts.group = self.mass, self.friction, np.arange(self.m)
        laws.kind, laws.tangential, laws.nu = TANGENTIAL_CODE[self.law], self.tangential, self.nu
        none = {
            "bodies": BODY,
            "joints": JOINT,
            "lines": LINE_SPRING,
            "bearings": BEARING,
            "shocks": SHOCK,
            "weighed": WEIGHED,
            "coils": COIL,
            "tables": TABLE,
            "primitives": PRIMITIVE,
            "pairs": BODY_PAIR,
        }
        parts = {name: records(dtype, 0) for name, dtype in none.items()}
        parts |= {"coordinates": coordinates, "contacts": contacts, "laws": laws}
        parts |= {
            "knots": np.zeros((0, 2)),
            "jolts": np.zeros((0, 6)),
            "windings": np.zeros((0, 4)),
            "near": np.zeros(0, np.int64),
        }
        return Model(**{name: frozen(part) for name, part in parts.items()})

    def take(self, contacts: list[int]) -> None:
        """Let only these contacts take part, in this order."""
        self.taken = contacts
        for row, i in enumerate(contacts):
            self.closed.ids[row], self.closed.slots[row] = i, self.n
            self.closed.coord[row, : self.n] = np.arange(self.n)
            self.closed.w_N[row, : self.n], self.closed.w_T[row, : self.n] = self.W[2 * i], self.W[2 * i + 1]

    def impact(self, u: Array, restitution: Array | None = None) -> tuple[bool, Array, Array]:
        """Solved?, velocities after, impulses N, T, N, T, ... of the contacts that take part."""
        after, m = u.copy(), len(self.taken)
        shares = (self.restitution if restitution is None else restitution)[self.taken]
        solved = impact(self.model, self.closed, m, shares, 0.0, self.work, after)
        return bool(solved), after, self.work.phases.impulse[: 2 * m].copy()

    def energy_change(self) -> float:
        """Of the impact just solved, as the kernel says, J."""
        system, phases = self.work.system, self.work.phases
        return float(_energy_gain(2 * len(self.taken), system.G, phases.rates, phases.impulse)[0])

    def kinetic(self, u: Array) -> float:
        """J."""
        return 0.5 * float(u @ (self.mass * u))

    def modes(self, u: Array, h: Array, speed_zero: float) -> tuple[bool, NDArray[np.int8]]:
        """Solved?, and mode by contact, of the contacts that take part under the forces h; constant directions."""
        mode, grip = np.full(self.m, OPEN, np.int8), np.zeros(self.n, np.int8)
        for row, i in enumerate(self.taken):
            self.closed.kin[row].gN_dot, self.closed.kin[row].gT_dot = self.W[2 * i : 2 * i + 2] @ u
        self.work.system.h[:] = h
        solved = decide_modes(self.model, self.closed, len(self.taken), 0, speed_zero, self.work, grip, mode)
        return bool(solved), mode

    def forces(self, h: Array, mode: NDArray[np.int8]) -> Array:
        """Forces N, T, N, T, ... of the contacts that take part in their modes under the forces h."""
        self.work.system.inverse[:], self.work.system.h[:] = 1.0 / self.mass, h
        solve_mode(self.model, self.closed, len(self.taken), np.asarray(mode, np.int8), 1.0, self.work)
        return self.work.system.force[: 2 * len(self.taken)].copy()


Problem = tuple[Array, Array]
FEW, MANY = 2000, 100_000  # problems of each kind: at every `verify`, and with --slow
LARGEST = 5  # unknowns of a complementarity problem: all its bases are tried where no solution is found
ZERO = 1e-9  # of the oracle: violations and determinants below count as zero


def random_rows(count: int) -> list[Row]:
    """Impacts of one contact and complementarity problems of four families, the given number of each."""
    return [*impact_rows(count), *lcp_rows(count)]


def impact_rows(count: int) -> list[Row]:
    """One contact with friction on three coordinates: velocities and impulses against the closed form."""
    rng = np.random.default_rng(210)
    worst, unsolved = 0.0, 0
    for _ in range(count):
        W, mass = rng.normal(size=(2, 3)), 10.0 ** rng.uniform(-1.0, 1.0, 3)
        mu, restitution, u = rng.uniform(0.0, 0.8), rng.uniform(), rng.normal(size=3)
        G, rates = W / mass @ W.T, W @ u
        if rates[0] >= 0.0 or mu * abs(G[0, 1]) >= 0.99 * G[0, 0]:
            continue  # nothing to do, or near jamming, where the answer is as large as one likes
        case = BareContacts(mass, W, np.array([mu]), np.array([restitution]))
        solved, after, force = case.impact(u)
        unsolved += not solved
        truth = single_impact(G, rates, mu, restitution)
        wanted = u + W.T @ truth / mass
        # Where the approach is the small difference of large terms, their rounding sets the scale of the impulse.
        scale = max(np.abs(truth).max(), np.abs(W[0]) @ np.abs(u) / G[0, 0])
        worst = max(
            worst, float(np.abs(force - truth).max() / scale), float(np.abs(after - wanted).max() / np.abs(wanted).max())
        )
    name, source = f"impact of one contact, {count} at random", "closed form: compression sticks or slips, friction clipped"
    return [
        compared(name, "left unsolved", 0.0, float(unsolved), 0.0, source),
        compared(name, "largest relative error of velocity or impulse", 0.0, worst, 1e-12, source),
    ]


def single_impact(G: Array, rates: Array, mu: float, restitution: float) -> Array:
    """Impulses (normal, tangential) of Poisson's law with Coulomb friction; G (2, 2) and the rates before are N, T."""
    Lam = -np.linalg.solve(G, rates)
    if abs(Lam[1]) > mu * Lam[0]:
        for s in (1.0, -1.0):
            normal = -rates[0] / (G[0, 0] - s * mu * G[0, 1])
            Lam = np.array([normal, -s * mu * normal])
            if s * (rates[1] + G[1] @ Lam) >= 0.0:
                break
    more = restitution * Lam[0]
    slip = rates[1] + G[1] @ Lam + G[1, 0] * more
    return Lam + np.array([more, np.clip(-slip / G[1, 1], -mu * more, mu * more)])


def anything(rng: np.random.Generator, n: int) -> Problem:
    """No structure: none, one or many solutions."""
    return rng.normal(size=(n, n)), rng.normal(size=n)


def degenerate(rng: np.random.Generator, n: int) -> Problem:
    """Small integers, many of them zero: ties everywhere, singular blocks."""
    return rng.integers(-1, 2, size=(n, n)).astype(float), rng.integers(-1, 2, size=n).astype(float)


def badly_scaled(rng: np.random.Generator, n: int) -> Problem:
    """One solution, coefficients from 1e-12 to 1e12: between a wheel and a balance."""
    M, K, unit = rng.normal(size=(n, n)), rng.normal(size=(n, n)), 10.0 ** rng.uniform(-6.0, 6.0, n)
    return (M @ M.T + 0.1 * np.eye(n) + K - K.T) * np.outer(unit, unit), rng.normal(size=n) * unit


def infeasible(rng: np.random.Generator, n: int) -> Problem:
    """One row that nothing can make positive."""
    A, b = anything(rng, n)
    i = rng.integers(n)
    A[i], b[i] = -np.abs(A[i]), -abs(b[i])
    return A, b


def lcp_rows(count: int) -> list[Row]:
    """Claimed solutions that are none, and problems given up that have one, by family."""
    families: tuple[Callable[[np.random.Generator, int], Problem], ...] = (anything, degenerate, badly_scaled, infeasible)
    rows = []
    for family in families:
        rng, work = np.random.default_rng(1996), lcp_work(LARGEST)
        wrong, missed, given_up = 0, 0, 0
        for _ in range(count):
            n = int(rng.integers(1, LARGEST + 1))
            A, b = family(rng, n)
            x = np.zeros(n)
            if solve_lcp(A, b, n, work, x) == LcpOutcome.SOLVED:
                wrong += not is_solution(A, b, x)
            else:
                given_up += 1
                missed += has_solution(A, b)
        name = f"complementarity problems, {count}, {family.__name__.replace('_', ' ')}"
        source = "conditions evaluated with numpy; all bases tried one by one where none was found"
        rows.append(compared(name, "claimed solutions that are none", 0.0, float(wrong), 0.0, source))
        rows.append(compared(name, f"of {given_up} given up, those with a solution", 0.0, float(missed), 0.0, source))
    return rows


def scales(A: Array) -> Array:
    """(n,) powers of two that make the rows and columns of a badly scaled matrix of order one: x = scale x'."""
    diagonal = np.abs(np.diag(A))
    if np.any(diagonal == 0.0) or diagonal.max() < 1e3 * diagonal.min():
        return np.ones(len(A))
    return np.array([2.0 ** -round(0.5 * math.log2(value)) for value in diagonal])


def is_solution(A: Array, b: Array, x: Array) -> bool:
    """True if x, A x + b >= 0 and one of each pair is zero, to ZERO of the largest terms of each row."""
    s = scales(A)
    A, b, x = A * np.outer(s, s), b * s, x / s
    terms = np.abs(A) @ np.abs(x) + np.abs(b)
    violation = np.abs(np.minimum(x, A @ x + b))
    return bool(np.all(np.isfinite(x)) and np.all(violation <= ZERO * np.maximum(1.0, terms.max(initial=0.0))))


def has_solution(A: Array, b: Array) -> bool:
    """True if one of the regular complementary bases gives a solution."""
    n = len(b)
    for chosen in itertools.product((False, True), repeat=n):
        active = np.array(chosen, dtype=bool)
        block = A[np.ix_(active, active)]
        if active.any() and abs(np.linalg.det(block)) < ZERO:
            continue
        x = np.zeros(n)
        if active.any():
            x[active] = np.linalg.solve(block, -b[active])
        if is_solution(A, b, x):
            return True
    return False
