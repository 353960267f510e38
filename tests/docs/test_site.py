"""Does the contents of the site, which follows from the lists of the sections' first pages, hold every page once?"""

import importlib.util
from collections import Counter
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"


@pytest.fixture(scope="module")
def conf() -> ModuleType:
    """The configuration of Sphinx, as a module."""
    spec = importlib.util.spec_from_file_location("conf_of_the_site", DOCS / "conf.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_page_stands_in_one_section(conf: ModuleType) -> None:
    firsts = [DOCS / name / "README.md" for name in conf.SECTIONS]
    listed = Counter(
        (first.parent / page).resolve()
        for first in firsts
        for page in conf.contents(first.parent, first.read_text(encoding="utf-8"))
    )
    pages = {*DOCS.rglob("*.md"), *DOCS.rglob("*.ipynb"), ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"} - set(firsts)
    assert listed == Counter(pages)


def test_a_docstring_becomes_fields(conf: ModuleType) -> None:
    lines = ["Simulate a * of `a*b`.", "", "scene  a scene", "       of bodies", "start, end  s", "", "ValueError if t < 0."]
    conf.as_rst(None, "function", "f", None, None, lines)
    assert lines == [
        r"Simulate a \* of `a*b`.",
        *("", "", ":param scene: a scene", "    of bodies", ":start, end: s"),
        *("", "ValueError if t < 0.", ""),
    ]


@pytest.mark.slow
def test_the_site_is_made_without_a_warning(tmp_path: Path) -> None:
    """All but the outputs of the notebook, which has a test of its own."""
    sphinx = pytest.importorskip("sphinx.cmd.build", reason="Sphinx is not installed: pip install 'watchsim[docs]'")
    pytest.importorskip("myst_nb", reason="myst-nb is not installed: pip install 'watchsim[docs]'")
    options = ["-q", "--fail-on-warning", "--keep-going", "-D", "nb_execution_mode=off", "-c", str(DOCS)]
    assert sphinx.main([*options, "-d", str(tmp_path / "kept"), str(ROOT), str(tmp_path / "html")]) == 0
    assert (tmp_path / "html" / "docs" / "guide" / "gallery.html").is_file()
    assert "watchsim.simulate" in (tmp_path / "html" / "genindex.html").read_text(encoding="utf-8")
