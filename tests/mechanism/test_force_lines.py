"""Is what a scene declares said in words with the right numbers, and what it leaves unsaid where it matters?

Numbers in the expected words are worked out by hand from those of the scene.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from watchsim.mechanism.notes import notes
from watchsim.mechanism.scene_in_words import force_lines, law_words, length, place, turned
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Damping, LineSpring, Mainspring, Side, Spring, Torque
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene

ARM = Body("arm", inertia=4e-9, mass=1e-3)  # 4 Hz on 1 uN·m/rad times (8 pi)² 4e-3
STIFF = 4e-9 * (8.0 * math.pi) ** 2
OTHER = Body("other", inertia=12e-9)
SLIDE = Body("slide", "slide", mass=2e-3)
WALL = Body("wall", "fixed")


def said(*bodies: Body, **forces: Any) -> list[str]:
    return [line.strip() for line in force_lines(Scene("said", bodies, **forces))]


@pytest.mark.parametrize(("rest", "stop"), [(0.0, math.radians(10.0)), (math.radians(20.0), math.radians(10.0))])
def test_a_spring_with_a_stop(rest: float, stop: float) -> None:
    """The preload is the same on either side."""
    preload = 1e9 * STIFF * math.radians(10.0)
    (line,) = said(ARM, springs=(Spring("arm", STIFF, rest, stop=stop, restitution=0.25),))
    start = f"spring on arm: {1e6 * STIFF:.6g} µN·m/rad, 4 Hz = 28800 vph, at rest at {math.degrees(rest):.6g}°"
    assert line == f"{start}, pressed on its stop at 10° with {preload:.4g} nN·m, restitution 0.25"
    # A driven wheel that the sprung body touches is no escapement: it rests there.
    touching: Any = {"torques": (Torque("other", 1e-6),), "contacts": (Contact((Side("arm"), Side("other"))),)}
    assert "4 Hz while it touches nothing, at rest" in said(ARM, OTHER, springs=(Spring("arm", STIFF, rest),), **touching)[1]


def test_a_spring_that_slides() -> None:
    """2 g on 3.2 N/m pi² swing at 20 Hz; a stop 1.5 mm away takes the force of that way."""
    stiffness = 2e-3 * (40.0 * math.pi) ** 2
    (line,) = said(SLIDE, springs=(Spring("slide", stiffness, 2e-3, stop=0.5e-3),))
    force = f"{1e3 * stiffness * 1.5e-3:.4g} mN"
    assert line == (
        f"spring on slide: {stiffness:.6g} N/m, 20 Hz = 144000 vph, at rest at 2 mm"
        f", pressed on its stop at 0.5 mm with {force}, restitution 0"
    )


def test_a_spring_between_two_bodies() -> None:
    """Against each other they swing with the reduced inertia, 3 of 4e-9; against what is driven, with their own."""
    both = said(ARM, OTHER, springs=(Spring("arm", STIFF, against="other"),))
    hertz = 4.0 * math.sqrt(4.0 / 3.0)
    assert both == [
        f"spring on arm against other: {1e6 * STIFF:.6g} µN·m/rad, {hertz:.6g} Hz while they touch nothing, at rest at 0°"
    ]
    driven = replace(OTHER, prescribed=Prescribed(square=4.0))
    assert "4 Hz while they" in said(ARM, driven, springs=(Spring("arm", STIFF, against="other"),))[0]


@pytest.mark.parametrize("square", [0.0, 4.0])
def test_how_a_driven_body_moves(square: float) -> None:
    swings = Prescribed(square=square)
    assert law_words(replace(ARM, prescribed=swings, velocity=(math.pi,))) == (
        f"driven, swings at {1e3 / math.pi:.6g} mHz" if square else "driven at 180 °/s"
    )
    assert law_words(replace(SLIDE, prescribed=Prescribed(), velocity=(2e-3,))) == "driven at 2 mm/s"
    assert law_words(replace(ARM, prescribed=Prescribed())) == "driven at 0 °/s"


def test_springs_between_points() -> None:
    springs = (
        LineSpring(("arm", "slide"), ((0.0, 0.0), (0.0, 0.0)), 20.0, 7e-3, 0.05),
        LineSpring(("arm", None), ((0.0, 0.0), (0.0, 0.0)), 2e3, 2e-5),
    )
    assert said(ARM, SLIDE, line_springs=springs) == [
        "spring from a point of arm to one of slide: 20 N/m, 7 mm long without force, damping 50 mN·s/m",
        "spring from a point of arm to one of the movement: 2 kN/m, 20 µm long without force",
    ]


def test_drives() -> None:
    steps = ((0.0, 1.0), (1.0, 2.0), (1.5, 1.0))
    spring = Mainspring(-12.5, 0.85, 3.0 * math.pi, 7e-3, 4e-10)
    torques = (
        Torque("arm", -2e-6),
        Torque("slide", 0.25),
        Torque("arm", over="angle", table=steps, against="other"),
        Torque("arm", over="time", table=steps, period=1.5),
        Torque("arm", 3e-6, "angle", steps, spring),
        Torque("arm", 3e-6, "angle", steps, replace(spring, inertia=0.0)),
    )
    barrel = "from 7 mN·m at the barrel 1.5 turns from full wind, ratio -12.5, efficiency 85 %"
    assert said(ARM, OTHER, SLIDE, torques=torques) == [
        "drive on arm: -2 µN·m",
        "drive on slide: 250 mN",
        "drive on arm against other: 3 values over angle",
        "drive on arm: 2 values over time, again after 1.5 s",
        f"drive on arm: 3 µN·m, {barrel}, train felt as 4 mg·cm²",
        f"drive on arm: 3 µN·m, {barrel}",
    ]


def test_dampers() -> None:
    """Q is the root of stiffness times inertia over the damping."""
    damping = (
        Damping("arm", 2e-9),
        Damping("arm", 2e-9, 3e-10, 4e-8),
        Damping("slide", 0.1, 0.2, 0.3),
        Damping("arm", 2e-9, against="other"),
        Damping("arm"),
    )
    quality = f"Q = {math.sqrt(STIFF * 4e-9) / 2e-9:.6g}"
    lines = said(ARM, OTHER, SLIDE, springs=(Spring("arm", STIFF),), damping=damping)
    assert lines[1:] == [
        f"damping on arm: 2 nN·m·s/rad, {quality}",
        f"damping on arm: 2 nN·m·s/rad, {quality}, 300 pN·m·s²/rad², dry friction 40 nN·m",
        "damping on slide: 100 mN·s/m, 200 mN·s²/m², dry friction 300 mN",
        "damping on arm against other: 2 nN·m·s/rad",
        "damping on arm: none",
    ]


def test_what_swings_by_its_weight() -> None:
    """1 g hangs 2 mm below the pivot: it pulls back with m g s; turned over, against the spring that holds it up."""
    hung, pull = replace(ARM, centre_of_mass=(0.0, -2e-3)), 1e-3 * 9.81 * 2e-3
    together = "its springs and gravity together, {} µN·m/rad of it from gravity"
    for stiffness, rest, gravity, by in (
        (0.0, 0, -9.81, "gravity alone, 19.62 µN·m/rad"),
        (5e-6, 0, -9.81, together.format("19.62")),
        (3e-5, 180, -9.81, together.format("-19.62")),
        (1e-6, 180, 9.81, together.format("19.62")),
    ):
        springs = (Spring("arm", stiffness, math.radians(rest)),) if stiffness else ()
        hertz = math.sqrt((stiffness + (pull if (rest == 0) is (gravity < 0.0) else -pull)) / 4e-9) / math.tau
        last = said(hung, springs=springs, gravity=(0.0, gravity))[-1]
        assert last == f"arm makes small swings at {hertz:.6g} Hz = {7200.0 * hertz:.6g} vph about {rest}° by {by}"


def test_distances_and_contacts() -> None:
    """One line for two pivots, however often they may touch; of a carried pivot, where it is at the start."""
    far = replace(OTHER, position=(3e-3, 4e-3))
    rider = Body("rider", position=(1e-3, 0.0), on="other", inertia=1e-9)
    contacts = (
        Contact((Side("arm"), Side("other", "TEETH")), 0.2, 0.5, 0.1),
        Contact((Side("other"), Side("arm")), 0.125),
        Contact((Side("arm"), Side("slide"))),
        Contact((Side("arm"), Side("rider"))),
    )
    assert said(ARM, far, SLIDE, rider, contacts=contacts, tangential_law="pg1996") == [
        "centre distance arm - other: 5 mm",
        f"centre distance arm - rider: {1e3 * math.hypot(4e-3, 4e-3):.6f} mm".replace("0 mm", " mm").rstrip(),
        "contact arm - other.TEETH: friction 0.2, restitution 0.5, tangential 0.1 (pg1996)",
        "contact other - arm: friction 0.125, restitution 0",
        "contact arm - slide: friction 0, restitution 0",
        "contact arm - rider: friction 0, restitution 0",
    ]


def test_where_lengths_change_their_unit() -> None:
    assert [length(value) for value in (0.99e-4, 1.01e-4, 0.99, 1.01, 0.0, -0.5)] == [
        *("99 µm", "0.101 mm", "990 mm", "1.01 m", "0 m", "-500 mm"),
    ]
    assert [place(value) for value in (1.23456789e-3, -4e-10, 1e-9, 0.6e-9, 0.4e-9, 0.1)] == [
        *("1.234568 mm", "0 mm", "0.000001 mm", "0.000001 mm", "0 mm", "100 mm"),
    ]
    assert [turned(math.radians(value)) for value in (1e-9, 0.4e-9, -33.333333333)] == ["1e-09°", "0°", "-33.3333°"]


def noted(*bodies: Body, source: dict[str, object] | None = None, **forces: Any) -> list[str]:
    scene = Scene("noted", bodies, source={"bodies": source or {}}, **forces)
    return [one.code for one in notes(scene)]


DOWN: Any = {"gravity": (0.0, -9.81)}


@pytest.mark.parametrize(("off", "code"), [(0.9e-9, []), (1.1e-9, ["centre-of-mass"])])
def test_a_centre_of_mass_beside_the_pivot_by_a_billionth(off: float, code: list[str]) -> None:
    """Of the radius of gyration, here 3 mm: it must have been taken from the outline, and gravity must be there."""
    gyration = 3e-3
    body = Body("arm", mass=2e-3, inertia=2e-3 * gyration**2, centre_of_mass=(0.6 * off * gyration, -0.8 * off * gyration))
    written: dict[str, object] = {"arm": {"mass": "2 g", "inertia": "1 g·cm²"}}
    assert noted(body, source=written, **DOWN) == code
    assert noted(body, source=written) == []
    for more in ("solids", "centre_of_mass"):
        assert noted(body, source={"arm": {"mass": "2 g", "inertia": "1", more: 1}}, **DOWN) == []
    assert noted(body, source={"arm": {"mass": "2 g"}}, **DOWN) == [] == noted(body, source={"arm": {"inertia": "1"}}, **DOWN)
    assert noted(WALL, replace(body, on="wall"), source=written, **DOWN) == []
    assert noted(replace(body, motion="free"), source=written, **DOWN) == []


def test_what_has_no_mass() -> None:
    """Gravity does not turn it; what moves it does not feel it. A carrier without mass of its own weighs what it carries."""
    bare, rider = Body("bare", inertia=1e-9), Body("rider", inertia=1e-9, on="bare")
    assert noted(bare, **DOWN) == ["poised"] and noted(bare) == [] and noted(replace(bare, mass=1e-6), **DOWN) == []
    assert noted(bare, rider) == ["weightless"] and noted(bare, rider, **DOWN) == ["poised", "poised", "weightless"]
    assert noted(bare, replace(rider, mass=1e-6)) == [] and noted(WALL, replace(rider, on="wall")) == []
    assert noted(SLIDE, **DOWN) == []


def test_a_lift_angle_that_nothing_reads() -> None:
    spring, touching = (Spring("arm", STIFF),), (Contact((Side("arm"), Side("other"))),)
    assert noted(ARM, OTHER, lift_angle=0.9) == ["lift-angle"]
    arm = replace(ARM, angle=1.0)
    assert noted(arm, OTHER, lift_angle=0.9, springs=spring) == ["lift-angle"]
    assert noted(arm, OTHER, lift_angle=0.9, springs=spring, contacts=touching) == [] == noted(arm, OTHER, springs=spring)


@pytest.mark.parametrize(
    ("angle", "speed", "rests"), [(0.5, 0.0, True), (0.9, 0.9, True), (1.1, 0.0, False), (0.0, -1.1, False)]
)
def test_what_starts_at_rest(angle: float, speed: float, rests: bool) -> None:
    """Nearer to its rest position than a billionth of a radian, and slower than that a second."""
    body = replace(ARM, angle=0.3 + 1e-9 * angle, velocity=(1e-9 * speed,))
    assert noted(body, springs=(Spring("arm", STIFF, 0.3),)) == (["at-rest"] if rests else [])
    mirrored = replace(ARM, angle=-0.3 - 1e-9 * angle)
    assert noted(mirrored, springs=(Spring("arm", STIFF, -0.3),)) == (["at-rest"] if angle < 1.0 else [])
    slide = replace(SLIDE, angle=1.0)
    assert noted(slide, springs=(Spring("slide", 1.0, 0.5e-9),)) == ["at-rest"]
    assert noted(slide, springs=(Spring("slide", 1.0, 2e-9),)) == []
    touching: Any = {"torques": (Torque("other", 1e-6),), "contacts": (Contact((Side("arm"), Side("other"))),)}
    assert noted(body, OTHER, springs=(Spring("arm", STIFF, 0.3),), **touching) == []
