"""Does a scene file become the scene it describes?"""

import hashlib
import math
import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from made_scenes import drawing, square

import watchsim as ws
from watchsim.cli import main
from watchsim.drawing.read import read as read_drawing
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.forces import Contact, Damping, LineSpring, Side, Spring, Torque
from watchsim.scene.keys import RUN
from watchsim.scene.load import load
from watchsim.scene.outlines import forget_drawings
from watchsim.scene.read_settings import read_record
from watchsim.scene.roles import Oscillator
from watchsim.scene.scene import (
    ALL,
    EVENTS,
    EVERYTHING,
    STATISTICS,
    WHOLE_RUN,
    Body,
    Expectation,
    Gear,
    Prescribed,
    Recording,
    Scene,
    as_recording,
)
from watchsim.scene.solids import Solid, Weight
from watchsim.scene.trains import MOVEMENT, Bond, Ride, Weighed
from watchsim.scene.values import Table


def test_all_values_arrive_in_si(desk):
    scene = load(desk.scene())
    wheel, lever, balance, banking = scene.bodies
    assert scene.title == "Small lever"
    assert (wheel.name, wheel.motion, wheel.inertia, wheel.velocity) == ("wheel", "pivot", 5e-12, (0.0,))
    assert (lever.position, lever.angle) == ((0.0, 0.009), pytest.approx(math.radians(10)))
    assert balance.velocity == (pytest.approx(2.0 * math.pi),)
    assert (banking.motion, banking.velocity, banking.inertia) == ("fixed", (), 0.0)
    assert scene.springs[0].stiffness == pytest.approx(1.2e-9 * (8.0 * math.pi) ** 2, rel=1e-15)
    assert scene.torques[0].value == -1e-6
    assert scene.damping[0].viscous == pytest.approx(1.2e-9 * 8.0 * math.pi / 250, rel=1e-15)
    assert scene.contacts[0].sides == (Side("wheel", "TEETH"), Side("lever"))
    assert (scene.contacts[0].friction, scene.contacts[0].restitution) == (0.12, 0.2)
    assert (scene.duration, scene.record, scene.tolerance) == (180.0, Recording(((179.0, 180.0),)), 1e-8)
    assert scene.lift_angle == pytest.approx(math.radians(52))
    amplitude, impacts = scene.expect
    assert amplitude == Expectation("amplitude", 275.0, pytest.approx(math.degrees(0.02)), "°")
    assert impacts == Expectation("impacts", 500.0, 3.0, "")


def test_outlines_are_about_the_pivot_and_the_rest_is_decoration(desk):
    wheel = load(desk.scene()).body("wheel")
    assert wheel.layers == ("TEETH",)
    corners = sorted((round(edge.x0, 12), round(edge.y0, 12)) for edge in wheel.loops[0].edges)
    assert corners == [(-0.005, -0.005), (-0.005, 0.005), (0.005, -0.005), (0.005, 0.005)]
    assert [loop.layer for loop in wheel.decoration] == ["BORE"]
    assert wheel.decoration[0].edges[0].x == pytest.approx(0.0, abs=1e-15)


def test_a_drawing_of_several_bodies_decorates_none(desk, good):
    other = '[bodies.other]\ndrawing = "wheel.dxf"\nlayers = ["BORE"]\nposition = ["0 mm", "50 mm"]\nmotion = "fixed"\n'
    scene = load(desk.scene(good + other))
    assert scene.body("wheel").decoration == scene.body("other").decoration == ()
    assert scene.body("other").loops[0].edges[0].x == 0.003


def test_default_layers_are_all_but_the_pivot(desk, good):
    text = good.replace('layers = ["TEETH"]\n', "").replace('pivot = "PIVOT"', 'pivot = "BORE"')
    wheel = load(desk.scene(text)).body("wheel")
    assert wheel.layers == ("TEETH",)
    assert wheel.loops[0].edges[0].x0 == pytest.approx(-0.005)


def test_units_and_snap_reach_the_reader(desk, good):
    load(desk.scene(good.replace('pivot = "PIVOT"', 'pivot = "PIVOT"\nunits = "inch"\nsnap = "25 µm"')))
    assert desk.asked[-1] == ("wheel.dxf", "inch", 25e-6)


def test_warnings_of_drawings_travel_with_the_scene(desk):
    (finding,) = load(desk.scene()).findings
    assert (finding.code, finding.severity) == ("duplicate", "warning")
    assert finding.message == "wheel.dxf: an edge was drawn twice"


def test_polygons_run_counter_clockwise(desk, good):
    turned = good.replace(
        '[["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "3 mm"]]', '[["1 mm", "0 mm"], ["-1 mm", "0 mm"], ["0 mm", "3 mm"]]'
    )
    edges = load(desk.scene(turned)).body("lever").loops[0].edges
    assert sum(edge.x0 * edge.y1 - edge.x1 * edge.y0 for edge in edges) / 2 == pytest.approx(3e-6)


INCLINE = """
[scene]
gravity = ["3.3552176060248105 m/s²", "-9.21838460990976 m/s²"]
[bodies.disc]
circle = "50 mm"
motion = "free"
position = ["0 mm", "150 mm"]
velocity = ["1 m/s", "-2 m/s"]
spin = "3 rad/s"
mass = "1 kg"
[bodies.plane]
line = [["20 m", "0 m"], ["-1 m", "0 m"]]
motion = "fixed"
[[contacts]]
between = ["disc", "plane"]
"""


def test_free_body_and_open_line(desk):
    scene = load(desk.scene(INCLINE))
    disc, plane = scene.bodies
    assert disc.velocity == (1.0, -2.0, 3.0)
    assert disc.inertia == pytest.approx(0.5 * 0.05**2, rel=1e-12, abs=0.0), "a uniform disc where nothing else is said"
    assert scene.gravity == (3.3552176060248105, -9.21838460990976)
    (loop,) = plane.loops
    assert not loop.closed and loop.edges[0].end == (-1.0, 0.0)


def test_sliding_body_takes_linear_units(desk):
    text = """
[bodies.slider]
polygon = [["0 mm", "0 mm"], ["1 mm", "0 mm"], ["1 mm", "1 mm"]]
motion = "slide"
axis = [3.0, 4.0]
velocity = "10 mm/s"
mass = "2 g"
[[springs]]
body = "slider"
frequency = "1 Hz"
rest = "1 mm"
[[torques]]
body = "slider"
over = "travel"
table = [["0 mm", "1 mN"], ["5 mm", "3 mN"]]
[[damping]]
body = "slider"
viscous = "1 mN·s/m"
quadratic = "2 N·s²/m²"
"""
    scene = load(desk.scene(text))
    assert scene.bodies[0].axis == (0.6, 0.8)
    assert scene.bodies[0].velocity == (0.01,)
    assert (scene.springs[0].stiffness, scene.springs[0].rest) == (pytest.approx(0.002 * 4 * math.pi**2), 0.001)
    assert (scene.torques[0].over, scene.torques[0].table) == ("angle", ((0.0, 1e-3), (0.005, 3e-3)))
    assert (scene.damping[0].viscous, scene.damping[0].quadratic) == (1e-3, 2.0)


def test_torque_over_time(desk, good):
    table = 'over = "time"\ntable = [["0 s", "0 µN·m"], ["1 s", "-1 µN·m"]]'
    scene = load(desk.scene(good.replace('value = "-1.0 µN·m"', table)))
    assert (scene.torques[0].over, scene.torques[0].table) == ("time", ((0.0, 0.0), (1.0, -1e-6)))


SOLID = '[[bodies.wheel.solids]]\nlayer = "TEETH"\nthickness = "0.12 mm"\ndensity = "7.85 g/cm³"\n'


def test_mass_and_inertia_from_solids(desk, good):
    wheel = load(desk.scene(good.replace('inertia = "0.05 mg·cm²"\n', "", 1) + SOLID)).body("wheel")
    mass = 0.01**2 * 0.00012 * 7850
    assert wheel.mass == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert wheel.inertia == pytest.approx(mass * 0.01**2 / 6, rel=1e-12, abs=0.0)
    assert wheel.centre_of_mass == pytest.approx((0.0, 0.0), abs=1e-15)


def test_solids_away_from_the_pivot_follow_steiner(desk, good):
    text = good.replace('inertia = "0.05 mg·cm²"\n', "", 1).replace('pivot = "PIVOT"', 'pivot = ["0 mm", "0 mm"]')
    wheel = load(desk.scene(text + SOLID + SOLID.replace("TEETH", "BORE"))).body("wheel")
    plate, disc = 0.01**2 * 0.00012 * 7850, math.pi * 1e-6 * 0.00012 * 7850
    assert wheel.mass == pytest.approx(plate + disc, rel=1e-12, abs=0.0)
    expected = plate * 0.01**2 / 6 + disc * 1e-6 / 2 + (plate + disc) * 0.005**2
    assert wheel.inertia == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert wheel.centre_of_mass == pytest.approx((0.003, 0.004), rel=1e-12, abs=0.0)


def test_a_stated_inertia_wins_over_solids(desk, good):
    wheel = load(desk.scene(good + SOLID)).body("wheel")
    assert wheel.inertia == 5e-12
    assert wheel.mass == pytest.approx(0.01**2 * 0.00012 * 7850)


def test_free_bodies_are_about_their_centre_of_mass(desk, good):
    text = good.replace('layers = ["TEETH"]\npivot = "PIVOT"', 'layers = ["TEETH"]\nmotion = "free"\nmass = "1 g"')
    text = text.replace('[[torques]]\nbody = "wheel"\nvalue = "-1.0 µN·m"\n', "")
    wheel = load(desk.scene(text)).body("wheel")
    assert (wheel.mass, wheel.inertia) == (0.001, 5e-12)
    assert min(edge.x0 for edge in wheel.loops[0].edges) == pytest.approx(-0.005)
    assert wheel.centre_of_mass == pytest.approx((0.0, 0.0), abs=1e-15)


def test_a_free_line_is_about_the_origin_it_is_drawn_from(desk):
    """A line has no area, and so no centre: with mass and inertia written, nothing moves it from where its points are."""
    disc = INCLINE[INCLINE.index('circle = "50 mm"') : INCLINE.index("[bodies.plane]")]
    line = 'line = [["-2 mm", "5 mm"], ["7 mm", "3 mm"]]\nmotion = "free"\nmass = "1 g"\ninertia = "1 g·cm²"\n'
    rod = load(desk.scene(INCLINE.replace(disc, line))).body("disc")
    (edge,) = rod.loops[0].edges
    assert (edge.x0, edge.y0, edge.x1, edge.y1) == pytest.approx((-2e-3, 5e-3, 7e-3, 3e-3), rel=1e-12)
    assert (rod.position, rod.centre_of_mass) == ((0.0, 0.0), (0.0, 0.0))


def test_layer_names_may_hold_points(desk, good):
    desk.put(drawing("lever.dxf", [square(0.002, layer="LEVER_z-1.20")]))
    text = good.replace('polygon = [["-1 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "3 mm"]]', 'drawing = "lever.dxf"')
    scene = load(desk.scene(text.replace('["wheel.TEETH", "lever"]', '["wheel.TEETH", "lever.LEVER_z-1.20"]')))
    assert scene.contacts[0].sides[1] == Side("lever", "LEVER_z-1.20")


NECESSARY = """
[scene]
title = "left out"
[bodies.wheel]
circle = "1 mm"
inertia = "1 g·cm²"
{body}
[bodies.disc]
circle = "1 mm"
inertia = "1 g·cm²"
position = ["5 mm", "0 mm"]
[[damping]]
body = "wheel"
viscous = "1 nN·m·s"
{damping}
[[contacts]]
between = ["wheel", "disc"]
{contact}
[[gears]]
between = ["wheel", "disc"]
ratio = -1.0
backlash = "1°"
{gear}
[run]
duration = "1 s"
{run}
"""
SAID = {
    "body": 'motion = "pivot"\nposition = ["0 mm", "0 mm"]\nangle = "0°"\nmass = "0 g"\ncentre_of_mass = ["0 mm", "0 mm"]',
    "damping": 'quadratic = "0 N·m·s²/rad²"\ncoulomb = "0 N·m"',
    "contact": "friction = 0\nrestitution = 0\ntangential_restitution = 0",
    "gear": 'restitution = 0\nefficiency = 1\npressure_angle = "20°"',
    "run": 'tolerance = 1e-9\nrecord = "all"',
}


def scene(folder: Path, parts: dict[str, str]) -> Scene:
    path = folder / "scene.toml"
    path.write_text(NECESSARY.format(**parts), encoding="utf-8")
    return load(path)


def test_what_is_left_out_is_what_the_manual_says(tmp_path: Path) -> None:
    short = scene(tmp_path, dict.fromkeys(SAID, ""))
    for key, words in SAID.items():
        full = scene(tmp_path, dict.fromkeys(SAID, "") | {key: words})
        mine, theirs = (
            replace(one, source={}, bodies=tuple(replace(body, velocity=()) for body in one.bodies)) for one in (short, full)
        )
        assert mine == theirs, key


def test_in_python_the_same_is_left_out(tmp_path: Path) -> None:
    short = scene(tmp_path, dict.fromkeys(SAID, ""))
    wheel, disc = short.bodies
    made = Scene(
        "left out",
        (Body("wheel", inertia=1e-7, loops=wheel.loops), Body("disc", position=(5e-3, 0.0), inertia=1e-7, loops=disc.loops)),
        damping=(Damping("wheel", 1e-9),),
        contacts=(Contact((Side("wheel"), Side("disc"))),),
        gears=(Gear(("wheel", "disc"), -1.0, short.gears[0].backlash),),
    )
    for one, other in zip(made.bodies, short.bodies, strict=True):
        assert replace(one, velocity=other.velocity) == other
    for name in ("damping", "contacts", "gears", "gravity", "nu", "duration", "tolerance", "record", "torques"):
        assert getattr(made, name) == getattr(short, name), name
    assert Recording().stride == 1 and Torque("wheel").value == Body("wheel").inertia == 0.0
    assert ws.simulate(replace(made, gears=()), duration=0.1).end_q.tolist() == [0.0, 0.0]


def test_of_a_file_that_cannot_be_read_nothing_is_told(tmp_path: Path) -> None:
    for name in ("nothing.dxf", "nothing.svg"):
        (tmp_path / name).write_text("neither\n", encoding="utf-8")
        drawing = read_drawing(tmp_path / name)
        assert (drawing.fitted_curves, drawing.fitted_arcs, drawing.fitted_deviation, drawing.drawn.length) == (0, 0, 0.0, 0.0)
        assert any(finding.severity == "error" for finding in drawing.findings)


ZERO = (0.0, 0.0)


def test_bodies_and_scenes() -> None:
    body, scene = Body("a"), Scene("t", ())
    assert (body.motion, body.position, body.angle, body.velocity, body.axis) == ("pivot", ZERO, 0.0, (), (1.0, 0.0))
    assert (body.mass, body.inertia, body.centre_of_mass, body.loops, body.decoration) == (0.0, 0.0, ZERO, (), ())
    assert (scene.gravity, scene.tangential_law, scene.nu, scene.duration) == (ZERO, "coulomb", 0.0, 1.0)
    assert (scene.tolerance, scene.record, scene.lift_angle, scene.nominal) == (1e-9, EVERYTHING, None, None)
    assert (scene.springs, scene.contacts, scene.gears, scene.line_springs, scene.expect) == ((), (), (), (), ())


def test_forces_contacts_and_gears() -> None:
    assert Spring("a", 3.0) == Spring("a", 3.0, 0.0, None, None, None, None, 0.0)
    assert LineSpring(("a", None), (ZERO, ZERO), 3.0, 1.0).viscous == 0.0
    assert Torque("a") == Torque("a", 0.0, "constant", (), None, None, None)
    assert Damping("a") == Damping("a", 0.0, 0.0, 0.0, None)
    assert Contact((Side("a"), Side("b"))) == Contact((Side("a", None), Side("b", None)), 0.0, 0.0, 0.0)
    assert Gear(("a", "b"), 3.0, 0.1) == Gear(("a", "b"), 3.0, 0.1, 0.0, 1.0, math.radians(20.0))
    assert Prescribed() == Prescribed(0.0, 0.0, ())


def test_what_carries_and_what_weighs() -> None:
    assert Ride(5) == Ride(5, -1, ZERO, -1, 0.0, 0.0, 0.0) and MOVEMENT == -1
    assert Weighed() == Weighed(0.0, ZERO, 0.0)
    assert Bond(5) == Bond(5, 1.0, 0.0, 1.0, 0.0)
    assert Oscillator("a", 1.0, 2.0, 3.0, 4.0).weight == 0.0
    solid = Solid("plate", "L", Weight(1.0, ZERO, 1.0), 8.0)
    assert (solid.loops, solid.thickness, solid.pivot, solid.count, solid.width, solid.bores) == ((), 0.0, ZERO, 1, 0.0, ())


@pytest.mark.parametrize(
    ("recording", "tail", "windows"),
    [
        (Recording(), False, WHOLE_RUN),
        (Recording(((1.0, 2.0),)), False, ((1.0, 2.0),)),
        (Recording(keep=EVENTS), True, ()),
        (Recording(((1.0, 2.0),), EVENTS), True, ((1.0, 2.0),)),
        (Recording(keep=STATISTICS), True, ()),
    ],
)
def test_what_is_kept_of_a_run(recording: Recording, tail: bool, windows: tuple[tuple[float, float], ...]) -> None:
    assert recording.has_tail is tail and recording.row_windows == windows
    assert ((-math.inf, math.inf),) == WHOLE_RUN and Recording().keep == ALL and Recording().stride == 1


def test_recordings_from_what_is_convenient() -> None:
    assert as_recording(None) is None and as_recording(EVERYTHING) is EVERYTHING
    assert as_recording("statistics") == Recording(keep=STATISTICS)
    assert as_recording([(1, 2), (4, 7)]) == Recording(((1.0, 2.0), (4.0, 7.0)))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"keep": "some"}, '"some" cannot be kept; choose from all, events, statistics'),
        ({"stride": 0}, "n must be at least 1, not 0"),
        ({"windows": ((2.0, 2.0),)}, "not from 2 s to 2 s"),
        ({"windows": ((1.0, 2.0), (5.0, 4.0))}, "not from 5 s to 4 s"),
    ],
)
def test_what_cannot_be_kept(more: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Recording(**more)  # type: ignore[arg-type]


WINDOWS = ((179.0, 180.0), (1.0, 2.0))


def read(value: object) -> tuple[Recording, list[str]]:
    faults = Faults("scene.toml")
    found = read_record(Table({"record": value}, "run", RUN, faults))
    try:
        faults.raise_any()
    except ValueError as error:
        return found, str(error).splitlines()
    return found, []


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ([], Recording()),
        ("all", Recording()),
        ("statistics", Recording(keep="statistics")),
        ("every 10", Recording(stride=10)),
        ("every 1", Recording(stride=1)),
        ("every 999999999", Recording(stride=999999999)),
        (["179 s", "180 s"], Recording(WINDOWS[:1])),
        ([["179 s", "180 s"], ["1 s", "2000 ms"]], Recording(WINDOWS)),
        (["statistics", ["179 s", "180 s"]], Recording(WINDOWS[:1], "statistics")),
        (["events", "every 3"], Recording((), "events", 3)),
    ],
)
def test_words_and_windows(value: object, expected: Recording) -> None:
    assert read(value) == (expected, [])


@pytest.mark.parametrize(
    ("value", "key", "said"),
    [
        ("statistic", "run.record", 'Did you mean "statistics"?'),
        ("evry 5", "run.record", 'Did you mean "every 10"?'),
        ("every", "run.record", '"every 10" for every tenth row'),
        ("every 0", "run.record", '"every 10" for every tenth row'),
        ("every 1000000000", "run.record", '"every 10" for every tenth row'),
        (["statistics", ["2 s", "1 s"]], "run.record.1", "from an earlier to a later time"),
        (["1 s"], "run.record", 'a window: two times, such as ["179 s", "180 s"]'),
        (["all", "statistics"], "run.record", "all and statistics exclude each other"),
        (["every 2", "every 3"], "run.record", "only one of every 2, every 3 can hold"),
        (["179", "180 s"], "run.record.0", "needs a unit"),
        ("x1", "run.record", "write all, events, statistics, "),
        (7, "run.record", "or a window: two times"),
        ("0.5 s", "run.record", "or a window: two times"),
    ],
)
def test_what_cannot_be_read(value: object, key: str, said: str) -> None:
    text = " ".join(read(value)[1])
    assert key in text
    assert said in text


def test_in_python() -> None:
    assert as_recording("events") == Recording(keep="events")
    assert as_recording([(1, 2)]) == Recording(((1.0, 2.0),))
    assert as_recording(None) is None


def test_a_locked_scene_refuses_drawings_that_have_changed(tmp_path: Path) -> None:
    """What is not there is no change; nor is another table in place of the digests."""
    (tmp_path / "a.dxf").write_bytes(b"anything")
    digest = hashlib.sha256(b"anything").hexdigest()
    body = '[bodies.b]\ninertia = "1 g·cm²"\n'
    path = tmp_path / "scene.toml"
    for lock, refused in (
        (f'"a.dxf" = "{digest}"', False),
        (f'"a.dxf" = "{digest[::-1]}"', True),
        (f'"none.dxf" = "{digest}"', False),
    ):
        path.write_text(f"{body}[lock.drawings]\n{lock}\n", encoding="utf-8")
        if refused:
            with pytest.raises(SceneError, match=r"lock\.drawings\.a\.dxf\n  the drawing was changed"):
                load(path)
        else:
            assert load(path).bodies


def test_a_scene_keeps_the_drawings_that_it_was_read_with(tmp_path, monkeypatch):
    """A study goes on when its drawings are edited or taken away, from another folder, and on another machine."""
    (tmp_path / "desk").mkdir()
    for one in (ws.profiles_dir() / "bench_lever").iterdir():
        (tmp_path / "desk" / one.name).write_bytes(one.read_bytes())
    monkeypatch.chdir(tmp_path)
    scene = ws.load("desk")
    expected = scene.set("bodies.lever.position.1", "2.8 mm")
    for name in scene.drawings:
        (tmp_path / "desk" / name).unlink()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    forget_drawings()
    assert pickle.loads(pickle.dumps(scene)).set("bodies.lever.position.1", "2.8 mm") == expected
    with pytest.raises(SceneError, match="there is no such file"):
        scene.set("bodies.lever.drawing", "other.dxf")


def test_a_recorded_shock_travels_with_results(tmp_path, monkeypatch):
    for one in (ws.profiles_dir() / "bench_lever").iterdir():
        (tmp_path / one.name).write_bytes(one.read_bytes())
    recorded = tmp_path / "blow.csv"
    recorded.write_text("t_s,ax_m_s2,ay_m_s2\n0,0,0\n0.001,100,0\n0.002,0,0\n", encoding="utf-8")
    with (tmp_path / "scene.toml").open("a", encoding="utf-8") as file:
        file.write('\n[[shocks]]\nfile = "blow.csv"\nat = "5 ms"\n')
    scene = ws.load(tmp_path)
    assert main(["run", str(tmp_path), "--duration", "20 ms", "--no-plots", "-o", str(tmp_path / "results")]) == 0
    expected = scene.set("torques.0.value", "-5 µN·m").shocks
    recorded.unlink()
    assert scene.set("torques.0.value", "-5 µN·m").shocks == expected and len(expected[0].rows) == 3
    (tmp_path / "results").rename(tmp_path / "mailed")
    assert ws.load(tmp_path / "mailed" / "scene.lock.toml").shocks == expected
