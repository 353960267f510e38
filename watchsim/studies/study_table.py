"""How is a study written as a table: CSV, and parquet where pyarrow is installed?"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from watchsim.results.tables import cell
from watchsim.studies.parameter_sweep import Sweep
from watchsim.studies.sensitivity import Sensitivity

Table = dict[str, list[Any]]  # column -> values


def sweep_table(sweep: Sweep) -> Table:
    """The rows as columns; the names of keys carry their SI units."""
    names = {axis.key: axis.column for axis in sweep.axes}
    columns = list(sweep.rows[0]) if sweep.rows else list(names)
    return {names.get(name, name): [row[name] for row in sweep.rows] for name in columns}


def csv_text(table: Table) -> str:
    """Numbers with all their digits; an empty field where there is none."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(map(cell, table))
    for row in zip(*table.values(), strict=True):
        writer.writerow(map(_field, row))
    return out.getvalue()


def _field(value: Any) -> Any:
    if isinstance(value, str):
        return cell(value)
    return "" if value is None else repr(float(value)) if isinstance(value, float) else value


def parquet_writer(table: Table) -> Callable[[Path], None] | None:
    """What writes the table as parquet; None where pyarrow is not installed."""
    try:
        import pyarrow as arrow
        from pyarrow import parquet
    except ImportError:
        return None

    def write(path: Path) -> None:
        parquet.write_table(arrow.table({name: _typed(arrow, values) for name, values in table.items()}), path)

    return write


def _typed(arrow: Any, values: Sequence[Any]) -> Any:
    """A column of numbers stays one where some or all of them are missing."""
    text = any(isinstance(value, str) for value in values)
    return arrow.array(values, type=arrow.string() if text else arrow.float64())


def sensitivity_table(found: Sensitivity) -> Table:
    """One line per quantity, the greatest effect first."""
    rows = found.rows()
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else ("key",))}
