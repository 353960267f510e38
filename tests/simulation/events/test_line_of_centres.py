"""Is motion smooth where friction has no lever arm, or one parallel to that of the normal force, in every orientation?"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import FORWARD, OPEN, STICK
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.events import dead_centre
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

MM = 1e-3


def turned(points: list[tuple[float, float]], angle: float) -> Loop:
    """A polygon (mm), turned in its own frame."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(MM * (x * c - y * s), MM * (x * s + y * c)) for x, y in points]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


def blade(tilt: float, drawn: tuple[float, float] = (0.0, 0.0), friction: float = 0.12) -> Scene:
    """A tooth's tip pushes a radial blade past the line of centres; `tilt` turns all, `drawn` each outline in its own frame."""
    wheel = turned([(0.0, 2.4), (-0.3, 1.8), (-0.05, 1.8)], drawn[0])
    face = turned([(0.0, -1.08), (0.1, -1.08), (0.1, -0.6), (0.0, -0.6)], drawn[1])
    apart, eight, five = 3.372e-3, math.radians(8.0), math.radians(-5.0)
    bodies = (
        Body("wheel", "pivot", (0.0, 0.0), eight + tilt - drawn[0], inertia=5e-12, loops=(wheel,)),
        Body(
            "balance",
            "pivot",
            (-apart * math.sin(tilt), apart * math.cos(tilt)),
            five + tilt - drawn[1],
            velocity=(math.radians(3000.0),),
            inertia=1.2e-9,
            loops=(face,),
        ),
    )
    touching = (Contact((Side("wheel"), Side("balance")), friction, 0.0),)
    return Scene("blade", bodies, torques=(Torque("wheel", -1e-5),), contacts=touching, duration=0.015)


@pytest.mark.parametrize("friction", [0.0, 0.12])
def test_a_blade_passes_the_line_of_centres_alike_in_all_orientations(friction: float) -> None:
    rng = np.random.default_rng(7)
    reference = simulate(blade(0.0, friction=friction))
    assert reference.stop == Stop.DURATION
    assert abs(reference.energy["residual_relative"]) < 1e-8
    for _ in range(25):
        tilt, *drawn = rng.uniform(0.0, 2.0 * math.pi, 3)
        done = simulate(blade(tilt, (drawn[0], drawn[1]), friction))
        assert done.stop == Stop.DURATION
        np.testing.assert_allclose(done.end_u, reference.end_u, rtol=1e-8)
        turn = done.end_q - done.q[0]
        np.testing.assert_allclose(turn, reference.end_q - reference.q[0], rtol=1e-8)


def test_friction_takes_only_what_its_lever_arm_allows() -> None:
    """Near the line of centres friction does no work: the balance ends as fast as without it to first order of the arm."""
    with_friction, without = (simulate(blade(0.0, friction=mu)).end_u[1] for mu in (0.12, 0.0))
    assert with_friction == pytest.approx(without, rel=0.02)
    assert with_friction != without


def sliders(mirrored: bool, restitution: float, friction: float = 0.5) -> Scene:
    """Two sliders on parallel axes whose tilted faces meet: slip is a multiple of approach."""
    sign = -1.0 if mirrored else 1.0
    one = Body("one", "slide", (-8e-3, 0.0), velocity=(0.3,), mass=2e-2, loops=(turned(order(left_tip(sign)), 0.0),))
    two = Body("two", "slide", (8e-3, 0.0), mass=2e-2, loops=(turned(order([(-x, -y) for x, y in left_tip(sign)]), 0.0),))
    return Scene("sliders", (one, two), contacts=(Contact((Side("one"), Side("two")), friction, restitution),), duration=0.1)


def left_tip(sign: float) -> list[tuple[float, float]]:
    """A slider whose right end is cut off at 30 degrees, upwards or downwards."""
    cut = 5.0 * math.tan(math.radians(30.0))
    return [(-5.0, -5.0), (cut * sign, -5.0), (-cut * sign, 5.0), (-5.0, 5.0)]


def order(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Counter-clockwise."""
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))
    return points if area > 0.0 else points[::-1]


@pytest.mark.parametrize("restitution", [0.0, 0.4, 0.9])
def test_tilted_faces_on_parallel_axes_rebound_by_routh(restitution: float) -> None:
    """Friction acts against the slip in both phases: e' = e (cos - mu sin) / (cos + mu sin), mirrored or not."""
    mu, slope = 0.5, math.radians(30.0)
    back = restitution * (math.cos(slope) - mu * math.sin(slope)) / (math.cos(slope) + mu * math.sin(slope))
    for mirrored in (False, True):
        done = simulate(sliders(mirrored, restitution, mu))
        assert np.count_nonzero(done.events["kind"] == EventKind.IMPACT) >= 1
        np.testing.assert_allclose(done.end_u, [0.15 * (1.0 - back), 0.15 * (1.0 + back)], rtol=1e-9)


def test_a_disc_about_its_own_pivot_lets_a_bar_pass() -> None:
    """No motion changes their gap: nothing is corrected, nothing stops."""
    disc = Loop((Arc(0.0, 0.0, 3e-3, 0.0, 2.0 * math.pi),))
    bar = turned([(-40.0, -5.0), (40.0, -5.0), (40.0, 0.0), (-40.0, 0.0)], 0.0)
    bodies = (
        Body("disc", "pivot", (0.0, 3e-3), inertia=1e-7, loops=(disc,)),
        Body("bar", "slide", (0.0, 0.0), velocity=(0.1,), mass=0.1, loops=(bar,)),
    )
    done = simulate(Scene("disc", bodies, contacts=(Contact((Side("disc"), Side("bar")), 0.3, 0.2),), duration=0.2))
    assert done.stop == Stop.DURATION
    np.testing.assert_allclose(done.end_q, [0.0, 0.02], atol=1e-12)


def locks(**changed: object) -> bool:
    """Of the second of two contacts, between two free coordinates, whose directions are parallel."""
    given = {"N": 4.0, "T": 9.0, "both": 6.0, "inverse": [0.0, 1.0, 0.0, 2.0], "slots": 2, "friction": 0.8, **changed}
    G = np.full((4, 4), 99.0)
    G[2, 2], G[3, 3], G[2, 3] = given["N"], given["T"], given["both"]
    rest = SimpleNamespace(ids=[0, 1], slots=[9, given["slots"]], coord=np.array([[0, 2], [1, 3]]))
    laws = [SimpleNamespace(friction=99.0), SimpleNamespace(friction=given["friction"])]
    model = SimpleNamespace(laws=laws, contacts=[SimpleNamespace(group=0), SimpleNamespace(group=1)])
    work = SimpleNamespace(G=G, inverse=given["inverse"])
    return bool(in_python(dead_centre._locks)(model, rest, 1, work))


def test_parallel_directions_within_the_cone_lock_two_coordinates() -> None:
    """Forces without effect, T to N as N is to what both share, must lie within the cone."""
    assert locks() and locks(both=-6.0)
    assert locks(friction=0.667) and not locks(friction=0.666)
    assert not locks(N=0.0, both=0.0)
    assert not locks(slots=3) and not locks(slots=1)
    assert not locks(inverse=[1.0, 0.0, 1.0, 2.0]) and not locks(inverse=[1.0, 1.0, 1.0, 0.0])
    assert locks(inverse=[0.0, 1e-3, 0.0, 1e-3])


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_directions_that_lock_are_parallel_but_for_rounding(share: float) -> None:
    assert locks(both=6.0 * math.sqrt(1.0 - share * 1e-10)) == (share < 1.0)


def dead(**changed: object) -> tuple[bool, list[int]]:
    """(is the island locked?, modes decided) of one contact between coordinates 1 and 3; 0 and 2 belong to other islands."""
    given = {
        "r": 1,
        "solved": False,
        "decided": OPEN,
        "locked": True,
        "u": [9.0, 0.0, 9.0, 0.0],
        "label": [2, 5, 2, 5],
        **changed,
    }
    rest = SimpleNamespace(ids=[2], coord=np.array([[1, 3]]))
    event = SimpleNamespace(rest=rest, decided=[9, 9, given["decided"]], label=given["label"])
    asked = in_python(dead_centre.stands_at_dead_centre, _locks=lambda *_: given["locked"])
    return bool(asked(None, SimpleNamespace(u=given["u"]), 5, given["r"], given["solved"], None, event)), event.decided


def test_an_island_stands_where_its_only_contact_locks_its_two_bodies() -> None:
    assert dead() == (True, [9, 9, STICK])
    assert dead(solved=True, decided=FORWARD)[0] and not dead(solved=True, decided=OPEN)[0]
    assert dead(solved=False, decided=OPEN)[0]
    unlike = ({"r": 2}, {"locked": False}, {"u": [0.0, 1e-9, 0.0, 0.0]}, {"u": [0.0, 0.0, 0.0, -1e-9]}, {"label": [2, 5, 5, 5]})
    for one in unlike:
        assert dead(**one, decided=FORWARD) == (False, [9, 9, FORWARD])


@pytest.mark.parametrize(
    ("mode", "force", "speeds", "locked", "stopped"),
    [
        (STICK, 1.0, (0.0, 0.0), True, True),
        (FORWARD, 1.0, (0.0, 0.0), True, False),
        (STICK, 0.0, (0.0, 0.0), True, False),
        (STICK, 1.0, (1e-9, 0.0), True, False),
        (STICK, 1.0, (0.0, -1e-9), True, False),
        (STICK, 1.0, (0.0, 0.0), False, False),
    ],
)
def test_what_is_locked_and_stands_is_not_accelerated(
    mode: int, force: float, speeds: tuple[float, float], locked: bool, stopped: bool
) -> None:
    """By the second of two contacts, which is pressed and sticks."""
    rest = SimpleNamespace(ids=[4, 6], coord=np.array([[0, 2], [1, 3]]))
    state = SimpleNamespace(mode={4: FORWARD, 6: mode}, u=[0.0, speeds[0], 0.0, speeds[1]], a=[1.0, 2.0, 3.0, 4.0])
    work = SimpleNamespace(force=[1.0, 9.0, force, 9.0])
    hold = in_python(dead_centre.hold_at_dead_centre, _locks=lambda model, rest, i, work: locked)
    hold(None, state, 2, work, rest)
    assert state.a == ([1.0, 0.0, 3.0, 0.0] if stopped else [1.0, 2.0, 3.0, 4.0])
