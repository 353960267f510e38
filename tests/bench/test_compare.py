"""Is the comparison fair and told in full: right errors, spread, references that another method confirms?"""

from __future__ import annotations

import dataclasses
import json

import pytest

from watchsim.bench.compare import compare, missing_engines
from watchsim.bench.comparison_table import table
from watchsim.bench.engines.world import is_installed
from watchsim.bench.scenarios import scenarios
from watchsim.cli import main
from watchsim.commands import bench
from watchsim.commands.common.console import FINE

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


def test_engines_that_are_missing_are_named(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.setattr("watchsim.bench.compare.is_installed", lambda _: False)
    assert missing_engines() == ["pymunk", "box2d", "mujoco"]
    assert main(["bench", "--quick", "--scene", "incline", "-o", str(tmp_path)]) == FINE
    said = capsys.readouterr()
    assert "pymunk is not installed" in said.err
    assert "pip install 'watchsim[bench]'" in said.err
    assert "| pymunk" not in said.out


def test_an_unknown_scene_is_refused(capsys) -> None:
    assert main(["bench", "--scene", "inclin"]) == 2
    assert "Choose from incline; " in capsys.readouterr().err
    assert bench.HELP
