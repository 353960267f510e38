"""Are the words in the pictures of the pages those of today, and is every picture made by a script?"""

import ast
import json
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

from draw_pictures import EXHIBITS, IMAGES, KEPT, MEASURED, WORDS, drawn, gallery_page, groups, plots_page  # noqa: E402

RECORDED: dict[str, list[str]] = json.loads(WORDS.read_text(encoding="utf-8"))
GROUPS = groups()
MADE = {name for group in GROUPS.values() for name in group}
LONG = {"live", "positions", "shock", "tolerances", "movies"}  # which are not drawn again by a test


def test_every_picture_has_a_script_or_a_reason() -> None:
    there = {path.relative_to(IMAGES).as_posix() for path in IMAGES.rglob("*") if path.suffix in {".png", ".gif"}}
    assert there == MADE | set(MEASURED) | KEPT
    assert not (MADE & set(MEASURED)) and not (MADE & KEPT) and len(EXHIBITS) > 10
    assert [script for script in MEASURED.values() if not (ROOT / script).is_file()] == []


def test_the_pages_of_pictures_are_those_of_the_script() -> None:
    for name, text in (("gallery", gallery_page()), ("plots", plots_page())):
        assert (ROOT / "docs" / "guide" / f"{name}.md").read_text(encoding="utf-8") == text


def vocabulary() -> set[str]:
    """Every word that code or scenes can write into a picture."""
    words: set[str] = set()
    for path in [*(ROOT / "watchsim").rglob("*.py"), ROOT / "scripts" / "draw_theory.py"]:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        texts = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        words.update(word for text in texts for word in re.findall(r"[^\W\d_]{3,}", text))
    for path in [*(ROOT / "profiles").rglob("*.toml"), *(ROOT / "docs").rglob("*.toml")]:
        words.update(re.findall(r"[^\W\d_]{3,}", path.read_text(encoding="utf-8")))
    return {word.lower() for word in words}


def test_no_picture_holds_a_word_that_is_gone() -> None:
    drawn_quickly = {name for group, pictures in GROUPS.items() if group not in LONG for name in pictures}
    assert drawn_quickly <= set(RECORDED) <= MADE
    known = vocabulary()
    assert len(known) > 1000
    assert {
        name: gone for name, words in RECORDED.items() if (gone := [one for one in words if one.lower() not in known])
    } == {}


@pytest.mark.slow
@pytest.mark.parametrize("group", sorted(set(GROUPS) - LONG))
def test_pictures_drawn_today_have_the_same_words(group: str, tmp_path: Path) -> None:
    words = drawn(GROUPS[group], tmp_path)
    assert {name: RECORDED[name] for name in words} == words
