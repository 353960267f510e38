"""Do the commands of the guide run as they stand there, page by page, one after the other?

But for `live`, which serves, and tolerances, which take hours.
"""

import re
import shlex
import shutil
from pathlib import Path

import pytest
from docs.test_examples import COMMANDS, ROOT
from every_time import few

from watchsim.cli import main

PAGES = sorted(
    {page for page, _ in COMMANDS if page.startswith("docs/guide/")} - {"docs/guide/live.md", "docs/guide/tolerances.md"}
)
LEFT_OUT = re.compile(
    r"SCENE|\$SLURM|^watchsim merge|results/my_lever-tolerance|decay.csv|my_watch"
)  # what needs more than the page gives
FEWER = (
    (r"--samples \d+", "--samples 16"),
    (r"(=[-\d.]+:[-\d.]+):\d+", r"\1:2"),
    (r'--duration "(?:20|30) s"', '--duration "3 s"'),
)
EARLIER = ((r"19\.55 s:19\.85 s", "2.55 s:2.85 s"),)  # of a run that is cut
QUICK = "docs/guide/export.md"


def prepare(folder: Path) -> None:
    """What the pages speak of: scenes that were begun with `new`, a part, and a solid of one."""
    for name, design in {"my_lever": "swiss_lever", "mine": "swiss_lever", "my_graham": "graham"}.items():
        assert main(["new", design, "-o", str(folder / name)]) == 0
    lever = ROOT / "profiles" / "swiss_lever"
    shutil.copy(lever / "escape_wheel.dxf", folder / "wheel.dxf")
    assert main(["export", str(lever), "--format", "stl", "--bodies", "lever", "-o", str(folder / "out")]) == 0
    shutil.copy(folder / "out" / "lever.stl", folder)
    for name in ("positions", "tolerances"):
        shutil.copytree(ROOT / "docs" / "guide" / name, folder / "docs" / "guide" / name)


@pytest.mark.parametrize("page", few(PAGES, lambda page: page == QUICK))
def test_the_commands_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    if any("results/swiss_lever" in line for where, line in COMMANDS if where == page):
        assert main(["run", "profiles/swiss_lever", "--duration", "3 s", "--no-plots"]) == 0
    wrong = []
    for line in (line for where, line in COMMANDS if where == page and not LEFT_OUT.search(line)):
        short = line.removeprefix("$ ")
        for pattern, by in (*FEWER, *EARLIER):
            short = re.sub(pattern, by, short)
        status = main(shlex.split(short, comments=True)[1:])
        if status not in (0, 1):  # 1: a verdict, as the page says
            wrong.append((short, status))
    assert not wrong
