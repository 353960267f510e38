"""Do the links of the pages lead somewhere, and are the pages whole?"""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_links_lead_to_files_and_headings(page):
    text = page.read_text(encoding="utf-8")
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    broken = []
    for target in re.findall(r"\]\(([^()\s]+)\)", prose):
        place, _, anchor = target.partition("#")
        if place.startswith(("http:", "https:", "mailto:")):
            continue
        path = (page.parent / place).resolve() if place else page
        if not path.exists() or (anchor and path.suffix == ".md" and anchor not in anchors(path)):
            broken.append(target)
    assert not broken


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_no_merge_is_left_half_done(page):
    assert not re.search(r"^(<{7}|={7}|>{7})( |$)", page.read_text(encoding="utf-8"), re.MULTILINE)


@pytest.mark.parametrize(("name", "fewest"), [("design", 30), ("extend", 20), ("debug", 1)])
def test_files_and_modules_named_for_developers_exist(name, fewest):
    text = (ROOT / "docs" / "develop" / f"{name}.md").read_text(encoding="utf-8")
    tops = {path.name for path in (ROOT / "watchsim").iterdir() if path.is_dir()} | {"tests", "scripts", "watchsim"}
    named = [place.split(":")[0] for place in re.findall(r"`([a-z_]+[./][a-z_./]+[a-z_])", text)]
    named = [place for place in named if re.split(r"[./]", place)[0] in tops and not place.endswith(".toml")]
    assert len(named) >= fewest
    assert [place for place in named if not is_there(place)] == []


def is_there(place: str) -> bool:
    """Whether a path, or a dotted name of a module or of something in it, is in the checkout or the package."""
    parts = re.split(r"[./]", re.sub(r"\.(py|sh)$", "", place))
    for root in (ROOT, ROOT / "watchsim"):
        whole = root.joinpath(*parts)
        if whole.is_dir() or whole.with_suffix(".py").is_file() or whole.with_suffix(".sh").is_file():
            return True
        if "/" not in place and whole.parent != root and whole.parent.with_suffix(".py").is_file():
            return True
    return False


def anchors(path: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
