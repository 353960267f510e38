"""Do bearings take what momentum, weight, contacts and teeth leave over? Against momenta of points, differentiated in time."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.contact_forces import _drives, _pivots, _pressed, absolute
from watchsim.analysis.mesh_forces import Loads, Motion, Pressed
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.gearing import Geared
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene

GRAVITY = (0.7, -9.3)
# A carrier of 2 g, on it a planet of 3 g that turns, and a weight of 5 g that does not; another wheel; something fixed.
BODIES = (
    Body("carrier", position=(1e-3, 2e-3), mass=2e-3, inertia=4e-7, centre_of_mass=(3e-3, -1e-3)),
    Body("planet", position=(8e-3, 3e-3), mass=3e-3, inertia=2e-7, on="carrier"),
    Body("weight", "fixed", position=(-4e-3, 6e-3), mass=5e-3, on="carrier"),
    Body("wheel", position=(9e-3, -7e-3), mass=4e-3, inertia=3e-7, centre_of_mass=(2e-3, 5e-3)),
    Body("slider", "slide", mass=1e-3),
    Body("plate", "fixed"),
)
SCENE = Scene("Carried", BODIES, gravity=GRAVITY)
CARRIER, PLANET, WEIGHT, WHEEL, SLIDER, PLATE = range(6)
Q = np.array([[0.3, 0.9, -1.1, 2e-3], [2.2, -0.4, 0.6, -1e-3]])  # in the movement
U = np.array([[5.0, -3.0, 7.0, 0.1], [-4.0, 6.0, -2.0, 0.3]])
A = np.array([[110.0, 50.0, -90.0, 3.0], [-70.0, 20.0, 130.0, -5.0]])


def momentum(arms: tuple[tuple[float, complex], ...], angle: float, spin: float, turn: float) -> complex:
    """Change of momentum (N) of masses at arms of a body that turns about a point at rest: twice differentiated by hand."""

    def place(t: float) -> complex:
        return sum(m * arm for m, arm in arms) * np.exp(1j * (angle + spin * t + 0.5 * turn * t * t))

    h = 1e-5
    return complex((place(h) - 2.0 * place(0.0) + place(-h)) / h**2)


def pivots(scene: Scene, loads: Loads, meshed: list[Pressed]) -> dict[str, Any]:
    compiled = compile_scene(scene)
    run: Any = SimpleNamespace(scene=scene)
    return dict(_pivots(run, compiled, Motion(np.zeros(2), Q, U, A), loads, meshed))


NONE = Loads(np.zeros(0, np.int64), np.zeros((2, 0, 2)), np.zeros((2, 0, 2)))
ARMS = {
    "carrier": ((2e-3, 3e-3 - 1e-3j), (3e-3, 8e-3 + 3e-3j), (5e-3, -4e-3 + 6e-3j)),
    "wheel": ((4e-3, 2e-3 + 5e-3j),),
}


def test_momentum_and_weight_of_all_that_is_carried() -> None:
    """Of bearings in the movement only: that of the planet is in its carrier."""
    found = pivots(SCENE, NONE, [])
    assert set(found) == {"carrier", "wheel"}
    for name, column in (("carrier", 0), ("wheel", 2)):
        for row in range(2):
            mass = sum(m for m, _ in ARMS[name])
            wanted = momentum(ARMS[name], Q[row, column], U[row, column], A[row, column]) - mass * complex(*GRAVITY)
            assert complex(*found[name][row]) == pytest.approx(wanted, rel=1e-5, abs=0.0)


def test_contacts_and_teeth_of_all_that_is_carried() -> None:
    """Against each other parts of one carrier press in vain; what presses on side B of a contact is the reverse."""
    still = pivots(SCENE, NONE, [])
    sides = ((PLATE, PLANET), (WEIGHT, WHEEL), (CARRIER, PLANET), (WHEEL, PLATE), (SLIDER, CARRIER))
    pressed = np.random.default_rng(5).normal(size=(2, len(sides), 2))
    compiled = compile_scene(SCENE)
    owner = np.array([PLATE, PLANET, WEIGHT, WHEEL, CARRIER, SLIDER])
    place = {body: k for k, body in enumerate(owner.tolist())}
    kinds = np.dtype([("a", np.int64), ("b", np.int64)])
    contacts = np.array([(0, 0), (0, 0), *((place[a], place[b]) for a, b in sides)], kinds).view(np.recarray)
    made: Any = SimpleNamespace(
        model=SimpleNamespace(contacts=contacts, primitives=SimpleNamespace(body=owner)),
        own=compiled.own,
        slices=compiled.slices,
    )
    run: Any = SimpleNamespace(scene=SCENE)
    loads = Loads(np.arange(2, 7), np.zeros((2, 5, 2)), pressed)
    teeth = [Pressed(body, np.full((2, 2), 10.0**body)) for body in (PLANET, WHEEL, SLIDER)]
    found = dict(_pivots(run, made, Motion(np.zeros(2), Q, U, A), loads, teeth))
    on_carrier = -pressed[:, 0] + pressed[:, 1] - pressed[:, 4] + 10.0**PLANET
    on_wheel = -pressed[:, 1] + pressed[:, 3] + 10.0**WHEEL
    assert found["carrier"] == pytest.approx(still["carrier"] - on_carrier, rel=1e-9)
    assert found["wheel"] == pytest.approx(still["wheel"] - on_wheel, rel=1e-9)


def test_what_presses_on_body_a_along_and_across_the_normal() -> None:
    """Across is the normal turned by +90°."""
    angle, force = np.array([[0.4, -2.0], [1.1, 3.0]]), np.array([[[3.0, -2.0], [5.0, 0.5]], [[7.0, 4.0], [0.0, -1.0]]])
    balanced: Any = SimpleNamespace(normal=np.stack((np.cos(angle), np.sin(angle)), axis=2), force=force)
    found = _pressed(balanced)
    wanted = (force[..., 0] + 1j * force[..., 1]) * np.exp(1j * angle)
    assert found[..., 0] + 1j * found[..., 1] == pytest.approx(wanted, rel=1e-12)


def test_a_drive_moves_mass_and_holds_against_contacts() -> None:
    moved = tuple(replace(body, prescribed=Prescribed()) if body.name == "wheel" else body for body in BODIES)
    slices = {"carrier": slice(0, 1), "planet": slice(1, 2), "wheel": slice(2, 3), "slider": slice(3, 4)}
    load = np.array([[1e-6, 2e-6, 3e-6, 4e-6], [5e-6, 6e-6, 7e-6, 8e-6]])
    run, compiled = SimpleNamespace(scene=SimpleNamespace(bodies=moved)), SimpleNamespace(slices=slices)
    found = dict(_drives(run, compiled, load, A))  # type: ignore[arg-type]
    assert set(found) == {"wheel"}
    assert found["wheel"] == pytest.approx(3e-7 * A[:, 2] - load[:, 2], rel=1e-9, abs=0.0)


@pytest.mark.parametrize("rates", [False, True])
def test_coordinates_in_the_movement_and_back(rates: bool) -> None:
    """Of what is carried, two deep and turned besides, and with a body that is geared to another."""
    plain = (
        Body("first", angle=0.2),
        Body("plate", "fixed", angle=0.7, on="first"),
        Body("second", angle=0.3, on="plate"),
        Body("third", angle=-0.4, on="second"),
        Body("wheel", geared=Geared("other", -2.5)),
        Body("other"),
        Body("base", "fixed", angle=0.8),
        Body("last", angle=0.1, on="base"),
    )
    bodies = tuple(replace(body, inertia=2e-7) for body in plain)
    compiled = compile_scene(Scene("Carried", bodies))
    values = np.random.default_rng(8).normal(size=(4, len(compiled.q)))
    given = compiled.relative(values, rates)
    assert given.shape[1] == values.shape[1] + 1 == 6
    before = given.copy()
    assert absolute(compiled, given, rates) == pytest.approx(values, rel=1e-12, abs=1e-12)
    assert np.array_equal(given, before)
    at_zero = absolute(compiled, np.zeros((1, 6)), rates)[0]
    assert at_zero == pytest.approx(np.zeros(5) if rates else np.array([0.0, 0.7, 0.7, 0.0, 0.8]), abs=1e-15)
