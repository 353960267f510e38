"""What does a value look like in a notebook: a title, a few lines, and a picture beside them?"""

from __future__ import annotations

import base64
from collections.abc import Sequence

from watchsim.pages.html import Content, Markup, element, joined

STYLE = Markup(
    "<style>.watchsim{display:flex;gap:18px;align-items:flex-start;flex-wrap:wrap}"
    ".watchsim>div{max-width:420px}.watchsim>.scroll{max-width:100%;overflow-x:auto}.watchsim p{margin:0 0 4px}"
    ".watchsim img,.watchsim .chart svg{max-width:420px;width:100%;height:auto}"
    ".watchsim text{fill:currentColor;font-size:13px}.watchsim .grid{stroke:#8884}.watchsim .axis{stroke:#888}"
    ".watchsim .d0{fill:#2f57a6}.watchsim .d1{fill:#b0183c}.watchsim figure{margin:0}"
    ".watchsim .key{font-size:12px}.watchsim .key svg{width:10px;margin:0 5px}"
    ".watchsim td,.watchsim th{padding:1px 8px;text-align:right}.watchsim th:first-child{text-align:left}</style>"
)


def card(title: str, lines: Sequence[str], *pictures: Content) -> str:
    """The HTML of a card; empty lines are left out."""
    text = element("div", element("p", element("b", title)), *(element("p", line) for line in lines if line))
    return element("div", STYLE, text, *pictures, class_="watchsim")


def image(png: bytes, words: str, width: int) -> Markup:
    """A picture held by the page itself; `words` for readers that show none."""
    data = base64.b64encode(png).decode("ascii")
    return joined(element("img", src=f"data:image/png;base64,{data}", alt=words, width=width))
