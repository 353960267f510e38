"""What does the sheet say of the geometry of function: lock, draw, lift, drop, and the freedoms of the safety action?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.escapement.function_report import Table, measured, tables
from watchsim.escapement.measure import measure
from watchsim.pages.html import Content, Markup, element, section, table
from watchsim.scene.scene import Scene

HEAD = ("quantity", "entry stone", "exit stone")
STONES = "stones and wheel"
MINUS, DASH = "\N{MINUS SIGN}", "\N{EN DASH}"
BOTH = 2  # values of a row: of entry and of exit


def function_tables(scene: Scene) -> Iterator[Markup]:
    """The section, measured by turning the parts of the scene by hand as `check` does; nothing of a scene without stones."""
    found = measure(scene)
    if found.pallets is None:
        return
    note = f"Measured on the drawing: {measured(found)}."
    missing = [element("p", f"Not measured: {what}, {why}.", class_="note") for what, why in found.missing]
    measures = element("div", *map(_table, tables(found)), class_="columns")
    yield section("function", "Geometry of function", element("p", note, class_="note"), measures, *missing)


def _table(one: Table) -> Markup:
    worst = any(row.worst for row in one.rows)
    rows: list[list[Content]] = []
    for row in one.rows:
        words = row.words.strip()
        name = element("span", words, class_="of") if row.words != words else words
        values = [_printed(value) for value in row.values]
        values += [""] * (BOTH - len(values))
        rows.append([name, *values, *([row.worst] if worst else [])])
    return table((*HEAD, "worst tooth") if worst else HEAD, rows, (one.title or STONES).capitalize())


def _printed(value: str) -> str:
    return DASH if value == "-" else value.replace("-", MINUS)
