"""Mechanisms that do not touch each other do not feel each other, however many stand in one scene."""

from __future__ import annotations

from watchsim.bench.growth import side_by_side
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop


def test_levers_side_by_side_move_as_each_alone() -> None:
    scene = load(profiles_dir() / "bench_lever" / "scene.toml")
    alone, many = simulate(scene, 0.3), simulate(side_by_side(scene, 6), 0.3)
    assert many.stop == Stop.DURATION
    assert many.counts["lcp_failures"] == 0
    first = many.q[-1][: len(alone.q[-1])]
    assert abs(first - alone.q[-1]).max() < 1e-9
