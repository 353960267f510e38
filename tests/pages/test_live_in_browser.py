"""Does the page of a live scene follow it in a browser, and keep what whoever looks at it has chosen?"""

import time
from pathlib import Path
from typing import Any

import pytest
from live.follower import copied, following
from pages.browser import opened

pytestmark = pytest.mark.slow
DESIGNED = '[design]\nof = "swiss_lever"\nlock = "1.5°"\n\n[run]\nduration = "2 s"\n'
PATIENCE = 90.0  # s; a busy machine


def until(page: Any, condition: str) -> None:
    """Asked from outside: the page's own policy lets no text be executed."""
    end = time.monotonic() + PATIENCE
    while not page.evaluate(condition):
        assert time.monotonic() < end, (condition, page.inner_text("#desk"), page.said)
        page.wait_for_timeout(20)


def shown(page: Any, order: int) -> None:
    until(page, f"watchsim.live().shown >= {order}")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_time_view_and_zoom_are_kept_and_the_old_outline_is_a_ghost(tmp_path: Path, scheme: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED, encoding="utf-8")
    with following(path) as follower, opened(follower.url, scheme=scheme) as page:
        shown(page, 1)
        page.evaluate("watchsim.seek(1.4)")
        for _ in range(3):
            page.click("#closer")
        page.press("#stage", "Alt+ArrowLeft")
        page.click("#push")
        before = page.evaluate("watchsim.live()")
        path.write_text(DESIGNED.replace("1.5°", "1.9°"), encoding="utf-8")
        shown(page, 2)
        after = page.evaluate("watchsim.live()")
        assert after["t"] == before["t"] and after["scale"] == pytest.approx(before["scale"], rel=1e-12)
        assert after["centre"] == pytest.approx(before["centre"], abs=1e-12)
        assert page.get_attribute("#push", "aria-pressed") == "true"
        assert before["ghost"] == 0 < after["ghost"]
        page.press("body", "g")
        assert page.evaluate("watchsim.live().ghost") == 0
        assert (
            page.locator("#outcome th", has_text="lock").count()
            and "design" not in page.inner_text("#outcome")
            and "dxf" not in page.inner_text("#outcome")
        )
        until(page, "document.querySelectorAll('#sheet > section').length > 3 && document.querySelector('.verdict') !== null")
        assert page.said == []
        assert {address.partition("/")[2].partition("/")[2].partition("/")[0] for address in page.asked} == {follower.address}


def test_a_slider_by_keyboard_changes_the_file_and_undo_takes_it_back(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED, encoding="utf-8")
    with following(path) as follower, opened(follower.url) as page:
        shown(page, 1)
        slider = page.locator('[id="in-design.lock"]').locator("xpath=preceding-sibling::input")
        slider.press("ArrowRight")
        shown(page, 2)
        assert 'lock = "1.5°"' not in path.read_text(encoding="utf-8")
        assert slider.evaluate("one => one === document.activeElement")  # where one was is where one is
        field = page.locator('[id="in-design.lock"]')
        field.fill("400")
        field.press("Enter")
        until(page, "document.getElementById('in-design.lock').getAttribute('aria-invalid') === 'true'")
        field.press("Escape")
        page.locator("summary", has_text="Numbers").click()
        duration = page.locator('[id="in-run.duration"]')
        duration.fill("2.5 s")
        duration.press("Enter")
        shown(page, 3)
        page.press("#stage", "z")
        shown(page, 4)
        page.click("#undo")
        shown(page, 5)
        assert path.read_text(encoding="utf-8") == DESIGNED
        assert page.is_disabled("#undo")
        assert [one for one in page.said if "409" not in one] == []  # Chromium reports what was refused


def test_faults_stand_in_place_of_the_result_and_the_page_says_when_nobody_answers(tmp_path: Path) -> None:
    folder = copied("swiss_lever", tmp_path)
    drawing = folder / "lever.dxf"
    whole = drawing.read_text(encoding="utf-8")
    first = whole.index("LINE\n")
    with following(folder) as follower, opened(follower.url) as page:
        shown(page, 1)
        drawing.write_text(whole[:first] + whole[first:].replace("\n 10\n", "\n 10\n0.1", 1), encoding="utf-8")
        until(page, "document.querySelectorAll('.faulty img').length > 0")
        assert ") mm:" in page.inner_text("#faults") and "no result" in page.inner_text("#doing")
        assert page.is_hidden("#outcome") and page.is_hidden(".verdict")
        drawing.write_text(whole, encoding="utf-8")
        shown(page, 3)
        assert page.is_hidden(".faulty") and page.is_hidden("#faults")
        assert page.said == []
        assert follower.ended() == 130
        until(page, "document.getElementById('doing').textContent.includes('what is shown stays')")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_panel_has_no_barriers(tmp_path: Path, scheme: str) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    path = tmp_path / "scene.toml"
    path.write_text(DESIGNED, encoding="utf-8")
    with following(path) as follower, opened(follower.url, scheme=scheme) as page:
        shown(page, 1)
        path.write_text(DESIGNED.replace("1.5°", "1.9°"), encoding="utf-8")
        shown(page, 2)
        page.locator("summary", has_text="Numbers").click()
        until(page, "!document.documentElement.classList.contains('dated')")
        found = axe.Axe().run(page)
        assert [(one["id"], [node["target"] for node in one["nodes"]]) for one in found.response["violations"]] == []
        path.write_text(DESIGNED.replace("1.5°", "80°"), encoding="utf-8")
        until(page, "!document.getElementById('faults').hidden")
        found = axe.Axe().run(page)
        assert [(one["id"], [node["target"] for node in one["nodes"]]) for one in found.response["violations"]] == []
