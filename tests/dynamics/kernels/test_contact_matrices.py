"""Are the sums over the coordinates of each contact those of whole matrices?"""

from __future__ import annotations

import numpy as np
import pytest
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.dynamics import acceleration, bearing_friction, delassus
from watchsim.dynamics.problem_kinds import Level

SEEDS = pytest.mark.parametrize("seed", range(5))


def made(seed: int) -> tuple[Sparse, np.random.Generator]:
    """One to four contacts on six coordinates, of which the third is driven."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, 1 + seed % 4, 6)
    case.model.coordinates.driven[2] = 1
    case.work.inverse[2] = 0.0
    return case, rng


@SEEDS
def test_impulses_change_rates_by_the_matrix_of_delassus(seed: int) -> None:
    case, _ = made(seed)
    work, rows = case.work, 2 * case.m
    work.G[:] = np.nan
    in_python(delassus.fill_delassus)(case.closed, case.m, work)
    assert work.G[:rows, :rows] == pytest.approx(case.G)
    assert np.isnan(work.G[rows:]).all() and np.isnan(work.G[:, rows:]).all()


@SEEDS
def test_bearings_have_rows_of_their_own_behind_those_of_contacts(seed: int) -> None:
    case, rng = made(seed)
    work, m = case.work, case.m
    dry = rng.permutation(6)[:2]
    work.dry[:2] = dry
    work.G[: 2 * m, : 2 * m], work.G[2 * m :], work.G[:, 2 * m :] = case.G, np.nan, np.nan
    in_python(delassus.fill_bearings)(case.closed, m, 2, work)
    both = np.vstack([case.W, np.eye(6)[dry]])
    assert work.G[: 2 * m + 2, : 2 * m + 2] == pytest.approx(both * work.inverse @ both.T)
    assert np.isnan(work.G[2 * m + 2 :]).all() and np.isnan(work.G[:, 2 * m + 2 :]).all()


@SEEDS
def test_forces_accelerate_by_inverse_masses_and_prescribed_motions_by_themselves(seed: int) -> None:
    case, rng = made(seed)
    work, m = case.work, case.m
    work.force[: 2 * m] = rng.normal(size=2 * m)
    free = work.h * work.inverse
    free[2] = work.h[2]
    a = np.full(6, np.nan)
    in_python(acceleration.accelerate)(case.model, case.closed, m, work, a)
    assert a == pytest.approx(free + work.inverse * (case.W.T @ work.force[: 2 * m]))
    b, size = np.full(2 * m, np.nan), np.full(2 * m, np.nan)
    in_python(acceleration.gap_accelerations)(case.model, case.closed, m, work, b, size)
    assert b == pytest.approx(case.bars + case.W @ free)
    terms = np.abs(free) + case.model.coordinates.load * work.inverse
    assert size == pytest.approx(np.repeat(case.closed.kin.bar_size[:m], 2) + np.abs(case.W) @ terms)


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
    in_python(delassus.apply)(case.closed, case.m, force, case.work.inverse, change)
    assert change == pytest.approx(1.0 + case.work.inverse * (case.W.T @ force))


def test_what_is_driven_or_held_moves_by_no_force() -> None:
    case, _ = made(3)
    inverse, grips = np.full(6, np.nan), np.array([OPEN, STICK, OPEN, FORWARD, STICK, BACKWARD])
    in_python(delassus.fill_inverse)(case.model, grips, inverse)
    mass = case.model.coordinates.mass
    assert inverse == pytest.approx([1.0 / mass[0], 0.0, 0.0, 1.0 / mass[3], 0.0, 1.0 / mass[5]])


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
    in_python(bearing_friction.add_drag)(case.model, grips, h)
    assert h == pytest.approx(3.0 - moving * dry)
    assert in_python(bearing_friction.drag_power)(case.model, grips, u) == pytest.approx(moving * dry @ u)


def test_after_a_decision_nothing_moves_against_its_grip() -> None:
    """Only in the island that was decided about."""
    grips = np.array([STICK, FORWARD, FORWARD, BACKWARD, BACKWARD, OPEN, STICK, FORWARD])
    u = np.array([0.5, 6e-6, -7e-6, 8e-6, -9e-6, -1.0, 1.1, -1.2])
    in_python(bearing_friction.stop_held)(np.array([4, 4, 4, 4, 4, 4, 3, 5]), 4, grips, u)
    assert u.tolist() == [0.0, 6e-6, 0.0, 0.0, -9e-6, -1.0, 1.1, -1.2]


@pytest.mark.parametrize(
    ("unknowns", "place"), [(1, 0), (2, 1), (3, 2), (4, 2), (5, 3), (8, 3), (9, 4), (16, 4), (17, 5), (99, 5)]
)
def test_problems_are_counted_by_their_size(unknowns: int, place: int) -> None:
    assert in_python(delassus.size_class)(unknowns) == place
    assert len(delassus.contact_work(1, 1).sizes) == 6


def test_a_problem_says_what_it_is_about() -> None:
    work = delassus.contact_work(1, 1)
    in_python(delassus.note_posed)(work, 5, 4, 3, Level.COMPRESSION)
    posed = work.posed
    assert (posed.contacts, posed.elements, posed.bearings, posed.level) == (5, 4, 3, Level.COMPRESSION)


@pytest.mark.parametrize(("room", "coordinates"), [(1, 1), (3, 4), (5, 2)])
def test_there_is_room_for_the_largest_problem(room: int, coordinates: int) -> None:
    """The copositive form: a normal force for each contact and three unknowns for each contact and each bearing."""
    work = delassus.contact_work(room, coordinates)
    rows, blocks, side = 2 * room + coordinates, room + coordinates, room + 3 * (room + coordinates)
    for name in ("b", "size", "force", "more", "rates", "loaded", "correction", "hand"):
        assert getattr(work, name).shape == (rows,)
    for name in ("unit", "block", "width", "span", "shift"):
        assert getattr(work, name).shape == (blocks,)
    for name in ("worth", "offset", "drag", "tangent"):
        assert getattr(work, name).shape == (room,)
    for name in ("inverse", "dry", "h"):
        assert getattr(work, name).shape == (coordinates,)
    for name in ("rhs", "x", "other_rhs", "other_x", "weight", "dual", "scale", "order", "row"):
        assert getattr(work, name).shape == (side,)
    for name in ("A", "B", "free"):
        assert getattr(work, name).shape == (side, side)
    assert work.G.shape == (rows, rows) and work.lcp.matrix.shape == (side, side)
    assert work.hand.tolist() == [1.0] * rows
