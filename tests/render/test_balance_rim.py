"""Is a balance drawn with rim and hairspring behind everything, in the frame that shows it best?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from render.fake_runs import MM, circle, disc_run, watch_run, watch_scene

from watchsim.geometry.hairspring import Coil
from watchsim.render.encoder import FORMATS, fitting
from watchsim.render.keyframes import placed_solids
from watchsim.render.marks import goes_round, reading
from watchsim.render.movie import frame, movie
from watchsim.render.palette import BRASS, FIXED, LIGHT
from watchsim.render.parts import backdrop, parts, working
from watchsim.render.stage import NOTHING, Stage
from watchsim.render.view import hairsprings, poses
from watchsim.scene.forces import Spring
from watchsim.scene.layer_heights import slabs
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Trajectory

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
    tall, turn = fitting(watch_run(), WINDOW, NOTHING, None, False, None)
    assert tall == (720, 1280) and turn == 0.0
    assert fitting(watch_run(), WINDOW, NOTHING, None, False, math.pi / 2)[0] == (1280, 720)
    assert fitting(watch_run(), WINDOW, NOTHING, ["wheel"], False, None)[0] in (FORMATS[1], FORMATS[2])
    assert fitting(disc_run(), (0.0, 3.0), NOTHING, None, False, None) == ((1280, 720), None)
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
