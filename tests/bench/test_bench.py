"""Is the comparison of engines fair, and are whole runs timed?"""

import dataclasses
import json
import math
import time
from itertools import pairwise

import numpy as np
import pytest

from watchsim.bench.compare import compare, scenarios, swing, table, whole
from watchsim.bench.engines import Circle, convex_pieces, is_installed
from watchsim.cli import main
from watchsim.commands import bench
from watchsim.commands.console import FINE
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.simulation import EVENT_DRIVEN, MOREAU

# Is the comparison fair and told in full: right errors, spread, references that another method confirms?

KEYS = {"scene", "method", "setting", "wall_s_per_simulated_s", "error_rate_s_per_d", "error_amplitude_deg", "error_state"}


def test_the_incline_is_told_as_json(tmp_path, capsys) -> None:
    assert main(["bench", "--quick", "--scene", "incline", "--json", "-o", str(tmp_path)]) == FINE
    rows = json.loads(capsys.readouterr().out)
    assert all(set(row) >= KEYS for row in rows)
    own = [row for row in rows if row["method"] == "pfeiffer-glocker"]
    assert all(row["error_state"] < 1e-10 for row in own)
    stepped = [row["error_state"] for row in rows if row["method"] == "moreau"]
    assert 1e-7 < stepped[-1] < 0.3 * stepped[0]  # first order: the errors are real ones
    for engine in ("pymunk", "box2d", "mujoco"):
        assert any(row["method"] == engine for row in rows) == is_installed(engine)
    assert {path.name for path in tmp_path.iterdir()} == {"bench.json", "bench.md", "bench.png"}


@pytest.mark.slow
def test_the_reference_of_a_lever_is_confirmed_by_another_method() -> None:
    whole = next(one for one in scenarios() if one.name == "bench_lever")
    few = dataclasses.replace(
        whole, duration=1.5, window=(0.5, 1.5), settings={"pfeiffer-glocker": (1e-6, 1e-9), "moreau": (2e-5, 1e-5)}
    )
    reference, rows = compare(few, 2, lambda _: None)
    assert reference.amplitude_off_deg < 0.5
    assert rows[1].error_amplitude_deg < 1e-3
    assert rows[1].error_amplitude_deg < rows[0].error_amplitude_deg
    assert all(row.wall_least <= row.wall_s_per_simulated_s <= row.wall_largest and row.repeats == 2 for row in rows)
    text = table([dataclasses.asdict(row) for row in rows], [dataclasses.asdict(reference)])
    assert "Moreau's time stepping" in text
    assert "tolerance 1e-09" in text


def test_an_unknown_scene_is_refused(capsys) -> None:
    assert main(["bench", "--scene", "inclin"]) == 2
    assert "Choose from incline; " in capsys.readouterr().err
    assert bench.HELP


# Do convex pieces fill the outline they were cut from?


def area(points):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1], strict=True))


def is_convex(points):
    turns = [
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        for a, b, c in zip(points, points[1:] + points[:1], points[2:] + points[:2], strict=True)
    ]
    return min(turns) > 0.0


@pytest.mark.parametrize("body", ["wheel", "lever"])
def test_the_pieces_of_a_body_fill_it(body: str) -> None:
    for loop in load(profiles_dir() / "bench_lever" / "scene.toml").body(body).loops:
        pieces = convex_pieces(loop, 1e-7)
        assert all(isinstance(piece, tuple) and is_convex(piece) and len(piece) <= 8 for piece in pieces)
        whole = area(tuple(edge.start for edge in loop.edges))
        assert sum(area(piece) for piece in pieces) == pytest.approx(whole, rel=1e-9, abs=0.0)


def test_a_full_circle_stays_one() -> None:
    assert convex_pieces(Loop((Arc(1.0, 2.0, 0.5, 0.0, 2.0 * math.pi),)), 1e-3) == [Circle((1.0, 2.0), 0.5)]


def test_an_arc_becomes_chords_that_stray_no_further_than_asked() -> None:
    half = Loop((Arc(0.0, 0.0, 1.0, 0.0, math.pi), Line(-1.0, 0.0, 1.0, 0.0)))
    corners = {corner for piece in convex_pieces(half, 0.01) for corner in piece}
    angles = sorted(math.atan2(y, x) % math.tau for x, y in corners)
    sagitta = [1.0 - math.cos(0.5 * (after - before)) for before, after in pairwise(angles)]
    assert 0.002 < max(sagitta) <= 0.01


@pytest.mark.parametrize("loop", [Loop((Arc(0.0, 0.0, 1.0, 0.0, -6.283185307179586),), hole=True)])
def test_holes_are_refused(loop: Loop) -> None:
    with pytest.raises(ValueError, match="cannot be filled"):
        convex_pieces(loop, 1e-3)


# Are amplitude and period told right from samples alone?


@pytest.mark.parametrize("hertz", [3.7, 4.0])
def test_a_dying_swing(hertz: float) -> None:
    """x = A e^(-d t) cos(w t): known extremes and passages, sampled at times that hit neither."""
    amplitude, decay, w = 4.7, 0.3, 2.0 * np.pi * hertz
    times = 2e-4 * np.arange(1.0, 15000.0)
    told = swing(times, amplitude * np.exp(-decay * times) * np.cos(w * times + 0.123), (1.0, 2.9))
    passages = (np.arange(200) * np.pi + 0.5 * np.pi - 0.123) / w
    turns = (np.arange(-1, 200) * np.pi - 0.123 - np.arctan(decay / w)) / w
    high = amplitude * np.exp(-decay * turns) * np.cos(np.arctan(decay / w))
    inside = (passages >= 1.0) & (passages <= 2.9)
    means = 0.5 * (high[1:] + high[:-1])
    before = np.searchsorted(turns, passages) - 1
    assert told[2] == inside.sum()
    assert told[0] == pytest.approx(means[before[inside]].mean(), rel=1e-7)
    assert told[1] == pytest.approx(1.0 / hertz, rel=1e-9)


def test_what_does_not_swing_has_no_period() -> None:
    times = 1e-3 * np.arange(1.0, 1000.0)
    assert swing(times, np.full(len(times), 0.3), (0.0, 1.0)) == (None, None, 0)


# Are whole runs timed from the drawing on, and is what was learnt the first time known the second?


@pytest.mark.parametrize(("method", "setting"), [(EVENT_DRIVEN, 1e-9), (MOREAU, 1e-4)])
def test_both_runs_are_timed(method: str, setting: float) -> None:
    settled = next(one for one in scenarios() if one.name == "bench_lever, settled")
    assert settled.window == (13.0, 15.0) and settled.duration == 15.0
    begun = time.perf_counter()
    found = whole(dataclasses.replace(settled, duration=0.3), method, setting)
    taken = time.perf_counter() - begun
    times = (found.first_ready, found.first_stepping, found.again_ready, found.again_stepping)
    assert all(seconds > 0.0 for seconds in times) and sum(times) <= taken
    assert (found.scene, found.method, found.simulated) == ("bench_lever, settled", method, 0.3)


def test_a_scene_without_a_file_cannot_be_read() -> None:
    settled = next(one for one in scenarios() if one.name == "bench_lever, settled")
    made = dataclasses.replace(settled, scene=dataclasses.replace(settled.scene, path=None))
    with pytest.raises(ValueError, match="has no scene file to be read"):
        whole(made, EVENT_DRIVEN, 1e-9)
