"""Which browser opens pages in tests? Debian's Chromium, driven by playwright; without them such tests are skipped."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")


@contextmanager
def opened(
    path: Path | str, width: int = 1280, height: int = 900, scheme: str = "light", ratio: float = 1.0, script: bool = True
) -> Iterator[Any]:
    """A file or address in a window; its `said` collects messages and exceptions, its `asked` the addresses it opens.

    `script`: it is a page with a player.
    """
    driver = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: pip install 'watchsim[browser]'")
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"no browser: none of {', '.join(NAMES)} is installed")
    with driver.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=program, args=["--no-sandbox"])
        context = browser.new_context(
            viewport={"width": width, "height": height}, color_scheme=scheme, device_scale_factor=ratio, accept_downloads=True
        )
        page = context.new_page()
        said: list[str] = []
        asked: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.goto(path if isinstance(path, str) else path.absolute().as_uri())
        assert page.evaluate("window.watchsim !== undefined") == script, said
        page.said, page.asked = said, asked
        try:
            yield page
        finally:
            browser.close()
