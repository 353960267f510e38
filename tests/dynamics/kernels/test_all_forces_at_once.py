"""Are forces, powers and energies those of the words of the model, with everything in it at once?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.dynamics import applied_forces, equations_of_motion
from watchsim.model.records import COORDINATE, JOINT, OVER_ANGLE, OVER_TIME, REPEATED, TABLE, records

N, DRIVEN, T = 5, 3, 1.7
ARMS, STIFFNESS, LENGTH, VISCOUS = np.array([0.3, -0.7, 0.5, 0.9, 0.2]), 3.0, 0.6, 0.4  # of a line spring, linear in q
KNOTS = np.array([[0.5, 0.3], [1.1, -0.4], [2.3, 0.9], [3.4, 0.3]])


def pull(q: np.ndarray, u: np.ndarray) -> float:
    return float(STIFFNESS * (ARMS @ q - LENGTH) + VISCOUS * (ARMS @ u))


def add_line_springs(model: object, q: np.ndarray, u: np.ndarray, out: np.ndarray) -> None:
    out -= pull(q, u) * ARMS * (np.arange(N) != DRIVEN)


INSTEAD = {
    "add_line_springs": add_line_springs,
    "line_spring_energy": lambda model, q: 0.5 * STIFFNESS * float(ARMS @ q - LENGTH) ** 2,
    "line_spring_damping": lambda model, q, u: VISCOUS * float(ARMS @ u) ** 2,
    "line_spring_drive": lambda model, q, u: pull(q, u) * ARMS[DRIVEN] * u[DRIVEN],
}
FORCES, DRIVE, DAMPING, STORED = (
    in_python(getattr(applied_forces, name), **INSTEAD) for name in ("forces", "drive_power", "damping_power", "stored_energy")
)


def model(rng: np.random.Generator) -> SimpleNamespace:
    """Sprung, damped and weighted coordinates, one of them driven; joints and tables that act back on others, driven or not."""
    c, joints, tables = records(COORDINATE, N), records(JOINT, 2), records(TABLE, 4)
    for name in ("mass", "force", "viscous", "quadratic", "stiffness", "rest", "weight_x", "weight_y"):
        c[name][:] = rng.uniform(0.2, 2.0, N)
    c.driven[DRIVEN], c.mass[DRIVEN] = 1, 1.0
    for name in ("viscous", "quadratic", "stiffness", "weight_x", "weight_y"):
        c[name][DRIVEN] = 0.0
    c.weight_x[0], c.weight_y[1] = 0.0, 0.0
    joints.coordinate, joints.on = [0, 2], [1, DRIVEN]
    for name in ("force", "viscous", "quadratic", "stiffness", "rest"):
        joints[name][:] = rng.uniform(0.2, 2.0, 2)
    tables.coordinate, tables.on = [4, 1, 2, 0], [-1, 0, DRIVEN, -1]
    tables.over, tables.start, tables.count = [OVER_TIME, OVER_ANGLE, REPEATED, OVER_ANGLE], 1, 4
    return SimpleNamespace(
        coordinates=c, joints=joints, tables=tables, lines=[], knots=np.vstack([[9.0, 9.0], KNOTS, [7.0, 7.0]])
    )


def told(made: SimpleNamespace, j: int, q: np.ndarray) -> float:
    table = made.tables[j]
    at = {OVER_TIME: T, REPEATED: 0.5 + (T - 0.5) % 2.9}.get(int(table.over))
    if at is None:
        at = q[table.coordinate] - (q[table.on] if table.on >= 0 else 0.0)
    return float(np.interp(at, KNOTS[:, 0], KNOTS[:, 1]))


@pytest.mark.parametrize("seed", range(8))
def test_every_coordinate_feels_what_acts_on_it_and_back_on_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made, q, u = model(rng), 2.0 * rng.normal(size=N), rng.normal(size=N)
    c, j, out = made.coordinates, made.joints, np.full(N, np.nan)
    FORCES(made, T, q, u, out)
    expected = c.force + np.cos(q) * c.weight_y - np.sin(q) * c.weight_x - c.stiffness * (q - c.rest)
    expected -= c.viscous * u + c.quadratic * u * np.abs(u)
    speed = u[j.coordinate] - u[j.on]
    torque = (
        j.force - j.stiffness * (q[j.coordinate] - q[j.on] - j.rest) - j.viscous * speed - j.quadratic * speed * np.abs(speed)
    )
    acts = [*zip(j.coordinate, j.on, torque, strict=True)]
    acts += [(table.coordinate, table.on, told(made, k, q)) for k, table in enumerate(made.tables)]
    for on_one, on_other, force in acts:
        expected[on_one] += force
        if on_other not in (-1, DRIVEN):
            expected[on_other] -= force
    expected -= pull(q, u) * ARMS * (np.arange(N) != DRIVEN)
    assert out == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(8))
def test_power_put_in_less_what_damping_takes_is_what_the_stored_energy_gains(seed: int) -> None:
    """Where free coordinates move as forces make them; by central quotients."""
    rng = np.random.default_rng(seed)
    made, q, u, out, h = model(rng), rng.normal(size=N), rng.normal(size=N), np.zeros(N), 1e-5
    FORCES(made, T, q, u, out)
    a = out / made.coordinates.mass
    after, before = (STORED(made, q + s * u + 0.5 * s * s * a, u + s * a) for s in (h, -h))
    assert DRIVE(made, T, q, u) - DAMPING(made, q, u) == pytest.approx((after - before) / (2.0 * h), rel=1e-7)
    assert DAMPING(made, q, u) > VISCOUS * float(ARMS @ u) ** 2


def test_stored_is_kinetic_energy_and_that_of_springs() -> None:
    rng = np.random.default_rng(3)
    made, q, u = model(rng), rng.normal(size=N), rng.normal(size=N)
    c, j, free = made.coordinates, made.joints, np.arange(N) != DRIVEN
    expected = 0.5 * (c.mass * u**2 + c.stiffness * (q - c.rest) ** 2)[free].sum() + 0.5 * STIFFNESS * (ARMS @ q - LENGTH) ** 2
    expected += 0.5 * (j.stiffness * (q[j.coordinate] - q[j.on] - j.rest) ** 2).sum()
    assert STORED(made, q, u) == pytest.approx(expected)


def test_at_each_instant_there_are_kinematics_and_normals_row_by_row_and_all_other_forces() -> None:
    """Of contacts 2 and 0, which are of primitives (4, 1) and (3, 2). Contact k has coordinates 0, k and 0 again."""
    contacts = [SimpleNamespace(a=3, b=2), None, SimpleNamespace(a=4, b=1)]
    made = SimpleNamespace(contacts=contacts, primitives=[SimpleNamespace(body=k) for k in range(5)])
    t, q, u = np.array([T, 2.0 * T]), np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]), np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    pose, closed, seen = np.zeros(5), closed_contacts(1), equations_of_motion.room(2, 2, 3)

    def contact_kinematics(model: object, k: int, pose: np.ndarray, row: int, out: Closed) -> None:
        out.slots[row], out.coord[row, :3] = 3, [0, k, 0]
        out.w_N[row, :3], out.w_T[row, :3] = (pose[k], 10.0, 5.0), (-pose[k], 20.0, 7.0)
        kin = out.kin[row]
        kin.bar_N, kin.bar_T, kin.x, kin.y = pose[k] + np.array([1.0, 2.0, 3.0, 4.0])

    instead = {
        "place": lambda model, q, u, out: np.copyto(out, np.arange(5.0) + q[1] + 100.0 * u[2]),
        "contact_kinematics": contact_kinematics,
        "shape_of_contact": lambda contact, a, b, pa, pb: SimpleNamespace(nx=pa - pb, ny=pa + a.body),
        "forces": lambda model, t, q, u, out: np.copyto(out, t + q + 10.0 * u),
    }
    in_python(equations_of_motion.balance, **instead)(made, t, q, u, [2, 0], pose, closed, seen)
    assert seen.h == pytest.approx(t[:, None] + q + 10.0 * u)
    for i, place in enumerate(q[:, 1] + 100.0 * u[:, 2]):
        two, none = 2.0 + place, place
        assert seen.w_N[i] == pytest.approx(np.array([[two + 5.0, 0.0, 10.0], [none + 15.0, 0.0, 0.0]]))
        assert seen.w_T[i] == pytest.approx(np.array([[7.0 - two, 0.0, 20.0], [27.0 - none, 0.0, 0.0]]))
        assert seen.bar[i] == pytest.approx(np.array([[two + 1.0, none + 1.0], [two + 2.0, none + 2.0]]))
        assert seen.point[i] == pytest.approx(np.array([[two + 3.0, two + 4.0], [none + 3.0, none + 4.0]]))
        assert seen.normal[i] == pytest.approx(np.array([[3.0, 8.0 + place], [1.0, 6.0 + place]]))


@pytest.mark.parametrize("count", [2, 3, 4])
def test_tables_are_straight_between_knots_and_end_with_their_last_values(count: int) -> None:
    ask = in_python(applied_forces.table_value)
    made, table = model(np.random.default_rng(0)), SimpleNamespace(start=1, count=count)
    for x in (-math.inf, 0.499, 0.5, 0.7, 1.1, 1.6, 2.3, 2.9, 3.4, 3.5, math.inf):
        assert ask(made, table, x) == pytest.approx(float(np.interp(x, KNOTS[:count, 0], KNOTS[:count, 1])))
