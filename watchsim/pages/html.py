"""How does text become HTML, so that no title and no file name can become anything else?

Whatever is no `Markup` is escaped on its way into an element.
"""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from typing import Any

VOID = frozenset(("img", "input", "meta", "path", "rect", "line", "circle", "polyline"))


class Markup(str):
    """Text that is HTML or SVG already."""

    __slots__ = ()


Content = str | Iterable["Content"] | None


def element(name: str, *content: Content, **attributes: object) -> Markup:
    """<name …>content</name>; `class_`, `aria_label` and the like lose their underscores, None leaves an attribute out."""
    told = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    if name in VOID and not content:
        return Markup(f"<{name}{told}/>")
    return Markup(f"<{name}{told}>{joined(content)}</{name}>")


def joined(content: Content) -> Markup:
    """Everything in it, one after the other, what is no markup escaped."""
    if content is None:
        return Markup("")
    if isinstance(content, Markup):
        return content
    if isinstance(content, str):
        return Markup(html.escape(content))
    return Markup("".join(joined(item) for item in content))


def embedded(value: Any) -> Markup:
    """A value as JSON that can stand in a script element: nothing in it ends one, or begins a comment."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))


def table(head: Iterable[Content], rows: Iterable[Iterable[Content]], caption: str, numeric: bool = True) -> Markup:
    """A table with a caption; the first cell of a row is its heading."""
    header = element("tr", *(element("th", cell, scope="col") for cell in head))
    body = []
    for row in rows:
        first, *rest = row
        body.append(element("tr", element("th", first, scope="row"), *(element("td", cell) for cell in rest)))
    kind = "numbers" if numeric else None
    parts = (element("caption", caption), element("thead", header), element("tbody", *body))
    # What is wider than a telephone is scrolled in its own frame, by keyboard too.
    return element("div", element("table", *parts, class_=kind), class_="scroll", tabindex=0, role="region", aria_label=caption)


def section(name: str, title: str, *content: Content) -> Markup:
    """A part of the page under a heading."""
    return element("section", element("h2", title, id=f"h-{name}"), *content, aria_labelledby=f"h-{name}", class_=name)
