"""How are [[shocks]] read, which accelerate and turn the case?"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from watchsim.scene.errors import Faults
from watchsim.scene.forces import Shock
from watchsim.scene.keys import SHOCK
from watchsim.scene.values import Table, listed

NAN = math.nan
COLUMNS = ("t_s", "ax_m_s2", "ay_m_s2", "turn_rad_s2")
Rows = tuple[tuple[float, float, float, float], ...]


def read_shocks(
    mapping: Mapping[str, Any], folder: Path, faults: Faults, known: Mapping[str, bytes] | None = None
) -> tuple[tuple[Shock, ...], dict[str, bytes]]:
    """Half sines and recordings; what turns the case turns it about one point. The files of recordings by name, too.

    Those in `known` are not looked for in the folder.
    """
    files: dict[str, bytes] = {}
    elements = listed(mapping, "shocks", faults)
    tables = [Table(one, f"shocks.{i}", SHOCK, faults) for i, one in enumerate(elements)]
    found = tuple(_shock(table, folder, known or {}, files) for table in tables)
    if any(one.turns for one in found):
        for table, one in zip(tables, found, strict=True):
            if one.about != found[0].about:
                table.fault("about", "all shocks of a case that turns are said of one point: write the same in each")
    return found, files


def _shock(table: Table, folder: Path, known: Mapping[str, bytes], files: dict[str, bytes]) -> Shock:
    at, about = table.quantity("at", 0.0), table.pair("about")
    if "file" in table:
        for key in ("acceleration", "direction", "duration", "turn"):
            if key in table:
                table.fault(key, "belongs to a half sine, and the file says all of it: leave one out")
        rows = _recording(table, folder, known, files)
        return Shock(at, rows[-1][0] if rows else NAN, about=about, rows=rows)
    table.lacks('acceleration = "30400 m/s²", direction = "0°", duration = "0.35 ms"', "duration")
    if "acceleration" not in table and "turn" not in table and table.is_table:
        table.fault("", 'a shock accelerates the case: write acceleration = "30400 m/s²", or turn = "1000 rad/s²"')
    size, way = table.quantity("acceleration", 0.0), table.quantity("direction", 0.0)
    return Shock(
        at, table.quantity("duration", NAN), (size * math.cos(way), size * math.sin(way)), table.quantity("turn", 0.0), about
    )


def _recording(table: Table, folder: Path, known: Mapping[str, bytes], files: dict[str, bytes]) -> Rows:
    """The rows of a CSV file, which is added to `files`; none after a fault."""
    name = table.text("file")
    path = folder / name
    try:
        data = known[name] if name in known else path.read_bytes()
        lines = [line for line in csv.reader(io.StringIO(data.decode("utf-8-sig"), newline="")) if line]
        files[name] = data
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        table.fault("file", f"{path} cannot be read: {getattr(error, 'strerror', None) or error}", with_value=True)
        return ()
    names = [name.strip() for name in lines[0]] if lines else []
    if names not in (list(COLUMNS), list(COLUMNS[:3])):
        table.fault(
            "file", f"its first line must be {','.join(COLUMNS)} (the last one only if the case turns)", with_value=True
        )
        return ()
    rows: list[tuple[float, float, float, float]] = []
    for number, line in enumerate(lines[1:], 2):
        try:
            values = [float(value) for value in line]
        except ValueError:
            values = []
        if len(values) != len(names) or not all(map(math.isfinite, values)) or (rows and values[0] <= rows[-1][0]):
            table.fault(
                "file", f"{path.name}:{number}: {len(names)} numbers are needed, at a later time than before", with_value=True
            )
            return ()
        rows.append((values[0], values[1], values[2], values[3] if len(values) > len(COLUMNS) - 1 else 0.0))
    if len(rows) < 2:
        table.fault("file", "at least two rows are needed", with_value=True)
        return ()
    return tuple(rows)
