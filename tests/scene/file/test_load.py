"""Does a scene file become the scene it describes?"""

import math

import pytest
from made_scenes import drawing, square

from watchsim.scene.forces import Side
from watchsim.scene.load import load
from watchsim.scene.scene import Expectation, Recording


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
