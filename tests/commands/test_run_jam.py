"""Does a run that ends in a jam say so, with status 3, and no fault of the program behind it?"""

from pathlib import Path

import pytest

from watchsim.cli import main
from watchsim.commands.console import GAVE_UP

JAM = """
[bodies.pusher]
circle = "2 mm"
motion = "driven"
velocity = "90 °/s"
pivot = ["-5 mm", "0 mm"]
[bodies.lever]
polygon = [["-1 mm", "-1 mm"], ["9 mm", "-1 mm"], ["9 mm", "1 mm"], ["-1 mm", "1 mm"]]
position = ["0 mm", "7 mm"]
inertia = "1 g·cm²"
[bodies.bank]
circle = "1 mm"
position = ["6 mm", "9.5 mm"]
motion = "fixed"
[[contacts]]
between = ["pusher", "lever"]
[[contacts]]
between = ["lever", "bank"]
[run]
duration = "2 s"
"""


def test_a_driven_body_that_jams_another_is_named_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "scene.toml").write_text(JAM, encoding="utf-8")
    assert main(["run", str(tmp_path), "--no-plots", "-o", str(tmp_path / "run")]) == GAVE_UP
    said = capsys.readouterr().err
    assert "pusher, which is driven, leaves lever no way out" in said
    assert "This is a jam" in said
    assert "complementarity" not in said
    assert "fault of watchsim" not in said
