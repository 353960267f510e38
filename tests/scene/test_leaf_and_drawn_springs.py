"""Is a leaf spring as stiff as a cantilever, and does a preloaded one stay on its stop until the preload is exceeded?"""

import math
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
import tomllib
from numpy.typing import NDArray

import watchsim as ws
from watchsim.geometry.hairspring import Coil
from watchsim.mechanism.compile import compile_scene, scene_size
from watchsim.paths import profiles_dir
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping, load
from watchsim.scene.scene import Body, Scene

LEAF = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm", arm = "2 mm" }'
SLIDER = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm" }'
JOULE = 1e-7  # kg·m²


def made(spring: str, more: str = "", body: str = 'inertia = "100 g·mm²"') -> Scene:
    text = f'[bodies.click]\ncircle = "1 mm"\n{body}\n[[springs]]\nbody = "click"\n{spring}\n{more}\n[run]\nduration = "1 s"\n'
    return from_mapping(tomllib.loads(text), Path("x/scene.toml"))


def stiffness_by_bending(modulus: float, length: float, width: float, thickness: float) -> float:
    """End load over deflection, from M(x) = F (L - x) integrated twice along the leaf: no closed form."""
    x: NDArray[np.float64] = np.linspace(0.0, length, 20001)
    curvature = (length - x) / (modulus * width * thickness**3 / 12.0)
    step = x[1]
    slope = np.concatenate(([0.0], np.cumsum(0.5 * step * (curvature[1:] + curvature[:-1]))))
    return 1.0 / float(np.sum(0.5 * step * (slope[1:] + slope[:-1])))


def test_it_is_as_stiff_as_a_cantilever() -> None:
    bent = stiffness_by_bending(200e9, 5e-3, 5e-4, 8e-5)
    assert made(SLIDER, body='motion = "slide"\naxis = [1.0, 0.0]\nmass = "1 g"').springs[0].stiffness == pytest.approx(
        bent, 1e-8
    )
    assert made(LEAF).springs[0].stiffness == pytest.approx(4e-6 * bent, 1e-8)
    line = f'[[line_springs]]\nbetween = ["click"]\npoints = [["1 mm", "0 mm"], ["5 mm", "0 mm"]]\n{SLIDER}'
    assert made(LEAF, line).line_springs[0].stiffness == pytest.approx(bent, 1e-8)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("pull", [0.0, 0.5, 0.99, 1.01, 2.0, 5.0])
def test_it_yields_once_the_preload_is_exceeded(side: float, pull: float) -> None:
    """A torque of `pull` times the preload: no motion up to 1, beyond (pull - 1) preload / stiffness from the stop."""
    preload = 3e-6 * side
    more = (
        f'[[torques]]\nbody = "click"\nvalue = "{-preload * pull!r} N·m"\n[[damping]]\nbody = "click"\nviscous = "5 µN·m·s/rad"'
    )
    scene = made(
        f'stiffness = "50 µN·m/rad"\npreload = "{preload!r} N·m"\nstop = "10°"', more, 'inertia = "100 g·mm²"\nangle = "10°"'
    )
    run = ws.simulate(scene, duration=3.0)
    expected = math.radians(10.0) - preload / 5e-5 * max(pull - 1.0, 0.0)
    assert run.end_q[0] == pytest.approx(expected, abs=1e-11)
    assert run.energy["residual_relative"] < 1e-9


def test_it_swings_back_to_its_stop_and_bounces() -> None:
    """From 20° beyond the stop, on a spring with its rest beyond it: time and speed of the impacts in closed form."""
    body = 'inertia = "100 g·mm²"\nangle = "-20°"'
    run = ws.simulate(made('stiffness = "50 µN·m/rad"\nrest = "8°"\nstop = "0°"\nrestitution = 0.5', body=body))
    w = math.sqrt(5e-5 / JOULE)
    first = math.acos(8.0 / 28.0) / w
    speed = w * math.radians(math.sqrt(28.0**2 - 8.0**2))
    times = np.array([first - 1e-9, first + 1e-9])
    assert run.sample(times)[1][:, 0] == pytest.approx([speed, -0.5 * speed], rel=1e-6)
    # The rebound is a swing about the same rest: its length from the speed alone.
    again = first + 2.0 * math.atan2(0.5 * speed / w, math.radians(8.0)) / w
    assert run.sample(np.array([again - 1e-9, again + 1e-9]))[1][:, 0] == pytest.approx([0.5 * speed, -0.25 * speed], rel=1e-6)
    assert run.end_q[0] == pytest.approx(0.0, abs=1e-12)
    stepped = ws.simulate(run.scene, method="moreau", step=2e-5, duration=0.05)
    assert stepped.end_q[0] == pytest.approx(run.at(0.05)[0][0], abs=2e-3)


def test_between_two_bodies_it_stops_one_against_the_other() -> None:
    """Free in space both go on together after the impact, with their common momentum."""
    other = '[bodies.wheel]\ncircle = "1 mm"\nposition = ["5 mm", "0 mm"]\ninertia = "300 g·mm²"\nvelocity = "1 rad/s"\n'
    scene = made('against = "wheel"\nstiffness = "1 nN·m/rad"\npreload = "10 nN·m"\nstop = "0.1 rad"', other)
    run = ws.simulate(scene.set("bodies.click.velocity", "2 rad/s"), duration=2.0)
    assert run.end_u == pytest.approx([1.25, 1.25], rel=1e-9)
    assert run.end_q[0] - run.end_q[1] == pytest.approx(0.1, abs=1e-12)


def test_a_slider_has_a_stop_too() -> None:
    body = 'motion = "slide"\naxis = [0.0, 1.0]\nmass = "1 g"'
    scene = made('stiffness = "10 N/m"\npreload = "-5 mN"\nstop = "-1 mm"\nrestitution = 0', body=body)
    run = ws.simulate(scene)
    # The rest lies 0.5 mm below the stop, the start 1 mm above it.
    assert run.end_q[0] == pytest.approx(-1e-3, abs=1e-14)
    w = math.sqrt(10.0 / 1e-3)
    before = math.acos(0.5 / 1.5) / w - 1e-9
    assert run.sample(np.array([before]))[1][0, 0] == pytest.approx(-w * 1.5e-3 * math.sqrt(8.0 / 9.0), rel=1e-6)


def test_a_carried_body_stops_against_its_carrier() -> None:
    """Angles are those against the carrier: free in space both go on together, with their common momentum about its axis."""
    carrier = '[bodies.carrier]\ncircle = "1 mm"\nposition = ["5 mm", "0 mm"]\nangle = "40°"\ninertia = "300 g·mm²"\n'
    body = 'on = "carrier"\ninertia = "100 g·mm²"\nmass = "1 g"\nposition = ["7 mm", "0 mm"]\nangle = "0.2 rad"'
    scene = made('stiffness = "1 nN·m/rad"\npreload = "-10 nN·m"\nstop = "0.1 rad"', carrier, body)
    run = ws.simulate(scene.set("bodies.click.velocity", "-1 rad/s"), duration=2.0)
    # The click has -1 rad/s against the carrier, which stands; with its mass 7 mm out the carrier has 300 + 49 g·mm².
    assert run.end_u[run.slices["carrier"].start] == pytest.approx(-100.0 / 449.0, rel=1e-6)
    assert run.end_u[run.slices["click"].start] == pytest.approx(0.0, abs=1e-9)
    assert run.end_q[run.slices["click"].start] == pytest.approx(0.1, abs=1e-12)
    assert run.energy["residual_relative"] < 1e-9


def test_a_stop_between_three_angles_is_refused() -> None:
    carrier = '[bodies.carrier]\ninertia = "300 g·mm²"\n[bodies.wheel]\ninertia = "300 g·mm²"\nposition = ["5 mm", "0 mm"]\n'
    with pytest.raises(SceneError, match="between three angles"):
        made(
            'against = "wheel"\nstiffness = "1 nN·m/rad"\nrest = "1 rad"\nstop = "0 rad"',
            carrier,
            'on = "carrier"\ninertia = "1 g·mm²"\nmass = "1 g"',
        )


FAULTS = [
    (LEAF + '\nstiffness = "1 µN·m/rad"', "stiffness and leaf say the same thing"),
    (SLIDER, 'missing: arm. Write e.g. leaf = { modulus = "200 GPa"'),
    (LEAF.replace("200 GPa", "200 N"), "force"),
    (LEAF.replace("0.08 mm", "8 mm"), "a leaf is thin"),
    ("leaf = 3", "a table is needed here, such as leaf ="),
    ('stiffness = "1 µN·m/rad"\npreload = "1 µN·m"\nrest = "1°"', "rest and preload say the same thing"),
    ('stiffness = "1 µN·m/rad"\nstop = "0°"', "the spring does not press on it"),
    ('stiffness = "1 µN·m/rad"\npreload = "1 µN·m"\nstop = "-5°"', "the body stands beyond it at the start"),
    ('stiffness = "1 µN·m/rad"\nrestitution = 0.3', "belongs to a spring with a stop"),
    ('stiffness = "1 µN·m/rad"\nrest = "5°"\nstop = "2°"\nrestitution = 2', "lies between 0 and 1"),
]


@pytest.mark.parametrize(("spring", "words"), FAULTS)
def test_what_cannot_be_is_refused(spring: str, words: str) -> None:
    with pytest.raises(SceneError) as caught:
        made(spring)
    assert words in str(caught.value)


def test_a_size_of_the_leaf_can_be_set() -> None:
    scene = made(LEAF)
    thicker = scene.set("springs.0.leaf.thickness", "0.16 mm")
    assert thicker.springs[0].stiffness == pytest.approx(8.0 * scene.springs[0].stiffness)
    assert scene.set("springs.0.stiffness", "1 µN·m/rad").springs[0].stiffness == 1e-6


def test_results_hold_a_scene_that_reads_the_same(tmp_path: Path) -> None:
    scene = made(LEAF + '\npreload = "10 µN·m"\nstop = "0°"')
    ws.write_results(ws.simulate(scene, duration=0.01), tmp_path / "run")
    assert ws.read_results(tmp_path / "run").scene.springs == scene.springs


PROFILES = Path(str(profiles_dir()))


def same(a: object, b: object) -> bool:
    """Equal to the bit, records field by field."""
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if hasattr(a, "_fields"):
        return all(same(getattr(a, name), getattr(b, name)) for name in a._fields)
    if isinstance(a, (tuple, list)):
        return isinstance(b, (tuple, list)) and len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)


@pytest.mark.parametrize("profile", ["swiss_lever", "coaxial"])
def test_what_is_only_drawn_changes_no_bit_of_the_model(profile: str) -> None:
    scene = load(PROFILES / profile)
    assert {loop.layer for loop in scene.body("balance").decoration} == {"RIM"} and scene.springs[0].coil is not None
    bare = replace(
        scene,
        bodies=tuple(replace(body, decoration=()) for body in scene.bodies),
        springs=tuple(replace(spring, coil=None) for spring in scene.springs),
    )
    with_rim, without = compile_scene(scene), compile_scene(bare)
    for field in fields(with_rim):
        assert same(getattr(with_rim, field.name), getattr(without, field.name)), field.name
    turned = compile_scene(scene.set("bodies.lever.adjust.ARMS", {"turn": "0.0001°"}))
    assert not same(with_rim.model, turned.model)


def test_a_hairspring_that_is_weighed_is_drawn_as_it_is_weighed() -> None:
    (spring,) = load(PROFILES / "balance").springs
    assert spring.coil == Coil(0.6e-3, 2.6e-3, 13.0, 0.0, 3e-5)


def test_dimensions_are_keys_like_any_other() -> None:
    scene = load(PROFILES / "swiss_lever").set("springs.0.draw.turns", 11).set("springs.0.draw.stud", "45°")
    assert scene.springs[0].coil.turns == 11 and scene.springs[0].coil.stud == pytest.approx(math.radians(45.0))


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("springs.0.draw.turn", 3, 'Did you mean "turns"'),
        ("springs.0.draw.outer", "0.1 mm", "stud must stand outside"),
        ("springs.0.draw.inner", "-1 mm", "above zero"),
        ("springs.0.draw.turns", 1e6, "1 to 100 turns"),
        ("springs.0.draw.width", "3 kg", "length"),
        ("springs.0.draw", 3, "a table is needed"),
        ("springs.0.draw", {"inner": "1 mm"}, "missing: outer"),
    ],
)
def test_what_cannot_be_drawn_is_said(key: str, value: object, said: str) -> None:
    scene: Scene = load(PROFILES / "swiss_lever")
    with pytest.raises(SceneError, match=said):
        scene.set(key, value)


def test_a_sliding_body_has_no_hairspring(tmp_path: Path) -> None:
    text = """
[bodies.slider]
circle = "1 mm"
motion = "slide"
axis = [1.0, 0.0]
mass = "1 g"
[[springs]]
body = "slider"
stiffness = "1 N/m"
draw = { inner = "1 mm", outer = "2 mm", turns = 5 }
"""
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match="wound about a pivot"):
        load(tmp_path / "scene.toml")


TEXT = """
[scene]
title = "two discs"
{law}
[bodies.a]
circle = "1 mm"
inertia = "1 g·cm²"
[bodies.b]
circle = "1 mm"
position = ["3 mm", "0 mm"]
inertia = "1 g·cm²"
[[contacts]]
between = ["a", "b"]
tangential_restitution = {tangential}
restitution = 0.5
[[torques]]
body = "a"
over = "time"
table = [["0 s", "0 N·m"], {row}]
[run]
duration = "1 s"
"""


def loaded(folder: Path, law: str = "", tangential: float = 0.0, row: str = '["1 s", "1 N·m"]') -> Scene:
    path = folder / "scene.toml"
    path.write_text(TEXT.format(law=law, tangential=tangential, row=row), encoding="utf-8")
    return load(path)


@pytest.mark.parametrize("row", ['["1 s"]', '["1 s", "1 N·m", "2 N·m"]', '"1 s"', "3", '"ab"', "[]"])
def test_two_values_in_each_row(tmp_path: Path, row: str) -> None:
    assert loaded(tmp_path).torques[0].table == ((0.0, 0.0), (1.0, 1.0))
    with pytest.raises(SceneError, match="two values are needed in each row"):
        loaded(tmp_path, row=row)


@pytest.mark.parametrize("tangential", [5e-4, 0.5])
def test_tangential_restitution_needs_a_law_that_gives_it_back(tmp_path: Path, tangential: float) -> None:
    assert loaded(tmp_path, 'tangential_law = "pg1996"', tangential).contacts[0].tangential_restitution == tangential
    with pytest.raises(SceneError, match="tangential_restitution"):
        loaded(tmp_path, 'tangential_law = "coulomb"', tangential)


def test_a_scene_without_outlines_is_a_millimetre_large() -> None:
    assert scene_size(Scene("none", (Body("a"), Body("b", "fixed")))) == pytest.approx(1e-3, rel=1e-12)
