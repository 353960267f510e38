"""Does the command line choose what is kept, and do the numbers stay?"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from watchsim.cli import main
from watchsim.commands.console import BAD_INPUT, FINE
from watchsim.profiles_path import profiles_dir

SCENE = str(profiles_dir() / "bench_lever")


def summary_of(folder: Path, *options: str) -> dict[str, object]:
    assert main(["run", SCENE, "--duration", "5 s", "--no-plots", "-o", str(folder), *options]) == FINE
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def test_statistics_with_a_window(tmp_path) -> None:
    whole = summary_of(tmp_path / "whole")
    few = summary_of(tmp_path / "few", "--record", "statistics", "--record", "1 s:1.5 s")
    assert (whole["kept"], few["kept"]) == ("all", "statistics")
    for name in ("amplitude_deg", "rate_s_per_d", "beat_error_ms", "energy", "missed_beats", "events_by_kind", "bodies"):
        assert few[name] == whole[name], name
    assert not (tmp_path / "few" / "plots").exists()
    with np.load(tmp_path / "few" / "trajectory.npz") as kept:
        inside = (kept["t"] >= 1.0) & (kept["t"] <= 1.5)
        assert inside.sum() > 100
        assert np.all(inside | (kept["t"] >= 2.0))
    # The locked scene says what was kept, and the folder can be gone on from.
    assert '"statistics"' in (tmp_path / "few" / "scene.lock.toml").read_text(encoding="utf-8")
    more = ["run", str(tmp_path / "few" / "scene.lock.toml"), "--resume", str(tmp_path / "few"), "--duration", "6 s"]
    assert main([*more, "--no-plots", "-o", str(tmp_path / "more")]) == FINE
    told = json.loads((tmp_path / "more" / "summary.json").read_text(encoding="utf-8"))
    assert told["whole_run"]["beats"] == few["whole_run"]["beats"] + 8


@pytest.mark.parametrize("what", ["statistic", "2 s:1 s", "1:2"])
def test_what_cannot_be_kept(what: str, capsys, tmp_path) -> None:
    assert main(["run", SCENE, "--record", what, "-o", str(tmp_path / "x")]) == BAD_INPUT
    assert "run.record" in capsys.readouterr().err
