"""Are gaps, rates, force directions and bar terms what difference quotients and brute-force distances say?"""

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from naive.distance_oracle import chords, nearest
from pair_scenes import DEGREES, KINDS, MOTIONS, Kin, body_pose, contacts_of_kind, kind_of, pose_at, two_bodies
from plain_kernels import in_python

from watchsim.contact.gaps import closed_contacts, contact_kinematics, normal_gap, place, poses
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Edge, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import ARC, CORNER, LINE
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.tolerances import SPIN_ROUNDING

# Are gaps, rates, force directions and bar terms what difference quotients and brute-force distances say?

PAIRS = [(a, b) for a, b in itertools.product(MOTIONS, MOTIONS) if (a, b) != ("fixed", "fixed")]
STEP = 1e-3  # of a five-point quotient: its error is of order STEP^4
SPACING = 0.02
BAND = 1e-6  # m: contacts this close to the end of a primitive are not asked which side they are on

_normal_gap = callable_kernel(normal_gap)
motions = st.lists(st.floats(-3.0, 3.0), min_size=12, max_size=12)
checked = settings(suppress_health_check=[HealthCheck.filter_too_much])


def quotient(function, x: float = 0.0):
    """Derivative at x by five points."""
    h = STEP
    return (8.0 * (function(x + h) - function(x - h)) - (function(x + 2 * h) - function(x - 2 * h))) / (12.0 * h)


def drawn(motion_a: str, motion_b: str, numbers: list[float]) -> tuple[np.ndarray, np.ndarray]:
    n = DEGREES[motion_a] + DEGREES[motion_b]
    return np.array(numbers[:n]), np.array(numbers[6 : 6 + n])


def centre_distance(compiled: Compiled, k: int, q: np.ndarray, u: np.ndarray) -> float:
    """Distance of the centres of a centre-centre contact, else 1: at 0 there is no normal."""
    contact = compiled.model.contacts[k]
    a, b = compiled.model.primitives[contact.a], compiled.model.primitives[contact.b]
    if b.kind == LINE:
        return 1.0
    at = [
        (p.x + p.c * i.x - p.s * i.y, p.y + p.s * i.x + p.c * i.y) for i in (a, b) for p in (pose_at(compiled, q, u)[i.body],)
    ]
    return math.dist(*at)


@pytest.mark.parametrize("kind", KINDS)
def test_rates_directions_and_bar_terms(kind: str) -> None:
    """For all motions of both bodies; every quotient is of something simpler than what it is compared with."""

    @checked
    @given(st.sampled_from(PAIRS), st.integers(0, 1000), motions)
    def check(pair: tuple[str, str], choice: int, numbers: list[float]) -> None:
        compiled = two_bodies(*pair)[1]
        ids = contacts_of_kind(*pair, kind)
        k = ids[choice % len(ids)]
        q, u = drawn(*pair, numbers)
        assume(centre_distance(compiled, k, q, u) > 0.2)
        kin = Kin(compiled, k, q, u)
        scale = 1.0 + float(np.abs(u).max()) ** 2
        assert kin.w_N @ u == pytest.approx(kin.gN_dot, abs=1e-13 * scale)
        assert kin.w_T @ u == pytest.approx(kin.gT_dot, abs=1e-13 * scale)
        for j in range(len(q)):
            unit = np.eye(len(q))[j]
            slope = quotient(lambda s, e=unit: Kin(compiled, k, q + s * e, u).g)
            assert kin.w_N[j] == pytest.approx(slope, abs=1e-8)
        along = [lambda s, name=name: getattr(Kin(compiled, k, q + s * u, u), name) for name in ("g", "gN_dot", "gT_dot")]
        truth = [quotient(function) for function in along]
        assert [kin.gN_dot, kin.bar_N, kin.bar_T] == pytest.approx(truth, abs=3e-7 * scale**3)

    check()


@pytest.mark.parametrize("kind", KINDS)
def test_slip_is_the_relative_velocity_of_the_touching_material(kind: str) -> None:
    @checked
    @given(st.sampled_from(PAIRS), st.integers(0, 1000), motions)
    def check(pair: tuple[str, str], choice: int, numbers: list[float]) -> None:
        scene, compiled = two_bodies(*pair)
        ids = contacts_of_kind(*pair, kind)
        k = ids[choice % len(ids)]
        q, u = drawn(*pair, numbers)
        assume(centre_distance(compiled, k, q, u) > 0.05)
        kin = Kin(compiled, k, q, u)
        _, _, nx, ny = _normal_gap(compiled.model, k, pose_at(compiled, q, u))
        contact = compiled.model.contacts[k]
        circle, other = ("ab"[compiled.model.primitives[i].body] for i in (contact.a, contact.b))

        def carried(name: str, s: float) -> np.ndarray:
            """Where the material of a body that is at the contact point now will be after time s."""
            x, y, angle = body_pose(scene, name, q)
            X, Y, turned = body_pose(scene, name, q + s * u)
            c, sine = math.cos(turned - angle), math.sin(turned - angle)
            dx, dy = kin.point - (x, y)
            return np.array([X + c * dx - sine * dy, Y + sine * dx + c * dy])

        velocity = quotient(lambda s: carried(circle, s) - carried(other, s))
        assert math.hypot(nx, ny) == pytest.approx(1.0, abs=1e-14)
        assert kin.gT_dot == pytest.approx(float(velocity @ (-ny, nx)), abs=1e-8 * (1.0 + np.abs(u).max()))

    check()


def edges_of(compiled: Compiled, scene, number: int) -> list[Edge]:
    """The edge that a primitive record stands for; for a corner, both its neighbours."""
    p = compiled.model.primitives[number]
    found = []
    for edge in scene.bodies[p.body].loops[0].edges:
        if p.kind == ARC and isinstance(edge, Arc):
            near = math.dist((edge.x, edge.y), (p.x, p.y)) < 1e-12 and abs(edge.radius - p.radius) < 1e-12
        elif p.kind == LINE and not isinstance(edge, Arc):
            near = math.dist(edge.start, (p.x, p.y)) < 1e-12
        else:
            near = p.kind == CORNER and min(math.dist(end, (p.x, p.y)) for end in (edge.start, edge.end)) < 1e-12
        if near:
            found.append(edge)
    return found


def distance_to(edge: Edge, point: np.ndarray) -> float:
    """Exact distance of a point from an edge, in the body's frame."""
    if isinstance(edge, Arc):
        angle = math.atan2(point[1] - edge.y, point[0] - edge.x)
        low = min(edge.start_angle, edge.start_angle + edge.sweep)
        if (angle - low) % (2.0 * math.pi) <= abs(edge.sweep):
            return abs(math.dist(point, (edge.x, edge.y)) - edge.radius)
        return min(math.dist(point, edge.start), math.dist(point, edge.end))
    start, way = np.array(edge.start), np.subtract(edge.end, edge.start)
    share = float(np.clip((point - start) @ way / (way @ way), 0.0, 1.0))
    return math.dist(point, start + share * way)


def in_body(scene, name: str, q: np.ndarray, point: np.ndarray) -> np.ndarray:
    x, y, angle = body_pose(scene, name, q)
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = point - (x, y)
    return np.array([c * dx + s * dy, -s * dx + c * dy])


@pytest.mark.parametrize("kind", KINDS)
def test_margin_says_whether_the_contact_lies_inside_both_primitives(kind: str) -> None:
    """A point just off the surface, along the normal, is nearest to the contact point exactly when that is inside."""
    off = 1e-2

    @checked
    @given(st.sampled_from(PAIRS), st.integers(0, 1000), motions)
    def check(pair: tuple[str, str], choice: int, numbers: list[float]) -> None:
        scene, compiled = two_bodies(*pair)
        ids = contacts_of_kind(*pair, kind)
        k = ids[choice % len(ids)]
        q, u = drawn(*pair, numbers)
        assume(centre_distance(compiled, k, q, u) > 1e-3)
        kin = Kin(compiled, k, q, u)
        assume(abs(kin.margin) > BAND)
        contact = compiled.model.contacts[k]
        normal = np.array(_normal_gap(compiled.model, k, pose_at(compiled, q, u))[2:])
        inside = []
        for number, foot, side in ((contact.a, kin.point, -1.0), (contact.b, kin.point - kin.g * normal, 1.0)):
            name = "ab"[compiled.model.primitives[number].body]
            local = in_body(scene, name, q, foot + side * off * normal)
            found = min(distance_to(edge, local) for edge in edges_of(compiled, scene, number))
            inside.append(abs(found - off) < 1e-12)
        assert (kin.margin > 0.0) == all(inside)

    check()


@checked
@given(motions)
def test_smallest_valid_gap_is_the_distance_of_the_bodies(numbers: list[float]) -> None:
    scene, compiled = two_bodies("fixed", "free")
    q = np.array([numbers[0] / 3.0 + 0.5, numbers[1] / 3.0, numbers[2]])
    a, b = (body.loops for body in scene.bodies)
    found = nearest(a, body_pose(scene, "a", q), b, body_pose(scene, "b", q), SPACING)
    assume(found.gap > 0.05)
    allowed = SPACING**2 / (2.0 * found.gap) + SPACING**2 / 0.6
    everything = [Kin(compiled, k, q, np.zeros(3)) for k in range(len(compiled.model.contacts))]
    valid = [kin.g for kin in everything if kin.margin >= 0.0 and kin.g > 0.0]
    assert min(valid, default=math.inf) > found.gap - allowed
    near = []
    for body, on in enumerate((found.on_a, found.on_b)):
        local = in_body(scene, "ab"[body], q, on)
        corners = [p for p in compiled.model.primitives if p.kind == CORNER and p.body == body]
        near.append(min(math.dist(local, (p.x, p.y)) for p in corners))
    # A corner against a corner is left to their neighbours.
    assume(max(near) > 2.0 * SPACING)
    assert min(valid) == pytest.approx(found.gap, abs=allowed)


def test_every_kind_occurs() -> None:
    scene, compiled = two_bodies("free", "free")
    assert {kind_of(compiled, k) for k in range(len(compiled.model.contacts))} >= set(KINDS)
    assert len(chords(scene.bodies[0].loops, (0.0, 0.0, 0.0), SPACING)) > 50


# How large are the vectors that the bar terms of a contact are made of? Two outlines, worked out with complex numbers.

_kinematics, _place = in_python(contact_kinematics), in_python(place)
SMALL, LARGE = 0.3, 1.1  # m
OFF_SMALL, OFF_LARGE = 0.2 - 0.5j, -0.4 + 0.7j  # of the middles, from the bodies' origins
Pose = tuple[float, float, float]


def round_loop(radius: float, centre: complex, hole: bool = False) -> Loop:
    return Loop((Arc(centre.real, centre.imag, radius, 0.3, -TURN if hole else TURN),), hole=hole)


def row(a: Loop, pose_a: Pose, rates_a: Pose, b: Loop, pose_b: Pose, rates_b: Pose) -> Any:
    """Kinematics of the only contact of two free bodies."""
    bodies = tuple(Body(name, "free", mass=1.0, inertia=1.0, loops=(loop,)) for name, loop in (("a", a), ("b", b)))
    model = compile_scene(Scene("two", bodies, contacts=(Contact((Side("a"), Side("b"))),))).model
    pose, closed = poses(2), closed_contacts(1)
    _place(model, np.array((*pose_a, *pose_b)), np.array((*rates_a, *rates_b)), pose)
    _kinematics(model, 0, pose, 0, closed)
    return closed.kin[0]


def out(pose: Pose, point: complex) -> complex:
    return complex(*pose[:2]) + point * np.exp(1j * pose[2])


def speed(pose: Pose, rates: Pose, point: complex) -> complex:
    """Of the material at that place in the world."""
    return complex(*rates[:2]) + 1j * rates[2] * (point - complex(*pose[:2]))


def taxi(way: complex) -> float:
    return abs(way.real) + abs(way.imag)


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_of_two_circles(hollow: bool, seed: int) -> None:
    """The normal turns with the line of centres; the contact travels along the smaller circle by what that does not turn."""
    rng = np.random.default_rng(seed)
    (pose_a, rates_a, rates_b), pose_b = rng.normal(size=(3, 3)), (0.3, 0.1, 0.8)
    if hollow:  # within a hole: the normal points to the hole's middle
        pose_a = np.array([0.2, -0.3, 1.7])
    found = row(
        round_loop(SMALL, OFF_SMALL), tuple(pose_a), tuple(rates_a),
        round_loop(LARGE, OFF_LARGE, hollow), pose_b, tuple(rates_b),
    )  # fmt: skip
    small, large = out(tuple(pose_a), OFF_SMALL), out(pose_b, OFF_LARGE)
    apart, moving = small - large, speed(tuple(pose_a), tuple(rates_a), small) - speed(pose_b, tuple(rates_b), large)
    turning = float((moving / apart).imag)
    n = (-1.0 if hollow else 1.0) * apart / abs(apart)
    point = small - SMALL * n
    slip = (speed(tuple(pose_a), tuple(rates_a), point) - speed(pose_b, tuple(rates_b), point)) / n
    w_a, w_b = rates_a[2], rates_b[2]
    size = (abs(turning) + abs(w_b)) * taxi(slip) + abs(w_a - w_b) * SMALL * abs(turning - w_a)
    size += w_a**2 * taxi(point - complex(*pose_a[:2])) + w_b**2 * taxi(point - complex(*pose_b[:2]))
    assert found.bar_size == pytest.approx(size, rel=1e-12, abs=0.0)
    assert (found.x, found.y) == pytest.approx((point.real, point.imag), rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("y", "turn"), [(0.9, 0.4), (-0.2, 2.5)])
def test_of_a_circle_over_a_line(y: float, turn: float) -> None:
    """The normal is the line's own, on the right of its way."""
    pose_a, rates_a = (0.3, y, turn), (0.7, -0.2, 1.3)
    pose_b, rates_b = (-0.5, 0.1, 0.35), (0.15, 0.45, -0.6)
    line = Loop((Line(4.0, 0.25, -4.0, 0.25),), closed=False)
    found = row(round_loop(SMALL, OFF_SMALL), pose_a, rates_a, line, pose_b, rates_b)
    n = 1j * np.exp(1j * pose_b[2])
    point = out(pose_a, OFF_SMALL) - SMALL * n
    slip = (speed(pose_a, rates_a, point) - speed(pose_b, rates_b, point)) / n
    size = 2.0 * 0.6 * taxi(slip) + 1.9 * SMALL * 1.9
    size += 1.3**2 * taxi(point - complex(*pose_a[:2])) + 0.6**2 * taxi(point - complex(*pose_b[:2]))
    assert found.bar_size == pytest.approx(size, rel=1e-12)


@pytest.mark.parametrize("swapped", [False, True])
def test_bodies_that_travel_flush_leave_what_rounding_may_turn_them_by(swapped: bool) -> None:
    """The square of that spin, over the two arms; the longer arm belongs to either body."""
    near, far = (0.1, 0.2, 0.0), (-3.0, 0.5, 0.0)
    pose_a, pose_b = (far, near) if swapped else (near, far)
    centre = complex(0.3, 0.9) - complex(*pose_a[:2])
    line = Loop((Line(9.0, 0.6 - pose_b[1], -9.0, 0.6 - pose_b[1]),), closed=False)
    rates_a, rates_b = (-3.0, 0.7, 0.0), (-3.0, 0.7, 0.0)
    found = row(round_loop(SMALL, centre), pose_a, rates_a, line, pose_b, rates_b)
    point = complex(0.3, 0.6)
    arms = taxi(point - complex(*pose_a[:2])) + taxi(point - complex(*pose_b[:2]))
    assert found.g == pytest.approx(0.0, abs=1e-12)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 7.4) ** 2 / arms, rel=1e-12, abs=0.0)


def test_each_speed_counts_by_its_size() -> None:
    """Along both axes and of both bodies: bodies that slide past one another without any spin."""
    line, rates_a, rates_b = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False), (-5.0, -0.7, 0.0), (-2.0, -11.0, 0.0)
    found = row(round_loop(SMALL, 0.5j), (0.0, 0.0, 0.0), rates_a, line, (-0.4, 0.1, 0.0), rates_b)
    arms = 0.2 + (0.4 + 0.1)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 18.7) ** 2 / arms, rel=1e-12, abs=0.0)


def test_short_arms_count_as_long_ones_do() -> None:
    """The contact lies a tenth of a millimetre from one origin and three from the other."""
    line, rates = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False), (-5.0, 0.6, 0.0)
    found = row(round_loop(SMALL, 1e-4 + 0.3j), (0.0, 0.0, 0.0), rates, line, (-2e-4, 0.0, 0.0), rates)
    assert found.bar_size == pytest.approx((SPIN_ROUNDING * 11.2) ** 2 / 4e-4, rel=1e-9, abs=0.0)


def test_without_an_arm_nothing_turns() -> None:
    """A corner at its body's origin, on a line through the origin of the other."""
    line = Loop((Line(9.0, 0.0, -9.0, 0.0),), closed=False)
    wedge = Loop((Line(-1.0, 2.0, 0.0, 0.0), Line(0.0, 0.0, 1.0, 2.0)), closed=False)
    found = row(wedge, (0.4, 0.7, 0.0), (3.0, 2.0, 0.0), line, (0.4, 0.7, 0.0), (3.0, 2.0, 0.0))
    assert found.bar_size == 0.0 and math.isfinite(found.bar_N)
