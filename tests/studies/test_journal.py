"""Does a study keep its rows where the disk fails for a while, and an earlier one where it cannot begin?"""

import json
from pathlib import Path

import pytest
from storage.disk_faults import Disk, watched

from watchsim.studies.journal import NAME, Journal

STUDY = {"scene": "0123456789abcdef", "keys": {"a": [1.0, 2.0, 3.0]}}
ROWS = {number: {"amplitude_deg": 270.0 + number} for number in range(3)}


def written(folder: Path) -> dict[int, dict[str, float]]:
    _, *lines = (folder / NAME).read_text().splitlines()
    rows = [json.loads(line) for line in lines]
    return {int(row.pop("point")): row for row in rows}


def filled(folder: Path) -> None:
    with Journal(folder, STUDY, resume=False) as journal:
        for number, row in ROWS.items():
            journal.add(number, row)


def test_a_row_that_fails_once_comes_with_the_next(tmp_path: Path) -> None:
    with watched(Disk(tmp_path)) as disk:
        filled(tmp_path)
    actions = len(disk.log)
    lines = [name for name, *_ in disk.log].index("os.rename") + 1  # the header is written, the rows begin
    for number in range(lines + 1, actions + 1):
        with watched(Disk(tmp_path, number)) as disk:
            try:
                filled(tmp_path)
            except OSError as error:
                assert "could not write the rows" in str(error)
                continue
        assert disk.failed and written(tmp_path) == ROWS, disk.log[number - 1]


def test_a_full_disk_does_not_stop_the_study(tmp_path: Path) -> None:
    """Not even half a line is left of what could not be written; who goes on computes those rows again."""
    with watched(Disk(tmp_path, count=10**6)) as disk, Journal(tmp_path, STUDY, resume=False) as journal:
        journal.add(0, ROWS[0])
        disk.failing = len(disk.log) + 1
        journal.add(1, ROWS[1])
        assert disk.failed and journal.rows == {0: ROWS[0], 1: ROWS[1]} and written(tmp_path) == {0: ROWS[0]}
        disk.failing = 0
    assert written(tmp_path) == {0: ROWS[0], 1: ROWS[1]}, "written when it is closed"


def test_an_earlier_study_is_there_until_the_new_one_has_begun(tmp_path: Path) -> None:
    filled(tmp_path)
    before = (tmp_path / NAME).read_bytes()
    with watched(Disk(tmp_path, 1, count=10**6)), pytest.raises(OSError, match="could not write the rows"):
        Journal(tmp_path, {**STUDY, "keys": {}}, resume=False)
    assert (tmp_path / NAME).read_bytes() == before and [path.name for path in tmp_path.iterdir()] == [NAME]


def test_a_line_that_was_cut_off_is_written_over(tmp_path: Path) -> None:
    filled(tmp_path)
    path = tmp_path / NAME
    path.write_bytes(path.read_bytes()[:-5])
    with Journal(tmp_path, STUDY, resume=True) as journal:
        assert journal.rows == {0: ROWS[0], 1: ROWS[1]}
        journal.add(2, ROWS[2])
    assert written(tmp_path) == ROWS
