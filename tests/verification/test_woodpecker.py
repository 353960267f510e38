"""Does the woodpecker toy come out?"""

from __future__ import annotations

import numpy as np
import pytest
from benchmark_names import PUBLISHED

from watchsim.contact.index_sets import BACKWARD, OPEN
from watchsim.verification.woodpecker.exact_motion import moments, phase_of
from watchsim.verification.woodpecker.toy import LOWER, UPPER, Toy, modal, start
from watchsim.verification.woodpecker.woodpecker_cycle import breaks_loose, find_cycle
from watchsim.verification.woodpecker.woodpecker_rows import STEPS, woodpecker_rows

STICKS = (10.496956, 30.073403, 49.633109)  # mm down the page: where the sleeve's lower edge sticks in the animation


def by_hand(toy: Toy, tilt: float, h: float, until: float) -> np.ndarray:
    """Coordinates (steps, 3) by the published scheme: contacts closed half-way, Newton's law, Gauss-Seidel."""
    inverse, W, mu, eps = np.linalg.inv(toy.mass), toy.directions, toy.friction, toy.restitution
    spring = toy.stiffness * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1]])
    q, u, passed = np.array([0.0, tilt, -0.2788]), np.array([-0.3411, 0.0, -7.4583]), []
    for _ in range(round(until / h)):
        middle, P, before = q + 0.5 * h * u, np.zeros(6), np.ones(6)
        closed = [k for k in range(3) if toy.gaps[k] + W[2 * k] @ middle <= 0.0]
        free = u + inverse @ (toy.load - spring @ middle) * h
        while closed and np.abs(P - before).max() > 1e-13:
            before = P.copy()
            for k in closed:
                for row in (2 * k, 2 * k + 1):
                    rate = W[row] @ (free + inverse @ (W.T @ P)) + (eps[k] * (W[row] @ u) if row == 2 * k else 0.0)
                    P[row] -= rate / (W[row] @ inverse @ W[row])
                    P[row] = max(P[row], 0.0) if row == 2 * k else np.clip(P[row], -mu * P[2 * k], mu * P[2 * k])
        new = free + inverse @ (W.T @ P)
        q, u = q + 0.5 * h * (u + new), new
        passed.append(q)
    return np.array(passed)


@pytest.mark.slow
def test_the_published_animation_is_understood() -> None:
    """Its scheme, written down again, sticks where the animation does, within what its relaxation leaves."""
    toy = Toy()
    y, tilt, _ = by_hand(toy, -0.1036, 1e-4, 0.34)[[400, 1860, 3340]].T
    edge = y + toy.sleeve_radius * np.sin(tilt) - toy.sleeve_half_height * np.cos(tilt)
    assert -1e3 * edge == pytest.approx(STICKS, abs=1e-4)


@pytest.mark.slow
def test_the_published_scheme_comes_to_the_same_with_small_steps() -> None:
    """Nothing but the data of the toy is shared with it."""
    toy = Toy()
    model = modal(toy)
    q, u = start(toy, model)
    exact = list(moments(model, q, u, 0.187))[-1].q[0]
    errors = [abs(by_hand(toy, float((model.basis @ q)[1]), h, 0.187)[-1, 0] - exact) for h in (1e-4, 1e-5, 2e-6)]
    assert errors[1] < 1e-4 and errors[2] < 1e-5 and errors[2] < 0.1 * errors[0]


@pytest.mark.parametrize("steps", [(5e-5,), pytest.param(STEPS, marks=pytest.mark.slow)], ids=["coarse", "as verified"])
def test_rows(steps: tuple[float, ...]) -> None:
    rows = woodpecker_rows(steps)
    assert not [row for row in rows if not row["ok"]]
    for row in rows:  # what is expected and allowed is what the page says, and so is how the published runs compare
        expected, got, allowed = PUBLISHED["Woodpecker toy"][row["quantity"]]
        if row["quantity"].startswith(("events", "height", "tilt of the bird")):
            assert row["got"] == pytest.approx(got, rel=1e-6, abs=0.0)
        assert row["expected"] == pytest.approx(expected, rel=1e-9, abs=0.0)
        assert float(f"{row['tolerance']:.0e}") == allowed


def test_modal_coordinates_are_the_toys() -> None:
    """Unit masses and one spring: the energies of q and of its modal coordinates are the same."""
    toy = Toy()
    model, rng = modal(toy), np.random.default_rng(3)
    e, v = rng.normal(size=3), rng.normal(size=3)
    q, u = model.basis @ e, model.basis @ v
    assert u @ toy.mass @ u == pytest.approx(v @ v, rel=1e-12, abs=0.0)
    assert toy.stiffness * (q[1] - q[2]) ** 2 == pytest.approx(e @ (model.spring * e), rel=1e-12)
    assert toy.load @ q == pytest.approx(model.load @ e, rel=1e-12)


def test_energy_only_falls() -> None:
    """From event to event the energy falls by what friction and impacts take; a free flight loses nothing."""
    toy = Toy()
    model = modal(toy)
    seen = list(moments(model, *start(toy, model), 0.3))

    def energy(q: np.ndarray, u: np.ndarray) -> float:
        return 0.5 * u @ toy.mass @ u + 0.5 * toy.stiffness * (q[1] - q[2]) ** 2 - toy.load @ q

    before = [energy(seen[k].q, seen[k].before) - energy(seen[k - 1].q, seen[k - 1].u) for k in range(1, len(seen))]
    jumps = [energy(one.q, one.u) - energy(one.q, one.before) for one in seen]
    assert max(before) < 1e-12
    assert max(jumps) < 1e-15
    free = [k for k in range(1, len(seen)) if seen[k - 1].mode == (OPEN, OPEN, OPEN)]
    assert len(free) > 5
    assert max(abs(before[k - 1]) for k in free) < 1e-13


def test_the_flow_of_a_mode_keeps_its_contact_closed() -> None:
    model = modal(Toy())
    phase = phase_of(model, np.array([OPEN, BACKWARD, OPEN]), [LOWER])
    N = model.contacts.W[2 * LOWER]
    assert np.abs(N @ phase.flow[3:6]).max() < 1e-9 * np.abs(phase.flow[3:6]).max() * np.abs(N).max()
    assert {contact for _, contact in phase.causes} == {0, LOWER, UPPER}


def test_without_friction_the_sleeve_falls() -> None:
    """It is friction that stops the sleeve: with none it falls and never sticks."""
    toy = Toy(friction=0.0)
    model = modal(toy)
    slipping = list(moments(model, *start(toy, model), 0.1))
    fall = -0.3411 * 0.1 - 0.5 * 9.81 * 0.1**2
    assert slipping[-1].q[0] < 0.5 * fall
    assert not any(2 in moment.mode for moment in slipping)


@pytest.mark.parametrize("pecks", [4, pytest.param(20, marks=pytest.mark.slow)])
def test_the_cycle_does_not_depend_on_where_it_is_looked_for(pecks: int) -> None:
    """Each peck takes away a sixth of the distance, as the slope of the map says."""
    cycle = find_cycle(Toy())
    assert cycle.period == pytest.approx(0.1459760651, abs=1e-9)
    assert cycle.slope == pytest.approx(-0.84, abs=0.01)
    model = modal(Toy())
    q, u = cycle.events[0].q, cycle.events[0].u * 1.005
    section = cycle.events[0].u[2]
    later = [one for one in moments(model, model.into(q), model.into(u), (pecks + 0.5) * cycle.period) if breaks_loose(one)]
    left = [abs(one.u[2] - section) / abs(u[2] - section) for one in later]
    assert left[pecks - 1] == pytest.approx(abs(cycle.slope) ** pecks, rel=0.05 * pecks**0.5)
