"""Does a fixed step with contacts, dry bearings, drives and springs obey its laws, and do the books of its energy close?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from naive.lcp_oracle import solutions
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.model.records import JOINT, records
from watchsim.simulation.moreau import one_step
from watchsim.simulation.moreau.percussion_laws import laws

STEP, M, N = 0.1, 2, 6
DRIVEN, DRY = 2, (4, 1)
ARMS = np.array([0.3, -0.7, 0.5, 0.0, 0.2, -0.4])  # of a line spring whose length is linear in the coordinates
LINE_STIFFNESS, LINE_DAMPING, LINE_LENGTH = 3.0, 0.4, 0.6
GAP_CLOSE = 1e-3
SUMS = ("drive", "damping", "correction", "friction")


class Step:
    """One step from q and u; `push` presses the contacts together."""

    def __init__(self, seed: int, push: float = 2.0, *, lines: int = 1, m: int = M, dry: tuple[int, ...] = DRY) -> None:
        self.m, self.dry = m, list(dry)
        rng = np.random.default_rng(seed)
        self.case = case = Sparse(rng, M, N, friction=0.25, slots=(4, 6))
        c = case.model.coordinates
        for name in ("stiffness", "viscous", "quadratic", "rest", "force"):
            c[name][:] = rng.uniform(0.2, 2.0, N)
        c.coulomb[list(DRY)], c.driven[DRIVEN] = rng.uniform(0.2, 0.6, 2), 1
        for name, value in (("mass", 1.0), ("stiffness", 0.0), ("viscous", 0.0), ("quadratic", 0.0)):
            c[name][DRIVEN] = value  # its force is an acceleration
        joints = records(JOINT, 2)
        joints.coordinate, joints.on = [0, 5], [3, DRIVEN]
        for name in ("stiffness", "viscous", "quadratic", "rest", "force"):
            joints[name][:] = rng.uniform(0.2, 2.0, 2)
        self.joints = joints
        model = SimpleNamespace(**vars(case.model), joints=joints, tables=[], lines=[None] * lines)
        self.q, self.u, self.a = rng.normal(size=(3, N))
        self.u[DRY[1]] = 0.0
        c.force += push * (case.W[0] + case.W[2]) * -1.0
        c.force[DRIVEN] = 0.8
        case.closed.kin.g[:M] = -0.02, 0.2e-3
        sums = SimpleNamespace(**dict.fromkeys(SUMS, 0.0))
        counts = SimpleNamespace(lcp=0, lcp_sizes=[0] * 6, lcp_failures=0)
        self.state = SimpleNamespace(
            clock=SimpleNamespace(time=0.0), q=self.q.copy(), a=self.a.copy(), sums=sums, counts=counts,
            mode=np.zeros(2 * M, int), worst=SimpleNamespace(penetration=0.0),
        )  # fmt: skip
        names = ("force", "damping", "mass", "inverse", "free", "foreseen", "wound", "line", "change")
        self.work = SimpleNamespace(
            q=self.q + 0.5 * STEP * self.u, u=self.u, start=self.q.copy(), joint=np.zeros(2), dry=self.dry, closed=case.closed,
            laws=laws(m, len(dry)), memory=np.zeros((2 * M, 2)), kept=SimpleNamespace(depth=0.0, sweeps=0, violation=0.0),
            rates=np.full(2 * m + len(dry), np.nan), **{name: np.full(N, np.nan) for name in names},
        )  # fmt: skip
        self.after = np.full(N, np.nan)
        instead = {
            "add_line_springs": add_line_springs,
            "line_spring_energy": lambda model, q: line_energy(q) if lines else 0.0,
            "line_spring_damping": lambda model, q, u: LINE_DAMPING * float(ARMS @ u) ** 2,
            "line_spring_drive": lambda model, q, u: pull(q, u) * ARMS[DRIVEN] * u[DRIVEN],
        }
        in_python(one_step.act, **instead)(model, self.state, m, STEP, self.work, self.after)
        self.P = self.work.laws.P.copy()
        in_python(one_step.move, **instead)(
            model, self.state, SimpleNamespace(gap_close=GAP_CLOSE), m, STEP, self.work, self.after
        )

    def energy(self, q: np.ndarray, u: np.ndarray) -> float:
        c, j = self.case.model.coordinates, self.joints
        own = 0.5 * (c.mass * u**2 + c.stiffness * (q - c.rest) ** 2)
        own[DRIVEN] = 0.0
        return float(own.sum() + 0.5 * j.stiffness @ (q[j.coordinate] - q[j.on] - j.rest) ** 2) + line_energy(q)


def pull(q: np.ndarray, u: np.ndarray) -> float:
    return float(LINE_STIFFNESS * (ARMS @ q - LINE_LENGTH) + LINE_DAMPING * (ARMS @ u))


def line_energy(q: np.ndarray) -> float:
    return 0.5 * LINE_STIFFNESS * float(ARMS @ q - LINE_LENGTH) ** 2


def add_line_springs(model: object, q: np.ndarray, u: np.ndarray, out: np.ndarray) -> None:
    for i in range(N):
        out[i] -= 0.0 if i == DRIVEN else pull(q, u) * ARMS[i]


TAKING_PART = pytest.mark.parametrize(("m", "dry"), [(M, DRY), (0, DRY), (M, ()), (1, (4,)), (0, ())])


@TAKING_PART
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("push", [2.0, -2.0])
def test_energy_gained_is_work_less_losses(seed: int, push: float, m: int, dry: tuple[int, ...]) -> None:
    step = Step(seed, push, m=m, dry=dry)
    gained = step.energy(step.state.q, step.after) - step.energy(step.q, step.u)
    drive, damping, correction, friction = (getattr(step.state.sums, name) for name in SUMS)
    assert drive - damping - correction - friction == pytest.approx(gained, rel=1e-9)


@TAKING_PART
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("push", [2.0, -2.0, 0.3])
def test_percussions_obey_the_laws_at_the_end_of_the_step(seed: int, push: float, m: int, dry: tuple[int, ...]) -> None:
    """Signorini's and Coulomb's, and those of dry bearings; each moves the velocities by the mobility in the step."""
    step = Step(seed, push, m=m, dry=dry)
    case, P, after = step.case, step.P, step.after
    directions = np.vstack([case.W[: 2 * m], np.eye(N)[step.dry]])
    assert after == pytest.approx(step.work.free + step.work.inverse * (directions.T @ P))
    rates, near = directions @ after, 1e-10
    for i in range(m):
        N_i, T_i, gap, slip = P[2 * i], P[2 * i + 1], rates[2 * i], rates[2 * i + 1]
        most = case.friction[i] * N_i
        assert N_i >= 0.0 and gap > -near and (N_i < near or abs(gap) < near)
        assert abs(T_i) <= most + near and (abs(slip) < near or T_i == pytest.approx(-np.sign(slip) * most, abs=near))
    for k, j in enumerate(dry):
        most, speed = STEP * case.model.coordinates[j].coulomb, after[j]
        assert abs(P[2 * m + k]) <= most * (1.0 + 1e-12)
        assert abs(speed) < near or P[2 * m + k] == pytest.approx(-np.sign(speed) * most, abs=near)
    spent = [-0.5 * P[r] * (directions[r] @ (step.u + after)) for r in range(2 * m + len(dry))]
    assert step.state.sums.friction == pytest.approx(sum(spent[1 : 2 * m : 2]), abs=1e-12)
    if len(P):
        place = {1: 0, 2: 1, 3: 2, 4: 2}.get(len(P), 3)
        assert (step.state.counts.lcp, step.state.counts.lcp_sizes) == (1, [int(i == place) for i in range(6)])
    assert step.work.memory[case.closed.ids[:m]].ravel() == pytest.approx(P[: 2 * m])


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("lines", [0, 1])
def test_what_acts_between_two_coordinates_is_taken_at_the_middle_that_the_last_step_foresees(seed: int, lines: int) -> None:
    """Springs of one coordinate alone by the midpoint rule, in full."""
    step = Step(seed, lines=lines)
    c, j, h = step.case.model.coordinates, step.joints, STEP
    u, middle, foreseen = step.u, step.q + 0.5 * h * step.u, step.u + 0.5 * h * step.a
    force = c.force.copy()
    np.add.at(force, j.coordinate, j.force)
    np.subtract.at(force, j.on, np.where(j.on == DRIVEN, 0.0, j.force))
    damping = c.viscous + c.quadratic * np.abs(u)
    matrix = c.mass / h + 0.25 * h * c.stiffness + 0.5 * damping
    free = (c.mass / h * u + force - c.stiffness * (step.q + 0.25 * h * u - c.rest) - 0.5 * damping * u) / matrix
    inverse = 1.0 / (h * matrix)
    inverse[DRIVEN] = 0.0
    speed = foreseen[j.coordinate] - foreseen[j.on]
    torque = -(j.viscous + j.quadratic * np.abs(speed)) * speed
    torque -= j.stiffness * (middle[j.coordinate] - middle[j.on] - j.rest)
    np.add.at(free, j.coordinate, h * torque * inverse[j.coordinate])
    np.subtract.at(free, j.on, h * torque * inverse[j.on])
    if lines:
        free -= h * pull(middle, foreseen) * ARMS * inverse
    assert step.work.free == pytest.approx(free)
    assert step.work.inverse == pytest.approx(inverse)


@pytest.mark.parametrize("seed", range(4))
def test_a_fifth_of_a_penetration_is_taken_back_by_the_mobility_of_the_step(seed: int) -> None:
    """The other contact, which is not deep, gives way as little as it may; of its own push each yields a thousandth."""
    step = Step(seed)
    moved = step.state.q - (step.q + 0.5 * STEP * (step.u + step.after))
    normal = step.case.W[::2]
    G = normal * step.work.inverse @ normal.T
    push = solutions(G * (1.0 + 1e-3 * np.eye(M)), np.array([-0.2 * (0.02 - 0.5 * GAP_CLOSE), 0.0]), 1e-14)[0]
    assert moved == pytest.approx(step.work.inverse * (normal.T @ push), rel=1e-9, abs=1e-14)
    assert step.state.worst.penetration == step.work.kept.depth == 0.02
    assert step.state.a == pytest.approx((step.after - step.u) / STEP)
