"""Are the commands, scenes and Python of the pages such as the program takes? Tutorials run: tests/tutorials."""

import ast
import re
import shlex
import textwrap
from pathlib import Path

import pytest

from watchsim.cli import parser
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping
from watchsim.scene.toml import parsed

UNKNOWN = "unknown key"
ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^( *)```(\w*)\n(.*?)^ *```$", re.MULTILINE | re.DOTALL)
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*/*.md"))]
BLOCKS = [
    (page.relative_to(ROOT).as_posix(), language, textwrap.dedent(text))
    for page in PAGES
    for _, language, text in BLOCK.findall(page.read_text(encoding="utf-8"))
]
COMMANDS = [
    (page, line)
    for page, language, text in BLOCKS
    if language in {"", "console", "bash"}
    for line in text.replace("\\\n", " ").splitlines()
    if re.match(r"(\$ )?watchsim (?!COMMAND)", line)
]


@pytest.mark.parametrize(("page", "line"), COMMANDS, ids=[f"{page}: {line}"[:90] for page, line in COMMANDS])
def test_a_command_is_one_that_the_program_knows(page: str, line: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = shlex.split(line.removeprefix("$ "), comments=True)
    try:
        parser().parse_args([re.sub(r"\$\w+", "1", word) for word in words[1:]])
    except SystemExit:
        pytest.fail(f"{page}: {line}\n{capsys.readouterr().err}")


SCENES = [(page, text) for page, language, text in BLOCKS if language == "toml" and not page.startswith("docs/tutorials")]


@pytest.mark.parametrize(("page", "text"), SCENES, ids=[f"{page}: {text.splitlines()[0]}" for page, text in SCENES])
def test_a_part_of_a_scene_has_keys_that_exist(page: str, text: str) -> None:
    mapping = parsed(text)
    if "project" in mapping:  # of a package, not of a scene
        return
    try:
        from_mapping(mapping, None)
    except SceneError as error:
        assert [line for line in str(error).splitlines() if UNKNOWN in line] == []


PYTHON = [(page, text) for page, language, text in BLOCKS if language == "python" and not page.startswith("docs/reference")]


@pytest.mark.parametrize(("page", "text"), PYTHON, ids=[page for page, _ in PYTHON])
def test_python_is_python(page: str, text: str) -> None:
    assert ast.parse(text, page).body


@pytest.mark.slow
def test_the_python_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # profiles/NAME is found there, too
    (text,) = (text for page, text in PYTHON if page == "README.md")
    names: dict[str, object] = {}
    exec(compile(text, "README.md", "exec"), names)
    assert Path("beat.png").stat().st_size > 10_000
    assert len(names["table"].rows) == 13  # type: ignore[attr-defined]


def test_there_are_examples() -> None:
    assert len(COMMANDS) > 50 and len(SCENES) > 15 and len(PYTHON) > 5
