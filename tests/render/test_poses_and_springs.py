"""Are bodies where the exact motion says they are?"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tomllib
from matplotlib.colors import to_rgb
from render.fake_runs import MM, circle, disc_run, slide_run, watch_run, watch_scene
from shapely.affinity import rotate, translate
from shapely.geometry import Point as Spot
from shapely.geometry import Polygon

import watchsim as ws
from watchsim.geometry.hairspring import Coil
from watchsim.pages.report_page import page_text
from watchsim.render.encoder import FORMATS, fitting
from watchsim.render.keyframes import placed_solids
from watchsim.render.marks import goes_round, reading
from watchsim.render.movie import frame, movie
from watchsim.render.palette import BLUED, BRASS, FIXED, LIGHT
from watchsim.render.parts import backdrop, parts, working
from watchsim.render.patches import stop_pins
from watchsim.render.stage import Extras, Stage
from watchsim.render.view import (
    COILS,
    WIDTH,
    choose,
    dense,
    hairsprings,
    placed,
    poses,
    recorded,
    room_for,
    sampled,
    stretch,
    swept,
    zigzags,
)
from watchsim.scene.forces import LineSpring, Spring
from watchsim.scene.layer_heights import slabs
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory

TIMES = np.array([0.0, 0.1234, 0.777, 1.9, 2.0])


def test_sample_agrees_with_at_and_with_the_exact_motion():
    run = watch_run()
    q, u = run.sample(TIMES)
    for k, t in enumerate(TIMES):
        assert np.array_equal(q[k], run.at(t)[0])
        assert np.array_equal(u[k], run.at(t)[1])
    assert q[:, 2] == pytest.approx(5.0 * np.cos(25.0 * TIMES), abs=1e-8)
    assert u[:, 2] == pytest.approx(-125.0 * np.sin(25.0 * TIMES), abs=1e-5)


def test_after_an_impact_the_new_velocity_counts():
    run = watch_run()
    before, at = run.sample(np.array([1.0 - 1e-9, 1.0]))[1][:, 1]
    assert at - before == pytest.approx(4.0, abs=1e-6)


def test_times_outside_are_clamped_and_a_double_last_row_counts_once():
    run = watch_run()
    last = replace(
        run,
        t=np.append(run.t, run.t[-1]),
        q=np.vstack((run.q, run.q[-1])),
        u=np.vstack((run.u, run.u[-1] + 1.0)),
        a=np.vstack((run.a, run.a[-1])),
    )
    assert np.array_equal(last.at(5.0)[1], run.u[-1] + 1.0)
    assert np.array_equal(last.at(-5.0)[0], run.q[0])


def test_poses_of_all_motions():
    watch = poses(watch_run(), TIMES)
    assert np.allclose(watch["wheel"][:, 2], -2.0 * TIMES)
    assert np.all(watch["lever"][:, :2] == (0.0, 3 * MM))
    assert np.all(watch["banking"] == 0.0)
    disc = poses(disc_run(), np.array([1.0]))["disc"][0]
    assert disc[2] == pytest.approx(-disc[0] / 0.05)
    x, y, angle = poses(slide_run(), np.array([0.3]))["slider"][0]
    assert (x, y) == pytest.approx((1 * MM + 2 * MM * math.sin(3.0) * math.sqrt(0.5),) * 2, abs=1e-9)
    assert angle == 0.0


def test_placed_turns_and_shifts():
    points = placed(np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([[3.0, 4.0, math.pi / 2]]))[0]
    assert points == pytest.approx(np.array([[3.0, 5.0], [1.0, 4.0]]))


def test_swept_angles_end_where_the_motion_ends():
    run = watch_run()
    lever = swept(run, run.scene.body("lever"), (0.0, 0.9))
    assert (lever[:, 2].min(), lever[:, 2].max()) == pytest.approx((-0.1, 0.1), abs=1e-4)
    balance = swept(run, run.scene.body("balance"), (0.0, 0.9))
    assert np.ptp(balance[:, 2]) == pytest.approx(2.0 * math.pi)


def test_dense_keeps_rows_and_jumps():
    run = watch_run()
    t, q, u, _ = dense(run, (0.95, 1.05))
    assert (t[0], t[-1]) == (0.95, 1.05)
    assert np.all(np.diff(t) >= 0.0)
    assert np.diff(t).max() <= 0.1 / 2000 * 1.001
    twice = np.flatnonzero(np.diff(t) == 0.0)
    assert len(twice) == 1
    assert u[twice[0] + 1, 1] - u[twice[0], 1] == pytest.approx(4.0)
    assert q[:, 2] == pytest.approx(5.0 * np.cos(25.0 * t), abs=1e-8)


def test_window_is_checked():
    run = watch_run()
    assert stretch(run, None) == (0.0, 2.0)
    assert stretch(run, (0.5, 1)) == (0.5, 1.0)
    for wrong, said in (
        ((1.5, 2.5), "0 s to 2 s was recorded"),
        ((1, 1), "empty"),
        ((2, 1), "empty"),
        (3, "two times"),
        (("a", 1), "two"),
    ):
        with pytest.raises(ValueError, match=said):
            stretch(run, wrong)


def test_gaps_in_the_record_are_neither_drawn_nor_allowed():
    full = watch_run()
    keep = (full.t <= 0.51) | (full.t >= 1.49)  # with the rows next to what was asked for
    cut = {name: getattr(full, name)[keep] for name in ("t", "q", "u", "a")}
    run = replace(full, spans=((0.0, 0.5), (1.5, 2.0)), **cut)
    assert recorded(run) == ((0.0, 0.5), (1.5, 2.0))
    assert stretch(run, (1.5, 2.0)) == (1.5, 2.0)
    with pytest.raises(ValueError, match=r"0 s to 0\.5 s and 1\.5 s to 2 s"):
        stretch(run, (0.4, 1.6))
    with pytest.raises(ValueError, match="choose a window"):
        stretch(run, None, unbroken=True)
    t, q, *_ = dense(run, stretch(run, None))
    assert np.all(np.isnan(q[(t > 0.5) & (t < 1.5)]))
    assert not np.any(np.isnan(q[(t <= 0.5) | (t >= 1.5)]))


def test_bodies_are_chosen_by_name():
    run = watch_run()
    assert [body.name for body in choose(run, None)] == ["wheel", "lever", "balance"]
    assert [body.name for body in choose(run, ["balance", "wheel"])] == ["balance", "wheel"]
    assert [body.name for body in choose(run, "lever")] == ["lever"]
    for wrong in (["lver"], ["banking"], []):
        with pytest.raises(ValueError, match="wheel, lever, balance"):
            choose(run, wrong)


def test_a_record_of_one_row_is_known_at_that_instant_and_one_of_none_nowhere():
    full = watch_run()
    one, none = ({name: getattr(full, name)[:count] for name in ("t", "q", "u", "a")} for count in (1, 0))
    assert recorded(replace(full, spans=(), **one)) == ((0.0, 0.0),)
    with pytest.raises(ValueError, match="no row"):
        recorded(replace(full, spans=(), **none))


def test_rows_of_the_window_are_among_its_samples() -> None:
    """Both ends, too; of very many rows so few that the evenly spread instants outnumber them."""
    run = watch_run(rows=3001)
    times = -0.5 * sampled(run, run.scene.body("wheel"), (0.5, 0.75))[:, 2]
    rows = run.t[(run.t >= 0.5) & (run.t <= 0.75)]
    assert np.abs(times[:, None] - rows).min(axis=0).max() < 1e-12 and len(times) > len(rows)
    assert times[0] == pytest.approx(0.5, rel=1e-12) and times[-1] == pytest.approx(0.75, rel=1e-12)
    whole = sampled(run, run.scene.body("wheel"), (0.0, 2.0))
    assert 700 < len(whole) <= 400 + math.ceil(3002 / (3002 // 400)) + 1


COIL = Coil(0.5 * MM, 2.6 * MM, 11.0, 0.5, 0.05 * MM)
SIZE = (960, 540)
WINDOW = (0.0, 2.0)


def with_rim(scene: Scene, coil: Coil | None = COIL) -> Scene:
    """The balance gets a rim from 3.5 to 4 mm, which covers the banking pins and the lever's pivot."""
    rim = (circle(0, 0, 4, "RIM"), circle(0, 0, 1.6, "RIM", hole=True))
    bodies = tuple(replace(body, decoration=rim) if body.name == "balance" else body for body in scene.bodies)
    return replace(scene, bodies=bodies, springs=(Spring("balance", 1e-7, rest=0.3, coil=coil),))


def run_with_rim(coil: Coil | None = COIL) -> Trajectory:
    run = watch_run()
    return Trajectory(**{**run.__dict__, "scene": with_rim(run.scene, coil)})


def at(picture: np.ndarray, stage: Stage, frames: dict[str, np.ndarray], point: tuple[float, float]) -> np.ndarray:
    """The colour of the picture at a point of the movement (m)."""
    matrix = stage.view.matrix(stage.view.centre_at(frames))
    x, y, _ = matrix @ (*point, 1.0)
    return picture[picture.shape[0] - 1 - math.floor(y), math.floor(x), :3]


def rgb(colour: str) -> np.ndarray:
    return np.round(255 * np.array(to_rgb(colour)))


def test_pins_wheel_and_lever_lie_before_the_rim() -> None:
    run = run_with_rim()
    stage = Stage(run, SIZE, WINDOW)
    frames = {name: rows[0] for name, rows in poses(run, np.array([0.7])).items()}
    picture = stage.draw(0.7, frames)
    pale = LIGHT.worn(replace(BRASS, pale=True)).fill
    assert np.all(at(picture, stage, frames, (1 * MM, 5 * MM)) == rgb(FIXED.fill))  # a pin, 2.2 mm from the balance's pivot
    assert np.all(at(picture, stage, frames, (0.0, 10.0 * MM)) == rgb(pale))
    shapes = [part for part in parts(run.scene, 1e-6, 1e-3) if part.body != "banking"]
    assert [part.layer for part in backdrop(shapes)] == ["RIM"]


def test_a_zoom_frames_what_works_and_the_whole_is_framed_whole() -> None:
    bare, rimmed = watch_run(), run_with_rim()
    for names in (["wheel", "lever"], ["lever", "balance"], ["balance"]):
        one, other = (Stage(run, SIZE, WINDOW, zoom=names).view for run in (bare, rimmed))
        assert one == other
    stage = Stage(rimmed, SIZE, WINDOW)
    frames = {name: rows[0] for name, rows in poses(rimmed, np.array([0.0])).items()}
    matrix = stage.view.matrix(stage.view.centre_at(frames))
    for angle in np.linspace(0.0, math.tau, 13):
        x, y, _ = matrix @ (4 * MM * math.cos(angle), 7 * MM + 4 * MM * math.sin(angle), 1.0)
        assert 0.0 < x < SIZE[0] and 0.0 < y < SIZE[1]


def test_collet_and_stud_are_where_the_balance_and_the_movement_have_them() -> None:
    run = run_with_rim()
    (spring,) = hairsprings(run.scene)
    for t in (0.0, 0.3, 1.9):
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        line = spring.line(frames, 300)
        x, y, angle = frames["balance"]
        start = COIL.stud - math.tau * COIL.turns + angle - 0.3
        assert line[0] == pytest.approx((x + COIL.inner * math.cos(start), y + COIL.inner * math.sin(start)), abs=1e-12)
        assert line[-1] == pytest.approx((COIL.outer * math.cos(0.5), 7 * MM + COIL.outer * math.sin(0.5)), abs=1e-12)
        assert spring.stud(frames)[:-1].mean(axis=0) == pytest.approx(line[-1], abs=1e-12)


def test_room_is_made_about_the_body_that_has_the_hairspring() -> None:
    scene = run_with_rim().scene
    assert np.hypot(*room_for(scene, "balance").T).min() > COIL.outer
    assert not len(room_for(scene, "wheel"))


def test_on_a_carriage_the_stud_turns_with_it() -> None:
    run = run_with_rim()
    spring = replace(hairsprings(run.scene)[0], on="wheel")
    frames = {"balance": np.array([1 * MM, 2 * MM, 0.9]), "wheel": np.array([0.0, 0.0, 0.4])}
    assert spring.turned(frames) == pytest.approx(0.9 - 0.4 - 0.3)
    end = spring.line(frames, 50)[-1] - (1 * MM, 2 * MM)
    assert math.atan2(end[1], end[0]) == pytest.approx(0.5 + 0.4)


def test_the_spring_is_seen_and_moves() -> None:
    run, bare = run_with_rim(), run_with_rim(None)
    changed = [np.any(frame(run, t, SIZE, WINDOW) != frame(bare, t, SIZE, WINDOW), axis=2).sum() for t in (0.05, 0.1)]
    assert min(changed) > 500
    assert np.any(frame(run, 0.05, SIZE, WINDOW) != frame(run, 0.1, SIZE, WINDOW))
    inset = frame(run, 0.05, SIZE, WINDOW, insets=["balance"])
    assert np.any(inset != frame(bare, 0.05, SIZE, WINDOW, insets=["balance"]))


def test_a_picture_takes_the_shape_of_its_mechanism() -> None:
    tall, turn = fitting(watch_run(), WINDOW, Extras(), None, False, None)
    assert tall == (720, 1280) and turn == 0.0
    assert fitting(watch_run(), WINDOW, Extras(), None, False, math.pi / 2)[0] == (1280, 720)
    assert fitting(watch_run(), WINDOW, Extras(), ["wheel"], False, None)[0] in (FORMATS[1], FORMATS[2])
    assert fitting(disc_run(), (0.0, 3.0), Extras(), None, False, None) == ((1280, 720), None)
    picture = frame(watch_run(), 0.5, "auto")
    assert picture.shape == (1280, 720, 3)


@pytest.mark.slow
def test_a_movie_takes_it_too_and_no_other_word(tmp_path) -> None:
    import imageio.v3 as iio

    path = movie(watch_run(), tmp_path / "a.gif", (0.0, 0.2), size="auto", dark=True)
    assert iio.imread(path, index=0).shape[:2] == (800, 450)
    with pytest.raises(ValueError, match="auto"):
        movie(watch_run(), tmp_path / "b.gif", (0.0, 0.2), size="tall")


def test_angles_are_told_within_a_turn_once_turns_have_gone_by() -> None:
    assert not goes_round(np.radians([-300.0, 359.0])) and goes_round(np.radians([0.0, -3605.0]))
    wheel = watch_scene().body("wheel")
    turned = np.column_stack((np.zeros((3, 2)), np.radians([-4.0, -3605.25, 7199.9999])))
    tell, ends = reading(wheel, turned, within_turn=True)
    assert [tell(row) for row in turned] == ["356.0°", "354.8°", "0.0°"]
    assert all(len(text) >= len("0.0°") for text in ends)
    assert reading(wheel, turned)[0](turned[1]) == "−3605.2°"


def test_pictures_of_function_leave_the_rim_out() -> None:
    scene = with_rim(watch_scene())
    assert {part.layer for part in parts(scene, 1e-6, 1e-3)} - {part.layer for part in working(scene, 1e-6, 1e-3)} == {"RIM"}


def test_a_rim_is_a_solid_below_what_works() -> None:
    scene = with_rim(watch_scene())
    found = slabs(scene, 0.2 * MM)
    middle = {(slab.body, slab.layer): slab.middle for slab in found}
    assert {layer for body, layer in middle if body == "balance"} == {"ROLLER", "PIN", "RIM"}
    assert middle["balance", "RIM"] < middle["lever", "ARMS"] - 0.19 * MM
    (balance,) = (one for one in placed_solids(scene, found, 1e-6) if one.name == "balance")
    rim = next(piece.mesh for piece in balance.pieces if piece.name == "RIM")
    assert rim.is_watertight and rim.volume == pytest.approx(math.pi * (16 - 1.6**2) * 0.2, rel=1e-3)


ARM = [(-1.0, -0.6), (9.0, -0.3), (10.0, 0.0), (9.0, 0.4), (-1.0, 0.7)]  # mm
CORNERS = ", ".join(f'["{x} mm", "{y} mm"]' for x, y in ARM)
SPRING = '[[springs]]\nbody = "click"\nstiffness = "50 µN·m/rad"\n'


def scene_of(spring: str, more: str = "", body: str = "") -> Scene:
    click = f'[bodies.click]\npolygon = [{CORNERS}]\ninertia = "100 g·mm²"\n{body}\n'
    return from_mapping(tomllib.loads(f'{click}{SPRING}{spring}\n{more}\n[run]\nduration = "0.1 s"\n'), Path("x/scene.toml"))


@pytest.mark.parametrize(("stop", "rest"), [("10°", "30°"), ("-5°", "-40°"), ("100°", "140°")])
def test_the_pin_touches_the_arm_at_the_stop_on_the_side_of_the_spring(stop: str, rest: str) -> None:
    scene = scene_of(f'stop = "{stop}"\nrest = "{rest}"', body='position = ["3 mm", "-2 mm"]')
    (pin,) = stop_pins(scene)
    at, to = (float(text.rstrip("°")) for text in (stop, rest))
    disc = Spot(1e3 * pin.place[0], 1e3 * pin.place[1]).buffer(1e3 * pin.radius, 256)

    def overlap(angle: float) -> float:
        return float(translate(rotate(Polygon(ARM), angle, origin=(0, 0)), 3.0, -2.0).intersection(disc).area)

    towards = math.copysign(1.0, to - at)
    assert pin.on is None
    assert overlap(at - 0.2 * towards) == 0.0  # free before the stop
    assert overlap(at + 0.2 * towards) > 0.0  # and inside the pin just behind it
    assert overlap(at - 90.0 * towards) == 0.0


def test_a_slider_stands_before_its_pin() -> None:
    body = 'motion = "slide"\naxis = [0.0, 1.0]\nmass = "1 g"'
    click = f'[bodies.click]\npolygon = [{CORNERS}]\n{body}\n[[springs]]\nbody = "click"\nstiffness = "10 N/m"\n'
    scene = from_mapping(tomllib.loads(f'{click}stop = "-1 mm"\nrest = "-2 mm"\n'), Path("x/scene.toml"))
    (pin,) = stop_pins(scene)
    assert pin.place[1] + pin.radius == pytest.approx(-1.6e-3, abs=1e-12)  # lowest corner, a millimetre down


def test_on_another_body_it_goes_with_that() -> None:
    other = '[bodies.wheel]\ncircle = "1 mm"\nposition = ["5 mm", "0 mm"]\nangle = "30°"\ninertia = "300 g·mm²"\n'
    scene = scene_of('against = "wheel"\nstop = "-10°"\nrest = "20°"', other, body='angle = "-20°"')
    (pin,) = stop_pins(scene)
    assert pin.on == "wheel"
    # In the movement, with the wheel at 30°, the arm comes to it at 20°.
    place = complex(5.0, 0.0) + 1e3 * complex(*pin.place) * np.exp(1j * math.radians(30.0))
    arm = rotate(Polygon(ARM), 20.0, origin=(0, 0))
    assert arm.distance(Spot(place.real, place.imag)) == pytest.approx(1e3 * pin.radius, abs=2e-3)


def test_pictures_show_it() -> None:
    scene = scene_of('stop = "-5°"\nrest = "-40°"', body='angle = "20°"')
    run = ws.simulate(scene, duration=0.01)
    stage = Stage(run, (960, 540), (0.0, 0.01))
    frames = {name: rows[0] for name, rows in poses(run, np.array([0.0])).items()}
    (pin,) = stop_pins(scene)
    x, y, _ = stage.view.matrix(stage.view.centre_at(frames)) @ (*pin.place, 1.0)
    seen = stage.draw(0.0, frames)[540 - 1 - math.floor(y), math.floor(x), :3].astype(int)
    assert np.abs(seen - [int(FIXED.fill[k : k + 2], 16) for k in (1, 3, 5)]).max() < 10


HOOK = (30.0 * MM, 40.0 * MM)  # far from all bodies
SPRING_LINE_SPRINGS_DRAWN = LineSpring(("lever", None), ((1.0 * MM, 0.5 * MM), HOOK), stiffness=1.0, length=5.0 * MM)


def run_with_spring() -> Trajectory:
    run = watch_run()
    return replace(run, scene=replace(run.scene, line_springs=(SPRING_LINE_SPRINGS_DRAWN,)))


def at_line_springs_drawn(run: Trajectory, t: float) -> dict[str, np.ndarray]:
    return {name: rows[0] for name, rows in poses(run, np.array([t])).items()}


def test_the_zigzag_runs_from_point_to_point_about_the_line() -> None:
    run = run_with_spring()
    (spring,) = zigzags(run.scene)
    for t in (0.1, 0.7, 1.9):
        frames = at_line_springs_drawn(run, t)
        x, y, angle = frames["lever"]
        first = complex(x, y) + complex(*SPRING_LINE_SPRINGS_DRAWN.points[0]) * complex(math.cos(angle), math.sin(angle))
        way = complex(*HOOK) - first
        seen = (spring.line(frames) @ [1.0, 1j] - first) / way  # the line is the real axis from 0 to 1
        assert abs(seen[0]) < 1e-12 and abs(seen[-1] - 1.0) < 1e-12
        assert np.all(np.diff(seen.real) > 0.0)
        sides = abs(way) * seen.imag
        assert np.count_nonzero(np.diff(np.sign(sides[2:-2])) != 0.0) == 2 * COILS - 1
        assert np.ptp(np.abs(sides[2:-2])) < 1e-15
    apart = math.dist(HOOK, zigzags(run.scene)[0].ends(at_line_springs_drawn(run, 0.0))[0])
    assert spring.half == WIDTH * max(apart, SPRING_LINE_SPRINGS_DRAWN.length)


def test_the_picture_has_room_for_the_fixed_end_and_shows_the_wire() -> None:
    run, size = run_with_spring(), (960, 540)
    stage = Stage(run, size, (0.0, 2.0))
    frames = at_line_springs_drawn(run, 0.7)
    matrix = stage.view.matrix(stage.view.centre_at(frames))
    x, y, _ = matrix @ (*HOOK, 1.0)
    assert 0.0 < x < size[0] and 0.0 < y < size[1]
    picture = stage.draw(0.7, frames)
    pin = picture[size[1] - 1 - math.floor(y), math.floor(x), :3]
    wanted = [int(BLUED.line[k : k + 2], 16) for k in (1, 3, 5)]
    assert np.abs(pin.astype(int) - wanted).max() < 40


def test_the_page_holds_it_in_player_and_still_picture() -> None:
    text = page_text(run_with_spring())
    assert 'data-zigzag="0"' in text and '"half":' in text
    assert "data-zigzag=" not in page_text(watch_run()).split("<script")[0]
