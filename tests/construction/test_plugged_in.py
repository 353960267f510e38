"""Does the design of docs/develop/extend.md, a file of another package, work like one of ours?"""

import json
import math
import re
import sys
from pathlib import Path

import pytest

import watchsim as ws
from watchsim.cli import main

PAGE = Path(__file__).resolve().parents[2] / "docs" / "develop" / "extend.md"


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """The page's pendulum as an installed package: what its entry point refers to, and the folder of the package."""
    section = PAGE.read_text(encoding="utf-8").partition("## A design\n")[2].partition("\n## ")[0]
    source, declared = (re.search(rf"```{kind}\n(.*?)```", section, re.DOTALL)[1] for kind in ("python", "toml"))
    group, name, value = re.fullmatch(r'\s*\[project\.entry-points\."(.+)"\]\s+(\w+) = "(.+)"\s*', declared).groups()
    home = tmp_path / "installed" / "my_clocks"
    home.mkdir(parents=True)
    (home / "__init__.py").touch()
    (home / "pendulum.py").write_text(source, encoding="utf-8")
    info = home.parent / "my_clocks-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my_clocks\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{group}]\n{name} = {value}\n")
    monkeypatch.syspath_prepend(str(home.parent))
    yield home
    for module in [name for name in sys.modules if name.partition(".")[0] == "my_clocks"]:
        del sys.modules[module]


def test_it_swings_as_long_as_its_length_says(installed):
    assert ws.designs.names()[-1] == "pendulum"
    run = ws.simulate(ws.designs.pendulum(length="300 mm").scene(), duration=1.5)
    about = 0.3**2 + 0.5 * 0.01**2
    modulus = math.sin(math.radians(2.5))
    agm = (1.0, math.sqrt(1.0 - modulus**2))
    for _ in range(6):
        agm = ((agm[0] + agm[1]) / 2.0, math.sqrt(agm[0] * agm[1]))
    period = math.tau * math.sqrt(about / (9.81 * 0.3)) / agm[0]
    again = ws.simulate(run.scene, duration=period)
    assert again.end_q[0] == pytest.approx(math.radians(5.0), abs=1e-8)


def test_it_is_listed_written_and_refused(installed, tmp_path, capsys):
    assert main(["new", "--list", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["designs"][-1]["title"] == "Simple pendulum"
    assert main(["new", "pendulum", "--bob", "12 mm", "--drawings", "-o", str(tmp_path / "mine")]) == 0
    assert sorted(path.name for path in (tmp_path / "mine").iterdir()) == ["bob.dxf", "scene.schema.json", "scene.toml"]
    assert main(["new", "pendulum", "--bob", "90 mm", "--length", "80 mm", "-o", str(tmp_path / "other")]) == 2
    assert "design.bob" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("source", "words"),
    [("1/0", "cannot be loaded: ZeroDivisionError"), ("DESIGN = 3", 'must be a Design of the name "pendulum"')],
)
def test_a_broken_one_is_named_and_ours_still_work(source, words, installed, tmp_path, capsys):
    (installed / "pendulum.py").write_text(source)
    assert main(["new", "pendulum", "-o", str(tmp_path / "mine")]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert "my_clocks.pendulum:DESIGN" in said
    assert main(["new", "cam", "-o", str(tmp_path / "cam")]) == 0
