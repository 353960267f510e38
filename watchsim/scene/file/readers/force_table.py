"""How is the table of a torque read, over an angle, a way or time?"""

from __future__ import annotations

from itertools import pairwise

from watchsim import units
from watchsim.scene.file.keys.key_values import NAN, Table, shown

Rows = tuple[tuple[float, float], ...]  # abscissa and value, in SI


def repeated(table: Table, rows: Rows) -> tuple[Rows, float]:
    """The rows with the first once more, a period later, and the period (s)."""
    period = table.positive("period", "the table repeats after it")
    if rows and period <= rows[-1][0] - rows[0][0]:
        table.fault("period", "must be longer than the table, which goes on with its first row after it", with_value=True)
    return (*rows, (rows[0][0] + period, rows[0][1])) if rows else (), period


def rows_of(table: Table, abscissa: units.Dimension) -> Rows:
    """(abscissa, value) pairs with ascending abscissae."""
    value, ordinate = table.mapping["table"], table.keys["value"].dimension_for(table.motion) or units.TORQUE
    if not isinstance(value, (list, tuple)) or len(value) < 2:
        example = f'[["0 {abscissa.usual[1]}", "0 {ordinate.usual[1]}"], ["1 {abscissa.usual[1]}", "1 {ordinate.usual[1]}"]]'
        table.fault("table", f"a list of at least two pairs is needed here, such as table = {example}", with_value=True)
        return ()
    rows = tuple(_row(table, i, row, (abscissa, ordinate)) for i, row in enumerate(value))
    for i, (before, after) in enumerate(pairwise(rows)):
        if after[0] <= before[0]:
            table.fault(f"table.{i + 1}", "its first column must ascend")
    return rows


def _row(table: Table, i: int, row: object, dimensions: tuple[units.Dimension, units.Dimension]) -> tuple[float, float]:
    if not isinstance(row, (list, tuple)) or len(row) != 2:
        table.faults.add(f"{table.path}.table.{i}", "two values are needed in each row", shown(row))
        return (NAN, NAN)
    x, y = (table.parsed(f"table.{i}.{j}", item, dimensions[j]) for j, item in enumerate(row))
    return (x, y)
