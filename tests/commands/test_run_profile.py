"""Does `--profile` say where the time went, in words and in summary.json?"""

import json
from pathlib import Path

import pytest

import watchsim as ws
from watchsim import jit
from watchsim.bench import profile as run_profile
from watchsim.cli import main
from watchsim.commands import write as write_run
from watchsim.commands.console import BAD_INPUT, FINE

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


def test_the_first_profile_says_that_it_compiles(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """What times the kernels is compiled apart from the solver, and as long."""
    run = ws.simulate(SCENE, duration=0.01)
    monkeypatch.setattr(run_profile, "profile_of", lambda run: {})
    for known, told in ((False, 1), (True, 0)):
        monkeypatch.setattr(jit, "is_cached", lambda kernel, known=known: known or kernel == "advance.advance")
        write_run._numbers(run, write_run.Extras(profile=True), (), Path())
        assert capsys.readouterr().err.count("Compiling what times the kernels") == told


def test_fixed_steps_have_no_profile(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", SCENE, "--profile", "--method", "moreau", "-o", str(tmp_path / "x")]) == BAD_INPUT
    told = capsys.readouterr().err
    assert "--profile" in told and "pfeiffer-glocker" in told and "moreau" in told
    assert not (tmp_path / "x").exists()
