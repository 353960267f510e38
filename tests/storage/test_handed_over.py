"""Does another process get what was handed over, whole, and without waiting for anybody?"""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.storage.columns import Columns, Mapping, mapping
from watchsim.storage.handed_over import Lost, hand_over, memory_file, take_over

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="files without a name are passed on Linux only")

Line = tuple[socket.socket, socket.socket]


@pytest.fixture
def line() -> Iterator[Line]:
    ends = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    yield ends
    for end in ends:
        end.close()


def test_messages_arrive_in_order_and_whole(line: Line) -> None:
    values = [{"a": 1}, ("text", None, [1.5]), np.arange(300_000.0).reshape(-1, 3), {b"x": "y"}]
    for value in values:
        hand_over(line[0], value)
    for value in values:
        assert np.array_equal(take_over(line[1]), value) if isinstance(value, np.ndarray) else take_over(line[1]) == value


def test_what_a_scene_has_only_remembered_is_not_passed(line: Line) -> None:
    """Another thread may be adding to it meanwhile."""
    scene = load(profiles_dir() / "incline")
    assert scene.body(scene.bodies[0].name) is scene.bodies[0]
    hand_over(line[0], scene)
    passed = take_over(line[1])
    assert passed == scene and passed.source == scene.source and passed.set("run.duration", "1 s").duration == 1.0
    assert vars(scene).keys() - vars(passed).keys() == {"_by_name"}


def test_files_are_passed_as_they_are(line: Line) -> None:
    with memory_file() as file:
        file.write(b"before")
        file.flush()
        hand_over(line[0], {"picture": file})
        taken = take_over(line[1])["picture"]
        os.pwrite(file.fileno(), b"after!", 0)
    taken.seek(0)
    assert taken.read() == b"after!"


def in_a_file(folder: Path, rows: int) -> np.ndarray:
    columns = Columns()
    columns.folder, columns.most = folder, 0
    columns.append([np.arange(2.0 * rows).reshape(rows, 2)])
    columns.append([np.full((1, 2), -1.0)])
    (array,) = columns.all()
    return array[:rows]


def test_arrays_in_files_are_not_copied(line: Line, tmp_path: Path) -> None:
    array = in_a_file(tmp_path, 1000)
    hand_over(line[0], {"q": array, "part": array[3:7]})
    taken = take_over(line[1])
    assert np.array_equal(taken["q"], array) and np.array_equal(taken["part"], array[3:7])
    there, here = mapping(array), mapping(taken["q"])
    assert isinstance(there, Mapping) and isinstance(here, Mapping)
    assert os.fstat(there.file.fileno()).st_ino == os.fstat(here.file.fileno()).st_ino
    assert mapping(taken["part"]) is None  # it does not begin where its file begins
    assert not taken["q"].flags.writeable


def test_who_has_gone_is_lost(line: Line) -> None:
    line[0].close()
    with pytest.raises(Lost):
        take_over(line[1])
    with pytest.raises(OSError):
        hand_over(line[1], "anybody?")


def test_nobody_waits_for_who_is_behind(line: Line) -> None:
    line[0].setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1)  # the least there is
    with pytest.raises(BlockingIOError):
        for _ in range(1000):
            hand_over(line[0], "more")
    assert take_over(line[1]) == "more"


def test_what_cannot_be_pickled_is_not_sent(line: Line) -> None:
    with pytest.raises(Exception, match="pickle"):
        hand_over(line[0], lambda: None)
    hand_over(line[0], "next")
    assert take_over(line[1]) == "next"
