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
_share, _gap_acceleration = in_python(kinematics._share), in_python(kinematics.gap_acceleration)


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
    assert _gap_rate(shape, a, b) == pytest.approx(((moving[0] - moving[1]) * n.conjugate()).real, rel=1e-13)


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
    assert _margins(None, a, b, pa, pb, shape) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("angle", [0.25, -0.5, 0.9])
def test_how_far_inside_an_arc_a_contact_lies(angle: float) -> None:
    pa, pb, half = placed(0.3, -0.8, 0.9), placed(-0.5, 0.2, -0.4), 0.7
    middle = cmath.rect(1.0, 2.2)
    n = middle * cmath.rect(1.0, angle - 0.4)
    ends = {"extent": PART, "half_cos": math.cos(half), "half_sin": math.sin(half)}
    whole = SimpleNamespace(extent=FULL, nx=0.6, ny=0.8, radius=0.3, length=0.0)
    b = SimpleNamespace(kind=ARC, nx=middle.real, ny=middle.imag, radius=1.7, **ends)
    shape = Shape(0.0, n.real, n.imag, 1.0, math.sin(angle), 0.2, 0.1)
    assert _margins(None, whole, b, pa, pb, shape) == pytest.approx((0.3, 1.7 * math.sin(half - abs(angle))), rel=1e-12)
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


Q, U = np.array([0.7, -1.3, 0.45, 1.9]), np.array([2.1, -0.6, 0.35, -1.2])
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
