"""Do names stand apart, with lines that end on their parts, and does a picture show what touches?"""

import math
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from every_time import few
from render.fake_runs import disc_run
from shapely.geometry import LineString, Point, Polygon, box

import watchsim as ws
from watchsim.cli import main
from watchsim.render.part_names import PartName, _by_sides, part_names
from watchsim.render.parts import loops_of, outline
from watchsim.render.stage import Extras, Stage
from watchsim.render.view import poses
from watchsim.scene.roles import with_anchor
from watchsim.simulation.trajectory import Trajectory

MOVING = {
    **{"swiss_lever": 1.2, "graham": 1.5, "pin_pallet": 1.2, "detent": 1.2, "cylinder": 1.2, "tourbillon": 0.6},
    "grasshopper": 1.0,
}


@cache
def run_of(profile: str, duration: float = 1.2) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / profile), duration=duration, record="all")


def stage_of(run: Trajectory, names: tuple[PartName, ...], ordered: list[float]) -> Stage:
    return Stage(run, (1280, 720), (0.0, float(run.t[-1])), extras=Extras(names=names, ordered=tuple(ordered)))


def in_sight(stage: Stage, name: PartName, frames: dict[str, np.ndarray]) -> bool:
    x, y = name.seen(frames, stage.view.matrix(stage.view.centre_at(frames))).tolist()
    return stage._beside._labels._room.near(x, y, 0.0)


@pytest.mark.parametrize("profile", few(list(MOVING), lambda profile: profile in ("detent", "graham", "tourbillon")))
def test_names_at_ten_instants_stand_apart_and_on_their_parts(profile: str) -> None:
    run = run_of(profile, MOVING[profile])
    names = tuple(part_names(run.scene))
    for t in np.linspace(0.0, run.t[-1], 10).tolist():
        stage = stage_of(run, names, [t])
        frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
        labels = stage.labels(frames)
        seen = [one for one in names if in_sight(stage, one, frames)]
        assert len(labels) == len(seen) >= 3, "a name is left out"
        boxes = [box(*label.box) for label in labels]
        lines = [LineString(label.line) for label in labels]
        assert not any(one.intersects(other) for one, other in combinations(boxes, 2))
        assert not any(one.crosses(other) for one, other in combinations(lines, 2))
        assert not any(line.intersects(other) for k, line in enumerate(lines) for i, other in enumerate(boxes) if i != k)
        for label in labels:
            assert label.box[0] >= 0.0 and label.box[2] <= 1280.0
            if label.name.body is None:
                continue
            body, (x, y, angle) = run.scene.body(label.name.body), frames[label.name.body].tolist()
            c, s = math.cos(angle), math.sin(angle)
            px, py = label.name.point
            where = np.linalg.solve(stage.view.matrix(stage.view.centre), [*label.at, 1.0])[:2]
            assert np.allclose(where, (x + c * px - s * py, y + s * px + c * py), atol=1e-9)
            shapes = [Polygon(outline([loop], 1e-6)) for loop in loops_of(body) if loop.closed]
            assert (px, py) == (0.0, 0.0) or any(one.buffer(1e-6).contains(Point(px, py)) for one in shapes), label.name.text


@pytest.mark.parametrize("profile", ["swiss_lever", "bench_lever", "pin_pallet"])
def test_pallets_named_by_their_sides_are_those_that_are_measured(profile: str) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    measured = {one.text.split()[0]: one for one in part_names(scene) if one.text.split()[0] in ("entry", "exit")}
    by_sides = {one.text.split()[0]: one for one in _by_sides(scene, with_anchor(scene))}
    assert set(measured) == set(by_sides) == {"entry", "exit"}
    reach = math.dist(measured["entry"].point, measured["exit"].point)
    for name, one in measured.items():
        assert math.dist(one.point, by_sides[name].point) < 0.3 * reach


def test_in_a_movie_names_keep_their_rows_and_lines_never_cross() -> None:
    run = run_of("swiss_lever")
    stage = stage_of(run, tuple(part_names(run.scene)), np.linspace(0.9, 1.2, 25).tolist())
    rows: dict[tuple[str, object], set[object]] = {}
    for t in np.linspace(0.9, 1.2, 60).tolist():
        labels = stage.labels({name: rows[0] for name, rows in poses(run, np.array([t])).items()})
        for label in labels:
            rows.setdefault((label.name.text, label.name.point), set()).add(label.box)
        lines = [LineString(label.line) for label in labels]
        assert len(lines) >= len(part_names(run.scene)) - 3
        assert not any(one.crosses(other) for one, other in combinations(lines, 2))
    assert len(rows) == len(part_names(run.scene)) and all(len(own) == 1 for own in rows.values())


def test_a_name_whose_part_is_out_of_sight_goes_with_its_line() -> None:
    run = run_of("coaxial")
    window = (0.0, float(run.t[-1]))
    names, ordered = tuple(part_names(run.scene)), np.linspace(*window, 60).tolist()
    stage = Stage(run, (1280, 720), window, zoom=["lever"], extras=Extras(names=names, ordered=tuple(ordered)))
    counts = []
    for t in ordered:
        labels = stage.labels(frames := {name: rows[0] for name, rows in poses(run, np.array([t])).items()})
        assert all(in_sight(stage, label.name, frames) for label in labels)
        counts.append(len(labels))
    assert min(counts) < max(counts)


@pytest.mark.parametrize(
    ("profile", "duration", "at_least", "pixels"),
    [("graham", 1.5, 4.0, 250), ("verge", 1.0, 20.0, 100), ("swiss_lever", 1.2, 1.0, 0), ("geneva", 1.0, 1.0, 0)],
)
def test_a_picture_shows_what_touches(profile: str, duration: float, at_least: float, pixels: float) -> None:
    run = run_of(profile, duration)
    window = (0.0, float(run.t[-1]))
    opened, whole = (Stage(run, (1280, 720), window, zoom=zoom).view.scale for zoom in (None, "all"))
    if at_least == 1.0:
        assert opened == whole
        return
    assert opened > at_least * whole
    moving = {side.body for contact in run.scene.contacts for side in contact.sides}
    rotors = [body for name in moving if (body := run.scene.body(name)).motion == "pivot" and body.loops]
    tallest = max(float(np.ptp(outline(body.loops, 1e-5), axis=0).max()) for body in rotors)
    assert tallest * opened >= pixels


def test_the_whole_is_seen_beside_what_touches() -> None:
    """The pendulum's bob, far below the picture of the escapement, stands in the box on the left, and moves there."""
    run = run_of("graham", 1.5)
    early, late = (ws.frame(run, t)[60:640, :190].astype(int) for t in (0.5, 1.0))
    assert (early != late).any(axis=2).sum() > 20
    assert ws.frame(run, 1.0).shape == ws.frame(run, 1.0, zoom="all").shape


def test_names_are_refused_where_there_are_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="names: the parts of this scene have none"):
        ws.frame(disc_run(), 1.0, names=True)
    with pytest.raises(ValueError, match="no room is left for the mechanism between its names"):
        ws.frame(run_of("swiss_lever"), 1.0, size=(200, 200), names=True)
    folder = tmp_path / "run"
    assert main(["run", str(ws.profiles_dir() / "graham"), "--duration", "1 s", "--no-plots", "-o", str(folder)]) == 0
    command = ["movie", str(folder), "--names", "--window", "0.9 s:1 s", "--fps", "25", "--size", "640x360"]
    assert main([*command, "-o", str(tmp_path / "names.gif")]) == 0
    capsys.readouterr()


@pytest.mark.parametrize(
    ("profile", "first", "second"), [("cylinder", "entry lip", "exit lip"), ("duplex", "locking roller", "impulse pallet")]
)
def test_a_balance_that_the_wheel_meets_itself_has_the_names_of_its_trade(profile: str, first: str, second: str) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    at = {one.text: one.point for one in part_names(scene)}
    assert not {"entry pallet", "exit pallet"} & set(at)
    if profile == "cylinder":  # a wheel that turns clockwise below comes from the left
        assert at[first][0] < 0.0 < at[second][0]
    else:  # the notch is nearer to the pivot than the pallet, which reaches to the impulse teeth
        assert math.hypot(*at[first]) < 0.5 * math.hypot(*at[second])
