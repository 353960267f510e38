"""What do the equations of motion lack once bodies are freed of their gears, and which teeth make up for it?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis import mesh_forces as module
from watchsim.analysis.mesh_forces import Loads, Motion, _freed, _lacking, _tight, mesh_forces
from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.gear_trains import ungeared
from watchsim.scene.gearing import Gear, Geared
from watchsim.scene.scene import Scene

RNG = np.random.default_rng(12)
FIRST, SECOND, THIRD = 0.2, 0.7, -0.4  # rad, at the start


def train() -> Scene:
    """Three wheels in a row without play, a plate, a stone that is free, and a fourth wheel with play against the third."""
    bodies = (
        Body("stone", "free", mass=2e-3, inertia=1e-7, velocity=(0.0, 0.0, 0.0)),
        Body("second", position=(9e-3, 0.0), angle=SECOND, inertia=2e-7, geared=Geared("first", -2.5)),
        Body("plate", "fixed"),
        Body("first", angle=FIRST, inertia=3e-7),
        Body("third", position=(9e-3, 7e-3), angle=THIRD, inertia=4e-7, geared=Geared("first", 7.5)),
        Body("fourth", position=(2e-3, 7e-3), inertia=5e-7),
    )
    rigid = (Gear(("first", "second"), -2.5, 0.0), Gear(("second", "third"), -3.0, 0.0))
    return Scene("Train", bodies, gears=(Gear(("third", "fourth"), -2.0, 1e-3),), rigid_gears=rigid)


def test_coordinates_of_freed_bodies() -> None:
    """Of those that had none their places in the movement follow from where they stood, their rates from the ratio alone."""
    scene = train()
    compiled, free = compile_scene(scene), compile_scene(ungeared(scene))
    values = RNG.normal(size=(4, compiled.model.coordinates.mass.size))
    own = {name: compiled.slices[name].start for name in ("stone", "first", "fourth")}
    for rates in (0, 1):
        found = _freed(scene, compiled, free, values, rates)
        assert found.shape == (4, 7)
        turned = values[:, own["first"]]
        at = {name: found[:, free.slices[name].start] for name in ("first", "second", "third", "fourth")}
        assert np.array_equal(at["first"], turned) and np.array_equal(at["fourth"], values[:, own["fourth"]])
        start = (0.0, 0.0, 0.0) if rates else (FIRST, SECOND, THIRD)
        assert at["second"] == pytest.approx(start[1] - 2.5 * (turned - start[0]), rel=1e-12)
        assert at["third"] == pytest.approx(start[2] + 7.5 * (turned - start[0]), rel=1e-12)
        assert np.array_equal(found[:, free.slices["stone"]], values[:, own["stone"] : own["stone"] + 3])


@pytest.mark.parametrize("racks", [0, 2])
def test_what_the_equation_of_each_coordinate_lacks(monkeypatch: pytest.MonkeyPatch, racks: int) -> None:
    """Mass times acceleration less all that is known; contacts of racks do not belong to the freed scene."""
    n, width, m = 3, 4, 2
    h, w_n, w_t = RNG.normal(size=(n, width)), *RNG.normal(size=(2, n, m, width))
    a, mass, force = RNG.normal(size=(n, width)), np.array([2.0, 3.0, 5.0, 7.0]), RNG.normal(size=(n, m + racks, 2))
    u = np.array([[1.5, 0.0, -2.5, 0.0], [-0.5, 0.25, 0.0, 0.0], [0.0, -1e-4, 1e-4, 3.0]])
    dry, prescribed = np.array([0.3, 5e-4, 0.0, 0.7]), np.array([False, False, False, True])
    asked: list[Any] = []

    def seen(t: Any, q: Any, rates: Any, ids: Any) -> Any:
        asked.append((t, q, rates, ids))
        return SimpleNamespace(h=h, w_N=w_n, w_T=w_t)

    monkeypatch.setattr(module, "Mechanism", lambda free: SimpleNamespace(seen=seen, dry=dry, prescribed=prescribed))
    monkeypatch.setattr(module, "_freed", lambda scene, compiled, free, values, rates: values + 0.5 * (rates == 0))
    model = SimpleNamespace(contacts=[None] * 8, coordinates=SimpleNamespace(mass=mass))
    free: Any = SimpleNamespace(model=model)
    nothing: Any = None
    q, t = RNG.normal(size=(n, width)), np.arange(3.0)
    ids = np.array([3, 7, 8, 9][: m + racks])
    lacking, known = _lacking(nothing, nothing, free, Motion(t, q, u, a), Loads(ids, force, nothing))
    ((times, places, rates, contacts),) = asked
    assert times is t and np.array_equal(places, q + 0.5) and np.array_equal(rates, u) and contacts.tolist() == [3, 7]
    for row in range(n):
        for j in range(width):
            contact = sum(force[row, k, 0] * w_n[row, k, j] + force[row, k, 1] * w_t[row, k, j] for k in range(m))
            rub = dry[j] * (1.0 if u[row, j] > 0.0 else -1.0) if u[row, j] else 0.0
            assert lacking[row, j] == pytest.approx(mass[j] * a[row, j] - h[row, j] + rub - contact, rel=1e-12, abs=1e-12)
            stands = dry[j] > 0.0 and u[row, j] == 0.0
            assert bool(known[row, j]) is not (prescribed[j] or stands)


@pytest.mark.parametrize("hidden", [None, "first", "second"])
def test_torques_of_teeth_that_make_up_for_what_is_lacking(monkeypatch: pytest.MonkeyPatch, hidden: str | None) -> None:
    """Of the train, with torques of 2 and 5 on the second and the third: -ratio times as much on the one before. What racks
    press is no lack, and where one equation says nothing the others do; at another instant it may say something."""
    scene = train()
    free = compile_scene(ungeared(scene))
    at = {name: columns.start for name, columns in free.slices.items()}
    lacking, known = np.zeros((2, len(free.q))), np.ones((2, len(free.q)), bool)
    for row, (one, two) in enumerate(((2.0, 5.0), (-3.0, 0.5))):
        lacking[row, at["second"]] = one + 3.0 * two
        lacking[row, at["first"]], lacking[row, at["third"]] = 2.5 * one, two + 0.7
        lacking[row, at["fourth"]] = 0.3
    if hidden:
        known[0, at[hidden]], lacking[0, at[hidden]] = False, 99.0
    monkeypatch.setattr(module, "_lacking", lambda *_: (lacking, known))
    nothing: Any = None
    motion = Motion(np.zeros(2), nothing, nothing, nothing)
    found = _tight(scene, nothing, motion, nothing, [(np.full(2, 0.7), np.full(2, 0.3))])
    for torques, wanted in zip(found, ((5.0, 2.0, -7.5, -3.0), (15.0, 5.0, 1.5, 0.5)), strict=True):
        assert (torques[0][0], torques[1][0], torques[0][1], torques[1][1]) == pytest.approx(wanted, rel=1e-9)


def test_gears_with_play_come_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each with its own torques and bodies, by number; without gears nothing is asked."""
    asked: list[Any] = []

    def noted(scene: Any, compiled: Any, motion: Any, gear: Gear, numbers: Any, torques: Any, hung: Any) -> Any:
        asked.append((gear.between, numbers, torques))
        return iter((len(asked),))

    monkeypatch.setattr(module, "_of_racks", lambda scene, compiled, k, loads: f"racks {k}")
    monkeypatch.setattr(module, "_tight", lambda *_: ["tight 0", "tight 1"])
    monkeypatch.setattr(module, "_at_pitch_point", noted)
    nothing: Any = None
    assert list(mesh_forces(train(), nothing, nothing, nothing)) == [1, 2, 3]
    assert asked == [
        (("third", "fourth"), (4, 5), "racks 0"),
        (("first", "second"), (3, 1), "tight 0"),
        (("second", "third"), (1, 4), "tight 1"),
    ]
    alone = Scene("none", (Body("a"),))
    assert list(mesh_forces(alone, nothing, nothing, nothing)) == []
    assert len(asked) == 3
