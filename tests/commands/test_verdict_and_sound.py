"""Does the command line say when a watch does not work, and let it be heard?"""

import json
import wave
from pathlib import Path

import pytest

from watchsim.cli import main
from watchsim.paths import profiles_dir

SWISS = str(profiles_dir() / "swiss_lever")


@pytest.fixture(scope="module")
def knocking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "knocking"
    asked = ["run", SWISS, "--set", "torques.0.value=-10 µN·m", "--duration", "3 s", "--no-plots", "-o", str(folder)]
    assert main(asked) == 1
    return folder


def test_a_watch_that_knocks_is_no_good_result(knocking: Path) -> None:
    numbers = json.loads((knocking / "summary.json").read_text(encoding="utf-8"))
    assert numbers["verdict"] == "knocks" and numbers["verdict_message"].startswith("t = 0.6185 s  the watch knocks: ")
    about = numbers["verdict_details"]
    assert about["works"] is False and about["body"] == "balance" and about["torque_Nm"] == pytest.approx(-1e-5)
    assert about["pair"].startswith("balance.PIN arc") and about["t_s"] == pytest.approx(0.6185, abs=1e-4)
    lines = (knocking / "report.txt").read_text(encoding="utf-8").splitlines()
    assert next(line for line in lines if not line.startswith("Note")) == "Swiss lever, 4 Hz, 15 teeth"
    told = {line[2:14].strip(): line for line in lines if line.startswith("  ") and line[2] != " "}
    assert "the watch knocks" in told["verdict"]
    for label in ("amplitude", "rate", "beat error"):
        assert told[label].endswith(", while it knocks")


def test_what_has_not_settled_is_said_and_is_no_failure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", SWISS, "--duration", "3 s", "--no-plots", "--json", "-o", str(tmp_path / "run")]) == 0
    told = capsys.readouterr()
    numbers = json.loads(told.out)
    assert numbers["verdict"] == "unsettled" and "on its way to about 279°" in numbers["verdict_message"]
    assert "does not work" not in told.err


def test_no_watch_no_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["run", str(profiles_dir() / "incline"), "--duration", "0.1 s", "--no-plots", "--json", "-o", str(tmp_path / "run")]
    assert main(asked) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert [numbers[key] for key in ("verdict", "verdict_message", "verdict_details")] == [None, None, None]


def test_a_run_is_heard_for_as_long_as_is_asked(knocking: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sound", str(knocking)]) == 0
    assert capsys.readouterr().out.strip() == str(knocking / "tick.wav")
    target = tmp_path / "long.wav"
    assert main(["sound", str(knocking), "--duration", "7 s", "-o", str(target)]) == 0
    assert "oscillations are repeated" in capsys.readouterr().err
    for path, seconds in ((knocking / "tick.wav", 3), (target, 7)):
        with wave.open(str(path)) as file:
            assert file.getnframes() == seconds * 48000


def test_the_paper_of_a_run(knocking: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", str(knocking), "--tape"]) == 0
    assert (knocking / "plots" / "tape.png").read_bytes().startswith(b"\x89PNG")
    assert main(["plot", str(knocking), "--tape", "--window", "1 s:2 s", "-o", str(tmp_path / "paper.svg")]) == 0
    assert b"<svg" in (tmp_path / "paper.svg").read_bytes()
    capsys.readouterr()
    # What these commands wrote belongs to the results and goes with them.
    asked = ["run", SWISS, "--duration", "0.1 s", "--no-plots", "--force", "-o", str(knocking)]
    assert main(asked) == 0 and not (knocking / "tick.wav").exists() and not (knocking / "plots").exists()


@pytest.mark.parametrize(
    ("extra", "why"),
    [
        (["--duration", "13 h"], "up to 12 hours"),
        (["--duration", "60"], "needs a unit"),
        (["-o", "tick.mp3"], "ends in .wav"),
        (["-o", "/dev/null/tick.wav"], "/dev/null"),
    ],
)
def test_what_no_sound_can_be_is_refused(extra, why, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = tmp_path / "run"
    assert main(["run", SWISS, "--duration", "0.2 s", "--no-plots", "-o", str(run)]) == 0
    assert main(["sound", str(run), *extra]) == 2
    assert why in capsys.readouterr().err
    assert main(["sound", str(tmp_path / "nothing")]) == 2
