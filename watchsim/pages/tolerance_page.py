"""How does a study of tolerances become one page that can be sent?"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from watchsim.pages.html import Content, Markup, element, image, joined, section, style, table
from watchsim.pages.report_page import check_page
from watchsim.render.style import MM
from watchsim.render.tolerance_plot import plot_tolerance
from watchsim.scene.keys import in_words
from watchsim.storage.write import write_file
from watchsim.studies.point import OUTPUTS
from watchsim.studies.tolerance_result import ToleranceStudy
from watchsim.units import signed

DOTS = 1400  # across the picture
MOST = 12  # contributions in a table
VIEWPORT = element("meta", name_="viewport", content="width=device-width, initial-scale=1")


def tolerance_page(study: ToleranceStudy, path: str | Path) -> Path:
    """Write the study as one self-contained HTML file; ValueError for a path with another ending, OSError where it fails."""
    picture = drawn(plot_tolerance(study), f"plots of the study: {study.message}")
    parts = [
        section("yield", "Yield", element("p", f"{study.message}."), _yields(study)),
        section("spread", "What the watches do", *_spread(study), picture),
        section("tolerances", "What they are made to", _tolerances(study)),
        section("contributions", "Which dimension decides it", *_contributions(study)),
        section("worst", "The worst of them", _worst(study)),
    ]
    return written(study.title, parts, path)


def drawn(figure: Any, words: str) -> Markup:
    """A figure in the page; `words` for readers that show no pictures."""
    made = io.BytesIO()
    figure.savefig(made, format="png", dpi=DOTS / figure.get_figwidth())
    shown = image(made.getvalue(), words, round(figure.get_figwidth() / MM * 6))
    return element("div", shown, class_="scroll", tabindex=0, role="region", aria_label=words)


def written(title: str, parts: Sequence[Content], path: str | Path) -> Path:
    """The page of a study with these parts below its title, as one file; light, as its pictures are."""
    target = check_page(path)
    head = element("head", element("meta", charset="utf-8"), VIEWPORT, element("title", title), element("style", style()))
    body = element("body", element("header", element("h1", title)), element("main", element("article", *parts, id="sheet")))
    text = joined([Markup("<!doctype html>"), element("html", head, body, lang="en", data_theme="light", class_="study")])
    write_file(target, lambda place: place.write_bytes(text.encode("utf-8", "replace")), "the page")
    return target


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}".replace("-", "−")


def _percent(value: float) -> str:
    return f"{100.0 * value:.4g}\N{NO-BREAK SPACE}%"


def _yields(study: ToleranceStudy) -> Markup:
    rows = [(one.by, _percent(one.value), _percent(one.low), _percent(one.high)) for one in study.shares.values()]
    return table(("yield by", "share", "from", "to"), rows, f"{study.good} of {study.samples} samples are good")


def _share(value: float | None) -> str:
    return "" if value is None else signed(value, 4)


def _spread(study: ToleranceStudy) -> list[Content]:
    labels = {one.column: f"{one.label} ({one.unit})" if one.unit else one.label for one in OUTPUTS.values()}
    rows = []
    for column, one in study.outputs.items():
        ends = [one.quantiles[q] for q in ("0.00135", "0.5", "0.99865")]
        linear = (one.linear_sigma, one.linear_low, one.linear_high)
        rows.append((labels[column], *map(_number, (one.mean, one.sigma, *ends, one.cp, one.cpk, *linear))))
    head = ("", "mean", "σ", "0.1 %", "median", "99.9 %", "Cp", "Cpk", "linear σ", "worst case from", "to")
    words = "mean and scatter of all samples, and what the linear prediction (root of squares, worst case) says"
    remarks = [f"{labels[column]}: {one.remark}." for column, one in study.outputs.items() if one.remark]
    return [table(head, rows, words), *(element("p", remark, class_="note") for remark in remarks)]


def _tolerances(study: ToleranceStudy) -> Markup:
    rows = [(in_words(one.key), one.shown(one.nominal), one.words) for one in study.plan.scene.tolerances]
    return table(("", "nominal", "limits"), rows, "the dimensions that are drawn", numeric=False)


def _contributions(study: ToleranceStudy) -> list[Content]:
    found: list[Content] = []
    labels = {one.column: one.label for one in OUTPUTS.values()}
    for name, each in study.contributions.items():
        rows = [
            (in_words(one.key), *(_share(value) for value in (one.first, one.total, one.total_error, one.linear, one.rank)))
            for one in each[:MOST]
        ]
        known = f", {_percent(study.explained[name])} of the variance explained" if name in study.explained else ""
        known += f", rank correlations only: {why}" if (why := study.why_ranks(name)) else ""
        found.append(table(("", "alone", "total", "± ", "linear", "rank"), rows, f"{labels.get(name, name)}{known}"))
    return found


def _worst(study: ToleranceStudy) -> Markup:
    rows = [(str(one["sample"]), one["why"]) for one in study.worst]
    return table(("sample", "what is wrong"), rows, "watchsim run STUDY --sample N --movie shows one of them", numeric=False)
