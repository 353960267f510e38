"""How does a finished study get onto the disk, beside the rows that are there already?"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from watchsim import stopping
from watchsim.commands.common.console import InputError
from watchsim.studies.workers.journal import FIGURES, FILES


def write_study(folder: Path, numbers: dict[str, Any], table: dict[str, list[Any]], figure: Any) -> None:
    """sweep.json, sweep.csv, sweep.parquet where pyarrow is installed, the plot as PNG, SVG and PDF.

    Those of an earlier study are there until then. InputError where numbers and table had to go elsewhere.
    """
    from watchsim.render.figures.figure_style import save
    from watchsim.storage.rescue import write_elsewhere
    from watchsim.storage.write import write_file

    files = _tables(numbers, table)
    try:
        for name, write in files.items():
            write_file(folder / name, write, "the table")
    except OSError as error:
        place = write_elsewhere(folder.name, lambda made: _all_in(made, files), "the table")
        raise InputError(f"{error}.\nThe table was saved, without plots, in {place}") from error
    drawn = [] if figure is None or stopping.requested() else [f"sweep{ending}" for ending in FIGURES]
    for name in drawn:
        write_file(folder / name, lambda path: save(figure, path), "the plot")
    for name in set(FILES) - {*files, *drawn}:
        _remove(folder / name)


def _tables(numbers: dict[str, Any], table: dict[str, list[Any]]) -> dict[str, Callable[[Path], object]]:
    from watchsim.results.tables import json_text
    from watchsim.studies.study_table import csv_text, parquet_writer

    text, rows, parquet = json_text(numbers), csv_text(table), parquet_writer(table)
    files: dict[str, Callable[[Path], object]] = {
        "sweep.json": lambda path: path.write_text(text, encoding="utf-8"),
        "sweep.csv": lambda path: path.write_text(rows, encoding="utf-8"),
    }
    return files if parquet is None else {**files, "sweep.parquet": parquet}


def _remove(path: Path) -> None:
    """Away with what an earlier study has left; InputError where it stays."""
    from watchsim.storage.disk import reason

    try:
        if path.exists():
            path.unlink()
    except OSError as error:
        raise InputError(
            f"{path} is of an earlier study and could not be removed: {reason(error)}. The table is the new one."
        ) from error


def _all_in(folder: Path, files: dict[str, Callable[[Path], object]]) -> None:
    for name, write in files.items():
        write(folder / name)
