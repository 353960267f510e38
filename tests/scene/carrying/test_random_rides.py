"""Does every carried body hang where its carriers take it, whatever their order, and is only refused what must be?

Places come from turning and shifting frame after frame, at several positions of all bodies. A body can be simulated where its
origin is a fixed point of the movement, or of one moving body that nothing carries round.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import MOVEMENT, carried_last, is_still, rides, start_poses, weigh

Pose = tuple[complex, float]  # of a frame in the movement


def tree(rng: np.random.Generator, count: int) -> tuple[Body, ...]:
    """Bodies, some on others or at their centre, in any order; what is carried is pivoted or fixed there."""
    bodies: list[Body] = []
    for k in range(count):
        on = str(rng.choice([body.name for body in bodies])) if bodies and rng.random() < 0.75 else None
        motion = str(
            rng.choice(["pivot", "fixed"] if on else ["pivot", "fixed", "slide", "free"], p=[0.6, 0.4] if on else None)
        )
        position = (0.0, 0.0) if rng.random() < 0.3 else (float(rng.normal()), float(rng.normal()))
        way = rng.uniform(0.0, math.tau)
        speed = {"pivot": 1, "slide": 1, "free": 3, "fixed": 0}[motion] if rng.random() < 0.7 else 0
        body = Body(f"b{k}", motion, position, float(rng.normal()), tuple(rng.normal(size=speed).tolist()), on=on)
        bodies.append(replace(body, axis=(math.cos(way), math.sin(way))))
    return tuple(bodies[k] for k in rng.permutation(count))


def poses(bodies: tuple[Body, ...], moved: dict[str, np.ndarray]) -> dict[str, Pose]:
    """Where all stand with their coordinates changed by `moved`."""
    known: dict[str, Pose] = {}
    named = {body.name: body for body in bodies}

    def of(name: str) -> Pose:
        if name not in known:
            body, by = named[name], moved[name]
            place, angle = complex(*body.position), body.angle
            if body.motion == "pivot":
                angle += by[0]
            elif body.motion == "slide":
                place += complex(*body.axis) * by[0]
            elif body.motion == "free":
                place, angle = place + complex(*by[:2]), angle + by[2]
            origin, turned = of(body.on) if body.on else (0j, 0.0)
            known[name] = origin + cmath.exp(1j * turned) * place, turned + angle
        return known[name]

    return {name: of(name) for name in named}


def within(pose: Pose, frame: Pose) -> complex:
    return (pose[0] - frame[0]) * cmath.exp(-1j * frame[1])


def is_one(places: list[complex]) -> bool:
    return max(abs(place - places[0]) for place in places) < 1e-12


def hosts(bodies: tuple[Body, ...], name: str, seen: list[dict[str, Pose]]) -> list[int]:
    """In which moving body, or in the movement, does a body's origin stay where it is?"""
    found = [MOVEMENT] if is_one([one[name][0] for one in seen]) else []
    for i, body in enumerate(bodies):
        in_place = body.on is None or is_one([one[body.name][0] for one in seen])  # itself not carried round
        if body.motion != "fixed" and body.name != name and in_place:
            found += [i] if is_one([within(one[name], one[body.name]) for one in seen]) else []
    return found


@pytest.mark.parametrize("seed", range(60))
def test_rides(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = tree(rng, int(rng.integers(2, 6)))
    still = {body.name: np.zeros(3) for body in bodies}
    seen = [poses(bodies, {body.name: rng.normal(size=3) for body in bodies}) for _ in range(5)]
    start = poses(bodies, still)
    complaints: list[str] = []
    found = rides(bodies, lambda name, message: complaints.append(name))
    names = [body.name for body in bodies]
    possible = {name: hosts(bodies, name, seen) for name in names}
    hopeless = {body.name for body in bodies if body.on and body.motion == "pivot" and not possible[body.name]}
    assert hopeless <= set(complaints)
    told = start_poses(Scene("tree", bodies))
    for i, (body, ride) in enumerate(zip(bodies, found, strict=True)):
        above = [body.name]
        while (on := bodies[names.index(above[-1])].on) is not None:
            above.append(on)
        assert complex(*told[body.name][:2]) == pytest.approx(start[body.name][0], abs=1e-12)
        assert told[body.name][2] == pytest.approx(start[body.name][1], abs=1e-12)
        assert is_still(Scene("tree", bodies), body) is all(bodies[names.index(one)].motion == "fixed" for one in above)
        if set(above) & set(complaints):
            continue
        assert ride.start == pytest.approx(start[body.name][1], abs=1e-12)
        spins = [bodies[names.index(one)] for one in above]
        assert ride.spin == pytest.approx(sum(one.velocity[-1] for one in spins if one.velocity and one.motion != "slide"))
        for one in seen if body.on else []:
            frame = (0j, 0.0) if ride.host == MOVEMENT else one[names[ride.host]]
            assert complex(*ride.place) == pytest.approx(within(one[body.name], frame), abs=1e-12)
            if ride.part_of != i:  # rigid with another: turned in its frame
                assert ride.host == ride.part_of
                turned = one[body.name][1] - frame[1]
            else:
                turns = 0.0 if ride.turns_with == MOVEMENT else one[names[ride.turns_with]][1]
                own = body.angle if body.motion == "fixed" else one[body.name][1] - one[str(body.on)][1]
                turned = one[body.name][1] - turns - own
            assert cmath.exp(1j * turned) == pytest.approx(cmath.exp(1j * ride.angle), abs=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_only_what_cannot_be_is_refused(seed: int) -> None:
    """Of chains whose lower part is none."""
    rng = np.random.default_rng(100 + seed)
    bodies = tree(rng, 4)
    seen = [poses(bodies, {body.name: rng.normal(size=3) for body in bodies}) for _ in range(5)]
    complaints: list[str] = []
    rides(bodies, lambda name, message: complaints.append(name))
    for name in complaints:
        body = next(body for body in bodies if body.name == name)
        assert body.on in complaints or not hosts(bodies, name, seen)


@pytest.mark.parametrize("seed", range(20))
def test_carriers_come_first(seed: int) -> None:
    bodies = tree(np.random.default_rng(seed), 6)
    order = [body.name for body in carried_last(bodies)]
    assert sorted(order) == sorted(body.name for body in bodies)
    assert all(body.on is None or order.index(body.on) < order.index(body.name) for body in bodies)


@pytest.mark.parametrize("first", [0, 1, 2])
def test_what_carries_itself_is_left_out(first: int) -> None:
    ring = [Body("a", on="c"), Body("b", on="a"), Body("c", on="b")]
    bodies = (*ring[first:], Body("d"), *ring[:first])
    complaints: list[str] = []
    found = rides(bodies, lambda name, message: complaints.append(f"{name}: {message}"))
    assert len(found) == 4 and len(complaints) == 3 and all("would carry itself" in one for one in complaints)
    with pytest.raises(ValueError, match="would carry itself"):
        rides(bodies)


def points(body: Body, rng: np.random.Generator) -> tuple[Body, np.ndarray, np.ndarray]:
    """The body made of three points of mass (as poised ones where it is pivoted): body, places, masses."""
    places, masses = rng.normal(size=3) + 1j * rng.normal(size=3), rng.uniform(1.0, 2.0, 3)
    places = places - (places @ masses) / masses.sum() * (body.motion in ("pivot", "free", "slide"))
    centre = (places @ masses) / masses.sum()
    inertia = float(np.abs(places) ** 2 @ masses)
    made = replace(body, mass=float(masses.sum()), inertia=inertia, centre_of_mass=(centre.real, centre.imag))
    return made, places, masses


@pytest.mark.parametrize("seed", range(40))
def test_what_carriers_weigh(seed: int) -> None:
    """As all the points of mass that turn with them; those of a pivoted load as if they lay at its pivot."""
    rng = np.random.default_rng(500 + seed)
    made = [points(body, rng) for body in tree(rng, 4)]
    whole, places, masses = (tuple(parts) for parts in zip(*made, strict=True))
    complaints: list[str] = []
    hung = rides(whole, lambda name, message: complaints.append(name))
    if complaints:
        return
    start = poses(whole, {body.name: np.zeros(3) for body in whole})
    got = weigh(whole, hung, lambda name, message: None)
    for i, body in enumerate(whole):
        if hung[i].part_of != i:
            assert got[i].mass == 0.0
            continue
        mass, moment, inertia = 0.0, 0j, 0.0
        for k, (places_k, masses_k) in enumerate(zip(places, masses, strict=True)):
            part = hung[k].part_of
            origin, turned = start[whole[k].name]
            if part == i:
                here = np.array([within((origin + cmath.exp(1j * turned) * p, 0.0), start[body.name]) for p in places_k])
                here = places_k if k == i else here
            elif hung[part].host == i:  # a pivoted load with all its rigid parts
                here = np.full(3, complex(*hung[part].place))
            else:
                continue
            mass, moment, inertia = mass + masses_k.sum(), moment + here @ masses_k, inertia + np.abs(here) ** 2 @ masses_k
        assert (got[i].mass, complex(*got[i].moment)) == (pytest.approx(mass), pytest.approx(moment, abs=1e-9))
        if body.motion == "fixed":
            continue
        assert got[i].inertia == pytest.approx(inertia, rel=1e-9)
