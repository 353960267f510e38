"""Is every touch found: grazes of a nanometre, thin blades hit fast, corners hit almost exactly?"""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from moving_scenes import box, circle, ground, of_kind, polygon, tip, touching
from scipy.optimize import minimize_scalar

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.body import Body
from watchsim.scene.force import Damping, Spring
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

NANOMETRE = 1e-9
QUADRATIC = 1e-16  # too weak to matter, but enough to take the exact flights away


def graze_of_two(depth: float, coupled: bool, speeds: tuple[float, float] = (7.0, -11.0)) -> tuple[Scene, float]:
    """The round pins of two rotors pass one another with this overlap at the closest point; scene and time of that."""
    shift, reach, arm = 2.3e-3, 1.0e-3, 1.5e-3

    def centre(t: float) -> float:
        """Distance of the pins' centres."""
        a, b = -2.0 + speeds[0] * t, math.pi + 3.1 + speeds[1] * t
        return math.hypot(shift + arm * math.cos(b) - reach * math.cos(a), arm * math.sin(b) - reach * math.sin(a))

    times = np.linspace(0.0, 0.6, 20001)
    near = times[np.argmin([centre(t) for t in times])]
    best = minimize_scalar(centre, bounds=(near - 1e-4, near + 1e-4), method="bounded", options={"xatol": 1e-15})
    small = 0.3 * best.fun
    pin = circle(best.fun - small + depth, (arm, 0.0))
    bodies = (
        Body("post", "pivot", (0.0, 0.0), -2.0, (speeds[0],), inertia=1e-12, loops=(circle(small, (reach, 0.0)),)),
        Body("pin", "pivot", (shift, 0.0), math.pi + 3.1, (speeds[1],), inertia=3e-12, loops=(pin,)),
    )
    damping = (Damping("post", 0.0, QUADRATIC * 1e-6),) if coupled else ()
    return Scene("graze", bodies, damping=damping, contacts=touching("post", "pin")), float(best.x)


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("depth", [-NANOMETRE, -1e-12, 1e-12, NANOMETRE])
def test_two_rotors_graze(depth: float, coupled: bool) -> None:
    """The pin misses by a nanometre, or picometre, or touches by as much."""
    scene, closest = graze_of_two(depth, coupled)
    done = simulate(scene, closest + 0.02)
    impacts = of_kind(done, EventKind.IMPACT)
    assert done.stop == Stop.DURATION
    assert done.worst_penetration < 1e-12
    if depth < 0.0:
        assert len(impacts) == 0
        assert done.u[-1] == pytest.approx(scene.bodies[0].velocity + scene.bodies[1].velocity, rel=1e-9)
    else:
        assert len(impacts) >= 1
        # It touches a little before the closest point: by sqrt(2 depth / relative acceleration).
        assert closest - 1e-3 < impacts[0]["t"] < closest


@pytest.mark.parametrize("coupled", [False, True])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_pin_strikes_a_thorn_and_stays_with_it(coupled: bool, restitution: float) -> None:
    """The pin of a fast rotor catches the flank of another one's thorn and pushes it away: time goes on."""
    bodies = (
        Body("thorn", "pivot", (0.0, 0.0), -2.0, (7.0,), inertia=1e-12, loops=(tip(1e-3),)),
        Body("pin", "pivot", (2.3e-3, 0.0), math.pi + 3.1, (-11.0,), inertia=3e-12, loops=(circle(0.1e-3, (1.5e-3, 0.0)),)),
    )
    damping = (Damping("thorn", 0.0, QUADRATIC * 1e-6),) if coupled else ()
    scene = Scene("catch", bodies, damping=damping, contacts=touching("thorn", "pin", restitution=restitution))
    done = simulate(scene, 2.0)
    assert done.stop == Stop.DURATION
    assert of_kind(done, EventKind.IMPACT)
    assert done.worst_penetration < 1e-12
    assert abs(done.energy["residual_J"]) < 1e-9 * 0.5 * (1e-12 * 49.0 + 3e-12 * 121.0)


@pytest.mark.parametrize("depth", [-NANOMETRE, NANOMETRE])
@pytest.mark.parametrize("amplitude", [0.3, 4.0])
def test_a_swinging_corner_grazes_a_line(depth: float, amplitude: float) -> None:
    """A sprung rotor brushes a fixed line with its thorn at full speed, half way through an exact flight."""
    reach = 1e-3
    fence = Loop((Line(reach + depth, 0.01, reach + depth, -0.01),), closed=False)
    rotor = Body("rotor", "pivot", (0.0, 0.0), -amplitude, (0.0,), inertia=1e-9, loops=(tip(reach),))
    scene = Scene(
        "fence",
        (rotor, Body("fence", "fixed", loops=(fence,))),
        springs=(Spring("rotor", 1e-9 * (8.0 * math.pi) ** 2),),
        contacts=touching("rotor", "fence"),
    )
    done = simulate(scene, 0.2)
    impacts = of_kind(done, EventKind.IMPACT)
    assert (len(impacts) > 0) == (depth < 0.0)
    if depth > 0.0:
        assert done.q[-1][0] == pytest.approx(-amplitude * math.cos(8.0 * math.pi * 0.2), rel=1e-12, abs=0.0)
    else:
        assert impacts[0]["t"] == pytest.approx(1.0 / 16.0, abs=1e-3)


def test_a_tangent_pass_of_a_sliding_body() -> None:
    """A slider's corner passes over a fixed round post by a nanometre, or brushes it."""
    for depth, hits in ((NANOMETRE, False), (-NANOMETRE, True)):
        knife = polygon((0.0, 0.0), (1e-4, 2e-3), (-1e-4, 2e-3))
        slider = Body("slider", "slide", (-0.01, 1e-3 + depth), velocity=(3.0,), mass=1e-3, loops=(knife,))
        scene = Scene("post", (slider, Body("post", "fixed", loops=(circle(1e-3),))), contacts=touching("slider", "post"))
        done = simulate(scene, 0.01)
        assert bool(of_kind(done, EventKind.IMPACT)) == hits
        if hits:
            # It meets the post where that is `depth` below the top: x = -sqrt(2 R depth).
            assert of_kind(done, EventKind.IMPACT)[0]["t"] == pytest.approx((0.01 - math.sqrt(2e-3 * -depth)) / 3.0, rel=1e-9)


@pytest.mark.parametrize("speed", [1.0, 30.0, 1000.0, 1e6])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_thin_blade_is_not_run_through(speed: float, restitution: float) -> None:
    """A blade of one micrometre, hit by a bullet's corner after a long flight in one step."""
    bullet = polygon((1e-3, 0.0), (-1e-3, 0.5e-3), (-1e-3, -0.5e-3))
    blade = box(1e-6, 4e-3)
    bodies = (
        Body("bullet", "slide", (-0.2, 1e-5), velocity=(speed,), mass=1e-3, loops=(bullet,)),
        Body("blade", "fixed", (0.0, 0.0), loops=(blade,)),
    )
    scene = Scene("blade", bodies, contacts=touching("bullet", "blade", restitution=restitution))
    done = simulate(scene, 0.5 / speed)
    hit = (0.2 - 1e-3 - 0.5e-6) / speed
    impacts = of_kind(done, EventKind.IMPACT)
    assert len(impacts) == 1
    assert impacts[0]["t"] == pytest.approx(hit, rel=1e-12)
    assert done.u[-1][0] == pytest.approx(-restitution * speed, rel=1e-12, abs=1e-15 * speed)
    assert done.worst_penetration < 1e-12


@pytest.mark.parametrize("coupled", [False, True])
def test_a_rotor_hits_a_thin_blade(coupled: bool) -> None:
    """At 2000 rad/s the thorn moves at 2 m/s and could cross the blade in half a microsecond."""
    blade = box(1e-6, 0.5e-3, (0.0, 0.9e-3))
    rotor = Body("rotor", "pivot", (0.0, 0.0), 0.0, (2000.0,), inertia=1e-10, loops=(tip(1e-3),))
    damping = (Damping("rotor", 0.0, 1e-22),) if coupled else ()
    scene = Scene(
        "blade",
        (rotor, Body("blade", "fixed", loops=(blade,))),
        damping=damping,
        contacts=touching("rotor", "blade", restitution=0.3),
    )
    done = simulate(scene, 1.2e-3)
    impacts = of_kind(done, EventKind.IMPACT)
    # The thorn's shoulder comes first.
    x, y = 0.7e-3, 0.1e-3
    assert impacts[0]["t"] == pytest.approx(
        (math.acos(0.5e-6 / math.hypot(x, y)) - math.atan2(y, x)) / 2000.0, rel=1e-9, abs=0.0
    )
    assert -600.01 < done.u[-1][0] <= -599.99


@pytest.mark.parametrize("aside", [-1e-10, -1e-11, -1e-12, 0.0, 1e-12, 1e-11, 1e-10])
def test_a_thorn_falls_on_a_corner(aside: float) -> None:
    """Corner on corner has no normal; lines beside it take over. Whatever is hit, nothing goes through."""
    thorn = polygon((0.0, 0.0), (0.4e-3, 1e-3), (-0.4e-3, 1e-3))
    post = Body("post", "fixed", loops=(box(1e-3, 1e-3, (-0.5e-3, -0.5e-3)),))
    body = Body("thorn", "slide", (aside, 2e-3), axis=(0.0, -1.0), velocity=(0.0,), mass=1e-6, loops=(thorn,))
    scene = Scene("corner", (body, post), contacts=touching("thorn", "post", restitution=0.2), gravity=(0.0, -9.81))
    done = simulate(scene, 0.1)
    impacts = of_kind(done, EventKind.IMPACT)
    assert impacts, "it fell through"
    assert impacts[0]["t"] == pytest.approx(math.sqrt(2.0 * 2e-3 / 9.81), rel=1e-6)
    # To the right of the post's corner the thorn's flank meets it a little lower.
    lowest = 2e-3 + max(0.0, aside) * 2.5
    assert done.q[:, 0].max() <= lowest + 1e-9
    assert done.u[-1][0] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("aside", [-1e-10, 0.0, 1e-10])
def test_a_disc_falls_on_a_corner(aside: float) -> None:
    """The corner's fan of normals begins where the faces' end: at the seam nothing may be lost or counted twice."""
    R, H = 1e-3, 5e-3
    disc = Body("disc", "free", (aside, R + H), mass=1e-6, inertia=0.5e-12, loops=(circle(R),))
    post = Body("post", "fixed", loops=(box(4e-3, 1e-3, (-2e-3, -0.5e-3)),))
    scene = Scene("seam", (disc, post), contacts=touching("disc", "post", restitution=0.5), gravity=(0.0, -9.81))
    fall = math.sqrt(2.0 * H / 9.81)
    done = simulate(scene, 1.5 * fall)
    impacts = of_kind(done, EventKind.IMPACT)
    assert impacts[0]["t"] == pytest.approx(fall, rel=1e-9)
    _, u = done.at(1.1 * fall)
    v = 9.81 * fall
    assert u[1] == pytest.approx(0.5 * v - 9.81 * 0.1 * fall, rel=1e-6)
    assert u[0] == pytest.approx(max(0.0, aside) / R * 1.5 * v, abs=1e-9 * v)


def test_many_balls_in_a_row_on_the_ground() -> None:
    """Every one of eight balls, dropped from different heights, bounces when it should."""
    heights = [0.01 * (k + 1) for k in range(8)]
    balls = tuple(
        Body(f"ball{k}", "free", (0.03 * k, 0.01 + h), mass=0.1, inertia=1e-5, loops=(circle(0.01),))
        for k, h in enumerate(heights)
    )
    contacts = tuple(touching(ball.name, "ground", restitution=0.8)[0] for ball in balls)
    done = simulate(Scene("balls", (*balls, ground()), contacts=contacts, gravity=(0.0, -9.81)), 0.3)
    for k, h in enumerate(heights):
        first = math.sqrt(2.0 * h / 9.81)
        mine = [event["t"] for event in of_kind(done, EventKind.IMPACT) if done.pairs[event["contact"]].body_a == f"ball{k}"]
        expected = [first * (1.0 + 2.0 * sum(0.8**j for j in range(1, n + 1))) for n in range(20)]
        expected = [t for t in expected if t < 0.3]
        assert mine == pytest.approx(expected, rel=1e-9)


LONG_FLIGHT = """
from moving_scenes import profile
from watchsim.candidates import cell_grid
from watchsim.simulation.simulate import simulate
cell_grid.FEW_CONTACTS = 10**9
print(simulate(profile("bench_lever"), 0.05).stop.name)
"""


def test_the_search_always_advances() -> None:
    """Far down a long flight a gap closes by more within one rounding step of time than counts as zero: no endless loop.

    In a process of its own, since a compiled loop that stands still cannot be interrupted.
    """
    paths = f"import sys; sys.path[:0] = {sys.path!r}\n"
    done = subprocess.run([sys.executable, "-c", paths + LONG_FLIGHT], capture_output=True, text=True, timeout=600, check=True)
    assert done.stdout.split() == ["DURATION"]


def test_a_face_is_no_contact_from_behind() -> None:
    """Thrown up through an open floor from below, a ball meets nothing; falling back on it from above, it bounces."""
    radius, up, depth, g = 0.01, 5.0, 0.1, 9.81
    ball = Body("ball", "free", (0.0, -depth), velocity=(0.0, up, 0.0), mass=0.1, inertia=1e-5, loops=(circle(radius),))
    scene = Scene("floor", (ball, ground()), contacts=touching("ball", "ground", restitution=0.8), gravity=(0.0, -g))
    done = simulate(scene, 1.2)
    back = (up + math.sqrt(up**2 - 2.0 * g * (depth + radius))) / g
    (hit,) = of_kind(done, EventKind.IMPACT)
    assert hit["t"] == pytest.approx(back, rel=1e-9)
    assert done.u[-1][1] == pytest.approx(0.8 * math.sqrt(up**2 - 2.0 * g * (depth + radius)) - g * (1.2 - back), rel=1e-8)
