"""Are the lever arms of contacts those of forces on paper? A disc off its pivot, a bar that turns about another."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import polygon
from scipy.optimize import brentq

from watchsim.analysis.balanced_forces import Mechanism
from watchsim.analysis.promised import not_begun
from watchsim.analysis.verdicts.equilibrium.lever_arms import arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Scene

RADIUS, CENTRE = 1.5e-3, 2e-3 - 1e-3j
DISC, BAR = 1e-3 + 5.5e-3j, -2e-3 + 3e-3j  # pivots
TOP, CORNER = 2, 5  # contacts: the bar's upper edge, and its corner above on the right
EDGE, HORN = 0.5e-3, 5e-3 + 0.5e-3j


def scene() -> Scene:
    disc = Loop((Arc(CENTRE.real, CENTRE.imag, RADIUS, 0.0, math.tau),), "RIM", True)
    bar = polygon([1e-3 * complex(x, y) for x, y in ((-6, -1), (5, -1), (5, 0.5), (-6, 0.5))], "BAR")
    bodies = (
        Body("plate", "fixed"),
        Body("disc", position=(DISC.real, DISC.imag), inertia=2e-9, velocity=(0.0,), loops=(disc,)),
        Body("bar", position=(BAR.real, BAR.imag), inertia=3e-9, velocity=(0.0,), loops=(bar,)),
    )
    contacts = (Contact((Side("disc"), Side("plate")), 0.4), Contact((Side("disc"), Side("bar")), 0.13))
    acting: dict[str, Any] = {"springs": (Spring("bar", 2e-6, 0.1),), "torques": (Torque("disc", 3e-6),)}
    return Scene("Disc and bar", bodies, damping=(Damping("bar", 1e-7, 0.0, 5e-8),), contacts=contacts, **acting)


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def told(bar: float, contacts: list[int], top: bool, u: float = 0.0) -> tuple[Any, float]:
    """With the bar at that angle, and the disc so that it touches its upper edge, or else its corner."""

    def gap(disc: float) -> float:
        middle = (DISC + CENTRE * np.exp(1j * disc) - BAR) * np.exp(-1j * bar)
        return float(middle.imag - EDGE if top else abs(middle - HORN)) - RADIUS

    tried = np.linspace(-math.pi, math.pi, 200)
    k = next(k for k in range(199) if gap(tried[k]) * gap(tried[k + 1]) <= 0.0)
    disc = brentq(gap, tried[k], tried[k + 1], xtol=1e-15)
    made = scene()
    compiled = compile_scene(made)
    contact = compiled.model.contacts
    # Of the model: which primitive is on side A, and to which declared contact all belong.
    pairs: Any = tuple(SimpleNamespace(group=int(group), name=k) for k, group in enumerate(contact.group))
    q, rates = np.array([[disc, bar]]), np.array([[0.0, u]])
    run = replace(not_begun(made), q=q, u=rates, pairs=pairs)
    return arms(run, compiled, 0.0, contacts), disc


def on_paper(disc: float, bar: float) -> tuple[complex, complex, tuple[float, float], tuple[float, float]]:
    """Of the contact on the bar's upper edge: where, its normal, and the arms about both pivots along the normal and across."""
    normal = 1j * np.exp(1j * bar)
    point = DISC + CENTRE * np.exp(1j * disc) - RADIUS * normal
    along, across = ((cross(point - DISC, way), -cross(point - BAR, way)) for way in (normal, 1j * normal))
    return point, normal, along, across


@pytest.mark.parametrize("bar", [0.2, -0.35, 0.5])
@pytest.mark.parametrize("others", [[], [0]])
def test_arms_of_a_contact(bar: float, others: list[int]) -> None:
    """On body A along the normal out of B, and along that turned by +90°; on body B the other way."""
    found, disc = told(bar, [*others, TOP], top=True)
    row = len(others)
    point, normal, along, across = on_paper(disc, bar)
    assert complex(*found.way[row]) == pytest.approx(normal, rel=1e-9) and found.t == 0.0
    assert complex(*found.point[row]) == pytest.approx(point, abs=1e-12)
    assert found.of(row, "disc") == pytest.approx((along[0], across[0]), rel=1e-9, abs=0.0)
    assert found.of(row, "bar") == pytest.approx((along[1], across[1]), rel=1e-9, abs=0.0)
    assert [pair.name for pair in found.pairs] == [*others, TOP] and found.friction[row] == 0.13
    assert found.places["disc"] == pytest.approx((DISC.real, DISC.imag, disc), rel=1e-12)
    assert found.places["bar"] == pytest.approx((BAR.real, BAR.imag, bar), rel=1e-12) and found.columns == {"disc": 0, "bar": 1}


def test_arms_of_a_corner() -> None:
    """Side A is the bar's: the normal points out of the disc."""
    found, disc = told(-0.1, [CORNER], top=False)
    middle, point = DISC + CENTRE * np.exp(1j * disc), BAR + HORN * np.exp(-0.1j)
    normal = (point - middle) / RADIUS
    assert complex(*found.way[0]) == pytest.approx(normal, rel=1e-9)
    assert complex(*found.point[0]) == pytest.approx(point, abs=1e-12)
    assert found.of(0, "bar") == pytest.approx((cross(point - BAR, normal), cross(point - BAR, 1j * normal)), rel=1e-9)
    assert found.of(0, "disc") == pytest.approx((-cross(point - DISC, normal), -cross(point - DISC, 1j * normal)), rel=1e-9)


def test_loads_are_those_of_bodies_at_rest() -> None:
    """Springs and drives, whatever turns: viscous damping is left out, dry friction told apart."""
    found, _ = told(0.2, [TOP], top=True, u=3.0)
    assert found.loads == pytest.approx([3e-6, -2e-6 * (0.2 - 0.1)], rel=1e-9, abs=0.0)
    assert found.dry.tolist() == [0.0, 5e-8]


def test_without_contacts_there_are_still_loads() -> None:
    found, _ = told(0.2, [], top=True)
    assert found.normal.shape == found.across.shape == (0, 2) and found.point.shape == found.way.shape == (0, 2)
    assert found.loads[0] == pytest.approx(3e-6, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("contacts", [[TOP], [0, TOP, CORNER], []])
def test_many_instants_are_seen_one_by_one(contacts: list[int]) -> None:
    """With velocities: how the gap bends as both turn on evenly, and what damping does to them."""
    compiled = compile_scene(scene())
    q = np.array([(told(bar, [TOP], top=True)[1], bar) for bar in (0.2, -0.35, 0.5)])
    u = np.array([(1.5, -2.0), (-0.5, 3.0), (2.5, 0.25)])
    seen = Mechanism(compiled).seen(np.zeros(3), q, u, np.array(contacts, np.int64))
    count = len(contacts)
    assert seen.w_N.shape == seen.w_T.shape == (3, count, 2) == seen.normal.shape == seen.point.shape
    assert seen.bar.shape == (3, 2, count) and seen.h.shape == (3, 2)
    assert seen.h[:, 1] == pytest.approx(-2e-6 * (q[:, 1] - 0.1) - 1e-7 * u[:, 1], rel=1e-9, abs=0.0)
    if not contacts:
        return
    row = contacts.index(TOP)
    for k, (disc, bar) in enumerate(q):
        point, normal, along, across = on_paper(disc, bar)
        assert seen.w_N[k, row] == pytest.approx(along, rel=1e-9, abs=1e-15)
        assert seen.w_T[k, row] == pytest.approx(across, rel=1e-9, abs=1e-15)
        assert complex(*seen.point[k, row]) == pytest.approx(point, abs=1e-12)
        assert complex(*seen.normal[k, row]) == pytest.approx(normal, rel=1e-9)

        def gap(t: float, k: int = k) -> float:
            disc, bar = q[k] + t * u[k]
            return float(((DISC + CENTRE * np.exp(1j * disc) - BAR) * np.exp(-1j * bar)).imag)

        h = 1e-4
        assert seen.w_N[k, row] @ u[k] == pytest.approx((gap(h) - gap(-h)) / (2.0 * h), rel=1e-6, abs=0.0)
        assert seen.bar[k, 0, row] == pytest.approx((gap(h) - 2.0 * gap(0.0) + gap(-h)) / h**2, rel=1e-5, abs=0.0)


def test_what_a_mechanism_knows_of_its_contacts() -> None:
    """Friction by the contact declared, mobilities and dry friction by coordinate."""
    made = Mechanism(compile_scene(scene()))
    assert made.friction.tolist() == [0.13] * 8 and made.mobility == pytest.approx([1 / 2e-9, 1 / 3e-9], rel=1e-12)
    assert made.dry.tolist() == [0.0, 5e-8] and made.prescribed.tolist() == [False, False]
