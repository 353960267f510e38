"""Does the acceleration-level problem decide roll, slip and detachment as mechanics does, singular cases included?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.contact.kinematics import closed_contacts, contact_kinematics
from watchsim.contact.poses import place, poses
from watchsim.dynamics.delassus import contact_work
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model.records import LINE
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.verification.contact_problems import accelerate, decide_modes, solve_mode

R, M, KAPPA, G = 0.05, 2.0, 0.4, 9.81
J = KAPPA * M * R * R
SLOW = 1e-9
ROOM = 6

_place, _kinematics = callable_kernel(place), callable_kernel(contact_kinematics)


class Outcome:
    """Modes, forces (N, T rows) and accelerations of the given contacts at (q, u) under h."""

    def __init__(self, compiled: Compiled, ids: list[int], q, u, h) -> None:
        model, n = compiled.model, len(compiled.q)
        pose, closed, work = poses(len(model.bodies)), closed_contacts(ROOM), contact_work(ROOM, n)
        self.mode, m = np.zeros(len(model.contacts), np.int8), len(ids)
        _place(model, np.array(q, float), np.array(u, float), pose)
        for row, k in enumerate(ids):
            _kinematics(model, k, pose, row, closed)
        work.h[:] = h
        self.grip = np.zeros(n, np.int8)
        self.gaps = closed.kin.g[:m].copy()
        self.solved = decide_modes(model, closed, m, 0, SLOW, work, self.grip, self.mode)
        self.force, self.a = work.force[: 2 * m].copy(), np.zeros(n)
        accelerate(model, closed, m, work, self.a)
        # The equality system of the decided mode has the same answer as the complementarity problem that chose it.
        self.again = np.zeros(n)
        stay = [row for row, k in enumerate(ids) if self.mode[k] != OPEN]
        for row, kept in enumerate(stay):
            _kinematics(model, ids[kept], pose, row, closed)
        solve_mode(model, closed, len(stay), self.mode, 1.0, work)
        accelerate(model, closed, len(stay), work, self.again)


def disc_on_plane(mu: float) -> tuple[Compiled, int]:
    """A free disc on a plane along x; the contact's number."""
    disc = Body("disc", "free", (0.0, R), mass=M, inertia=J, loops=(Loop((Arc(0.0, 0.0, R, 0.0, 2.0 * math.pi),)),))
    plane = Body("plane", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    scene = Scene("disc", (disc, plane), contacts=(Contact((Side("disc"), Side("plane")), mu, 0.0),))
    compiled = compile_scene(scene)
    kinds = compiled.model.primitives.kind[compiled.model.contacts.b]
    return compiled, int(np.flatnonzero(kinds == LINE)[0])


def on_incline(mu: float, slope: float, v: float, spin: float, push: float = 0.0) -> Outcome:
    """The disc on the incline, downhill is +x; `push` is a force off the plane."""
    compiled, k = disc_on_plane(mu)
    h = [M * G * math.sin(slope), -M * G * math.cos(slope) + push, 0.0]
    out = Outcome(compiled, [k], (0.0, R, 0.3), (v, 0.0, spin), h)
    assert out.solved
    assert out.gaps == pytest.approx([0.0], abs=1e-16)
    assert out.again == pytest.approx(out.a, abs=1e-12 * G)
    out.mode = out.mode[k : k + 1]
    return out


SLOPE = math.radians(20.0)
CRITICAL = math.tan(SLOPE) * KAPPA / (1.0 + KAPPA)  # least friction that makes it roll


@pytest.mark.parametrize("mu", [1.0001 * CRITICAL, 0.3, 1.0])
@pytest.mark.parametrize("v", [0.0, 0.7, -0.7])
def test_rolls(mu: float, v: float) -> None:
    out = on_incline(mu, SLOPE, v, -v / R)
    a = G * math.sin(SLOPE) / (1.0 + KAPPA)
    assert out.mode == [STICK]
    assert out.a == pytest.approx([a, 0.0, -a / R], abs=1e-12 * G / R)
    # t points uphill (n turned by +90 degrees): friction on the disc, body A, is along +t.
    assert out.force == pytest.approx([M * G * math.cos(SLOPE), M * G * math.sin(SLOPE) * KAPPA / (1.0 + KAPPA)], rel=1e-12)


@pytest.mark.parametrize("mu", [0.9999 * CRITICAL, 0.05])
def test_begins_to_slip(mu: float) -> None:
    out = on_incline(mu, SLOPE, 0.7, -0.7 / R)
    press = M * G * math.cos(SLOPE)
    assert abs(out.mode[0]) == 1
    assert out.a == pytest.approx([G * math.sin(SLOPE) - mu * press / M, 0.0, -mu * press * R / J], rel=1e-12, abs=1e-12)


def test_without_friction_it_slides_freely() -> None:
    out = on_incline(0.0, SLOPE, 0.0, 0.0)
    assert out.a == pytest.approx([G * math.sin(SLOPE), 0.0, 0.0], abs=1e-13)
    assert out.force[1] == 0.0


@pytest.mark.parametrize("v", [-0.5, 0.5])
def test_slides_against_its_slip(v: float) -> None:
    """Uphill (v < 0) and downhill without spin: friction opposes the slip, whatever the slope does."""
    mu = 0.2
    out = on_incline(mu, SLOPE, v, 0.0)
    press, side = M * G * math.cos(SLOPE), math.copysign(1.0, v)
    assert out.a == pytest.approx([G * math.sin(SLOPE) - side * mu * press / M, 0.0, -side * mu * press * R / J], rel=1e-12)
    # g_T_dot is the disc's velocity along t, which points uphill.
    assert out.mode == [BACKWARD if v > 0.0 else FORWARD]


@pytest.mark.parametrize(("v", "spin"), [(0.0, 0.0), (0.3, 0.0), (0.3, -0.3 / R)])
def test_detaches_exactly_when_pulled_off(v: float, spin: float) -> None:
    weight = M * G * math.cos(SLOPE)
    stays = on_incline(0.3, SLOPE, v, spin, push=0.999 * weight)
    leaves = on_incline(0.3, SLOPE, v, spin, push=1.001 * weight)
    assert stays.mode != [OPEN]
    assert stays.force[0] == pytest.approx(0.001 * weight, rel=1e-9)
    assert leaves.mode == [OPEN]
    assert np.all(leaves.force == 0.0)
    assert leaves.a == pytest.approx([G * math.sin(SLOPE), 0.001 * weight / M, 0.0], rel=1e-9, abs=1e-12)


def rotor_on_stop(arm: tuple[float, float], mu: float) -> tuple[Compiled, list[int]]:
    """A rotor about the origin whose downward corner, at `arm` from the axis, rests on a fixed horizontal line."""
    x, y = arm
    tip = Loop((Line(x - 0.2, y + 0.3, x, y), Line(x, y, x + 0.2, y + 0.3)), closed=False)
    rotor = Body("rotor", "pivot", (0.0, 0.0), 0.0, inertia=0.7, loops=(tip,))
    stop = Body("stop", "fixed", loops=(Loop((Line(5.0, y, -5.0, y),), closed=False),))
    scene = Scene("rotor", (rotor, stop), contacts=(Contact((Side("rotor"), Side("stop")), mu, 0.0),))
    compiled = compile_scene(scene)
    model = compiled.model
    ids = [
        k
        for k, c in enumerate(model.contacts)
        if model.primitives[c.a].kind == 0 and model.primitives[c.a].body == 0 and model.primitives[c.b].kind == LINE
    ]
    assert len(ids) == 1
    return compiled, ids


@pytest.mark.parametrize("mu", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("height", [-0.3, 0.0, 0.3])
def test_one_rotor_on_a_stop(mu: float, height: float) -> None:
    """One coordinate, up to two forces: det G = 0. Pressed on it stays, pulled off it leaves; either acceleration is unique."""
    compiled, ids = rotor_on_stop((1.0, height), mu)
    pressed = Outcome(compiled, ids, [0.0], [0.0], [-2.0])
    assert pressed.solved
    assert pressed.mode[ids[0]] == STICK if mu > 0.0 and height != 0.0 else pressed.mode[ids[0]] != OPEN
    assert pressed.a == pytest.approx([0.0], abs=1e-13)
    assert pressed.again == pytest.approx([0.0], abs=1e-13)
    assert pressed.force[0] > 0.0
    assert abs(pressed.force[1]) <= mu * pressed.force[0] * (1.0 + 1e-12)
    # Moment balance: the forces carry the torque, however they share it.
    assert pressed.force[0] - height * -pressed.force[1] == pytest.approx(2.0, abs=1e-12)
    pulled = Outcome(compiled, ids, [0.0], [0.0], [3.0])
    assert pulled.mode[ids[0]] == OPEN
    assert pulled.a == pytest.approx([3.0 / 0.7], rel=1e-13)


def test_a_block_on_four_redundant_corners_stays() -> None:
    """A square lying flat touches with two corners on the plane; with stick the four forces are not unique, the rest is."""
    s, mu = 0.1, 0.5
    points = [(-s, -s), (s, -s), (s, s), (-s, s)]
    edges = tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True))
    block = Body("block", "free", (0.0, s), mass=M, inertia=0.01, loops=(Loop(edges),))
    plane = Body("plane", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    compiled = compile_scene(Scene("block", (block, plane), contacts=(Contact((Side("block"), Side("plane")), mu, 0.0),)))
    p = compiled.model.primitives
    ids = [k for k, c in enumerate(compiled.model.contacts) if p[c.a].kind == 0 and p[c.a].body == 0 and p[c.a].y < 0.0]
    ids = [k for k in ids if p[compiled.model.contacts[k].b].kind == LINE]
    assert len(ids) == 2
    for slope, stays in ((0.9 * math.atan(mu), True), (1.1 * math.atan(mu), False)):
        h = [M * G * math.sin(slope), -M * G * math.cos(slope), 0.0]
        out = Outcome(compiled, ids, (0.0, s, 0.0), (0.0, 0.0, 0.0), h)
        assert out.solved
        a = 0.0 if stays else G * (math.sin(slope) - mu * math.cos(slope))
        assert out.a == pytest.approx([a, 0.0, 0.0], abs=1e-11 * G)
        assert out.again == pytest.approx([a, 0.0, 0.0], abs=1e-11 * G)
        assert out.force[0] + out.force[2] == pytest.approx(M * G * math.cos(slope), rel=1e-12)
