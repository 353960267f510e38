"""How do template, style, scripts and data become one file that asks nothing of any network?

Its policy lets no address be opened and no script run but the one it was written with.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from importlib import resources
from string import Template
from typing import Any

from watchsim.pages.html import Markup, embedded, joined

ASSETS = "watchsim.pages.assets"
PLOTTING = ("uplot/LICENSE", "uplot/uPlot.iife.min.js", "uplot/uPlot.min.css")
SCRIPTS = (
    "bytes",
    "motion",
    "coil",
    "zigzag",
    "scene",
    "view",
    "contacts",
    "clock",
    "sound",
    "curves",
    "plots",
    "player",
    "files",
    "main",
)


def page(title: str, parts: Mapping[str, Markup | str | None], data: Mapping[str, Any]) -> str:
    """The whole page; `parts` go into the places that the template names, escaped where they are no markup."""
    licence, library, library_style = map(_asset, PLOTTING)
    script = "".join((f"/*\n{licence}*/\n", library, *(_asset(f"{name}.js") for name in SCRIPTS)))
    script = f'"use strict";\n(() => {{\n{script}}})();\n'
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii")
    template = Template(_asset("page.html"))
    places: dict[str, object] = {name: joined(part) for name, part in parts.items()}
    return template.substitute(
        places, title=joined(title), digest=digest, style=library_style + _asset("page.css"), script=script, data=embedded(data)
    )


def _asset(name: str) -> str:
    return resources.files(ASSETS).joinpath(name).read_text(encoding="utf-8")
