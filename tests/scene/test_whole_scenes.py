"""Do the scenes of the project load with their real drawings, and do faults of real drawings reach the user?"""

import json
import math
from itertools import pairwise, permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomllib
from every_time import few
from scipy.interpolate import PPoly
from strangers import PIN_LEVER, needs, pin_lever_scene
from strangers import SCENES as SCENES_BESIDE

from watchsim.geometry.primitives import Arc
from watchsim.mechanism.overlap import overlaps
from watchsim.results.folder import lock_text
from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.read_settings import read_expectations
from watchsim.scene.roles import Roles, is_driven, roles, with_anchor
from watchsim.scene.scene import Body, Expectation, Scene, path, swing
from watchsim.scene.toml import toml_text, value_text

ROOT = Path(__file__).resolve().parents[2]
BENCH = SCENES_BESIDE / "bench_lever.json"
SCENES = sorted(ROOT.glob("profiles/*/scene*.toml"))


@pytest.mark.parametrize("path", few(SCENES, 12), ids=lambda path: f"{path.parent.name}/{path.name}")
def test_profiles_load_do_not_overlap_and_lock(path, tmp_path):
    scene = load(path)
    assert overlaps(scene) == []
    locked = tmp_path / "scene.lock.toml"
    locked.write_text(lock_text(scene, tmp_path), encoding="utf-8")
    assert load(locked) == scene


@needs(BENCH)
def test_bench_lever_agrees_with_its_source():
    source = json.loads(BENCH.read_text())
    scene = load(ROOT / "profiles/bench_lever/scene.toml")
    wheel, lever, balance, banking = scene.bodies
    assert wheel.inertia == source["wheel"]["inertia_kg_m2"]
    assert lever.inertia == source["lever"]["inertia_kg_m2"]
    assert balance.inertia == source["balance"]["inertia_kg_m2"]
    assert scene.springs[0].stiffness == pytest.approx(source["balance"]["stiffness_N_m_per_rad"], rel=1e-14)
    assert scene.damping[0].viscous == pytest.approx(source["balance"]["viscous_N_m_s"], rel=1e-14)
    assert scene.torques[0].value == source["wheel"]["torque_N_m"]
    corners = {(round(edge.x0 * 1e3, 8), round(edge.y0 * 1e3, 8)) for loop in wheel.loops for edge in loop.edges}
    expected = {(round(x, 8), round(y, 8)) for tooth in source["wheel"]["teeth_mm_in_wheel_frame"] for x, y in tooth}
    assert corners == expected
    centres = sorted((loop.edges[0].x * 1e3, loop.edges[0].y * 1e3) for loop in banking.loops)
    assert [c for centre in centres for c in centre] == pytest.approx(
        [c for pin in source["banking_pins_mm"] for c in pin["centre"]], abs=1e-9
    )


@needs(PIN_LEVER)
@pytest.mark.parametrize("name", ["scene.toml", "scene_as_drawn.toml"])
def test_the_real_lever_loads(name, tmp_path):
    scene = load(pin_lever_scene(name, tmp_path))
    assert overlaps(scene) == []
    assert len(scene.body("wheel").loops) >= 1
    assert not scene.body("wheel").decoration, "the drawing holds all parts"


def dxf(path: Path, units: int, gap: float = 0.0) -> None:
    """A triangle of lines whose last corner is open by `gap`, on layer PLATE, and a point on layer PIVOT."""
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    corners = [(0.0, 0.0), (3.0, 0.0), (0.0, 4.0), (0.0, gap)]
    for start, end in pairwise(corners):
        document.modelspace().add_line(start, end, {"layer": "PLATE"})
    document.modelspace().add_point((1.0, 1.0), {"layer": "PIVOT"})
    document.saveas(path)


SCENE = (
    '[bodies.plate]\ndrawing = "plate.dxf"\npivot = "PIVOT"\n[[bodies.plate.solids]]\nthickness = "1 mm"\ndensity = "1 g/cm³"\n'
)


def test_a_triangle_from_the_file_to_its_inertia(tmp_path):
    dxf(tmp_path / "plate.dxf", units=4)
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    (plate,) = load(tmp_path / "scene.toml").bodies
    mass = 6e-6
    assert plate.mass == pytest.approx(mass, rel=1e-9, abs=0.0)
    assert plate.centre_of_mass == pytest.approx((0.0, 1e-3 / 3), abs=1e-9)
    about_centroid = mass * (3.0**2 + 4.0**2) / 18 * 1e-6
    assert plate.inertia == pytest.approx(about_centroid + mass * (1e-3 / 3) ** 2, rel=1e-6, abs=0.0)
    assert math.isclose(min(edge.x0 for edge in plate.loops[0].edges), -1e-3, rel_tol=1e-9)


def test_missing_units_and_open_outlines_are_told_with_their_cure(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE, encoding="utf-8")
    dxf(tmp_path / "plate.dxf", units=0)
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert f"{scene}:2  bodies.plate.drawing -> plate.dxf\n  the drawing does not say its units" in str(caught.value)
    assert 'Set units = "mm" (or "inch") under [bodies.plate].' in str(caught.value)
    dxf(tmp_path / "plate.dxf", units=4, gap=0.023)
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert "bodies.plate.drawing -> plate.dxf, layer PLATE\n  the outline is open: 23 µm between" in str(caught.value)
    assert 'set snap = "' in str(caught.value) and "under [bodies.plate]." in str(caught.value)


def test_the_cures_work(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace("[[", 'units = "inch"\nsnap = "600 µm"\n[[', 1), encoding="utf-8")
    dxf(tmp_path / "plate.dxf", units=0, gap=0.02)
    (plate,) = load(scene).bodies
    assert max(edge.y0 for edge in plate.loops[0].edges) == pytest.approx(3 * 0.0254, rel=1e-6)


ROLLER = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 {page} viewBox="0 0 10 10">
 <g inkscape:groupmode="layer" inkscape:label="ROLLER" transform="translate(4,6)">
  <circle r="2"/>
 </g>
 <g inkscape:groupmode="layer" inkscape:label="PIN" transform="translate(4,6)">
  <path d="M 1.2,-0.25 h 0.3 a 0.25,0.25 0 0 1 0,0.5 h -0.3 z"/>
 </g>
 <circle id="PIVOT" cx="4" cy="6" r="{pivot}"/>
 <g id="DRESS"><path d="M 0 0 L 1 1"/><text>Hebelscheibe</text></g>
</svg>"""
SCENE_SCENES_WITH_SVG = """[bodies.balance]
drawing = "roller.svg"
layers = ["ROLLER", "PIN"]
pivot = "PIVOT"
{units}
[[bodies.balance.solids]]
layer = "ROLLER"
thickness = "0.5 mm"
density = "8 g/cm³"
"""


def written(tmp_path, page='width="10mm" height="10mm"', units="", pivot="0.1"):
    (tmp_path / "roller.svg").write_text(ROLLER.format(page=page, pivot=pivot), encoding="utf-8")
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE_SCENES_WITH_SVG.format(units=units), encoding="utf-8")
    return scene


@pytest.mark.parametrize("pivot", ["0.1", "0"])
@pytest.mark.parametrize(
    ("page", "units", "unit"),
    [('width="10mm" height="10mm"', "", 1e-3), ("", 'units = "mm"', 1e-3), ('width="500"', 'units = "inch"', 0.0254)],
)
def test_a_roller_turns_about_its_pivot(tmp_path, page, units, unit, pivot):
    (balance,) = load(written(tmp_path, page, units, pivot)).bodies
    radius = 2 * unit
    mass = math.pi * radius**2 * 0.5e-3 * 8000
    assert balance.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert balance.inertia == pytest.approx(mass * radius**2 / 2, rel=1e-12, abs=0.0)
    assert sorted(loop.layer for loop in balance.loops) == ["PIN", "ROLLER"]
    (pin,) = (loop for loop in balance.loops if loop.layer == "PIN")
    (head,) = (edge for edge in pin.edges if isinstance(edge, Arc))
    assert (head.x, head.y, head.radius) == pytest.approx((1.5 * unit, 0.0, 0.25 * unit), abs=1e-14)


def test_a_page_without_unit_and_a_wrong_layer_are_told(tmp_path):
    with pytest.raises(SceneError) as caught:
        load(written(tmp_path, 'width="500" height="500"'))
    assert "bodies.balance.drawing -> roller.svg\n  the drawing does not say its units" in str(caught.value)
    scene = written(tmp_path)
    scene.write_text(scene.read_text(encoding="utf-8").replace('"PIN"]', '"PINS"]'), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(scene)
    assert 'Did you mean "PIN"?' in str(caught.value)


def expected(entries: Any) -> tuple[tuple[Expectation, ...], list[str]]:
    faults = Faults()
    found = read_expectations({"expect": entries}, faults)
    return found, [f"{fault.key}{fault.shown}: {fault.message}" for fault in faults.found]


@pytest.mark.parametrize(
    ("key", "value", "tolerance", "number", "width", "unit"),
    [
        ("amplitude", "270°", "0.05 rad", 270.0, math.degrees(0.05), "°"),
        ("amplitude", "4.5 rad", "9°", 4.5, math.radians(9.0), "rad"),
        ("rate", "-3 s/d", "7 ppm", -3.0, 0.6048, "s/d"),
        ("period", "250 ms", "0.001 s", 250.0, 1.0, "ms"),
        ("frequency", "28800 vph", "0.5 Hz", 28800.0, 3600.0, "vph"),
        ("impacts", 7, 2, 7.0, 2.0, ""),
        ("anything", "3 mm", "5 µm", 3.0, 0.005, "mm"),
        ("share", "12 %", "3 %", 12.0, 3.0, "%"),
    ],
)
def test_a_promise_is_kept_in_the_unit_of_its_value(
    key: str, value: object, tolerance: object, number: float, width: float, unit: str
) -> None:
    (found,), said = expected({key: {"value": value, "tolerance": tolerance}})
    assert not said and (found.key, found.value, found.unit) == (key, number, unit)
    assert found.tolerance == pytest.approx(width, rel=1e-12)


REFUSED = [
    ({"amplitude": {"value": "3 s", "tolerance": "1°"}}, 'expect.amplitude.value = "3 s": "3 s" is a time; here an angle'),
    ({"amplitude": {"value": "3°", "tolerance": "1 s"}}, 'expect.amplitude.tolerance = "1 s": "1 s" is a time; here an angle'),
    ({"any": {"value": "3 mm", "tolerance": 1}}, 'expect.any.tolerance = 1: a bare number needs a unit here. Write "1 mm"'),
    (
        {"any": {"value": "0.5 %", "tolerance": 0.03}},
        'expect.any.tolerance = 0.03: a bare number needs a unit here. Write "0.03%"',
    ),
    (
        {"amplitude": {"value": "270°", "tolerance": 1}},
        "expect.amplitude.tolerance = 1: a bare number needs a unit here: 1 rad and 1° differ by a factor of 57.3. ",
    ),
    ({"any": {"value": "3 mm", "tolerance": "0 mm"}}, 'expect.any.tolerance = "0 mm": must be above zero'),
    ({"any": {"value": "3 mm", "tolerance": "-1 mm"}}, 'expect.any.tolerance = "-1 mm": must be above zero'),
    ({"any": {"value": "3 mm"}}, "expect.any: missing: tolerance. Write e.g. { value = 500, tolerance = 3 }"),
    ({"any": {"tolerance": "3 mm"}}, "expect.any: missing: value. Write e.g. { value = 500"),
    ({"any": 3}, "expect.any = 3: a table of keys is needed here"),
    (3, "expect = 3: write e.g."),
]


@pytest.mark.parametrize(("entries", "words"), REFUSED)
def test_a_promise_that_cannot_be_kept(entries: Any, words: str) -> None:
    found, said = expected(entries)
    assert len(said) == 1 and said[0].startswith(words) and (found == () or "tolerance" in words)


MAPPING: dict[str, Any] = {
    "title": 'a "quoted" µ\ntext\x7f\\',
    "numbers": [1, 2.5, -3e-300, 1e22],
    "truth": [True, False],
    "empty": {},
    "lists": [[1, [2]], []],
    "table": {"a.b": 1, "nested": {"deep": "x"}, "of": [{"k": 1, "in": {"v": 2}}, {"k": 3}]},
    "tables": [{"name": "x", "inner": [{"y": 1}, {"y": 2}]}, {}],
    "only": {"inner": {"z": 5}},
}


def test_what_is_written_reads_back_the_same() -> None:
    assert tomllib.loads(toml_text(MAPPING)) == MAPPING and toml_text({}) == "\n"
    assert toml_text({"a": 1, "b": {"c": 2}}) == "a = 1\n\n[b]\nc = 2\n"
    assert toml_text({"only": {"inner": {"z": 5}}}) == "[only.inner]\nz = 5\n"
    assert toml_text({"t": [{"a": 1}, {"a": 2}]}) == "[[t]]\na = 1\n\n[[t]]\na = 2\n"
    with pytest.raises(TypeError, match="TOML cannot hold complex"):
        value_text([1j])


def test_faults_come_in_the_order_of_the_file_each_once() -> None:
    """At their own line, else at that of the table that holds them; what was changed since is named so."""
    faults = Faults("f.toml", {"a": 9, "a.b": 4, "c": 2}, frozenset({"c.x"}))
    for key in ("a.b", "a.z", "c.x", "c.x.1", "c.xy", "a.b.0", "none", "a.b"):
        faults.add(key, "wrong")
    places = {fault.key: fault.place for fault in faults.found}
    assert places == {
        **{"a.b": "f.toml:4", "a.b.0": "f.toml:4", "a.z": "f.toml:9", "c.xy": "f.toml:2"},
        **{"c.x": "changed value", "c.x.1": "changed value", "none": "f.toml"},
    }
    with pytest.raises(SceneError) as caught:
        faults.raise_any()
    assert [fault.key for fault in caught.value.faults] == ["none", "c.x", "c.x.1", "c.xy", "a.b", "a.b.0", "a.z"]
    Faults().raise_any()
    assert (
        str(Fault("k", "why", " = 3", "here")) == "here  k = 3\n  why."
        and str(Fault("", "why?\nso", "", "here")) == "here\n  why?\n  so."
    )


@pytest.mark.parametrize(
    ("names", "taken"), [(("scene.toml", "scene.lock.toml"), "scene.toml"), (("scene.lock.toml",), "scene.lock.toml")]
)
def test_of_a_folder_the_scene_comes_before_its_lock(tmp_path: Path, names: tuple[str, ...], taken: str) -> None:
    for name in names:
        (tmp_path / name).write_text('[bodies.b]\ninertia = "1 g·cm²"\n', encoding="utf-8-sig")
    scene = load(tmp_path)
    assert scene.path == tmp_path / taken and scene.title == tmp_path.name
    with pytest.raises(SceneError, match=r"cannot be read: .*\."):
        load(tmp_path / taken / "below")


@pytest.mark.parametrize(
    ("text", "line"), [("a = 1\nb = \n", 2), ("a = 1\n\n[b\n", 3), ('a = """x\n\n\n', 3), ("a = 1\na = 2\n", 2)]
)
def test_what_is_no_toml_is_told_with_its_line(tmp_path: Path, text: str, line: int) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(path)
    (fault,) = caught.value.faults
    assert fault.place == f"{path}:{line}" and fault.message.startswith("not valid TOML: ") and "(at" not in fault.message


BODIES = tuple(Body(name, "pivot", inertia=1.0) for name in ("third", "wheel", "fork", "balance"))
TOUCHES = tuple(Contact((Side(a), Side(b))) for a, b in (("wheel", "fork"), ("fork", "balance"), ("third", "wheel")))
LEVER = Roles("balance", "wheel", "fork")


@pytest.mark.parametrize("bodies", list(permutations(BODIES)), ids=lambda bodies: "-".join(body.name for body in bodies))
def test_the_lever_touches_both(bodies: tuple[Body, ...]) -> None:
    """The third wheel touches one of them; a torque on the fork itself makes it no wheel."""
    torques = (Torque("fork", 1.0), Torque("wheel", 1.0))
    for order in (torques, torques[::-1], torques[1:]):
        assert roles(Scene("", bodies, (Spring("balance", 1.0),), order, contacts=TOUCHES)) == LEVER


def test_a_lever_may_touch_by_way_of_what_it_carries() -> None:
    bodies = (*BODIES, Body("spring", "pivot", inertia=1.0, on="fork"))
    touches = (TOUCHES[0], Contact((Side("spring"), Side("balance"))))
    assert roles(Scene("", bodies, (Spring("balance", 1.0),), (Torque("wheel", 1.0),), contacts=touches)) == LEVER


def test_what_is_not_there_is_not_found() -> None:
    torques = (Torque("wheel", 1.0),)
    assert roles(Scene("", BODIES, (Spring("balance", 1.0),), torques, contacts=TOUCHES[:1])) == Roles("balance", "wheel", None)
    assert roles(Scene("", BODIES, (), torques, contacts=TOUCHES)) == Roles(None, "wheel", None)
    assert roles(Scene("", BODIES, (Spring("balance", 1.0),), contacts=TOUCHES)) == Roles("balance", None, None)


def test_a_scene_is_driven_where_any_torque_puts_work_in() -> None:
    nothing, value, table = Torque("fork", 0.0), Torque("wheel", -1.0), Torque("wheel", table=((0.0, 1.0), (1.0, 2.0)))
    for torques, driven in (((), False), ((nothing,), False), ((nothing, value), True), ((nothing, table), True)):
        assert is_driven(Scene("", BODIES, torques=torques)) is driven


@pytest.mark.parametrize("touches", [TOUCHES, TOUCHES[:1]])
def test_only_a_pendulum_that_touches_the_wheel_itself_is_its_own_lever(touches: tuple[Contact, ...]) -> None:
    direct = Contact((Side("wheel"), Side("balance")))
    springs, torques = (Spring("balance", 1.0),), (Torque("wheel", 1.0),)
    swing = Scene("", BODIES, springs, torques, contacts=(*touches, direct), lift_angle=1.0)
    assert with_anchor(swing) == (LEVER if len(touches) > 1 else Roles("balance", "wheel", "balance"))


PATHS = [
    ((0.0, 0.3), (2.0, -1.0)),
    ((0.0, 0.0), (1.0, 2.0), (1.5, 2.0)),
    ((0.0, 1.0), (0.1, 1.5), (0.4, -2.0), (1.0, 0.0), (1.7, 0.5)),
    ((1.0, 5.0), (3.0, 5.0)),
]


@pytest.mark.parametrize("points", PATHS, ids=len)
def test_a_path_passes_its_points_and_ends_at_rest(points: tuple[tuple[float, float], ...]) -> None:
    """By scipy's integrals of the piecewise linear acceleration."""
    times, places = np.array(points).T
    knots, a = np.array(path(points).table).T
    bend = PPoly(np.array([np.diff(a) / np.diff(knots), a[:-1]]), knots)
    speed = bend.antiderivative()
    assert a[0] == a[-1] == 0.0 and len(knots) == len(points) + 2
    assert speed(times[-1]) == pytest.approx(0.0, abs=1e-12)
    assert places[0] + speed.antiderivative()(times) == pytest.approx(places, abs=1e-12)


def test_knots_divide_the_first_and_the_last_stretch() -> None:
    assert [t for t, _ in path(PATHS[0]).table] == pytest.approx([0.0, 2.0 / 3.0, 4.0 / 3.0, 2.0])
    assert [t for t, _ in path(PATHS[1]).table] == pytest.approx([0.0, 0.5, 1.0, 1.25, 1.5])


@pytest.mark.parametrize("phase", [0.0, 0.7, -2.0])
def test_a_swing(phase: float) -> None:
    law, start, speed = swing(0.2, 1.5, 3.0, phase)
    w = 2.0 * math.pi * 3.0
    assert (law.square, law.middle, law.table) == (pytest.approx(w * w), 0.2, ())
    assert start == pytest.approx(0.2 + 1.5 * math.sin(phase)) and speed == pytest.approx(1.5 * w * math.cos(phase))
