"""Does `--profile` say where the time went, in words and in summary.json?"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from watchsim.cli import main
from watchsim.commands.common.console import BAD_INPUT, FINE

SCENE = str(Path(__file__).resolve().parents[2] / "profiles" / "incline" / "scene.toml")
WORDS = {"step": "steps of coupled bodies", "impact": "impacts", "lcp_to_4": "problems of 3 and 4 unknowns"}


@pytest.mark.slow
def test_the_profile_is_printed_and_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", SCENE, "--profile", "--no-plots", "-o", str(tmp_path / "x")]) == FINE
    told = capsys.readouterr().out
    summary = json.loads((tmp_path / "x" / "summary.json").read_text(encoding="utf-8"))
    work = summary["profile"]["work"]
    assert work["impact"]["count"] == summary["counts"]["impacts"] == 20
    lines = [" ".join(line.split()) for line in told.splitlines()]
    for name, words in WORDS.items():
        assert any(line.startswith(f"{words} {work[name]['count']} ×") for line in lines)
    assert "the rest" in told


def test_fixed_steps_have_no_profile(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", SCENE, "--profile", "--method", "moreau", "-o", str(tmp_path / "x")]) == BAD_INPUT
    told = capsys.readouterr().err
    assert "--profile" in told and "pfeiffer-glocker" in told and "moreau" in told
    assert not (tmp_path / "x").exists()
