"""What is answered to a command or an option that there is not?"""

import argparse
import importlib
import io
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from watchsim.cli import COMMANDS, CommandParser, main
from watchsim.commands import console
from watchsim.commands.completion import SHELLS
from watchsim.paths import profiles_dir

ANSWERS = [  # what was typed, whose usage is shown, what is said
    ("run --foo", "run", "there is no option --foo."),
    ("run here --frce", "run", "there is no option --frce. Did you mean --force?"),
    ("run here --fource=1", "run", "there is no option --fource. Did you mean --force?"),
    ("plot --dak", "plot", "there is no option --dak. Did you mean --dark?"),
    ("check -json", "check", "there is no option -json. Did you mean --json?"),
    ("check -q", "check", "there is no option -q."),
    ("new --lst", "new", "there is no option --lst. Did you mean --list?"),
    ("plot here there", "plot", 'unexpected argument "there". Put quotes around a value that contains spaces.'),
    ("rnu here", "", 'there is no command "rnu". Did you mean run?'),
    ("scene.toml", "", f'there is no command "scene.toml". Commands: {", ".join(COMMANDS)}.'),
]


@pytest.mark.parametrize(("typed", "command", "said"), ANSWERS)
def test_what_is_not_known(typed: str, command: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(typed.split(" "))
    told, name = capsys.readouterr().err, f"watchsim {command}".strip()
    assert left.value.code == 2
    assert told.startswith(f"usage: {name} ") and told.endswith(f"\n{name}: error: {said}\n")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_known_whole_and_shortened(name: str) -> None:
    """Each alone is either taken, or something else is amiss."""
    parser = CommandParser(prog=name, exit_on_error=False)
    importlib.import_module(f"watchsim.commands.{name}").options(parser)
    listed = argparse.ArgumentParser(add_help=False)
    importlib.import_module(f"watchsim.commands.{name}").options(listed)
    options = [option for action in listed._actions for option in action.option_strings]
    assert options
    for option in options:
        for word in (option, f"{option}=1", option[:4] if option.startswith("--") else f"{option}x"):
            parser._check(word)


@pytest.mark.parametrize("value", ["-5s", "-30°", "−.5 mm", "-1 s:2 s", "-1.5"])
def test_a_negative_quantity_is_the_value_of_its_option(value: str) -> None:
    parser = CommandParser()
    parser.add_argument("--duration")
    parser.add_argument("place")
    assert vars(parser.parse_args(["--duration", value, "here"])) == {"duration": value, "place": "here"}


def test_keys_are_taken_before_and_after_options() -> None:
    parser = CommandParser()
    importlib.import_module("watchsim.commands.sweep").options(parser)
    found = parser.parse_args(["scene", "a=1,2", "-o", "here", "b=3,4", "--json", "c=5 µN·m"])
    assert (found.scene, found.keys, found.output, found.json) == ("scene", ["a=1,2", "b=3,4", "c=5 µN·m"], "here", True)


def test_a_sweep_speaks_in_the_unit_that_was_typed(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["sweep", str(profiles_dir() / "swiss_lever"), "--no-plots", "bodies.balance.inertia=-10:20:3 g·mm²"]
    assert main(words) == 2
    assert '"-10 g·mm²"' in capsys.readouterr().err


@pytest.mark.parametrize(("typed", "said"), [("2,80 °", "80 °"), ("0.03,1.5 rad", "1.5 rad")])
def test_a_later_point_that_is_refused_speaks_so_too(
    typed: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Only the first value is tried beforehand; the row of a later one says what is wrong with it."""
    (tmp_path / "scene.toml").write_text('[scene]\ntitle = "Lever"\nschema = 1\n[design]\nof = "swiss_lever"\nlock = "1.5°"\n')
    main(["sweep", str(tmp_path), f"design.lock={typed}", "--no-plots", "--outputs", "amplitude", "-o", str(tmp_path / "o")])
    assert f"design.lock {said}: must be from 0.1° to 4°" in capsys.readouterr().out


def test_a_folder_with_a_scene_is_told_from_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "scene.toml").write_text("")
    assert main(["plot", str(tmp_path)]) == 2
    assert f"missing. It holds a scene: watchsim run {tmp_path} makes results of it" in capsys.readouterr().err


@pytest.mark.parametrize("value", ["-1.5", "-30°", "- 3", "-1 s:2 s", "a=-b", "-", "-.5 mm"])
def test_values_are_no_options(value: str) -> None:
    parser = CommandParser()
    parser.add_argument("--window")
    parser.add_argument("changes", nargs="*")
    assert vars(parser.parse_args([value, "--window", value])) == {"window": value, "changes": [value]}


SENTENCE = "  verdict      not settled yet: the amplitude rises by 0.21° per second, on its way to about 279°"


def test_a_sentence_is_broken_between_words_under_its_beginning() -> None:
    lines = console.folded(SENTENCE, 60).split("\n")
    assert len(lines) == 2 and max(map(len, lines)) <= 60
    assert lines[0].startswith("  verdict      not") and lines[1].startswith(" " * 15 + "per")
    assert " ".join(" ".join(lines).split()) == " ".join(SENTENCE.split())


@pytest.mark.parametrize("line", ["short", "  key (°)    12.3    45.6    ticks, a row", "/a/path/" + 60 * "x"])
def test_rows_of_tables_and_paths_are_left_whole(line: str) -> None:
    assert console.folded(line, 40) == line


@pytest.mark.parametrize(("whole", "said"), [(8.0, "3 of 8   2.0 s elapsed, 5.0 s left"), (math.inf, "3   2.0 s elapsed")])
def test_progress_of_which_the_end_may_not_be_known(whole: float, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search on a terminal ended with a fault of the program as soon as it had taken a second."""
    screen = io.StringIO()
    screen.isatty = lambda: True  # type: ignore[method-assign]
    monkeypatch.setattr(sys, "stderr", screen)
    now = iter([0.0, 0.0, 2.0])
    monkeypatch.setattr(console.time, "monotonic", lambda: next(now))
    progress = console.Progress("designs:")
    monkeypatch.setattr(progress, "_shown", -1.0)
    progress(1.0, whole)
    progress(3.0, whole)
    assert screen.getvalue().rpartition("\r")[2].rstrip() == f"designs:  {said}"


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="needs a terminal")
def test_only_a_terminal_breaks_lines_and_never_json() -> None:
    """In a process of its own, whose standard output is a terminal of 50 columns."""
    said = "from watchsim.commands import console as c; c.open_streams(); w = 'word ' * 30; print(w); c.print_json({'a': w})"
    ours, theirs = os.openpty()
    import fcntl
    import struct
    import termios

    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 50, 0, 0))
    done = subprocess.run([sys.executable, "-c", said], stdout=theirs, check=True)
    text = os.read(ours, 10_000).decode().replace("\r\n", "\n")
    prose, json_text = text.split("{", 1)
    assert done.returncode == 0 and max(map(len, prose.split("\n"))) <= 50 and len(prose.split()) == 30
    assert max(map(len, json_text.split("\n"))) > 140
    plain = subprocess.run([sys.executable, "-c", said], capture_output=True, check=True, text=True)
    assert len(plain.stdout.split("\n")[0]) == 150


# Do shells complete commands, and the paths of a scene behind --set?


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
