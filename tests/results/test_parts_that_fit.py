"""Is a run taken for damaged where its parts do not fit together, and only there? One thing changed at a time."""

import dataclasses
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import lever_run

from watchsim.results import archive
from watchsim.results.archive import _check_pairs, _groups, _in_order, _within
from watchsim.scene.forces import Spring
from watchsim.scene.scene import Gear
from watchsim.simulation.recording import Pairs, as_pairs
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.columns import blocks

RUN = lever_run(4)
ROWS, WIDTH = RUN.q.shape
ORDER, UNKNOWN = "its rows are out of order, or its events of unknown contacts", "its events name unknown bodies or kinds"


def changed(name: str, values: Any) -> Trajectory:
    return dataclasses.replace(RUN, **{name: values})


def event(name: str, value: float) -> Trajectory:
    """The last event with another value."""
    events = RUN.events.copy()
    events[name][-1] = value
    return changed("events", events)


def read_back(run: Trajectory) -> Trajectory:
    with TemporaryDirectory() as folder:
        path = Path(folder, "trajectory.npz")
        archive.write_trajectory(run, path)
        return archive.read_trajectory(path, run.scene)


def refused(run: Trajectory, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read_back(run)


def test_the_run_itself_is_read_back_with_and_without_its_end() -> None:
    for run in (RUN, dataclasses.replace(RUN, end_q=np.zeros(WIDTH), end_u=np.zeros(WIDTH))):
        assert np.array_equal(read_back(run).q, run.q)


def test_where_nothing_moves_there_are_no_columns() -> None:
    empty, one = np.zeros((ROWS, 0)), np.zeros((ROWS, 1))
    bodies = tuple(dataclasses.replace(body, motion="fixed") for body in RUN.scene.bodies)
    still = dataclasses.replace(RUN, scene=dataclasses.replace(RUN.scene, bodies=bodies), slices={})
    assert read_back(dataclasses.replace(still, q=empty, u=empty, a=empty)).q.shape == (ROWS, 0)
    refused(dataclasses.replace(still, q=one, u=one, a=one), "columns are of different lengths")


@pytest.mark.parametrize("name", ["t", "q", "u", "a"])
def test_rows_and_columns(name: str) -> None:
    values = getattr(RUN, name)
    refused(changed(name, values[:-1]), "columns are of different lengths")
    if name != "t":
        refused(changed(name, values[:, :-1]), "columns are of different lengths")
        refused(changed(name, np.column_stack((values, values[:, :1]))), "columns are of different lengths")
    else:
        refused(changed(name, values[:, None]), "columns are of different lengths")
    refused(changed(name, values.astype(np.float32)), "something that is not a number")
    for row in (0, ROWS // 2, ROWS - 1):
        for wrong in (np.nan, np.inf):
            spoilt = values.copy()
            spoilt[row] = wrong
            refused(changed(name, spoilt), "something that is not a number")


@pytest.mark.parametrize("name", ["end_q", "end_u"])
def test_the_state_at_the_end(name: str) -> None:
    read_back(changed(name, np.zeros(0)))
    for wrong in (np.zeros(WIDTH - 1), np.zeros(WIDTH + 1), np.zeros((1, WIDTH)), np.zeros(WIDTH, np.float32)):
        refused(changed(name, wrong), "its end is no state")


def test_times_in_order() -> None:
    """Two rows at one time are an impact."""
    t = RUN.t.copy()
    t[3] = t[2]
    read_back(changed("t", t))
    t[3] = np.nextafter(t[2], 0.0)
    refused(changed("t", t), ORDER)
    assert _in_order(np.zeros(0)) and _in_order(np.array([-5.0, -5.0, 3.0])) and not _in_order(np.array([1.0, 0.0]))


@pytest.mark.parametrize("at_once", [1, 2, 3, 100])
def test_times_in_order_however_many_are_looked_at_together(at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archive, "blocks", partial(blocks, length=at_once))
    assert _in_order(np.array([-1.5, 0.25, 0.25, 3.0, 3.0, 4.5, 7.0]))
    for place in range(1, 7):
        times = np.arange(7.0)
        times[place:] -= 1.5
        assert not _in_order(times)


@pytest.mark.parametrize(
    ("name", "count", "words"), [("contact", len(RUN.pairs), ORDER), ("body", len(RUN.scene.bodies), UNKNOWN)]
)
def test_events_of_known_contacts_and_bodies(name: str, count: int, words: str) -> None:
    for known in (-1, 0, count - 1):
        read_back(event(name, known))
    for unknown in (-2, count):
        refused(event(name, unknown), words)


def test_events_of_known_kinds() -> None:
    refused(event("kind", 99), UNKNOWN)
    refused(event("kind", -1), UNKNOWN)
    refused(event("t", np.nan), "something that is not a number")


def test_contacts_of_known_primitives_and_groups() -> None:
    pairs, groups = as_pairs(RUN.pairs), _groups(RUN.scene)
    names, table = pairs.names, np.array(pairs.table)
    _check_pairs(Pairs(names, table.copy()), groups)
    assert groups == len(RUN.scene.contacts) == table[:, 0].max() + 1
    for column, last in ((0, groups - 1), (1, len(names) - 1), (2, len(names) - 1)):
        for value, fits in ((last, True), (last + 1, False), (0, True), (-1, False)):
            other = table.copy()
            other[1, column] = value
            if fits:
                _check_pairs(Pairs(names, other), groups)
            else:
                with pytest.raises(ValueError, match="contacts are of unknown primitives"):
                    _check_pairs(Pairs(names, other), groups)
    for wrong in (table.astype(float), table[:, :2].copy(), np.column_stack((table, table[:, :1]))):
        with pytest.raises(ValueError, match="not whole numbers in threes"):
            _check_pairs(Pairs(names, wrong), groups)


def test_stops_and_gears_with_play_are_contacts() -> None:
    scene = dataclasses.replace(RUN.scene, springs=(Spring("balance", 1.0), Spring("lever", 1.0, stop=0.1)))
    assert _groups(scene) == len(scene.contacts) + 1
    gears = (Gear(("wheel", "lever"), 2.0, 0.1), Gear(("wheel", "balance"), 2.0, 0.1))
    assert _groups(dataclasses.replace(scene, gears=gears)) == len(scene.contacts) + 3


@pytest.mark.parametrize("name", ["simulated", "wall", "compile", "tolerance", "worst_penetration", "worst_residual"])
def test_headers_hold_numbers(name: str) -> None:
    read_back(changed(name, 3))
    refused(changed(name, "3"), "its header holds something that is not a number")
    refused(changed("stop_message", 3), "its header holds something that is not a number")


@pytest.mark.parametrize("name", ["overlap", "energy", "counts", "sums"])
def test_headers_hold_sums(name: str) -> None:
    refused(changed(name, [1.0]), "its header holds no sums")


def test_numbers_within() -> None:
    assert _within(np.zeros(0), 5, 1) and _within(np.array([-1, 2]), -1, 3)
    assert not _within(np.array([-2, 2]), -1, 3) and not _within(np.array([-1, 3]), -1, 3)
