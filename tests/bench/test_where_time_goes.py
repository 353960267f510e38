"""Are the shares of time those that clocks within the loop find, and is the floor made of counts and measured costs?"""

from __future__ import annotations

import dataclasses
import platform
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from clocked import clocked_loop
from naive.lcp_oracle import solutions

from watchsim.analysis.promised import COUNTS
from watchsim.bench.profile.lcp_costs import problems_met, size_name
from watchsim.bench.profile.repeated_work import problems_again
from watchsim.bench.profile.run_profile import WORDS, profile_of, profile_text
from watchsim.bench.profile.sampled_moments import SAMPLE, Kind, Walk
from watchsim.candidates.pair_cache import forget
from watchsim.dynamics.lcp.lemke_pivoting import lcp_work
from watchsim.mechanism.compile import compile_scene
from watchsim.model.named_fields import words_of
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import advance
from watchsim.simulation import runner as run
from watchsim.simulation.record.trajectory import EVENT_DTYPE, Trajectory
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

RUNS = [("incline", 3.0), ("bench_lever", 10.0), ("swiss_lever", 10.0)]
SMOOTH = ("step", "flight")
PROBLEMS = tuple(name for name in WORDS if name.startswith("lcp_"))
CLOCKS = {  # kernel with a clock -> the work that it does, but for what other kernels with clocks do within
    "motion": ("evaluation",),
    "first_touch": ("gap_evaluation", "cell_lookup"),
    "_smooth_step": SMOOTH,
    "lemke_checked": PROBLEMS,
    "collide": ("impact",),
    "_settle": ("instant",),
}


def scene(name: str) -> Scene:
    return load(profiles_dir() / name / "scene.toml")


def a_run(stepped: Callable[..., Any], name: str, duration: float) -> run.Run:
    """A run by the given compiled loop, with all cells known."""
    given = scene(name)
    made = run.Run(given, compile_scene(given), given.tolerance, Recording(keep="statistics"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "advance", stepped)
        assert made.to_the_end(duration, None) == Stop.DURATION
    return made


@pytest.fixture(scope="module")
def clocked() -> tuple[Callable[..., Any], Callable[[], dict[str, np.ndarray]]]:
    return clocked_loop(advance.advance, tuple(CLOCKS))


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="reads the counter of these processors")
@pytest.mark.parametrize(("name", "duration"), RUNS[1:])  # the incline is done before its code is in the caches
def test_shares_are_those_of_clocks_within_the_loop(name: str, duration: float, clocked: Any) -> None:
    loop, clocks = clocked
    made = simulate(scene(name), duration, record="statistics")  # learns the cells, which takes some work again
    plain, timed = a_run(advance.advance, name, duration), a_run(loop, name, duration)
    for part, other in zip(plain.state, timed.state, strict=True):
        assert np.array_equal(part, other)
    apart: dict[str, tuple[float, float]] = {}
    work: dict[str, Any] = {}
    for _ in range(5):  # other programs may slow down one measurement of a cost, but not each
        found, read = profile_of(made)["work"], read_clocks(loop, clocks, name, duration)
        work = {kind: min(found[kind], work.get(kind, found[kind]), key=lambda one: one["seconds"]) for kind in found}
        assert read["motion"][1] == work["evaluation"]["count"]
        assert read["_settle"][1] == work["instant"]["count"]
        assert read["_smooth_step"][1] == sum(work[one]["count"] for one in SMOOTH)
        apart = far_apart(work, {kernel: ticks for kernel, (ticks, _) in read.items()})
        if not apart:
            break
    assert not apart


def read_clocks(loop: Any, clocks: Any, name: str, duration: float) -> dict[str, tuple[int, int]]:
    """Kernel -> (ticks, calls), of each call the fewest ticks of five runs."""
    clocks()
    found = []
    for _ in range(5):
        a_run(loop, name, duration)
        found.append(clocks())
    quickest = {kernel: np.min([one[kernel] for one in found], axis=0) for kernel in CLOCKS}
    return {kernel: (int(ticks.sum()), len(ticks)) for kernel, ticks in quickest.items()}


def far_apart(work: dict[str, Any], ticks: dict[str, int]) -> dict[str, tuple[float, float]]:
    """Kernels whose shares by count and cost and by the clock differ: kernel -> both.

    In the midst of others a kernel runs slower than many times in a row, and the clocks themselves take time.
    """
    seconds = {kernel: sum(work[one]["seconds"] for one in kinds if one in work) for kernel, kinds in CLOCKS.items()}
    shares = {kernel: (seconds[kernel] / sum(seconds.values()), ticks[kernel] / sum(ticks.values())) for kernel in CLOCKS}
    return {kernel: (share, clock) for kernel, (share, clock) in shares.items() if abs(share - clock) > 0.2 * clock + 0.015}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "duration"), RUNS)
def test_the_floor_is_counts_times_costs_and_explains_the_run(name: str, duration: float) -> None:
    made = simulate(scene(name), duration, record="statistics")
    profile = profile_of(made)
    work, counts = profile["work"], profile["counts"]
    assert counts["impacts"] == made.counts["impacts"] == work["impact"]["count"]
    everywhere = {"step", "evaluation", "flight", "gap_evaluation", "instant", "impact", "call"}
    assert set(work) - set(PROBLEMS) == everywhere | ({"cell_lookup"} if counts["cells"] else set())
    assert sum(work[one]["count"] for one in PROBLEMS if one in work) == counts["lcp"]
    assert profile["floor_s"] == pytest.approx(sum(one["count"] * one["seconds_each"] for one in work.values()))
    assert profile["over_numerics"] >= profile["over_floor"] == pytest.approx(profile["stepping_s"] / profile["floor_s"])
    assert profile["rest"]["share"] + sum(one["share"] for one in work.values()) == pytest.approx(1.0)
    assert all(one["seconds_each"] > 0.0 for one in work.values())
    assert -0.15 < profile["rest"]["share"] < 0.4
    told = profile_text(profile)
    assert all(WORDS[one] in told for one in work)


@pytest.mark.slow
def test_cells_learnt_are_those_of_a_first_run() -> None:
    forget()
    made = simulate(scene("swiss_lever"), 1.0, record="statistics")
    learning = profile_of(made)["learning"]
    assert learning["count"] == made.counts["cells_asked"] > 0
    assert 0.0 < learning["share"] < 1.0
    assert learning["seconds"] == pytest.approx(learning["count"] * learning["seconds_each"])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "duration"), RUNS)
def test_a_walk_does_what_the_run_does(name: str, duration: float) -> None:
    walk = Walk(scene(name), scene(name).tolerance, duration)
    # A run that learns cells goes back to where it met them, and does some work again.
    whole = simulate(scene(name), duration, record="statistics").counts
    assert walk.counts == {one: whole[one] for one in walk.counts}
    assert walk.met[Kind.STEP] == whole["steps"] and walk.met[Kind.FLIGHT] == whole["flights"]
    assert walk.met[Kind.IMPACT] + walk.met[Kind.CHANGE] == whole["instants"]
    for kind, moments in walk.moments.items():
        assert len(moments) == min(walk.met[kind], SAMPLE)
        for moment in moments[::20]:
            walk.again(moment)
            done = words_of(walk.run.state.counts, int) - words_of(moment.state.counts, int)
            assert np.array_equal(done, moment.done)
            assert moment.kind == kind


@pytest.mark.slow
def test_problems_met_are_solved_by_what_enumeration_finds() -> None:
    problems = [(A, b) for A, b in problems_met(Walk(scene("swiss_lever"), 1e-9, 1.0)) if len(b) <= 6]
    assert {size_name(len(b)) for _, b in problems} == {"lcp_to_1", "lcp_to_2", "lcp_to_4", "lcp_to_8"}
    for A, b in problems[::10]:
        x, scale = np.zeros(len(b)), np.abs(b).max()
        problems_again(A, b, len(b), lcp_work(len(b)), x, 1)
        assert any(np.allclose(x / scale, other, atol=1e-8) for other in solutions(A, b / scale))


def test_what_is_not_done_is_not_told() -> None:
    entry = {"count": 2000, "seconds_each": 1e-6, "seconds": 2e-3, "share": 0.8}
    profile = {
        "stepping_s": 2.5e-3,
        "simulated_s": 5.0,
        "work": {"evaluation": entry},
        "rest": {"seconds": 5e-4, "share": 0.2},
        "over_floor": 1.25,
        "over_numerics": 1.25,
        "learning": {"count": 0, "seconds_each": 0.0, "seconds": 0.0, "share": 0.0},
    }
    first, second, third, fourth = profile_text(profile).splitlines()
    assert first.split() == ["stepping", "0.0025", "s", "of", "processor", "time", "for", "5", "s", "simulated"]
    assert second.split() == ["accelerations", "of", "coupled", "bodies", "2000", "×", "1000", "ns", "=", "80.0", "%"]
    assert third.strip() == "1.25 × the sum of these, 1.25 × accelerations, gaps and problems alone"
    assert fourth.split() == ["the", "rest", "20.0", "%"]
    learnt = profile | {"learning": {"count": 10, "seconds_each": 5e-5, "seconds": 5e-4, "share": 0.1}}
    assert profile_text(learnt).splitlines()[-1].split()[:5] == ["cells", "10", "learnt", "×", "50"]


def test_runs_with_fixed_steps_have_no_profile() -> None:
    nothing = np.zeros((0, 1))
    made = Trajectory(scene("incline"), np.zeros(0), nothing, nothing, nothing, {}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION)
    with pytest.raises(ValueError, match="moreau"):
        profile_of(dataclasses.replace(made, method="moreau", counts=dict.fromkeys(COUNTS, 0)))
