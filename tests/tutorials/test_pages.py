"""Do the tutorials and the pages for developers work as they stand?"""

import argparse
import math
import re
import shlex
import sys
import textwrap
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from watchsim.cli import main
from watchsim.designs import Maker
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.roles import frequency

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
TUTORIALS = sorted((DOCS / "tutorials").glob("[!R]*.md"))  # README.md lists them
DEVELOP = sorted((DOCS / "develop").glob("*.md"))
BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^ *```$", re.MULTILINE | re.DOTALL)


def blocks(page: Path) -> list[tuple[str, str]]:
    """(language, text) of every block of code on the page."""
    return [(language, textwrap.dedent(text)) for _, language, text in BLOCK.findall(page.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_tutorial_runs_from_its_first_line_to_its_last(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Scene files are written (`# NAME` in the first line; `continued` appends), commands and Python run."""
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    done = set()
    for language, text in blocks(page):
        done.add(language)
        if language == "toml":
            name, _, how = text.splitlines()[0].removeprefix("# ").partition(", ")
            before = (tmp_path / name).read_text(encoding="utf-8") if how == "continued" else ""
            (tmp_path / name).write_text(before + text, encoding="utf-8")
        elif language == "python":
            exec(compile(text, str(page), "exec"), names)
        else:
            for line in text.splitlines():
                _, _, *words = shlex.split(line)  # $ watchsim ...
                assert main(words) == 0, (line, capsys.readouterr().err)
    assert done == {"toml", "console", "python"}
    for scene in tmp_path.glob("*.toml"):  # what was continued is whole, and keeps its promises
        assert main(["run", str(scene), "--no-plots", "-o", str(tmp_path / "again")]) == 0, capsys.readouterr().err


@pytest.fixture
def executed(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], dict[str, Any]]:
    """Runs a text as a module of its own and gives its names."""

    def execute(text: str) -> dict[str, Any]:
        module = types.ModuleType("of_a_page")
        monkeypatch.setitem(sys.modules, module.__name__, module)
        exec(compile(text, module.__name__, "exec", dont_inherit=True), module.__dict__)
        return module.__dict__

    return execute


def example(page: str, holding: str) -> str:
    """The one block of Python on a page for developers that holds these words."""
    (text,) = (text for language, text in blocks(DOCS / "develop" / page) if language == "python" and holding in text)
    return text


def test_one_kernel_is_called_as_shown(executed: Callable[[str], dict[str, Any]]) -> None:
    assert executed(example("debug.md", "callable_kernel"))["gap"] == pytest.approx(0.1, abs=1e-12)


def test_the_example_of_a_design_is_one(tmp_path: Path, executed: Callable[[str], dict[str, Any]]) -> None:
    design = executed(example("extend.md", "DESIGN = "))["DESIGN"]
    assert design.refusals({}) == ()
    assert [conflict.dimension for conflict in design.refusals({"length": 5.0})] == ["length"]
    scene = load(Maker(design)(length="300 mm").write(tmp_path / "pendulum"))
    assert scene.title == "Simple pendulum"
    exact = math.sqrt(9.81 * 0.3 / (0.3**2 + 0.5 * 0.01**2)) / math.tau
    assert frequency(scene) == pytest.approx(exact, rel=1e-9)


def test_the_example_of_a_command_is_one(executed: Callable[[str], dict[str, Any]], capsys: pytest.CaptureFixture[str]) -> None:
    names = executed(example("extend.md", "HELP = "))
    parser = argparse.ArgumentParser()
    names["options"](parser)
    assert names["run"](parser.parse_args([str(profiles_dir() / "incline")])) == 0
    assert capsys.readouterr().out.split() == ["disc", "plane"]


@pytest.mark.parametrize("page", [ROOT / "CONTRIBUTING.md", *DEVELOP], ids=lambda page: page.stem)
def test_files_that_developers_are_sent_to_are_there(page: Path) -> None:
    named = re.findall(r"`((?:watchsim|tests|scripts|docs|profiles|construction)/[\w/.-]+)`", page.read_text(encoding="utf-8"))
    made_by_the_reader = {path for path in named if "NAME" in path}
    missing = [
        path
        for path in set(named) - made_by_the_reader
        if not any((base / path).exists() or (base / f"{path}.py").exists() for base in (ROOT, ROOT / "watchsim"))
    ]
    assert missing == []
