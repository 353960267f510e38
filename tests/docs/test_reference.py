"""Is the reference made from the docstrings as they are, and does every public name say what it is?"""

import inspect
import re
import sys
from pathlib import Path

import pytest

import watchsim

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

from make_reference import FOLDER, PAGES, found, markdown, members, pages  # noqa: E402

NAMES = [name for _, names in PAGES.values() for name in names]


def test_the_pages_are_up_to_date():
    written = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.md")}
    stale = {name for name, text in pages().items() if written.get(name) != text} | (set(written) - set(pages()))
    assert not stale, f"{sorted(stale)}: run `python scripts/make_reference.py`"


def test_every_public_name_is_in_it():
    public = set(watchsim.__all__) - {"designs", "__version__"}
    assert {name for name in NAMES if ":" not in name} == public
    assert len(set(NAMES)) == len(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_and_all_its_members_are_described(name):
    shown, thing = found(name)
    silent = [shown] if not inspect.getdoc(thing) else []
    if inspect.isclass(thing):
        silent += [f"{shown}.{member}" for member, body in members(thing) if not inspect.getdoc(body)]
    assert not silent


def test_links_of_the_contents_lead_to_headings():
    made = pages()
    links = re.findall(r"\]\((\w+\.md)#([\w-]+)\)", made["README.md"])
    assert len(links) == len(NAMES)
    for page, anchor in links:
        headings = [re.sub(r"[^\w-]", "", line[3:].lower()) for line in made[page].splitlines() if line.startswith("## ")]
        assert anchor in headings


def test_lists_of_arguments_become_lists():
    said = "Simulate.\n\nscene  a scene\n       of bodies\nstart, end  s\n\nValueError if t < 0."
    assert markdown(said) == "Simulate.\n\n- `scene`: a scene\n  of bodies\n- `start`, `end`: s\n\nValueError if t &lt; 0.\n"
