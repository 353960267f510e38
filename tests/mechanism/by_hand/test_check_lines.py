"""What does `watchsim check` say of bodies and forces, line by line? Made-up scenes, numbers worked by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.mechanism.gears_in_words import gear_lines, ratio_words
from watchsim.mechanism.notes import notes
from watchsim.mechanism.static_check import _body_lines, _overlap_findings, _poise_lines, check_report
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.gearing import Gear, Geared
from watchsim.scene.oscillation import loads
from watchsim.scene.prescribed import Prescribed
from watchsim.scene.scene import Scene
from watchsim.scene.solid import Solid, Weight


def box(width: float, height: float, layer: str = "L") -> Loop:
    corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)), layer)


def test_bodies_one_by_one() -> None:
    scene = Scene(
        "t",
        (
            Body("a", inertia=3e-10, mass=2e-6, loops=(box(5e-3, 3e-3),), position=(1e-3, -2e-3), angle=0.5),
            Body("far", "slide", mass=20.0, inertia=7.0, loops=(box(30.0, 2e-3),)),
            Body("f", "free", mass=9.99, inertia=0.999e-3),
            Body("still", "fixed", mass=4.0),
            Body("load", "fixed", mass=3e-6, on="a", position=(4e-3, 0.0)),
            Body("driven", prescribed=Prescribed(), velocity=(2.0,), inertia=5.0, mass=2.0),
        ),
    )
    assert list(_body_lines(scene)) == [
        "  a       pivot  at (1 mm, -2 mm), turned by 28.6479°, 5 mm × 3 mm, mass 2 mg, inertia 3 mg·cm²",
        "      with load: mass 5 mg, inertia 3.48 mg·cm²",
        "      the common centre of mass lies 2.4 mm beside the pivot; the scene has no gravity, so this does nothing",
        "  far     slide  at (0 mm, 0 mm), turned by 0°, 30 m × 2 mm, mass 20 kg",
        "  f       free   at (0 mm, 0 mm), turned by 0°, no outline, mass 9.99 kg, inertia 9990 g·cm²",
        "  still   fixed  at (0 mm, 0 mm), turned by 0°, no outline",
        "  load    fixed  on a at (4 mm, 0 mm), turned by 0°, no outline, mass 3 mg",
        "  driven  pivot  at (0 mm, 0 mm), turned by 0°, no outline, driven at 114.592 °/s",
    ]


@pytest.mark.parametrize(
    ("kilograms", "words"),
    [(0.999e-3, "999 mg"), (1.001e-3, "1.001 g"), (0.999, "999 g"), (1.001, "1.001 kg"), (3e4, "30000 kg")],
)
def test_masses_have_the_first_unit_that_fits(kilograms: float, words: str) -> None:
    """In which they are below a thousand."""
    (line,) = _body_lines(Scene("t", (Body("s", "slide", mass=kilograms),)))
    assert line.endswith(f"mass {words}")


def test_solids_and_their_sum() -> None:
    plate = Solid("plate", "P", Weight(2e-6, (1e-3, -3e-3), 4e-12), 8e3, thickness=0.2e-3, count=3)
    drilled = replace(
        plate, layer="Q", loops=(box(1e-3, 1e-3, "H"), box(2e-3, 1e-3, "H"), box(9e-3, 9e-3, "Q")), bores=("H",), count=1
    )
    one = replace(drilled, loops=drilled.loops[1:])
    spring = Solid("hairspring", "", Weight(6e-6, (0.0, 0.0), 5e-12), 8e3)
    body = Body(
        "b",
        mass=16e-6,
        inertia=1e-9,
        solids=(plate, drilled, one, spring, replace(spring, kind="upright"), replace(spring, kind="lying")),
    )
    found = list(_body_lines(Scene("t", (body,))))[1:]
    kinds = [
        "plate of 0.2 mm",
        "plate of 0.2 mm less 2 bores",
        "plate of 0.2 mm less 1 bore",
        "hairspring, one third",
        "turned, upright on the pivot",
        "turned, lying",
    ]
    assert [line[6:].split("  ")[0].strip() for line in found] == [
        "P × 3",
        "Q",
        "Q",
        "hairspring",
        "upright",
        "lying",
        "together",
    ]
    assert all(kind in line for kind, line in zip(kinds, found, strict=False))
    assert found[0].endswith("0.24 mg·cm²  centre (1, -3) mm") and "2 mg" in found[0]
    assert (
        "24 mg" in found[-1]
        and found[-1].endswith("centre (0.25, -0.75) mm")
        and len({len(line.partition(" mg ")[0]) for line in found}) == 1
    )


def test_an_overlap_is_told_in_millimetres() -> None:
    disc = Loop((Arc(0.0, 0.0, 1e-3, 0.0, math.tau),), "D")
    two = (
        Body("a", position=(3e-3, 5e-3), inertia=1.0, loops=(disc,)),
        Body("b", "fixed", position=(4.9e-3, 5e-3), loops=(disc,)),
    )
    scene = Scene("t", two, contacts=(Contact((Side("b"), Side("a"))),))
    (finding,) = _overlap_findings(scene)
    assert (finding.x_mm, finding.y_mm) == (pytest.approx(3.95, abs=0.06), pytest.approx(5.0, abs=0.35))
    assert [entry["code"] for entry in check_report(scene, ())["findings"]] == ["overlap"]


def heavy_spot(*bodies: Body, gravity: tuple[float, float] = (0.0, 0.0)) -> list[str]:
    """What is told of the first of them."""
    return list(_poise_lines(Scene("t", bodies, gravity=gravity), bodies[0], loads(bodies)[1][0]))


@pytest.mark.parametrize(("gravity", "pull"), [((0.0, 0.0), None), ((3.0, -4.0), 5.0)])
def test_a_heavy_spot_is_told_with_what_gravity_does(gravity: tuple[float, float], pull: float | None) -> None:
    body = Body("b", mass=2e-3, inertia=1e-6, centre_of_mass=(3e-3, -4e-3))
    (line,) = heavy_spot(body, gravity=gravity)
    assert line == "      its centre of mass lies 5 mm beside the pivot" + (
        ": gravity turns it with up to 50 µN·m" if pull else "; the scene has no gravity, so this does nothing"
    )
    driven = replace(body, prescribed=Prescribed())
    for other in (replace(body, motion="free"), replace(body, mass=0.0), replace(body, centre_of_mass=(0.0, 0.0)), driven):
        assert not heavy_spot(other, gravity=gravity)
    bob = Body("c", "fixed", position=(-9e-3, 12e-3), mass=1e-3, on="b")  # together (-1, 4/3) mm, 3 g
    assert heavy_spot(body, bob, gravity=gravity)[0].startswith(
        "      the common centre of mass lies 1.667 mm beside the pivot"
    )


@pytest.mark.parametrize(
    ("x", "y", "width", "height", "far"), [(1e-3, -7e-3, 2e-3, 8e-3, 4e-3), (-5e-3, 3e-3, 9e-3, 2e-3, 4.5e-3)]
)
def test_rounding_of_a_centre_of_mass_is_a_share_of_what_is_drawn(
    x: float, y: float, width: float, height: float, far: float
) -> None:
    """A thousand-millionth of half the larger side, wherever it lies and whether it touches or not."""
    drawn = (box(width, height).moved(0.0, (x, y)),)
    for kind in ("loops", "decoration"):
        for share, told in ((0.95e-9, False), (1.05e-9, True)):
            body = replace(Body("b", mass=2e-3, centre_of_mass=(0.6 * share * far, 0.8 * share * far)), **{kind: drawn})  # type: ignore[arg-type]
            assert bool(heavy_spot(body)) is told


A, B = Body("a", inertia=2e-9), Body("b", inertia=8e-9)
S, T = Body("s", "slide", mass=2e-3), Body("t", "slide", mass=8e-3)
DRIVEN = Body("d", prescribed=Prescribed())


def test_gears_in_words() -> None:
    bodies = (
        replace(A, inertia=2.3456789e-9),
        replace(B, geared=Geared("a", -3.0)),
        S,
        replace(T, geared=Geared("a", 2e-3)),
        Body("c", inertia=1.0),
    )
    gears = (
        Gear(("a", "c"), 5.0, 0.5, 0.25, 0.875),
        Gear(("c", "s"), 3e-3, 4e-5),
        Gear(("s", "a"), 50.0, 0.1),
        Gear(("s", "t"), -2.0, 1e-5),
    )
    scene = Scene("t", bodies, gears=gears)
    felt = 2.3456789e-9 + 9.0 * 8e-9 + 4e-6 * 8e-3
    assert [line.replace("−", "-") for line in gear_lines(scene)] == [
        "  b is geared to a: -3 turns for one turn of it",
        "  t is geared to a: 12.5664 mm for one turn of it",
        f"  felt at a with all that is geared to it: {felt / 1e-10:.5g} mg·cm²",
        "  gears a - c: 5 turns for one turn, play 28.6479°, restitution 0.25, efficiency 87.5 %",
        "  gears c - s: 18.8496 mm for one turn, play 40 µm, restitution 0, efficiency 100 %",
        "  gears s - a: 0.00795775 turns for one mm, play 5.72958°, restitution 0, efficiency 100 %",
        "  gears s - t: -2 mm for one mm, play 10 µm, restitution 0, efficiency 100 %",
    ]
    assert ratio_words(scene, "a", "b", 1.5) == "1.5 turns for one turn"
    held = Scene(
        "t", (DRIVEN, replace(B, geared=Geared("d", -3.0)), replace(S, mass=2.3456789e-3), replace(T, geared=Geared("s", -2.0)))
    )
    assert [line for line in gear_lines(held) if "felt" in line] == ["  felt at s with all that is geared to it: 34.346 g"]


@pytest.mark.parametrize(
    ("start", "velocity", "told"),
    [(0.25, 0.0, True), (0.25 + 0.9e-9, 0.0, True), (0.25 - 1.1e-9, 0.0, False), (0.25, 0.9e-9, True), (0.25, -1.1e-9, False)],
)
def test_a_clock_at_rest_is_told(start: float, velocity: float, told: bool) -> None:
    """Nearer than a thousand-millionth of a radian, and as slow."""
    body = Body("a", inertia=2.0, angle=start, velocity=(velocity,))
    assert [note.code for note in notes(Scene("t", (body,), (Spring("a", 3.0, 0.25),)))] == (["at-rest"] if told else [])
    slide = Body("s", "slide", mass=2.0, angle=0.5, velocity=(velocity,))
    assert bool(notes(Scene("t", (slide,), (Spring("s", 3.0, start - 0.25),)))) is told


@pytest.mark.parametrize(("off", "told"), [(0.9e-9, False), (1.1e-9, True)])
def test_a_centre_of_mass_from_the_outline_is_told_where_it_is_off(off: float, told: bool) -> None:
    """By more than a thousand-millionth of the radius of gyration, 0.5 here."""
    body = Body("a", inertia=2.0, mass=8.0, centre_of_mass=(0.3 * off, 0.4 * off), angle=1.0)
    scene = Scene("t", (body,), gravity=(0.0, -9.0), source={"bodies": {"a": {"mass": "8 kg", "inertia": "2 kg·m²"}}})
    assert ("centre-of-mass" in [note.code for note in notes(scene)]) is told
