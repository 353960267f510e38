"""Do shells complete commands, and the paths of a scene behind --set?"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from watchsim.cli import main
from watchsim.commands.completion import SHELLS


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
@pytest.mark.parametrize(
    ("words", "found"),
    [("sche", "schema"), ("run a --set design.lo", "design.lock="), ("check a --set torques.0.v", "torques.0.value=")],
)
def test_bash_completes(words, found, tmp_path, capsys):
    assert main(["new", "swiss_lever", "-o", str(tmp_path / "a")]) == 0
    capsys.readouterr()
    assert main(["schema", "--completion", "bash"]) == 0
    (tmp_path / "script").write_text(capsys.readouterr().out, encoding="utf-8")
    typed = (
        f"COMP_WORDS=(watchsim {words}); COMP_CWORD={len(words.split())}; _shtab_watchsim; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    )
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    made = subprocess.run(
        ["bash", "-c", f". ./script; {typed}"],
        cwd=tmp_path,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    assert made.stdout.split() == [found]


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_has_a_script_with_paths_with_and_without_the_command(shell, capsys):
    assert [main([*words, "--completion", shell]) for words in (["schema"], [])] == [0, 0]
    assert capsys.readouterr().out.count(" schema --paths") == 2
