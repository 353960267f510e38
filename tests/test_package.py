"""Is the package whole when it is installed, and do its papers agree?"""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import watchsim as ws

ROOT = Path(__file__).resolve().parents[1]
PROFILES = ("bench_lever", "incline", "swiss_lever")


def test_profiles_are_found_wherever_the_package_is() -> None:
    folder = ws.profiles_dir()
    assert all((folder / name / "scene.toml").is_file() for name in PROFILES)


def test_profiles_are_named_from_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the pages name them; a folder of that name that is here comes first."""
    monkeypatch.chdir(tmp_path)
    assert ws.load("profiles/incline").path == ws.profiles_dir() / "incline" / "scene.toml"
    Path("profiles").mkdir()
    with pytest.raises(ws.SceneError, match="no such scene"):
        ws.load("profiles/incline")


def test_versions_agree() -> None:
    """The package holds the version; builds read it there, papers quote it."""
    assert 'dynamic = ["version"]' in (ROOT / "pyproject.toml").read_text()
    citation = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    released = re.search(r"^## \[(\d.+?)\]", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert citation and released
    assert citation[1] == released[1] == ws.__version__


def test_the_glossary_names_files_that_exist() -> None:
    words = (ROOT / "docs/guide/glossary.md").read_text(encoding="utf-8")
    homes = re.findall(r"`([a-z_]+/[a-z_/]*(?:\.py)?)`", words)
    assert len(homes) > 20
    assert [home for home in homes if not (ROOT / "watchsim" / home).exists()] == []


@pytest.mark.parametrize(
    "page", ["docs/develop/design.md", "docs/develop/extend.md", "docs/theory/method.md", "docs/reports/hunt.md"]
)
def test_pages_name_files_that_exist(page: str) -> None:
    named = re.findall(r"`([a-z_/]+\.py)`", (ROOT / page).read_text(encoding="utf-8"))
    there = [path.as_posix() for top in ("watchsim", "tests", "scripts") for path in (ROOT / top).rglob("*.py")]
    assert named
    assert [name for name in named if not any(path.endswith(f"/{name}") for path in there)] == []


def test_the_documents_name_the_commands_that_exist() -> None:
    from watchsim.cli import COMMANDS

    named = re.findall(r"^\| `watchsim (\w+)", (ROOT / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert tuple(named) == COMMANDS


@pytest.mark.slow
def test_the_wheel_holds_the_package_and_the_profiles(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "pip", "wheel", str(ROOT), "--no-deps", "--quiet", "--wheel-dir", str(tmp_path)]
    subprocess.run(build, check=True)
    (wheel,) = tmp_path.glob("watchsim-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        for path in (path for path in (ROOT / "profiles").rglob("*") if path.is_file()):
            assert archive.read(f"watchsim/profiles/{path.relative_to(ROOT / 'profiles').as_posix()}") == path.read_bytes()
    assert {"watchsim/py.typed", "watchsim/__init__.py", "watchsim/cli.py"} <= names
    assert not {name.split("/")[0] for name in names} - {"watchsim", f"watchsim-{ws.__version__}.dist-info"}
    assert any(name.endswith("LICENSE") for name in names)
