"""Do bodies that have nothing to do with each other leave each other alone, and do they rest until they must move?"""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from every_time import few
from moving_scenes import box, circle, ground, named, of_kind, on_slope, profile, tip, touching
from plain_kernels import in_python
from reference import rolling
from reference.block import block, stops_at
from reference.rolling import Disc
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from watchsim.bench.growth import side_by_side
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import FIXED, FREE, PIVOT, SLIDE
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import coupled_motion as contact_islands
from watchsim.simulation import coupled_motion as sleeping
from watchsim.simulation.coupled_motion import island_of, label_islands, sort_by_island
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop

# Which coordinates act on each other, and which of them sleep? Against connected components of a graph, and rule by rule.


def body(motion: int, first: int, carrier: int = -1) -> SimpleNamespace:
    return named(motion=motion, first=first, carrier=carrier)


# Coordinates: 0 pivot on the body of 5, 1 to 3 free, 4 slide, 6 to 8 free, 9, 10 and 11 pivots.
BODIES = [
    *(body(PIVOT, 5), body(FREE, 1), body(SLIDE, 4), body(PIVOT, 0, 0), body(FIXED, -1), body(FREE, 6), body(PIVOT, 9)),
    *(body(FIXED, -1, 0), body(PIVOT, 10), body(PIVOT, 11)),
]
N = 12


def moved_by(b: int) -> int:
    """A coordinate that moves a body, -1 for none."""
    carrier = BODIES[b].carrier
    return BODIES[b].first if BODIES[b].first >= 0 or carrier < 0 else BODIES[carrier].first


def components(pairs: list[tuple[int, int]]) -> list[int]:
    """By coordinate, the smallest one that it is joined to."""
    rows, columns = zip(*pairs, strict=True)
    _, part = connected_components(coo_matrix((np.ones(len(pairs)), (rows, columns)), (N, N)), directed=False)
    return [int(np.flatnonzero(part == own)[0]) for own in part]


@pytest.mark.parametrize("seed", range(25))
def test_contacts_carriers_free_bodies_joints_and_springs_make_islands(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.permuted(np.tile(np.arange(len(BODIES)), (6, 1)), axis=1)[:, :2].tolist()
    joints = [named(coordinate=int(i), on=int(j)) for i, j in rng.choice(N, (seed % 2, 2), replace=False)]
    lines = [named(a=int(a), b=int(b)) for a, b in rng.choice(len(BODIES), (seed % 3, 2), replace=False)]
    lines += [named(a=2, b=-1), named(a=4, b=8), named(a=9, b=4), named(a=3, b=8)]
    model = named(
        bodies=BODIES,
        joints=joints,
        lines=lines,
        contacts=[named(a=2 * k, b=2 * k + 1) for k in range(6)],
        primitives=[named(body=b) for pair in ends for b in pair],
    )
    ids = rng.permutation(6)[: seed % 4].tolist()
    label = np.full(N, 77)
    in_python(contact_islands.label_islands)(model, [*ids, 5], len(ids), label)
    pairs = [(1, 2), (1, 3), (5, 0), (6, 7), (6, 8)] + [(one.coordinate, one.on) for one in joints]
    pairs += [(BODIES[one.a].first, BODIES[one.b].first) for one in lines if one.b >= 0]
    pairs += [(moved_by(ends[k][0]), moved_by(ends[k][1])) for k in ids]
    wanted = components([pair for pair in pairs if min(pair) >= 0])
    assert label.tolist() == wanted
    for k in range(6):
        movers = [moved_by(b) for b in ends[k] if moved_by(b) >= 0]
        if k in ids and movers:
            assert in_python(contact_islands.island_of)(model, label, k) == wanted[movers[0]]


def test_a_contact_belongs_to_the_island_of_whatever_of_it_moves() -> None:
    model = named(
        bodies=BODIES,
        contacts=[named(a=0, b=1), named(a=1, b=0), named(a=0, b=2)],
        primitives=[named(body=b) for b in (3, 4, 2)],
    )
    label = [40 + i for i in range(N)]
    assert [in_python(contact_islands.island_of)(model, label, k) for k in range(3)] == [40, 40, 40]


def test_a_body_rests_where_its_coordinate_sleeps_and_its_carrier_too() -> None:
    model = named(bodies=[body(FIXED, -1), body(PIVOT, 1), body(PIVOT, 2, 1), body(FIXED, -1, 1), body(PIVOT, 0)])
    for flags, expected in (
        ((1, 0, 0), [True, True, True, True, False]),
        ((0, 1, 0), [True, False, False, False, True]),
        ((0, 0, 1), [True, True, False, True, True]),
    ):
        asked = [in_python(sleeping.is_at_rest)(model, list(flags), b) for b in range(5)]
        assert asked == expected


# Do bodies that have nothing to do with each other leave each other alone, and are those found that have?

_label, _sort = callable_kernel(label_islands), callable_kernel(sort_by_island)
_island_of = callable_kernel(island_of)
R = 0.01  # m


def disc(name: str, x: float, height: float = 0.0) -> Body:
    circle = Loop((Arc(0.0, 0.0, R, 0.0, 2.0 * math.pi),))
    return Body(name, "free", (x, R + height), mass=0.01, inertia=4e-7, loops=(circle,))


def on_ground(*discs: Body, touching: tuple[tuple[str, str], ...] = ()) -> Scene:
    """Discs on one line, with contacts among those in `touching`."""
    ground = Body("ground", "fixed", loops=(Loop((Line(5.0, 0.0, -5.0, 0.0),), closed=False),))
    pairs = [(one.name, "ground") for one in discs] + list(touching)
    contacts = tuple(Contact((Side(a), Side(b)), 0.2, 0.7) for a, b in pairs)
    return Scene("discs", (*discs, ground), gravity=(0.0, -9.81), contacts=contacts)


def islands(compiled: Compiled, ids: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Labels by coordinate, the contacts in order, the end of each one's island."""
    label, listed, upto = np.zeros(len(compiled.q), np.int64), ids.copy(), np.zeros(len(ids), np.int64)
    _label(compiled.model, listed, len(ids), label)
    _sort(compiled.model, label, len(ids), listed, upto)
    return label, listed, upto


def test_islands_are_the_connected_sets() -> None:
    """Against a search over the graph of coordinates, for any choice of closed contacts."""
    names = [f"d{i}" for i in range(7)]
    touching = tuple((names[i], names[j]) for i in range(7) for j in range(i))
    compiled = compile_scene(on_ground(*(disc(name, 0.03 * i) for i, name in enumerate(names)), touching=touching))
    model, rng = compiled.model, np.random.default_rng(5)
    body = [compiled.model.primitives[k].body for k in range(len(model.primitives))]
    for _ in range(200):
        ids = np.sort(rng.choice(len(model.contacts), rng.integers(0, 12), replace=False)).astype(np.int64)
        label, listed, upto = islands(compiled, ids)
        groups = [{3 * i, 3 * i + 1, 3 * i + 2} for i in range(7)]
        for k in ids:
            firsts = [model.bodies[body[side]].first for side in (model.contacts[k].a, model.contacts[k].b)]
            joined = [g for g in groups if any(first in g for first in firsts if first >= 0)]
            groups = [g for g in groups if g not in joined] + [set.union(*joined)]
        assert sorted(min(g) for g in groups) == sorted(set(label))
        assert all(label[i] == min(g) for g in groups for i in g)
        assert sorted(listed) == sorted(ids)
        where = [int(_island_of(model, label, k)) for k in listed]
        assert where == sorted(where)
        assert [int(end) for end in upto] == [max(j for j, other in enumerate(where) if other == one) + 1 for one in where]


def test_impacts_elsewhere_do_not_push_what_rolls() -> None:
    """A disc rolls on undisturbed, without any event of its own, while another one bounces beside it: also where they could
    meet, and so have the same steps. Where they cannot, it moves to the last bit as it does alone."""
    rolling = dataclasses.replace(disc("rolling", 0.0), velocity=(0.3, 0.0, -0.3 / R))
    apart = on_ground(rolling, disc("bouncing", 1.0, height=0.02))
    joined = dataclasses.replace(apart, contacts=(*apart.contacts, *touching("rolling", "bouncing")))
    runs = [simulate(scene, 0.5) for scene in (joined, apart)]
    for run in runs:
        assert run.counts["impacts"] > 5
        own = [k for k, pair in enumerate(run.pairs) if "rolling" in (pair.body_a, pair.body_b)]
        assert not np.isin(run.events["contact"][run.events["t"] > 0.0], own).any()
    one_system = runs[0].u[:, runs[0].slices["rolling"]]
    assert np.abs(one_system / [0.3, 1.0, 0.3 / R] - [1.0, 0.0, -1.0]).max() < 2e-15
    alone = simulate(on_ground(rolling), 0.5)
    for name in ("end_q", "end_u"):
        assert np.array_equal(getattr(runs[1], name)[runs[1].slices["rolling"]], getattr(alone, name))


# Do bodies come to rest by friction, stay at rest, and move again when they must?

SIDE = 0.1


@pytest.mark.parametrize("friction", few([0.15, 0.0], 1))
@pytest.mark.parametrize("quadratic", [0.0, 1e-12])
def test_a_rotor_pressed_on_a_stop_stays(friction: float, quadratic: float) -> None:
    """For a minute, with something else swinging; with and without an exact solution of its free motion."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (3.0,), inertia=4e-12, loops=(tip(2e-3),)),
        Body("stop", "fixed", (2e-3 * math.cos(0.1), 2e-3 * math.sin(0.1) + 0.3e-3), loops=(circle(0.2e-3),)),
        Body("balance", "pivot", (1.0, 1.0), 1.0, inertia=1e-9),
    )
    scene = Scene(
        "stop",
        bodies,
        springs=(Spring("balance", 1e-9 * (8.0 * math.pi) ** 2),),
        torques=(Torque("rotor", 1e-6),),
        damping=(Damping("rotor", 0.0, quadratic),),
        contacts=touching("rotor", "stop", friction=friction, restitution=0.2),
    )
    done = simulate(scene, 60.0, record=((0.1, 0.2), (59.9, 60.0)))
    assert done.stop == Stop.DURATION
    angle = done.q[:, 0]
    assert np.ptp(angle) < 1e-12
    assert np.all(done.u[:, 0] == 0.0)
    assert done.q[-1][2 - 1] == pytest.approx(math.cos(8.0 * math.pi * 60.0), abs=1e-9)
    assert not [event for event in done.events if event["t"] > 0.1 and event["kind"] < EventKind.TURN]


@pytest.mark.slow
def test_the_locked_lever_of_the_bench_stays() -> None:
    """No balance: the wheel draws the lever onto its banking and both stand still for a minute."""
    whole = profile("bench_lever")
    bodies = tuple(body for body in whole.bodies if body.name != "balance")
    contacts = tuple(c for c in whole.contacts if "balance" not in (side.body for side in c.sides))
    scene = Scene("locked", bodies, torques=whole.torques, contacts=contacts)
    done = simulate(scene, 60.0, record=((0.5, 0.6), (59.9, 60.0)))
    assert done.stop == Stop.DURATION
    assert np.ptp(done.q, axis=0).max() < 1e-12


def block_scene(slope: float, mu: float, speed: float) -> Scene:
    """A block on an incline that falls towards +x, thrown uphill (-x)."""
    body = Body("block", "free", (0.0, 0.5 * SIDE), velocity=(-speed, 0.0, 0.0), mass=2.0, inertia=2.0 * SIDE**2 / 6.0)
    body = Body(**{**body.__dict__, "loops": (box(2.0 * SIDE, SIDE),)})
    return Scene("block", (body, ground()), contacts=touching("block", "ground", friction=mu), gravity=on_slope(slope))


@pytest.mark.parametrize(("slope", "mu"), [(0.3, 0.4), (0.3, 0.2), (0.0, 0.3), (0.3, 0.0)])
def test_a_block_thrown_uphill(slope: float, mu: float) -> None:
    """It slides up, stops, and stays (friction angle above the slope) or comes back."""
    done = simulate(block_scene(slope, mu, 1.5), 1.2)
    assert done.stop == Stop.DURATION
    for t in (0.1, stops_at(1.5, mu, slope) if mu + slope else 0.5, 0.9, 1.2):
        way, speed = block(t, 1.5, mu, slope)
        q, u = done.at(t)
        assert (-q[0], -u[0]) == pytest.approx((way, speed), abs=1e-8)
        assert abs(q[1] - 0.5 * SIDE) + abs(q[2]) < 1e-12
    assert done.energy["residual_relative"] < 1e-9


@pytest.mark.parametrize(("share", "stays"), [(0.999, True), (1.001, False)])
def test_a_block_at_its_friction_angle(share: float, stays: bool) -> None:
    mu = 0.3
    slope = share * math.atan(mu)
    done = simulate(block_scene(slope, mu, 0.0), 10.0)
    a = 9.81 * (math.sin(slope) - mu * math.cos(slope))
    assert done.q[-1][0] == pytest.approx(0.0 if stays else 0.5 * a * 100.0, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(("v", "spin"), [(2.0, 0.0), (0.0, 60.0), (2.0, -60.0), (-1.0, 10.0)])
@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_a_disc_slides_until_it_rolls(v: float, spin: float, slope: float) -> None:
    """`rolling` counts the angle in the sense of rolling downhill, +x; ours is the opposite."""
    disc = Disc(0.05, 0.25, slope)
    body = Body("disc", "free", (0.0, 0.05), 0.0, (v, 0.0, -spin), mass=1.0, inertia=0.5 * 0.05**2, loops=(circle(0.05),))
    scene = Scene("disc", (body, ground()), contacts=touching("disc", "ground", friction=0.25), gravity=on_slope(slope))
    done = simulate(scene, 2.0)
    assert done.stop == Stop.DURATION
    for t in (0.05, 0.5, 2.0):
        truth = rolling.motion(disc, v, spin, t)
        q, u = done.at(t)
        assert (q[0], -q[2], u[0], -u[2]) == pytest.approx(tuple(truth), abs=2e-8)
    ends = rolling.slip_ends(disc, v, spin)
    sticks = of_kind(done, EventKind.STICK)
    assert [event["t"] for event in sticks] == pytest.approx([ends], abs=1e-8)


def test_a_sleeper_wakes_when_it_is_hit() -> None:
    """A rotor rests on a stop; two seconds later a ball falls on it."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (0.0,), inertia=1e-3, loops=(box(0.4, 0.02, (0.25, 0.0)),)),
        Body("stop", "fixed", (0.4, -0.02), loops=(circle(0.01),)),
        Body("ball", "slide", (0.2, 0.02 + 19.62), axis=(0.0, -1.0), velocity=(0.0,), mass=0.01, loops=(circle(0.01),)),
    )
    contacts = touching("rotor", "stop", restitution=0.5) + touching("rotor", "ball", restitution=0.5)
    scene = Scene("wake", bodies, torques=(Torque("rotor", -0.1),), contacts=contacts, gravity=(0.0, -9.81))
    done = simulate(scene, 2.5)
    assert np.all(done.q[done.t < 2.0, 0] == done.q[0, 0])
    impacts = [event["t"] for event in of_kind(done, EventKind.IMPACT)]
    assert impacts[0] == pytest.approx(2.0, rel=1e-9)
    assert done.u[-1][1] < 9.81 * 2.4


def test_a_sleeper_under_a_changing_torque_moves_when_that_turns() -> None:
    """Held on its stop by a torque that falls through zero at t = 1 s and pulls it away from then on."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, (0.0,), inertia=1e-3, loops=(box(0.4, 0.02, (0.25, 0.0)),)),
        Body("stop", "fixed", (0.4, -0.02), loops=(circle(0.01),)),
    )
    torque = Torque("rotor", over="time", table=((0.0, -0.1), (2.0, 0.1)))
    done = simulate(Scene("pull", bodies, torques=(torque,), contacts=touching("rotor", "stop")), 1.5)
    opened = of_kind(done, EventKind.OPEN)
    assert [event["t"] for event in opened] == pytest.approx([1.0], abs=1e-6)
    # From then on angle'' = 100 (t - 1): angle = 100/6 (t - 1)³.
    assert done.q[-1][0] == pytest.approx(100.0 / 6.0 * 0.5**3, rel=1e-6)


def test_what_stands_still_is_woken_by_a_force_that_is_yet_to_change() -> None:
    """Pressed on a stop for five seconds, then drawn away on time."""
    bodies = (
        Body("rotor", "pivot", (0.0, 0.0), 0.0, inertia=4e-12, loops=(tip(2e-3),)),
        Body("stop", "fixed", (2e-3 * math.cos(0.1), 2e-3 * math.sin(0.1) + 0.3e-3), loops=(circle(0.2e-3),)),
    )
    table = ((0.0, 0.0), (0.2, 1e-6), (5.0, 1e-6), (5.001, -1e-6))
    torque = Torque("rotor", over="time", table=table)
    scene = Scene("pressed", bodies, torques=(torque,), damping=(Damping("rotor", 1e-9),), contacts=touching("rotor", "stop"))
    held = simulate(scene, 4.9)
    assert np.all(held.u[-1] == 0.0)
    assert simulate(scene, 5.01).end_q[0] < held.end_q[0] - 1e-4


# Mechanisms that do not touch each other do not feel each other, however many stand in one scene.


def test_levers_side_by_side_move_as_each_alone() -> None:
    scene = load(profiles_dir() / "bench_lever" / "scene.toml")
    alone, many = simulate(scene, 0.3), simulate(side_by_side(scene, 6), 0.3)
    assert many.stop == Stop.DURATION
    assert many.counts["lcp_failures"] == 0
    first = many.q[-1][: len(alone.q[-1])]
    assert abs(first - alone.q[-1]).max() < 1e-9
