"""Is what carries what resolved as told, weighed right, and refused by name where it could not be simulated exactly?"""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from watchsim.mechanism.check import check_report, check_text
from watchsim.mechanism.compile import compile_scene
from watchsim.results.folder import lock_text
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Damping, Spring
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import MOVEMENT, at_start, carried_last, is_still, rides, start_poses, weigh

CARRIAGE = """
[scene]
title = "carriage"
gravity = ["0 m/s²", "-9.81 m/s²"]

[bodies.balance]
on = "carriage"
position = ["3 mm", "0 mm"]
angle = "20°"
velocity = "90 °/s"
mass = "40 mg"
inertia = "12 mg·cm²"

[bodies.carriage]
position = ["1 mm", "2 mm"]
angle = "90°"
velocity = "10 °/s"
inertia = "30 mg·cm²"

[bodies.banking]
on = "carriage"
motion = "fixed"
position = ["0 mm", "4 mm"]
circle = "0.5 mm"
mass = "2 mg"
"""


def read(tmp_path, text: str) -> Scene:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return load(path)


def faults(tmp_path, text: str) -> dict[str, str]:
    with pytest.raises(SceneError) as caught:
        read(tmp_path, text)
    return {fault.key: fault.message for fault in caught.value.faults}


def test_a_carried_body_starts_where_its_carrier_holds_it(tmp_path) -> None:
    scene = read(tmp_path, CARRIAGE)
    poses = start_poses(scene)
    assert poses["balance"] == pytest.approx((1e-3, 5e-3, math.radians(110.0)))
    assert poses["banking"] == pytest.approx((-3e-3, 2e-3, math.radians(90.0)))
    assert [body.position for body in at_start(scene).bodies] == [poses[b.name][:2] for b in scene.bodies]
    compiled = compile_scene(scene)
    assert compiled.q == pytest.approx(np.radians([110.0, 90.0]))
    assert compiled.u == pytest.approx(np.radians([100.0, 10.0]))
    assert compiled.relative(compiled.q[None])[0] == pytest.approx(np.radians([20.0, 90.0]))
    assert is_still(scene, scene.body("banking")) is False


def test_a_carrier_weighs_what_it_carries(tmp_path) -> None:
    """A mass at the pivot of the balance; the fixed disc whole, by Steiner; gravity pulls at their common first moment."""
    scene = read(tmp_path, CARRIAGE)
    disc = 0.5 * 2e-6 * 0.5e-3**2 + 2e-6 * 4e-3**2
    row = compile_scene(scene).model.coordinates
    assert row.mass == pytest.approx([12e-10, 30e-10 + 40e-6 * 9e-6 + disc], rel=1e-12)
    weighed = weigh(scene.bodies, rides(scene.bodies))[1]
    assert weighed.mass == pytest.approx(42e-6)
    assert weighed.moment == pytest.approx((40e-6 * 3e-3, 2e-6 * 4e-3))
    # cos q weight_y - sin q weight_x is the torque of that moment's weight.
    q = math.radians(90.0)
    arm = weighed.moment[0] * math.cos(q) - weighed.moment[1] * math.sin(q)
    assert math.cos(q) * row.weight_y[1] - math.sin(q) * row.weight_x[1] == pytest.approx(-9.81 * arm)
    assert row.weight_x[0] == row.weight_y[0] == 0.0


def test_a_load_whose_weight_lies_off_its_origin_counts_about_its_centre_of_mass() -> None:
    """Two points of mass, joined and turned in any way, against the sum over the points."""
    points, masses = np.array([[1.2e-3, -0.4e-3], [0.3e-3, 2.0e-3]]), np.array([3e-6, 5e-6])
    cx, cy = masses @ points / masses.sum()
    about_own_origin = float(masses @ (points**2).sum(axis=1))
    load_ = Body(
        "load", "fixed", (4e-3, -1e-3), 0.7, mass=8e-6, inertia=about_own_origin, centre_of_mass=(cx, cy), on="carriage"
    )
    carriage = Body("carriage", "pivot", (1e-3, 2e-3), 0.5, mass=1e-6, inertia=2e-10)
    c, s = math.cos(0.7), math.sin(0.7)
    placed = points @ np.array([[c, s], [-s, c]]) + [4e-3, -1e-3]
    bodies = (load_, carriage)
    weighed = weigh(bodies, rides(bodies))[1]
    assert weighed.mass == pytest.approx(9e-6)
    assert weighed.moment == pytest.approx(tuple(masses @ placed), rel=1e-6, abs=0.0)
    assert weighed.inertia == pytest.approx(2e-10 + float(masses @ (placed**2).sum(axis=1)), rel=1e-12, abs=0.0)


def test_fixed_carriers_only_move_the_start(tmp_path) -> None:
    """On a plate that cannot move, nothing is a joint; rests and angles are told against the plate all the same."""
    text = CARRIAGE.replace('velocity = "10 °/s"\ninertia = "30 mg·cm²"', 'motion = "fixed"')
    text += (
        '\n[[springs]]\nbody = "balance"\nfrequency = "4 Hz"\nrest = "5°"\n[[damping]]\nbody = "balance"\ncoulomb = "1 nN·m"\n'
    )
    scene = read(tmp_path, text)
    compiled = compile_scene(scene)
    assert len(compiled.model.joints) == 0 and compiled.model.bodies.carrier.tolist() == [-1, -1, -1]
    assert compiled.model.coordinates.rest == pytest.approx([math.radians(95.0)])
    assert compiled.relative(compiled.q[None])[0] == pytest.approx([math.radians(20.0)])


def test_chains_that_are_exact() -> None:
    """A hub fixed on a carriage, one coaxial with it, and what they carry."""
    carriage = Body("carriage", "pivot", (1.0, 2.0), 0.5, (3.0,), inertia=1.0)
    hub = Body("hub", "fixed", (0.2, 0.0), 0.4, on="carriage")
    wheel = Body("wheel", "pivot", (0.0, 0.1), 0.3, (1.0,), inertia=1.0, on="hub")
    ring = Body("ring", "pivot", (0.0, 0.0), 0.1, (2.0,), inertia=1.0, on="carriage")
    planet = Body("planet", "pivot", (0.5, 0.0), 0.2, (1.0,), inertia=1.0, on="ring")
    found = rides((planet, wheel, hub, ring, carriage))
    assert (found[2].part_of, found[2].host) == (4, 4)
    assert (found[1].host, found[1].turns_with, found[1].angle) == (4, 4, 0.4)
    assert found[1].place == pytest.approx((0.2 - 0.1 * math.sin(0.4), 0.1 * math.cos(0.4)))
    assert (found[1].start, found[1].spin) == pytest.approx((1.2, 4.0))
    assert (found[3].host, found[3].place, found[3].turns_with) == (-1, (1.0, 2.0), 4)
    assert (found[0].host, found[0].turns_with, found[0].spin) == (3, 3, 6.0)


REFUSED = [
    ('on = "carriag"', "bodies.balance.on", 'no such body. Did you mean "carriage"'),
    ('on = "balance"', "bodies.balance.on", "cannot carry itself"),
    ('on = "carriage"\nmotion = "slide"\naxis = [1.0, 0.0]', "bodies.balance.on", "pivoted or fixed there"),
    ('on = "carriage"\nmotion = "free"', "bodies.balance.on", "pivoted or fixed there"),
]


@pytest.mark.parametrize(("line", "key", "message"), REFUSED)
def test_what_is_refused_by_name(tmp_path, line: str, key: str, message: str) -> None:
    text = CARRIAGE.replace('on = "carriage"', line, 1)
    if "free" in line:
        text = text.replace('velocity = "90 °/s"\n', "")
    if "slide" in line:
        text = text.replace('velocity = "90 °/s"\n', "")
    assert message in faults(tmp_path, text)[key]


def test_a_chain_of_two_turning_carriers_is_refused(tmp_path) -> None:
    text = CARRIAGE + '\n[bodies.wheel]\non = "balance"\nposition = ["1 mm", "0 mm"]\ninertia = "1 mg·cm²"\n'
    assert "carried by carriage and turns on it" in faults(tmp_path, text)["bodies.wheel.on"]
    assert "would carry itself" in str(faults(tmp_path, CARRIAGE.replace('angle = "90°"', 'angle = "90°"\non = "balance"')))


def test_a_body_that_is_not_poised_is_refused(tmp_path) -> None:
    text = CARRIAGE.replace(
        'mass = "40 mg"\ninertia = "12 mg·cm²"',
        'mass = "40 mg"\npolygon = [["0 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "1 mm"]]',
    )
    assert "471.4 µm beside its pivot" in faults(tmp_path, text)["bodies.balance.on"]
    fixed = text.replace('velocity = "10 °/s"\ninertia = "30 mg·cm²"', 'motion = "fixed"')
    assert read(tmp_path, fixed).body("balance").mass == pytest.approx(40e-6)


def test_a_free_carrier_must_balance(tmp_path) -> None:
    text = CARRIAGE.replace('velocity = "10 °/s"\ninertia', 'motion = "free"\nmass = "100 mg"\ninertia')
    assert "moves to (0.8451, 0.05634) mm" in faults(tmp_path, text)["bodies.carriage"]


def test_dry_friction_and_idle_contacts_are_refused(tmp_path) -> None:
    text = CARRIAGE.replace('inertia = "30 mg·cm²"', 'inertia = "30 mg·cm²"\ncircle = "5 mm"')
    text += '\n[[damping]]\nbody = "balance"\ncoulomb = "1 nN·m"\n[[contacts]]\nbetween = ["banking", "carriage"]\n'
    found = faults(tmp_path, text)
    assert "dry friction between balance and a carrier that turns" in found["damping.0.coulomb"]
    assert "rigid with each other" in found["contacts.0.between"]
    with pytest.raises(ValueError, match="dry friction"):
        bodies = (Body("c", inertia=1.0), Body("b", inertia=1.0, on="c"))
        compile_scene(Scene("dry", bodies, damping=(Damping("b", coulomb=1.0),)))


def test_springs_join_two_coordinates() -> None:
    """The joint holds what acts between the two; neither flies alone, and the fastest swing is that of both."""
    bodies = (Body("c", inertia=3.0), Body("b", inertia=1.0, on="c"), Body("loose", inertia=1.0, on="c"))
    compiled = compile_scene(Scene("joint", bodies, springs=(Spring("b", 2.0, 0.3),)))
    joint = compiled.model.joints[0]
    assert (joint.coordinate, joint.on, joint.stiffness, joint.rest) == (1, 0, 2.0, 0.3)
    assert compiled.model.coordinates.linear.tolist() == [0, 0, 1]
    assert compiled.fastest == pytest.approx(math.sqrt(2.0 * (1.0 + 1.0 / 3.0)))


def test_check_tells_the_carrier_and_what_has_no_mass(tmp_path) -> None:
    text = CARRIAGE.replace('mass = "40 mg"\n', "")
    scene = read(tmp_path, text)
    report = check_report(scene, [])
    notices = [finding["message"] for finding in report["findings"] if finding["code"] == "weightless"]
    assert notices == ["balance has no mass, so it adds nothing to what carriage weighs"]
    assert report["bodies"]["balance"]["on"] == "carriage"
    assert "on carriage at (3 mm, 0 mm)" in check_text(report, scene)
    assert read(tmp_path, lock_text(scene, tmp_path)) == scene


@pytest.mark.parametrize(("off", "refused"), [(0.0, False), (1e-13, False), (1e-6, True)])
def test_rounding_of_the_places_is_no_lack_of_balance(tmp_path, off: float, refused: bool) -> None:
    """Two equal weights on either side of a free carrier without outlines, one of them a little off."""
    text = '[scene]\ntitle = "free"\n[bodies.carriage]\nmotion = "free"\nmass = "100 mg"\ninertia = "30 mg·cm²"\n'
    for name, x in (("left", -3e-3), ("right", 3e-3 + off)):
        text += f'[bodies.{name}]\non = "carriage"\nposition = ["{x!r} m", "0 mm"]\nmass = "40 mg"\ninertia = "12 mg·cm²"\n'
    text += '[run]\nduration = "1 s"\n'
    if refused:
        assert "centre of mass moves" in faults(tmp_path, text)["bodies.carriage"]
    else:
        assert read(tmp_path, text).body("right").mass == pytest.approx(40e-6)


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
