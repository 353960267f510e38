"""How far is time stepping from the woodpecker's cycle, and are the toy's coordinates those in which nothing couples?"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

from watchsim.verification.woodpecker import woodpecker_rows as module
from watchsim.verification.woodpecker.published import FASTEST
from watchsim.verification.woodpecker.toy import BEAK, LOWER, UPPER, Modal, Toy, modal, start
from watchsim.verification.woodpecker.toy_stepping import step_to
from watchsim.verification.woodpecker.woodpecker_cycle import Cycle
from watchsim.verification.woodpecker.woodpecker_rows import woodpecker_rows

TOYS = [Toy(), replace(Toy(), sleeve_mass=2e-3, stiffness=0.03, friction=0.55, restitution=(0.3, 0.2, 0.1))]


def moment(q: tuple[float, ...], rate: float) -> Any:
    return SimpleNamespace(q=np.array(q), u=np.array([0.3, -0.2, rate]))


EVENTS = [moment((0.0, -0.1, -0.3), 5.0), moment((-3e-3, 0.4, 0.7), 6.0), moment((-7e-3, -0.09, -0.33), 4.0)]
STEPPED = np.array([-9e-3, -0.095, -0.31])


@pytest.mark.parametrize("h", [4e-5, 3e-4])
def test_stepping_goes_from_the_first_event_of_a_cycle_to_its_last(monkeypatch: pytest.MonkeyPatch, h: float) -> None:
    """Tilts are compared, and may be off by what the fastest of them makes in a step."""
    toy = Toy()
    model = modal(toy)
    asked: list[Any] = []

    def stepped(made: Any, e: np.ndarray, v: np.ndarray, until: float, step: float) -> tuple[np.ndarray, np.ndarray]:
        asked.append((made.basis @ e, made.basis @ v, until, step))
        return model.into(STEPPED), np.full(3, 77.0)

    monkeypatch.setattr(module, "step_to", stepped)
    monkeypatch.setattr(module, "find_cycle", lambda toy: Cycle(EVENTS, 0.146, 7e-3, 2e-10, -1.25))
    monkeypatch.setattr(module, "published_rows", lambda toy, cycle: ["published"])
    closing, slope, published, row = woodpecker_rows((h,))
    q, u, until, step = asked[0]
    assert q == pytest.approx(EVENTS[0].q, abs=1e-15) and u == pytest.approx(EVENTS[0].u, rel=1e-12, abs=0.0)
    assert (until, step) == (0.146, h) and published == "published"
    assert row["got"] == pytest.approx(0.02, rel=1e-9) and row["expected"] == 0.0
    assert row["tolerance"] == FASTEST * h and FASTEST == 250.0
    assert f"steps of {h:g} s" in row["quantity"]
    assert (closing["got"], closing["expected"], closing["tolerance"]) == (2e-10, 0.0, 1e-9)
    assert (slope["got"], slope["expected"], slope["tolerance"]) == (pytest.approx(0.25), 0.0, 0.0)


@pytest.mark.parametrize(("slope", "beyond"), [(-0.75, 0.0), (0.9, 0.0), (1.5, 0.5), (-1.5, 0.5)])
def test_a_cycle_is_unstable_where_the_slope_is_beyond_one(
    monkeypatch: pytest.MonkeyPatch, slope: float, beyond: float
) -> None:
    monkeypatch.setattr(module, "find_cycle", lambda toy: Cycle(EVENTS, 0.146, 7e-3, 0.0, slope))
    monkeypatch.setattr(module, "published_rows", lambda toy, cycle: [])
    _, row = woodpecker_rows(())
    assert row["got"] == beyond and row["ok"] is (beyond == 0.0)


@pytest.mark.parametrize("toy", TOYS)
def test_masses_are_one_and_the_spring_acts_on_one_coordinate_alone(toy: Toy) -> None:
    """Its square frequency by scipy; the other two are exactly free."""
    model, k = modal(toy), toy.stiffness
    spring = np.array([[0.0, 0.0, 0.0], [0.0, k, -k], [0.0, -k, k]])
    assert model.basis.T @ toy.mass @ model.basis == pytest.approx(np.eye(3), abs=1e-12)
    assert model.spring[:2].tolist() == [0.0, 0.0]
    assert model.spring[2] == pytest.approx(eigh(spring, toy.mass, eigvals_only=True)[2], rel=1e-10)
    assert model.basis.T @ spring @ model.basis == pytest.approx(np.diag(model.spring), abs=1e-12 * model.spring[2])
    assert model.load == pytest.approx(model.basis.T @ toy.load, rel=1e-12)
    contacts = model.contacts
    assert pytest.approx(toy.directions @ model.basis, rel=1e-12) == contacts.W and contacts.mass.tolist() == [1.0] * 3
    assert contacts.friction.tolist() == [toy.friction] * 3 and tuple(contacts.restitution) == toy.restitution
    e = np.array([0.3, -0.7, 0.2])
    assert model.force(e) == pytest.approx(model.load - model.spring * e, rel=1e-12)
    assert model.into(model.basis @ e) == pytest.approx(e, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("toy", TOYS)
def test_the_start_of_the_papers(toy: Toy) -> None:
    """The lower edge touches the pole and slides down; the bird swings back."""
    model = modal(toy)
    e, v = start(toy, model)
    y, sleeve, bird = model.basis @ e
    assert y == pytest.approx(0.0, abs=1e-15) and bird == pytest.approx(-0.2788, rel=1e-12, abs=0.0)
    assert sleeve == pytest.approx(-(3.1e-3 - 2.5e-3) / 5.8e-3, rel=1e-12, abs=0.0)
    assert model.basis @ v == pytest.approx([-0.3411, 0.0, -7.4583], abs=1e-12)


def energy_of(toy: Toy, q: np.ndarray, u: np.ndarray) -> tuple[float, float]:
    """Kinetic and potential, from where masses are: the bird's at the end of two arms, one turns with each tilt."""
    m, s = toy.bird_mass, toy.sleeve_mass
    speed = u[0] + 0.010 * u[1] + 0.015 * u[2]
    kinetic = 0.5 * (s * u[0] ** 2 + toy.sleeve_inertia * u[1] ** 2 + m * speed**2 + toy.bird_inertia * u[2] ** 2)
    return kinetic, toy.gravity * (s * q[0] + m * (q[0] + 0.010 * q[1] + 0.015 * q[2]))


@pytest.mark.parametrize("toy", TOYS)
def test_masses_and_weights_are_those_of_its_parts(toy: Toy) -> None:
    rng = np.random.default_rng(5)
    for q, u in rng.normal(size=(5, 2, 3)):
        kinetic, potential = energy_of(toy, q, u)
        assert 0.5 * u @ toy.mass @ u == pytest.approx(kinetic, rel=1e-12, abs=0.0)
        assert -toy.load @ q == pytest.approx(potential, rel=1e-12, abs=0.0)


def test_data_of_the_toy() -> None:
    """As in Glocker and Studer 2005, in SI."""
    toy = Toy()
    printed = {
        **{"sleeve_mass": 0.0003, "sleeve_inertia": 5.0e-9, "bird_mass": 0.0045, "bird_inertia": 7.0e-7, "stiffness": 0.0056},
        **{"gravity": 9.81, "pole_radius": 0.0025, "sleeve_radius": 0.0031, "sleeve_half_height": 0.0058, "friction": 0.3},
        **{"sleeve_to_spring": 0.010, "spring_to_bird": 0.015, "beak_height": 0.020, "beak_length": 0.0201},
    }
    assert {name: getattr(toy, name) for name in printed} == printed and toy.restitution == (0.5, 0.0, 0.0)


def test_gaps_are_those_of_beak_and_edges() -> None:
    """Of the beak: arms of 10 and 15 mm less its length and the pole; it comes nearer as the bird tilts forwards."""
    toy = Toy()
    y, sleeve, bird = 0.03, -0.04, 0.07
    N, T = toy.directions[::2], toy.directions[1::2]
    gaps = toy.gaps + N @ (y, sleeve, bird)
    assert gaps == pytest.approx([0.025 - 0.0201 - 0.0025 - 0.02 * bird, 6e-4 + 5.8e-3 * sleeve, 6e-4 - 5.8e-3 * sleeve])
    slips = [y + 0.010 * sleeve + (0.015 - 0.0201) * bird, *[y + 3.1e-3 * sleeve] * 2]
    assert T @ (y, sleeve, bird) == pytest.approx(slips)


NEAR = ((BEAK, LOWER), (BEAK, UPPER))  # both edges of the sleeve at once would be on either side of the pole


def without_friction(closed: tuple[int, ...], restitution: tuple[float, float, float]) -> Modal:
    """The toy with only these contacts within reach, and without weight."""
    model = modal(Toy(friction=0.0, restitution=restitution))
    gaps = np.where([k in closed for k in range(3)], model.gaps, 1.0)
    return Modal(model.basis, model.spring, np.zeros(3), model.contacts, gaps)


@pytest.mark.parametrize("closed", NEAR)
@pytest.mark.parametrize("rates", [(-0.3, -0.7), (-0.7, -0.01), (0.05, -0.7), (-0.7, 0.05), (0.3, 0.7)])
def test_two_contacts_at_once(closed: tuple[int, int], rates: tuple[float, float]) -> None:
    """Those that approach are stopped, each gets its share of its own impulse back, and none is pulled: all ways are tried."""
    model = without_friction(closed, (0.5, 0.2, 0.8))
    N = model.contacts.W[[2 * k for k in closed]]
    e = -np.linalg.pinv(N) @ model.gaps[list(closed)]
    v, h = np.linalg.pinv(N) @ rates, 1e-7
    G, back = N @ N.T, np.array([(0.5, 0.2, 0.8)[k] for k in closed])
    stop = pressed(G, np.array(rates), np.zeros(2))
    thrown = stop + pressed(G, np.array(rates) + G @ stop, back * stop)
    e_new, v_new = step_to(model, e - 1e-9 * N.sum(axis=0), v, h, h)
    assert v_new == pytest.approx(v + N.T @ thrown, abs=1e-4 * np.abs(v).max())
    assert e_new == pytest.approx(e, abs=1e-5)


def pressed(G: np.ndarray, rates: np.ndarray, low: np.ndarray) -> np.ndarray:
    """Impulses of at least `low`, more only where a contact then stands still."""
    for held in ((False, False), (True, False), (False, True), (True, True)):
        rows = np.flatnonzero(held)
        P = low.copy()
        others = np.flatnonzero(np.logical_not(held))
        P[rows] = np.linalg.solve(G[np.ix_(rows, rows)], -rates[rows] - G[np.ix_(rows, others)] @ low[others])
        if np.all(low - 1e-12 <= P) and np.all(rates + G @ P >= -1e-12):
            return P
    raise AssertionError("no way")


@pytest.mark.parametrize(("at_middle", "hit"), [(-1e-9, True), (1e-9, False), (5e-4, False)])
def test_contacts_count_that_are_closed_at_the_middle_of_the_step(at_middle: float, hit: bool) -> None:
    """The gap that is left after half a step, seen from either side."""
    model, h = without_friction((LOWER,), (0.5, 0.5, 0.5)), 1e-3
    N = model.contacts.W[2 * LOWER]
    v = -0.2 * N / (N @ N)
    e = (at_middle + 0.5 * h * 0.2 - model.gaps[LOWER]) * N / (N @ N)
    held = Modal(model.basis, np.zeros(3), model.load, model.contacts, model.gaps)
    e_new, v_new = step_to(held, e, v, h, h)
    rate = 0.1 if hit else -0.2
    assert N @ v_new == pytest.approx(rate, rel=1e-9)
    assert N @ (e_new - e) == pytest.approx(0.5 * h * 2.0 * rate, rel=1e-9, abs=0.0)
