"""How does a run become a page that can be sent?

report(run, "watch.html")
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from watchsim.analysis.phases import phases_within
from watchsim.analysis.summary import summary
from watchsim.pages.charts import poster
from watchsim.pages.html import Markup, element, image, joined, packed_files, page, section
from watchsim.pages.player import Channel, TooMuch, channels, drawn_parts, picture_size, player_data, shown
from watchsim.pages.timing_sheet import sheet, verdict
from watchsim.render.opening import last_beats, telling
from watchsim.render.view import Window, recorded
from watchsim.results.tables import plain
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.write import write_file
from watchsim.units import metric

ENDINGS = (".html", ".htm")
HALVINGS = 12
WORN_DOTS = 800  # across the picture of wear: 19 kB
ALONE = Markup("<style>.skip,header,#sheet,footer{display:none!important}main{margin-top:0;padding-top:0}</style>")


def report(
    run: Trajectory,
    path: str | os.PathLike[str] = "report.html",
    window: Sequence[float] | None = None,
    *,
    numbers: Mapping[str, Any] | None = None,
) -> Path:
    """Write a run as one self-contained HTML file, and return its path: a player, linked plots, the timing sheet, the files.

    window   (from, to) in seconds that the player shows; default the last ten beats, or all of the last stretch recorded
    numbers  as in summary.json, where already at hand; default `summary(run)`

    ValueError for a window that was not recorded, that holds too much motion for a page, or a path with another ending;
    OSError where the file cannot be written: it is written whole or not at all.
    """
    target = check_page(path)
    text = page_text(run, window, numbers)
    write_file(target, lambda place: place.write_bytes(text.encode("utf-8", "replace")), "the page")
    return target


def check_page(path: str | os.PathLike[str]) -> Path:
    """The path, if its ending is that of a page."""
    target = Path(path)
    if target.suffix.lower() not in ENDINGS:
        raise ValueError(f"{path}: a page is written as HTML; choose a name that ends in .html")
    return target


def page_text(run: Trajectory, window: Sequence[float] | None = None, numbers: Mapping[str, Any] | None = None) -> str:
    """The page as text; see `report`."""
    known = plain(summary(run) if numbers is None else numbers)
    places, data = page_parts(run, window, known)
    files, left_out = packed_files(run, known)
    return page(run.scene.title, {**places, "saved": _saved(left_out)}, {**data, "files": files})


def player_text(run: Trajectory, window: Sequence[float] | None = None) -> str:
    """A page with the player and the plots only, for a frame in another page."""
    places, data = page_parts(run, window)
    return page(run.scene.title, {**places, **dict.fromkeys(("poster", "lead"), ""), "sheet": ALONE}, data)


def page_parts(
    run: Trajectory, window: Sequence[float] | None = None, numbers: Mapping[str, Any] | None = None
) -> tuple[dict[str, Markup | str], dict[str, Any]]:
    """What stands in the places of the page, and the data of its player, without files; `numbers` fill the timing sheet."""
    span, moved, off = _motion(run, window)
    found = phases_within(run, span)
    opening = telling(found, span)
    parts = drawn_parts(run.scene, picture_size(run, span))
    data = player_data(run, span, moved, parts, found, opening)
    data["files"] = {"entries": [], "data": ""}
    places = {
        "poster": poster(run, span, parts, opening),
        "verdict": (verdict(numbers) if numbers else None) or Markup(""),
        "lead": _lead(run, span),
        "sheet": joined((sheet(run, numbers), _worn(run))) if numbers else Markup(""),
        "saved": Markup(""),
        "made": _made(numbers or {}, off),
    }
    return places, data


def _motion(run: Trajectory, window: Sequence[float] | None) -> tuple[Window, list[Channel], float]:
    """What is shown, its rows, and how exact they are (m); a window nobody asked for is halved until it fits."""
    span = shown(run, window)
    size = picture_size(run, span)
    for _ in range(HALVINGS):
        try:
            return span, *channels(run, span, size)
        except TooMuch:
            if window is not None:
                raise
            span = (0.5 * (span[0] + span[1]), span[1])
    return span, *channels(run, span, size)


def _worn(run: Trajectory) -> Markup:
    """What wore in the last beats, along the outlines; nothing where nothing slides, or the run does not know."""
    from watchsim.render.palette import dark
    from watchsim.render.style import small_png  # with matplotlib, which takes half a second to load
    from watchsim.render.wear_plot import plot_wear

    try:
        figure = plot_wear(run, last_beats(run))
    except ValueError:
        return Markup("")
    words = "Archard's index of the last beats as colour along the outlines that slide on each other"
    light = element("div", image(small_png(figure, WORN_DOTS), words, WORN_DOTS), class_="light")
    night = element("div", image(small_png(dark(figure), WORN_DOTS), words, WORN_DOTS), class_="night")
    look = {"class_": "scroll", "tabindex": 0, "role": "region", "aria_label": words}
    return section("wear", "What wears", element("div", light, night, **look))


def _lead(run: Trajectory, span: Window) -> str:
    start, end = span
    whole = f"{run.simulated:.6g} s simulated"
    spans = recorded(run)
    if start <= spans[0][0] <= 0.0 and end >= run.simulated * (1.0 - 1e-9) and len(spans) == 1:
        return f"{whole}, all of it shown"
    return f"{whole}; shown: {start:.6g} s to {end:.6g} s"


def _saved(left_out: list[str]) -> Markup:
    if not left_out:
        return Markup("")
    return element("p", f"Too large for this page: {', '.join(left_out)}.", class_="note")


def _made(numbers: Mapping[str, Any], off: float) -> Markup:
    version = (numbers.get("versions") or {}).get("watchsim")
    exact = metric(off, "m", 2)
    return joined(
        (f"watchsim {version}. " if version else "", f"Outlines stand within {exact} of the motion that was computed.")
    )
