"""Where are the numbers behind a report's picture kept, so that it can be drawn again without measuring again?

One small table beside the page, docs/reports/NAME.csv, in the digits that were measured.
"""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

REPORTS = Path(__file__).resolve().parents[2] / "docs" / "reports"
REDRAW = "draw the picture from the numbers that were kept, and measure nothing"


def keep(name: str, rows: Iterable[Mapping[str, Any]]) -> None:
    """Write the rows, all with the same columns."""
    told = [{key: "" if value is None else value for key, value in row.items()} for row in rows]
    with (REPORTS / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(told[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(told)


def kept(name: str) -> list[dict[str, Any]]:
    """The rows of docs/reports/NAME.csv: numbers as numbers, None where there is nothing, other words as they are."""
    path = REPORTS / f"{name}.csv"
    if not path.exists():
        raise SystemExit(f"{path} is not there: measure first, without --redraw")
    with path.open(encoding="utf-8", newline="") as file:
        return [{key: _read(text) for key, text in row.items()} for row in csv.DictReader(file)]


def _read(text: str) -> Any:
    if text == "":
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
