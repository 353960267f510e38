"""Does a winding click let its wheel run back by what its geometry says, and slacken a mainspring wound too tight?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

import watchsim as ws
from watchsim import designs
from watchsim.simulation.trajectory import Trajectory

R, LENGTH, NOSE, APART = 3.0, 2.0, 0.1, 4.75  # mm, the defaults: 3 + 2 + 0.1 - 0.35
UNDERCUT, BANK = math.radians(10.0), math.radians(2.0)
Array = NDArray[np.float64]


def nose(angle: float) -> Array:
    return np.array([LENGTH * math.sin(angle), APART - LENGTH * math.cos(angle)])


def teeth(count: int) -> tuple[Array, Array]:
    """The root and the point of the first locking face of the drawing, with the wheel at 0°."""
    loop = next(one for one in designs.winding_click(teeth=count).scene().body("wheel").loops if not one.hole)
    corners = 1e3 * np.array([edge.start for edge in loop.edges])
    root = int(np.argmin(np.abs(corners[:, 1]) + np.abs(np.hypot(*corners.T) - 2.4)))
    return corners[root], corners[(root + 1) % len(corners)]


def least_recoil(count: int, bank: float) -> float:
    """Degrees, by the drawn corners: from where a point lets the nose off until its face meets it at the bank."""
    root, point = teeth(count)
    leaves = brentq(lambda one: np.hypot(*nose(one)) - (R + NOSE), math.radians(-80.0), 0.0)

    def at(turn: float, place: Array) -> Array:
        c, s = math.cos(turn), math.sin(turn)
        return np.array([c * place[0] - s * place[1], s * place[0] + c * place[1]])

    def gap(turn: float) -> float:
        foot, face = at(turn, root), at(turn, point - root) / np.hypot(*(point - root))
        away = nose(bank) - foot
        return float(away[0] * face[1] - away[1] * face[0]) - NOSE

    off = math.atan2(*nose(leaves)[::-1]) - math.atan2(point[1], point[0])
    return math.degrees(off - brentq(gap, off - 1.0, off))


def wound(**changed: str | float) -> tuple[Trajectory, Array]:
    """A run, and the angles of wheel and click in it."""
    scene = designs.winding_click(**changed).scene()
    run = ws.simulate(scene)
    return run, np.degrees(run.sample(np.linspace(0.0, scene.duration, 4001))[0])


@pytest.mark.parametrize("bank", [2.0, -8.0, 10.0])
@pytest.mark.parametrize("wound_for", ["0.1 s", "0.14 s", "0.18 s", "0.3 s"])
def test_it_recoils_by_the_least_and_up_to_a_pitch_more(bank: float, wound_for: str) -> None:
    run, q = wound(bank=f"{bank}°", wound_for=wound_for)
    start, end = q[0, 0], q[-1, 0]
    assert (end - start) / 20.0 == pytest.approx(round((end - start) / 20.0), abs=1e-9)
    assert q[-1, 1] == pytest.approx(bank, abs=1e-10)
    # As many points have passed the nose as the wheel had turned beyond where the first one does.
    least = least_recoil(18, math.radians(bank))
    assert 0.0 < q[:, 0].max() - end - least < 20.0
    assert run.energy["residual_relative"] < 1e-9
    assert run.worst_penetration < 1e-9


@pytest.mark.parametrize("reach", [0.35, 0.25])
def test_a_point_lets_the_nose_off_on_the_line_to_the_axis(reach: float) -> None:
    """cos β = (d² + l² - (R + r)²) / (2 d l): the furthest that the click ever swings."""
    _, q = wound(reach=f"{reach} mm", friction=0.0)
    d = R + LENGTH + NOSE - reach
    off = -math.degrees(math.acos((d**2 + LENGTH**2 - (R + NOSE) ** 2) / (2.0 * d * LENGTH)))
    assert q[:, 1].min() == pytest.approx(off, abs=2e-3)


def test_it_takes_the_tightness_out_of_the_mainspring() -> None:
    """Coils on each other at the end of the winding: nearly three times the torque. After the recoil they are free."""
    run, q = wound(friction=0.0)
    full = q[0, 0] + 120.0
    assert 0.5 + 4.0 * math.radians(q[:, 0].max() - full) > 1.35
    assert q[-1, 0] < full
    found = ws.forces(run, [run.t[-1]])
    push = found.normal[0, :, None] * found.direction[0]
    on_wheel = np.abs(np.hypot(*found.point[0].T) - 2.7e-3) < 0.4e-3
    moments = [x * fy - y * fx for (x, y), (fx, fy) in zip(found.point[0][on_wheel], push[on_wheel], strict=True)]
    assert [abs(one) for one in moments] == pytest.approx([0.5e-3], rel=1e-6)


def test_time_stepping_agrees() -> None:
    scene = designs.winding_click(wound_for="0.1 s").scene()
    true = ws.simulate(scene, tolerance=1e-11)
    for step, close in ((4e-5, 4e-3), (1e-5, 1e-3)):
        stepped = ws.simulate(scene, method="moreau", step=step)
        assert np.abs(stepped.at(0.12)[0] - true.at(0.12)[0]).max() < close
        assert stepped.end_q == pytest.approx(true.end_q, abs=1e-5)


REFUSED = [
    ({"reach": "0.6 mm"}, "else the nose meets the roots"),
    ({"bank": "-30°"}, "the nose is out of the teeth"),
    ({"winding": "0.5 mN·m"}, "does not wind the mainspring"),
    ({"teeth": 40, "nose_radius": "0.2 mm"}, "meets the back of a tooth"),
    ({"nose_radius": "0.5 mm"}, "does not meet a locking face"),
    ({"bank": "-22°"}, "does not meet a locking face"),
]


@pytest.mark.parametrize(("changed", "why"), REFUSED)
def test_what_does_not_fit_is_refused(changed: dict[str, str], why: str) -> None:
    with pytest.raises(ws.SceneError, match=why):
        designs.winding_click(**changed)
