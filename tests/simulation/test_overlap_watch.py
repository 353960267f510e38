"""Is material inside material found in a run, and nothing reported of sound ones?"""

import dataclasses
import math

import numpy as np
import pytest
import short_runs
from moving_scenes import box, circle, profile

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.mechanism.compile import compile_scene
from watchsim.results.folder import read_results, write_results
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import WHOLE_RUN, Body, Scene
from watchsim.simulation import EVENT_DRIVEN, MOREAU
from watchsim.simulation.overlap_sieve import BLOCK, EARLY, chosen_moves
from watchsim.simulation.overlap_watch import Layers, OverlapWatch, PairOfLayers
from watchsim.simulation.runner import Run
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop

# Is material inside material found in a run whose contacts were lost, and nothing reported of sound ones?

MM = 1e-3


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


def test_results_without_it_can_still_be_read(tmp_path) -> None:
    from watchsim.results.folder import lock_text

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


# When does the watch look, what does it keep of what it sees, and when does it say that a run is wrong?

SCENE = Scene(
    "squares",
    (
        Body("post", "fixed", (-50 * MM, 0.0), loops=SQUARE),
        Body("still", "fixed", (5 * MM, 1 * MM), loops=SQUARE),
        Body("slider", "slide", (2 * MM, 1.5 * MM), axis=(1.0, 0.0), mass=1e-3, loops=SQUARE),
    ),
    contacts=(Contact((Side("slider"), Side("post"))), Contact((Side("slider"), Side("still")))),
    duration=8.0,
)
COMPILED = compile_scene(SCENE)
SIZE = COMPILED.size


def watch(method: str = EVENT_DRIVEN, windows: tuple[tuple[float, float], ...] = WHOLE_RUN) -> OverlapWatch:
    return OverlapWatch(SCENE, COMPILED, method, windows)


def rows(places: list[float], start: float = 0.0) -> np.ndarray:
    """A row (t, q, u, a) each second, at rest at these places (mm)."""
    found = np.zeros((len(places), 4))
    found[:, 0], found[:, 1] = start + np.arange(len(places)), np.array(places) * MM
    return found


def seen(looker: OverlapWatch, *parts: np.ndarray) -> OverlapWatch:
    for part in parts:
        looker.see_rows(part)
    looker.see()
    return looker


def test_what_overlaps_is_told_with_depth_time_and_place() -> None:
    looker = seen(watch(MOREAU), rows([0.0, 0.5, 1.3, 0.2]))
    found = looker.result(0.0)
    assert found["worst_m"] == pytest.approx(0.3 * MM)
    assert found["t_s"] == 2.0 and found["between"] == ["slider", "still"]
    assert 4.0 <= found["x_mm"] <= 4.3 and 0.5 <= found["y_mm"] <= 2.0
    assert looker.words().startswith("slider and still overlapped by 300 µm at t = 2 s, at (4")
    nothing = seen(watch(MOREAU), rows([0.0, 0.5, 1.0, 0.2])).result(0.0)
    assert nothing["worst_m"] == 0.0 and nothing["looks"] == 3
    assert [nothing[name] for name in ("between", "t_s", "x_mm", "y_mm")] == [None] * 4


def test_within_a_move_it_looks_between_its_rows() -> None:
    """The move there and back again is over between two rows: their velocities say so."""
    there = rows([0.9, 0.9])
    there[:, 2] = 1.6 * MM, -1.6 * MM  # quintic: 0.5 mm further at the middle
    looker = seen(watch(), there)
    assert looker.found.looks == 1.0 and looker.found.time == 0.5
    assert looker.found.depth == pytest.approx(0.4 * MM)


def test_an_overlap_counts_as_the_worst_when_it_is_a_quarter_deeper() -> None:
    """So that each step of an overlap that grows is not measured anew."""
    assert seen(watch(MOREAU), rows([0.0, 1.2, 1.24, 0.0])).found.depth == pytest.approx(0.2 * MM)
    assert seen(watch(MOREAU), rows([0.0, 1.2, 1.26, 0.0])).found.depth == pytest.approx(0.26 * MM)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_what_is_shallower_than_the_resolution_is_not_seen(share: float) -> None:
    """A twenty thousandth of the scene's size."""
    looker = seen(watch(MOREAU), rows([0.0, 1.0 + share * 5e-5 * SIZE / MM, 0.0]))
    assert (looker.found.depth > 0.0) == (share > 1.0)
    assert looker.resolution == pytest.approx(5e-5 * SIZE)


@pytest.mark.parametrize("share", [0.6, 1.6])
def test_chords_are_close_to_their_arcs(share: float) -> None:
    """An overlap of two discs is seen in every direction, and none where there is none."""
    discs = [dataclasses.replace(body, loops=(circle(1 * MM),), position=(x, 0.0)) for body, x in
             zip(SCENE.bodies, (-50 * MM, 5 * MM, 2 * MM), strict=True)]  # fmt: skip
    for angle in np.linspace(0.0, 3.0, 9):
        turned = tuple(dataclasses.replace(body, angle=float(angle) * i) for i, body in enumerate(discs))
        scene = dataclasses.replace(SCENE, bodies=turned)
        looker = OverlapWatch(scene, compile_scene(scene), MOREAU, WHOLE_RUN)
        seen(looker, rows([0.0, 1.0 + share * looker.resolution / MM]))
        assert (looker.found.depth > 0.0) == (share > 1.0)


def test_how_deep_bodies_may_overlap() -> None:
    """Events: as deep as is seen at all. Fixed steps: half a hundredth of the size, or four times what gap functions say."""
    assert watch().limit(1.0) == watch().resolution
    assert watch(MOREAU).limit(0.0) == pytest.approx(5e-3 * SIZE) == watch(MOREAU).limit(1e-3 * SIZE)
    assert watch(MOREAU).limit(2e-3 * SIZE) == pytest.approx(8e-3 * SIZE)
    looker = seen(watch(MOREAU), rows([0.0, 1.0 + 6e-3 * SIZE / MM, 0.0]))
    assert looker.fails(0.0) and looker.fails(1.4e-3 * SIZE) and not looker.fails(1.6e-3 * SIZE)
    assert not watch().fails(0.0)


def test_without_rows_a_state_is_looked_at_sixteen_times() -> None:
    """The next time is later, also where the last one was reached but for rounding; with rows there are none."""
    looker = watch(windows=((1.0, 2.0),))
    times, t = [], 0.0
    while t < SCENE.duration:
        t = looker.next_look(t)
        times.append(t)
    assert times == pytest.approx([0.5 * k for k in range(1, 17)])
    for t, later in ((8.0, 8.5), (15.9, 16.0), (16.0, 17.0), (100.0, 104.0)):  # sixteen more whenever the time has doubled
        assert looker.next_look(t) == pytest.approx(later)
    assert looker.next_look(0.5 * (1.0 - 1e-13)) == pytest.approx(1.0)
    assert looker.next_look(0.5 * (1.0 - 1e-9)) == 0.5
    assert watch().next_look(0.0) == math.inf


def test_four_states_are_looked_at_together() -> None:
    looker = watch(windows=((1.0, 2.0),))
    looker.see_rows(rows([0.0, 1.3, 0.0]))
    looker.see()
    assert looker.found.looks == 0.0 and looker.found.rows == 3.0
    for k, place in enumerate([0.0, 0.1, 1.2]):
        looker.see_state(0.5 * k, np.array([place * MM]))
        assert looker.found.looks == 0.0
    looker.see_state(1.5, np.array([0.0]))
    assert looker.found.looks == 4.0 and looker.found.time == 1.0
    looker.see_state(2.0, np.array([1.5 * MM]))
    looker.see()
    assert looker.found.looks == 5.0 and looker.found.depth == pytest.approx(0.5 * MM)


@pytest.mark.parametrize("parts", [1, 2, 5])
def test_numbers_that_were_owed_are_those_of_the_moment(parts: int) -> None:
    """However many moves are looked at together: each copy holds what was found up to it, and how many rows it had seen."""
    places = [0.0, 0.6, 1.2, 0.3, 1.1, 1.7, 0.0, 1.9, 0.2, 0.1]
    looker, alone = watch(MOREAU), watch(MOREAU)
    owed, expected = [], []
    for k, part in enumerate(np.array_split(rows(places), 5)):
        looker.see_rows(part)
        numbers = looker.numbers.copy()
        looker.fill_in_later(numbers)
        owed.append(numbers)
        if k % parts == parts - 1:
            looker.see()
        alone.see_rows(part)
        alone.see()
        expected.append(alone.numbers.copy())
    looker.see()
    assert np.array(owed) == pytest.approx(np.array(expected))
    assert looker.numbers.tolist() == alone.numbers.tolist()


def test_where_nothing_can_meet_nothing_is_looked_at() -> None:
    scene = dataclasses.replace(SCENE, contacts=())
    looker = OverlapWatch(scene, compile_scene(scene), EVENT_DRIVEN, WHOLE_RUN)
    assert seen(looker, rows([0.0, 1.5])).found.looks == 0.0
