"""Is material inside material found in a run whose contacts were lost, and nothing reported of sound ones?

Contacts are lost here on purpose: runs begin without the check of the start, from overlaps that no gap function takes for a
touch.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import short_runs
from moving_scenes import box, circle, profile

from watchsim.analysis.summary import summary, summary_text
from watchsim.commands import run as command
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.results.read_results import read_results
from watchsim.results.write_results import write_results
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.record.overlap_instants import Layers, PairOfLayers
from watchsim.simulation.record.overlap_watch import OverlapWatch
from watchsim.simulation.record.watched_instants import BLOCK, EARLY, STRIDE, chosen_moves
from watchsim.simulation.runner import Run
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

MM = 1e-3
KEPT = [Recording(), Recording(keep="events"), Recording(keep="statistics"), Recording(((0.04, 0.05),)), Recording(stride=50)]


@pytest.fixture
def unchecked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Run, "begin", lambda run: None)


@pytest.mark.usefixtures("unchecked")
@pytest.mark.parametrize("record", KEPT, ids=str)
def test_a_lever_that_swings_through_its_banking_is_found(record: Recording) -> None:
    scene = dataclasses.replace(profile("swiss_lever").set("bodies.lever.angle", "5.00001°"), duration=0.05)
    done = simulate(scene, record=record)
    assert abs(done.end_q[done.slices["lever"]]) > math.radians(6.0), "the case tests nothing any more"
    assert done.stop == Stop.OVERLAP and done.stop.gave_up
    assert done.worst_overlap > 50e-6
    assert done.overlap["between"] == ["lever.ARMS", "banking.PINS"]
    assert 0.0 < done.overlap["t_s"] <= 0.05
    assert "lever.ARMS and banking.PINS overlapped by" in done.stop_message


@pytest.mark.usefixtures("unchecked")
@pytest.mark.parametrize("duration", [0.02, 5.0])
def test_a_tooth_that_goes_through_a_pallet_is_found(duration: float) -> None:
    """It is through after a millisecond and a half, between two rows, and the watch ticks on."""
    done = simulate(profile("swiss_lever").set("bodies.wheel.angle", "-0.28652°"), duration)
    assert done.counts["impacts"] > 10
    assert done.stop == Stop.OVERLAP
    assert done.overlap["between"] == ["wheel.TEETH", "lever.STONES"]
    assert done.overlap["t_s"] < 1.5e-3


def test_a_single_tooth_that_slips_through_late_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The wheel is moved by a tooth between two rows of a run that is sound otherwise."""
    flush = Run.flush

    def slipping(run: Run) -> None:
        rows = run.record.rows[: run.record.used.rows]
        late = (rows[:, 0] > 1.2345) & (run.record.used.rows > 0)
        rows[late, 1] -= 2.0 * math.pi / 15
        flush(run)

    monkeypatch.setattr(Run, "flush", slipping)
    done = simulate(profile("swiss_lever"), 2.0)
    assert done.stop == Stop.OVERLAP
    assert done.overlap["between"] == ["wheel.TEETH", "lever.STONES"]
    assert done.overlap["t_s"] == pytest.approx(1.2345, abs=0.01)


@pytest.mark.parametrize(
    "run", [case for name, case in short_runs.short_runs().items() if "Moreau" not in name][:13], ids=lambda run: run[0].title
)
def test_sound_runs_are_left_alone(run: short_runs.Short) -> None:
    scene, duration, how = run
    done = simulate(scene, duration, **how)
    assert done.stop == Stop.DURATION
    assert done.worst_overlap == 0.0
    assert (done.overlap["looks"] > 0) == bool(scene.contacts)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-11])
def test_no_tolerance_raises_an_alarm(tolerance: float) -> None:
    done = simulate(profile("swiss_lever"), 0.5, tolerance)
    assert (done.stop, done.worst_overlap) == (Stop.DURATION, 0.0)


def test_fixed_steps_report_what_they_overlap_and_fail_by_more() -> None:
    """Moreau's bodies overlap by what they move in a step: the outlines say what the gap functions say."""
    done = simulate(profile("bench_lever"), 0.3, method="moreau", step=2e-4)
    assert done.stop == Stop.DURATION
    assert done.overlap["resolution_m"] < done.worst_overlap <= 1.1 * done.worst_penetration
    assert done.overlap["allowed_m"] > done.worst_overlap


def test_being_watched_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    watched = simulate(profile("bench_lever"), 0.3)
    monkeypatch.setattr("watchsim.simulation.record.overlap_watch.OverlapWatch.see", lambda *_: None)
    alone = simulate(profile("bench_lever"), 0.3)
    assert np.array_equal(watched.q, alone.q) and np.array_equal(watched.u, alone.u)


@pytest.mark.usefixtures("unchecked")
def test_what_was_found_is_carried_on_written_and_said(tmp_path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = profile("swiss_lever").set("bodies.lever.angle", "5.00001°")
    first = simulate(scene, 0.05)
    later = simulate(scene, 0.1, start=first)
    assert later.stop == Stop.OVERLAP and later.worst_overlap >= first.worst_overlap
    write_results(first, tmp_path / "run", summary(first), "")
    numbers = summary(first)
    assert numbers["worst_overlap_m"] == numbers["overlap"]["worst_m"] == first.worst_overlap
    assert "checks of the outlines themselves: lever.ARMS and banking.PINS by" in summary_text(first, numbers)
    assert command.status(first, numbers) == 3
    assert "The result is wrong" in capsys.readouterr().err


def test_results_without_it_can_still_be_read(tmp_path) -> None:
    from watchsim.results.provenance import lock_text

    done = dataclasses.replace(simulate(profile("incline"), 0.1), overlap={})
    write_results(done, tmp_path / "run", {}, lock_text(done.scene, (tmp_path / "run").absolute()))
    assert read_results(tmp_path / "run").worst_overlap == 0.0


DEPTH = 1e-6


def layers(first: tuple[Loop, ...], second: tuple[Loop, ...]) -> Layers:
    return Layers((PairOfLayers(0, (Side("a"), Side("b")), (first, second), DEPTH / 8),))


SQUARE = (box(2 * MM, 2 * MM),)
BAR = (box(8 * MM, 0.5 * MM),)
RING = (circle(3 * MM), circle(2 * MM).reversed())
RING = (RING[0], dataclasses.replace(RING[1], hole=True))


TWO = tuple(circle(0.2 * MM).moved(0.0, (x, 0.0)) for x in (-4 * MM, 4 * MM))
FACE = (Loop((Line(2 * MM, 0.0, -2 * MM, 0.0),), closed=False),)

PLACED = [
    ("apart", SQUARE, SQUARE, (3 * MM, 0.0, 0.0), 0.0),
    ("touching", SQUARE, SQUARE, (2 * MM, 0.5 * MM, 0.0), 0.0),
    ("by a little", SQUARE, SQUARE, (1.99 * MM, 0.5 * MM, 0.0), 0.01 * MM),
    ("crossed", BAR, BAR, (0.0, 0.0, 0.5 * math.pi), 0.25 * MM),
    ("swallowed", SQUARE, (circle(0.2 * MM),), (0.1 * MM, 0.0, 0.0), 0.7 * MM),
    ("swallowing", (circle(0.2 * MM),), SQUARE, (0.1 * MM, 0.0, 0.0), 0.7 * MM),
    ("one of two swallowed", TWO, SQUARE, (4.1 * MM, 0.0, 0.0), 0.7 * MM),
    ("in the hole of a ring", RING, SQUARE, (0.0, 0.0, 0.3), 0.0),
    ("in the ring itself", RING, (circle(0.2 * MM),), (2.5 * MM, 0.0, 0.0), 0.3 * MM),
    ("resting on a face", FACE, SQUARE, (0.0, 1 * MM, 0.0), 0.0),
    ("through a face", FACE, SQUARE, (0.0, 0.9 * MM, 0.0), 0.1 * MM),
    ("round the end of a face", FACE, SQUARE, (2.5 * MM, 0.0, 0.0), 0.0),
    ("behind a face", FACE, SQUARE, (0.0, -2 * MM, 0.0), 0.0),
]


@pytest.mark.parametrize("turn", [0.0, 2.1])
@pytest.mark.parametrize("name, first, second, pose, depth", PLACED, ids=[case[0] for case in PLACED])
def test_pairs(name: str, first: tuple[Loop, ...], second: tuple[Loop, ...], pose, depth: float, turn: float) -> None:
    """The same at every place and angle of the two together."""
    x, y, angle = pose
    place = complex(x, y) * np.exp(1j * turn) + complex(7 * MM, -3 * MM)
    one = [(7 * MM, -3 * MM, turn), (7 * MM, -3 * MM, turn), (0.0, 0.0, 0.0)]
    other = [(place.real, place.imag, angle + turn), (place.real, place.imag, angle + turn), (1.0, 0.0, 0.0)]
    where, looked = np.array([one, other]), layers(first, second)
    assert looked.overlapping(where, DEPTH).tolist() == [[depth > 0.0, depth > 0.0, False]]
    if depth:
        assert looked.pairs[0].deepest(where[:, 0])[0] >= 0.99 * depth


def test_rows_are_chosen_at_the_start_and_where_they_are_far_apart() -> None:
    rows = np.zeros((BLOCK + 100, 4))
    rows[:, 0] = np.arange(len(rows))
    rows[5000:, 1] = 1.0
    assert set(EARLY) | {4999} <= set(chosen_moves(rows, 1, 0).tolist())
    assert not set(EARLY) & set(chosen_moves(rows, 1, 10**6).tolist()) - {0, 4999, BLOCK}


def test_open_faces_in_motion() -> None:
    """A disc that begins across a line falls through it, since no gap function takes that for a touch."""
    bodies = (
        Body("ground", "fixed", loops=FACE),
        Body("disc", "free", (0.0, 0.2 * MM), mass=1e-3, inertia=1e-10, velocity=(0.0, 0.0, 0.0), loops=(circle(1 * MM),)),
    )
    scene = Scene("inside", bodies, contacts=(Contact((Side("ground"), Side("disc"))),), gravity=(0.0, -9.81), duration=0.01)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Run, "begin", lambda run: None)
        assert simulate(scene).stop == Stop.OVERLAP


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("coordinate", [0, 1])
def test_a_long_way_between_rows_counts_in_either_direction(coordinate: int, sign: float) -> None:
    """By its own scale; at one and the same time, as at an impact, nothing lies between."""
    watch = object.__new__(OverlapWatch)
    watch._scale, watch._last = np.array([1.0, 0.01]), np.array([[2.0, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0]])
    for share, later, far in ((1.01, 0.1, True), (0.99, 0.1, False), (1.01, 0.0, False)):
        row = watch._last[0].copy()
        row[0] += later
        row[1 + coordinate] += sign * share * STRIDE * watch._scale[coordinate]
        assert watch._is_far(row) == far
