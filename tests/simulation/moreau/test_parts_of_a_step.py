"""Which contacts take part in a fixed step, what may percussions be, and how much of a penetration is taken back?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.candidates.cell_lookup import LISTED, UNKNOWN
from watchsim.contact.index_sets import OPEN
from watchsim.simulation.moreau import one_step
from watchsim.simulation.moreau.percussion_laws import laws
from watchsim.simulation.stops import Stop

STEP = 0.1


@pytest.mark.parametrize(("m", "bearings"), [(0, 3), (1, 1), (2, 3), (3, 0)])
def test_percussions_begin_with_those_of_the_last_step_and_bearings_hold_what_friction_lets_them(m: int, bearings: int) -> None:
    """Against the velocity where there is one; in the rows behind those of the contacts."""
    rng = np.random.default_rng(m)
    coordinates = [SimpleNamespace(coulomb=float(c)) for c in rng.uniform(0.1, 1.0, 5)]
    dry, u = [4, 0, 2][:bearings], np.array([0.3, 1.0, 0.0, 1.0, -0.2])
    room = laws(m, bearings)
    room.ends[:] = np.nan
    room.P[:] = np.nan
    closed = SimpleNamespace(ids=[6, 1, 3])
    work = SimpleNamespace(laws=room, dry=dry, closed=closed, memory=rng.normal(size=(8, 2)), u=u, free=None)
    instead = {name: lambda *_: None for name in ("fill_mobility", "rates_of", "friction_cones")}
    assert (
        in_python(one_step._begin_percussions, **instead)(SimpleNamespace(coordinates=coordinates), m, STEP, work) == bearings
    )
    for i in range(m):
        assert room.P[2 * i : 2 * i + 2].tolist() == work.memory[closed.ids[i]].tolist()
    for k, j in enumerate(dry):
        most = STEP * coordinates[j].coulomb
        assert (room.ends[m + k, 0], room.ends[m + k, 2]) == (-most, most)
        assert room.P[2 * m + k] == -most * np.sign(u[j])


@pytest.mark.parametrize("seed", range(5))
def test_how_deep_an_open_contact_may_be_found_is_twice_its_way_in_a_step(seed: int) -> None:
    """The way of the circle's centre as seen from the other body, and what contacts had sunk in before."""
    rng = np.random.default_rng(seed)
    names, h = ("x", "y", "w", "vx", "vy"), 1e-6
    poses = [
        SimpleNamespace(angle=rng.uniform(-3.0, 3.0), **dict(zip(names, rng.normal(size=5), strict=True))) for _ in range(2)
    ]
    a, b = (SimpleNamespace(body=i, x=x, y=y) for i, (x, y) in enumerate(rng.normal(size=(2, 2)).tolist()))

    def centre(t: float) -> complex:
        """In the frame of the other body, which moves and turns."""
        one, other = poses
        at = complex(one.x + one.vx * t, one.y + one.vy * t) + complex(a.x, a.y) * np.exp(1j * (one.angle + one.w * t))
        return complex(
            (at - complex(other.x + other.vx * t, other.y + other.vy * t)) * np.exp(-1j * (other.angle + other.w * t))
        )

    def point_of(pose, x: float, y: float) -> tuple[float, float]:
        at = complex(x, y) * np.exp(1j * pose.angle)
        return at.real, at.imag

    speed = abs(centre(h) - centre(-h)) / (2.0 * h)
    model = SimpleNamespace(contacts=[SimpleNamespace(a=0, b=1)], primitives=[a, b])
    work = SimpleNamespace(pose=poses, kept=SimpleNamespace(depth=0.02))
    found = in_python(one_step._believable, point_of=point_of)(model, SimpleNamespace(gap_close=1e-3), 0, STEP, work)
    assert found == pytest.approx(2.0 * (STEP * speed + 0.02) + 1e-3, rel=1e-8)


def closed(gaps: list[float], **given: object) -> tuple[Stop, list[int]]:
    """(code, contacts) at the middle of a step, of contacts with these gaps; half a metre is how deep one is believed to be."""
    n = len(gaps)
    margins, modes, fixed = (
        given.get(name, default) for name, default in (("margins", [0.0] * n), ("modes", [OPEN] * n), ("fixed", ()))
    )
    room = int(given.get("room", 9))  # type: ignore[call-overload]
    state = SimpleNamespace(q=np.array([1.0, 2.0]), u=np.array([10.0, -20.0]), mode=modes)
    ids = [-1] * room
    work = SimpleNamespace(q=np.zeros(2), pose=None, closed=SimpleNamespace(ids=ids), asked="asked")
    options = SimpleNamespace(gap_close=1e-3, extent=1e-2)
    pairs = [(LISTED, 0, n // 2), (given.get("second", LISTED), n // 2, n - n // 2)]

    def kinematics(model, k, pose, m, out) -> None:
        ids[m] = k

    instead = {
        "place": lambda model, q, u, pose: None,
        "candidates": lambda model, cells, p, q: pairs[p],
        "candidate": lambda model, cells, how, place: place,
        "normal_gap": lambda model, k, pose: SimpleNamespace(gap=gaps[k]),
        "extent_margin": lambda model, k, pose: margins[k],
        "contact_kinematics": kinematics,
        "is_immovable": lambda model, out, m: out.ids[m] in fixed,
        "_believable": lambda *_: 0.5,
        "ask": lambda *_: None,
    }
    code, m = in_python(one_step.closed_at_middle, **instead)(SimpleNamespace(pairs=pairs), None, state, options, STEP, work)
    assert work.q.tolist() == [1.5, 1.0]
    return code, ids[:m]


def test_closed_is_what_has_no_gap_within_its_primitives_at_the_middle_of_the_step() -> None:
    assert closed([0.0, 0.9e-3, 1.1e-3, -0.4, -1.0, -0.49]) == (Stop.RUNNING, [0, 1, 3, 5])
    assert closed([0.0] * 4, margins=[-0.9e-2, -1.1e-2, 0.0, 1.0]) == (Stop.RUNNING, [0, 2, 3])


def test_what_was_closed_may_be_found_deeper_than_an_open_contact() -> None:
    assert closed([-0.6, -0.6, -0.4], modes=[1, OPEN, OPEN]) == (Stop.RUNNING, [0, 2])


def test_what_cannot_be_moved_takes_no_part_and_leaves_its_place() -> None:
    assert closed([0.0, 0.0, 0.0], fixed=(1,)) == (Stop.RUNNING, [0, 2])


def test_more_contacts_than_there_is_room_for_or_unknown_cells_stop_the_loop() -> None:
    assert closed([0.0] * 4, room=4)[0] == Stop.RUNNING
    assert closed([0.0] * 5, room=4)[0] == Stop.TOO_MANY_CONTACTS
    assert closed([0.0, 0.0, 0.0], second=UNKNOWN) == (Stop.CELL_UNKNOWN, [0])


@pytest.mark.parametrize("deep", [False, True])
def test_a_fifth_of_what_is_deeper_than_half_the_closing_gap_is_taken_back(deep: bool) -> None:
    """By normal percussions alone, of contacts that yield a little; modes, memories and the deepest are kept."""
    room, pushed = laws(2, 1), []
    room.P[:] = 1.0, 2.0, 3.0, 4.0, 9.0
    room.G[:] = np.diag([5.0, 6.0, 7.0, 8.0, 9.0])
    room.low[:], room.ends[:] = 9.0, 9.0
    gaps = [-0.4e-3, -4.5e-3 if deep else 0.3e-3]
    kin = [SimpleNamespace(g=gap) for gap in gaps]
    work = SimpleNamespace(
        laws=room, memory=np.ones((6, 2)), kept=SimpleNamespace(depth=9.0), closed=SimpleNamespace(ids=[4, 2], kin=kin)
    )
    state = SimpleNamespace(mode=np.array([1, 1, 0, 1, 0, 0]), worst=SimpleNamespace(penetration=1e-3), q=None)
    instead = {"relax": lambda laws, m, b: None, "push": lambda work, m, b, P, q: pushed.append(P.copy())}
    in_python(one_step._take_back, **instead)(state, SimpleNamespace(gap_close=1e-3), 2, work)
    assert state.mode.tolist() == [0, 0, 1, 0, 1, 0]
    assert work.memory.tolist() == [[0, 0], [0, 0], [3, 4], [0, 0], [1, 2], [0, 0]]
    assert work.kept.depth == max(0.4e-3, -gaps[1]) and state.worst.penetration == max(1e-3, work.kept.depth)
    assert len(pushed) == deep
    if deep:
        assert pushed[0].tolist() == [0.0] * 4 + [9.0]
        assert room.b == pytest.approx([0.0, 0.0, -0.2 * 4e-3, 0.0, 0.0])
        assert room.low.tolist() == [0.0, 0.0] and not room.ends[:2].any()
        assert np.diag(room.G) == pytest.approx([5.0 * 1.001, 6.0, 7.0 * 1.001, 8.0, 9.0])


@pytest.mark.parametrize("seed", range(6))
def test_the_books_of_a_step_without_contacts_close(seed: int) -> None:
    """Energy gained is work put in less damping less the error of the method; two sprung coordinates with a spring between."""
    rng = np.random.default_rng(seed)
    given = {"driven": 0, "weight_x": 0.0, "weight_y": 0.0, "coulomb": 0.0}
    names = ("mass", "stiffness", "viscous", "quadratic", "rest", "force")
    rows = [SimpleNamespace(**dict(zip(names, rng.uniform(0.2, 2.0, 6), strict=True)), **given) for _ in range(2)]
    joint_names = ("stiffness", "viscous", "quadratic", "rest", "force")
    joint = SimpleNamespace(coordinate=1, on=0, **dict(zip(joint_names, rng.uniform(0.2, 2.0, 5), strict=True)))
    model = SimpleNamespace(coordinates=rows, joints=[joint], tables=[], lines=[])
    q, u = rng.normal(size=2), rng.normal(size=2)
    sums = SimpleNamespace(drive=0.0, damping=0.0, correction=0.0, friction=0.0)
    state = SimpleNamespace(
        clock=SimpleNamespace(time=0.0), q=q.copy(), a=rng.normal(size=2), sums=sums, mode=np.zeros(0, int),
        worst=SimpleNamespace(penetration=0.0),
    )  # fmt: skip
    arrays = ("force", "damping", "mass", "inverse", "free", "foreseen", "wound")
    work = SimpleNamespace(
        q=q + 0.5 * STEP * u, u=u, start=q.copy(), joint=np.zeros(1), dry=[], laws=laws(0, 0), memory=np.zeros((0, 2)),
        kept=SimpleNamespace(depth=0.0), **{name: np.zeros(2) for name in arrays},
    )  # fmt: skip

    def energy(place: np.ndarray, speed: np.ndarray) -> float:
        own = sum(
            0.5 * c.mass * v * v + 0.5 * c.stiffness * (x - c.rest) ** 2 for c, x, v in zip(rows, place, speed, strict=True)
        )
        return float(own + 0.5 * joint.stiffness * (place[1] - place[0] - joint.rest) ** 2)

    after = np.zeros(2)
    in_python(one_step.act)(model, state, 0, STEP, work, after)
    in_python(one_step.move)(model, state, SimpleNamespace(gap_close=1e-3), 0, STEP, work, after)
    assert state.q == pytest.approx(q + 0.5 * STEP * (u + after))
    assert state.a == pytest.approx((after - u) / STEP)
    gained = energy(state.q, after) - energy(q, u)
    mean = 0.5 * (u + after)
    put_in = STEP * (sum(c.force * v for c, v in zip(rows, mean, strict=True)) + joint.force * (mean[1] - mean[0]))
    assert sums.drive == pytest.approx(put_in)
    assert sums.drive - sums.damping - sums.correction == pytest.approx(gained, abs=1e-12)
    assert sums.damping > 0.0
