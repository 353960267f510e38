"""What do the small kernels of gaps say, one by one? Angles and complex numbers, worked out beside them."""

from __future__ import annotations

import cmath
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact import gaps, kinematics, poses
from watchsim.contact.gaps import Shape
from watchsim.model.records import ARC, FIXED, FREE, FULL, LINE, PART, PIVOT, SLIDE
from watchsim.tolerances import TILT_ROUNDING

_inside_fan, _gap_rate, _margins = (in_python(getattr(gaps, name)) for name in ("_inside_fan", "_gap_rate", "margins_of"))
_share, _gap_acceleration, _directions = (
    in_python(kernel) for kernel in (kinematics._share, kinematics.gap_acceleration, kinematics._directions)
)


@pytest.mark.parametrize("half", [0.3, 1.2, 2.0, 2.9])
def test_how_far_inside_its_fan_a_normal_lies(half: float) -> None:
    """The sine of the angle to the nearer end; more than a right angle counts as one."""
    arc = SimpleNamespace(extent=PART, half_cos=math.cos(half), half_sin=math.sin(half))
    for angle in np.linspace(0.01, 3.13, 60):
        left = half - angle
        wanted = 0.7 * (math.sin(left) if abs(left) < 0.5 * math.pi else math.copysign(1.0, left))
        assert _inside_fan(arc, math.cos(angle), math.sin(angle), 0.7) == pytest.approx(wanted, rel=1e-9, abs=1e-12)
    arc.extent = FULL
    assert _inside_fan(arc, math.cos(3.0), math.sin(3.0), 0.7) == 0.7


@pytest.mark.parametrize("carried", [0.0, 0.9])
def test_the_rate_of_a_gap_is_that_of_both_materials(carried: float) -> None:
    """Each turns about its own origin, the contact being at one point."""
    n, arm = cmath.rect(1.0, 0.7), 0.4 - 0.9j
    shape = Shape(0.1, n.real, n.imag, 1.3, 0.2, arm.real, arm.imag)
    a = SimpleNamespace(x=1.1, y=-0.3, vx=0.6, vy=-1.7, w=carried)
    b = SimpleNamespace(x=-0.4, y=0.8, vx=2.3, vy=0.35, w=-1.4)
    point = complex(a.x, a.y) + arm
    moving = [complex(one.vx, one.vy) + 1j * one.w * (point - complex(one.x, one.y)) for one in (a, b)]
    assert _gap_rate(shape, a, b) == pytest.approx(((moving[0] - moving[1]) * n.conjugate()).real, rel=1e-13, abs=0.0)


def placed(x: float, y: float, turn: float) -> Any:
    return SimpleNamespace(x=x, y=y, c=math.cos(turn), s=math.sin(turn))


@pytest.mark.parametrize("way", [0.13, 0.58, -0.2, 0.9])
@pytest.mark.parametrize("angle", [0.35, -0.6, 1.1])
def test_how_far_inside_both_a_contact_lies(way: float, angle: float) -> None:
    """On a line so far from its nearer end; on the circle by the angle to the end of its fan."""
    pa, pb, half, length = placed(0.3, -0.8, 0.9), placed(-0.5, 0.2, -0.4), 0.8, 0.7
    start, along = -0.2 + 0.35j, cmath.rect(1.0, 1.9)
    n = -1j * along * cmath.rect(1.0, -0.4)
    point = complex(pb.x, pb.y) + (start + way * along) * cmath.rect(1.0, -0.4)
    arm = point - complex(pa.x, pa.y)
    middle = -n * cmath.rect(1.0, angle - 0.9)
    a = SimpleNamespace(extent=PART, half_cos=math.cos(half), half_sin=math.sin(half), nx=middle.real, ny=middle.imag)
    a.radius, a.length = (0.4, 0.0) if angle > 0.0 else (0.0, 2.5)
    b = SimpleNamespace(kind=LINE, x=start.real, y=start.imag, tx=along.real, ty=along.imag, length=length)
    shape = Shape(0.0, n.real, n.imag, 1.0, 0.0, arm.real, arm.imag)
    wanted = (max(a.radius, a.length) * math.sin(half - abs(angle)), min(way, length - way))
    assert _margins(None, a, b, pa, pb, shape) == pytest.approx(wanted, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("angle", [0.25, -0.5, 0.9])
def test_how_far_inside_an_arc_a_contact_lies(angle: float) -> None:
    pa, pb, half = placed(0.3, -0.8, 0.9), placed(-0.5, 0.2, -0.4), 0.7
    middle = cmath.rect(1.0, 2.2)
    n = middle * cmath.rect(1.0, angle - 0.4)
    ends = {"extent": PART, "half_cos": math.cos(half), "half_sin": math.sin(half)}
    whole = SimpleNamespace(extent=FULL, nx=0.6, ny=0.8, radius=0.3, length=0.0)
    b = SimpleNamespace(kind=ARC, nx=middle.real, ny=middle.imag, radius=1.7, **ends)
    shape = Shape(0.0, n.real, n.imag, 1.0, math.sin(angle), 0.2, 0.1)
    assert _margins(None, whole, b, pa, pb, shape) == pytest.approx(
        (0.3, 1.7 * math.sin(half - abs(angle))), rel=1e-12, abs=0.0
    )
    concentric = shape._replace(nx=0.0, ny=0.0, Q=0.0)
    assert _margins(None, whole, b, pa, pb, concentric) == (0.0, -1.7)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_of_what_lies_across_nothing_is_left(sign: float) -> None:
    for share, wanted in ((0.99, False), (1.01, True)):
        tilt = sign * share * TILT_ROUNDING
        assert (_share((tilt, 1.0), (1.0, 0.0)) != 0.0) is wanted
    assert _share((0.6, 0.8), (0.28, -0.96)) == pytest.approx(0.6 * 0.28 - 0.8 * 0.96, rel=1e-14)


def test_the_acceleration_of_a_gap() -> None:
    """As many entries as a row has; those behind do not count."""
    kin = [SimpleNamespace(bar_N=9.0), SimpleNamespace(bar_N=-0.7)]
    coord, w = np.array([[0, 0, 0], [4, 1, 0]]), np.array([[5.0, 5.0, 5.0], [0.3, -1.1, 8.0]])
    closed = SimpleNamespace(kin=kin, slots=np.array([3, 2]), coord=coord, w_N=w)
    assert _gap_acceleration(closed, 1, [50.0, 0.6, 70.0, 80.0, 2.5]) == pytest.approx(-0.7 + 0.3 * 2.5 - 1.1 * 0.6, rel=1e-14)


Q, U = np.array([0.7, -1.3, 0.45, 1.9, 5.1]), np.array([2.1, -0.6, 0.35, -1.2, 8.3])
AXIS = cmath.rect(1.0, 0.8)


@pytest.mark.parametrize("motion", [FIXED, PIVOT, SLIDE, FREE])
def test_where_a_body_is_and_how_it_moves(motion: int) -> None:
    """From the second coordinate on; geared two and a half times as fast, against it, where it can be."""
    body = SimpleNamespace(motion=motion, first=1, x=0.3, y=-0.9, c=0.6, s=0.8, carrier=-1, ratio=-2.5, phase=0.4)
    body.axis_x, body.axis_y = AXIS.real, AXIS.imag
    room = poses.poses(1)
    in_python(poses.place_body)(SimpleNamespace(bodies=[body]), 0, Q, U, room)
    pose, place = room[0], 0.3 - 0.9j
    way, speed = -2.5 * -1.3 + 0.4, -2.5 * -0.6
    at, turned, v, w = {
        FIXED: (place, 0.6 + 0.8j, 0.0j, 0.0),
        PIVOT: (place, cmath.rect(1.0, way), 0.0j, speed),
        SLIDE: (place + way * AXIS, 0.6 + 0.8j, speed * AXIS, 0.0),
        FREE: (-1.3 + 0.45j, cmath.rect(1.0, 1.9), -0.6 + 0.35j, -1.2),
    }[motion]
    found = [complex(pose.x, pose.y), complex(pose.c, pose.s), complex(pose.vx, pose.vy), complex(pose.w)]
    assert found == pytest.approx([at, turned, v, complex(w)], rel=1e-14)
    assert (pose.rx, pose.ry, pose.ax, pose.ay) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("motion", [PIVOT, SLIDE, FREE])
def test_what_is_carried_rides_along(motion: int) -> None:
    """The carrier is the first body of all; its own ratio is one, that of the body it carries is not."""
    first = 0 if motion == FREE else 1
    carrier = SimpleNamespace(motion=motion, first=first, x=0.7, y=1.6, c=0.28, s=0.96, axis_x=AXIS.real, axis_y=AXIS.imag)
    body = SimpleNamespace(motion=PIVOT, first=3, x=0.3, y=-0.9, c=0.6, s=0.8, carrier=0, ratio=-2.5, phase=0.4)
    room = poses.poses(2)
    in_python(poses.place_body)(SimpleNamespace(bodies=[carrier, body]), 1, Q, U, room)
    origin, turned, moving, w = {
        PIVOT: (0.7 + 1.6j, cmath.rect(1.0, -1.3), 0.0j, -0.6),
        SLIDE: (0.7 + 1.6j - 1.3 * AXIS, 0.28 + 0.96j, -0.6 * AXIS, 0.0),
        FREE: (0.7 - 1.3j, cmath.rect(1.0, 0.45), 2.1 - 0.6j, 0.35),
    }[motion]
    arm, pose = (0.3 - 0.9j) * turned, room[1]
    found = [complex(pose[x], pose[y]) for x, y in (("rx", "ry"), ("x", "y"), ("vx", "vy"), ("ax", "ay"), ("c", "s"))]
    wanted = [arm, origin + arm, moving + 1j * w * arm, -(w**2) * arm, cmath.rect(1.0, -2.5 * 1.9 + 0.4)]
    assert found == pytest.approx(wanted, rel=1e-14) and pose.w == pytest.approx(-2.5 * -1.2, rel=1e-14)


def two(radius: float, bend: float) -> Any:
    """A convex circle on one body by an arc on another; the contact of both is number 0."""
    out = cmath.rect(1.0, 0.6)
    point = 0.2 - 0.1j + radius * out
    half = {"extent": PART, "half_cos": math.cos(1.4), "half_sin": math.sin(1.4), "length": 0.0}
    a = SimpleNamespace(body=0, px=point.real, py=point.imag, nx=out.real, ny=out.imag, radius=radius, kind=ARC, **half)
    b = SimpleNamespace(body=1, px=0.5, py=-0.7, nx=-0.8, ny=0.6, radius=bend, kind=ARC, **half)
    contact = SimpleNamespace(a=0, b=1, curvature=1.0 / (bend + radius), reduced=0.1)
    return SimpleNamespace(contacts=[contact], primitives=[a, b])


@pytest.mark.parametrize("turn", [0.4, 1.1, 2.0])
def test_where_two_arcs_meet(turn: float) -> None:
    """On the line of their centres; how far inside they are is the less of what either says."""
    model, pose = two(0.3, 0.9), [placed(-0.9, 0.6, turn + 2.9), placed(0.4, -0.2, turn)]
    a, b = model.primitives
    centre = complex(pose[0].x, pose[0].y) + (0.2 - 0.1j) * complex(pose[0].c, pose[0].s)
    middle = complex(pose[1].x, pose[1].y) + (0.5 - 0.7j + 0.9 * (0.8 - 0.6j)) * complex(pose[1].c, pose[1].s)
    n = (centre - middle) / abs(centre - middle)
    assert complex(*in_python(gaps.contact_point)(model, 0, pose)) == pytest.approx(centre - 0.3 * n, rel=1e-12, abs=0.0)
    shape = in_python(gaps.shape_of_contact)(model.contacts[0], a, b, *pose)
    own = complex(b.nx, b.ny) * complex(pose[1].c, pose[1].s)
    assert shape.gap == pytest.approx(abs(centre - middle) - 1.2, rel=1e-12)
    assert shape.foot == pytest.approx((n / own).imag, rel=1e-9)
    both = in_python(gaps.extent_margins)(model, 0, pose)
    assert both[0] != both[1] and in_python(gaps.extent_margin)(model, 0, pose) == min(both)


@pytest.mark.parametrize(("off", "known"), [(0.0, False), (1e-4, True)])
def test_in_the_middle_of_a_bite_there_is_no_normal(off: float, known: bool) -> None:
    """A tenth of a millimetre beside it there is."""
    a = SimpleNamespace(px=0.25, py=0.0, nx=1.0, ny=0.0, radius=0.25)
    b = SimpleNamespace(px=-0.75, py=0.0, nx=1.0, ny=0.0)
    shape = in_python(gaps.shape_of_contact)(
        SimpleNamespace(curvature=-2.0), a, b, placed(off, 0.0, 0.0), placed(0.0, 0.0, 0.0)
    )
    assert shape.gap == pytest.approx(0.5 - off, rel=1e-12)
    assert (shape.nx, shape.ny) == pytest.approx((-1.0, 0.0) if known else (0.0, 0.0), abs=1e-12)
    if not known:
        assert shape == (0.5, 0.0, 0.0, 0.0, 0.0, 0.25, 0.0)


@pytest.mark.parametrize("motion", [FIXED, PIVOT, SLIDE, FREE])
def test_how_a_contact_feels_the_coordinates_of_a_body(motion: int) -> None:
    """Behind the two entries that the row has: what each coordinate alone moves the contact along normal and tangent."""
    closed, n, arm, sign = kinematics.closed_contacts(2), cmath.rect(1.0, 0.7), 0.4 - 0.9j, -1.5
    closed.slots[:] = 2
    body = SimpleNamespace(motion=motion, first=3, axis_x=AXIS.real, axis_y=AXIS.imag, ratio=-2.5)
    _directions(SimpleNamespace(bodies=[None, body]), 1, 1, sign, (n.real, n.imag, arm.real, arm.imag), closed)
    ways = {FIXED: {}, PIVOT: {3: 1j * arm}, SLIDE: {3: AXIS}, FREE: {3: 1.0, 4: 1j, 5: 1j * arm}}[motion]
    assert closed.slots.tolist() == [2, 2 + len(ways)] and not closed.w_N[0].any()
    assert closed.coord[1, 2 : 2 + len(ways)].tolist() == list(ways)
    for j, way in enumerate(ways.values()):
        felt = sign * -2.5 * way / n
        assert (closed.w_N[1, 2 + j], closed.w_T[1, 2 + j]) == pytest.approx((felt.real, felt.imag), rel=1e-13, abs=0.0)
    assert not closed.w_N[1, 2 + len(ways) :].any() and not closed.w_T[1, :2].any()
