"""Is the floor made of counts and measured costs, and below what the run takes?"""

from __future__ import annotations

import pytest

from watchsim.bench.profile import profile_of, profile_text
from watchsim.mechanism.load import load
from watchsim.profiles_path import profiles_dir
from watchsim.simulation.simulate import simulate


@pytest.mark.slow
def test_the_floor_of_a_lever() -> None:
    run = simulate(load(profiles_dir() / "bench_lever" / "scene.toml"), 5.0)
    profile = profile_of(run)
    assert profile["counts"]["impacts"] == run.counts["impacts"]
    problems = {name for name in profile["work"] if name.startswith("lcp_")}
    assert set(profile["work"]) - problems == {"evaluation", "flight", "gap_evaluation"}
    assert sum(profile["work"][name]["count"] for name in problems) == profile["counts"]["lcp"]
    assert profile["floor_s"] == pytest.approx(sum(one["count"] * one["seconds_each"] for one in profile["work"].values()))
    assert 1.0 < profile["over_floor"] < 30.0
    assert "accelerations of coupled bodies" in profile_text(profile)
