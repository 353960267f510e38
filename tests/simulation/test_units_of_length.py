"""Does a scene written in micrometres move like the same scene in metres?"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from every_time import few
from moving_scenes import profile

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge
from watchsim.scene.body import Body
from watchsim.scene.force import Damping
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate


def _edge(edge: Edge, k: float) -> Edge:
    if isinstance(edge, Arc):
        return Arc(k * edge.x, k * edge.y, k * edge.radius, edge.start_angle, edge.sweep)
    return type(edge)(k * edge.x0, k * edge.y0, k * edge.x1, k * edge.y1)


def _body(body: Body, k: float) -> Body:
    loops = tuple(dataclasses.replace(loop, edges=tuple(_edge(edge, k) for edge in loop.edges)) for loop in body.loops)
    lengths = {"free": (k, k, 1.0), "slide": (k,)}.get(body.motion, (1.0,))
    return dataclasses.replace(
        body,
        position=(k * body.position[0], k * body.position[1]),
        velocity=tuple(v * f for v, f in zip(body.velocity, lengths, strict=False)),
        inertia=k * k * body.inertia,
        centre_of_mass=(k * body.centre_of_mass[0], k * body.centre_of_mass[1]),
        loops=loops,
    )


def in_units(scene: Scene, k: float) -> Scene:
    """The same scene with k units of length where there was one; masses and times keep theirs. Pivots and free bodies."""
    return dataclasses.replace(
        scene,
        bodies=tuple(_body(body, k) for body in scene.bodies),
        springs=tuple(dataclasses.replace(one, stiffness=k * k * one.stiffness) for one in scene.springs),
        torques=tuple(dataclasses.replace(one, value=k * k * one.value) for one in scene.torques),
        damping=tuple(
            Damping(one.body, k * k * one.viscous, k * k * one.quadratic, k * k * one.coulomb) for one in scene.damping
        ),
        gravity=(k * scene.gravity[0], k * scene.gravity[1]),
    )


def test_scaled_scenes_are_scaled() -> None:
    """The helper itself: a circle grows, an angle does not."""
    loop = Loop((Arc(1.0, 2.0, 3.0, 0.5, 1.0),))
    body = _body(Body("a", "free", (1.0, 1.0), 0.3, (1.0, 1.0, 1.0), mass=2.0, inertia=3.0, loops=(loop,)), 10.0)
    assert body.loops[0].edges[0] == Arc(10.0, 20.0, 30.0, 0.5, 1.0)
    assert (body.velocity, body.inertia, body.angle) == ((10.0, 10.0, 1.0), 300.0, 0.3)


@pytest.mark.parametrize("k", [1e6, 2.0**20])
def test_the_incline_in_micrometres(k: float) -> None:
    plain, scaled = (simulate(scene) for scene in (profile("incline"), in_units(profile("incline"), k)))
    assert len(plain.events) == len(scaled.events)
    assert list(plain.events["kind"]) == list(scaled.events["kind"])
    # A gap is the difference of lengths as large as the disc and known to their rounding; an impact at speed v comes that
    # length over v earlier or later. Powers of two, which change no rounding, change no bit.
    height = plain.q[-1, 1]
    speed = np.abs(plain.events["value"][plain.events["kind"] == EventKind.IMPACT]).min()
    allowed = 0.0 if k == 2.0**20 else 2.0 * np.spacing(height) / speed
    assert np.abs(scaled.events["t"] - plain.events["t"]).max() <= allowed
    fast = (plain.events["kind"] == EventKind.IMPACT) & (plain.events["value"] < -1e-3)
    assert scaled.events["t"][fast] == pytest.approx(plain.events["t"][fast], rel=1e-12, abs=0.0)
    unit = np.array([k, k, 1.0])
    assert scaled.q[-1] / unit == pytest.approx(plain.q[-1], rel=1e-12)
    assert scaled.u[-1] / unit == pytest.approx(plain.u[-1], rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("k", few([1e6, 2.0**20], lambda k: k != 1e6))
def test_the_bench_lever_in_micrometres(k: float) -> None:
    """A tenth of a second: two dozen impacts, stick, slip, redundant contacts. Powers of two change not even a bit."""
    scene = profile("bench_lever")
    plain, scaled = (simulate(one, 0.1) for one in (scene, in_units(scene, k)))
    assert list(plain.events["kind"]) == list(scaled.events["kind"])
    assert list(plain.events["contact"]) == list(scaled.events["contact"])
    if k == 2.0**20:
        assert np.array_equal(plain.q, scaled.q)
    assert scaled.q[-1] == pytest.approx(plain.q[-1], rel=1e-12, abs=0.0)
    # Rounding of lengths over speeds: of times, not of their share.
    assert scaled.events["t"] == pytest.approx(plain.events["t"], rel=1e-12, abs=1e-15)
