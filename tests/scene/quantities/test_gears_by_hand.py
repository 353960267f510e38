"""How do coordinates of geared bodies follow from one another, and what do they weigh? By hand, with unequal numbers."""

from __future__ import annotations

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene
from watchsim.scene.trains import bonds, felt, goes_with, note_gears, reached, rides, start_poses, ungeared, weigh

WHEEL = Body("wheel", inertia=7.0, angle=0.3)
PINION = Body("pinion", inertia=0.5, angle=-0.2, geared=Geared("wheel", -4.0))
RACK = Body("rack", "slide", mass=2.0, angle=0.9, geared=Geared("wheel", 0.25))
FREE = Body("free", inertia=11.0)
TRAIN = (PINION, FREE, RACK, WHEEL)


def test_an_angle_is_linear_in_that_of_the_holder() -> None:
    """Both stand at their start angles at once; a rack at the start of its way."""
    pinion, free, rack, wheel = bonds(TRAIN, rides(TRAIN))
    assert (free.to, wheel.to, pinion.to, rack.to) == (1, 3, 3, 3)
    assert (free.ratio, free.phase, free.told, free.shift) == (1.0, 0.0, 1.0, 0.0)
    assert (pinion.ratio, pinion.told) == (-4.0, -4.0) and (rack.ratio, rack.told) == (0.25, 0.25)
    for bond, start in ((pinion, -0.2), (rack, 0.0)):
        assert bond.ratio * 0.3 + bond.phase == pytest.approx(start) and bond.told * 0.3 + bond.shift == pytest.approx(start)


def test_a_planet_turns_with_what_carries_it_besides() -> None:
    """At -4 against its carrier it turns at -3 in the movement; `told` is what the scene says."""
    planet = Body("planet", inertia=0.5, angle=-0.2, on="wheel", geared=Geared("wheel", -4.0))
    _, bond = bonds((WHEEL, planet), rides((WHEEL, planet)))
    assert (bond.ratio, bond.told) == (-3.0, -4.0)
    assert bond.ratio * 0.3 + bond.phase == pytest.approx(0.1) and bond.told * 0.3 + bond.shift == pytest.approx(-0.2)


def test_each_feels_all_that_is_geared_to_it() -> None:
    """The energy of one unit of its own rate, doubled: all go on with the wheel."""
    weighed = weigh(TRAIN, rides(TRAIN))
    whole = 7.0 + 16.0 * 0.5 + 2.0 / 16.0
    assert felt(TRAIN, rides(TRAIN), weighed) == pytest.approx((whole / 16.0, 11.0, whole * 16.0, whole))
    alone = tuple(Body(body.name, body.motion, mass=body.mass, inertia=body.inertia) for body in TRAIN)
    assert felt(alone, rides(alone), weigh(alone, rides(alone))) == (0.5, 11.0, 2.0, 7.0)


def test_what_goes_with_what() -> None:
    """Gears with play count as those without."""
    scene = Scene("t", TRAIN, gears=(Gear(("pinion", "free"), 5.0, 0.1),))
    assert goes_with(scene, "wheel") == {"wheel": 1.0, "pinion": -4.0, "rack": 0.25, "free": -20.0}
    assert goes_with(scene, "rack") == {"rack": 1.0, "wheel": 4.0, "pinion": -16.0, "free": -80.0}
    assert goes_with(Scene("t", TRAIN), "free") == {"free": 1.0}
    ways = {"a": {"b": 3.0}, "b": {"a": 1 / 3, "c": -0.5}, "c": {"b": -2.0, "a": 99.0}}
    assert reached(ways, "a") == {"a": 1.0, "b": 3.0, "c": -1.5} and reached({}, "z") == {"z": 1.0}


def test_out_of_its_train_every_body_is_free() -> None:
    loose, rigid = Gear(("pinion", "free"), 5.0, 0.1), Gear(("wheel", "pinion"), -4.0, 0.0)
    bare = ungeared(Scene("t", TRAIN, gears=(loose,), rigid_gears=(rigid,)))
    assert bare.gears == bare.rigid_gears == () and all(body.geared is None for body in bare.bodies)
    for scene in (Scene("t", (FREE, PINION)), Scene("t", (FREE,), gears=(loose,))):
        assert ungeared(scene) != scene
    plain = Scene("t", (FREE, WHEEL))
    assert ungeared(plain) is plain


def complaints(*bodies: Body, pulled: tuple[str, ...] = ()) -> list[str]:
    found: list[str] = []
    note_gears(bodies, rides(bodies), frozenset(pulled), lambda name, message: found.append(f"{name}: {message}"))
    return found


LAW = Prescribed()


def test_only_one_of_those_geared_may_be_held() -> None:
    driven = Body("wheel", inertia=7.0, prescribed=LAW)
    rider = Body("rider", inertia=1.0, on="pinion")
    assert complaints(driven, PINION) == complaints(WHEEL, PINION, FREE) == complaints(WHEEL, PINION, pulled=("wheel",)) == []
    (one,) = complaints(driven, PINION, pulled=("pinion",))
    assert one.startswith("pinion: gravity turns pinion, which is not poised; wheel is driven. Of bodies geared")
    (two,) = complaints(rider, WHEEL, PINION, pulled=("pinion",))
    assert two.startswith("pinion: pinion carries others; . Of bodies geared")
    three = complaints(WHEEL, Body("pinion", inertia=0.5, prescribed=LAW, geared=Geared("wheel", -4.0)), pulled=("wheel",))
    assert three[0].startswith("pinion: pinion is driven; gravity turns wheel, which is not poised.")


def test_gears_bind_in_the_movement_or_on_a_carrier_alone() -> None:
    carriage = Body("carriage", inertia=9.0)
    on_it = Body("wheel", inertia=7.0, on="carriage")
    planet = Body("planet", inertia=0.5, on="carriage", geared=Geared("carriage", 3.0))
    assert complaints(carriage, planet) == []
    (one,) = complaints(carriage, on_it, PINION)
    assert one.startswith("pinion: wheel is itself carried by a body that turns. Gears bind bodies in the movement")
    (two,) = complaints(carriage, WHEEL, Body("planet", inertia=0.5, on="carriage", geared=Geared("wheel", 3.0)))
    assert two.startswith("planet: what carries it is not wheel. Gears bind")


def test_what_nobody_carries_stands_in_the_movement() -> None:
    """Also where its carrier is missing."""
    scene = Scene(
        "t", (Body("a", position=(3.0, -2.0), angle=0.4, on="none"), Body("b", position=(1.0, 0.0), angle=0.5, on="a"))
    )
    poses = start_poses(scene)
    assert poses["a"] == pytest.approx((3.0, -2.0, 0.4), abs=1e-15)
    assert poses["b"] == pytest.approx((3.0 + 0.921060994, -2.0 + 0.389418342, 0.9))


@pytest.mark.parametrize(("off", "refused"), [(1.9e-9, False), (2.1e-9, True)])
@pytest.mark.parametrize("order", [1, -1])
def test_a_load_is_poised_by_the_farthest_of_its_edges(off: float, refused: bool, order: int) -> None:
    """The middles of its edges lie 0.1 mm and 2 mm from its pivot; that of its carrier's count for nothing."""
    near, far, wide = (Loop((Line(x, -1e-3, x, 1e-3),), closed=False) for x in (0.1e-3, -2e-3, 50e-3))
    load = Body(
        "b", inertia=1.0, mass=3.0, centre_of_mass=(0.0, off), position=(0.2e-3, 0.0), on="c", loops=(near, far)[::order]
    )
    bodies = (Body("c", inertia=1.0, loops=(wide,)), load)
    found: list[str] = []
    weigh(bodies, rides(bodies), lambda name, _: found.append(name))
    assert found == (["b"] if refused else [])


@pytest.mark.parametrize(("off", "refused"), [(0.19e-9, False), (0.21e-9, True), (0.5e-9, True)])
def test_a_load_without_outlines_is_poised_by_its_reach(off: float, refused: bool) -> None:
    """0.2 mm from its carrier: a millionth of that."""
    bodies = (
        Body("c", inertia=1.0),
        Body("b", inertia=1.0, mass=3.0, centre_of_mass=(off, 0.0), position=(0.2e-3, 0.0), on="c"),
    )
    found: list[str] = []
    weigh(bodies, rides(bodies), lambda name, _: found.append(name))
    assert found == (["b"] if refused else [])
