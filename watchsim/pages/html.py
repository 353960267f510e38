"""How do template, style, scripts and data become one file that asks nothing of any network?

Its policy lets no address be opened and no script run but the one it was written with.
"""

from __future__ import annotations

import base64
import hashlib
import html
import io
import json
import tempfile
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

from watchsim.analysis.summary import tables
from watchsim.results.folder import LOCK, travelling
from watchsim.results.tables import json_text
from watchsim.simulation.trajectory import Trajectory

# Whatever is no `Markup` is escaped on its way into an element: no title and no file name can become anything else.

VOID = frozenset(("img", "input", "meta", "path", "rect", "line", "circle", "polyline"))


class Markup(str):
    """Text that is HTML or SVG already."""

    __slots__ = ()


Content = str | Iterable["Content"] | None


def element(name: str, *content: Content, **attributes: object) -> Markup:
    """<name …>content</name>; `class_`, `aria_label` and the like lose their underscores, None leaves an attribute out."""
    listed = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items() if value is not None}
    inside = "".join(f' {key}="{html.escape(str(value))}"' for key, value in listed.items())
    if name in VOID and not content:
        return Markup(f"<{name}{inside}/>")
    return Markup(f"<{name}{inside}>{joined(content)}</{name}>")


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
    # What is wider than a phone is scrolled in its own frame, by keyboard too.
    return element("div", element("table", *parts, class_=kind), class_="scroll", tabindex=0, role="region", aria_label=caption)


def section(name: str, title: str, *content: Content) -> Markup:
    """A part of the page under a heading."""
    return element("section", element("h2", title, id=f"h-{name}"), *content, aria_labelledby=f"h-{name}", class_=name)


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


# Files to be saved from a page: the scene with its drawings, and the numbers, one zip archive, and each by itself.

MOST_PACKED = 300_000  # bytes of packed files; a page must fit into a mail
LONGEST = 20_000_000  # bytes of a table that is worth trying: packed it is a tenth
TYPES = {"json": "application/json", "csv": "text/csv", "toml": "application/toml", "svg": "image/svg+xml"}
HEADER = 30  # bytes of a local header, to which name and extra field are added (PKWARE APPNOTE 4.3.7)
STAMP = (1980, 1, 1, 0, 0, 0)  # the same run makes the same page


def packed_files(run: Trajectory, numbers: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The archive with where each file lies in it, and the names of those that would make the page too large."""
    found = tables(run, Path(tempfile.gettempdir()))
    long = [name for name, text in found.items() if text.size > LONGEST]
    contents: dict[str, str | bytes] = {**travelling(run.scene), "summary.json": json_text(numbers)}
    contents |= {name: str(text) for name, text in found.items() if name not in long}
    if not contents[LOCK]:
        contents.pop(LOCK)
    raw = {name: text.encode("utf-8", "replace") if isinstance(text, str) else text for name, text in contents.items()}
    fitting, left_out = _chosen(raw)
    archive = _zipped({name: raw[name] for name in raw if name in fitting})
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        entries = [_entry(archive, info) for info in opened.infolist()]
    return {"entries": entries, "data": base64.b64encode(archive).decode("ascii")}, [*left_out, *long]


def _chosen(raw: Mapping[str, bytes]) -> tuple[set[str], list[str]]:
    """Names that fit, the smallest first, and those that do not."""
    room, fitting = MOST_PACKED, set()
    sizes = {name: len(_zipped({name: content})) for name, content in raw.items()}
    for name in sorted(sizes, key=lambda name: sizes[name]):
        if sizes[name] <= room:
            room -= sizes[name]
            fitting.add(name)
    return fitting, [name for name in raw if name not in fitting]


def _zipped(contents: Mapping[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in contents.items():
            info = zipfile.ZipInfo(name, STAMP)
            info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(info, content)
    return out.getvalue()


def _entry(archive: bytes, info: zipfile.ZipInfo) -> dict[str, Any]:
    """Name, type, size, and where the packed bytes begin and end."""
    at = info.header_offset
    start = at + HEADER + sum(int.from_bytes(archive[at + k : at + k + 2], "little") for k in (26, 28))
    kind = TYPES.get(info.filename.rsplit(".", 1)[-1].lower(), "application/octet-stream")
    return {"name": info.filename, "type": kind, "size": info.file_size, "from": start, "to": start + info.compress_size}


ASSETS = "watchsim.pages.assets"
PLOTTING = ("uplot/LICENSE", "uplot/uPlot.iife.min.js", "uplot/uPlot.min.css")
SCRIPTS = (
    *("bytes", "motion", "coil", "zigzag", "scene", "solids", "view", "contacts", "names", "clock"),
    *("sound", "curves", "plots", "strip", "player", "files", "main"),
)


def page(
    title: str, parts: Mapping[str, Markup | str | None], data: Mapping[str, Any] | None, live: Markup | None = None
) -> str:
    """The whole page; `parts` go into the places that the template names, escaped where they are no markup.

    `live` is the panel of a page that gets its data later, from the server it came from (data None), and may ask nobody else.
    """
    licence, library, library_style = map(_asset, PLOTTING)
    scripts, styles = ((*SCRIPTS, "live"), ("page", "live")) if live else (SCRIPTS, ("page",))
    script = "".join((f"/*\n{licence}*/\n", library, *(_asset(f"{name}.js") for name in scripts)))
    script = f'"use strict";\n(() => {{\n{script}}})();\n'
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii")
    template = Template(_asset("page.html"))
    places: dict[str, object] = {name: joined(part) for name, part in parts.items()}
    places |= {"live": live or "", "connect": " connect-src 'self';" if live else ""}
    look = "".join((library_style, *(_asset(f"{name}.css") for name in styles)))
    return template.substitute(places, title=joined(title), digest=digest, style=look, script=script, data=embedded(data))


def style() -> Markup:
    """The look of every page, for those without a player."""
    return Markup(_asset("page.css"))


def _asset(name: str) -> str:
    return resources.files(ASSETS).joinpath(name).read_text(encoding="utf-8")
