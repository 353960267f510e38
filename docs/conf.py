"""How Sphinx makes the site of these pages: `scripts/make_site.py`.

The pages are plain Markdown, to be read on a forge as well. What a site needs besides is added while they are read: a table of
contents from the lists of each section's README.md, and the reference from the docstrings themselves (autodoc).
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from make_reference import ITEM, PAGES, found, member_rows  # noqa: E402

import watchsim  # noqa: E402

project, author, copyright = "watchsim", "The watchsim authors", "The watchsim authors"
version = release = watchsim.__version__
language = "en"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.viewcode"]
root_doc = "README"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/**"]
exclude_patterns = [".*", "build", "results", "profiles", "tests", "scripts", "watchsim", "**/*.toml", "**/*.csv"]
SECTIONS = ["tutorials", "guide", "reference", "theory", "reports", "develop"]

myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
nb_execution_mode = os.environ.get("WATCHSIM_NOTEBOOK", "cache")  # off: without outputs, in seconds
nb_execution_timeout = 900
nb_execution_raise_on_error = True
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100
add_module_names = False
default_role = "code"  # docstrings mark code with single backticks, as the pages do
linkcheck_timeout, linkcheck_retries = 20, 2

html_theme = "pydata_sphinx_theme"
html_title = f"watchsim {release}"
html_theme_options = {
    "navbar_align": "left",
    "header_links_before_dropdown": len(SECTIONS),
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
}
html_show_sourcelink = False
html_copy_source = False


def contents(folder: Path, text: str) -> list[str]:
    """The pages that the lists of a section name, in their order."""
    named = re.findall(r"^(?:- |## )\[[^\]]+\]\(([\w./-]+\.(?:md|ipynb))\)", text, re.MULTILINE)
    return [os.path.relpath((folder / name).resolve(), folder) for name in named]


def add_contents(app: Any, docname: str, source: list[str]) -> None:
    """A hidden table of contents for the first page and that of each section."""
    if docname == root_doc:
        pages = [f"docs/{name}/README.md" for name in SECTIONS]
    elif docname.endswith("/README"):
        pages = contents((ROOT / docname).parent, source[0])
    else:
        return
    source[0] += "\n```{toctree}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"


def add_reference(app: Any, docname: str, source: list[str]) -> None:
    """The pages that make_reference.py writes for the forge, made here by autodoc: with an index, types and sources linked."""
    folder, _, page = docname.rpartition("/")
    if folder != "docs/reference" or page not in PAGES:
        return
    title, names = PAGES[page]
    parts = [f"# {title}\n"]
    for name in names:
        shown, thing = found(name)
        module, _, record = name.rpartition(":")
        kind = "autoclass" if isinstance(thing, type) else "autofunction"
        target = f"{module or 'watchsim'}.{record}"
        parts.append(
            f"\n## {shown}\n\n```{{eval-rst}}\n.. {kind}:: {target}\n" + "   :members:\n" * (kind == "autoclass") + "```\n"
        )
        if kind == "autoclass" and hasattr(thing, "__members__"):
            parts += ["\n| name | value | meaning |\n|---|---|---|\n", *member_rows(thing)]
    source[0] = "".join(parts)


def as_rst(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Lists `name  what it is` of a docstring become fields (parameters) or items; stars and bars are no markup."""
    field = what in {"function", "method", "class"}
    out: list[str] = []
    in_list = False
    for line in lines:
        safe = re.sub(r"(`[^`]*`)|([*|\\]|(?<=\w)_(?=\W|$))", lambda m: m[1] or f"\\{m[2]}", line)
        head = ITEM.match(safe)
        if head:
            if not in_list:
                out.append("")
            names = head[1].replace("\\", "")
            out.append(f":param {names}: {head[2]}" if field and "," not in names else f":{names}: {head[2]}")
        elif in_list and line.startswith(" "):
            out.append(f"    {safe.strip()}")
        else:
            if in_list and line:
                out.append("")
            out.append(safe)
        in_list = bool(head) or (in_list and line.startswith(" "))
    lines[:] = [*out, ""]


def setup(app: Any) -> None:
    app.connect("source-read", add_reference)
    app.connect("source-read", add_contents)
    app.connect("autodoc-process-docstring", as_rst)
